//! What moves: the hanging chain, the pendulum, the spring, the tension wave, free fall, energy. Nothing is damped.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3A};

use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::oscillation;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, Specimen, Surroundings};
use crate::validate::{CaseSetup, Level};

use super::search::{crossings, peak, period};

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all: Vec<ValidationCase> = [1, 2, 3].map(chain).into();
    for degrees in [30.0, 60.0, 90.0, 120.0] {
        all.extend([Swung::Period, Swung::Loss].map(|what| pendulum(degrees, what)));
    }
    all.push(pendulum(120.0, Swung::Whole));
    all.push(spring(None));
    all.extend([2, 4, 8, 16, 32].map(|n| spring(Some(n))));
    all.extend([1.0, 4.0].map(|tension| wave(tension, WAVE_SHEAR)));
    all.push(wave(4.0, CaseFabric::PLAIN.shear));
    all.push(fall());
    all.extend([Kept::Gain, Kept::Loss].map(energy));
    all
}

/// A case that only differs by what it is called and how it is run.
fn case(name: &'static str, parameter: String, rows: usize, unit: &'static str, expected: f64) -> ValidationCase {
    ValidationCase {
        name,
        parameter,
        mesh: MeshStyle::Grid.name(),
        resolution: rows,
        unit,
        expected,
        scale: None,
        target: None,
        run: Box::new(|_| Ok(CaseOutcome::none(f64::NAN))),
    }
}

/// Steps a specimen for a time and takes a sample after each step.
fn watch(specimen: &mut Specimen, seconds: f64, sample: impl Fn(&Specimen) -> f64) -> (Vec<f64>, f64) {
    let step = f64::from(specimen.settings.step_seconds);
    let mut samples = vec![sample(specimen)];
    for _ in 0..(seconds / step) as usize {
        specimen.step();
        samples.push(sample(specimen));
    }
    (samples, step)
}

/// Links of the chain.
const CHAIN_ROWS: usize = 40;

/// Amplitude of a mode at the free end (m).
const AMPLITUDE: f64 = 0.004;

/// Periods for which the motion is watched.
const PERIODS: f64 = 5.0;

/// A mode of a hanging chain: a strip two particles wide starts in the mode's form; what is watched is its projection onto
/// that form.
fn chain(n: usize) -> ValidationCase {
    let hz = oscillation::chain_mode_hz(n, 1.0, G);
    let run = move |setup: CaseSetup<'_>| {
        let strip = Strip::narrow(1.0, CHAIN_ROWS, [EndSupport::Pinned, EndSupport::Free]);
        let form = |along: f64| oscillation::j0(oscillation::j0_root(n) * (1.0 - along).max(0.0).sqrt());
        let shape = strip.shape(|along, across| DVec3::new(across, -along, AMPLITUDE * form(along)));
        let mut specimen = Specimen::new(&shape, &CaseFabric::PLAIN, setup, &Surroundings::default())?;
        let forms: Vec<f64> = shape.cut.iter().map(|p| form(f64::from(-p.y))).collect();
        let projection = |specimen: &Specimen| forms.iter().enumerate().map(|(v, f)| f * specimen.at(v).z).sum();
        let (samples, step) = watch(&mut specimen, PERIODS / hz, projection);
        Ok(CaseOutcome::of(&specimen, period(&crossings(&samples, step)).recip()))
    };
    ValidationCase {
        target: Some(3.0),
        run: Box::new(run),
        ..case("chain-mode", format!("mode {n}"), CHAIN_ROWS, "Hz", hz)
    }
}

/// What is read off a pendulum.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Swung {
    /// Four times the way from rest to the lowest place, over the period of small swings.
    Period,
    /// From the lowest place to and fro to the lowest place again, over the period of small swings: a whole period, which
    /// what is lost on the way shortens.
    Whole,
    /// Part of its angle that it has lost after one swing to and fro (%): only reported. The velocity of a substep is a chord
    /// of the arc, which is shorter, so that the engine damps what turns.
    Loss,
}

