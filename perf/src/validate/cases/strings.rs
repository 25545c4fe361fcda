//! What only stretches and hangs: the hanging strip, the catenary. Strips two particles wide that do not bend.

use glam::DVec3;

use crate::validate::CaseSetup;
use crate::validate::case::{CaseOutcome, ValidationCase};
use crate::validate::exact::string;
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::validate::specimen::{G, ParticlePlaces, Specimen, Surroundings};

/// Links along the strings.
const ROWS: usize = 32;

/// Rate of damping (1/s).
const DAMPING: f64 = 5.0;

/// Longest time to come to rest (s).
const REST_S: f64 = 6.0;

/// Shear stiffness of what is to stretch alone (N/m): next to none.
const SHEAR: f64 = 1.0;

/// That of a woven cloth (N/m).
const CLOTH: f64 = CaseFabric::PLAIN.shear;

/// The cases of this module.
pub fn cases() -> Vec<ValidationCase> {
    let mut all = Vec::new();
    for stretch in [60.0, 600.0, 6_000.0] {
        all.extend([Hung::Tip, Hung::Top].map(|what| strip(stretch, SHEAR, what)));
    }
    for length in [1.05, 1.2, 1.5, 2.0] {
        all.extend([Slung::Sag, Slung::Tension].map(|what| catenary(length, SHEAR, what)));
    }
    // As cloth shears: the tip, where shear is a tenth of what holds it, and the pull of a slack catenary.
    all.extend([600.0, 6_000.0].map(|stretch| strip(stretch, CLOTH, Hung::Tip)));
    all.push(catenary(1.2, CLOTH, Slung::Tension));
    all.extend([20.0, 60.0, 200.0].map(shear));
    all
}

/// Side of the sheared sheet (m).
const SHEET: f64 = 0.3;

/// How many times as tall as wide it is. At its free sides there is no shear, so that within L sqrt(G/E) of them it
/// sags more: by a fifth of the width where G is highest, which is nothing any more at half its height.
const TALL: usize = 3;

/// A sheet that is held along both upright sides sags by w L^2 / 8G in its middle, by shear alone: its upright threads
/// only sink, its level ones turn.
fn shear(stiffness: f64) -> ValidationCase {
    let (rows, held) = (16, [EndSupport::Pinned, EndSupport::Pinned]);
    let tall = TALL as f64 * SHEET;
    let strip = Strip { width: tall, columns: TALL * rows, ..Strip::narrow(SHEET, rows, held) };
    let cloth = CaseFabric { shear: stiffness, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| {
        let shape = strip.shape(|along, across| DVec3::new(along, across, 0.0));
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let settled = specimen.rest(REST_S);
        let at = |v: usize, axis: usize, middle: f64| (f64::from(shape.worn[v][axis]) - middle).abs() < 1e-4;
        let middle = || (0..specimen.vertices()).filter(|&v| at(v, 0, 0.5 * SHEET) && at(v, 1, 0.0));
        let before = middle().map(|v| f64::from(shape.worn[v].y)).sum::<f64>() / middle().count().max(1) as f64;
        Ok(CaseOutcome::at_rest(&specimen, setup, |seen| before - seen.mean(middle()).y).settled(settled))
    };
    ValidationCase {
        name: "shear-sag",
        parameter: format!("G {stiffness} N/m"),
        mesh: MeshStyle::Grid.name(),
        resolution: rows,
        unit: "m",
        expected: cloth.density * G * SHEET * SHEET / (8.0 * stiffness),
        scale: None,
        target: Some(5.0),
        run: Box::new(run),
    }
}

/// What a parameter says of a shear stiffness (N/m) that is felt.
fn sheared(shear: f64) -> String {
    if shear > SHEAR { format!(", G {shear} N/m") } else { String::new() }
}

/// What is read off a hanging strip.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Hung {
    /// How far its tip has come down: w L^2 / 2E.
    Tip,
    /// The pull of its highest links, over the weight that hangs on them.
    Top,
}

fn strip(stretch: f64, shear: f64, what: Hung) -> ValidationCase {
    let strip = Strip::narrow(1.0, ROWS, [EndSupport::Pinned, EndSupport::Free]);
    let cloth = CaseFabric { stretch, shear, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| {
        let shape = strip.shape(|along, across| DVec3::new(across, -along, 0.0));
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let settled = specimen.rest(REST_S);
        let tip = || (0..specimen.vertices()).filter(|v| shape.cut[*v].y < -1.0 + 1e-4);
        let read = |seen: &ParticlePlaces<'_>| match what {
            Hung::Tip => -seen.mean(tip()).y - 1.0,
            Hung::Top => -seen.force_on_fixed(|_| true).y / (specimen.mass() * G),
        };
        Ok(CaseOutcome::at_rest(&specimen, setup, read).settled(settled))
    };
    let [name, unit] = match what {
        Hung::Tip => ["strip", "m"],
        Hung::Top => ["top-force", "T/weight"],
    };
    ValidationCase {
        name,
        parameter: format!("E {stretch} N/m{}", sheared(shear)),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS,
        unit,
        expected: if what == Hung::Tip { cloth.density * G / (2.0 * stretch) } else { 1.0 },
        scale: None,
        target: Some(if what == Hung::Tip { 1.0 } else { 2.0 }),
        run: Box::new(run),
    }
}

/// What is read off a catenary.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slung {
    Sag,
    Tension,
}

/// A strip between two points a metre apart, let go from a V.
fn catenary(length: f64, shear: f64, what: Slung) -> ValidationCase {
    let strip = Strip::narrow(length, ROWS, [EndSupport::Pinned, EndSupport::Pinned]);
    let cloth = CaseFabric { stretch: 3e4, shear, damping: DAMPING, ..CaseFabric::PLAIN };
    let run = move |setup: CaseSetup<'_>| {
        let depth = (0.25 * length * length - 0.25).sqrt();
        let shape = strip.shape(|along, across| {
            let part = along / length;
            DVec3::new(part - 0.5, -depth * (1.0 - (2.0 * part - 1.0).abs()), across)
        });
        let mut specimen = Specimen::new(&shape, &cloth, setup, &Surroundings::default())?;
        let settled = specimen.rest(REST_S);
        let weight = cloth.density * G * strip.width * length;
        let read = |seen: &ParticlePlaces<'_>| match what {
            Slung::Sag => -seen.lowest(),
            Slung::Tension => seen.force_on_fixed(|p| p.x < 0.0).x / weight,
        };
        Ok(CaseOutcome::at_rest(&specimen, setup, read).settled(settled))
    };
    let exact = string::catenary(length);
    ValidationCase {
        name: "catenary",
        parameter: format!("length {length}, {}{}", if what == Slung::Sag { "sag" } else { "pull" }, sheared(shear)),
        mesh: MeshStyle::Grid.name(),
        resolution: ROWS,
        unit: if what == Slung::Sag { "spans" } else { "T0/weight" },
        expected: if what == Slung::Sag { exact.sag } else { exact.tension },
        scale: None,
        target: Some(2.0),
        run: Box::new(run),
    }
}
