//! Errors of an imported body: one sentence each, which names the element and the cure.

use toile_base::limits::{MAX_BODY_BYTES, MAX_BODY_VERTICES};

/// Why a file does not become a body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{path}: {flaw}")]
pub struct AvatarError {
    /// The file or folder.
    pub path: String,
    /// The fault.
    pub flaw: Flaw,
}

/// The fault, to follow the file's name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Flaw {
    /// The file cannot be read.
    #[error("it cannot be read ({reason}); give the path of a readable file")]
    Read {
        /// Error of the operating system.
        reason: String,
    },
    /// The file is larger than [`MAX_BODY_BYTES`].
    #[error("it has {bytes} bytes, more than the {MAX_BODY_BYTES} that are read; reduce its mesh and its pictures")]
    TooLarge {
        /// Size of the file (bytes).
        bytes: u64,
    },
    /// The text or the structure of the file; the reason holds the cure.
    #[error("{reason}")]
    Syntax {
        /// The fault and its cure.
        reason: String,
    },
    /// No mesh has a skin.
    #[error("it has no mesh that is bound to a skeleton; export the body with its armature, skinning included")]
    NoSkin,
    /// No mesh has the name that was asked for.
    #[error("it has no mesh named {name}, only {known}; name one of these, or none to take them all")]
    NoMesh {
        /// Name that was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// No animation has the name that was asked for.
    #[error("it has no animation named {name}, only {known}; name one of these")]
    NoAnimation {
        /// Name that was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// An animation that cannot be followed.
    #[error("its animation \"{name}\" {reason}")]
    Animation {
        /// Name of the animation.
        name: String,
        /// The fault and its cure.
        reason: String,
    },
    /// Too few vertices, or more than [`MAX_BODY_VERTICES`].
    #[error("it has {count} vertices, and a body has 4 to {MAX_BODY_VERTICES}; export a mesh of that size")]
    Vertices {
        /// How many there are.
        count: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("{what} {index} is not finite; mend the mesh where it was made and export it again")]
    NotFinite {
        /// Kind of the element.
        what: &'static str,
        /// Number of the element.
        index: usize,
    },
    /// A weight for a joint that the skin lacks.
    #[error(
        "vertex {vertex} (from 0 over all skinned parts) is bound to joint {joint}, but its skin has {joints}; bind the mesh to its armature again"
    )]
    JointRange {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// The joint that it names.
        joint: u32,
        /// How many the skin has.
        joints: usize,
    },
    /// Weights that do not sum to 1.
    #[error(
        "the weights of vertex {vertex} (from 0 over all skinned parts) sum to {sum} instead of 1; normalise all weights before exporting"
    )]
    WeightSum {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// Sum of its weights; 1 is right.
        sum: f32,
    },
    /// A weight outside of 0 to 1.
    #[error(
        "vertex {vertex} (from 0 over all skinned parts) has the weight {weight}; weights lie between 0 and 1, so normalise them"
    )]
    Weight {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// The weight found; 0 to 1 is right.
        weight: f32,
    },
    /// A node that is its own ancestor.
    #[error("node \"{node}\" is below itself; make the armature a tree and export it again")]
    Cycle {
        /// Name of the node.
        node: String,
    },
    /// A node with two parents.
    #[error("node \"{node}\" has two parents; make the armature a tree and export it again")]
    TwoParents {
        /// Name of the node.
        node: String,
    },
    /// A node whose scale is negative.
    #[error("node \"{node}\" is mirrored by a negative scale; apply scales to the armature before exporting")]
    Mirrored {
        /// Name of the node.
        node: String,
    },
    /// A node whose scale is 0.
    #[error("node \"{node}\" is scaled to nothing; apply scales to the armature before exporting")]
    Flat {
        /// Name of the node.
        node: String,
    },
    /// A bind matrix that cannot be inverted.
    #[error("the inverse bind matrix of joint \"{joint}\" cannot be used; bind the mesh to its armature again")]
    InverseBind {
        /// The joint's name.
        joint: String,
    },
    /// Joints without which there is no body.
    #[error(
        "no joint was found for {missing} (the names are most like those of {dialect}); name the bones as H-Anim, VRM, \
         Mixamo, Unreal or CMU do, or mark them as a VRM humanoid"
    )]
    Missing {
        /// Ours that were not found.
        missing: String,
        /// The naming that the file's names are most like.
        dialect: &'static str,
    },
    /// A joint that is no descendant of the hips.
    #[error(
        "joint \"{joint}\" has no way up to the hips, so there are several roots; make every bone a descendant of the hips"
    )]
    Roots {
        /// Name of the joint.
        joint: String,
    },
    /// A joint whose parent is another than in a body.
    #[error("the parent of joint \"{joint}\" is \"{parent}\", as in no body; check the names of both")]
    Chain {
        /// Name of the joint.
        joint: String,
        /// Name of its parent.
        parent: String,
    },
    /// A body that does not stand along an axis.
    #[error("from the hips to the head it points along {x:.2} {y:.2} {z:.2}, no axis; export it standing upright")]
    Leaning {
        /// From the hips to the head, along x (1).
        x: f32,
        /// The same direction, along y (1).
        y: f32,
        /// The same direction, along z (1).
        z: f32,
    },
    /// Left and right are swapped.
    #[error("the toes point backwards, so left and right are swapped; mirror the mesh or rename its bones")]
    Swapped,
    /// A height that is a person's in no unit of length.
    #[error(
        "it is {height} units tall, and no body is 0.5 to 2.6 m tall in metres, decimetres, centimetres or \
         millimetres; scale it to metres"
    )]
    Units {
        /// The height, in the file's units.
        height: f32,
    },
    /// A surface that is not closed.
    #[error(
        "the surface is open at {count} edges outside of the head, the first near \
         ({x:.2}, {y:.2}, {z:.2}) m; close the body, leave out its clothes, or allow holes"
    )]
    Hole {
        /// Open edges outside of the head.
        count: usize,
        /// Coordinate x of the place (m).
        x: f32,
        /// Coordinate y of the place (m).
        y: f32,
        /// Coordinate z of the place (m).
        z: f32,
    },
    /// A level of the body that is not on the mesh.
    #[error("no {level} can be found on the trunk; check that the mesh is a body and bound to the joints named for it")]
    Level {
        /// Name of the level, such as the waist.
        level: &'static str,
    },
    /// A target that the folder lacks.
    #[error("there is no target named {name}; name one of the folder's *.target.gz files")]
    NoTarget {
        /// Name of the target that was asked for.
        name: String,
    },
}

impl Flaw {
    pub(super) fn syntax(reason: impl Into<String>) -> Self {
        Self::Syntax { reason: reason.into() }
    }

    pub(crate) fn of(self, path: &std::path::Path) -> AvatarError {
        AvatarError { path: path.display().to_string(), flaw: self }
    }
}

impl From<String> for Flaw {
    fn from(reason: String) -> Self {
        Self::Syntax { reason }
    }
}
