//! Contact with the body's capsules and the floor, with Coulomb friction.
//!
//! Positions are projected out of the signed distance field of each round cone that is near; what a push moves beyond
//! the approach of this substep is taken out of the velocity again, so that nothing is shot out of a body that it was
//! found in. Friction acts on the motion relative to the moving surface (Mueller et al. 2007, section 3.5, with the
//! Coulomb bound of the push): up to mu times the push it holds, beyond that it slides.

use glam::{Vec3, Vec3A};
use toile_assets::garment::Garment;
use toile_assets::limits::{MAX_CAPSULES, STEP_SECONDS};

use super::{Cloth, Step};
use crate::colliders::{Colliders, RoundCone};

// A set bit of `Cloth::near` names a capsule.
const _: () = assert!(MAX_CAPSULES <= 32);

/// Particles this much farther away than they can travel in a step are still looked at (m).
const SLACK_M: f32 = 0.004;

/// Finds the capsules that each free particle may touch during the step: first by bounding box, then by distance.
pub fn find_near(cloth: &mut Cloth, garment: &Garment, step: &Step<'_>) {
    let reaches = Reaches::new(step.colliders);
    let offset = garment.fabric.contact_offset_mm * 1e-3 + SLACK_M;
    let fall = step.settings.gravity.length() * STEP_SECONDS;
    let particles = cloth.positions.iter().zip(&cloth.velocities).zip(&garment.inverse_mass);
    for (((p, v), w), near) in particles.zip(&mut cloth.near) {
        let mut bits = 0u32;
        if *w > 0.0 {
            // Twice its present motion: a particle may be jerked along by its neighbours.
            let margin = offset + 2.0 * (v.length() + fall) * STEP_SECONDS;
            for c in 0..reaches.count {
                let inside = (p.cmpge(reaches.low[c] - margin) & p.cmple(reaches.high[c] + margin)).all();
                if inside && reaches.cones[c].contact((*p).into()).distance < margin + reaches.travel[c] {
                    bits |= 1 << c;
                }
            }
        }
        *near = bits;
    }
}

/// Where each capsule is at the start of the step and how far it reaches during it.
struct Reaches {
    count: usize,
    cones: [RoundCone; MAX_CAPSULES],
    low: [Vec3A; MAX_CAPSULES],
    high: [Vec3A; MAX_CAPSULES],
    travel: [f32; MAX_CAPSULES],
}

impl Reaches {
    fn new(colliders: &Colliders) -> Self {
        let mut this = Self {
            count: colliders.capsules().len(),
            cones: colliders.cones_at(0.0),
            low: [Vec3A::INFINITY; MAX_CAPSULES],
            high: [Vec3A::NEG_INFINITY; MAX_CAPSULES],
            travel: [0.0; MAX_CAPSULES],
        };
        for (c, ends) in colliders.capsules().iter().enumerate() {
            for s in ends.map(usize::from) {
                for sphere in [colliders.start()[s], colliders.end()[s]] {
                    let (centre, radius) = (Vec3A::from_vec4(sphere), sphere.w);
                    this.low[c] = this.low[c].min(centre - radius);
                    this.high[c] = this.high[c].max(centre + radius);
                }
            }
            this.travel[c] = colliders.travel(c, 0.0).length().max(colliders.travel(c, 1.0).length());
        }
        this
    }
}

/// Pushes every near particle out of the body as it stands at the end of a substep, and out of the floor.
/// `span` is the substep's part of the step, 0..1.
pub fn solve(cloth: &mut Cloth, garment: &Garment, colliders: &Colliders, span: [f32; 2]) {
    let cones = colliders.cones_at(span[1]);
    let share = span[1] - span[0];
    let offset = garment.fabric.contact_offset_mm * 1e-3;
    let friction = garment.fabric.friction;
    let particles = cloth.positions.iter_mut().zip(&mut cloth.previous).zip(&cloth.near);
    for (((position, previous), &near), &w) in particles.zip(&garment.inverse_mass) {
        if w <= 0.0 {
            continue;
        }
        let mut bits = near;
        while bits != 0 {
            let c = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let contact = cones[c].contact((*position).into());
            let depth = offset - contact.distance;
            if depth > 0.0 {
                let carried: Vec3 = colliders.travel(c, contact.along) * share;
                push(position, previous, contact.normal.into(), depth, friction, carried.into());
            }
        }
        if colliders.floor && position.y < offset {
            let depth = offset - position.y;
            push(position, previous, Vec3A::Y, depth, friction, Vec3A::ZERO);
        }
    }
}

/// Moves a particle out by `depth` along `normal`; `carried` is how far the surface itself moved in the substep.
#[inline]
fn push(position: &mut Vec3A, previous: &mut Vec3A, normal: Vec3A, depth: f32, friction: f32, carried: Vec3A) {
    let relative = *position - *previous - carried;
    let approach = -relative.dot(normal);
    *position += normal * depth;
    let sliding = relative + normal * approach;
    let slid = sliding.length();
    if slid > 1e-9 {
        *position -= sliding * (friction * depth / slid).min(1.0);
    }
    // Only the approach may turn into speed: a deeper push moves the start of the substep along.
    let excess = depth - approach.max(0.0);
    if excess > 0.0 {
        *previous += normal * excess;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_found_inside_comes_out_without_speed() {
        let mut p = Vec3A::new(0.0, -0.05, 0.0);
        let mut before = p;
        push(&mut p, &mut before, Vec3A::Y, 0.05, 0.3, Vec3A::ZERO);
        assert!(p.y.abs() < 1e-7 && (p - before).length() < 1e-7);
    }

    #[test]
    fn friction_holds_below_the_cone_and_slides_beyond() {
        for (dx, left) in [(0.002, 0.0), (0.02, 0.02 - 0.3 * 0.01)] {
            let mut before = Vec3A::ZERO;
            let mut p = Vec3A::new(dx, -0.01, 0.0);
            push(&mut p, &mut before, Vec3A::Y, 0.01, 0.3, Vec3A::ZERO);
            assert!((p.x - left).abs() < 1e-6 && p.y.abs() < 1e-7, "{p}");
        }
    }

    #[test]
    fn a_moving_surface_carries_what_rests_on_it() {
        let mut before = Vec3A::ZERO;
        let mut p = Vec3A::new(0.0, -0.001, 0.0);
        push(&mut p, &mut before, Vec3A::Y, 0.001, 1.0, Vec3A::new(0.0005, 0.0, 0.0));
        assert!((p.x - 0.0005).abs() < 1e-7, "{p}");
    }
}
