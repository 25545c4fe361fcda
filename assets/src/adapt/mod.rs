//! Adapting: meshes that others made become garments that hold.
//!
//! In this order: the unit is recognised by whether a body stands in the mesh ([`mod@unit`]); the mesh becomes surfaces of one layer
//! ([`repair`], [`surface`], [`shells`], [`hems`]); the body that it is made for is found ([`made_for`]); and for each shopper it
//! is laid on them ([`place`], [`lay`]), held where it lies on the skin ([`hold`]), and each piece judged ([`judge`]); what comes of it is
//! baked ([`dress`]).

pub mod dress;
mod error;
pub mod file_order;
pub mod grading;
pub mod hems;
pub mod hold;
pub mod judge;
pub mod lay;
pub mod layers;
pub mod made_for;
pub mod measures;
pub mod mesh;
pub mod own_mesh;
pub mod paint;
pub mod place;
pub mod repair;
pub mod report;
mod sets;
pub mod shells;
pub mod source;
pub mod surface;
pub mod unit;
pub mod wear;

pub use error::AdaptError;
pub use file_order::FileOrder;
pub use own_mesh::OwnMesh;
pub use report::{MeshReport, PieceReport, Repair};
