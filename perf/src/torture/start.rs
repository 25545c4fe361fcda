//! Cases of a cloth that starts where no cloth can be, or is stepped as no cloth should be.

use glam::{Quat, Vec3};
use toile_engine::cloth::{Quality, Settings};

use super::Site;
use super::found::Found;
use super::piece::{CURTAIN, Piece, TOP};
use super::random::Random;
use super::trial::Trial;

/// The middle of the curtain (m).
const MIDDLE: Vec3 = Vec3::new(0.0, TOP.y - 0.23, 0.0);

/// Half of the side of the box that vertices are strewn in (m).
const BOX_M: f32 = 0.5;

/// How many times a cloth is stretched.
const STRETCH: f32 = 5.0;

/// Fastest push of what swings (m/s).
const PUSH_M_S: f32 = 3.0;

/// How far nothing is from where it is meant to be (m). What lies exactly in the plane that it hangs in could leave it to
/// either side as well and so, by symmetry, never does: an equilibrium, but not one that anything real is found in.
const TREMBLE_M: f32 = 1e-5;

/// Puts the curtain's free particles elsewhere, at rest, and lets go.
fn from(site: &Site, random: &mut Random, mut to: impl FnMut(usize, Vec3) -> Vec3) -> Found {
    let mut trial = Trial::new(site, &site.curtain.garment, &site.settings);
    trial.disturb(|i, p| (to(i, p) + random.point() * TREMBLE_M, Vec3::ZERO));
    Found::back(trial, &site.curtain.rest)
}

pub(super) fn random_box(site: &Site, random: &mut Random, _: u64) -> Found {
    let mut strewn = random.clone();
    from(site, random, |_, _| MIDDLE + strewn.point() * BOX_M)
}

/// The same with lawn.
pub(super) fn crumpled(site: &Site, random: &mut Random, _: u64) -> Found {
    let mut trial = Trial::new(site, &site.lawn.garment, &site.settings);
    trial.disturb(|_, _| (MIDDLE + random.point() * BOX_M, Vec3::ZERO));
    Found::back_anywhere(trial, &site.lawn.rest)
}

/// Into a plane through the middle: what stands across it is gone.
pub(super) fn flattened(site: &Site, random: &mut Random, _: u64) -> Found {
    let across = random.direction();
    from(site, random, |_, p| p - across * across.dot(p - MIDDLE))
}

pub(super) fn inverted(site: &Site, random: &mut Random, _: u64) -> Found {
    let across = random.direction();
    from(site, random, |_, p| p - 2.0 * across * across.dot(p - MIDDLE))
}

/// Along one direction or, every second seed, along all.
pub(super) fn stretched(site: &Site, random: &mut Random, seed: u64) -> Found {
    let along = random.direction();
    let grown = |d: Vec3| if seed.is_multiple_of(2) { along * along.dot(d) } else { d };
    from(site, random, |_, p| p + grown(p - TOP) * (STRETCH - 1.0))
}

/// A warp fiber or a weft fiber, at the place of one of its particles.
pub(super) fn collapsed_fiber(site: &Site, random: &mut Random, seed: u64) -> Found {
    let [columns, rows] = CURTAIN;
    let warp = seed.is_multiple_of(2);
    // Row 0 is held.
    let fiber = if warp { random.below(columns) } else { 1 + random.below(rows - 1) };
    let to =
        if warp { (1 + random.below(rows - 1)) * columns + fiber } else { fiber * columns + random.below(columns) };
    let place = site.curtain.garment.start[site.curtain.particles()[to]];
    let source = &site.curtain.garment.source;
    from(site, random, |i, p| {
        let v = source[i] as usize;
        let of = if warp { v % columns } else { v / columns };
        if of == fiber { place } else { p }
    })
}

pub(super) fn collapsed_cloth(site: &Site, random: &mut Random, _: u64) -> Found {
    let place = MIDDLE + random.point() * BOX_M;
    from(site, random, |_, _| place)
}

/// A cloth that hangs askew, turned about its upper edge, each particle pushed another way.
pub(super) fn swung<'a>(site: &Site, piece: &'a Piece, settings: &Settings, random: &mut Random) -> Trial<'a> {
    let turn = Quat::from_axis_angle(Vec3::X, random.between(-1.5, 1.5));
    let mut trial = Trial::new(site, &piece.garment, settings);
    trial.disturb(|_, p| (TOP + turn * (p - TOP), random.direction() * random.between(0.0, PUSH_M_S)));
    trial
}

/// As many substeps as ever in a step four times as long.
pub(super) fn long_step(site: &Site, random: &mut Random, _: u64) -> Found {
    let piece = &site.curtain;
    let substeps = site.settings.quality.substeps(piece.garment.substeps);
    let step_seconds = site.settings.step_seconds * 4.0;
    let settings = Settings { step_seconds, substeps: Some(substeps), ..site.settings };
    Found::back(swung(site, piece, &settings, random), &piece.rest)
}

pub(super) fn one_iteration(site: &Site, random: &mut Random, _: u64) -> Found {
    let settings = Settings { quality: Quality::Draft, substeps: Some(1), ..site.settings };
    Found::back(swung(site, &site.curtain, &settings, random), &site.curtain.rest)
}
