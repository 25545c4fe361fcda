//! Joints and shape from depth alone: the parametric body fitted to the shopper's surface, frame after frame.
//!
//! Analysis by synthesis with point-to-surface residuals and a Gauss-Newton step over pose and shape together; the
//! shape is accumulated over the frames, with the population (ANSUR II) as its prior.

mod body_fit;
mod closer_look;
mod correspondence;
mod depth_cells;
mod initial_pose;
mod joint_angles;
pub mod measuring;
#[expect(clippy::needless_range_loop, reason = "matrices are read by row and column")]
mod normal_equations;
mod options;
mod path;
mod posed_body;
mod residuals;
mod rim;
mod seen_surface;
#[expect(clippy::needless_range_loop, reason = "matrices are read by row and column")]
mod shape_filter;
pub mod tracker;

pub use body_fit::{BodyFit, FitTimes, FittedFrame};
pub use closer_look::CLOSED;
pub use initial_pose::{ARMS, ArmPose, of_stature, set_arm};
pub use joint_angles::JointAngle;
pub use normal_equations::{NormalEquations, ShapeQuadratic};
pub use options::{FitOptions, Stance};
pub use posed_body::{BodyModel, FitState, JacobianRow, PosedBody, SurfaceSample, UNKNOWNS};
pub use residuals::{PosePrior, add_priors, limit_step};
pub use seen_surface::SeenSurface;
pub use shape_filter::ShapeFilter;
