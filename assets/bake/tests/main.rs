//! Garments are put together only where their constraints hold, and come back from their bytes as they were.

mod bytes;
mod layout;

use glam::Vec3;
use toile_bake::{Shape, bake};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;

/// A hanging cloth of 12 by 12 particles, 2 cm apart.
fn cloth() -> Garment {
    let place = |row, column| (Vec3::new(column as f32 * 0.02, 1.0 - row as f32 * 0.02, 0.0), row == 0);
    bake("cloth", "one", &Shape::sheet(12, 12, place), &Fabric::cotton_lawn()).unwrap()
}
