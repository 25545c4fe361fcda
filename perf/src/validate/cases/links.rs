//! Links with more than one slope, and links that rub: a strip with a knee under its own weight, and loops of shear and stretch as the
//! Kawabata system makes them, here by a weight that grows and shrinks.

use glam::DVec3;
use toile_base::fabric::stretch_curve::StretchCurve;
use toile_base::garment::Solver;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, Specimen, SpecimenError, Surroundings};

/// Rate of damping (1/s).
const DAMPING: f64 = 4.0;

/// Longest time to come to rest (s).
const REST_S: f64 = 6.0;

/// Links along the strip that hangs, solved directly and by Gauss-Seidel.
const ROWS: usize = 32;
const SWEPT_ROWS: usize = 8;

/// Half of the strip hangs beyond the knee.
const KNEE: StretchCurve = StretchCurve { knee_percent: 1.0, knee_n_m: 1.0, beyond_n_m: 1_000.0, hysteresis_n_m: 0.0 };

/// Loops: name, shear stiffness or curve.
const SHEARED: [(&str, f64, f64); 2] = [("denim, tropical", 122.5, 4.915), ("wool suiting", 45.0, 1.0)];

/// A jersey's curve.
const STRETCHED: StretchCurve =
    StretchCurve { knee_percent: 8.0, knee_n_m: 40.0, beyond_n_m: 3_000.0, hysteresis_n_m: 6.0 };

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = vec![hung(Solver::SemiImplicit, ROWS), hung(Solver::GaussSeidel, SWEPT_ROWS)];
    for (name, g, width) in SHEARED {
        for style in [MeshStyle::Grid, MeshStyle::Alternating] {
            all.extend([Read::Slope, Read::Width].map(|read| sheared(name, [g, width], style, read)));
        }
    }
    all.extend([Read::Slope, Read::Width].map(stretched));
    all
}

/// Tip of a strip of own weight with a knee: the integral of e(T(s)), T(s) = w (L - s).
fn hung(solver: Solver, rows: usize) -> ValidationCase {
    let strip = Strip::narrow(1.0, rows, [EndSupport::Pinned, EndSupport::Free]);
    let cloth = CaseFabric { curve: Some(KNEE), shear: 1.0, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| {
        let mut shape = strip.shape(|along, across| DVec3::new(across, -along, 0.0));
        shape.solver.warp = Some(solver);
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let settled = specimen.rest(REST_S);
        let tip = || (0..specimen.vertices()).filter(|v| shape.worn[*v].y < -1.0 + 1e-4);
        Ok(CaseOutcome::at_rest(&specimen, setup, |seen| -seen.mean(tip()).y - 1.0).settled(settled))
    };
    let (link_curve, weight) = (KNEE.link_curve(), cloth.density * G);
    const STEPS: u32 = 10_000;
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(STEPS);
    let expected = (0..STEPS).map(|k| link_curve.deformation(weight * at(k))).sum::<f64>() / f64::from(STEPS);
    ValidationCase {
        name: "stretch-curve",
        parameter: format!("100 to 1,000 N/m, {}", if solver == Solver::SemiImplicit { "direct" } else { "swept" }),
        mesh: MeshStyle::Grid.name(),
        resolution: rows,
        unit: "m",
        expected,
        scale: None,
        target: Some(0.5),
        run: Box::new(run),
    }
}

/// What is read off a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Read {
    Slope,
    Width,
}

/// How much heavier the end is than cloth (1): the load is there, and gravity small, so that what falls freely within a substep is less
/// than what sticks.
const HEAVIER: f32 = 1_000.0;

/// Loads on the way from one end of the loop to the other, a step each: so slow that nothing swings, which would shake friction loose.
const LOADS: i32 = 4_000;

/// One of so many is read.
const READ: i32 = 16;

/// Deformation and force for a width on the way up and on the way down of the second loop, while a load goes to and fro.
type Branches = [Vec<[f64; 2]>; 2];

/// Slope and width between two deformations: those of the lines that lie nearest to what the branches have between them.
fn read(branches: &Branches, at: [f64; 2]) -> [f64; 2] {
    let middle = 0.5 * (at[0] + at[1]);
    let lines = branches.each_ref().map(|branch| {
        let within = || branch.iter().filter(|p| (at[0]..=at[1]).contains(&p[0]));
        let count = within().count() as f64;
        let mean = |k: usize| within().map(|p| p[k]).sum::<f64>() / count;
        let [d, force] = [mean(0), mean(1)];
        let slope = within().map(|p| (p[0] - d) * (p[1] - force)).sum::<f64>()
            / within().map(|p| (p[0] - d).powi(2)).sum::<f64>();
        [slope, force + slope * (middle - d)]
    });
    let [up, down] = lines;
    [0.5 * (up[0] + down[0]), up[1] - down[1]]
}

