//! A body from its silhouettes: the parametric body posed and shaped until its outlines are those that calibrated cameras saw.

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
