//! One horizontal slice of a torso as a depth camera sees it: its front half, between two edges.

use glam::{Mat3, Vec2, Vec3};
use toile_base::numeric::statistics::quantile_of;

/// Columns in which a slice is sorted, to either side of the axis.
const COLUMNS: usize = 60;

/// Width of a column (m): two pixels at 2.4 m.
const COLUMN: f32 = 0.01;

/// This many empty columns part an arm from the torso.
const GAP: usize = 2;

/// An arm lying against the torso shows as a valley this deep between the two (m); the noise of a column is 2 mm.
const VALLEY: f32 = 0.012;

/// A valley nearer to the axis than this is a fold or the breastbone, not an arm (m).
const VALLEY_FROM: f32 = 0.09;

/// Surface this far before the torso's own is a hand or a bag held in front of it (m).
const HELD_BEFORE: f32 = 0.14;

/// The narrowest and the widest torso (m).
const BREADTH: [f32; 2] = [0.16, 0.60];

/// Of each half breadth, the part that the profile is fitted on: farther out the surface turns away from the camera.
const FITTED: f32 = 0.9;

/// What a slice of the torso measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorsoSection {
    /// Distance between its left and right edge (m).
    pub breadth: f32,
    /// Depth of its front half as that of the half ellipse that fits it best (m).
    pub front: f32,
    /// Length of a tape laid over its front from edge to edge (m).
    pub arc: f32,
}

/// Measures the torso in a band of points, x counted from the body's axis and the person facing +z.
/// `None` where there is no torso, or an arm hides where it ends.
pub(crate) fn measure_torso(points: &[Vec3], pitch: f32) -> Option<TorsoSection> {
    let columns = SliceColumns::new(points);
    let (left, right) = (columns.reach(-1)?, columns.reach(1)?);
    let edges = columns.edges(points, left, right);
    let breadth = edges[1] - edges[0] + pitch;
    if !(BREADTH[0]..BREADTH[1]).contains(&breadth) {
        return None;
    }
    let front = columns.front(left, right, edges)?;
    Some(TorsoSection { breadth, front, arc: columns.arc(left, right, edges) })
}

/// A slice in columns: mean depth of each, and how many points it has.
struct SliceColumns {
    depth: [f32; 2 * COLUMNS],
    count: [usize; 2 * COLUMNS],
}

impl SliceColumns {
    fn new(points: &[Vec3]) -> Self {
        let mut sorted: [Vec<f32>; 2 * COLUMNS] = std::array::from_fn(|_| Vec::new());
        for p in points {
            if let Some(column) = column(p.x) {
                sorted[column].push(p.z);
            }
        }
        let trunk = sorted[COLUMNS - 8..COLUMNS + 8].iter().flatten().copied();
        let reference = quantile_of(trunk, 0.5).unwrap_or(0.0);
        let mut columns = Self { depth: [0.0; 2 * COLUMNS], count: [0; 2 * COLUMNS] };
        for (i, depths) in sorted.iter().enumerate() {
            let own = depths.iter().filter(|&&z| z < reference + HELD_BEFORE);
            columns.count[i] = own.clone().count();
            columns.depth[i] = own.sum::<f32>() / columns.count[i].max(1) as f32;
        }
        columns
    }

    /// The outermost column of the torso on one side (-1 left, 1 right): up to a gap, or to a valley between the
    /// torso and an arm. `None` if the axis itself is empty.
    fn reach(&self, side: isize) -> Option<usize> {
        let start = if side > 0 { COLUMNS } else { COLUMNS - 1 };
        let at = |i: usize| start.wrapping_add_signed(side * i as isize);
        let first = (0..GAP * 2).find(|&i| self.count[at(i)] > 0)?;
        let (mut last, mut empty) = (first, 0);
        for i in first..COLUMNS {
            if self.count[at(i)] > 0 {
                (last, empty) = (i, 0);
            } else {
                empty += 1;
                if empty >= GAP {
                    break;
                }
            }
        }
        Some(at(self.valley(&at, last).unwrap_or(last)))
    }

