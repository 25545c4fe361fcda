//! Cases of a cloth that meets itself: drawn through itself, and crushed.

use std::f32::consts::{FRAC_PI_3, PI};

use glam::{Quat, Vec2, Vec3, Vec4};

use super::layer_trial::LayerTrial;
use super::layered::{HALF_M, SHEET, found};
use super::outcome::TrialFindings;
use super::piece::{CELL_M, CURTAIN, TOP};
use super::pieces::Pieces;
use super::start::{MIDDLE, TREMBLE_M};
use super::trial::Trial;
use crate::random::CaseRandom;

/// In which a cloth has to be out of itself (s).
const FREE_S: f32 = 2.0;

/// How far a part reaches through the rest, at least and at most (m).
const THROUGH_M: [f32; 2] = [0.005, 0.03];

/// Radius of the bend before it (m).
const BEND_M: [f32; 2] = [0.012, 0.025];

/// By how much more than half a turn the part is bent (rad).
const STEEP: [f32; 2] = [0.5, 1.2];

/// Radius of the ball that a cloth starts crushed in, at least and at most (m).
const BALL_M: [f32; 2] = [0.03, 0.08];

/// Half of what the walls leave (m), at least and at most.
const GAP_M: [f32; 2] = [0.02, 0.05];

/// How far above the floor a sheet starts (m).
const FALLS_M: f32 = 0.06;

/// Radius of the spheres that crush (m): as good as walls for a cloth of half a metre.
const WALL_M: f32 = 1.0;

/// How far the walls are away (m) before and after.
const AWAY_M: f32 = 0.4;

/// How fast each moves (m/s).
const WALLS_M_S: f32 = 0.5;

/// Steps for which it stays crushed.
const CRUSHED_STEPS: usize = 60;

/// A bend that goes on until the cloth passes through itself.
struct ThroughItself {
    /// Where it begins (m), and which way it goes from there: in the plane of the cloth.
    begin: Vec2,
    way: Vec2,
    radius: f32,
    /// How far it is bent (rad).
    turn: f32,
    /// To which side: 1 or -1.
    side: f32,
}

impl ThroughItself {
    /// A corner of a cloth, or its lower edge, so far through what is above it; `low` is the lower right corner (m).
    fn random(random: &mut CaseRandom, low: Vec2, side: f32) -> Self {
        let askew = random.between(-FRAC_PI_3, FRAC_PI_3);
        let way = Vec2::new(askew.sin(), -askew.cos());
        let [radius, steep, through] = [BEND_M, STEEP, THROUGH_M].map(|[low, high]| random.between(low, high));
        // The bend ends at this height over the cloth, from where the way is straight.
        let height = radius * (1.0 + steep.cos());
        let length = radius * (PI + steep) + (height + through) / steep.sin();
        let tip = Vec2::new(low.x * way.x.signum(), low.y);
        Self { begin: tip - way * length, way, radius, turn: PI + steep, side }
    }

    /// Where a point of the flat cloth comes to be.
    fn bent(&self, p: Vec3) -> Vec3 {
        let along = (p.truncate() - self.begin).dot(self.way);
        if along <= 0.0 {
            return p;
        }
        let angle = (along / self.radius).min(self.turn);
        let (sin, cos) = angle.sin_cos();
        let straight = along - angle * self.radius;
        let forward = self.radius * sin + straight * cos;
        let up = self.radius * (1.0 - cos) + straight * sin;
        (p.truncate() + self.way * (forward - along)).extend(p.z + self.side * up)
    }
}

/// The curtain hangs with a corner, or its lower edge, drawn through itself; every second seed a sheet falls on the floor so, where
/// no weight draws it out.
pub(super) fn crossing(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    if seed % 2 == 1 {
        return fallen(pieces, random);
    }
    let [columns, rows] = CURTAIN.map(|count| (count - 1) as f32 * CELL_M);
    let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let through = ThroughItself::random(random, Vec2::new(0.5 * columns, TOP.y - rows), side);
    let mut trial = Trial::new(pieces, &pieces.curtain.garment, &pieces.settings).with_folds();
    trial.disturb(|_, p| (through.bent(p) + random.point() * TREMBLE_M, Vec3::ZERO));
    uncrossed(trial, pieces)
}

