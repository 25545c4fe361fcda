//! Walking to the nearest triangle: from where a particle's nearest point was to where it is.
//!
//! The nearest point of a triangle is the projection onto its plane where that falls inside, else the nearest point of its
//! edges (Ericson 2005, "Real-time collision detection", section 5.1.5). Where the projection falls outside, the surface may
//! be nearer across the edge that it falls behind: the particle steps over that edge as long as this brings it nearer. From
//! step to step that is nearly always the same triangle (van den Bergen, Gregorius 2010, "Game physics pearls", 12.3.2).

use super::mesh::{NO_TRIANGLE, SurfaceMesh};
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, V3};

/// Most triangles that a particle walks over in one step: 8 edges of 15 mm in 1/120 s are 14 m/s.
const MOST_HOPS: usize = 8;

/// A triangle has at least this square of its area (m4) in a division: none gives 0 / 0.
const NO_AREA: f32 = 1e-24;

/// The point of a surface that is nearest to a particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NearestPoint {
    /// Its triangle.
    pub triangle: u32,
    /// Shares of the triangle's corners, each 0 to 1, together 1.
    pub shares: [f32; 3],
    /// Square of the distance (m2).
    pub distance2: f32,
}

/// For each particle of a list the nearest point that is found by walking from `triangle`.
pub struct FindNearest<'a> {
    /// The surface.
    pub mesh: &'a SurfaceMesh,
    /// Where its vertices are (m).
    pub surface: [ReadColumn<'a>; 3],
    /// Where the particles are (m).
    pub points: [ReadColumn<'a>; 3],
    /// Which of them ask.
    pub list: &'a [u32],
    /// For each in the list: the triangle to start from, and what was found.
    pub found: &'a mut [NearestPoint],
}

/// The nearest points of some triangles, in lanes.
#[derive(Clone, Copy)]
struct Closest<L> {
    shares: [L; 3],
    distance2: L,
    /// Shares of the projection onto the plane, below 0 behind the edge opposite to a corner.
    flat: [L; 3],
}

impl Kernel for FindNearest<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mut from = 0;
        while from < self.list.len() {
            let n = (self.list.len() - from).min(L::N);
            self.some::<L>(from, n);
            from += n;
        }
    }
}

impl FindNearest<'_> {
    #[inline(always)]
    fn some<L: Lanes>(&mut self, from: usize, n: usize) {
        let p = V3::<L>::gather(self.points, &self.list[from..from + n], n);
        let mut triangles = [0u32; MOST];
        for (t, found) in triangles.iter_mut().zip(&self.found[from..from + n]) {
            *t = found.triangle;
        }
        let mut best = self.closest(p, &triangles, n);
        // Over which edge each goes next; the second choice is for where the first did not bring it nearer.
        let mut second = 0u32;
        let mut walking = ((1u64 << n) - 1) as u32;
        for _ in 0..MOST_HOPS {
            let mut next = triangles;
            walking = self.step(&mut next, arrays(best.flat), walking, second);
            if walking == 0 {
                break;
            }
            let there = self.closest(p, &next, n);
            let better = there.distance2.lt(best.distance2).and(L::Mask::of(walking));
            let bits = better.bits();
            for (lane, (t, new)) in triangles.iter_mut().zip(&next).enumerate() {
                *t = if bits >> lane & 1 == 1 { *new } else { *t };
            }
            best = Closest {
                shares: pick(there.shares, better, best.shares),
                distance2: there.distance2.select(better, best.distance2),
                flat: pick(there.flat, better, best.flat),
            };
            // Who did not come nearer tries the other edge once, then stays.
            walking &= bits | !second;
            second = walking & !bits;
        }
        let (shares, distance2) = (arrays(best.shares), best.distance2.to_array());
        for (lane, found) in self.found[from..from + n].iter_mut().enumerate() {
            let shares = shares.map(|s| s[lane]);
            *found = NearestPoint { triangle: triangles[lane], shares, distance2: distance2[lane] };
        }
    }

    /// Steps every walking lane over the edge that its projection falls behind the most, or `second` most; gives those that
    /// have one.
    #[inline(always)]
    fn step(&self, next: &mut [u32; MOST], flat: [[f32; MOST]; 3], walking: u32, second: u32) -> u32 {
        let mut go = 0;
        for (lane, t) in next.iter_mut().enumerate() {
            if walking >> lane & 1 == 0 {
                continue;
            }
            let shares = [flat[0][lane], flat[1][lane], flat[2][lane]];
            if let Some(there) = over(shares, self.mesh.across(*t), second >> lane & 1 == 1) {
                *t = there;
                go |= 1 << lane;
            }
        }
        go
    }

    /// The nearest points of triangles.
    #[inline(always)]
    fn closest<L: Lanes>(&self, p: V3<L>, triangles: &[u32; MOST], n: usize) -> Closest<L> {
        let mut corners = [[0u32; MOST]; 3];
        for (lane, &t) in triangles[..n].iter().enumerate() {
            let c = self.mesh.corners(t);
            (corners[0][lane], corners[1][lane], corners[2][lane]) = (c[0], c[1], c[2]);
        }
        let a = V3::<L>::gather(self.surface, &corners[0], n);
        let b = V3::<L>::gather(self.surface, &corners[1], n);
        let c = V3::<L>::gather(self.surface, &corners[2], n);
        closest(p, [a, b, c])
    }
}

