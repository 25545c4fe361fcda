//! Points along outlines. Both sides of a seam get the same number, the larger of what each would need.

use glam::DVec2;

use super::limits::CHORD_TURN;
use crate::pattern::curve::ArcLength;
use crate::pattern::{Curve, Panel, Pattern, Seam, SeamSide};

/// Corners of both sides of a seam that are nearer to each other than this part of a spacing are one point.
const SAME_CORNER: f64 = 0.5;

/// Edges shorter than this part of a spacing are left out, their ends made one point: traces of drafting, of a millimetre or
/// two, which would ask for particles as small as they are.
const LEAST_EDGE: f64 = 0.25;

/// Points along a panel's outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// The points in the order of the outline (m).
    pub points: Vec<DVec2>,
    /// Index of the point at which each edge starts `[edges + 1]`; the last is the number of points. An edge that was left
    /// out starts where the next one does.
    pub starts: Vec<usize>,
}

impl Boundary {
    /// The points along a run of edges in the order of sewing, from one end to the other.
    pub fn along(&self, side: &SeamSide) -> Vec<usize> {
        let edges = self.starts.len() - 1;
        let count = self.points.len();
        let outline = (0..side.count).flat_map(|i| {
            let e = (side.first + i) % edges;
            self.starts[e]..self.starts[e + 1]
        });
        let last = self.starts[(side.first + side.count) % edges];
        let mut found: Vec<usize> = outline.chain([last % count.max(1)]).collect();
        if side.reversed {
            found.reverse();
        }
        found
    }
}

/// The edges of a panel, measured.
struct MeasuredEdges<'p> {
    panel: &'p Panel,
    lengths: Vec<ArcLength>,
    turns: Vec<f64>,
    /// Fractions of each edge's length at which it has points, its start and end left out `[edges]`.
    inner: Vec<Vec<f64>>,
    /// Whether an edge is left out, because it is too short `[edges]`.
    left_out: Vec<bool>,
}

impl MeasuredEdges<'_> {
    /// Chords that a part of an edge needs at a spacing (m): by its length, and by how far it turns.
    fn chords(&self, edge: usize, share: f64, spacing: f64) -> usize {
        let by_length = self.lengths[edge].whole() * share / spacing;
        let by_turn = self.turns[edge] * share / CHORD_TURN;
        (by_length.max(by_turn) - 1e-6).ceil().max(1.0) as usize
    }

    /// Where the corners of a run lie, as parts of its length, from 0 to 1.
    fn corners(&self, side: &SeamSide) -> Vec<f64> {
        let mut sum = 0.0;
        let upto = side.run(self.lengths.len()).map(|e| {
            sum += self.lengths[e].whole();
            sum
        });
        let upto: Vec<f64> = upto.collect();
        [0.0].into_iter().chain(upto.into_iter().map(|l| l / sum)).collect()
    }

    /// The edge of a run at a part of its length, and the fraction of that edge's length from its own start.
    fn locate(&self, side: &SeamSide, corners: &[f64], at: f64) -> (usize, f64) {
        let k = corners.partition_point(|c| *c <= at).clamp(1, corners.len() - 1);
        let edge = side.run(self.lengths.len()).nth(k - 1).unwrap_or(side.first);
        let within = ((at - corners[k - 1]) / (corners[k] - corners[k - 1])).clamp(0.0, 1.0);
        (edge, if side.reversed { 1.0 - within } else { within })
    }
}

