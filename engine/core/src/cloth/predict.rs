//! Predict: gravity and air move every free particle; the skinned ones follow the body.

use glam::Vec3A;
use toile_assets::garment::Garment;

use super::{Cloth, Settings};

/// Semi-implicit Euler: v += g dt, damped by the air; x += v dt.
pub fn predict(cloth: &mut Cloth, garment: &Garment, settings: &Settings, dt: f32) {
    let kept = (-garment.fabric.damping_per_s * dt).exp();
    let fall = settings.gravity * dt;
    let particles = cloth.positions.iter_mut().zip(&mut cloth.previous).zip(&cloth.velocities);
    for (((position, previous), velocity), &w) in particles.zip(&garment.inverse_mass) {
        *previous = *position;
        // A skinned particle has no velocity of its own; the select keeps the loop free of branches.
        let v = if w > 0.0 { (*velocity + fall) * kept } else { Vec3A::ZERO };
        *position += v * dt;
    }
}

/// Puts the skinned particles where the body has them at `to` (0..1) of the step.
pub fn carry_fixed(cloth: &mut Cloth, garment: &Garment, to: f32) {
    for (k, &i) in garment.fixed.iter().enumerate() {
        cloth.positions[i as usize] = cloth.fixed_start[k].lerp(cloth.fixed_end[k], to);
    }
}
