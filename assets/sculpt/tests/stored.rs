//! The bodies that `toile-assets` ships equal those of the drawings.

use toile_assets::body::stored::StoredBodies;

const SHIPPED: &[u8] = include_bytes!("../../data/body/base.bin");
const DRAWINGS: [&str; 2] = [include_str!("../data/female.toml"), include_str!("../data/male.toml")];

/// Farthest that a vertex may lie from where it is drawn here (m): libraries of elementary functions differ.
const ROUNDING: f32 = 2e-5;

#[test]
fn shipped_bodies_are_those_of_the_drawings() {
    let shipped = StoredBodies::decode(SHIPPED).expect("the shipped file is complete");
    let drawn = toile_sculpt::stored(DRAWINGS).expect("the drawings can be read");
    assert_eq!(drawn.quads, shipped.quads);
    assert_eq!(drawn.charts, shipped.charts);
    assert_eq!(drawn.regions, shipped.regions);
    assert_eq!(drawn.mirrors, shipped.mirrors);
    assert_eq!(drawn.corners, shipped.corners);
    for (drawn, shipped) in drawn.positions.iter().zip(&shipped.positions) {
        let off = drawn.iter().zip(shipped).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(off < ROUNDING, "{off} m: store the bodies again with `cargo run --release -p toile-sculpt`");
    }
    for (drawn, shipped) in drawn.skeletons.iter().zip(&shipped.skeletons) {
        let off = drawn.rest.iter().zip(&shipped.rest).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(off < ROUNDING, "{off} m");
    }
    let off = drawn.uvs.iter().zip(&shipped.uvs).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(drawn.uvs.len() == shipped.uvs.len() && off < 1e-3, "the atlas is off by {off} of its side");
}
