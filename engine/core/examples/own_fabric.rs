//! An own fabric: figures of a data sheet become cloth, and the cloth shows them again.
//!
//! `cargo run --release -p toile-engine --example own_fabric`
//!
//! A strip hangs from a rail with a bar in its hem. How much longer it becomes is what its stiffness says: force over
//! stiffness times width.

use std::error::Error;

use glam::{Affine3A, Vec3};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Quality, Settings, Step};
use toile_engine::colliders::Colliders;

/// What a mill prints, in the units that Toile reads: mass, stiffness along warp and weft, shear, bending.
const STRETCHY: &str = r#"
name = "ribbed-knit"
title = "Ribbed knit"
density_kg_m2 = 0.22
stretch_warp_n_m = 300.0
stretch_weft_n_m = 120.0
shear_n_m = 25.0
bend_warp_un_m = 6.0
bend_weft_un_m = 4.0
friction = 0.5
damping_per_s = 1.0
contact_offset_mm = 2.0
comfortable_stretch = 0.2
colour = [0.30, 0.42, 0.55]
"#;

/// Rows and columns of particles, and the distance between neighbours (m).
const ROWS: u32 = 41;
const COLUMNS: u32 = 11;
const CELL: f32 = 0.025;
/// Height of the rail (m).
const TOP: f32 = 1.0;
/// How many times heavier than its fabric the hem is.
const BAR: f32 = 50.0;
/// It comes to rest for so long, then is measured for so long (s).
const SETTLE_S: u32 = 5;
const MEAN_S: u32 = 3;

/// How much longer the strip is after some seconds, and how much by its data sheet (1).
fn stretched(fabric: &Fabric) -> Result<[f32; 2], Box<dyn Error>> {
    let place = |row: u32, column: u32| (Vec3::new(column as f32 * CELL, TOP - row as f32 * CELL, 0.0), row == 0);
    let mut shape = Shape::sheet(ROWS, COLUMNS, place);
    let last = ((ROWS - 1) * COLUMNS) as usize;
    shape.heavier = vec![1.0; shape.cut.len()];
    shape.heavier[last..].fill(BAR);
    let strip = bake("strip", "one size", &shape, fabric)?;
    let colliders = Colliders::new(&[], &[], false)?;
    let mut cloth = Cloth::new(&strip, &colliders);
    let settings = Settings { quality: Quality::Fine, ..Settings::default() };
    let palette = [Affine3A::IDENTITY; BONES];
    let middle = strip.source.iter().position(|v| *v as usize == last + COLUMNS as usize / 2).unwrap_or(0);
    // What still swings after some seconds is averaged out.
    let (mut sum, length) = (0.0, (ROWS - 1) as f32 * CELL);
    for step in 0..(SETTLE_S + MEAN_S) * STEP_HZ {
        cloth.step(&strip, &Step { palette: &palette, colliders: &colliders, settings: &settings });
        if step >= SETTLE_S * STEP_HZ {
            sum += (TOP - cloth.positions[middle].y) / length - 1.0;
        }
    }
    let found = sum / (MEAN_S * STEP_HZ) as f32;

    // By hand: each row carries what hangs below it.
    let width = (COLUMNS - 1) as f32 * CELL;
    let row = fabric.density_kg_m2 * width * CELL;
    let weight = |link: u32| ((ROWS - 2 - link) as f32 * row + 0.5 * row * BAR) * 9.81;
    let sum: f32 = (0..ROWS - 1).map(|link| weight(link) / (fabric.stretch_warp_n_m * width)).sum();
    Ok([found, sum / (ROWS - 1) as f32])
}

fn main() -> Result<(), Box<dyn Error>> {
    for fabric in
        [toile_assets::fabric::parse("ribbed-knit.toml", STRETCHY)?, toile_assets::fabric::built_in("cotton-jersey")?]
    {
        let [found, sheet] = stretched(&fabric)?;
        println!("{:<14} longer by {:.2} %, by its data sheet {:.2} %", fabric.title, found * 100.0, sheet * 100.0);
        if (found / sheet - 1.0).abs() > 0.02 {
            return Err(format!("{} does not stretch as its file says", fabric.name).into());
        }
    }
    // Grams in place of kilograms are refused by key, value and range.
    let slip = STRETCHY.replace("density_kg_m2 = 0.22", "density_kg_m2 = 220");
    match toile_assets::fabric::parse("ribbed-knit.toml", &slip) {
        Ok(_) => Err("a fabric of 220 kg/m2 was read".into()),
        Err(refused) => {
            println!("refused: {refused}");
            Ok(())
        }
    }
}