/// Places points along all outlines of a pattern at a spacing (m).
pub fn sample<'p>(pattern: &'p Pattern, spacing: f64) -> Vec<Boundary> {
    let measure = |panel: &'p Panel| {
        let edges: Vec<&Curve> = panel.edges.iter().map(|e| &e.curve).collect();
        MeasuredEdges {
            panel,
            lengths: edges.iter().map(|c| ArcLength::of(c)).collect(),
            turns: edges.iter().map(|c| c.turn()).collect(),
            inner: vec![Vec::new(); edges.len()],
            left_out: vec![false; edges.len()],
        }
    };
    let mut all: Vec<MeasuredEdges<'_>> = pattern.panels().iter().map(measure).collect();
    let mut sewn: Vec<Vec<bool>> = all.iter().map(|m| vec![false; m.lengths.len()]).collect();
    for seam in pattern.seams() {
        place_on_seam(&mut all, seam, spacing);
        for side in &seam.sides {
            side.run(sewn[side.panel].len()).for_each(|e| sewn[side.panel][e] = true);
        }
    }
    for (measured, sewn) in all.iter_mut().zip(&sewn) {
        for edge in (0..sewn.len()).filter(|&e| !sewn[e]) {
            let n = measured.chords(edge, 1.0, spacing);
            measured.left_out[edge] = measured.lengths[edge].whole() < LEAST_EDGE * spacing;
            measured.inner[edge] = (1..n).map(|k| k as f64 / n as f64).collect();
        }
    }
    all.iter().map(boundary).collect()
}

