//! One surface of a moving scene, as every writer takes it: what stays while its vertices move.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec2;

use super::surface::SurfaceLook;
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::body::Body;
use toile_base::garment::Garment;

/// A surface whose vertices move.
#[derive(Debug, Clone)]
pub struct MovingPart {
    /// Its name.
    pub name: String,
    /// How many vertices it has.
    pub vertices: usize,
    /// Triangles and quads, counter-clockwise seen from outside.
    pub faces: Vec<Face>,
    /// Texture points of the corners of each face, v upwards `[faces]`, or empty; the fourth of a triangle is not read.
    pub uvs: Vec<[Vec2; 4]>,
    /// How it looks.
    pub look: SurfaceLook,
    /// The body whose skeleton moves it, where one does: its vertices are the body's.
    pub skinned: Option<Arc<Body>>,
}

impl MovingPart {
    /// A garment as it is simulated: its vertices are its particles.
    pub fn garment(garment: &Garment) -> Self {
        let (look, corners) = SurfaceLook::of_garment(garment);
        Self {
            name: garment.name.clone(),
            vertices: garment.particles(),
            faces: garment.triangles.iter().map(face).collect(),
            uvs: corners.into_iter().map(|[a, b, c]| [a, b, c, a]).collect(),
            look,
            skinned: None,
        }
    }

    /// A body on its skeleton, with skin of a colour (linear RGB).
    pub fn body(body: &Body, skin: [f32; 3]) -> Self {
        let triangles = &body.mesh.triangles;
        let up = |v: u32| body.mesh.uvs.get(v as usize).map_or(Vec2::ZERO, |uv| Vec2::new(uv.x, 1.0 - uv.y));
        let uvs = if body.mesh.uvs.is_empty() {
            Vec::new()
        } else {
            triangles.iter().map(|&[a, b, c]| [a, b, c, a].map(up)).collect()
        };
        Self {
            name: "body".into(),
            vertices: body.mesh.positions.len(),
            faces: triangles.iter().map(face).collect(),
            uvs,
            look: SurfaceLook::skin(skin),
            skinned: Some(Arc::new(body.clone())),
        }
    }

    /// The corners of a face.
    pub(super) fn corners(face: &Face) -> &[u32] {
        corners(face)
    }
}

fn face(&[a, b, c]: &[u32; 3]) -> Face {
    [a, b, c, NO_VERTEX]
}

/// A surface for formats with one texture point a vertex: vertices with several are there several times.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SplitSurface {
    /// The part's vertex of each; those of the part come first, in their order, then the copies.
    pub source: Vec<u32>,
    /// Texture points, v upwards `[source]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Indices into `source`.
    pub triangles: Vec<[u32; 3]>,
}

impl SplitSurface {
    pub fn of(part: &MovingPart) -> Self {
        let mut split = Self { source: (0..part.vertices as u32).collect(), uvs: Vec::new(), triangles: Vec::new() };
        let mut at: Vec<Option<Vec2>> = vec![None; part.vertices];
        let mut copies: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let mut place = |v: u32, uv: Option<&Vec2>| {
            let Some(uv) = uv else { return v };
            let known = at[v as usize].get_or_insert(*uv);
            if known == uv {
                return v;
            }
            *copies.entry((v, uv.to_array().map(f32::to_bits))).or_insert_with(|| {
                split.source.push(v);
                at.push(Some(*uv));
                at.len() as u32 - 1
            })
        };
        for (i, face) in part.faces.iter().enumerate() {
            let uvs = part.uvs.get(i);
            let ring: Vec<u32> = corners(face).iter().enumerate().map(|(k, v)| place(*v, uvs.map(|c| &c[k]))).collect();
            split.triangles.extend((2..ring.len()).map(|k| [ring[0], ring[k - 1], ring[k]]));
        }
        if !part.uvs.is_empty() {
            split.uvs = at.into_iter().map(Option::unwrap_or_default).collect();
        }
        split
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_of_a_seam_are_copied_behind_all_others() {
        let uv = |u: f32, v: f32| Vec2::new(u, v);
        let part = MovingPart {
            name: "two squares".into(),
            vertices: 6,
            faces: vec![[0, 1, 4, 3], [1, 2, 5, NO_VERTEX]],
            uvs: vec![
                [uv(0.0, 0.0), uv(1.0, 0.0), uv(1.0, 1.0), uv(0.0, 1.0)],
                [uv(5.0, 0.0), uv(6.0, 0.0), uv(6.0, 1.0), Vec2::ZERO],
            ],
            look: SurfaceLook::cloth([0.5; 3]),
            skinned: None,
        };
        let split = SplitSurface::of(&part);
        assert_eq!(split.source, [0, 1, 2, 3, 4, 5, 1]);
        assert_eq!(split.triangles, [[0, 1, 4], [0, 4, 3], [6, 2, 5]]);
        assert_eq!((split.uvs[1], split.uvs[6], split.uvs[2]), (uv(1.0, 0.0), uv(5.0, 0.0), uv(6.0, 0.0)));
        let plain = SplitSurface::of(&MovingPart { uvs: Vec::new(), ..part });
        assert_eq!((plain.source.len(), plain.uvs.len(), plain.triangles[2]), (6, 0, [1, 2, 5]));
    }
}
