//! The base bodies as they are drawn: a form in sections, a grid laid on it, and the grid's texture atlas.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod form;
mod subdivide;

mod lattice;
mod wrap;

pub mod draw;

pub mod unwrap;

pub use draw::{Drawn, draw};
pub use unwrap::unwrap;

use toile_assets::body::stored::StoredBodies;

/// Draws a woman and a man from the texts of their drawings, and puts both with one atlas into what is stored.
///
/// # Errors
/// A drawing that is no TOML or lacks a part.
///
/// # Panics
/// If the two drawings do not give the same grid.
pub fn stored(drawings: [&str; 2]) -> Result<StoredBodies, toml::de::Error> {
    let bodies = [draw(drawings[0])?, draw(drawings[1])?];
    let (uvs, corners) = unwrap(&bodies);
    let [woman, man] = bodies;
    assert_eq!(woman.quads, man.quads, "both bodies have one grid");
    let charts = woman.charts.iter().map(|c| c.number()).collect();
    Ok(StoredBodies {
        positions: [woman.positions, man.positions],
        skeletons: [woman.skeleton, man.skeleton],
        quads: woman.quads,
        uvs,
        corners,
        charts,
        regions: woman.regions,
        mirrors: woman.mirrors,
    })
}
