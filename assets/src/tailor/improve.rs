//! Improves the ring between lattice and outline where a triangle is too sharp.
//!
//! The sharpest triangle is looked at, and one point near it is added, moved or taken away, whichever leaves the least
//! sharpness in all; where nothing helps, the next one is looked at. Points of the lattice are given up only for more than
//! they are worth.

use std::collections::BTreeSet;

use glam::DVec2;

use super::angles::{angles, interior};
use super::limits::AIM_DEG;
use super::ring::{Filled, Points};

/// Most triangles that are looked at in a panel: a usual one has fewer than ten.
const MAX_ROUNDS: usize = 120;

/// Most of them that nothing helps before the rest is left as it is.
const MAX_GIVEN_UP: usize = 16;

/// Angles below this count as sharp when changes are compared (degrees): some more than is aimed at, so that a change does
/// not spoil what is beside it.
const SHARP_DEG: f64 = AIM_DEG + 4.0;

/// What giving up a point of the lattice costs, in squared degrees of sharpness: about one angle 2.5 degrees short.
const LATTICE_WORTH: f64 = 6.0;

/// Cost of a free point.
const FREE_COST: f64 = 2.0;

/// How far a point is moved, in parts of the pitch.
const MOVES: [f64; 3] = [0.12, 0.25, 0.4];

/// Directions in which it is tried.
const DIRECTIONS: usize = 8;

/// One change of the points of a panel.
#[derive(Debug, Clone, Copy)]
enum Change {
    Insert(DVec2),
    Remove(u32),
    Move(u32, DVec2),
}

/// A triangulation and how sharp it is.
struct Judged {
    filled: Filled,
    cost: f64,
}

/// Improves the points of a panel and triangulates them; `pitch` is the spacing (m), `effort` how many points may be looked
/// at in all attempts together.
pub fn improve(points: &mut Points<'_>, filled: Filled, pitch: f64, effort: usize) -> Filled {
    let most = interior(&points.boundary.points, points.counter_clockwise);
    let cost = cost(points, &filled, &most);
    let mut best = Judged { filled, cost };
    let mut given_up: BTreeSet<[u32; 3]> = BTreeSet::new();
    let each = points.lattice.places() + points.boundary.points.len() + 1;
    let mut tries = effort / each;
    for _ in 0..MAX_ROUNDS {
        if given_up.len() > MAX_GIVEN_UP || tries == 0 {
            break;
        }
        let Some(sharpest) = sharpest(&best.filled, &most, &given_up) else { break };
        let mut simple = additions(&best.filled, sharpest);
        simple.extend(removals(points, sharpest));
        let found = choose(points, &best, &most, &simple, &mut tries).or_else(|| {
            let moves = moves(points, &best.filled, sharpest, pitch);
            choose(points, &best, &most, &moves, &mut tries)
        });
        match found {
            Some((changed, judged)) => (*points, best) = (changed, judged),
            None => {
                given_up.insert(sharpest);
            }
        }
    }
    best.filled
}

/// The least costly of some changes, if it is better than the present mesh; `tries` counts the attempts that are left.
fn choose<'b>(
    points: &Points<'b>,
    best: &Judged,
    most: &[f64],
    changes: &[Change],
    tries: &mut usize,
) -> Option<(Points<'b>, Judged)> {
    let changes = &changes[..changes.len().min(*tries)];
    *tries -= changes.len();
    let tried = changes.iter().filter_map(|change| {
        let changed = change.applied(points)?;
        let filled = changed.fill()?;
        let cost = cost(&changed, &filled, most);
        Some((changed, Judged { filled, cost }))
    });
    tried.filter(|t| t.1.cost < best.cost - 1.0).min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))
}

