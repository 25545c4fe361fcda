//! The lattice of a panel: rows of points along weft and warp, whose whole cells are quads.
//!
//! Rows are laid so that they meet the points of the longest sewn edge that runs along the warp, columns likewise along the
//! weft: then weft and warp go on across these seams.

use glam::DVec2;

use super::limits::{INSET, MAX_PLACES};
use super::sampling::Boundary;
use crate::pattern::Panel;

/// An edge whose chord is nearer to a thread than this decides where the threads across it lie (cosine of 35 degrees).
const ALONG_COS: f64 = 0.82;

/// Least pitch of a row in parts of the spacing: steeper edges would make rows too dense.
const LEAST_PITCH: f64 = 0.72;

/// What a metre of a bent edge counts beside one of a straight edge: its points lie on no even rows.
const BENT_WORTH: f64 = 0.5;

/// Lines of the lattice across one direction: `first + k * pitch` (m).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lines {
    first: f64,
    pitch: f64,
}

/// The lattice of one panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Unit vectors along weft and warp; the warp lies to the left of the weft.
    axes: [DVec2; 2],
    /// Columns and rows of points.
    counts: [usize; 2],
    /// The points kept, by their place in column and row (m) `[rows * columns]`; `None` outside of the panel.
    points: Vec<Option<DVec2>>,
}

impl Lattice {
    /// Lays the lattice into an outline at a spacing (m); `None` where the box around the panel has too many places.
    pub fn new(panel: &Panel, boundary: &Boundary, spacing: f64) -> Option<Self> {
        let warp = panel.grain;
        let axes = [DVec2::new(warp.y, -warp.x), warp];
        let lines = axes.map(|axis| lines(panel, boundary, axis, spacing));
        let along = |k: usize| boundary.points.iter().map(move |p| p.dot(axes[k]));
        let range = [0, 1].map(|k| (along(k).fold(f64::MAX, f64::min), along(k).fold(f64::MIN, f64::max)));
        let least = [0, 1].map(|k| ((range[k].0 - lines[k].first) / lines[k].pitch).floor());
        let counts =
            [0, 1].map(|k| ((range[k].1 - lines[k].first) / lines[k].pitch - least[k]).ceil().max(0.0) as usize + 1);
        if counts[0].saturating_mul(counts[1]) > MAX_PLACES {
            return None;
        }
        let at = |k: usize, i: usize| lines[k].first + (least[k] + i as f64) * lines[k].pitch;
        let distance = INSET * lines[0].pitch.min(lines[1].pitch);
        let ring: Vec<DVec2> = boundary.points.iter().map(|p| DVec2::new(p.dot(axes[0]), p.dot(axes[1]))).collect();
        let mut points = vec![None; counts[0] * counts[1]];
        for j in 0..counts[1] {
            let row = LatticeRow::new(&ring, at(1, j), distance);
            for i in 0..counts[0] {
                let p = DVec2::new(at(0, i), at(1, j));
                if row.holds(p, distance) {
                    points[j * counts[0] + i] = Some(axes[0] * p.x + axes[1] * p.y);
                }
            }
        }
        Some(Self { axes, counts, points })
    }

    /// Unit vectors along weft and warp.
    pub fn axes(&self) -> [DVec2; 2] {
        self.axes
    }

    /// The places of the points kept, and where they are (m).
    pub fn points(&self) -> impl Iterator<Item = (usize, DVec2)> + '_ {
        self.points.iter().enumerate().filter_map(|(i, p)| Some((i, (*p)?)))
    }

    /// Number of places, kept or not.
    pub fn places(&self) -> usize {
        self.points.len()
    }

    /// Takes a point away.
    pub fn remove(&mut self, place: usize) -> Option<DVec2> {
        self.points[place].take()
    }

    /// Whether the cell whose lower left corner is a place is whole.
    fn is_cell(&self, place: usize) -> bool {
        let [columns, rows] = self.counts;
        place % columns + 1 < columns
            && place / columns + 1 < rows
            && [0, 1, columns, columns + 1].iter().all(|d| self.points[place + d].is_some())
    }

    /// The whole cells: their corners in the order of a quad, counter-clockwise in the drawing.
    pub fn cells(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let columns = self.counts[0];
        let corners = move |p: usize| [p, p + 1, p + columns + 1, p + columns];
        (0..self.points.len()).filter(|&p| self.is_cell(p)).map(corners)
    }
}

/// Lines across an axis, as the longest edge along it has its points.
fn lines(panel: &Panel, boundary: &Boundary, axis: DVec2, spacing: f64) -> Lines {
    let edge = |e: usize| {
        let (start, end) = (panel.edges[e].curve.start(), panel.edges[e].curve.end());
        let points = boundary.starts[e + 1] - boundary.starts[e];
        let length = (end - start).dot(axis);
        let along = length.abs() >= ALONG_COS * start.distance(end);
        // Where a seam has more points than the lattice needs, each line meets every second or third.
        let chord = length.abs() / points as f64;
        let pitch = chord * (spacing * 1.02 / chord).floor().max(1.0);
        let worth = length.abs() * if panel.edges[e].curve.is_straight() { 1.0 } else { BENT_WORTH };
        (along && pitch >= LEAST_PITCH * spacing).then(|| (worth, Lines { first: start.dot(axis), pitch }))
    };
    let longest = (0..panel.edges.len()).filter_map(edge).max_by(|a, b| a.0.total_cmp(&b.0));
    longest.map_or_else(
        || {
            let along = boundary.points.iter().map(|p| p.dot(axis));
            let (low, high) = (along.clone().fold(f64::MAX, f64::min), along.fold(f64::MIN, f64::max));
            let pitch = (high - low) / ((high - low) / spacing).ceil().max(1.0);
            Lines { first: low, pitch }
        },
        |(_, lines)| lines,
    )
}

/// The sides of an outline near one row of the lattice.
struct LatticeRow {
    near: Vec<[DVec2; 2]>,
}

impl LatticeRow {
    fn new(ring: &[DVec2], y: f64, distance: f64) -> Self {
        let sides = (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]);
        let near = |[a, b]: &[DVec2; 2]| a.y.min(b.y) <= y + distance && a.y.max(b.y) >= y - distance;
        Self { near: sides.filter(near).collect() }
    }

    /// Whether a point of the row lies inside, at least so far from the outline (m).
    fn holds(&self, p: DVec2, distance: f64) -> bool {
        let crosses =
            |[a, b]: &[DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
        let inside = self.near.iter().filter(|s| crosses(s)).count() % 2 == 1;
        let far = |[a, b]: &[DVec2; 2]| {
            let t = ((p - *a).dot(*b - *a) / (*b - *a).length_squared()).clamp(0.0, 1.0);
            a.lerp(*b, t).distance_squared(p) >= distance * distance * (1.0 - 1e-9)
        };
        inside && self.near.iter().all(far)
    }
}
