//! Sweep: the continuous part, for particles that move so far relative to a capsule that the end of the substep alone
//! does not tell on which side they have to come to lie.
//!
//! Conservative advancement (Mirtich 1996) on the exact distance, particle and both ends of the capsule moving along
//! straight lines: the distance cannot shrink faster than the faster end approaches, so that time may go on by their
//! quotient. From the moment of impact on the particle stays before the tangent plane that the capsule carries along.

use super::cones::{CapsuleCones, CapsuleEnds, CapsuleIndex, splat3};
use super::touch::{ContactSurface, Friction, carried, close, push};
use crate::lanes::{Lanes, Mask, V3, reciprocal_root};

/// Of the smallest radius and offset: what travels less relative to the surface cuts at most 1/128 of the radius deep,
/// and comes out on the side where it went in.
pub const QUICK: f32 = 0.25;

/// Most steps of the advancement; each goes on by at least their part of the substep.
const STEPS: u32 = 32;

/// Square of the farthest move relative to a capsule (m2) that is followed: what moves farther is an error.
const FARTHEST2_M2: f32 = 1e8;

/// Input of a sweep.
pub struct Sweep<'a> {
    /// End spheres of the capsules over the step.
    pub ends: &'a CapsuleEnds,
    /// The capsules at the end of the substep.
    pub cones: &'a CapsuleCones,
    /// The substep's part of the step, 0..1.
    pub span: [f32; 2],
    /// Contact offset (m).
    pub offset: f32,
}

/// A capsule at a moment of its own in each lane, and the particle's place from it.
struct SweepMoment<L> {
    /// From the axis to the particle (m).
    out: V3<L>,
    out2: L,
    /// Distance to the surface (m).
    distance: L,
    /// Unit axis, 0 for a sphere.
    axis: V3<L>,
    /// Place along the axis, 0..1.
    along: L,
}