    /// The lowest column between the axis and `last` beyond which the surface rises again: where an arm begins.
    fn valley(&self, at: &impl Fn(usize) -> usize, last: usize) -> Option<usize> {
        let from = (VALLEY_FROM / COLUMN) as usize;
        let (mut lowest, mut place) = (f32::INFINITY, None);
        for i in from..=last {
            if self.count[at(i)] == 0 {
                continue;
            }
            let z = self.depth[at(i)];
            if z < lowest {
                (lowest, place) = (z, Some(i));
            } else if z > lowest + VALLEY {
                return place;
            }
        }
        None
    }

    /// Left and right edge (m): the mean of the outermost points of four rows, so that a stray pixel weighs little.
    fn edges(&self, points: &[Vec3], left: usize, right: usize) -> [f32; 2] {
        const ROWS: usize = 4;
        let [low, high] = [position(left) - 0.5 * COLUMN, position(right) + 0.5 * COLUMN];
        let (bottom, top) = (points[0].y, points[points.len() - 1].y);
        let mut rows = [[f32::INFINITY, f32::NEG_INFINITY]; ROWS];
        for p in points.iter().filter(|p| (low..high).contains(&p.x)) {
            let row = ((p.y - bottom) / (top - bottom).max(1e-6) * ROWS as f32) as usize;
            let [l, r] = &mut rows[row.min(ROWS - 1)];
            (*l, *r) = (l.min(p.x), r.max(p.x));
        }
        let seen = rows.iter().filter(|r| r[0].is_finite()).count().max(1) as f32;
        let sum = rows.iter().filter(|r| r[0].is_finite()).fold([0.0; 2], |s, r| [s[0] + r[0], s[1] + r[1]]);
        sum.map(|s| s / seen)
    }

    /// Length of the tape from edge to edge over the front: the convex hull of the columns' depths (m).
    fn arc(&self, left: usize, right: usize, edges: [f32; 2]) -> f32 {
        let mut chain: Vec<Vec2> = Vec::with_capacity(right - left + 1);
        for i in (left..=right).filter(|&i| self.count[i] > 0) {
            let p = Vec2::new(position(i).clamp(edges[0], edges[1]), self.depth[i]);
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - b) >= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Depth of the half ellipse z = z0 + front sqrt(1 - u^2) + turn u over the breadth, u from -1 to 1, by least
    /// squares over the columns; the turn takes up what is left of a person's not facing the camera.
    fn front(&self, left: usize, right: usize, edges: [f32; 2]) -> Option<f32> {
        let (centre, half) = (0.5 * (edges[0] + edges[1]), 0.5 * (edges[1] - edges[0]));
        let (mut normal, mut moment, mut columns) = (Mat3::ZERO, Vec3::ZERO, 0);
        for i in (left..=right).filter(|&i| self.count[i] > 0) {
            let u = (position(i) - centre) / half;
            if u.abs() > FITTED {
                continue;
            }
            let row = Vec3::new(1.0, (1.0 - u * u).sqrt(), u);
            normal += Mat3::from_cols(row * row.x, row * row.y, row * row.z);
            moment += row * self.depth[i];
            columns += 1;
        }
        let front = (columns >= 8).then(|| (normal.inverse() * moment).y)?;
        front.is_finite().then_some(front)
    }
}

/// Column of an x, if it lies within reach.
fn column(x: f32) -> Option<usize> {
    let i = (x / COLUMN).floor() + COLUMNS as f32;
    (i >= 0.0 && i < (2 * COLUMNS) as f32).then_some(i as usize)
}

/// Centre of a column (m).
fn position(column: usize) -> f32 {
    (column as f32 + 0.5 - COLUMNS as f32) * COLUMN
}
