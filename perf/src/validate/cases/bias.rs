//! Cantilevers that were cut along the warp, along the bias and along the weft: each bends by the rigidity of its own direction.
//!
//! A cloth whose strips hang without a bend across them has along each direction the rigidity that its plate has there: at 45 degrees what was
//! measured where a fabric's file says so, else (B_warp + B_weft) / 4, of threads that know nothing of each other. What keeps a strip from
//! bending across is that it would have to stretch, so the strips are models to scale: with the length that makes of the fabric's
//! own strip one of .3 m, bending grows by the third power, stretch and shear in proportion, and the weight stays.

use glam::DVec3;
use toile_base::fabric::Fabric;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::elastica;
use crate::validate::mesh::CaseFabric;
use crate::validate::specimen::{G, Specimen, SpecimenError, Surroundings};
use crate::validate::turned::{TurnedMesh, TurnedStrip};

use super::bending::{DAMPING, LENGTH, REST_S};

/// Width of the strips (m): of a laboratory's, 25 mm, over what hangs of it.
const WIDTH: f64 = 0.15;

/// Links along them.
const ROWS: usize = 24;

/// w L^3 / B of every strip along its own direction: what makes its length.
const GAMMA: f64 = 5.0;

/// Built-in fabrics: three with a rigidity at 45 degrees (Wang, O'Brien and Ramamoorthi 2011, ACM TOG 30(4) 71) and two without.
const FABRICS: [&str; 5] = ["interlock", "denim-11oz", "cotton-trousering", "wool-suiting", "cotton-lawn"];

/// Largest error (%).
const TARGET: f64 = 5.0;

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = Vec::new();
    // What is built in is read by the tests of fabrics.
    let fabrics: Vec<Fabric> = FABRICS.iter().filter_map(|name| toile_assets::fabric::built_in(name).ok()).collect();
    for style in TurnedMesh::ALL {
        for fabric in &fabrics {
            all.extend([0, 45, 90].map(|degrees| cantilever(style, fabric, degrees)));
        }
    }
    all
}

/// Rigidity of a fabric along a direction (N m; degrees from the warp: 0, 45, 90).
fn rigidity(fabric: &Fabric, degrees: u32) -> f64 {
    let [warp, weft] = [fabric.bend_warp_un_m, fabric.bend_weft_un_m];
    let along = match degrees {
        0 => warp,
        90 => weft,
        _ => fabric.bend_bias_un_m.unwrap_or(0.25 * (warp + weft)),
    };
    1e-6 * f64::from(along)
}

fn cantilever(style: TurnedMesh, fabric: &Fabric, degrees: u32) -> ValidationCase {
    let strip = TurnedStrip { length: LENGTH, width: WIDTH, rows: ROWS, style, degrees };
    let density = f64::from(fabric.density_kg_m2);
    let own_length = (GAMMA * rigidity(fabric, degrees) / (density * G)).cbrt();
    let larger = LENGTH / own_length;
    let bend = |b: f32| 1e-6 * f64::from(b) * larger.powi(3);
    let cloth = CaseFabric {
        density,
        stretch: 0.5 * f64::from(fabric.stretch_warp_n_m + fabric.stretch_weft_n_m) * larger,
        shear: f64::from(fabric.shear_n_m) * larger,
        bend: bend(fabric.bend_warp_un_m),
        weft: Some(bend(fabric.bend_weft_un_m)),
        bias: fabric.bend_bias_un_m.map(bend),
        damping: DAMPING,
        ..CaseFabric::PLAIN
    };
    ValidationCase {
        name: "bias",
        parameter: format!("{}, {degrees} deg", fabric.name),
        mesh: style.name(),
        resolution: ROWS,
        unit: "H/W",
        expected: elastica::tip(GAMMA, 0.0).slope(),
        scale: None,
        target: Some(TARGET),
        run: Box::new(move |setup: CaseSetup<'_>| hang(setup, &strip, &cloth)),
    }
}

/// Lets a strip come to rest and reads its tip's drop over its reach.
fn hang(setup: CaseSetup<'_>, strip: &TurnedStrip, cloth: &CaseFabric) -> Result<CaseOutcome, SpecimenError> {
    let shape = strip.shape();
    let mut specimen = Specimen::new(&shape, cloth, setup, &Surroundings::default())?;
    let settled = specimen.rest(REST_S);
    let last = (-strip.length + 1e-5) as f32;
    let tip: Vec<usize> = (0..shape.cut.len()).filter(|v| shape.cut[*v].y < last).collect();
    let read = |tip: DVec3| -tip.y / tip.x;
    Ok(CaseOutcome::at_rest(&specimen, setup, |seen| read(seen.mean(tip.iter().copied()))).settled(settled))
}