impl Sweep<'_> {
    /// Which particles, now at `x` after `moved`, have to be followed: they moved far relative to capsule `c`, and not
    /// from farther away than they could have come to it.
    #[inline(always)]
    pub fn asks<L: Lanes>(&self, c: CapsuleIndex, x: V3<L>, moved: V3<L>) -> L::Mask {
        let speed2 = self.speed2(c, moved);
        let speed = speed2 * reciprocal_root(speed2) * L::splat(1.0 + 1e-3);
        let far = self.quick2::<L>(c).lt(speed2).and(speed2.lt(L::splat(FARTHEST2_M2)));
        far.and(close(self.cones, c, x, speed))
    }

    /// Pushes the particles of `mask` that hit capsule `c` on their way.
    #[inline(always)]
    pub fn run<L: Lanes>(
        &self,
        c: CapsuleIndex,
        x: &mut V3<L>,
        previous: &mut V3<L>,
        friction: Friction<L>,
        mask: L::Mask,
    ) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let moved = *x - *previous;
        let speed2 = self.speed2(c, moved);
        let pace = reciprocal_root(speed2);
        let least = L::splat(1.0 / STEPS as f32);
        let mut t = zero;
        let mut moment = self.moment(c, *previous, t);
        for _ in 0..=STEPS {
            let under_way = mask.and(zero.lt(moment.distance)).and(t.lt(one));
            if !under_way.any() {
                break;
            }
            t = (t + (moment.distance * pace).max(least)).select(under_way, t);
            moment = self.moment(c, *previous + moved * t.min(one), t.min(one));
        }
        let hit = mask.and(moment.distance.lt(zero)).and(t.lt(one)).and(L::splat(1e-12).lt(moment.out2));
        if hit.any() {
            let on = self.carry(c, &moment, *x);
            push(x, previous, &on, friction, hit.and(zero.lt(on.depth)));
        }
    }

    /// Square of the farthest that particles move relative to any point of the capsule (m2).
    #[inline(always)]
    fn speed2<L: Lanes>(&self, c: CapsuleIndex, moved: V3<L>) -> L {
        let a = moved - splat3(&self.cones.carried, c);
        let b = a - splat3(&self.cones.turned, c);
        a.dot(a).max(b.dot(b))
    }

    /// Square of what is slow enough (m2).
    #[inline(always)]
    fn quick2<L: Lanes>(&self, c: CapsuleIndex) -> L {
        let least = self.sphere::<L>(0, c, L::splat(1.0)).1.min(self.sphere::<L>(1, c, L::splat(1.0)).1);
        let slow = (least + L::splat(self.offset)) * L::splat(QUICK);
        slow * slow
    }

    /// One end of the capsule at `t` of the substep.
    #[inline(always)]
    fn sphere<L: Lanes>(&self, i: usize, c: CapsuleIndex, t: L) -> (V3<L>, L) {
        let at = L::splat(self.span[0]) + t * L::splat(self.span[1] - self.span[0]);
        let (start, travel) = (&self.ends.start[i], &self.ends.travel[i]);
        let centre = splat3::<L>(&start.centre, c) + splat3::<L>(&travel.centre, c) * at;
        (centre, start.radius.splat::<L>(c) + travel.radius.splat::<L>(c) * at)
    }

    #[inline(always)]
    fn moment<L: Lanes>(&self, c: CapsuleIndex, x: V3<L>, t: L) -> SweepMoment<L> {
        let zero = L::splat(0.0);
        let [(a, ra), (b, rb)] = [self.sphere(0, c, t), self.sphere(1, c, t)];
        let (gap, d) = (b - a, ra - rb);
        let length2 = gap.dot(gap);
        let cone = (d * d * L::splat(1.000_02) + L::splat(1e-18)).lt(length2);
        let inverse = reciprocal_root(length2).select(cone, zero);
        // One sphere inside of the other: the larger alone, at an axis without length.
        let first = a.select(cone, b.select(ra.lt(rb), a));
        let radius = ra.select(cone, ra.max(rb));
        let axis = gap * inverse;
        let sine = d * inverse;
        let cosine = (L::splat(1.0) - sine * sine).max(zero).sqrt();
        let v = x - first;
        let y = v.dot(axis);
        let away = (v.dot(v) - y * y).max(zero).sqrt();
        let foot = (y * cosine - away * sine).min(length2 * inverse * cosine).max(zero);
        let climb = foot.div(cosine.max(L::splat(1e-9))).select(cone, zero);
        let along = climb * inverse;
        let out = v - axis * climb;
        let out2 = out.dot(out);
        let distance = out2 * reciprocal_root(out2) - (radius + (rb - ra) * along);
        let along = along.select(cone, L::splat(1.0).select(ra.lt(rb), zero));
        SweepMoment { out, out2, distance, axis, along }
    }

    /// The tangent plane of the moment of impact as the capsule has carried and turned it by the end of the substep.
    #[inline(always)]
    fn carry<L: Lanes>(&self, c: CapsuleIndex, moment: &SweepMoment<L>, x: V3<L>) -> ContactSurface<L> {
        let zero = L::splat(0.0);
        let normal = moment.out * reciprocal_root(moment.out2);
        let axis = splat3::<L>(&self.cones.axis, c);
        let lifted = normal.dot(moment.axis);
        let flat = normal - moment.axis * lifted;
        let turned = flat - axis * flat.dot(axis) + axis * lifted;
        let both = zero.lt(moment.axis.dot(moment.axis)).and(zero.lt(self.cones.shortness.splat(c)));
        let turned = turned.select(both, normal);
        let normal = turned * reciprocal_root(turned.dot(turned).max(L::splat(1e-12)));
        let [(a, ra), (b, rb)] = [self.sphere(0, c, L::splat(1.0)), self.sphere(1, c, L::splat(1.0))];
        let radius = (ra + (rb - ra) * moment.along).max(zero) + L::splat(self.offset);
        let depth = radius - (x - (a + (b - a) * moment.along)).dot(normal);
        ContactSurface { normal, depth, carried: carried(self.cones, c, moment.along, normal, radius) }
    }
}