/// Loads a specimen by gravity (m/s2), `most` to `least` and back, and calls `deformed` with it and the gravity at each load.
fn cycle(specimen: &mut Specimen, [least, most]: [f64; 2], deformed: impl Fn(&Specimen, f64) -> [f64; 2]) -> Branches {
    let mut branches = [Vec::new(), Vec::new()];
    let mut load = |branch: Option<usize>, from: f64, to: f64| {
        for k in 1..=LOADS {
            let gravity = from + (to - from) * f64::from(k) / f64::from(LOADS);
            specimen.settings.gravity = glam::Vec3A::NEG_Y * gravity as f32;
            specimen.step();
            if let Some(branch) = branch.filter(|_| k % READ == 0) {
                branches[branch].push(deformed(specimen, gravity));
            }
        }
    };
    load(None, 0.0, most);
    load(Some(1), most, least);
    load(Some(0), least, most);
    branches
}

/// A strip that is held along one long side and drawn down along the other: its cells shear alike.
fn sheared(name: &str, [g, width]: [f64; 2], style: MeshStyle, what: Read) -> ValidationCase {
    const LENGTH: f64 = 0.02;
    const CELLS: usize = 15;
    let ends = [EndSupport::Pinned, EndSupport::Free];
    let strip = Strip { length: LENGTH, width: CELLS as f64 * LENGTH, rows: 1, columns: CELLS, style, ends };
    // Threads that hardly stretch: else the diagonals draw them together, by 2 G / E of the angle.
    let cloth = CaseFabric { stretch: 1e6, shear: g, shear_loop: width, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| -> Result<CaseOutcome, SpecimenError> {
        let mut shape = strip.shape(|along, across| DVec3::new(along, across, 0.0));
        let free: Vec<usize> = (0..shape.cut.len()).filter(|v| !shape.fixed[*v]).collect();
        shape.heavier = shape.fixed.iter().map(|fixed| if *fixed { 1.0 } else { HEAVIER }).collect();
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let per_width = specimen.mass() / strip.width;
        let most = (g * 8f64.to_radians() + 0.5 * width) / per_width;
        let branches = cycle(&mut specimen, [-most, most], |specimen, gravity| {
            let angle = (-specimen.mean(free.iter().copied()).y / LENGTH).asin();
            [angle, gravity * per_width * angle.cos()]
        });
        let [slope, width] = read(&branches, [0.5, 2.5].map(f64::to_radians));
        Ok(CaseOutcome::of(&specimen, if what == Read::Slope { slope } else { width }))
    };
    ValidationCase {
        name: "loop",
        parameter: format!("{name}, {}", if what == Read::Slope { "G" } else { "2HG" }),
        mesh: style.name(),
        resolution: CELLS,
        unit: "N/m",
        expected: if what == Read::Slope { g } else { width },
        scale: None,
        target: Some(1.0),
        run: Box::new(run),
    }
}

/// A strip that is drawn at its end, beyond the knee and back: slope below the knee, width of the loop.
fn stretched(what: Read) -> ValidationCase {
    const LENGTH: f64 = 0.08;
    const LINKS: usize = 4;
    let strip = Strip::narrow(LENGTH, LINKS, [EndSupport::Pinned, EndSupport::Free]);
    let cloth = CaseFabric { curve: Some(STRETCHED), shear: 1.0, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| -> Result<CaseOutcome, SpecimenError> {
        let mut shape = strip.shape(|along, across| DVec3::new(across, -along, 0.0));
        let end: Vec<usize> = (0..shape.cut.len()).filter(|v| shape.cut[*v].y < (-LENGTH + 1e-5) as f32).collect();
        shape.heavier = shape.worn.iter().map(|p| if p.y < (-LENGTH + 1e-5) as f32 { HEAVIER } else { 1.0 }).collect();
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let per_width = specimen.mass() / strip.width;
        let most = 3.0 * f64::from(STRETCHED.knee_n_m) / per_width;
        let branches = cycle(&mut specimen, [0.0, most], |specimen, gravity| {
            [-specimen.mean(end.iter().copied()).y / LENGTH - 1.0, gravity * per_width]
        });
        let [slope, width] = read(&branches, [0.4, 0.8].map(|part| 0.01 * part * f64::from(STRETCHED.knee_percent)));
        Ok(CaseOutcome::of(&specimen, if what == Read::Slope { slope } else { width }))
    };
    ValidationCase {
        name: "loop",
        parameter: format!("jersey, {}", if what == Read::Slope { "stretch below the knee" } else { "its width" }),
        mesh: MeshStyle::Grid.name(),
        resolution: LINKS,
        unit: "N/m",
        expected: f64::from(if what == Read::Slope { STRETCHED.below_n_m() } else { STRETCHED.hysteresis_n_m }),
        scale: None,
        target: Some(1.0),
        run: Box::new(run),
    }
}
