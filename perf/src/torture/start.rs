//! Cases of a cloth that starts where no cloth can be, or is stepped as no cloth should be.

use glam::{Quat, Vec3};
use toile_engine::cloth::{Quality, Settings};

use super::outcome::TrialFindings;
use super::piece::{CURTAIN, Piece, TOP};
use super::pieces::Pieces;
use super::trial::Trial;
use crate::random::CaseRandom;

/// The middle of the curtain (m).
pub(super) const MIDDLE: Vec3 = Vec3::new(0.0, TOP.y - 0.23, 0.0);

/// Half of the side of the box that vertices are strewn in (m).
const BOX_M: f32 = 0.5;

/// How many times a cloth is stretched.
const STRETCH: f32 = 5.0;

/// Fastest push of what swings (m/s).
const PUSH_M_S: f32 = 3.0;

/// How far nothing is from where it is meant to be (m). What lies exactly in the plane that it hangs in could leave it to
/// either side as well and so, by symmetry, never does: an equilibrium, but not one that anything real is found in.
pub(super) const TREMBLE_M: f32 = 1e-5;

/// Puts the curtain's free particles elsewhere, at rest, and lets go.
fn from(pieces: &Pieces, random: &mut CaseRandom, mut to: impl FnMut(usize, Vec3) -> Vec3) -> TrialFindings {
    let mut trial = Trial::new(pieces, &pieces.curtain.garment, &pieces.settings);
    trial.disturb(|i, p| (to(i, p) + random.point() * TREMBLE_M, Vec3::ZERO));
    TrialFindings::back(trial, &pieces.curtain.rest)
}

pub(super) fn random_box(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let mut strewn = random.clone();
    from(pieces, random, |_, _| MIDDLE + strewn.point() * BOX_M)
}

/// The same with lawn.
pub(super) fn crumpled(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let mut trial = Trial::new(pieces, &pieces.lawn.garment, &pieces.settings);
    trial.disturb(|_, _| (MIDDLE + random.point() * BOX_M, Vec3::ZERO));
    TrialFindings::back_anywhere(trial, &pieces.lawn.rest)
}

/// Into a plane through the middle: what stands across it is gone.
pub(super) fn flattened(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let across = random.direction();
    from(pieces, random, |_, p| p - across * across.dot(p - MIDDLE))
}

pub(super) fn inverted(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let across = random.direction();
    from(pieces, random, |_, p| p - 2.0 * across * across.dot(p - MIDDLE))
}

/// Along one direction or, every second seed, along all.
pub(super) fn stretched(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let along = random.direction();
    let grown = |d: Vec3| if seed.is_multiple_of(2) { along * along.dot(d) } else { d };
    from(pieces, random, |_, p| p + grown(p - TOP) * (STRETCH - 1.0))
}

/// A warp fiber or a weft fiber, at the place of one of its particles.
pub(super) fn collapsed_fiber(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let [columns, rows] = CURTAIN;
    let warp = seed.is_multiple_of(2);
    // Row 0 is held.
    let fiber = if warp { random.below(columns) } else { 1 + random.below(rows - 1) };
    let to =
        if warp { (1 + random.below(rows - 1)) * columns + fiber } else { fiber * columns + random.below(columns) };
    let place = pieces.curtain.garment.start[pieces.curtain.particles()[to]];
    let source = &pieces.curtain.garment.source;
    from(pieces, random, |i, p| {
        let v = source[i] as usize;
        let of = if warp { v % columns } else { v / columns };
        if of == fiber { place } else { p }
    })
}

pub(super) fn collapsed_cloth(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let place = MIDDLE + random.point() * BOX_M;
    from(pieces, random, |_, _| place)
}

/// A cloth that hangs askew, turned about its upper edge, each particle pushed another way.
pub(super) fn swung<'a>(pieces: &Pieces, piece: &'a Piece, settings: &Settings, random: &mut CaseRandom) -> Trial<'a> {
    let turn = Quat::from_axis_angle(Vec3::X, random.between(-1.5, 1.5));
    let mut trial = Trial::new(pieces, &piece.garment, settings);
    trial.disturb(|_, p| (TOP + turn * (p - TOP), random.direction() * random.between(0.0, PUSH_M_S)));
    trial
}

/// As many substeps as ever in a step four times as long.
pub(super) fn long_step(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let piece = &pieces.curtain;
    let substeps = pieces.settings.quality.substeps(piece.garment.substeps);
    let step_seconds = pieces.settings.step_seconds * 4.0;
    let settings = Settings { step_seconds, substeps: Some(substeps), ..pieces.settings };
    TrialFindings::back(swung(pieces, piece, &settings, random), &piece.rest)
}

pub(super) fn one_iteration(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let settings = Settings { quality: Quality::Draft, substeps: Some(1), ..pieces.settings };
    TrialFindings::back(swung(pieces, &pieces.curtain, &settings, random), &pieces.curtain.rest)
}
