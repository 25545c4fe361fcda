//! A hanging cloth: the engine without a body. A sheet is made, baked and stepped until it hangs still.
//!
//! `cargo run --release -p toile-engine --example hanging_cloth`

use std::error::Error;

use glam::{Affine3A, Vec3, Vec3A};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step, step::measure};
use toile_engine::colliders::Colliders;

/// Rows and columns of particles.
const SIZE: u32 = 41;
/// Distance between neighbours (m).
const CELL: f32 = 0.02;
/// Height of the upper edge (m).
const TOP: f32 = 2.0;
/// Length of the run (s).
const SECONDS: u32 = 10;

fn main() -> Result<(), Box<dyn Error>> {
    // At load: what is baked is shared and never changes, what is stepped owns all its storage from here on.
    let place = |row: u32, column: u32| (Vec3::new(column as f32 * CELL, TOP - row as f32 * CELL, 0.0), row == 0);
    let shape = Shape::sheet(SIZE, SIZE, place);
    let fabric = toile_assets::fabric::built_in("cotton-lawn")?;
    let garment = bake("curtain", "one size", &shape, &fabric)?;
    let colliders = Colliders::new(&[], &[], false)?;
    let mut cloth = Cloth::new(&garment, &colliders);
    // A puff of air from behind: every free particle starts at half a metre a second.
    for i in (0..garment.particles()).filter(|&i| garment.inverse_mass[i] > 0.0) {
        cloth.disturb(i, garment.start[i].into(), Vec3A::Z * 0.5);
    }

    // In the frame: a step borrows everything and allocates nothing. What is held follows bone 0, which stands.
    let (palette, settings) = ([Affine3A::IDENTITY; BONES], Settings::default());
    let step = Step { palette: &palette, colliders: &colliders, settings: &settings };
    let mut widest = 0.0f32;
    for _ in 0..SECONDS * STEP_HZ {
        cloth.step(&garment, &step);
        widest = cloth.positions.iter().fold(widest, |most, p| most.max(p.z.abs()));
    }

    let strain = measure::strain(&mut cloth, &garment);
    let energy = cloth.kinetic_energy(&garment);
    let lowest = cloth.positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
    let hung = TOP - (SIZE - 1) as f32 * CELL;
    println!("{} particles, {} of them held, {} substeps", garment.particles(), garment.fixed.len(), cloth.substeps());
    println!("it swung out by {:.0} cm", widest * 100.0);
    println!("after {SECONDS} s: strain mean {:.3} %, worst {:.2} %", strain.mean * 100.0, strain.max * 100.0);
    println!("lower edge at {lowest:.3} m, {:.1} mm below that of the cloth at rest", (hung - lowest) * 1e3);

    if strain.max > 0.01 {
        return Err(
            format!("an edge is strained by {:.1} %, of cotton under its own weight", strain.max * 100.0).into()
        );
    }
    if energy > 1e-3 || cloth.events.rolled_back > 0 {
        return Err(
            format!("it still moves with {energy} J, after {} steps that failed", cloth.events.rolled_back).into()
        );
    }
    Ok(())
}
