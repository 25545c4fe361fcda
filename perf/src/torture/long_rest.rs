//! A cloth at rest for so long that what is left of its motion is smaller than the smallest normal number, with which
//! many processors count a hundred times slower.

use std::time::Instant;

use glam::Vec3;
use toile_base::numeric::statistics::median;

use super::outcome::TrialFindings;
use super::pieces::Pieces;
use super::trial::Trial;
use crate::random::CaseRandom;

/// Steps at rest: a minute.
const REST_STEPS: usize = 7_200;

/// Steps that are timed, each of the fresh cloth and of the rested one in turn: what slows one down slows both.
const TIMED: usize = 200;

/// How many times longer a step may take after the rest (1): the medians of equal work differ by less than a tenth.
const SLOWER: f64 = 1.5;

/// The curtain hangs in its plane but for a last trembling across it, from a thousandth of a metre to nothing that f32
/// knows; a minute later it is timed beside a copy that was kept as it was in the beginning.
pub(super) fn long_rest(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let size = random.decades(-44.0, -3.0);
    let mut rested = Trial::at_rest(pieces, &pieces.patch, &pieces.settings);
    rested.disturb(|i, p| (p.with_z(size * if i % 2 == 0 { 1.0 } else { -0.5 }), Vec3::ZERO));
    let mut fresh = Trial::at_rest(pieces, &pieces.patch, &pieces.settings);
    fresh.disturb(|_, p| (p.with_z(random.between(-1e-3, 1e-3)), Vec3::ZERO));
    rested.run(REST_STEPS);
    let [new, old] = [&mut fresh, &mut rested].map(|_| Vec::with_capacity(TIMED));
    let mut times = [new, old];
    for _ in 0..TIMED {
        for (trial, times) in [&mut fresh, &mut rested].into_iter().zip(&mut times) {
            let begun = Instant::now();
            trial.step();
            times.push(begun.elapsed().as_nanos() as f64);
        }
    }
    let [new, old] = times.map(|mut times| median(&mut times).unwrap_or(f64::NAN));
    let tiny = denormal(&rested);
    let mut found = TrialFindings::back(rested, &pieces.patch.rest);
    let ratio = old / new;
    found.note = format!("a step takes {ratio:.2} times as long after a minute's rest; {tiny} denormal numbers");
    found.miss = (ratio > SLOWER).then(|| found.note.clone());
    found
}

/// Numbers of the state that are smaller than the smallest normal one, and not 0.
fn denormal(trial: &Trial<'_>) -> usize {
    let state = (0..trial.garment.particles()).flat_map(|i| [trial.cloth.positions[i], trial.cloth.velocity(i)]);
    state.flat_map(|v| v.to_array()).filter(|x| x.is_subnormal()).count()
}
