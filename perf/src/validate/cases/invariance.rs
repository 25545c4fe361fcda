//! What must not matter: statics are the same when stiffnesses and mass are scaled together, when the mesh is renumbered,
//! turned or mirrored, when the step is halved. Held against the engine's own cantilever at the same level.

use glam::DQuat;
use toile_bake::Shape;
use toile_bake::shape::NO_VERTEX;
use toile_base::numeric::random::SplitMix64;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::mesh::{CaseFabric, MeshStyle};
use crate::validate::specimen::{Specimen, SpecimenError, Surroundings};

use super::bending::{Cantilever, REST_S};

/// The cantilever that is changed: its bending is carried whole by the quality `fine`, so that nothing but the change
/// shows.
const GAMMA: f64 = 300.0;

/// Links along the strip.
const ROWS: usize = 24;

toile_base::named! {
    /// How it is changed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    enum Change {
        Scaled = "mass and stiffness x 3",
        Renumbered = "renumbered",
        Turned = "turned 37 deg",
        Mirrored = "mirrored",
        HalfStep = "step halved",
    }
}

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    MeshStyle::ALL.into_iter().flat_map(|style| Change::ALL.map(|change| case(style, change))).collect()
}

fn case(style: MeshStyle, change: Change) -> ValidationCase {
    let run = move |setup: CaseSetup<'_>| {
        let (_, plain) = hung(style, None, setup)?;
        let (specimen, changed) = hung(style, Some(change), setup)?;
        Ok(CaseOutcome::of(&specimen, changed / plain))
    };
    ValidationCase {
        name: "invariance",
        parameter: change.name().into(),
        mesh: style.name(),
        resolution: ROWS,
        unit: "drop/drop",
        expected: 1.0,
        scale: None,
        target: Some(1.0),
        run: Box::new(run),
    }
}

/// The specimen at rest, and how far its tip has come down (m).
fn hung(style: MeshStyle, change: Option<Change>, setup: CaseSetup<'_>) -> Result<(Specimen, f64), SpecimenError> {
    let c = Cantilever::new(style, ROWS, GAMMA);
    let (mut shape, mut cloth) = (c.shape(), c.cloth());
    // By place, so that the numbers may change.
    let mut tip: Vec<bool> = shape.worn.iter().map(|p| p.x > (c.strip.length - 1e-5) as f32).collect();
    match change {
        Some(Change::Scaled) => {
            let CaseFabric { density, stretch, shear, bend, .. } = cloth;
            let [density, stretch, shear, bend] = [density, stretch, shear, bend].map(|x| 3.0 * x);
            cloth = CaseFabric { density, stretch, shear, bend, ..cloth };
        }
        Some(Change::Renumbered) => tip = renumber(&mut shape, &tip),
        Some(Change::Turned) => {
            let turn = DQuat::from_rotation_y(37f64.to_radians()).as_quat();
            shape.cut.iter_mut().chain(&mut shape.worn).for_each(|p| *p = turn * *p);
        }
        Some(Change::Mirrored) => mirror(&mut shape),
        Some(Change::HalfStep) | None => {}
    }
    let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
    if change == Some(Change::HalfStep) {
        specimen.settings.step_seconds *= 0.5;
    }
    specimen.rest(REST_S);
    let drop = -specimen.mean((0..tip.len()).filter(|v| tip[*v])).y;
    Ok((specimen, drop))
}

/// Shuffles the vertices and the faces; gives the tip by its new numbers.
fn renumber(shape: &mut Shape, tip: &[bool]) -> Vec<bool> {
    let mut random = SplitMix64::new(7);
    let count = shape.cut.len();
    let mut old: Vec<usize> = (0..count).collect();
    (1..count).rev().for_each(|i| old.swap(i, (random.uniform_f64() * (i + 1) as f64) as usize));
    let mut new = vec![0u32; count];
    old.iter().enumerate().for_each(|(i, o)| new[*o] = i as u32);
    fn moved<T: Copy>(of: &[T], old: &[usize]) -> Vec<T> {
        old.iter().map(|o| of[*o]).collect()
    }
    shape.cut = moved(&shape.cut, &old);
    shape.worn = moved(&shape.worn, &old);
    shape.fixed = moved(&shape.fixed, &old);
    shape.parts = moved(&shape.parts, &old);
    shape.weights = moved(&shape.weights, &old);
    let corner = |v: u32| if v == NO_VERTEX { v } else { new[v as usize] };
    shape.faces = shape.faces.iter().map(|f| f.map(corner)).collect();
    let faces = shape.faces.len();
    (1..faces).rev().for_each(|i| shape.faces.swap(i, (random.uniform_f64() * (i + 1) as f64) as usize));
    moved(tip, &old)
}

/// Left and right exchanged; faces keep looking to the front.
fn mirror(shape: &mut Shape) {
    shape.cut.iter_mut().for_each(|p| p.x = -p.x);
    shape.worn.iter_mut().for_each(|p| p.z = -p.z);
    for [a, b, c, d] in &mut shape.faces {
        if *d == NO_VERTEX {
            std::mem::swap(b, c);
        } else {
            std::mem::swap(a, b);
            std::mem::swap(c, d);
        }
    }
}