/// The triangle across the edge that a projection with these shares falls behind the most, or second most; none where it
/// falls behind no edge, or only behind borders.
#[inline(always)]
fn over(shares: [f32; 3], across: [u32; 3], second: bool) -> Option<u32> {
    let rank = |k: usize| if shares[k] < 0.0 && across[k] != NO_TRIANGLE { shares[k] } else { 0.0 };
    let ranks = [rank(0), rank(1), rank(2)];
    let least =
        |not: usize| (0..3).filter(|k| *k != not && ranks[*k] < 0.0).min_by(|a, b| ranks[*a].total_cmp(&ranks[*b]));
    let first = least(3)?;
    Some(across[if second { least(first)? } else { first }])
}

/// The nearest point of a triangle.
#[inline(always)]
fn closest<L: Lanes>(p: V3<L>, [a, b, c]: [V3<L>; 3]) -> Closest<L> {
    let (zero, one, two, tiny) = (L::splat(0.0), L::splat(1.0), L::splat(2.0), L::splat(NO_AREA));
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (bb, bc, cc) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
    let (pb, pc, pp) = (ap.dot(ab), ap.dot(ac), ap.dot(ap));
    let inverse = one.div((bb * cc - bc * bc).max(tiny));
    let (v, w) = ((cc * pb - bc * pc) * inverse, (bb * pc - bc * pb) * inverse);
    let u = one - v - w;
    // Along each edge: how far, and the square of the distance.
    let (s, t) = (along(pb, bb), along(pc, cc));
    let on_ab = pp - s * (two * pb - s * bb);
    let on_ac = pp - t * (two * pc - t * cc);
    let (length2, far) = (bb - two * bc + cc, (pc - pb) - (bc - bb));
    let r = along(far, length2);
    let on_bc = (pp - two * pb + bb) - r * (two * far - r * length2);
    let mut shares = [one - s, s, zero];
    let mut distance2 = on_ab;
    let nearer = on_ac.lt(distance2);
    (shares, distance2) = (pick([one - t, zero, t], nearer, shares), on_ac.select(nearer, distance2));
    let nearer = on_bc.lt(distance2);
    (shares, distance2) = (pick([zero, one - r, r], nearer, shares), on_bc.select(nearer, distance2));
    let inside = (-u).lt(zero).and((-v).lt(zero)).and((-w).lt(zero));
    let flat = pp - v * pb - w * pc;
    (shares, distance2) = (pick([u, v, w], inside, shares), flat.select(inside, distance2));
    Closest { shares, distance2: distance2.max(zero), flat: [u, v, w] }
}

/// Where along an edge, 0..1, its nearest point is: `far` of the square of its length.
#[inline(always)]
fn along<L: Lanes>(far: L, length2: L) -> L {
    far.div(length2.max(L::splat(NO_AREA))).max(L::splat(0.0)).min(L::splat(1.0))
}

/// `mask ? these : others`. No closure: those that are not inlined are compiled for no width.
#[inline(always)]
fn pick<L: Lanes>(these: [L; 3], mask: L::Mask, others: [L; 3]) -> [L; 3] {
    [these[0].select(mask, others[0]), these[1].select(mask, others[1]), these[2].select(mask, others[2])]
}

#[inline(always)]
fn arrays<L: Lanes>(of: [L; 3]) -> [[f32; MOST]; 3] {
    [of[0].to_array(), of[1].to_array(), of[2].to_array()]
}
