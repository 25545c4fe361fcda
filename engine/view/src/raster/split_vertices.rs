//! Vertices as they are drawn: one that lies in several places of a texture is drawn once for each.

use std::collections::HashMap;

use glam::Vec2;

use super::model::RenderSurface;

/// Bytes of the points of a vertex that is drawn: its source, texture point, distances, trims near it.
pub const POINT_BYTES: usize = 24;

/// The vertices of a surface as they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct SplitVertices {
    /// The surface's vertex that each is `[drawn]`.
    pub source: Vec<u32>,
    /// Texture point, place on the cloth (m), distance from hem and seam (m) of each `[drawn]`.
    pub points: Vec<[Vec2; 3]>,
    /// The trims that its triangles may show, a bit for each `[drawn]`.
    pub near: Vec<u32>,
    /// Corners of the triangles, as they are drawn.
    pub triangles: Vec<[u32; 3]>,
}

/// How far from hems and seams everything else is (m).
const FAR: Vec2 = Vec2::splat(1.0);

impl SplitVertices {
    /// Of a surface; one without a texture is drawn as it is.
    pub fn of(shape: &RenderSurface) -> Self {
        let Some(look) = shape.look.as_ref().filter(|l| !(l.corners.is_empty() && l.cloth.is_empty())) else {
            let source: Vec<u32> = (0..shape.rest.len() as u32).collect();
            let points = vec![[Vec2::ZERO, Vec2::ZERO, FAR]; source.len()];
            let near = vec![0; source.len()];
            return Self { source, points, near, triangles: shape.triangles.clone() };
        };
        let mut split = Self { source: Vec::new(), points: Vec::new(), near: Vec::new(), triangles: Vec::new() };
        let mut known: HashMap<(u32, u32, [[u32; 2]; 3]), u32> = HashMap::new();
        let at = |list: &[[Vec2; 3]], t: usize, k: usize, none: Vec2| list.get(t).map_or(none, |corners| corners[k]);
        for (t, corners) in shape.triangles.iter().enumerate() {
            let near = look.near.get(t).copied().unwrap_or(0);
            let corner = |k: usize| {
                let zero = Vec2::ZERO;
                let point = [at(&look.corners, t, k, zero), at(&look.cloth, t, k, zero), at(&look.edges, t, k, FAR)];
                let bits = point.map(|p| p.to_array().map(f32::to_bits));
                *known.entry((corners[k], near, bits)).or_insert_with(|| {
                    split.source.push(corners[k]);
                    split.points.push(point);
                    split.near.push(near);
                    split.source.len() as u32 - 1
                })
            };
            let triangle = [0, 1, 2].map(corner);
            split.triangles.push(triangle);
        }
        split
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::cloth_look::GarmentLook;
    use crate::raster::RenderMaterial;

    #[test]
    fn a_vertex_of_a_seam_is_drawn_on_both_sides() {
        let mut surface = RenderSurface {
            rest: vec![Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y],
            look: None,
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            colour: Vec3::ONE,
            material: RenderMaterial::Diffuse,
        };
        let plain = SplitVertices::of(&surface);
        assert_eq!((plain.source, &plain.triangles), (vec![0, 1, 2, 3], &surface.triangles));
        let [a, b, c, d, e] = [0.0, 1.0, 2.0, 3.0, 4.0].map(Vec2::splat);
        // The second triangle has vertex 0 where the first has it, and vertex 2 elsewhere.
        let cloth = vec![[a, b, c], [a, d, e]];
        surface.look = Some(GarmentLook { cloth, ..GarmentLook::default() });
        let split = SplitVertices::of(&surface);
        assert_eq!(split.source, [0, 1, 2, 2, 3]);
        assert_eq!(split.triangles, [[0, 1, 2], [0, 3, 4]]);
        assert_eq!(split.points[3][1], d);
    }
}
