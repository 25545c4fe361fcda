//! Sections: the convex outline of a body, as a tape measure lies, and rings of cloth laid around it.

use glam::{Vec2, Vec3};

use crate::body::tape::{hull, perimeter, slice};
use toile_base::body::{Body, Region};

/// A plane with its own axes: points of a section are `origin + u * x + v * y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPlane {
    /// A point of it (m).
    pub origin: Vec3,
    /// First axis, unit length: a ring runs from the second axis towards this one.
    pub u: Vec3,
    /// Second axis, unit length, at right angles to the first: where a ring begins.
    pub v: Vec3,
}

impl SectionPlane {
    /// The horizontal plane at a height (m); rings begin at the front and run towards the person's left.
    pub fn level(height: f32) -> Self {
        Self { origin: Vec3::new(0.0, height, 0.0), u: Vec3::X, v: Vec3::Z }
    }

    /// The point of the plane at (x, y) on its axes.
    pub fn at(&self, p: Vec2) -> Vec3 {
        self.origin + self.u * p.x + self.v * p.y
    }
}

/// The convex outline of a body in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySection {
    /// The plane of the section.
    pub plane: SectionPlane,
    /// Corners of the outline on the plane's axes (m), counter-clockwise.
    pub outline: Vec<Vec2>,
}

impl BodySection {
    /// The outline of the given regions, of those points alone that `near` admits. `None` where the plane misses them.
    fn of(body: &Body, regions: &[Region], height: f32, near: impl Fn(Vec3) -> bool) -> Option<Self> {
        let plane = SectionPlane::level(height);
        let keep = |t: usize| body.mesh.triangles[t].iter().all(|&v| regions.contains(&body.regions[v as usize]));
        let normal = plane.u.cross(plane.v);
        let flat = |p: Vec3| Vec2::new((p - plane.origin).dot(plane.u), (p - plane.origin).dot(plane.v));
        let cuts = slice(&body.mesh, keep, plane.origin, normal);
        let points = cuts.iter().flatten().filter(|p| near(**p)).map(|&p| flat(p)).collect::<Vec<_>>();
        let outline = hull(&points);
        (outline.len() >= 3).then_some(Self { plane, outline })
    }

    /// The torso without arms at a height; below the crotch both legs together.
    pub fn trunk(body: &Body, height: f32) -> Option<Self> {
        Self::of(body, &[Region::Torso, Region::LeftLeg, Region::RightLeg], height, |_| true)
    }

    /// The left leg at a height; above the crotch, the left half of the trunk.
    pub fn left_leg(body: &Body, height: f32) -> Option<Self> {
        Self::of(body, &[Region::Torso, Region::LeftLeg], height, |p| p.x >= 0.0)
    }

    /// Length of the outline (m).
    pub fn girth(&self) -> f32 {
        perimeter(&self.outline)
    }

    /// The outline widened to a girth (m), but nowhere closer to the body than `gap` (m). A convex outline moved
    /// outwards by d is longer by 2 pi d; cloth that is tighter than the body lies on it, shrunk about its middle.
    pub fn widened(&self, girth: f32, gap: f32) -> Vec<Vec2> {
        let own = self.girth();
        let ease = ((girth - own) / std::f32::consts::TAU).max(gap);
        if ease < 0.0 {
            let middle = self.middle();
            return self.outline.iter().map(|&p| middle + (p - middle) * (girth / own)).collect();
        }
        let n = self.outline.len();
        let outward = |k: usize| {
            let along = self.outline[(k + 1) % n] - self.outline[k % n];
            Vec2::new(along.y, -along.x).normalize_or_zero()
        };
        let mut out = Vec::with_capacity(n * 4);
        for k in 0..n {
            let (before, after) = (outward(k + n - 1), outward(k));
            let steps = 1 + (before.angle_to(after).abs() / ARC_STEP) as usize;
            for s in 0..=steps {
                let normal = before.lerp(after, s as f32 / steps as f32).normalize_or_zero();
                out.push(self.outline[k] + normal * ease);
            }
        }
        out
    }

