//! A body that moves as an animation of its file says: our poses, and the file's own skin in f64 that they are held against.
//!
//! Our rest pose is the file's bind pose, so a joint's rotation from rest to world is the rotation of its skin matrix (the joint's
//! place in the scene times its inverse bind matrix), seen from our axes. Between two of our joints a file may have more, of a
//! spine for example: our joint is then turned on, by the shortest way, until its child lies in the direction in which the
//! file has it. What scales joints is left out: our bones are rigid.

use glam::{DMat4, DQuat, DVec3, Quat};

use super::ImportedBody;
use super::animation::GltfClip;
use super::error::Flaw;
use super::raw::{RawBody, RawInfluences};
use super::skinned::BoundJoints;
use crate::limits::STEP_HZ;
use crate::skeleton::{JOINTS, Joint, Pose, Skeleton};

/// The joint that each of ours is aimed at, where it has one; those with several children are not aimed.
const AIMS: [(Joint, Joint); 17] = [
    (Joint::Spine, Joint::Chest),
    (Joint::Chest, Joint::Neck),
    (Joint::Neck, Joint::Head),
    (Joint::LeftClavicle, Joint::LeftShoulder),
    (Joint::LeftShoulder, Joint::LeftElbow),
    (Joint::LeftElbow, Joint::LeftWrist),
    (Joint::RightClavicle, Joint::RightShoulder),
    (Joint::RightShoulder, Joint::RightElbow),
    (Joint::RightElbow, Joint::RightWrist),
    (Joint::LeftHip, Joint::LeftKnee),
    (Joint::LeftKnee, Joint::LeftAnkle),
    (Joint::RightHip, Joint::RightKnee),
    (Joint::RightKnee, Joint::RightAnkle),
    (Joint::LeftWrist, Joint::LeftHand),
    (Joint::RightWrist, Joint::RightHand),
    (Joint::LeftAnkle, Joint::LeftToe),
    (Joint::RightAnkle, Joint::RightToe),
];

/// An imported body with the motion of one animation.
#[derive(Debug)]
pub struct MovingBody {
    /// The body in its rest pose, and what was found in its file.
    pub imported: ImportedBody,
    /// Name of the animation.
    pub animation: String,
    /// Its length (s).
    pub seconds: f64,
    /// Its poses [`STEP_HZ`] times a second, from its beginning to its end.
    pub poses: Vec<Pose>,
    skin: MovingSkin,
}

/// The file's own skin in motion.
pub(super) struct MovingSkin {
    joints: BoundJoints,
    /// Joints and what is above them, parents first, as indices of the raw ones.
    order: Vec<usize>,
    parents: Vec<Option<usize>>,
    /// Which raw joint each of ours is.
    places: [Option<usize>; JOINTS],
    clip: GltfClip,
    /// From the file's space to ours.
    ours: DMat4,
    influences: Vec<RawInfluences>,
    rest: Vec<DVec3>,
}

impl std::fmt::Debug for MovingSkin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "MovingSkin({} vertices, {} s)", self.rest.len(), self.clip.seconds)
    }
}

impl MovingSkin {
    /// Of a raw body that stands in our axes and unit.
    pub fn new(raw: &RawBody, joints: BoundJoints, clip: GltfClip, ours: DMat4) -> Self {
        let parents: Vec<Option<usize>> = raw.joints.iter().map(|j| j.parent).collect();
        let depth = |mut k: usize| {
            let mut depth = 0;
            while let Some(parent) = parents[k] {
                (k, depth) = (parent, depth + 1);
            }
            depth
        };
        let mut order: Vec<usize> = (0..parents.len()).collect();
        order.sort_by_key(|k| depth(*k));
        Self {
            joints,
            order,
            parents,
            places: raw.reading.places,
            clip,
            ours,
            influences: raw.influences.clone(),
            rest: raw.positions.iter().map(|p| p.as_dvec3()).collect(),
        }
    }

