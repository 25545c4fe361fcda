//! Cases of meshes with sides without length and faces without area.

use glam::Vec3;
use toile_assets::bake::bake;
use toile_assets::garment::{MeshError, Shape};

use super::Site;
use super::found::Found;
use super::piece::{PATCH, Piece, denim, sheet};
use super::random::Random;
use super::start::swung;
use super::trial::Trial;

/// What is wrong with the mesh, seed after seed.
const FLAWS: u64 = 7;

/// Smallest height of a face whose base is 2 cm that the bake takes (m): its least area is 1e-8 m2.
const SLIVER_M: f32 = 1.5e-6;

/// Every second seed or so has a flaw that the bake must refuse; the others are baked and have to hang as they should.
pub(super) fn bad_elements(site: &Site, random: &mut Random, seed: u64) -> Found {
    let mut shape = sheet(PATCH);
    let [columns, rows] = PATCH;
    let face = random.below(shape.faces.len());
    let [a, b, c, d] = shape.faces[face].map(|v| v as usize);
    match seed % FLAWS {
        0 => shape.cut[b] = shape.cut[a],
        1 => shape.cut[b] = shape.cut[a].midpoint(shape.cut[c]),
        2 => shape.faces[face][1] = shape.faces[face][0],
        3 => shape.worn[b] = shape.worn[a],
        4 => [b, c, d].into_iter().filter(|v| *v >= columns).for_each(|v| shape.worn[v] = shape.worn[a]),
        5 => {
            let row = 1 + random.below(rows - 1);
            let fixed = columns * row..columns * (row + 1);
            fixed.for_each(|v| shape.worn[v] = shape.worn[v - columns]);
        }
        _ => {
            // Two columns as close to each other as the bake takes.
            let column = 1 + random.below(columns - 1);
            let near = |p: Vec3| Vec3::new(p.x + SLIVER_M, p.y, p.z);
            for v in (0..rows).map(|row| row * columns + column) {
                shape.cut[v] = near(shape.cut[v - 1]);
                shape.worn[v] = shape.cut[v];
            }
        }
    }
    if seed % FLAWS < 3 { refused(&shape, face) } else { survived(site, &shape, random) }
}

/// A mesh that must not become a garment.
fn refused(shape: &Shape, face: usize) -> Found {
    match bake("torture", "one", shape, &denim()) {
        Err(error @ MeshError::Degenerate { .. }) => Found { note: error.to_string(), ..Found::default() },
        Err(error) => Found { miss: Some(format!("refused for another reason: {error}")), ..Found::default() },
        Ok(_) => Found { miss: Some(format!("face {face} was baked")), ..Found::default() },
    }
}

/// A mesh that can be baked, and must then hang.
fn survived(site: &Site, shape: &Shape, random: &mut Random) -> Found {
    let piece = match Piece::new(shape, &denim(), &site.settings) {
        Ok(piece) => piece,
        Err(error) => return Found { miss: Some(error.to_string()), ..Found::default() },
    };
    // What is only worn badly starts so and unfolds to where the same cut always hangs; a bad cut is swung besides.
    let same_cut = shape.cut == sheet(PATCH).cut;
    let trial = if same_cut {
        Trial::new(site, &piece.garment, &site.settings)
    } else {
        swung(site, &piece, &site.settings, random)
    };
    Found::back(trial, if same_cut { &site.patch.rest } else { &piece.rest })
}
