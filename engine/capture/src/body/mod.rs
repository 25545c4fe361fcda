//! A body from its silhouettes: the parametric body posed and shaped until its outlines are those that calibrated cameras saw.
//!
//! Reads: masks with their cameras, joints where there are some. Writes: measures with their errors, a body, a pose; in later frames
//! the pose alone.
//! Budget: offline; some seconds a person and sex, some tenths of a second for each later frame.
//! Thread: the caller's.

mod distance_field;
mod fit;
mod follow;
mod hull;
mod joint_point;
mod measured;
mod outline;
mod overlay;
mod rim;
mod start;
mod view;

pub use follow::{BodyFollower, FollowedFrame};
pub use joint_point::{JointPoint, joint_points};
pub use measured::{SilhouetteBody, SilhouetteOptions, SilhouetteView, measure};
pub use overlay::overlay_png;

#[cfg(test)]
mod tests;
