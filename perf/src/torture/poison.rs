//! Cases of inputs that are not finite or beyond all measure: each input and value at a time, for some steps, while the
//! cloth hangs at rest; then all is as before.

use glam::{Vec3, Vec3A, Vec4};
use toile_engine::cloth::Wind;

use super::outcome::TrialFindings;
use super::piece::TOP;
use super::pieces::Pieces;
use super::trial::Trial;
use crate::random::CaseRandom;

/// What stands in place of a number.
const VALUES: [f32; 4] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30];

/// What settings can be besides: nothing at all, less than nothing, less than any number that counts.
const SETTINGS_VALUES: [f32; 8] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 0.0, -1.0, 1e-40];

/// Longest that an input is bad (steps).
const LONGEST: usize = 24;

/// One input: its name, and how a value is put there.
type BadInput = (String, Box<dyn Fn(&mut Trial<'_>, f32)>);

fn input(name: &str, put: impl Fn(&mut Trial<'_>, f32) + 'static) -> BadInput {
    (name.into(), Box::new(put))
}

/// The inputs of the cloth's colliders: three fields of a sphere and its radius, all of them, their step.
fn surrounding_inputs() -> Vec<BadInput> {
    let sphere = |t: &mut Trial<'_>, change: &dyn Fn(&mut Vec4)| {
        t.spheres.iter_mut().flatten().take(1).for_each(change);
    };
    let mut inputs: Vec<BadInput> =
        (0..4).map(|k| input(&format!("number {k} of a sphere"), move |t, v| sphere(t, &|s| s[k] = v))).collect();
    inputs.push(input("a sphere", move |t, v| sphere(t, &|s| *s = Vec4::splat(v))));
    inputs.push(input("all spheres", |t, v| t.spheres.iter_mut().flatten().for_each(|s| *s = Vec4::splat(v))));
    inputs.push(input("the colliders' step", |t, v| t.colliders.step_seconds = v));
    inputs
}

/// The inputs of the bones: all twelve numbers of the two that the pins follow.
fn bone_inputs() -> Vec<BadInput> {
    let mut inputs = Vec::new();
    for bone in [0, 1] {
        // Bones are an affine map each: three columns and a place.
        for k in 0..12 {
            inputs.push(input(&format!("number {k} of bone {bone}"), move |t, v| {
                let bone = &mut t.palette[bone];
                if k < 9 { bone.matrix3.col_mut(k / 3)[k % 3] = v } else { bone.translation[k - 9] = v }
            }));
        }
    }
    inputs
}

/// The inputs of the settings.
fn setting_inputs() -> Vec<BadInput> {
    let wind = |t: &mut Trial<'_>, change: &dyn Fn(&mut Wind)| {
        let mut wind = Wind { velocity: Vec3A::ZERO, drag: 1.0, lift: 0.5 };
        change(&mut wind);
        t.settings.wind = Some(wind);
    };
    let mut inputs: Vec<BadInput> =
        (0..3).map(|k| input(&format!("gravity {k}"), move |t, v| t.settings.gravity[k] = v)).collect();
    for k in 0..3 {
        inputs.push(input(&format!("wind {k}"), move |t, v| wind(t, &|w| w.velocity[k] = v)));
    }
    inputs.push(input("drag", move |t, v| wind(t, &|w| w.drag = v)));
    inputs.push(input("lift", move |t, v| wind(t, &|w| w.lift = v)));
    inputs.push(input("step_seconds", |t, v| t.settings.step_seconds = v));
    inputs.push(input("max_speed", |t, v| t.settings.max_speed = v));
    inputs.push(input("stretch_damping_s", |t, v| t.settings.stretch_damping_s = v));
    inputs.push(input("static_friction", |t, v| t.settings.static_friction = v));
    inputs
}

/// The rest of the settings: the root's, and the substeps at both ends of their range.
fn root_inputs() -> Vec<BadInput> {
    vec![
        input("root.linear", |t, v| t.settings.root.linear = v),
        input("root.angular", |t, v| t.settings.root.angular = v),
        input("root.centrifugal", |t, v| t.settings.root.centrifugal = v),
        input("root.teleport_m", |t, v| t.settings.root.teleport_m = v),
        input("root.teleport_degrees", |t, v| t.settings.root.teleport_degrees = v),
        // No number at all is no substep, infinity as many as can be asked for.
        input("substeps", |t, v| t.settings.substeps = Some(v as u32)),
    ]
}

/// The numbers of the state: of one particle, of a tenth of them, of all.
fn state_inputs() -> Vec<BadInput> {
    let mut inputs = Vec::new();
    for (whose, every) in [("one", usize::MAX), ("a tenth", 10), ("all", 1)] {
        for k in 0..6 {
            let what = if k < 3 { "position" } else { "velocity" };
            inputs.push(input(&format!("{what} {} of {whose}", k % 3), move |t, v| {
                let middle = t.garment.particles() / 2;
                for i in (0..t.garment.particles()).filter(|i| i % every == middle % every) {
                    let (mut p, mut u) = (t.cloth.positions[i], t.cloth.velocity(i));
                    if k < 3 {
                        p[k] = v;
                    } else {
                        u[k - 3] = v;
                    }
                    t.cloth.disturb(i, p, u);
                }
            }));
        }
    }
    inputs
}

/// Puts a bad value into one input for some steps and lets the cloth come back.
fn poisoned(pieces: &Pieces, mut trial: Trial<'_>, (name, put): &BadInput, value: f32, steps: usize) -> TrialFindings {
    let (settings, palette, spheres) = (trial.settings, trial.palette.clone(), trial.spheres.clone());
    let step_seconds = trial.colliders.step_seconds;
    trial.run(2);
    for _ in 0..steps {
        put(&mut trial, value);
        trial.step();
    }
    (trial.settings, trial.palette, trial.spheres) = (settings, palette, spheres);
    trial.colliders.step_seconds = step_seconds;
    let mut found = TrialFindings::back(trial, &pieces.curtain.rest);
    found.note = format!("{name} is {value} for {steps} steps");
    found
}

/// The input and the value of a seed: seeds in a row go through all of them, and begin again.
fn chosen(inputs: &[BadInput], values: &[f32], seed: u64) -> (usize, f32) {
    let k = (seed % (inputs.len() * values.len()) as u64) as usize;
    (k / values.len(), values[k % values.len()])
}

pub(super) fn surroundings(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    beside(pieces, random, seed, &surrounding_inputs())
}

pub(super) fn bones(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    beside(pieces, random, seed, &bone_inputs())
}

/// A bad value in what is around the curtain.
fn beside(pieces: &Pieces, random: &mut CaseRandom, seed: u64, inputs: &[BadInput]) -> TrialFindings {
    let (which, value) = chosen(inputs, &VALUES, seed);
    // They stand beside the cloth, and come through it where they are drawn away and back.
    let side = |x: f32| [Vec3::new(x, TOP.y - 0.1, 0.0).extend(0.05), Vec3::new(x, TOP.y - 0.4, 0.0).extend(0.05)];
    let spheres = [side(-0.4), side(0.4)].concat();
    let mut trial = Trial::among(pieces, &pieces.curtain, &spheres, &[[0, 1], [2, 3]], &pieces.settings);
    trial.disturb(|i, _| (pieces.curtain.rest[i], Vec3::ZERO));
    poisoned(pieces, trial, &inputs[which], value, 1 + random.below(LONGEST))
}

pub(super) fn settings(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let inputs = setting_inputs();
    let (which, value) = chosen(&inputs, &SETTINGS_VALUES, seed);
    let trial = Trial::at_rest(pieces, &pieces.curtain, &pieces.settings);
    poisoned(pieces, trial, &inputs[which], value, 1 + random.below(LONGEST))
}

pub(super) fn root_settings(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let inputs = root_inputs();
    let (which, value) = chosen(&inputs, &SETTINGS_VALUES, seed);
    let trial = Trial::at_rest(pieces, &pieces.curtain, &pieces.settings);
    poisoned(pieces, trial, &inputs[which], value, 1 + random.below(LONGEST))
}

pub(super) fn state(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let inputs = state_inputs();
    let (which, value) = chosen(&inputs, &VALUES, seed);
    let trial = Trial::at_rest(pieces, &pieces.curtain, &pieces.settings);
    poisoned(pieces, trial, &inputs[which], value, 1 + random.below(LONGEST))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::SEEDS;

    #[test]
    fn the_seeds_of_a_whole_run_meet_every_input_with_every_value() {
        let four = VALUES.len();
        for (inputs, values) in [
            (surrounding_inputs(), four),
            (bone_inputs(), four),
            (setting_inputs(), SETTINGS_VALUES.len()),
            (root_inputs(), SETTINGS_VALUES.len()),
            (state_inputs(), four),
        ] {
            let combinations = (inputs.len() * values) as u64;
            assert!(combinations <= SEEDS, "{} inputs with {values} values each", inputs.len());
        }
    }
}
