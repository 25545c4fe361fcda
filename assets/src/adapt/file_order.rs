//! The order of a mesh's file: its faces, and the vertex of the repaired mesh that each of its vertices became.

use glam::Vec3;

use super::mesh::ForeignMesh;
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};

/// The file's vertices in the mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FileOrder {
    /// Where the file has each vertex (m), placed as the mesh is `[file's vertices]`.
    pub start: Vec<Vec3>,
    /// The file's faces, by the file's vertices counted from 0.
    pub faces: Vec<Face>,
    /// The vertex of the repaired mesh that each became `[file's vertices]`: its own, or the nearest that is left where it was
    /// joined or its layer taken away; [`NO_VERTEX`] where no face of the file uses it.
    pub vertices: Vec<u32>,
}

impl FileOrder {
    /// Of a mesh as its file has it, in metres, and the same mesh repaired.
    pub fn of(file: &ForeignMesh, repaired: &ForeignMesh) -> Self {
        let mut vertices = vec![NO_VERTEX; file.positions.len()];
        // Where a vertex was parted in two, the first of them goes by its number.
        for (v, source) in repaired.source.iter().enumerate().rev() {
            vertices[*source as usize - 1] = v as u32;
        }
        let nearest = NearestVertex::of(&repaired.positions);
        for &corner in file.faces.iter().flat_map(corners) {
            let became = &mut vertices[corner as usize];
            if *became == NO_VERTEX {
                *became = nearest.to(file.positions[corner as usize]);
            }
        }
        Self { start: file.positions.clone(), faces: file.faces.clone(), vertices }
    }
}

/// The vertices of a mesh by their height.
struct NearestVertex<'a> {
    positions: &'a [Vec3],
    order: Vec<u32>,
}

impl<'a> NearestVertex<'a> {
    fn of(positions: &'a [Vec3]) -> Self {
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.sort_by(|a, b| positions[*a as usize].y.total_cmp(&positions[*b as usize].y));
        Self { positions, order }
    }

    /// The one nearest to a point; what was taken away lies within millimetres of what is left, so that few heights are looked at.
    fn to(&self, p: Vec3) -> u32 {
        let at = |v: &u32| self.positions[*v as usize];
        let middle = self.order.partition_point(|v| at(v).y < p.y);
        let mut best = (f32::INFINITY, NO_VERTEX);
        let mut look = |v: &u32| {
            let far = at(v).distance_squared(p);
            best = if far < best.0 { (far, *v) } else { best };
            (at(v).y - p.y).powi(2) <= best.0
        };
        _ = self.order[middle..].iter().all(&mut look);
        _ = self.order[..middle].iter().rev().all(&mut look);
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_and_dropped_vertices_go_with_the_nearest_and_loose_ones_with_none() {
        let place = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let file = ForeignMesh {
            positions: vec![
                place(0.0, 0.0),
                place(1.0, 0.0),
                place(0.0, 1.0),
                place(0.0, 0.0),
                place(9.0, 9.0),
                place(1.0, 0.01),
            ],
            source: (1..=6).collect(),
            faces: vec![[0, 1, 2, NO_VERTEX], [3, 5, 2, NO_VERTEX]],
            ..ForeignMesh::default()
        };
        let repaired = ForeignMesh {
            positions: file.positions[..3].to_vec(),
            source: vec![1, 2, 3],
            faces: vec![file.faces[0]],
            ..ForeignMesh::default()
        };
        let order = FileOrder::of(&file, &repaired);
        assert_eq!(order.vertices, [0, 1, 2, 0, NO_VERTEX, 1]);
        assert_eq!(order.faces, file.faces);
    }
}
