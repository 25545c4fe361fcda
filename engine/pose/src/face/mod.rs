//! A head from photographs with marked points: the mannequin's head adapted by radial functions, its picture, and its motion.
//!
//! The difference from the mannequin's head is a field of displacements d(x) with a prior: smooth (a compact radial function), nearly the
//! same on both sides, and with an affine part. The marked points are its observations, each two equations in one photograph, and so are
//! stretches of the head's outline, one equation each; the most likely field is a sum of radial functions around them (Roussel and
//! Gagalowicz 2003 adapt through points in space; with the prior one photograph will do). Pose and field are found in turn. An expression
//! is a field as well, with an amplitude that each frame has of its own.

mod landmarks;
mod prior;
mod unfit;

mod view;

mod head_mesh;
mod sighting;

mod head_pose;
mod outline;

mod adapt;
mod expressions;

mod track;

mod sequence;

mod obj;
mod texture;

pub use adapt::{AdaptedHead, adapt};
pub use expressions::{EXPRESSIONS, ExpressionFields};
pub use landmarks::{FaceLandmarks, SurfacePoint};
pub use obj::{mtl, obj};
pub use sequence::{TrackedSequence, follow};
pub use texture::{HeadTexture, png, texture};
pub use track::{TrackedFrame, TrackedHead, track};
pub use unfit::UnfitFace;
pub use view::{FaceView, assumed_camera};

#[cfg(test)]
mod outline_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod track_tests;
