//! Strips bent by a load: the cantilever, Peirce's overhang, the tip-loaded elastica.
//!
//! All start straight and level and come to rest under the damping of [`DAMPING`], which holds nothing up.

use glam::DVec3;
use toile_bake::Shape;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::elastica;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, Specimen, SpecimenError, Surroundings};

/// Length of the strips (m): a sleeve's.
pub const LENGTH: f64 = 0.3;

/// Width of the strips that are meshed in more than one way (m).
const WIDTH: f64 = 0.1;

/// Rate of damping (1/s): near what brings a hanging strip of this length to rest soonest.
pub const DAMPING: f64 = 10.0;

/// Longest time that a strip is given to come to rest (s).
pub const REST_S: f64 = 4.0;

/// Links along the cantilever: 12.5 mm as garments have, and 9.4 mm.
const ROWS: [usize; 2] = [24, 32];

/// Its Gamma = w L^3 / B.
const GAMMAS: [f64; 12] = [0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0, 500.0, 1000.0];

/// What is run on raw noise too.
const RAW_GAMMAS: [f64; 3] = [1.0, 10.0, 100.0];

/// Between these the target holds.
const GATED: [f64; 2] = [0.3, 300.0];

/// A clamped strip, level.
#[derive(Debug, Clone, Copy)]
pub struct Cantilever {
    /// The strip's measures and mesh.
    pub strip: Strip,
    /// Its w L^3 / B.
    pub gamma: f64,
    /// Its tip's load over its own weight (1).
    pub load: f64,
}

impl Cantilever {
    /// One of the cantilevers of the table.
    pub fn new(style: MeshStyle, rows: usize, gamma: f64) -> Self {
        let ends = [EndSupport::Clamped, EndSupport::Free];
        Self { strip: Strip { length: LENGTH, width: WIDTH, rows, columns: rows / 3, style, ends }, gamma, load: 0.0 }
    }

    /// Its shape, level along x.
    pub fn shape(&self) -> Shape {
        let mut shape = self.strip.shape(|along, across| DVec3::new(along, 0.0, across));
        if self.load > 0.0 {
            // The last row has half a link's weight of its own.
            let factor = 1.0 + 2.0 * self.load * self.strip.rows as f64;
            let tip = self.tip(&shape);
            shape.heavier = vec![1.0; shape.cut.len()];
            tip.into_iter().for_each(|v| shape.heavier[v] = factor as f32);
        }
        shape
    }

    /// A fabric whose strip bends by this Gamma.
    pub fn cloth(&self) -> CaseFabric {
        let weight = CaseFabric::PLAIN.density * G;
        CaseFabric { bend: weight * LENGTH.powi(3) / self.gamma, damping: DAMPING, ..CaseFabric::PLAIN }
    }

    fn tip(&self, shape: &Shape) -> Vec<usize> {
        let last = (-self.strip.length + 1e-5) as f32;
        shape.cut.iter().enumerate().filter(|(_, p)| p.y < last).map(|(v, _)| v).collect()
    }

    /// Lets it come to rest and reads a figure off its tip (m from the clamp).
    fn hang(&self, setup: CaseSetup<'_>, read: impl Fn(DVec3) -> f64) -> Result<CaseOutcome, SpecimenError> {
        let shape = self.shape();
        let mut specimen = Specimen::new(&shape, &self.cloth(), setup, &Surroundings::default())?;
        let settled = specimen.rest(REST_S);
        let tip = self.tip(&shape);
        Ok(CaseOutcome::at_rest(&specimen, setup, |seen| read(seen.mean(tip.iter().copied()))).settled(settled))
    }
}

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = Vec::new();
    for style in MeshStyle::ALL {
        for rows in ROWS {
            all.extend(GAMMAS.map(|gamma| cantilever(Cantilever::new(style, rows, gamma))));
        }
    }
    all.extend(RAW_GAMMAS.map(|gamma| cantilever(Cantilever::new(MeshStyle::UnstructuredRaw, ROWS[0], gamma))));
    all.push(peirce());
    all.extend([0.5, 1.0, 2.0, 5.0, 10.0].map(tip_loaded));
    all
}

fn cantilever(c: Cantilever) -> ValidationCase {
    let run = move |setup: CaseSetup<'_>| c.hang(setup, |tip| -tip.y / tip.x);
    ValidationCase {
        name: "cantilever",
        parameter: format!("Gamma {}", c.gamma),
        mesh: c.strip.style.name(),
        resolution: c.strip.rows,
        unit: "H/W",
        expected: elastica::tip(c.gamma, 0.0).slope(),
        scale: None,
        target: (GATED[0]..=GATED[1]).contains(&c.gamma).then_some(5.0),
        run: Box::new(run),
    }
}

/// Angle of the chord in Peirce's test (rad).
const PEIRCE: f64 = 41.5 * std::f64::consts::PI / 180.0;

/// Rounds of the secant method: each gets three times closer at least.
const SECANTS: usize = 3;

/// The length at which the chord hangs at 41.5 degrees, in bending lengths c = (B/w)^(1/3), by the secant method over
/// Gamma = (L/c)^3 from two lengths around the exact one.
fn peirce() -> ValidationCase {
    let exact = elastica::overhang(PEIRCE);
    let run = move |setup: CaseSetup<'_>| {
        let angle = |length: f64| {
            let c = Cantilever::new(MeshStyle::Grid, ROWS[0], length.powi(3));
            c.hang(setup, |tip| (-tip.y / tip.x).atan() - PEIRCE)
        };
        let (mut a, mut b) = (0.95 * exact, 1.05 * exact);
        let (mut at_a, mut at_b) = (angle(a)?, angle(b)?);
        for _ in 0..SECANTS {
            let next = b - at_b.got * (b - a) / (at_b.got - at_a.got);
            if !next.is_finite() || (next - b).abs() < 1e-4 * b {
                break;
            }
            // Within what a strip of this mesh can be.
            let next = next.clamp(0.2 * exact, 5.0 * exact);
            (a, at_a, b) = (b, at_b, next);
            at_b = angle(b)?;
        }
        // Where the oracle's chord crosses, by the slope between the last two.
        let slope = (at_b.got - at_a.got) / (b - a);
        let solved = at_b.solved.map(|off| b - off / slope);
        Ok(CaseOutcome { got: b, solved, ..at_b })
    };
    ValidationCase {
        name: "peirce",
        parameter: "chord 41.5 deg".into(),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS[0],
        unit: "L/c",
        expected: exact,
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}

/// The tip's load over the strip's own weight: the engine knows no point loads, so that the last row is made heavier. What
/// the rest weighs is part of the exact value.
const TIP_LOAD: f64 = 2.0;

fn tip_loaded(p: f64) -> ValidationCase {
    let ends = [EndSupport::Clamped, EndSupport::Free];
    let c = Cantilever { strip: Strip::narrow(LENGTH, ROWS[0], ends), gamma: p / TIP_LOAD, load: TIP_LOAD };
    let run = move |setup: CaseSetup<'_>| c.hang(setup, |tip| -tip.y / LENGTH);
    ValidationCase {
        name: "elastica",
        parameter: format!("P L^2/B {p}"),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS[0],
        unit: "drop/L",
        expected: elastica::tip(c.gamma, p).drop,
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}
