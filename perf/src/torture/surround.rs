//! Cases of surroundings that move as no body does.

use glam::{Affine3A, Quat, Vec3, Vec4};

use super::outcome::TrialFindings;
use super::piece::TOP;
use super::pieces::{Pieces, TUBE_RADIUS_M};
use super::trial::Trial;
use crate::random::CaseRandom;

/// Radius of the capsules (m).
const RADIUS_M: f32 = 0.06;

/// Half of their length (m).
const REACH_M: f32 = 0.15;

/// Farther away than anything that the cloth touches (m).
const AWAY_M: f32 = 2.0;

/// Steps for which colliders are at it.
const STEPS: usize = 240;

/// Turns a second of the spin.
const TURNS_PER_S: f32 = 10.0;

/// A capsule by its middle and its half axis.
fn capsule(middle: Vec3, half: Vec3, radius: f32) -> [Vec4; 2] {
    [(middle - half).extend(radius), (middle + half).extend(radius)]
}

/// A capsule that jumps from one side to the other every few steps: every second seed alone, so that all colliders jump
/// and the engine takes it for another body; else beside three spheres that stay.
pub(super) fn teleport(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let stays = [1.0, 1.2, 1.4].map(|x| Vec4::new(x, TOP.y, 0.0, RADIUS_M));
    let half = random.direction() * REACH_M;
    let mut place = |side: f32| {
        let middle = TOP + Vec3::new(random.between(-0.1, 0.1), random.between(-0.45, 0.0), 0.0);
        (middle + Vec3::Z * side * random.between(0.05, 0.6), 6 + random.below(50))
    };
    let mut spheres = capsule(place(1.0).0, half, RADIUS_M).to_vec();
    let mut capsules = vec![[0, 1]];
    if seed.is_multiple_of(2) {
        spheres.extend(stays);
        capsules.extend([[2, 2], [3, 3], [4, 4]]);
    }
    let mut trial = Trial::among(pieces, &pieces.curtain, &spheres, &capsules, &pieces.settings);
    let (mut side, mut step) = (1.0, 0);
    while step < STEPS {
        side = -side;
        let (middle, stay) = place(side);
        spheres[..2].copy_from_slice(&capsule(middle, half, RADIUS_M));
        trial.spheres = Some(spheres.clone());
        trial.run(stay);
        step += stay;
    }
    // All of it is somewhere else, so that it takes nothing along that hangs over it.
    spheres.iter_mut().for_each(|s| s.x += AWAY_M);
    trial.spheres = Some(spheres);
    TrialFindings::back(trial, &pieces.curtain.rest)
}

/// Two capsules come from both sides until they overlap, stay, and go.
pub(super) fn squeeze(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let middle = TOP + Vec3::new(random.between(-0.05, 0.05), random.between(-0.4, -0.1), random.between(-0.05, 0.05));
    let halves = [0, 1].map(|_| {
        let d = random.direction();
        Vec3::new(d.x, d.y, 0.0).normalize_or(Vec3::X) * REACH_M
    });
    let overlap = random.between(-0.005, 0.03);
    let speed = random.between(0.2, 4.0);
    let far = 0.5;
    let at = |gap: f32| {
        let z = RADIUS_M - 0.5 * overlap + gap;
        let [a, b] = [1.0, -1.0].map(|side: f32| middle + Vec3::Z * side * z);
        [capsule(a, halves[0], RADIUS_M), capsule(b, halves[1], RADIUS_M)].concat()
    };
    let mut trial = Trial::among(pieces, &pieces.curtain, &at(far), &[[0, 1], [2, 3]], &pieces.settings);
    let move_by = speed * pieces.settings.step_seconds;
    let way = (far / move_by).ceil() as usize;
    for step in (0..=way).rev().chain(vec![0; STEPS]).chain(0..=way) {
        trial.spheres = Some(at((step as f32 * move_by).min(far)));
        trial.step();
    }
    TrialFindings::back(trial, &pieces.curtain.rest)
}

/// The tube starts about a body twice as wide as it was cut for, below the ring that it hangs by; then the body is gone.
pub(super) fn too_small(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let body = |radius: f32| capsule(TOP - Vec3::Y * 0.55, Vec3::Y * 0.35, radius).to_vec();
    // The fabric keeps 3 mm; up to 5 mm of the body stand out of the tube.
    let radius = 2.0 * TUBE_RADIUS_M + random.between(-0.03, 0.005);
    let mut trial = Trial::among(pieces, &pieces.tube, &body(radius), &[[0, 1]], &pieces.settings);
    trial.run(STEPS);
    trial.spheres = Some(body(0.001));
    TrialFindings::back(trial, &pieces.tube.rest)
}

/// The pins turn about an axis through the upper edge, and stop.
pub(super) fn spin(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let axis = random.direction();
    let centre = TOP + Vec3::X * random.between(-0.1, 0.1);
    let mut trial = Trial::at_rest(pieces, &pieces.curtain, &pieces.settings);
    let a_step = std::f32::consts::TAU * TURNS_PER_S * pieces.settings.step_seconds;
    for step in 1..=STEPS {
        let turn = Quat::from_axis_angle(axis, a_step * (step % 12) as f32);
        let bone = Affine3A::from_rotation_translation(turn, centre - turn * centre);
        trial.palette[..2].fill(bone);
        trial.step();
    }
    TrialFindings::back(trial, &pieces.curtain.rest)
}
