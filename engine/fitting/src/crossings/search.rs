//! All crossings of meshes with each other and with themselves.

use glam::DVec3;

use super::bounds::Bounds;
use super::grid::{Mailboxes, TriangleGrid};
use super::mesh::{CrossingMesh, are_testable, unique_edges};
use super::predicate::passes_through;

/// Which edge crosses which triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Crossing {
    /// Vertices of the edge, the lower first.
    pub edge: [u32; 2],
    /// Index of the mesh that the edge is of.
    pub edge_mesh: usize,
    /// Index of the triangle in its mesh.
    pub triangle: u32,
    /// Index of the mesh that the triangle is of.
    pub triangle_mesh: usize,
}

/// Finds where meshes cross. It keeps what depends on the topology (unique edges of each mesh), so that it can be asked
/// every tenth step of a long run.
///
/// An edge crosses a triangle where it passes through its interior: touching does not count, be it at a corner, along an
/// edge or in a plane. So two sheets that are drawn alike and meet with edge exactly on edge have no crossing, however
/// they lie; who lays meshes out sets one aside. Edges and triangles with a vertex that is not finite, or farther than
/// 1e90 m, are left out; [`CrossingTest::untested`] counts such triangles.
#[derive(Debug)]
pub struct CrossingTest {
    topologies: Vec<Topology>,
}

/// What does not change of a mesh.
#[derive(Debug)]
struct Topology {
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    /// Vertices that the triangles need, at least.
    vertices: usize,
}

impl Topology {
    fn new(triangles: &[[u32; 3]]) -> Self {
        let vertices = triangles.iter().flatten().max().map_or(0, |last| *last as usize + 1);
        Self { triangles: triangles.to_vec(), edges: unique_edges(triangles), vertices }
    }

    /// The mesh with positions.
    fn at<'a>(&'a self, positions: &'a [DVec3]) -> CrossingMesh<'a> {
        let (given, needed) = (positions.len(), self.vertices);
        assert!(given >= needed, "{given} positions were given, but the triangles name {needed}; give all vertices");
        CrossingMesh { positions, triangles: &self.triangles }
    }
}

impl CrossingTest {
    /// Of meshes with these triangles. At load.
    pub fn new(triangles: &[&[[u32; 3]]]) -> Self {
        Self { topologies: triangles.iter().map(|of| Topology::new(of)).collect() }
    }

    /// All crossings between different meshes, of each mesh's positions (m): in the order of the edge's mesh, the
    /// triangle's mesh, the edge and the triangle.
    ///
    /// # Panics
    /// Where there are not as many lists of positions as meshes, or fewer positions than the triangles name.
    pub fn between(&self, positions: &[&[DVec3]]) -> Vec<Crossing> {
        let meshes = self.meshes(positions);
        let pairs = meshes.iter().zip(&self.topologies);
        let grids: Vec<TriangleGrid> = pairs.map(|(mesh, of)| TriangleGrid::new(*mesh, &of.edges)).collect();
        let mut found = Vec::new();
        for (edge_mesh, mesh) in meshes.iter().enumerate() {
            for (triangle_mesh, grid) in grids.iter().enumerate().filter(|(other, _)| *other != edge_mesh) {
                let edges = &self.topologies[edge_mesh].edges;
                let crossing = |edge, triangle| Crossing { edge, edge_mesh, triangle, triangle_mesh };
                each_crossing((mesh, edges), grid, false, |e, t| found.push(crossing(e, t)));
            }
        }
        found
    }

    /// All crossings of a mesh with itself, of its positions (m), in the order of the edges and triangles. Edges and
    /// triangles that share a vertex are left out.
    ///
    /// # Panics
    /// Where there is no such mesh, or fewer positions than its triangles name.
    pub fn within(&self, mesh: usize, positions: &[DVec3]) -> Vec<Crossing> {
        let topology = &self.topologies[mesh];
        let of = topology.at(positions);
        let grid = TriangleGrid::new(of, &topology.edges);
        let mut found = Vec::new();
        let crossing = |edge, triangle| Crossing { edge, edge_mesh: mesh, triangle, triangle_mesh: mesh };
        each_crossing((&of, &topology.edges), &grid, true, |e, t| found.push(crossing(e, t)));
        found
    }

    /// How many triangles of all meshes are left out of every answer, because a vertex is not finite or too far.
    ///
    /// # Panics
    /// As [`CrossingTest::between`] does.
    pub fn untested(&self, positions: &[&[DVec3]]) -> usize {
        let untested =
            |mesh: &CrossingMesh| (0..mesh.triangles.len() as u32).filter(|t| !are_testable(&mesh.corners(*t))).count();
        self.meshes(positions).iter().map(untested).sum()
    }

    fn meshes<'a>(&'a self, positions: &[&'a [DVec3]]) -> Vec<CrossingMesh<'a>> {
        let (given, needed) = (positions.len(), self.topologies.len());
        assert!(
            given == needed,
            "positions of {given} meshes were given, but the test is of {needed}; give one list each"
        );
        self.topologies.iter().zip(positions).map(|(topology, of)| topology.at(of)).collect()
    }
}

/// Calls for each edge of a mesh and each triangle of a grid that it crosses, in their order.
fn each_crossing(
    (mesh, edges): (&CrossingMesh, &[[u32; 2]]),
    grid: &TriangleGrid,
    is_same: bool,
    mut call: impl FnMut([u32; 2], u32),
) {
    let mut met = Mailboxes::new(grid.mesh.triangles.len());
    let mut crossed = Vec::new();
    for &edge in edges {
        let ends = mesh.ends(edge);
        if !are_testable(&ends) {
            continue;
        }
        grid.each_near(&Bounds::of(&ends), &mut met, |t| {
            // At a vertex that they share they touch, and exact signs would say so; this is faster.
            let shares = || grid.mesh.triangles[t as usize].iter().any(|v| edge.contains(v));
            if !(is_same && shares()) && passes_through(ends, grid.mesh.corners(t)) {
                crossed.push(t);
            }
        });
        crossed.sort_unstable();
        crossed.drain(..).for_each(|t| call(edge, t));
    }
}
