//! The ring of neighbours around a vertex, laid flat, and what four points of it can measure.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2, TAU};

use glam::{DMat2, DVec2, Vec3};

use super::stencil::Stencil;
use crate::check::corners;
use crate::fibers::{Direction, Edge};
use crate::shape::{NO_VERTEX, Shape};

/// A measure that differs from its direction by more than this (of 1, Frobenius norm) is discarded. A poor one is better
/// than none: where a vertex measures nothing the cloth has a hinge, which no stiffness beside it makes up for, and along a rim
/// nothing else resists twisting.
const MOST_OFF: f64 = 0.8;

/// How much a measure by long levers is worse than one by short ones: enough to settle ties.
const LEVER_COST: f64 = 0.02;

/// How much a point that lies aside of a chord's direction is worse for it than one that lies on it.
const ASIDE_COST: f64 = 0.3;

/// Least sine between two chords whose product is a normal.
const LEAST_SINE: f64 = 0.2;

/// Longest lever: how much farther points pull apart than those of three in a row, for whom this is 1.
const MOST_LEVER: f64 = 8.0;

/// A fourth point with less than this share of the weights does nothing.
const LEAST_WEIGHT: f64 = 1e-5;

/// Least part of a stencil beside a clamp that counts as free to bend: what is less is an accident of the mesh.
pub const LEAST_BENDS: f64 = 0.25;

/// Neighbours and areas of all vertices.
pub struct Rings {
    /// Area of the cloth that each vertex stands for (m2).
    pub area: Vec<f64>,
    /// That of faces that can move.
    pub bending: Vec<f64>,
    /// True where the cloth ends at the vertex.
    pub rim: Vec<bool>,
    /// Neighbours by sides and diagonals.
    pub beside: Vec<Vec<u32>>,
    fans: Vec<Vec<Sector>>,
    /// Angle of each edge to the warp, from its smaller to its larger vertex (rad), and whether it is a side.
    angles: BTreeMap<(u32, u32), (f64, bool)>,
    lengths: BTreeMap<(u32, u32), f64>,
}

/// One face seen from one of its corners: the neighbours there, counter-clockwise, and the angles between them (rad).
struct Sector {
    points: [u32; 3],
    angles: [f64; 2],
}

impl Sector {
    fn last(&self) -> u32 {
        if self.points[2] == NO_VERTEX { self.points[1] } else { self.points[2] }
    }
}

