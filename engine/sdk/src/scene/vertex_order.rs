//! The order in which a caller knows the vertices of a garment, whatever order the engine keeps them in.

use glam::Vec3;
use toile_assets::adapt::FileOrder;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::garment::Garment;
use toile_engine::cloth::Cloth;

/// Where a vertex is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
enum VertexOrigin {
    /// A particle of one of the cloths.
    Particle { cloth: u32, particle: u32 },
    /// No face uses it: it stands where it was.
    Stands(Vec3),
}

/// The vertices and faces of a garment in the caller's order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct VertexOrder {
    places: Vec<VertexOrigin>,
    /// Triangles by the caller's vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl VertexOrder {
    /// Of a garment that was drafted: the order of its draft. It is cloth number `cloth` of the scene.
    pub fn drafted(garment: &Garment, cloth: usize) -> Self {
        let cloth = cloth as u32;
        let mut places = vec![VertexOrigin::Stands(Vec3::ZERO); garment.particles()];
        for (vertex, particle) in garment.source.iter().zip(0..) {
            places[*vertex as usize] = VertexOrigin::Particle { cloth, particle };
        }
        let triangles = garment.triangles.iter().map(|t| t.map(|particle| garment.source[particle as usize])).collect();
        Self { places, triangles }
    }

    /// Of a mesh of the user's own: the order of its file. Its layers are the cloths from number `first` on; `vertices` are those
    /// of the repaired mesh that each layer has.
    pub fn of_file(order: &FileOrder, garments: &[Garment], vertices: &[Vec<u32>], first: usize) -> Self {
        let repaired = vertices.iter().map(Vec::len).sum();
        let mut kept = vec![VertexOrigin::Stands(Vec3::ZERO); repaired];
        for ((garment, vertices), cloth) in garments.iter().zip(vertices).zip(first as u32..) {
            for (vertex, particle) in garment.source.iter().zip(0..) {
                kept[vertices[*vertex as usize] as usize] = VertexOrigin::Particle { cloth, particle };
            }
        }
        let place = |(became, start): (&u32, &Vec3)| match *became {
            NO_VERTEX => VertexOrigin::Stands(*start),
            became => kept[became as usize],
        };
        let places = order.vertices.iter().zip(&order.start).map(place).collect();
        Self { places, triangles: triangles(&order.faces) }
    }

    pub fn vertices(&self) -> usize {
        self.places.len()
    }

    /// A value of each vertex, of those that particles have; what has no particle has `else_where`.
    pub fn each<T>(&self, of: impl Fn(usize, usize) -> T, elsewhere: impl Fn(Vec3) -> T) -> impl Iterator<Item = T> {
        self.places.iter().map(move |place| match *place {
            VertexOrigin::Particle { cloth, particle } => of(cloth as usize, particle as usize),
            VertexOrigin::Stands(at) => elsewhere(at),
        })
    }

    /// Where the vertices are (m).
    pub fn positions<'a>(&'a self, cloths: &'a [Cloth]) -> impl Iterator<Item = Vec3> + 'a {
        self.each(move |cloth, particle| cloths[cloth].positions[particle].into(), |at| at)
    }
}

/// Faces as triangles; a quad is split along a-c.
pub(super) fn triangles(faces: &[Face]) -> Vec<[u32; 3]> {
    // One after the other: flattened, compilers look into options that hold nothing, which valgrind tells.
    let mut triangles = Vec::with_capacity(2 * faces.len());
    for &[a, b, c, d] in faces {
        triangles.push([a, b, c]);
        if d != NO_VERTEX {
            triangles.push([a, c, d]);
        }
    }
    triangles
}
