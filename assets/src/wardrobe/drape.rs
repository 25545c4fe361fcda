//! Drape: how the drafts lay rows of cloth around a body, over its shoulders and along its limbs.

use glam::{Vec2, Vec3};

use super::section::{BodySection, RingFit, SectionPlane, resample};
use crate::body::tape::hull;
use toile_bake::shape::{Face, Shape};
use toile_base::body::{Body, Region};

/// Cloth starts at least this far from the skin (m): a little more than the contact offset of the thickest fabric.
pub const START_GAP_M: f32 = 0.005;

/// Lowest height at which a trunk has an outline worth following (m): above the ankles.
const LOWEST_LEVEL_M: f32 = 0.12;

/// A way over the shoulder rises at least this much above its ends (m).
const LEAST_RISE_M: f32 = 0.004;

/// One body to drape on, and the gap that cloth keeps from it (m): none on the body that it is cut for, where its
/// girths are what the size says; [`START_GAP_M`] on the shopper, who may be larger than the garment.
#[derive(Debug, Clone, Copy)]
pub struct DrapeBody<'a> {
    /// The body that cloth is draped on.
    pub body: &'a Body,
    /// Least gap that cloth keeps from it (m).
    pub gap: f32,
    /// Room left for what is worn under the garment (m), more than the gap.
    pub room: f32,
}

impl<'a> DrapeBody<'a> {
    /// The body that a size is cut for.
    pub const fn cut(body: &'a Body) -> Self {
        Self { body, gap: -1.0, room: 0.0 }
    }

    /// The shopper's body, with the gap [`START_GAP_M`].
    pub const fn shopper(body: &'a Body) -> Self {
        Self { body, gap: START_GAP_M, room: 0.0 }
    }

    /// The same with room for what is worn under the garment (m).
    pub const fn over(self, room: f32) -> Self {
        Self { room, ..self }
    }

    /// How a ring of some girth (m) fits.
    pub fn fit(&self, girth: f32) -> RingFit {
        RingFit { girth, gap: self.gap + self.room }
    }

    /// Girth of the trunk at a height (m).
    pub fn girth(&self, height: f32) -> f32 {
        self.trunk(height).map_or(0.0, |s| s.girth())
    }

    fn trunk(&self, height: f32) -> Option<BodySection> {
        let section = BodySection::trunk(self.body, height.max(LOWEST_LEVEL_M))?;
        Some(BodySection { plane: SectionPlane::level(height), ..section })
    }

    /// A ring around the trunk, from the front centre over the left side.
    pub fn ring(&self, height: f32, girth: f32, columns: usize) -> Vec<Vec3> {
        self.trunk(height).map_or_else(
            || vec![Vec3::new(0.0, height, 0.0); columns],
            |section| section.ring(self.fit(girth), columns, Vec2::Y, 0.0),
        )
    }

    /// A ring around the trunk that is open in front, `columns + 1` points from its left edge to its right one; `girth` is that of
    /// the cloth, and the edges lie `opening` apart (m).
    pub fn open_ring(&self, height: f32, girth: f32, opening: f32, columns: usize) -> Vec<Vec3> {
        self.trunk(height).map_or_else(
            || vec![Vec3::new(0.0, height, 0.0); columns + 1],
            |section| section.open_ring(self.fit(girth + opening), opening, columns, Vec2::Y),
        )
    }

    /// The way from `front` to `back`, both ends included, close to the body, over the shoulder at a distance `x` from the
    /// middle (m).
    pub fn over_shoulder(&self, front: Vec3, back: Vec3, x: f32) -> Vec<Vec3> {
        let plane = SectionPlane { origin: Vec3::X * x, u: Vec3::Z, v: Vec3::Y };
        let arm = if x > 0.0 { Region::LeftArm } else { Region::RightArm };
        let lowest = front.y.min(back.y);
        let Some(section) = BodySection::of(self.body, &[Region::Torso, arm], plane, |p| p.y > lowest) else {
            return vec![front, back];
        };
        // The ends lie lowest, so they are corners of the hull, and the way over the top is one of its two sides.
        let ends = [front, back].map(|p| Vec2::new(p.z, p.y));
        let mut points = section.widened(0.0, self.gap.max(START_GAP_M) + self.room);
        points.retain(|p| p.y > lowest + LEAST_RISE_M);
        points.extend(ends);
        let around = hull(&points);
        let place = |end: Vec2| around.iter().position(|&p| p == end).unwrap_or(0);
        let (start, stop) = (place(ends[0]), place(ends[1]));
        let count = (stop + around.len() - start) % around.len();
        let mut line: Vec<Vec3> = (0..=count).map(|k| plane.at(around[(start + k) % around.len()])).collect();
        ease_sideways(&mut line, front.x, back.x);
        line
    }
}

/// Spreads the difference between the x of the two ends over a line made in one plane.
fn ease_sideways(line: &mut [Vec3], from: f32, to: f32) {
    let last = (line.len() - 1).max(1) as f32;
    for (k, p) in line.iter_mut().enumerate() {
        p.x = from + (to - from) * k as f32 / last;
    }
}

/// Splits a line at its highest point: the way up and the way down, both with that point.
pub fn split_at_top(line: &[Vec3]) -> (Vec<Vec3>, Vec<Vec3>) {
    let top = (0..line.len()).max_by(|&a, &b| line[a].y.total_cmp(&line[b].y)).unwrap_or(0);
    let top = top.clamp(1, line.len().max(3) - 2);
    (line[..=top].to_vec(), line[top..].to_vec())
}

/// The part of a rising line below a height, ending exactly there.
pub fn below(line: &[Vec3], height: f32) -> Vec<Vec3> {
    match (1..line.len()).find(|&k| line[k].y > height) {
        Some(k) => {
            let (p, q) = (line[k - 1], line[k]);
            let t = ((height - p.y) / (q.y - p.y).max(1e-6)).clamp(0.0, 1.0);
            let mut out = line[..k].to_vec();
            out.push(p.lerp(q, t));
            out
        }
        None => line.to_vec(),
    }
}

/// `rows` points evenly along a line, without its first.
pub fn rows_after(line: &[Vec3], rows: usize) -> Vec<Vec3> {
    resample(line, rows + 1).split_off(1)
}

/// Joins two rows of the same length with quads; `upper` lies above `lower`, both run the way a ring runs.
pub fn join(shape: &mut Shape, upper: &[u32], lower: &[u32], closed: bool) {
    let n = upper.len();
    for c in 0..if closed { n } else { n - 1 } {
        let d = (c + 1) % n;
        shape.faces.push([lower[c], lower[d], upper[d], upper[c]]);
    }
}

/// Turns faces inside out, keeping weft and warp: for the mirrored half of a garment.
pub fn flip(faces: &mut [Face]) {
    for [a, b, c, d] in faces {
        std::mem::swap(a, b);
        std::mem::swap(c, d);
    }
}
