//! Settle: velocities from where the particles came to lie.

use toile_assets::garment::Garment;

use super::{Cloth, Settings};

/// v = (x - previous) / dt, limited to the settings' speed. A particle over the limit is also put back to where that
/// speed would have brought it, so that position and velocity agree.
pub fn settle(cloth: &mut Cloth, garment: &Garment, settings: &Settings, dt: f32) {
    let farthest = settings.max_speed * dt;
    let particles = cloth.positions.iter_mut().zip(&cloth.previous).zip(&mut cloth.velocities);
    for (((position, previous), velocity), &w) in particles.zip(&garment.inverse_mass) {
        let mut moved = *position - *previous;
        let distance2 = moved.length_squared();
        if w > 0.0 && distance2 > farthest * farthest {
            moved *= farthest / distance2.sqrt();
            *position = *previous + moved;
            cloth.events.speed_limited += 1;
        }
        *velocity = moved / dt;
    }
}
