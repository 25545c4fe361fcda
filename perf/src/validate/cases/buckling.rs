//! What gives way: the upright strip, the column, the plate on edge. Each is found by bisection over its stiffness.
//!
//! The straight state is nudged by a thousandth of the length and left alone; it has given way when it is ever farther off
//! than [`AWAY`] times the nudge.

use std::f64::consts::PI;

use glam::DVec3;
use toile_bake::Shape;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::column::{self, Ends};
use crate::validate::exact::plate;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, Specimen, SpecimenError, Surroundings};

use super::bending::LENGTH;
use super::search::threshold;

/// Times the nudge.
const AWAY: f64 = 3.0;

/// The nudge (m).
const NUDGE: f64 = 3e-4;

/// How long it settles before (s), and the rate of damping then (1/s).
const SETTLE: (f64, f64) = (0.5, 20.0);

/// How long a trial is watched (s).
const WATCH_S: f64 = 5.0;

/// Rate of damping (1/s): little, so that what gives way slowly is seen to.
const DAMPING: f64 = 1.0;

/// Links along a column.
const ROWS: usize = 16;

/// Searched between these parts of the exact value.
const RANGE: [f64; 2] = [0.3, 3.0];

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = vec![greenhill()];
    all.extend(Ends::ALL.map(euler));
    all.extend([0.1, 0.2].map(lateral));
    all
}

/// Watches a specimen that was nudged; says whether it gave way.
fn gives_way(specimen: &mut Specimen, watched: &[usize], off: impl Fn(DVec3) -> f64) -> bool {
    let steps = (WATCH_S / f64::from(specimen.settings.step_seconds)) as usize;
    for _ in 0..steps {
        specimen.step();
        if watched.iter().any(|&v| off(specimen.at(v)).abs() > AWAY * NUDGE) {
            return true;
        }
    }
    false
}

/// Vertices at a part of a strip's length.
fn row(specimen: &Specimen, shape: &Shape, along: f64) -> Vec<usize> {
    (0..specimen.vertices()).filter(|v| (f64::from(-shape.cut[*v].y) - along).abs() < 1e-4).collect()
}

/// Lets what was only just loaded settle in its plane, then nudges every vertex that moves by NUDGE * form(s) out of it.
fn nudge(specimen: &mut Specimen, shape: &Shape, form: impl Fn(f64) -> f64) {
    specimen.damp(SETTLE.1);
    specimen.run(SETTLE.0);
    specimen.damp(DAMPING);
    for v in 0..specimen.vertices() {
        if specimen.moves(v) {
            let along = f64::from(-shape.cut[v].y) / LENGTH;
            let at = specimen.at(v) + DVec3::Z * (NUDGE * form(along));
            specimen.put(v, at, DVec3::ZERO);
        }
    }
}

/// An upright strip, clamped below, with a load on its top of so many times its own weight.
fn upright(setup: CaseSetup<'_>, gamma: f64, load: f64) -> Result<(CaseOutcome, bool), SpecimenError> {
    let strip = Strip::narrow(LENGTH, ROWS, [EndSupport::Clamped, EndSupport::Free]);
    let mut shape = strip.shape(|along, across| DVec3::new(across, along, 0.0));
    let tip: Vec<usize> = (0..shape.cut.len()).filter(|v| f64::from(-shape.cut[*v].y) > LENGTH - 1e-4).collect();
    shape.heavier = vec![1.0; shape.cut.len()];
    tip.iter().for_each(|&v| shape.heavier[v] = (1.0 + 2.0 * load * ROWS as f64) as f32);
    let bend = CaseFabric::PLAIN.density * G * LENGTH.powi(3) / gamma;
    let cloth = CaseFabric { bend, damping: DAMPING, ..CaseFabric::PLAIN };
    let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
    nudge(&mut specimen, &shape, |s| s * s);
    let gave = gives_way(&mut specimen, &tip, |p| p.z);
    Ok((CaseOutcome::of(&specimen, gamma), gave))
}

fn greenhill() -> ValidationCase {
    let exact = column::greenhill();
    ValidationCase {
        name: "greenhill",
        parameter: "own weight".into(),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS,
        unit: "w L^3/B",
        expected: exact,
        scale: None,
        target: Some(10.0),
        run: Box::new(move |setup: CaseSetup<'_>| {
            threshold(RANGE.map(|r| r * exact), |gamma| upright(setup, gamma, 0.0))
        }),
    }
}