    /// The skin matrices of all raw joints at a time (s), from rest to world in our axes and unit.
    fn matrices(&self, seconds: f64) -> Vec<DMat4> {
        let mut local: Vec<DMat4> = self.joints.of.iter().map(|n| self.joints.nodes.local(*n).as_dmat4()).collect();
        for (node, now) in self.clip.at(seconds) {
            if let Ok(k) = self.joints.of.binary_search(&node) {
                local[k] = now;
            }
        }
        let mut world = local.clone();
        for &k in &self.order {
            if let Some(parent) = self.parents[k] {
                world[k] = world[parent] * local[k];
            }
        }
        let back = self.ours.inverse();
        let skin = |(world, bound): (&DMat4, &glam::Mat4)| self.ours * *world * bound.as_dmat4().inverse() * back;
        world.iter().zip(&self.joints.bound).map(skin).collect()
    }

    /// Our pose at a time (s).
    fn pose(&self, skeleton: &Skeleton, seconds: f64) -> Pose {
        let matrices = self.matrices(seconds);
        let of = |joint: Joint| self.places[joint.index()].map(|k| &matrices[k]);
        let turn = |m: &DMat4| m.to_scale_rotation_translation().1.normalize();
        let place = |joint: Joint| of(joint).map(|m| m.transform_point3(skeleton.at(joint).as_dvec3()));
        let mut world = [DQuat::IDENTITY; JOINTS];
        let mut local = [Quat::IDENTITY; JOINTS];
        for joint in Joint::ALL {
            let above = joint.parent().map_or(DQuat::IDENTITY, |p| world[p.index()]);
            let mut now = of(joint).map_or(above, turn);
            let aim = AIMS.iter().find(|(from, _)| *from == joint).map(|(_, to)| *to);
            if let Some((child, from, to)) = aim.and_then(|to| Some((to, place(joint)?, place(to)?))) {
                let (have, want) = (now * skeleton.offset(child).as_dvec3(), to - from);
                if let (Some(have), Some(want)) = (have.try_normalize(), want.try_normalize()) {
                    now = (DQuat::from_rotation_arc(have, want) * now).normalize();
                }
            }
            world[joint.index()] = now;
            local[joint.index()] = (above.inverse() * now).normalize().as_quat();
        }
        let root = place(Joint::Pelvis).unwrap_or_default().as_vec3();
        Pose { root, local }
    }

    /// The file's own skin at a time (s).
    fn surface(&self, seconds: f64) -> Vec<DVec3> {
        let matrices = self.matrices(seconds);
        let vertex = |(p, influences): (&DVec3, &RawInfluences)| {
            let carried = influences.0.iter().filter(|(_, w)| *w > 0.0);
            carried.map(|(joint, w)| f64::from(*w) * matrices[usize::from(*joint)].transform_point3(*p)).sum()
        };
        self.rest.iter().zip(&self.influences).map(vertex).collect()
    }
}

impl MovingBody {
    pub(super) fn new(mut imported: ImportedBody, skin: MovingSkin) -> Result<Self, Flaw> {
        let (animation, seconds) = (skin.clip.name.clone(), skin.clip.seconds);
        let steps = (seconds * f64::from(STEP_HZ)).ceil() as u64;
        let poses: Vec<Pose> =
            (0..=steps).map(|k| skin.pose(&imported.body.skeleton, k as f64 / f64::from(STEP_HZ))).collect();
        if let Some(k) = poses.iter().position(|p| !p.root.is_finite() || p.local.iter().any(|q| !q.is_finite())) {
            let reason = format!("is not finite at {:.2} s; export it again", k as f64 / f64::from(STEP_HZ));
            return Err(Flaw::Animation { name: animation, reason });
        }
        if skin.clip.scales() {
            imported.report.notes.push(format!("animation {animation} scales joints, and our bones keep their length"));
        }
        Ok(Self { imported, animation, seconds, poses, skin })
    }

    /// The surface as the file itself skins it (all influences, linear blending, f64) at one of the poses, in the order of the
    /// body's vertices (m).
    pub fn surface(&self, pose: usize) -> Vec<DVec3> {
        self.skin.surface(pose as f64 / f64::from(STEP_HZ))
    }
}
