//! What can be wrong with an imported body: one sentence each, which names the element and the cure.

use crate::limits::{MAX_BODY_BYTES, MAX_BODY_VERTICES};

/// Why a file does not become a body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{path}: {flaw}")]
pub struct AvatarError {
    /// The file or folder.
    pub path: String,
    /// What is wrong with it.
    pub flaw: Flaw,
}

/// What is wrong, to stand behind the file's name.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each message says what its fields are")]
pub enum Flaw {
    #[error("it cannot be read ({reason}); give the path of a readable file")]
    Read { reason: String },
    #[error("it has {bytes} bytes, more than the {MAX_BODY_BYTES} that are read; reduce its mesh and its pictures")]
    TooLarge { bytes: u64 },
    /// The text or the structure of the file; the reason holds the cure.
    #[error("{reason}")]
    Syntax { reason: String },
    #[error("it has no mesh that hangs on a skeleton; export the body with its armature, skinning included")]
    NoSkin,
    #[error("it has no mesh named {name}, only {known}; name one of these, or none to take them all")]
    NoMesh { name: String, known: String },
    #[error("it has {count} vertices, and a body has 4 to {MAX_BODY_VERTICES}; export a mesh of that size")]
    Vertices { count: usize },
    #[error("{what} {index} is not finite; mend the mesh where it was made and export it again")]
    NotFinite { what: &'static str, index: usize },
    #[error("vertex {vertex} hangs on joint {joint}, but the skin has {joints}; bind the mesh to its armature again")]
    JointRange { vertex: usize, joint: u32, joints: usize },
    #[error("the weights of vertex {vertex} sum to {sum} instead of 1; normalise all weights before exporting")]
    WeightSum { vertex: usize, sum: f32 },
    #[error("vertex {vertex} has the weight {weight}; weights lie between 0 and 1, so normalise them")]
    Weight { vertex: usize, weight: f32 },
    #[error("node \"{node}\" is below itself; make the armature a tree and export it again")]
    Cycle { node: String },
    #[error("node \"{node}\" hangs from two parents; make the armature a tree and export it again")]
    TwoParents { node: String },
    #[error("node \"{node}\" is mirrored by a negative scale; apply scales to the armature before exporting")]
    Mirrored { node: String },
    #[error("node \"{node}\" is scaled to nothing; apply scales to the armature before exporting")]
    Flat { node: String },
    #[error("the inverse bind matrix of joint \"{joint}\" cannot be used; bind the mesh to its armature again")]
    InverseBind { joint: String },
    #[error(
        "no joint was found for {missing} (the names are most like those of {dialect}); name the bones as H-Anim, VRM, \
         Mixamo, Unreal or CMU do, or mark them as a VRM humanoid"
    )]
    Missing { missing: String, dialect: &'static str },
    #[error("joint \"{joint}\" has no way up to the hips, so there are several roots; hang every bone below the hips")]
    Roots { joint: String },
    #[error("joint \"{joint}\" hangs from \"{parent}\", where no body has it; check the names of both")]
    Chain { joint: String, parent: String },
    #[error("from the hips to the head it points along {x:.2} {y:.2} {z:.2}, no axis; export it standing upright")]
    Leaning { x: f32, y: f32, z: f32 },
    #[error("the toes point backwards, so left and right are swapped; mirror the mesh or rename its bones")]
    Swapped,
    #[error(
        "it is {height} units tall, and no body is 0.5 to 2.6 m tall in metres, decimetres, centimetres or \
         millimetres; scale it to metres"
    )]
    Units { height: f32 },
    #[error(
        "the surface is open at {count} edges outside of the head, the first between vertices {a} and {b} near \
         ({x:.2}, {y:.2}, {z:.2}) m; close the body, leave out its clothes, or allow holes"
    )]
    Hole { count: usize, a: u32, b: u32, x: f32, y: f32, z: f32 },
    #[error("no {level} can be found on the trunk; check that the mesh is a body and hangs on the joints named for it")]
    Level { level: &'static str },
    #[error("there is no target named {name}; name one of the folder's *.target.gz files")]
    NoTarget { name: String },
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
