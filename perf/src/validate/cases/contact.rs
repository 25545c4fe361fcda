//! Contact and friction: the rope around a post, the incline, the stopping distance, on the engine's own colliders.

use glam::{DVec3, Vec4};
use toile_bake::Shape;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::string;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, Specimen, SpecimenError, Surroundings};

use super::rope::{LoadedRope, POST, ROPE_LOADS, ROPE_ROWS, ROPE_WATCH, rope_length};
use super::search::threshold;

/// The gap that cloth keeps from a surface (m), as the cases' fabric has it.
const GAP: f64 = 1e-3;

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = Vec::new();
    for load in ROPE_LOADS {
        all.extend([0.3, 0.6].map(|mu| capstan(mu, load)));
    }
    all.extend([0.2, 0.3, 0.6].map(incline));
    all.extend([(1.0, 0.3), (2.0, 0.3), (1.0, 0.6)].map(|(v, mu)| stopping(v, mu)));
    all
}

/// A rope over half a turn of a post with a load at each end: the ratio of the two pulls at which it slips.
fn capstan(mu: f64, load: f64) -> ValidationCase {
    let exact = string::capstan_heavy(mu, POST / rope_length() / load);
    let run =
        move |setup: CaseSetup<'_>| threshold([1.0, exact * exact], |ratio| rope(setup, mu, [load, load * ratio]));
    ValidationCase {
        name: "capstan",
        parameter: format!("mu {mu}, load {load}"),
        mesh: MeshStyle::Grid.name(),
        resolution: ROPE_ROWS,
        unit: "T2/T1",
        expected: exact,
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}

fn rope(setup: CaseSetup<'_>, mu: f64, pulls: [f64; 2]) -> Result<(CaseOutcome, bool), SpecimenError> {
    let LoadedRope { shape, ends } = LoadedRope::new(pulls);
    let cloth = CaseFabric { friction: mu, damping: 5.0, stretch: 1e5, ..CaseFabric::PLAIN };
    let surroundings = Surroundings {
        capsule: Some([DVec3::NEG_Z * 0.2, DVec3::Z * 0.2]),
        radius: POST - GAP,
        ..Surroundings::default()
    };
    let mut specimen = Specimen::new(&shape, &cloth, setup, &surroundings)?;
    let before = specimen.mean(ends[1].iter().copied()).y;
    specimen.run(ROPE_WATCH.0);
    let slipped = before - specimen.mean(ends[1].iter().copied()).y > ROPE_WATCH.1;
    Ok((CaseOutcome::of(&specimen, pulls[1] / pulls[0]), slipped))
}

/// Side of the patch (m) and its links.
const PATCH: (f64, usize) = (0.05, 5);

/// A patch that lies on a plane through the origin which falls along +x at an angle (rad), at its gap; x is where its
/// middle is along the slope.
fn patch(angle: f64, x: f64) -> (Shape, Surroundings) {
    let (side, links) = PATCH;
    let strip =
        Strip { width: side, columns: links, ..Strip::narrow(side, links, [EndSupport::Free, EndSupport::Free]) };
    let (sin, cos) = angle.sin_cos();
    let (down, up) = (DVec3::new(cos, -sin, 0.0), DVec3::new(sin, cos, 0.0));
    let shape = strip.shape(|along, across| down * (x + along - 0.5 * side) + up * GAP + DVec3::Z * across);
    let plane = Vec4::new(sin as f32, cos as f32, 0.0, 0.0);
    (shape, Surroundings { planes: vec![plane], ..Surroundings::default() })
}

/// How long the patch is watched (s) and how far it must slide (m).
const SLIDE: (f64, f64) = (1.0, 0.005);

/// Target of the slope's angle (degrees).
const SLOPE_DEGREES: f64 = 2.0;

fn incline(mu: f64) -> ValidationCase {
    let exact = mu.atan().to_degrees();
    let run = move |setup: CaseSetup<'_>| {
        threshold([0.3 * exact, (3.0 * exact).min(85.0)], |degrees| {
            let (shape, surroundings) = patch(degrees.to_radians(), 0.0);
            let cloth = CaseFabric { friction: mu, ..CaseFabric::PLAIN };
            let mut specimen = Specimen::new(&shape, &cloth, setup, &surroundings)?;
            let vertices = specimen.vertices();
            let before = specimen.mean(0..vertices);
            specimen.run(SLIDE.0);
            let slid = specimen.mean(0..vertices).distance(before) > SLIDE.1;
            Ok((CaseOutcome::of(&specimen, degrees), slid))
        })
    };
    ValidationCase {
        name: "incline",
        parameter: format!("mu {mu}"),
        mesh: MeshStyle::Grid.name(),
        resolution: PATCH.1,
        unit: "deg",
        expected: exact,
        scale: None,
        target: Some(SLOPE_DEGREES / exact * 100.0),
        run: Box::new(run),
    }
}

/// A patch that is thrown along the floor: v^2 / 2 mu g.
fn stopping(speed: f64, mu: f64) -> ValidationCase {
    let run = move |setup: CaseSetup<'_>| {
        let (shape, surroundings) = patch(0.0, 0.0);
        let cloth = CaseFabric { friction: mu, ..CaseFabric::PLAIN };
        let mut specimen = Specimen::new(&shape, &cloth, setup, &surroundings)?;
        let vertices = specimen.vertices();
        (0..vertices).for_each(|v| specimen.put(v, specimen.at(v), DVec3::X * speed));
        let settled = specimen.rest(2.0 * speed / (mu * G) + 1.0);
        Ok(CaseOutcome::of(&specimen, specimen.mean(0..vertices).x).settled(settled))
    };
    ValidationCase {
        name: "stopping",
        parameter: format!("{speed} m/s, mu {mu}"),
        mesh: MeshStyle::Grid.name(),
        resolution: PATCH.1,
        unit: "m",
        expected: speed * speed / (2.0 * mu * G),
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}