/// A pendulum: one quad whose lower corners swing about its upper ones.
fn pendulum(degrees: f64, what: Swung) -> ValidationCase {
    let angle = degrees.to_radians();
    let exact = oscillation::pendulum(angle);
    let small = TAU / G.sqrt();
    let run = move |setup: CaseSetup<'_>| {
        let strip = Strip { width: 0.2, ..Strip::narrow(1.0, 1, [EndSupport::Pinned, EndSupport::Free]) };
        let shape = strip.shape(|along, across| DVec3::new(across, -along * angle.cos(), along * angle.sin()));
        let cloth = CaseFabric { stretch: f64::INFINITY, ..CaseFabric::PLAIN };
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let swing = |specimen: &Specimen| {
            let p = specimen.mean((0..specimen.vertices()).filter(|v| specimen.moves(*v)));
            p.z.atan2(-p.y)
        };
        let (samples, step) = watch(&mut specimen, 1.3 * small * exact, swing);
        let got = match what {
            Swung::Period => crossings(&samples, step).first().map_or(f64::NAN, |quarter| 4.0 * quarter / small),
            Swung::Whole => period(&crossings(&samples, step)) / small,
            Swung::Loss => {
                let back = samples[samples.len() / 2..].iter().copied().fold(f64::MIN, f64::max);
                (1.0 - back / angle) * 100.0
            }
        };
        Ok(CaseOutcome::of(&specimen, got))
    };
    let run = Box::new(run);
    match what {
        Swung::Period => {
            ValidationCase { target: Some(1.0), run, ..case("pendulum", format!("{degrees} deg"), 1, "T/T0", exact) }
        }
        Swung::Whole => ValidationCase {
            target: Some(1.0),
            run,
            ..case("pendulum", format!("{degrees} deg, whole"), 1, "T/T0", exact)
        },
        Swung::Loss => {
            ValidationCase { scale: Some(100.0), run, ..case("pendulum", format!("{degrees} deg, lost"), 1, "%", 0.0) }
        }
    }
}

/// The spring of the XPBD paper: 1.5 m long, at rest at 1 m, compliance .001 m/N, mass 1 kg: one quad whose lower corners
/// hang on its sides without gravity. Its period is to depend neither on the substeps nor on what is solved in each.
fn spring(substeps: Option<u32>) -> ValidationCase {
    let exact = TAU / 1_000f64.sqrt();
    let run = move |setup: CaseSetup<'_>| {
        let strip = Strip { width: 1.0, ..Strip::narrow(1.0, 1, [EndSupport::Pinned, EndSupport::Free]) };
        let shape = strip.shape(|along, across| DVec3::new(across, -1.5 * along, 0.0));
        // Half of the quad's mass is at its lower corners; shear hardly holds.
        let cloth = CaseFabric { density: 2.0, stretch: 1_000.0, shear: 1e-3, ..CaseFabric::PLAIN };
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        specimen.settings.gravity = Vec3A::ZERO;
        if setup.level != Level::Converged && substeps.is_some() {
            specimen.settings.substeps = substeps;
        }
        let length =
            |specimen: &Specimen| -specimen.mean((0..specimen.vertices()).filter(|v| specimen.moves(*v))).y - 1.0;
        let (samples, step) = watch(&mut specimen, PERIODS * exact, length);
        Ok(CaseOutcome::of(&specimen, period(&crossings(&samples, step))))
    };
    let parameter = substeps.map_or("as baked".into(), |n| format!("{n} substeps"));
    // At 2 substeps implicit Euler itself is 1.6 % off: reported, not held against it.
    let target = (substeps.unwrap_or(4) > 2).then_some(1.0);
    ValidationCase { target, run: Box::new(run), ..case("spring", parameter, 1, "s", exact) }
}

/// Where a wave is watched from its start on (m).
const GAUGES: [f64; 2] = [0.3, 0.8];

/// Shear stiffness of what is to carry waves by its tension alone (N/m): next to none.
const WAVE_SHEAR: f64 = 1.0;

/// Links of the string.
const WAVE_ROWS: usize = 120;

