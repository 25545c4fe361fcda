//! Cases of meshes with sides without length and faces without area.

use glam::Vec3;
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::check::MeshError;

use super::outcome::TrialFindings;
use super::piece::{PATCH, Piece, denim, sheet};
use super::pieces::Pieces;
use super::start::swung;
use super::trial::Trial;
use crate::random::CaseRandom;

/// What is wrong with the mesh, seed after seed.
const FLAWS: u64 = 7;

/// Smallest height of a face whose base is 2 cm that the bake takes (m): its least area is 1e-8 m2.
const SLIVER_M: f32 = 1.5e-6;

/// Every second seed or so has a flaw that the bake must refuse; the others are baked and have to hang as they should.
pub(super) fn bad_elements(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
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
    if seed % FLAWS < 3 { refused(&shape, face) } else { survived(pieces, &shape, random) }
}

/// A mesh that must not become a garment.
fn refused(shape: &Shape, face: usize) -> TrialFindings {
    match bake("torture", "one", shape, &denim()) {
        Err(error @ MeshError::Degenerate { .. }) => {
            TrialFindings { note: error.to_string(), ..TrialFindings::default() }
        }
        Err(error) => {
            TrialFindings { miss: Some(format!("refused for another reason: {error}")), ..TrialFindings::default() }
        }
        Ok(_) => TrialFindings { miss: Some(format!("face {face} was baked")), ..TrialFindings::default() },
    }
}

/// A mesh that can be baked, and must then hang.
fn survived(pieces: &Pieces, shape: &Shape, random: &mut CaseRandom) -> TrialFindings {
    let piece = match Piece::new(shape, &denim(), &pieces.settings) {
        Ok(piece) => piece,
        Err(error) => return TrialFindings { miss: Some(error.to_string()), ..TrialFindings::default() },
    };
    // What is only worn badly starts so and unfolds to where the same cut always hangs; a bad cut is swung besides.
    let same_cut = shape.cut == sheet(PATCH).cut;
    let trial = if same_cut {
        Trial::new(pieces, &piece.garment, &pieces.settings)
    } else {
        swung(pieces, &piece, &pieces.settings, random)
    };
    TrialFindings::back(trial, if same_cut { &pieces.patch.rest } else { &piece.rest })
}
