//! Touch: the distance to a capsule, and the push that ends it, on lanes of particles.
//!
//! The nearest point of a round cone belongs to the sphere around the axis whose place is that of the particle's foot
//! on the slanted side, held between the ends ([`RoundCone`](crate::cone::RoundCone) has the geometry; the tests hold
//! this against it). Friction acts on the motion relative to the moving surface (Mueller et al. 2007, "Position based
//! dynamics", section 3.5, with the Coulomb bound of the push): what the static bound covers is held, what goes beyond
//! slides against the kinetic one.

use super::cones::{Cones, splat3};
use crate::lanes::{Lanes, Mask, V3, reciprocal_root};

/// A particle that moves farther than this relative to a surface in one substep (m) is no case for contact; the square
/// stays finite.
const FARTHEST_MOVE_M: f32 = 1e4;

/// Friction of a substep.
#[derive(Clone, Copy)]
pub struct Friction<L> {
    /// Static coefficient.
    pub hold: L,
    /// Kinetic coefficient.
    pub slide: L,
}

/// A particle's place from a capsule.
#[derive(Clone, Copy)]
pub struct Place<L> {
    /// From the axis to the particle (m).
    pub out: V3<L>,
    /// Its square (m2).
    pub out2: L,
    /// Radius there, and offset (m).
    pub reach: L,
    /// Foot on the slanted side (m).
    pub foot: L,
}

/// The place of particles `x` from capsule `c`.
#[inline(always)]
pub fn place<L: Lanes>(cones: &Cones, c: usize, x: V3<L>) -> Place<L> {
    let v = x - splat3(&cones.a, c);
    let axis = splat3(&cones.axis, c);
    let y = v.dot(axis);
    let away2 = (v.dot(v) - y * y).max(L::splat(0.0));
    let away = away2 * reciprocal_root(away2);
    let foot = y * cones.cosine.splat(c) - away * cones.sine.splat(c);
    let foot = foot.min(cones.side.splat(c)).max(L::splat(0.0));
    let out = v - axis * (foot * cones.climb.splat(c));
    Place { out, out2: out.dot(out), reach: cones.reach.splat::<L>(c) + foot * cones.growth.splat(c), foot }
}

/// Which particles may be within `far` of capsule `c` and its offset: half the work of [`place`], never too few.
///
/// The axis is met square to it, at `y`, instead of at the slanted side's foot. With `x` the way from the axis, the side
/// is at `x cosine + y sine - ra`, that is `cosine (x - r(y))`, so that what is within `m` has `x - r(y) < m / cosine`.
/// At the spheres the way out is no longer than there, but their radius is not slanted: `r (1 - cosine)` is added to
/// `m`, which holds off the axis's end, too, since sqrt(x2 + e2) - x <= e2 / 2x.
#[inline(always)]
pub fn close<L: Lanes>(cones: &Cones, c: usize, x: V3<L>, far: L) -> L::Mask {
    let v = x - splat3(&cones.a, c);
    let axis = splat3(&cones.axis, c);
    let y = v.dot(axis).min(cones.length.splat(c)).max(L::splat(0.0));
    let out = v - axis * y;
    let reach = cones.wide.splat::<L>(c) + cones.taper.splat::<L>(c) * y + cones.loose.splat::<L>(c) * far;
    out.dot(out).lt(reach * reach)
}

/// A point of a surface that pushes.
#[derive(Clone, Copy)]
pub struct Surface<L> {
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
pub fn carried<L: Lanes>(cones: &Cones, c: usize, along: L, normal: V3<L>, radius: L) -> V3<L> {
    let (axis, turned) = (splat3::<L>(&cones.axis, c), splat3::<L>(&cones.turned, c));
    let lever = radius * cones.shortness.splat(c);
    let spin = turned * axis.dot(normal) - axis * turned.dot(normal);
    splat3::<L>(&cones.carried, c) + turned * along + spin * lever
}

/// The surface of capsule `c` under particles inside of it.
#[inline(always)]
pub fn surface<L: Lanes>(cones: &Cones, c: usize, at: &Place<L>) -> Surface<L> {
    // A particle on the axis leaves it sideways.
    let lost = at.out2.lt(L::splat(1e-18));
    let inverse = reciprocal_root(at.out2.max(L::splat(1e-18)));
    let normal = splat3::<L>(&cones.across, c).select(lost, at.out * inverse);
    let along = at.foot * cones.along.splat(c);
    let depth = at.reach - at.out2 * inverse;
    Surface { normal, depth, carried: carried(cones, c, along, normal, at.reach) }
}

/// Moves particles out of a surface where `mask` says so. Only the approach of this substep turns into load and speed:
/// what a push moves beyond it moves the start of the substep along, so that nothing is shot out of a body that it was
/// found in.
#[inline(always)]
pub fn push<L: Lanes>(x: &mut V3<L>, previous: &mut V3<L>, on: &Surface<L>, friction: Friction<L>, mask: L::Mask) {
    let zero = L::splat(0.0);
    let relative = *x - *previous - on.carried;
    let normal_motion = relative.dot(on.normal);
    let approach = (-normal_motion).max(zero);
    let load = on.depth.min(approach);
    let sliding = relative - on.normal * normal_motion;
    let slid2 = sliding.dot(sliding);
    let held = friction.hold * load;
    let slows = (friction.slide * load * reciprocal_root(slid2)).min(L::splat(1.0));
    let slows = L::splat(1.0).select(slid2.lt(held * held), slows);
    let mask = mask.and(relative.dot(relative).lt(L::splat(FARTHEST_MOVE_M * FARTHEST_MOVE_M)));
    *x = (*x + on.normal * on.depth - sliding * slows).select(mask, *x);
    *previous = (*previous + on.normal * (on.depth - approach).max(zero)).select(mask, *previous);
}