/// Load on a free top over the strip's own weight, which is part of the exact value.
const TOP_LOAD: f64 = 2.0;

/// Shortening of columns whose both ends are held (1): the engine knows no end loads, so that the ends are brought closer,
/// which presses with stretch stiffness times this.
const SHORTENING: f64 = 5e-4;

fn euler(ends: Ends) -> ValidationCase {
    let exact = if ends == Ends::Free { column::loaded(1.0 / TOP_LOAD) } else { ends.critical() };
    let run = move |setup: CaseSetup<'_>| {
        threshold(RANGE.map(|r| r * exact), |p| match ends {
            Ends::Free => upright(setup, p / TOP_LOAD, TOP_LOAD),
            _ => pressed(setup, ends, p),
        })
    };
    ValidationCase {
        name: "euler",
        parameter: ends.name().into(),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS,
        unit: "P L^2/B",
        expected: exact,
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}

/// A strip pressed between two ends that are too close, without weight.
fn pressed(setup: CaseSetup<'_>, ends: Ends, p: f64) -> Result<(CaseOutcome, bool), SpecimenError> {
    let (first, last) = match ends {
        Ends::Pinned | Ends::Free => (EndSupport::Pinned, EndSupport::Pinned),
        Ends::ClampedPinned => (EndSupport::Clamped, EndSupport::Pinned),
        Ends::Clamped => (EndSupport::Clamped, EndSupport::Clamped),
    };
    let strip = Strip::narrow(LENGTH, ROWS, [first, last]);
    let shape = strip.shape(|along, across| DVec3::new((along - 0.5 * LENGTH) * (1.0 - SHORTENING), across, 0.0));
    let force = CaseFabric::PLAIN.stretch * SHORTENING;
    let cloth = CaseFabric { bend: force * LENGTH * LENGTH / p, damping: DAMPING, ..CaseFabric::PLAIN };
    let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
    specimen.settings.gravity = glam::Vec3A::ZERO;
    // As the ends allow: a kink at a clamp would hold more energy than the nudge itself.
    nudge(&mut specimen, &shape, |s| match ends {
        Ends::Pinned | Ends::Free => (PI * s).sin(),
        Ends::ClampedPinned => 3.85 * s * s * (1.0 - s) * (1.5 - s),
        Ends::Clamped => (PI * s).sin().powi(2),
    });
    let middle = row(&specimen, &shape, 0.5 * LENGTH);
    let gave = gives_way(&mut specimen, &middle, |p| p.z);
    Ok((CaseOutcome::of(&specimen, p), gave))
}

/// Links along the plate.
const PLATE_ROWS: usize = 20;

/// A plate on edge, clamped at one short side. Stencils along warp and weft and of the twist are an isotropic plate of
/// Poisson's ratio 0 and no other.
fn lateral(width: f64) -> ValidationCase {
    let exact = plate::critical(width, 0.0);
    ValidationCase {
        name: "lateral",
        parameter: format!("width/length {width}"),
        mesh: MeshStyle::Grid.name(),
        resolution: PLATE_ROWS,
        unit: "w L^3/D",
        expected: exact,
        scale: None,
        target: Some(10.0),
        run: Box::new(move |setup: CaseSetup<'_>| {
            threshold(RANGE.map(|r| r * exact), |gamma| on_edge(setup, width, gamma))
        }),
    }
}

fn on_edge(setup: CaseSetup<'_>, width: f64, gamma: f64) -> Result<(CaseOutcome, bool), SpecimenError> {
    let columns = (width * PLATE_ROWS as f64).round().max(2.0) as usize;
    let ends = [EndSupport::Clamped, EndSupport::Free];
    let strip =
        Strip { length: LENGTH, width: width * LENGTH, rows: PLATE_ROWS, columns, style: MeshStyle::Grid, ends };
    let shape = strip.shape(|along, across| DVec3::new(along, across, 0.0));
    let bend = CaseFabric::PLAIN.density * G * LENGTH.powi(3) / gamma;
    // Stiffer in shear than most cloth, so that it does not sag in its plane instead.
    let cloth = CaseFabric { bend, bias: Some(bend), shear: 200.0, damping: DAMPING, ..CaseFabric::PLAIN };
    let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
    nudge(&mut specimen, &shape, |s| s * s);
    let tip = row(&specimen, &shape, LENGTH);
    let gave = gives_way(&mut specimen, &tip, |p| p.z);
    Ok((CaseOutcome::of(&specimen, gamma), gave))
}