/// A wave on a strip that is pulled with a tension (N/m): it starts at rest as a hump in the middle, which runs apart, and
/// passes two places.
fn wave(tension: f64, shear: f64) -> ValidationCase {
    let density = CaseFabric::PLAIN.density;
    let speed = (tension / density).sqrt();
    let run = move |setup: CaseSetup<'_>| {
        let cloth = CaseFabric { stretch: 2_000.0, shear, ..CaseFabric::PLAIN };
        let stretched = 1.0 + tension / cloth.stretch;
        let strip = Strip::narrow(2.4 / stretched, WAVE_ROWS, [EndSupport::Pinned, EndSupport::Pinned]);
        let hump = |x: f64| 0.005 * (-0.5 * (x / 0.08).powi(2)).exp();
        let shape = strip.shape(|along, across| {
            let x = along * stretched - 1.2;
            DVec3::new(x, across, hump(x))
        });
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        specimen.settings.gravity = Vec3A::ZERO;
        let gauge = |x: f64| {
            let near = |v: &usize| (shape.worn[*v].x - x as f32).abs() < 0.51 * strip.link() as f32;
            let places: Vec<usize> = (0..shape.worn.len()).filter(near).collect();
            let at = places.iter().map(|v| f64::from(shape.worn[*v].x)).sum::<f64>() / places.len().max(1) as f64;
            (places, at)
        };
        let [(first, from), (second, to)] = GAUGES.map(gauge);
        let step = f64::from(specimen.settings.step_seconds);
        let mut heights = [Vec::new(), Vec::new()];
        for _ in 0..((GAUGES[1] + 0.35) / speed / step) as usize {
            specimen.step();
            heights[0].push(specimen.mean(first.iter().copied()).z);
            heights[1].push(specimen.mean(second.iter().copied()).z);
        }
        let took = peak(&heights[1], step) - peak(&heights[0], step);
        Ok(CaseOutcome::of(&specimen, (to - from) / took))
    };
    // Cloth that is stretched is lighter by as much.
    let exact = speed * (1.0 + tension / 2_000.0).sqrt();
    let sheared = if shear > WAVE_SHEAR { format!(", G {shear} N/m") } else { String::new() };
    let parameter = format!("T {tension} N/m{sheared}");
    ValidationCase { target: Some(3.0), run: Box::new(run), ..case("wave", parameter, WAVE_ROWS, "m/s", exact) }
}

/// How long it falls (s).
const FALL_S: f64 = 1.0;

fn fall() -> ValidationCase {
    let run = |setup: CaseSetup<'_>| {
        let strip = Strip { width: 0.2, columns: 8, ..Strip::narrow(0.2, 8, [EndSupport::Free, EndSupport::Free]) };
        let shape = strip.shape(|along, across| DVec3::new(along, 0.0, across));
        let mut specimen = Specimen::new(&shape, &CaseFabric::PLAIN, setup, &Surroundings::default())?;
        specimen.run(FALL_S);
        let vertices = specimen.vertices();
        Ok(CaseOutcome::of(&specimen, -specimen.mean(0..vertices).y))
    };
    ValidationCase {
        target: Some(1.0),
        run: Box::new(run),
        ..case("free-fall", format!("{FALL_S} s"), 8, "m", 0.5 * G * FALL_S * FALL_S)
    }
}

/// How long energy is watched (s).
const ENERGY_S: f64 = 60.0;

/// Side of the cloth that swings (m), and its links.
const SWING: (f64, usize) = (0.3, 12);

/// Which way energy goes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kept {
    /// Above what it started with: nothing may come from nothing.
    Gain,
    /// What is lost in the end of what could be: only reported.
    Loss,
}

/// A cloth that is let go level from one pinned side and swings undamped for a minute: its energy, in parts of what it has
/// above hanging straight.
fn energy(which: Kept) -> ValidationCase {
    let run = move |setup: CaseSetup<'_>| {
        let (side, rows) = SWING;
        let strip =
            Strip { width: side, columns: rows, ..Strip::narrow(side, rows, [EndSupport::Pinned, EndSupport::Free]) };
        let shape = strip.shape(|along, across| DVec3::new(across, 0.0, along));
        let cloth = CaseFabric { bend: 13.6e-6, ..CaseFabric::PLAIN };
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let seconds = if setup.level == Level::Converged { 0.1 * ENERGY_S } else { ENERGY_S };
        let whole = 0.5 * specimen.mass() * G * side;
        let start = specimen.energy();
        let (samples, _) = watch(&mut specimen, seconds, |specimen| (specimen.energy() - start) / whole * 100.0);
        let got = match which {
            Kept::Gain => samples.iter().copied().fold(0.0, f64::max),
            Kept::Loss => samples.last().map_or(f64::NAN, |last| -last),
        };
        Ok(CaseOutcome::of(&specimen, got))
    };
    let parameter = match which {
        Kept::Gain => "most above the start",
        Kept::Loss => "lost in the end",
    };
    ValidationCase {
        scale: Some(100.0),
        target: (which == Kept::Gain).then_some(1.0),
        run: Box::new(run),
        ..case("energy", parameter.into(), SWING.1, "%", 0.0)
    }
}
