//! Forces: what changes velocities besides links and contact, namely bending and its friction, wind, gravity, the root's motion.

pub mod bend_friction;
pub mod bending;
pub mod bending_matrix;
pub mod friction_rows;
pub mod predict;
pub mod root;
pub mod stiff_bending;
pub mod wind;
