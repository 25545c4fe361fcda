//! Curvature over a whole ring, where three or four points of it cannot measure it.
//!
//! Cloth bends between two states of balance: moments that are even all over must push no particle inside of the cloth,
//! or the mesh finds a crumpled form that costs less than the smooth one and hangs too low however fine it is. A stencil
//! that measures a parabola exactly says nothing of that. Galerkin's weights do both: with the hat function phi of the
//! vertex and the facets of the ring
//!
//! H = - sum over facets of area sym(grad phi (x) grad x) + 1/2 sum over rim edges of sym(n (x) grad x)
//!
//! is the integral of the curvature tensor times phi (Herrmann 1967 and Miyoshi 1973, mixed elements for plates, with
//! moments and deflections both linear between the vertices, the moments' area lumped). The hats sum to one, so that even
//! moments cancel; every H vanishes on flat cloth. On rectangles it is the second difference along each thread.
//!
//! **Rims.** At a free rim no moment acts across it. So there the plate's rigidity D (3 x 3, on k11, k22, sqrt2 k12) is
//! condensed: D - (D n)(D n)^T / n.D n with n the curvature across the rim; a corner has two such directions.

use glam::{DMat3, DVec2, DVec3};

use super::ring::{NO_POINT, Ring};
use super::stencil::Stencil;
use crate::fibers::Direction;

/// What the ring of a vertex measures as a whole.
#[derive(Debug, Clone)]
pub struct RingCurvature {
    /// The vertex, then its ring.
    pub v: Vec<u32>,
    /// Weights of each of them in the integrals of k11, k22 and sqrt2 k12 over the vertex' part of the cloth (1).
    weights: Vec<DVec3>,
    /// Outward normals of the rim at the vertex: none inside, one where it is straight, two at a corner.
    normals: Vec<DVec2>,
}

/// Cosine between the normals of two rim edges from which on the rim counts as straight.
const STRAIGHT: f64 = 0.7;

/// A rigidity below this share of the plate's comes from rounding.
const LEAST_SHARE: f64 = 1e-6;

/// Least sum of the weights of the twist from which on a ring measures it; that of whole cells is sqrt2.
const LEAST_TWIST: f64 = 0.1;

/// A part of the curvature energy: rigidity (N m) times the square of a sum.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvatureTerm {
    /// Direction whose curvature it mainly measures.
    pub direction: Direction,
    /// Rigidity (N m).
    pub rigidity: f64,
    /// Weights of the vertex and its ring: integral of that curvature over the vertex' part of the cloth.
    pub weights: Vec<f64>,
}

impl CurvatureTerm {
    /// The stencil over the particles `v` of a vertex that stands for an area (m2). The weights sum to zero as exactly as
    /// f32 can.
    pub fn stencil(&self, v: &[u32], area: f64) -> Stencil {
        let mut c: Vec<f32> = self.weights.iter().map(|w| (w / area) as f32).collect();
        c[0] = -c[1..].iter().sum::<f32>();
        Stencil { v: v.to_vec(), c, k: (self.rigidity * area) as f32, direction: self.direction, bends: 1.0 }
    }
}

fn symmetric(a: DVec2, b: DVec2) -> DVec3 {
    DVec3::new(a.x * b.x, a.y * b.y, std::f64::consts::FRAC_1_SQRT_2 * (a.x * b.y + a.y * b.x))
}

/// Gradients of the hats of the origin, `a` and `b` in their triangle, and its area.
fn gradients(a: DVec2, b: DVec2) -> ([DVec2; 3], f64) {
    let twice = a.perp_dot(b);
    ([(b - a).perp() / twice, -b.perp() / twice, a.perp() / twice], 0.5 * twice)
}

impl RingCurvature {
    /// Of a ring whose facets all have an area.
    pub fn new(ring: &Ring) -> Option<Self> {
        let v: Vec<u32> = std::iter::once(ring.v).chain(ring.points.iter().map(|(u, _)| *u)).collect();
        let mut out = Self { weights: vec![DVec3::ZERO; v.len()], v, normals: Vec::new() };
        let place = |k: usize| ring.points[k].1;
        for sector in &ring.sectors {
            for (share, ends) in facets(sector) {
                let ([own, ..], area) = gradients(place(ends[0]), place(ends[1]));
                if area <= 0.0 {
                    return None;
                }
                out.add(ring, ends, own * (-area * share));
            }
        }
        if let (true, Some(first), Some(last)) = (ring.rim, ring.sectors.first(), ring.sectors.last()) {
            let (begin, end) = (place(first[0]), place(last_of(last)));
            let across = [-begin.perp(), end.perp()];
            for (k, sector) in [(0, first), (1, last)] {
                for (share, ends) in facets(sector).filter(|(_, ends)| ends[k] == [first[0], last_of(last)][k]) {
                    out.add(ring, ends, across[k] * (0.5 * share));
                }
            }
            out.normals = merged(across);
        }
        Some(out)
    }

