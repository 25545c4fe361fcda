//! Touch: the distance to a capsule, and the push that ends it, on lanes of particles.
//!
//! The nearest point of a round cone belongs to the sphere around that point of the axis from which the particle is seen
//! square to the slanted side, held between the ends ([`RoundCone`](crate::cone::RoundCone) has the geometry; the tests hold
//! this against it). Friction acts on the motion relative to the moving surface (Mueller et al. 2007, "Position based
//! dynamics", section 3.5, with the Coulomb bound of the push): what the static bound covers is held, what goes beyond
//! slides against the kinetic one.

use super::cones::{CapsuleCones, PickCapsule};
use crate::lanes::{Lanes, Mask, V3, reciprocal_root};

/// A particle that moves farther than this relative to a surface in one substep (m) is no case for contact; the square
/// stays finite.
const FARTHEST_MOVE_M: f32 = 1e4;

/// A particle not deeper than this behind a surface (m) lies on it: spheres that capsules share push once.
pub const ON_M: f32 = 1e-6;

/// Friction of a substep.
#[derive(Clone, Copy)]
pub struct Friction<L> {
    /// Coefficient of static friction (1).
    pub hold: L,
    /// Coefficient of kinetic friction (1).
    pub slide: L,
}

/// A particle's place from a capsule.
#[derive(Clone, Copy)]
pub struct CapsulePoint<L> {
    /// From the axis to the particle (m).
    pub out: V3<L>,
    /// Its square (m2).
    pub out2: L,
    /// Radius there, and offset (m).
    pub reach: L,
    /// How far along the axis (m).
    pub height: L,
}

/// 1 / sqrt(x) to 7e-4: the first step of [`reciprocal_root`].
#[inline(always)]
fn rough_reciprocal_root<L: Lanes>(x: L) -> L {
    let y = x.root_seed(0x5F1F_FFF9);
    y * L::splat(0.703_952_25) * (L::splat(2.389_244_6) - x * y * y)
}

/// The place of particles `x` from capsule `c`. The distance is least at the right height: that the rough root puts the
/// height off by 7e-4 of what the slope makes of it shows in no more than 1e-6 of the distance from the axis.
#[inline(always)]
pub fn place<L: Lanes>(cones: &CapsuleCones, c: impl PickCapsule<L>, x: V3<L>) -> CapsulePoint<L> {
    let v = x - c.vector(&cones.a);
    let y = v.dot(c.vector(&cones.axis));
    let away2 = (v.dot(v) - y * y).max(L::splat(0.0));
    let height = y - away2 * rough_reciprocal_root(away2) * c.number(&cones.tangent);
    around(cones, c, v, height, L::splat(0.0))
}

/// Which particles are within `far` of capsule `c` and its offset.
///
/// A particle just there is `reach + far` out from its point of the axis, square to the side, so that its height tells
/// where that is without a root: `height = (y - (reach + far) sine) / cosine^2`, with the reach of the first centre. Any
/// other particle is looked at from a wrong point of the axis, from which it looks farther away, but not by so much
/// that one inside would seem outside.
#[inline(always)]
pub fn close<L: Lanes>(cones: &CapsuleCones, c: impl PickCapsule<L>, x: V3<L>, far: L) -> L::Mask {
    let v = x - c.vector(&cones.a);
    let y = v.dot(c.vector(&cones.axis));
    let height = y * c.number(&cones.stretch) - (far + c.number(&cones.reach)) * c.number(&cones.lean);
    let place = around(cones, c, v, height, far);
    place.out2.lt(place.reach * place.reach)
}

/// The place of particles, `v` from the first centre, seen from a height along the axis.
#[inline(always)]
fn around<L: Lanes>(cones: &CapsuleCones, c: impl PickCapsule<L>, v: V3<L>, height: L, far: L) -> CapsulePoint<L> {
    let height = height.min(c.number(&cones.length)).max(L::splat(0.0));
    let out = v - c.vector(&cones.axis) * height;
    let reach = far + c.number(&cones.reach) + height * c.number(&cones.taper);
    CapsulePoint { out, out2: out.dot(out), reach, height }
}

/// A point of a surface that pushes.
#[derive(Clone, Copy)]
pub struct ContactSurface<L> {
    /// Unit outward normal.
    pub normal: V3<L>,
    /// How far the particle is behind it (m).
    pub depth: L,
    /// How far it has moved in the substep (m).
    pub carried: V3<L>,
}

/// How far the point of capsule `c` at `along` of its axis, `radius` out along `normal`, moves in the substep: with the
/// axis, and around it as the axis turns, `w x (r n)` with `w = axis x turned / length`.
#[inline(always)]
pub fn carried<L: Lanes>(cones: &CapsuleCones, c: impl PickCapsule<L>, along: L, normal: V3<L>, radius: L) -> V3<L> {
    let (axis, turned) = (c.vector(&cones.axis), c.vector(&cones.turned));
    let lever = radius * c.number(&cones.shortness);
    c.vector(&cones.carried) + turned * (along + lever * axis.dot(normal)) - axis * (lever * turned.dot(normal))
}

/// The surface of capsule `c` under particles inside of it.
#[inline(always)]
pub fn surface<L: Lanes>(cones: &CapsuleCones, c: impl PickCapsule<L>, at: &CapsulePoint<L>) -> ContactSurface<L> {
    let nothing = L::splat(1e-18);
    let inverse = reciprocal_root(at.out2.max(nothing));
    let mut normal = at.out * inverse;
    let lost = at.out2.lt(nothing);
    if lost.any() {
        // A particle on the axis leaves it sideways.
        normal = c.vector(&cones.across).select(lost, normal);
    }
    let along = at.height * c.number(&cones.shortness);
    let depth = (at.reach - at.out2 * inverse).max(L::splat(0.0));
    ContactSurface { normal, depth, carried: carried(cones, c, along, normal, at.reach) }
}

/// Moves particles out of a surface where `mask` says so. Only the approach of this substep turns into load and speed:
/// what a push moves beyond it moves the start of the substep along, so that nothing is shot out of a body that it was
/// found in.
#[inline(always)]
pub fn push<L: Lanes>(
    x: &mut V3<L>,
    previous: &mut V3<L>,
    on: &ContactSurface<L>,
    friction: Friction<L>,
    mask: L::Mask,
) {
    let relative = *x - *previous - on.carried;
    let normal_motion = relative.dot(on.normal);
    let approach = (-normal_motion).max(L::splat(0.0));
    let load = on.depth.min(approach);
    let sliding = relative - on.normal * normal_motion;
    let slid2 = sliding.dot(sliding);
    let held = friction.hold * load;
    let slows = (friction.slide * load * rough_reciprocal_root(slid2)).min(L::splat(1.0));
    let slows = L::splat(1.0).select(slid2.lt(held * held), slows);
    let far2 = slid2 + normal_motion * normal_motion;
    let mask = mask.and(far2.lt(L::splat(FARTHEST_MOVE_M * FARTHEST_MOVE_M)));
    *x = (*x + on.normal * on.depth - sliding * slows).select(mask, *x);
    *previous = (*previous + on.normal * (on.depth - load)).select(mask, *previous);
}
