//! Garments as the engine steps them: particles, constraints in memory order, what is skinned, how the cloth is shown.

mod baked;
pub mod bend_friction;
pub mod bytes;
mod check;
mod data;
pub mod direction;
pub mod gather;
pub mod layout;
pub mod link_curves;
pub mod look;
pub mod part;
pub mod solver;
pub mod trim;
pub mod tuck;

#[cfg(test)]
mod tests;

pub use baked::Garment;
pub use bytes::BytesError;
pub use check::LayoutError;
pub use data::GarmentData;
pub use direction::Direction;
pub use layout::Layout;
pub use look::GarmentAppearance;
pub use part::Part;
pub use solver::Solver;
pub use tuck::Tuck;