/// Points along both sides of a seam, at the corners of either and evenly between them.
fn place_on_seam(all: &mut [MeasuredEdges<'_>], seam: &Seam, spacing: f64) {
    let sides = seam.sides;
    let corners = sides.map(|side| all[side.panel].corners(&side));
    let length =
        sides.map(|side| side.run(all[side.panel].lengths.len()).map(|e| all[side.panel].lengths[e].whole()).sum());
    let stops = stops(&corners[0], &corners[1], f64::max(length[0], length[1]), spacing);
    for pair in stops.windows(2) {
        let spans = [0, 1].map(|k| Span {
            ends: [pair[0][k], pair[1][k]],
            corners: [pair[0][k], pair[1][k]].map(|at| corners[k].contains(&at)),
            length: (pair[1][k] - pair[0][k]) * length[k],
        });
        let edges = [0, 1].map(|k| {
            let middle = 0.5 * (spans[k].ends[0] + spans[k].ends[1]);
            all[sides[k].panel].locate(&sides[k], &corners[k], middle).0
        });
        if spans.iter().all(|span| span.may_be_left_out(spacing)) {
            let whole = (0..2).filter(|&k| spans[k].corners == [true, true]);
            whole.for_each(|k| all[sides[k].panel].left_out[edges[k]] = true);
            continue;
        }
        let chords = [0, 1].map(|k| {
            let measured = &all[sides[k].panel];
            measured.chords(edges[k], spans[k].length / measured.lengths[edges[k]].whole(), spacing)
        });
        let n = chords[0].max(chords[1]);
        for (k, side) in sides.iter().enumerate() {
            let Span { ends: [from, to], corners: [own_corner, _], .. } = spans[k];
            for i in usize::from(own_corner)..n {
                let at = from + (to - from) * i as f64 / n as f64;
                let (edge, fraction) = all[side.panel].locate(side, &corners[k], at);
                all[side.panel].inner[edge].push(fraction);
            }
        }
    }
}

/// A part of one side of a seam, between two common points.
struct Span {
    /// Where it begins and ends, as parts of the side's length.
    ends: [f64; 2],
    /// Whether these are corners of the side's own.
    corners: [bool; 2],
    /// Its length (m).
    length: f64,
}

impl Span {
    /// Whether it is too short, and its beginning may go: with its whole edge, or because no corner needs it.
    fn may_be_left_out(&self, spacing: f64) -> bool {
        self.length < LEAST_EDGE * spacing && self.corners != [true, false]
    }
}

/// Where both sides of a seam have a common point at the least: the corners of either, as parts of both lengths.
fn stops(a: &[f64], b: &[f64], length: f64, spacing: f64) -> Vec<[f64; 2]> {
    let near = SAME_CORNER * spacing / length;
    let mut pairs = vec![[0.0, 0.0], [1.0, 1.0]];
    let inner = |c: &[f64]| c[1..c.len() - 1].to_vec();
    let mut open = inner(b);
    let mut alone = Vec::new();
    for x in inner(a) {
        match open.iter().position(|y| (x - y).abs() < near) {
            Some(i) => pairs.push([x, open.remove(i)]),
            None => alone.push((0, x)),
        }
    }
    alone.extend(open.into_iter().map(|y| (1, y)));
    pairs.sort_by(|p, q| p[0].total_cmp(&q[0]));
    // A corner without a partner meets the other side where the length between the pairs around it is divided alike.
    let matched = pairs.clone();
    for (own, x) in alone {
        let i = matched.partition_point(|p| p[own] <= x).clamp(1, matched.len() - 1);
        let (p, q) = (matched[i - 1], matched[i]);
        let other = 1 - own;
        let y = p[other] + (q[other] - p[other]) * (x - p[own]) / (q[own] - p[own]);
        pairs.push(if own == 0 { [x, y] } else { [y, x] });
    }
    pairs.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    pairs
}

/// The points of an outline. Those of a curve are moved out so far that their chords enclose what the curve does; where
/// edges were left out, the next one starts in the middle of them.
fn boundary(measured: &MeasuredEdges<'_>) -> Boundary {
    let mut found = Boundary { points: Vec::new(), starts: Vec::new() };
    let edges = &measured.panel.edges;
    let n = edges.len();
    for (i, edge) in edges.iter().enumerate() {
        found.starts.push(found.points.len());
        if measured.left_out[i] {
            continue;
        }
        let mut inner = measured.inner[i].clone();
        inner.sort_by(f64::total_cmp);
        let at = |f: &f64| edge.curve.point(measured.lengths[i].parameter(*f));
        let mut points = vec![edge.curve.start()];
        points.extend(inner.iter().map(at));
        points.push(edge.curve.end());
        if !edge.curve.is_straight() {
            keep_area(&edge.curve, &mut points);
        }
        points.pop();
        let before = (1..n).take_while(|k| measured.left_out[(i + n - k) % n]).last().unwrap_or(0);
        points[0] = 0.5 * (points[0] + edges[(i + n - before) % n].curve.start());
        found.points.append(&mut points);
    }
    found.starts.push(found.points.len());
    found
}

/// How far, in second differences, points may be moved: a twelfth is what a circle asks for in the mean.
const MOST_OUT: f64 = 0.25;

/// Moves the inner points of a curve so that the area between chords and curve is nothing. Chords of an arc cut off
/// segments, s^3 k / 12 each at a chord s and a curvature k; as much is added by moving points out by s^2 k / 12, a twelfth
/// of their second difference.
fn keep_area(curve: &Curve, points: &mut [DVec2]) {
    let n = points.len();
    let old = points.to_vec();
    let bow = |i: usize| 2.0 * old[i] - old[i - 1] - old[i + 1];
    let area = |p: &[DVec2]| p.windows(2).map(|p| p[0].perp_dot(p[1])).sum::<f64>();
    let wanted = curve.twice_area();
    let (mut before, mut missing_before) = (0.0, wanted - area(points));
    let mut out: f64 = 1.0 / 12.0;
    for _ in 0..4 {
        (1..n - 1).for_each(|i| points[i] = old[i] + bow(i) * out);
        let missing = wanted - area(points);
        let slope = (missing - missing_before) / (out - before);
        if missing.abs() < 1e-12 || slope == 0.0 || !slope.is_finite() {
            break;
        }
        (before, missing_before) = (out, missing);
        out = (out - missing / slope).clamp(0.0, MOST_OUT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_both_sides_become_common_points() {
        let stops = stops(&[0.0, 0.5, 1.0], &[0.0, 0.501, 0.8, 1.0], 1.0, 0.02);
        assert_eq!(stops.len(), 4);
        assert_eq!(stops[1], [0.5, 0.501]);
        assert!((stops[2][0] - (0.5 + 0.5 * 0.299 / 0.499)).abs() < 1e-12 && stops[2][1] == 0.8);
    }

    #[test]
    fn chords_enclose_what_their_curve_does() {
        let curve = Curve::arc([DVec2::ZERO, DVec2::X], 0.5, false, true).unwrap();
        let mut points: Vec<DVec2> = (0..=7).map(|i| curve.point(f64::from(i) / 7.0)).collect();
        keep_area(&curve, &mut points);
        let area: f64 = points.windows(2).map(|p| p[0].perp_dot(p[1])).sum();
        assert!((area - curve.twice_area()).abs() < 1e-9);
    }
}
