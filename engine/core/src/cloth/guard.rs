//! Guard: the door behind the cloth. Nothing that is not finite leaves this room.

use glam::Vec3A;

use super::Cloth;

/// What went wrong, counted since the garment was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Events {
    /// Steps that ended with a value that is not finite and were rolled back.
    pub rolled_back: u64,
    /// Particle substeps that were held at the speed limit.
    pub speed_limited: u64,
}

/// Rolls the garment back to its last good positions, at rest, if any position or velocity is not finite.
pub fn check(cloth: &mut Cloth) {
    // A sum is finite only if all of its parts are; one pass, no branch a particle.
    let sum: Vec3A = cloth.positions.iter().zip(&cloth.velocities).map(|(p, v)| (*p + *v) * 0.0).sum();
    if sum.is_finite() {
        cloth.good.copy_from_slice(&cloth.positions);
    } else {
        cloth.positions.copy_from_slice(&cloth.good);
        cloth.previous.copy_from_slice(&cloth.good);
        cloth.velocities.fill(Vec3A::ZERO);
        cloth.events.rolled_back += 1;
    }
}
