//! Cases of cloths over one another: in the wrong order, and thrown at each other.

use glam::{Quat, Vec2, Vec3};
use toile_bake::check::MeshError;

use super::layer_trial::LayerTrial;
use super::outcome::TrialFindings;
use super::piece::CELL_M;
use super::pieces::Pieces;
use crate::random::CaseRandom;

/// Columns and rows of a sheet.
pub(super) const SHEET: [usize; 2] = [14, 14];

/// Half the side of a sheet (m).
pub(super) const HALF_M: f32 = 0.5 * 13.0 * CELL_M;

/// Time until they are in order again (s).
const ORDER_S: f32 = 0.5;

/// Height of the lowest sheet (m), and from one to the next where all is in order.
const HEIGHTS_M: [f32; 2] = [0.015, 0.003];

/// How deep a sheet is at most inside of the one that it is worn over (m).
const INSIDE_M: f32 = 0.01;

/// Places in which it is.
const PLACES: usize = 4;

/// How far such a place reaches (m), at least and at most.
const PLACE_M: [f32; 2] = [0.03, 0.15];

/// How fast sheets are thrown, of the engine's speed limit (1), at least and at most.
const THROWN: [f32; 2] = [0.1, 0.45];

/// Time after which those that were thrown at each other are looked at (s).
const THROWN_S: f32 = 1.0;

/// A place in which a sheet is lowered.
struct Dent {
    at: Vec2,
    reach: f32,
    depth: f32,
}

impl Dent {
    /// Where the next sheet is so far below its own place that it is inside.
    fn random(random: &mut CaseRandom) -> Self {
        let at = Vec2::new(random.between(-HALF_M, HALF_M), random.between(-HALF_M, HALF_M));
        let depth = HEIGHTS_M[1] + random.between(0.0, INSIDE_M);
        Self { at, reach: random.between(PLACE_M[0], PLACE_M[1]), depth }
    }

    fn depth(&self, p: Vec3) -> f32 {
        let far = Vec2::new(p.x, p.z).distance(self.at) / self.reach;
        self.depth * (-far * far).exp()
    }
}

/// Two sheets or three on a floor, each in places up to 10 mm inside of the one that it is worn over.
pub(super) fn layers(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let sheets = 2 + (seed % 2) as usize;
    let dents: Vec<Vec<Dent>> = (0..sheets).map(|_| (0..PLACES).map(|_| Dent::random(random)).collect()).collect();
    let turns: Vec<Quat> = (0..sheets).map(|_| Quat::from_rotation_y(random.between(-0.8, 0.8))).collect();
    let place = |sheet: usize, p: Vec3| {
        let p = turns[sheet] * p;
        let dented = dents[sheet].iter().map(|dent| dent.depth(p)).fold(0.0, f32::max);
        // The lowest is flat, and each one above is dented from where the one below is.
        let below: f32 = (1..sheet).map(|s| dents[s].iter().map(|dent| dent.depth(p)).fold(0.0, f32::max)).sum();
        let lowered = if sheet == 0 { 0.0 } else { dented + below };
        (p + Vec3::Y * (HEIGHTS_M[0] + HEIGHTS_M[1] * sheet as f32 - lowered), Vec3::ZERO)
    };
    found(LayerTrial::new(sheets, SHEET, &pieces.settings, place), ORDER_S)
}

/// Two sheets or three, a hand apart, thrown at each other askew.
pub(super) fn thrown(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let sheets = 2 + (seed % 2) as usize;
    let askew: Vec<Quat> = (0..sheets)
        .map(|_| {
            let tilt = random.between(-0.5, 0.5);
            Quat::from_rotation_y(random.between(-0.8, 0.8)) * Quat::from_rotation_z(tilt)
        })
        .collect();
    let most = pieces.settings.max_speed;
    let speed = most * random.between(THROWN[0], THROWN[1]);
    let middle = 0.5 * (sheets - 1) as f32;
    let place = |sheet: usize, p: Vec3| {
        let up = sheet as f32 - middle;
        (askew[sheet] * p + Vec3::Y * (0.4 + 0.2 * up), Vec3::NEG_Y * speed * up.signum() * up.abs().ceil())
    };
    found(LayerTrial::new(sheets, SHEET, &pieces.settings, place), THROWN_S)
}

/// What a trial came to, where it could be made.
pub(super) fn found(trial: Result<LayerTrial, MeshError>, seconds: f32) -> TrialFindings {
    match trial {
        Ok(trial) => trial.back_in_order(seconds),
        Err(error) => TrialFindings { miss: Some(error.to_string()), ..TrialFindings::default() },
    }
}
