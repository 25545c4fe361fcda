//! What friction keeps of a bend: strips that are rolled up and let go, and one that hangs for a minute.

use glam::DVec3;
use toile_bake::Shape;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{Specimen, SpecimenError, Surroundings};

/// Fabrics of Matsudaira et al. 2015 (J. Textile Eng. 61(6) 69-73): name, B (gf cm2/cm), 2HB (gf cm/cm).
const PUBLISHED: [(&str, f64, f64); 3] =
    [("cotton broad", 0.118, 0.124), ("wool tropical", 0.067, 0.033), ("polyester faille", 0.019, 0.007)];

/// N m of a gf cm2/cm.
const RIGIDITY: f64 = 9.806_65e-5;

/// N of a gf cm/cm.
const WIDTH: f64 = 9.806_65e-3;

/// Curvature that they are bent to (1/m).
const BENT: f64 = 100.0;

/// Length of the strips (m) and links along them: of a garment's length, a radian each where they are bent.
const LENGTH: f64 = 0.06;
const ROWS: usize = 6;

/// Rate of damping over the slowest swing's angular frequency (1), 3.516 sqrt(B / rho) / L^2: they are let go slowly, so that
/// none swings past where it stops.
const DAMPING: f64 = 5.0;

fn damping(rigidity: f64) -> f64 {
    DAMPING * 3.516 * (rigidity / CaseFabric::PLAIN.density).sqrt() / (LENGTH * LENGTH)
}

/// Longest time that they are given (s).
const REST_S: f64 = 20.0;

/// Largest error of where they stop (%).
const TARGET: f64 = 2.0;

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let styles = [MeshStyle::Grid, MeshStyle::Alternating, MeshStyle::Unstructured];
    let mut all: Vec<ValidationCase> =
        styles.into_iter().flat_map(|style| PUBLISHED.map(|fabric| residual(style, fabric))).collect();
    all.push(without());
    all.push(creep());
    all
}

fn strip(style: MeshStyle) -> Strip {
    let ends = [EndSupport::Clamped, EndSupport::Free];
    Strip { length: LENGTH, width: 0.04, rows: ROWS, columns: 4, style, ends }
}

/// The strip rolled up to a curvature (1/m), its links as long as they were cut.
fn rolled(strip: &Strip, curvature: f64) -> Shape {
    let turn = 2.0 * (0.5 * strip.link() * curvature).asin() / strip.link();
    strip.shape(|along, across| {
        // What lies behind the clamp is straight.
        let [x, z] = if along < 0.0 {
            [along, 0.0]
        } else {
            [(turn * along).sin() / curvature, (1.0 - (turn * along).cos()) / curvature]
        };
        DVec3::new(x, z, across)
    })
}

/// The curvature of a strip from the angle of the chord to its tip: that of a polygon of its links.
fn curvature(strip: &Strip, tip: DVec3) -> f64 {
    let chord = tip.y.atan2(tip.x);
    2.0 * (chord / strip.rows as f64).sin() / strip.link()
}

/// Lets a strip that was bent go, and reads its curvature when it rests.
fn release(setup: CaseSetup<'_>, strip: &Strip, cloth: &CaseFabric) -> Result<CaseOutcome, SpecimenError> {
    let shape = rolled(strip, BENT);
    let mut specimen = Specimen::new(&shape, cloth, setup, &Surroundings::default())?;
    specimen.settings.gravity = glam::Vec3A::ZERO;
    let settled = specimen.rest(REST_S);
    let last = (-strip.length + 1e-5) as f32;
    let tip = shape.cut.iter().enumerate().filter(|(_, p)| p.y < last).map(|(v, _)| v);
    let found = curvature(strip, specimen.mean(tip));
    Ok(CaseOutcome::of(&specimen, found).settled(settled))
}

fn residual(style: MeshStyle, (name, rigidity, width): (&'static str, f64, f64)) -> ValidationCase {
    let strip = strip(style);
    let cloth = CaseFabric {
        bend: rigidity * RIGIDITY,
        hysteresis: width * WIDTH,
        damping: damping(rigidity * RIGIDITY),
        ..CaseFabric::PLAIN
    };
    ValidationCase {
        name: "residual",
        parameter: name.into(),
        mesh: style.name(),
        resolution: ROWS,
        unit: "1/m",
        expected: width * WIDTH / (2.0 * rigidity * RIGIDITY),
        scale: None,
        target: Some(TARGET),
        run: Box::new(move |setup: CaseSetup<'_>| release(setup, &strip, &cloth)),
    }
}

/// Without friction nothing stays.
fn without() -> ValidationCase {
    let strip = strip(MeshStyle::Grid);
    let bend = PUBLISHED[0].1 * RIGIDITY;
    let cloth = CaseFabric { bend, damping: damping(bend), ..CaseFabric::PLAIN };
    ValidationCase {
        name: "residual",
        parameter: "without friction".into(),
        mesh: strip.style.name(),
        resolution: ROWS,
        unit: "1/m",
        expected: 0.0,
        scale: Some(BENT),
        target: Some(TARGET),
        run: Box::new(move |setup: CaseSetup<'_>| release(setup, &strip, &cloth)),
    }
}

/// Length (m) and links of the strip that hangs.
const HUNG: (f64, usize) = (0.3, 24);

/// Farthest that it may creep in a minute (m).
const CREEP_M: f64 = 1e-3;

/// A strip of wool tropical, let go level, that has come to rest: how far its tip goes in the minute after.
fn creep() -> ValidationCase {
    let ends = [EndSupport::Clamped, EndSupport::Free];
    let strip = Strip::narrow(HUNG.0, HUNG.1, ends);
    let (_, rigidity, width) = PUBLISHED[1];
    let cloth = CaseFabric { bend: rigidity * RIGIDITY, hysteresis: width * WIDTH, damping: 5.0, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| {
        let shape = strip.shape(|along, across| DVec3::new(along, 0.0, across));
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let tip = shape.cut.len() - 1;
        specimen.run(10.0);
        let before = specimen.at(tip);
        specimen.run(60.0);
        Ok(CaseOutcome::of(&specimen, before.distance(specimen.at(tip))))
    };
    ValidationCase {
        name: "creep",
        parameter: "a minute".into(),
        mesh: MeshStyle::Grid.name(),
        resolution: HUNG.1,
        unit: "m",
        expected: 0.0,
        scale: Some(CREEP_M),
        target: Some(100.0),
        run: Box::new(run),
    }
}
