//! A scene of own colliders: a cloth falls over a rail and a ball that rolls away under it, beside a wall.
//!
//! `cargo run --release -p toile-engine --example own_colliders`

use std::error::Error;

use glam::{Affine3A, Vec3, Vec4};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step, step::measure};
use toile_engine::colliders::{ColliderError, Colliders, RestSphere};

/// Rows and columns of particles, and the distance between neighbours (m).
const SIZE: u32 = 33;
const CELL: f32 = 0.025;
/// The rail: a capsule between two spheres that stand. The ball: a capsule between a sphere and itself.
const RAIL: [Vec4; 2] = [Vec4::new(-0.5, 0.75, -0.15, 0.03), Vec4::new(0.5, 0.75, -0.15, 0.03)];
const BALL: Vec4 = Vec4::new(0.0, 0.55, 0.2, 0.15);
/// How fast the ball rolls away (m/s), from this time on (s).
const ROLLS: (f32, f32) = (0.4, 1.0);
/// A wall at z = 0.45 that faces the cloth: its normal, and the offset along it (m).
const WALL: Vec4 = Vec4::new(0.0, 0.0, -1.0, -0.45);
/// Length of the run (s).
const SECONDS: u32 = 3;

/// Where the spheres are at a time (s).
fn spheres(time: f32) -> [Vec4; 3] {
    let (speed, from) = ROLLS;
    [RAIL[0], RAIL[1], BALL + Vec4::X * speed * (time - from).max(0.0)]
}

fn main() -> Result<(), Box<dyn Error>> {
    // Spheres and the pairs of them that capsules join; `true` is the floor at y = 0. Every capacity is checked here.
    let still = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.0 };
    let mut colliders = Colliders::new(&[still; 3], &[[0, 1], [2, 2]], true)?;
    colliders.set_planes(&[WALL])?;
    colliders.place_spheres(&spheres(0.0));
    match Colliders::new(&[still; 200], &[], true) {
        Err(ColliderError::TooManySpheres(200)) => {}
        other => return Err(format!("200 spheres were not refused as too many: {other:?}").into()),
    }

    let half = (SIZE - 1) as f32 * CELL * 0.5;
    let place = |row: u32, column: u32| (Vec3::new(column as f32 * CELL - half, 0.9, row as f32 * CELL - half), false);
    let shape = Shape::sheet(SIZE, SIZE, place);
    let cloth = bake("throw", "one size", &shape, &toile_assets::fabric::built_in("cotton-jersey")?)?;
    let mut state = Cloth::new(&cloth, &colliders);
    let (palette, settings) = ([Affine3A::IDENTITY; BONES], Settings::default());
    let (mut deepest, mut worst) = (0.0f32, 0.0f32);
    for step in 1..=SECONDS * STEP_HZ {
        // Spheres move from where they were to here within the step, and contact follows them on their way.
        colliders.place_spheres(&spheres(step as f32 / STEP_HZ as f32));
        state.step(&cloth, &Step { palette: &palette, colliders: &colliders, settings: &settings });
        deepest = deepest.max(measure::penetration(&mut state, &cloth, &colliders));
        worst = worst.max(measure::strain(&mut state, &cloth).mean);
        if step % STEP_HZ == 0 {
            let low = state.positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
            let far = state.positions.iter().map(|p| p.z).fold(f32::MIN, f32::max);
            println!("{} s: lowest {low:.2} m, nearest to the wall {:.2} m", step / STEP_HZ, 0.45 - far);
            if low < -1e-3 || far > 0.45 + 1e-3 {
                return Err("the cloth went through the floor or the wall".into());
            }
        }
    }
    println!(
        "deepest inside the rail or the ball {:.2} mm, mean strain {:.2} % at worst",
        deepest * 1e3,
        worst * 100.0
    );
    println!("pairs of particle and capsule that were near, over all steps: {}", state.contact_counts().near);
    if deepest > 0.002 || worst > 0.03 || state.events.rolled_back > 0 {
        return Err("the cloth went through something, was torn, or a step failed".into());
    }
    Ok(())
}
