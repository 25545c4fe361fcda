//! The surface that is followed: a triangle mesh with its edges, and the folds between neighbouring triangles.

use std::collections::BTreeMap;

use glam::{DVec3, Vec2};

use crate::error::CaptureError;

/// Most vertices of a surface that is followed.
pub const MAX_VERTICES: usize = 200_000;

/// Farthest that a vertex may lie from the origin (m): beyond it, the mesh is in millimetres.
const FARTHEST: f64 = 100.0;

/// Two triangles that share an edge: its two vertices, then the two opposite ones, with what each counts at rest.
///
/// The sum of a fold's positions by their coefficients is 0 where the fold is flat, and grows with its curvature: the discrete
/// Laplacian of an edge (Bergou et al. 2006, "A Quadratic Bending Model for Inextensible Surfaces", equation 5), scaled so that
/// the opposite vertices count one together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Vertices: of the edge, then opposite.
    pub corners: [u32; 4],
    /// What each counts; they sum to 0.
    pub coefficients: [f64; 4],
}

/// A triangle mesh whose vertices move and whose triangles stay.
#[derive(Debug, Clone, PartialEq)]
pub struct CapturedSurface {
    /// Positions in the first frame (m, world) `[vertices]`.
    pub rest: Vec<DVec3>,
    /// Texture points `[vertices]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Corners, counter-clockwise seen from outside `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// Pairs of vertices, the smaller first `[edges]`.
    pub edges: Vec<[u32; 2]>,
    /// Inner edges `[folds]`.
    pub folds: Vec<Fold>,
}

impl CapturedSurface {
    /// A surface of a mesh called `name`.
    ///
    /// # Errors
    /// One sentence where it has no triangles, too many vertices, coordinates in millimetres, or an index of no vertex.
    pub fn new(name: &str, rest: Vec<DVec3>, uvs: Vec<Vec2>, triangles: Vec<[u32; 3]>) -> Result<Self, CaptureError> {
        let unfit = |problem: String, cure| Err(CaptureError::unfit(name, problem, cure));
        if triangles.is_empty() || rest.len() > MAX_VERTICES {
            let (v, t) = (rest.len(), triangles.len());
            return unfit(
                format!("{v} vertices and {t} triangles, where 3 to {MAX_VERTICES} are followed"),
                "give a coarser mesh",
            );
        }
        if let Some(bad) = triangles.iter().flatten().find(|i| **i as usize >= rest.len()) {
            return unfit(format!("a triangle names the vertex {bad} of {}", rest.len()), "export the mesh again");
        }
        let far = rest.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
        if !rest.iter().all(|p| p.is_finite()) || far > FARTHEST {
            let problem = format!("its vertices lie up to {far:.0} from the origin, which are millimetres");
            return unfit(problem, "give the mesh in metres, in the world of the cameras");
        }
        let sides = sides(&triangles);
        let edges = sides.keys().copied().collect();
        let folds = sides.iter().filter_map(|(edge, across)| fold(&rest, *edge, across)).collect();
        Ok(Self { rest, uvs, triangles, edges, folds })
    }

    /// Mean length of the edges in the first frame (m).
    pub fn spacing(&self) -> f64 {
        let length = |[a, b]: &[u32; 2]| self.rest[*a as usize].distance(self.rest[*b as usize]);
        self.edges.iter().map(length).sum::<f64>() / self.edges.len() as f64
    }
}

/// The opposite vertices of each edge.
fn sides(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], Vec<u32>> {
    let mut found = BTreeMap::<[u32; 2], Vec<u32>>::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            found.entry([a.min(b), a.max(b)]).or_default().push(t[(k + 2) % 3]);
        }
    }
    found
}

fn fold(rest: &[DVec3], [a, b]: [u32; 2], across: &[u32]) -> Option<Fold> {
    let [c, d] = *across else { return None };
    let [pa, pb, pc, pd] = [a, b, c, d].map(|v| rest[v as usize]);
    let cot = |at: DVec3, p: DVec3, q: DVec3| {
        let (u, v) = (p - at, q - at);
        u.dot(v) / u.cross(v).length().max(1e-12)
    };
    let (ac, bc) = (cot(pa, pb, pc), cot(pb, pa, pc));
    let (ad, bd) = (cot(pa, pb, pd), cot(pb, pa, pd));
    let (oc, od) = (-(ac + bc), -(ad + bd));
    let whole = oc.abs() + od.abs();
    let coefficients = [bc + bd, ac + ad, oc, od].map(|k| k / whole);
    (whole > 1e-9 && coefficients.iter().all(|k| k.is_finite())).then_some(Fold { corners: [a, b, c, d], coefficients })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        (vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y], vec![[0, 1, 3], [0, 3, 2]])
    }

    #[test]
    fn a_flat_fold_has_no_curvature_and_a_bent_one_has() {
        let (rest, triangles) = square();
        let surface = CapturedSurface::new("m", rest.clone(), Vec::new(), triangles).unwrap();
        assert_eq!((surface.edges.len(), surface.folds.len()), (5, 1));
        let curvature = |p: &[DVec3]| {
            let f = surface.folds[0];
            f.corners.iter().zip(f.coefficients).map(|(v, k)| p[*v as usize] * k).sum::<DVec3>().length()
        };
        let mut bent = rest.clone();
        bent[2].z = 0.4;
        assert!(curvature(&rest) < 1e-12 && curvature(&bent) > 0.1);
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        let (rest, triangles) = square();
        let said = |rest: Vec<DVec3>, t: Vec<[u32; 3]>| {
            CapturedSurface::new("m", rest, Vec::new(), t).unwrap_err().to_string()
        };
        assert!(said(rest.clone(), Vec::new()).contains("coarser"));
        assert!(said(rest.clone(), vec![[0, 1, 9]]).contains("vertex 9 of 4"));
        assert!(said(rest.iter().map(|p| *p * 900.0).collect(), triangles).contains("millimetres"));
    }
}