    /// Adds sym(by (x) gradient) of a facet.
    fn add(&mut self, ring: &Ring, ends: [usize; 2], by: DVec2) {
        let (gradients, _) = gradients(ring.points[ends[0]].1, ring.points[ends[1]].1);
        for (at, gradient) in [0, ends[0] + 1, ends[1] + 1].into_iter().zip(gradients) {
            self.weights[at] += symmetric(by, gradient);
        }
    }

    /// The plate's rigidity where it is free to bend across the rim.
    pub fn plate(&self, plate: DMat3) -> DMat3 {
        let mut left = plate;
        let least = LEAST_SHARE * trace(&plate);
        for n in &self.normals {
            let across = left * symmetric(*n, *n);
            let own = across.dot(symmetric(*n, *n));
            if own > least {
                left -= DMat3::from_cols(across * across.x, across * across.y, across * across.z) * (1.0 / own);
            }
        }
        left
    }

    /// The energy of curvature as a sum of squares, at most three: L D L^T of the plate, largest first.
    pub fn parts(&self, plate: DMat3) -> Vec<CurvatureTerm> {
        let mut left = self.plate(plate);
        let least = LEAST_SHARE * trace(&plate);
        let mut parts = Vec::new();
        for _ in 0..3 {
            let diagonal = [left.x_axis.x, left.y_axis.y, left.z_axis.z];
            let largest = (0..3).fold(0, |best, k| if diagonal[k] > diagonal[best] { k } else { best });
            let rigidity = diagonal[largest];
            if rigidity <= least {
                break;
            }
            let row = left.col(largest) / rigidity;
            left -= DMat3::from_cols(row * row.x, row * row.y, row * row.z) * rigidity;
            let direction = [Direction::Warp, Direction::Weft, Direction::Bias][largest];
            parts.push(CurvatureTerm {
                direction,
                rigidity,
                weights: self.weights.iter().map(|w| w.dot(row)).collect(),
            });
        }
        parts
    }

    /// Whether its points lie so that they can tell a twist at all: those on two threads that cross cannot.
    pub fn measures_twist(&self) -> bool {
        self.weights.iter().map(|w| w.z.abs()).sum::<f64>() > LEAST_TWIST
    }

    /// How far weights of some of its points are from the integral along warp (0) or weft (1), over that itself.
    pub fn differs(&self, along: usize, points: &[(u32, f64)]) -> f64 {
        let other = |v: u32| points.iter().filter(|(u, _)| *u == v).map(|(_, w)| w).sum::<f64>();
        let own = |k: usize| self.weights[k][along];
        let off: f64 = self.v.iter().enumerate().map(|(k, v)| (own(k) - other(*v)).abs()).sum();
        off / (0..self.v.len()).map(|k| own(k).abs()).sum::<f64>().max(f64::MIN_POSITIVE)
    }
}

fn last_of(sector: &[usize; 3]) -> usize {
    if sector[2] == NO_POINT { sector[1] } else { sector[2] }
}

/// Triangles of a face at the vertex, with their share: a quad is half of each way to split it.
fn facets(&[next, far, last]: &[usize; 3]) -> impl Iterator<Item = (f64, [usize; 2])> {
    let triangle = [(1.0, [next, far]); 1];
    let quad = [(0.5, [next, far]), (0.5, [far, last]), (0.5, [next, last])];
    let (one, three) = if last == NO_POINT { (1, 0) } else { (0, 3) };
    triangle.into_iter().take(one).chain(quad.into_iter().take(three))
}

/// Unit normals of a rim.
fn merged(across: [DVec2; 2]) -> Vec<DVec2> {
    let [a, b] = across.map(|n| n.normalize_or_zero());
    if a.dot(b) > STRAIGHT { vec![(a + b).normalize()] } else { vec![a, b] }
}

fn trace(m: &DMat3) -> f64 {
    m.x_axis.x + m.y_axis.y + m.z_axis.z
}