impl Change {
    /// The points after the change; `None` where it changes nothing that may be changed.
    fn applied<'b>(&self, points: &Points<'b>) -> Option<Points<'b>> {
        let mut changed = points.clone();
        let outline = points.boundary.points.len();
        let free = outline + points.lattice.places();
        let own = |number: u32| (number as usize).checked_sub(free);
        match *self {
            Self::Insert(at) => changed.free.push(at),
            Self::Move(number, to) if own(number).is_some() => changed.free[number as usize - free] = to,
            Self::Remove(number) if own(number).is_some_and(|i| i < points.held) => return None,
            Self::Remove(number) if own(number).is_some() => {
                changed.free.remove(number as usize - free);
            }
            Self::Remove(number) => {
                changed.lattice.remove((number as usize).checked_sub(outline)?)?;
            }
            Self::Move(number, to) => {
                changed.lattice.remove((number as usize).checked_sub(outline)?)?;
                changed.free.push(to);
            }
        }
        Some(changed)
    }
}

/// The least angle that is asked of a corner (degrees): an outline's own corner may be sharper.
fn asked(number: u32, most: &[f64]) -> f64 {
    most.get(number as usize).map_or(SHARP_DEG, |most| most.to_degrees().min(SHARP_DEG))
}

/// How many degrees each corner of a triangle is short of what is asked.
fn short(filled: &Filled, triangle: [u32; 3], most: &[f64]) -> [f64; 3] {
    let found = angles(triangle.map(|v| filled.at[v as usize]));
    [0, 1, 2].map(|k| (asked(triangle[k], most) - found[k].to_degrees()).max(0.0))
}

fn cost(points: &Points<'_>, filled: &Filled, most: &[f64]) -> f64 {
    let sharpness: f64 = filled.triangles.iter().flat_map(|t| short(filled, *t, most)).map(|s| s * s).sum();
    sharpness - points.lattice.points().count() as f64 * LATTICE_WORTH + points.free.len() as f64 * FREE_COST
}

/// The triangle that is farthest from the aim and was not given up.
fn sharpest(filled: &Filled, most: &[f64], given_up: &BTreeSet<[u32; 3]>) -> Option<[u32; 3]> {
    let by = |t: &[u32; 3]| short(filled, *t, most).into_iter().fold(0.0, f64::max);
    let sharp = filled.triangles.iter().filter(|t| by(t) > SHARP_DEG - AIM_DEG && !given_up.contains(*t));
    sharp.max_by(|a, b| by(a).total_cmp(&by(b))).copied()
}

/// Places for a new point: centres of the triangle and of its neighbours, and beside its shortest side.
fn additions(filled: &Filled, triangle: [u32; 3]) -> Vec<Change> {
    let shared = |t: &&[u32; 3]| t.iter().filter(|v| triangle.contains(v)).count() >= 2;
    let mut places = Vec::new();
    for near in filled.triangles.iter().filter(shared) {
        let p = near.map(|v| filled.at[v as usize]);
        places.push((p[0] + p[1] + p[2]) / 3.0);
        places.extend((0..3).map(|k| 0.5 * (p[k] + p[(k + 1) % 3])));
        places.extend(circumcentre(p));
        for k in 0..3 {
            let side = p[(k + 1) % 3] - p[k];
            places.extend([0.7, 1.0].map(|h| p[k] + 0.5 * side + h * side.perp()));
        }
    }
    places.into_iter().map(Change::Insert).collect()
}

fn circumcentre([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (p, q) = (b - a, c - a);
    let twice = 2.0 * p.perp_dot(q);
    let centre = DVec2::new(
        q.y * p.length_squared() - p.y * q.length_squared(),
        p.x * q.length_squared() - q.x * p.length_squared(),
    );
    (twice.abs() > 1e-12).then(|| a + centre / twice)
}

fn removals(points: &Points<'_>, triangle: [u32; 3]) -> Vec<Change> {
    let outline = points.boundary.points.len() as u32;
    triangle.into_iter().filter(|v| *v >= outline).map(Change::Remove).collect()
}

fn moves(points: &Points<'_>, filled: &Filled, triangle: [u32; 3], pitch: f64) -> Vec<Change> {
    let outline = points.boundary.points.len() as u32;
    let mut found = Vec::new();
    for v in triangle.into_iter().filter(|v| *v >= outline) {
        for k in 0..DIRECTIONS {
            let way = DVec2::from_angle(k as f64 * std::f64::consts::TAU / DIRECTIONS as f64) * pitch;
            found.extend(MOVES.map(|m| Change::Move(v, filled.at[v as usize] + m * way)));
        }
    }
    found
}