fn pair(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Rings {
    /// Gathers the faces around each vertex.
    pub fn new(shape: &Shape, edges: &[Edge]) -> Self {
        let count = shape.cut.len();
        let (mut area, mut bending, mut fans) =
            (vec![0.0; count], vec![0.0; count], (0..count).map(|_| Vec::new()).collect::<Vec<Vec<Sector>>>());
        for (i, face) in shape.faces.iter().enumerate() {
            let ring = corners(face);
            let n = ring.len();
            let laid = shape.face_as_cut(i);
            let shares = corner_areas(&laid, &[0, 1, 2, 3][..n]);
            let moves = ring.iter().any(|&v| !shape.fixed[v as usize]);
            for (k, &v) in ring.iter().enumerate() {
                area[v as usize] += shares[k];
                bending[v as usize] += if moves { shares[k] } else { 0.0 };
                let (next, last) = (ring[(k + 1) % n], ring[(k + n - 1) % n]);
                let between = |p: usize, q: usize| angle(&laid, k, p % n, q % n);
                fans[v as usize].push(if n == 3 {
                    Sector { points: [next, last, NO_VERTEX], angles: [between(k + 1, k + 2), 0.0] }
                } else {
                    let far = ring[(k + 2) % n];
                    Sector { points: [next, far, last], angles: [between(k + 1, k + 2), between(k + 2, k + 3)] }
                });
            }
        }
        let mut beside = vec![Vec::new(); count];
        for e in edges {
            beside[e.a as usize].push(e.b);
            beside[e.b as usize].push(e.a);
        }
        let angles = edges.iter().map(|e| ((e.a, e.b), (f64::from(e.angle), e.side))).collect();
        let lengths = edges.iter().map(|e| ((e.a, e.b), f64::from(e.rest))).collect();
        let rim = fans.iter().map(|fan| !closed(fan)).collect();
        Self { area, bending, rim, beside, fans, angles, lengths }
    }

    /// The ring of a vertex in the plane, with the warp along x and the weft along y. Around a vertex inside of the cloth
    /// the angles are made to fill a whole turn, since cloth lies flat before it is sewn. `None` where faces meet in the
    /// vertex alone.
    pub fn flat(&self, v: usize) -> Option<Ring> {
        let around = &self.fans[v];
        let first = around.iter().position(|s| around.iter().all(|t| t.last() != s.points[0])).unwrap_or(0);
        let mut at = first;
        let (mut angle, mut points, mut sectors) = (0.0, Vec::new(), Vec::new());
        for _ in 0..around.len() {
            let sector = &around[at];
            let place = points.len();
            points.push((sector.points[0], angle));
            angle += sector.angles[0];
            if sector.points[2] == NO_VERTEX {
                sectors.push([place, place + 1, NO_POINT]);
            } else {
                sectors.push([place, place + 1, place + 2]);
                points.push((sector.points[1], angle));
                angle += sector.angles[1];
            }
            let end = sector.last();
            match around.iter().position(|s| s.points[0] == end) {
                Some(next) => at = next,
                None => points.push((end, angle)),
            }
        }
        let whole = if self.rim[v] { around.len() + 1 } else { around.len() };
        let sides = points.iter().filter(|(u, _)| self.angles[&pair(v as u32, *u)].1).count();
        let scale = if self.rim[v] { 1.0 } else { TAU / angle };
        // Around a vertex inside the last face ends where the first begins.
        let count = points.len();
        let close = |k: usize| if k == NO_POINT { NO_POINT } else { k % count };
        let sectors = sectors.into_iter().map(|s| s.map(close)).collect();
        (sides == whole && angle > 0.0).then(|| Ring {
            sectors,
            rim: self.rim[v],
            ..self.turned(v as u32, &points, scale)
        })
    }

    /// Turns a ring so that the warp runs along x, as its edges have it on average.
    fn turned(&self, v: u32, points: &[(u32, f64)], scale: f64) -> Ring {
        let mut mean = DVec2::ZERO;
        for &(u, angle) in points {
            let (of_edge, side) = self.angles[&pair(v, u)];
            let outwards = if v < u { of_edge } else { of_edge + 0.5 * TAU };
            if side {
                mean += DVec2::from_angle(outwards - angle * scale);
            }
        }
        let turn = mean.to_angle();
        let place = |&(u, angle): &(u32, f64)| (u, DVec2::from_angle(angle * scale + turn) * self.lengths[&pair(v, u)]);
        Ring { v, points: points.iter().map(place).collect(), sectors: Vec::new(), rim: false }
    }
}

/// True where the faces close around the vertex.
fn closed(fan: &[Sector]) -> bool {
    fan.iter().all(|s| fan.iter().any(|t| t.points[0] == s.last()))
}

fn face_area(positions: &[Vec3], ring: &[u32]) -> f64 {
    let p = |k: usize| positions[ring[k] as usize].as_dvec3();
    (2..ring.len()).map(|k| 0.5 * (p(k - 1) - p(0)).cross(p(k) - p(0)).length()).sum()
}

/// The part of a face's area that is nearest to each of its corners: of a triangle that of Voronoi, in an obtuse one half
/// of it at the obtuse corner (Meyer et al. 2003, "Discrete differential-geometry operators", 3.3); of a quad a quarter.
/// Equal thirds would weigh stencils side by side on a thread unequally where six and four faces meet in turn, and a thread
/// of stiff and soft places in a row is softer than their mean.
fn corner_areas(positions: &[Vec3], ring: &[u32]) -> [f64; 4] {
    let area = face_area(positions, ring);
    if ring.len() != 3 {
        return [0.25 * area; 4];
    }
    let side = |k: usize| positions[ring[(k + 1) % 3] as usize].distance_squared(positions[ring[k % 3] as usize]);
    let opposite = [1, 2, 0].map(|k| f64::from(side(k)));
    // 4 area cot(angle) at each corner.
    let cot = [0, 1, 2].map(|k| opposite[(k + 1) % 3] + opposite[(k + 2) % 3] - opposite[k]);
    if let Some(obtuse) = cot.iter().position(|c| *c < 0.0) {
        let mut shares = [0.25 * area; 4];
        shares[obtuse] = 0.5 * area;
        return shares;
    }
    let part = |k: usize| opposite[k] * cot[k] / (32.0 * area);
    [part(1) + part(2), part(2) + part(0), part(0) + part(1), 0.0]
}

fn angle(positions: &[Vec3], v: usize, p: usize, q: usize) -> f64 {
    let from = |i: usize| positions[i].as_dvec3() - positions[v].as_dvec3();
    from(p).cross(from(q)).length().atan2(from(p).dot(from(q)))
}

/// Stands for no third point of a triangle's sector.
pub const NO_POINT: usize = usize::MAX;

/// A vertex and its neighbours in the plane.
pub struct Ring {
    /// Index of the vertex in the middle, in the shape.
    pub v: u32,
    /// Its neighbours, counter-clockwise, and where they lie (m).
    pub points: Vec<(u32, DVec2)>,
    /// The points of each face, counter-clockwise; [`NO_POINT`] in the third place of a triangle.
    pub sectors: Vec<[usize; 3]>,
    /// True where the cloth ends at the vertex.
    pub rim: bool,
}

/// What of the curvature tensor a measure is to be, as a tensor of length 1.
#[derive(Debug, Clone, Copy)]
pub enum RingTensor {
    /// The curvature along a direction (unit).
    Along(DVec2),
    /// The twist between warp and weft, sqrt2 k12.
    Twist,
}

impl RingTensor {
    /// How much of it another tensor is.
    fn part(self, other: DMat2) -> f64 {
        match self {
            Self::Along(d) => d.dot(other * d),
            Self::Twist => FRAC_1_SQRT_2 * (other.x_axis.y + other.y_axis.x),
        }
    }

    /// How much better a triple has to be than one before it. Of a twist all cells around a vertex are as good but for rounding, and
    /// each is to be measured as often as the others: a vertex takes the first of its ring. Where rounding chose, every other cell of
    /// some was free to twist, and cloth had two thirds of its stiffness.
    fn tie(self) -> f64 {
        match self {
            Self::Along(_) => 1e-9,
            Self::Twist => 1e-4,
        }
    }

    /// The tensor itself.
    fn exact(self) -> DMat2 {
        match self {
            Self::Along(d) => DMat2::from_cols(d * d.x, d * d.y),
            Self::Twist => DMat2::from_cols(DVec2::Y, DVec2::X) * FRAC_1_SQRT_2,
        }
    }

    /// How much of it a point's dyad is (m2).
    fn of_point(self, x: DVec2) -> f64 {
        match self {
            Self::Along(d) => d.dot(x).powi(2),
            Self::Twist => SQRT_2 * x.x * x.y,
        }
    }
}

/// An affine dependence of points around a vertex.
#[derive(Debug, Clone, Copy)]
pub struct RingMeasure {
    /// The vertex, then up to three of its ring.
    pub v: [u32; 4],
    /// Weights of those of the ring (1/m2).
    weights: [f64; 3],
    /// What part of the curvature along its direction each of them measures; together 1.
    shares: [f64; 3],
    /// What it measures of the curvature tensor: 1 along its direction.
    pub tensor: DMat2,
    /// How far that is from what it is to measure (1, Frobenius norm).
    pub off: f64,
}

impl RingMeasure {
    /// The stencil of a stiffness (N m3), of which so much bends (1). The weights sum to zero as exactly as f32 can.
    pub fn stencil(&self, direction: Direction, k: f64, bends: f64) -> Stencil {
        let [p, q, r] = self.weights.map(|w| w as f32);
        let count = if self.v[3] == NO_VERTEX { 3 } else { 4 };
        let c = [-(p + q + r), p, q, r];
        Stencil { v: self.v[..count].to_vec(), c: c[..count].to_vec(), k: k as f32, direction, bends: bends as f32 }
    }

    /// How each of its particles is pushed by a moment over an area (m2), as weights.
    pub fn forces(&self, area: f64) -> Vec<(u32, f64)> {
        let own = (self.v[0], -self.weights.iter().sum::<f64>() * area);
        let ring = self.v[1..].iter().zip(self.weights).map(|(v, w)| (*v, w * area));
        std::iter::once(own).chain(ring.filter(|(v, _)| *v != NO_VERTEX)).collect()
    }

    /// The part of its length that can bend: all of it, but where the vertex is fixed and so is what lies behind it, as in
    /// a clamp, only what lies before. There the cloth turns on its half of the length, so that the sum measures as much
    /// less of the curvature as that half is shorter than the whole.
    pub fn bends(&self, fixed: &[bool]) -> f64 {
        if !fixed[self.v[0] as usize] {
            return 1.0;
        }
        let ring = self.v[1..].iter().zip(self.shares);
        let free = ring.filter(|(v, _)| **v != NO_VERTEX && !fixed[**v as usize]).map(|(_, share)| share);
        free.sum::<f64>().clamp(LEAST_BENDS, 1.0)
    }
}

impl Ring {
    /// The three points that with the vertex measure a part of the curvature tensor best.
    pub fn measure(&self, wanted: RingTensor) -> Option<RingMeasure> {
        let n = self.points.len();
        let mut best: Option<(f64, RingMeasure)> = None;
        for i in 0..n {
            for j in i + 1..n {
                // With three points in a row a fourth has no weight, so that two neighbours need a third to stand by.
                for k in j + 1..n {
                    let Some((cost, found)) = self.dependence([i, j, k], wanted) else { continue };
                    if best.as_ref().is_none_or(|(least, _)| cost < least - wanted.tie()) {
                        best = Some((cost, found));
                    }
                }
            }
        }
        best.map(|(_, found)| found)
    }

    /// Two chords, one along the warp and one along the weft, whose product is the normal of the cloth at the vertex: the
    /// ends of each are as far apart as the ring has them, and as little aside.
    pub fn chords(&self) -> Option<[u32; 4]> {
        let own = (self.v, DVec2::ZERO);
        let all = || std::iter::once(&own).chain(&self.points);
        let farthest = |along: DVec2| {
            let reach = |p: &DVec2| p.dot(along) - ASIDE_COST * p.perp_dot(along).abs();
            all().fold(own, |best, p| if reach(&p.1) > reach(&best.1) + 1e-9 { *p } else { best })
        };
        let [a, b, c, d] = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].map(farthest);
        let (one, other) = (a.1 - b.1, c.1 - d.1);
        let sine = one.perp_dot(other) / (one.length() * other.length());
        (sine > LEAST_SINE).then_some([a.0, b.0, c.0, d.0])
    }

    /// The affine dependence of the vertex and three points, normalised to measure 1 of what is wanted; and how bad it is.
    fn dependence(&self, triple: [usize; 3], wanted: RingTensor) -> Option<(f64, RingMeasure)> {
        let [p, q, r] = triple.map(|k| self.points[k].1);
        // Barycentric, with the vertex in the origin: w_p p + w_q q + w_r r = 0.
        let raw = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
        let tensor = |w: [f64; 3]| {
            let outer = |w: f64, x: DVec2| DMat2::from_cols(x * x.x, x * x.y) * (0.5 * w);
            outer(w[0], p) + outer(w[1], q) + outer(w[2], r)
        };
        let along = wanted.part(tensor(raw));
        let scale = raw.iter().zip([p, q, r]).map(|(w, x)| w.abs() * x.length_squared()).sum::<f64>();
        if along.abs() < 1e-6 * scale || scale == 0.0 {
            return None;
        }
        let weights = raw.map(|w| w / along);
        let found = tensor(weights);
        let off = (found - wanted.exact()).to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        let lever = 0.5 * scale / along.abs();
        let cost = off + LEVER_COST * lever;
        let shares = [0, 1, 2].map(|k| 0.5 * weights[k] * wanted.of_point([p, q, r][k]));
        (off < MOST_OFF && lever < MOST_LEVER)
            .then(|| (cost, RingMeasure { off, ..self.tidied(triple, weights, shares, found) }))
    }

    /// Leaves out a point without weight.
    fn tidied(&self, triple: [usize; 3], weights: [f64; 3], shares: [f64; 3], tensor: DMat2) -> RingMeasure {
        let least = LEAST_WEIGHT * weights.iter().map(|w| w.abs()).sum::<f64>();
        let mut v = [self.v, NO_VERTEX, NO_VERTEX, NO_VERTEX];
        let (mut kept, mut kept_shares) = ([0.0; 3], [0.0; 3]);
        let used = (0..3).filter(|&k| weights[k].abs() > least);
        for (place, k) in used.enumerate() {
            v[place + 1] = self.points[triple[k]].0;
            (kept[place], kept_shares[place]) = (weights[k], shares[k]);
        }
        RingMeasure { v, weights: kept, shares: kept_shares, tensor, off: 0.0 }
    }
}
