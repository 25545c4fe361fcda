//! Cloth on cloth: the rope around a post that wears a sleeve, the patch on a sheet that leans, the weight of a coat.

use std::f64::consts::PI;

use glam::{Affine3A, DVec3, Vec3A, Vec4};
use toile_bake::Shape;
use toile_base::fabric::USUAL_THICKNESS_MM;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::string;
use crate::validate::layered::LayeredSpecimen;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, SpecimenError, Surroundings};

use super::rope::{LoadedRope, POST, ROPE_LOADS, ROPE_ROWS, ROPE_WATCH, around, rope_length};
use super::search::threshold;

/// The gap that two cloths keep (m): half of both thicknesses, which are as usual.
const APART: f64 = USUAL_THICKNESS_MM as f64 * 1e-3;

/// How much rougher the lower fabric is than the mean of both, and the upper one smoother (1): their friction is the mean.
const ROUGHER: f64 = 1.0 / 3.0;

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = Vec::new();
    for load in ROPE_LOADS {
        all.extend([0.3, 0.6].map(|mu| capstan(mu, load)));
    }
    all.extend([0.2, 0.4, 0.6].map(incline));
    all.extend([Borne::ByPins, Borne::ByPlane].map(weight));
    all
}

/// A case of cloth on cloth.
fn case(name: &'static str, parameter: String, resolution: usize, expected: f64) -> ValidationCase {
    ValidationCase {
        name,
        parameter,
        mesh: MeshStyle::Grid.name(),
        resolution,
        unit: "1",
        expected,
        scale: None,
        target: None,
        run: Box::new(|_| Ok(CaseOutcome::none(f64::NAN))),
    }
}

/// A grid of so many links along and across, all of it held or none.
fn sheet([length, width]: [f64; 2], links: [usize; 2], ends: EndSupport) -> Strip {
    Strip { width, columns: links[1], ..Strip::narrow(length, links[0], [ends; 2]) }
}

/// The fabrics of a lower and of an upper piece whose friction on each other is `mu`.
fn fabrics(mu: f64) -> [CaseFabric; 2] {
    let of = |friction: f64| CaseFabric { friction, ..CaseFabric::PLAIN };
    [of(mu * (1.0 + ROUGHER)), of(mu * (1.0 - ROUGHER))]
}

/// Angle by which the sleeve goes on below the post's sides (rad).
const BELOW: f64 = 0.25 * PI;

/// Links of the sleeve along its turn, which do not fall on the rope's, and across.
const SLEEVE: [usize; 2] = [50, 4];

/// Width of the sleeve (m).
const SLEEVE_M: f64 = 0.05;

/// A rope as in `capstan`, but on a sleeve that is held around the post.
fn capstan(mu: f64, load: f64) -> ValidationCase {
    let exact = string::capstan_heavy(mu, POST / rope_length() / load);
    let run =
        move |setup: CaseSetup<'_>| threshold([1.0, exact * exact], |ratio| rope(setup, mu, [load, load * ratio]));
    ValidationCase {
        unit: "T2/T1",
        target: Some(3.0),
        run: Box::new(run),
        ..case("layer-capstan", format!("mu {mu}, load {load}"), ROPE_ROWS, exact)
    }
}

fn rope(setup: CaseSetup<'_>, mu: f64, pulls: [f64; 2]) -> Result<(CaseOutcome, bool), SpecimenError> {
    let LoadedRope { shape, ends } = LoadedRope::new(pulls);
    let [lower, upper] = fabrics(mu);
    let turn = PI + 2.0 * BELOW;
    let inner = POST - APART;
    let mut sleeve = sheet([turn * inner, SLEEVE_M], SLEEVE, EndSupport::Free)
        .shape(|along, across| around(inner, along / inner - BELOW, -across));
    hold(&mut sleeve);
    let upper = CaseFabric { damping: 5.0, stretch: 1e5, ..upper };
    let mut specimen = LayeredSpecimen::new(&[(sleeve, lower), (shape, upper)], setup.level, &Surroundings::default())?;
    let height = |specimen: &LayeredSpecimen| specimen.mean(1, ends[1].iter().copied()).y;
    let before = height(&specimen);
    specimen.run(ROPE_WATCH.0);
    let slipped = before - height(&specimen) > ROPE_WATCH.1;
    Ok((specimen.outcome(pulls[1] / pulls[0]), slipped))
}

/// Holds all of a piece where it is.
fn hold(shape: &mut Shape) {
    shape.fixed.iter_mut().for_each(|fixed| *fixed = true);
}

/// Side of the patch and of what it lies on (m), and their links.
const PATCH: (f64, usize) = (0.05, 5);
const LEANING: (f64, usize) = (0.3, 23);

/// How long the patch is watched (s) and how far it must slide (m).
const SLIDE: (f64, f64) = (1.0, 0.005);

/// A patch on a sheet that is held and leans: the slope at which it slides.
fn incline(mu: f64) -> ValidationCase {
    let run = move |setup: CaseSetup<'_>| {
        threshold([0.5 * mu, 2.0 * mu], |slope| {
            let (sin, cos) = slope.atan().sin_cos();
            let place = |x: f64, height: f64, across: f64| {
                DVec3::new(cos, -sin, 0.0) * x + DVec3::new(sin, cos, 0.0) * height - DVec3::Z * across
            };
            let flat = |(side, links): (f64, usize), height: f64| {
                sheet([side; 2], [links; 2], EndSupport::Free)
                    .shape(|along, across| place(along - 0.5 * side, height, across))
            };
            let mut below = flat(LEANING, 0.0);
            hold(&mut below);
            let [lower, upper] = fabrics(mu);
            let pieces = [(below, lower), (flat(PATCH, APART), upper)];
            let mut specimen = LayeredSpecimen::new(&pieces, setup.level, &Surroundings::default())?;
            let middle = |specimen: &LayeredSpecimen| specimen.mean(1, 0..specimen.vertices(1));
            let before = middle(&specimen);
            specimen.run(SLIDE.0);
            let slid = middle(&specimen).distance(before) > SLIDE.1;
            Ok((specimen.outcome(slope), slid))
        })
    };
    ValidationCase {
        unit: "tan",
        target: Some(2.0),
        run: Box::new(run),
        ..case("layer-incline", format!("mu {mu}"), PATCH.1, mu)
    }
}