/// A sheet that lies a hand above the floor, a part of it drawn through the rest from above.
fn fallen(pieces: &Pieces, random: &mut CaseRandom) -> TrialFindings {
    let through = ThroughItself::random(random, Vec2::new(HALF_M, -HALF_M), 1.0);
    let place = |_: usize, p: Vec3| {
        let bent = through.bent(Vec3::new(p.x, -p.z, 0.0));
        (Vec3::new(bent.x, FALLS_M + bent.z, -bent.y) + random.point() * TREMBLE_M, Vec3::ZERO)
    };
    found(LayerTrial::new(1, SHEET, &pieces.settings, place), FREE_S)
}

/// The curtain is in a ball, every vertex anywhere or, every second seed, drawn together and shaken.
pub(super) fn ball(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let mut trial = Trial::new(pieces, &pieces.curtain.garment, &pieces.settings).with_folds();
    let ball = random.between(BALL_M[0], BALL_M[1]);
    let orderly = if seed.is_multiple_of(2) { 0.0 } else { ball / 0.3 };
    let shaken = if seed.is_multiple_of(2) { ball } else { 0.3 * ball };
    let middle = MIDDLE + random.point() * 0.1;
    trial.disturb(|_, p| (middle + (p - MIDDLE) * orderly + random.direction() * shaken, Vec3::ZERO));
    uncrossed(trial, pieces)
}

/// Walls come together about the curtain from four sides and from below, stay, and go.
pub(super) fn crushing(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let turn = Quat::from_rotation_y(random.between(0.0, PI));
    let middle = TOP - Vec3::Y * random.between(0.2, 0.3);
    let gap = random.between(GAP_M[0], GAP_M[1]);
    let walls = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y].map(|side| turn * side);
    let at = |away: f32| -> Vec<Vec4> {
        let centre = |side: &Vec3| (middle + *side * (WALL_M + gap + away)).extend(WALL_M);
        walls.iter().map(centre).collect()
    };
    let capsules: Vec<[u8; 2]> = (0..walls.len() as u8).map(|wall| [wall; 2]).collect();
    let trial = Trial::among(pieces, &pieces.curtain, &at(AWAY_M), &capsules, &pieces.settings);
    let mut trial = trial.with_folds();
    let move_by = WALLS_M_S * pieces.settings.step_seconds;
    let way = (AWAY_M / move_by).ceil() as usize;
    for step in (0..=way).rev().chain(vec![0; CRUSHED_STEPS]).chain(0..=way) {
        trial.spheres = Some(at(step as f32 * move_by));
        trial.step();
    }
    uncrossed(trial, pieces)
}

/// Lets the curtain come out of itself and to rest.
fn uncrossed(mut trial: Trial<'_>, pieces: &Pieces) -> TrialFindings {
    trial.count_crossings_from_here();
    let dt = trial.settings.step_seconds;
    let recovery = Some(trial.recover(&pieces.curtain.rest));
    let found = TrialFindings { recovery, ..TrialFindings::of(&trial) };
    match trial.crossed() {
        Some(crossed) => found.uncrossed(crossed, FREE_S, dt),
        None => TrialFindings { miss: Some("a cloth without folds".into()), ..found },
    }
}

#[cfg(test)]
mod tests {
    use toile_bake::shape::Face;

    use super::*;
    use crate::torture::crossed::CrossedEdges;
    use crate::torture::piece::sheet;

    #[test]
    fn what_is_bent_passes_through_itself_and_keeps_its_lengths() {
        let shape = sheet(CURTAIN);
        let triangles: Vec<[u32; 3]> =
            shape.faces.iter().flat_map(|&[a, b, c, d]: &Face| [[a, b, c], [a, c, d]]).collect();
        let mut random = CaseRandom::new("bent", 1);
        for _ in 0..20 {
            let through = ThroughItself::random(&mut random, Vec2::new(0.14, TOP.y - 0.46), 1.0);
            let at: Vec<glam::Vec3A> = shape.worn.iter().map(|p| through.bent(*p).into()).collect();
            let mut crossed = CrossedEdges::new(&[&triangles]);
            crossed.look(&[&at]);
            assert!(crossed.now > 0, "{:?}", through.begin);
            let flat = |t: &[u32; 3]| shape.worn[t[0] as usize].distance(shape.worn[t[1] as usize]);
            let stretched = triangles.iter().map(|t| at[t[0] as usize].distance(at[t[1] as usize]) / flat(t));
            assert!(stretched.fold(0.0, f32::max) < 1.001);
        }
    }
}