    /// Middle of the outline's bounding box.
    pub fn middle(&self) -> Vec2 {
        let low = self.outline.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high = self.outline.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        (low + high) * 0.5
    }

    /// `columns` points evenly around the widened outline. Point 0 lies where the direction `from` leaves the middle,
    /// moved back by `shift` columns; they run from the plane's second axis towards its first.
    pub fn ring(&self, fit: RingFit, columns: usize, from: Vec2, shift: f32) -> Vec<Vec3> {
        let mut line = self.widened(fit.girth, fit.gap);
        line.reverse(); // counter-clockwise runs from u to v; rings run from v to u
        let line = start_at(&line, self.middle(), from);
        let length = closed_length(&line);
        let step = length / columns as f32;
        (0..columns)
            .map(|c| ((c as f32 - shift) * step).rem_euclid(length))
            .map(|s| self.plane.at(along(&line, s)))
            .collect()
    }
}

/// How wide a ring is: its girth as cut, and the gap that it keeps from the body (m). The gap is negative where cloth
/// may be tighter than the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingFit {
    /// Girth as cut (m).
    pub girth: f32,
    /// Least distance from the outline (m).
    pub gap: f32,
}

/// Corners of a widened outline are rounded in steps of this angle (rad).
const ARC_STEP: f32 = 0.2;

/// Rotates a closed line so that it begins where the ray from `middle` along `from` crosses it.
fn start_at(line: &[Vec2], middle: Vec2, from: Vec2) -> Vec<Vec2> {
    let n = line.len();
    for k in 0..n {
        let (p, q) = (line[k] - middle, line[(k + 1) % n] - middle);
        let (side_p, side_q) = (from.perp_dot(p), from.perp_dot(q));
        let crosses = (side_p > 0.0) != (side_q > 0.0) && p.dot(from) + q.dot(from) > 0.0;
        if crosses {
            let start = line[k].lerp(line[(k + 1) % n], side_p / (side_p - side_q));
            return std::iter::once(start).chain((1..=n).map(|i| line[(k + i) % n])).collect();
        }
    }
    line.to_vec()
}

fn closed_length(line: &[Vec2]) -> f32 {
    (0..line.len()).map(|k| line[k].distance(line[(k + 1) % line.len()])).sum()
}

/// Point at distance `s` along a closed line (m).
fn along(line: &[Vec2], s: f32) -> Vec2 {
    let mut left = s;
    for k in 0..line.len() {
        let (p, q) = (line[k], line[(k + 1) % line.len()]);
        let length = p.distance(q);
        if left <= length && length > 0.0 {
            return p.lerp(q, left / length);
        }
        left -= length;
    }
    line[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(radius: f32) -> BodySection {
        let outline = (0..200).map(|k| Vec2::from_angle(std::f32::consts::TAU * k as f32 / 200.0) * radius).collect();
        BodySection { plane: SectionPlane::level(1.0), outline }
    }

    #[test]
    fn a_ring_has_the_girth_asked_for_and_starts_at_the_front() {
        let section = circle(0.12);
        for girth in [0.7, 0.9, 1.4] {
            let ring = section.ring(RingFit { girth, gap: -1.0 }, 240, Vec2::Y, 0.0);
            let length: f32 = (0..240).map(|k| ring[k].distance(ring[(k + 1) % 240])).sum();
            assert!((length / girth - 1.0).abs() < 2e-3, "{length} {girth}");
            assert!(ring[0].x.abs() < 1e-4 && ring[0].z > 0.0, "{:?}", ring[0]);
            assert!(ring[60].x > 0.0 && ring[60].z.abs() < 2e-3, "{:?}", ring[60]);
        }
    }

    #[test]
    fn a_gap_keeps_cloth_off_the_body() {
        let ring = circle(0.12).ring(RingFit { girth: 0.3, gap: 0.005 }, 100, Vec2::Y, 0.0);
        assert!(ring.iter().all(|p| Vec2::new(p.x, p.z).length() > 0.1245));
    }
}