/// What bears a coat and the shirt below it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Borne {
    /// The shirt hangs by two sides like a hammock: the links there say what they carry.
    ByPins,
    /// The shirt lies on a plane and is drawn along by one side: the links there say what the friction on the plane is, which
    /// is the coefficient times what the plane bears.
    ByPlane,
}

/// Length and width of the shirt (m), and its links.
const SHIRT: ([f64; 2], [usize; 2]) = ([1.4, 1.2], [28, 24]);

/// Side of the coat (m), and its links, which do not fall on the shirt's.
const COAT: (f64, usize) = (1.0, 21);

/// Mass of a square metre of the shirt and of the coat (kg/m2): poplin and heavy wool. The coat weighs 600 g.
const DENSITIES: [f64; 2] = [0.12, 0.6];

/// How far the middle of the hammock hangs below its ends (m).
const SAG: f64 = 0.15;

/// How fast the shirt is drawn (m/s).
const DRAWN_M_S: f64 = 0.05;

/// Time until it is looked at, and for how long (s).
const WEIGHED_S: [f64; 2] = [4.0, 1.0];

/// Friction of the shirt on the plane (1).
const ON_PLANE: f64 = 0.3;

/// A coat on a shirt: what bears both, over their weight.
fn weight(how: Borne) -> ValidationCase {
    let parameter = match how {
        Borne::ByPins => "shirt hung by two sides",
        Borne::ByPlane => "shirt drawn along a plane",
    };
    ValidationCase {
        unit: "of m g",
        target: Some(1.0),
        run: Box::new(move |setup| weighed(setup, how)),
        ..case("layer-weight", parameter.into(), SHIRT.1[0], 1.0)
    }
}

fn weighed(setup: CaseSetup<'_>, how: Borne) -> Result<CaseOutcome, SpecimenError> {
    let mut specimen = LayeredSpecimen::new(&dressed(how), setup.level, &plane(how))?;
    let step = specimen.step_seconds();
    let steps = WEIGHED_S.map(|seconds| (seconds / step).round() as u32);
    let (mut sum, mut taken) = (DVec3::ZERO, 0u32);
    for k in 1..=steps[0] + steps[1] {
        if how == Borne::ByPlane {
            let way = Vec3A::X * (DRAWN_M_S * step * f64::from(k)) as f32;
            specimen.palette[0] = Affine3A::from_translation(way.into());
        }
        specimen.step();
        if k > steps[0] {
            sum += specimen.seen(0).force_on_fixed(|_| true);
            taken += 1;
        }
    }
    let mean = sum / f64::from(taken.max(1));
    let whole = specimen.mass() * G;
    // What is fixed is pulled down by the hammock and back by the shirt that it draws.
    let got = match how {
        Borne::ByPins => -mean.y / whole,
        Borne::ByPlane => -mean.x / (ON_PLANE * whole),
    };
    Ok(specimen.outcome(got))
}

/// What is below.
fn plane(how: Borne) -> Surroundings {
    let planes = if how == Borne::ByPlane { vec![Vec4::Y] } else { Vec::new() };
    Surroundings { planes, ..Surroundings::default() }
}

/// The shirt and the coat on it.
fn dressed(how: Borne) -> [(Shape, CaseFabric); 2] {
    /// The gap that cloth keeps from a plane (m), as the cases' fabric has it.
    const GAP: f64 = 1e-3;
    let ([length, width], links) = SHIRT;
    let hangs = how == Borne::ByPins;
    let place = |along: f64, across: f64, up: f64| {
        let x = along - 0.5 * length;
        let height = if hangs { SAG * ((x / (0.5 * length)).powi(2) - 1.0) } else { GAP };
        // Drawn by the side where it ends.
        DVec3::new(if hangs { 0.97 * x } else { x }, height + up, -across)
    };
    let ends = if hangs { [EndSupport::Pinned; 2] } else { [EndSupport::Free, EndSupport::Pinned] };
    let shirt = Strip { ends, ..sheet([length, width], links, EndSupport::Free) };
    let (side, coat_links) = COAT;
    let coat = sheet([side; 2], [coat_links; 2], EndSupport::Free);
    // What is drawn would have to be drawn through the air, too, so nothing damps it. And the links that say how hard it is drawn
    // are soft: friction moves their free ends last in a substep, by mu g dt^2, which must be little beside what they give.
    let (damping, stretch) = if hangs { (5.0, 2_000.0) } else { (0.0, 100.0) };
    let cloth = |density: f64| CaseFabric { density, damping, stretch, friction: ON_PLANE, ..CaseFabric::PLAIN };
    [
        (shirt.shape(|along, across| place(along, across, 0.0)), cloth(DENSITIES[0])),
        (coat.shape(|along, across| place(along + 0.5 * (length - side), across, APART)), cloth(DENSITIES[1])),
    ]
}
