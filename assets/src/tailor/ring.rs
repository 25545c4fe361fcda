//! Between the lattice and the outline: a constrained Delaunay triangulation of the points of both.

use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::lattice::Lattice;
use super::sampling::Boundary;

/// A point of the triangulation and its number in the panel.
#[derive(Debug, Clone, Copy)]
struct Node {
    at: DVec2,
    number: u32,
}

impl HasPosition for Node {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

/// What a panel is meshed from: the outline's points, the lattice, and free points between them. A panel's points are
/// numbered in this order.
#[derive(Debug, Clone)]
pub struct Points<'b> {
    /// Points of the outline, which all stay.
    pub boundary: &'b Boundary,
    /// True where the outline runs counter-clockwise.
    pub counter_clockwise: bool,
    /// The lattice, without the points that were taken away.
    pub lattice: Lattice,
    /// Points on neither (m).
    pub free: Vec<DVec2>,
    /// How many of them, from the first, must not be taken away.
    pub held: usize,
}

/// The ring between outline and lattice.
#[derive(Debug, Clone)]
pub struct Filled {
    /// Where each point is (m), by its number: the outline's, then the lattice's by their places, then the free ones.
    pub at: Vec<DVec2>,
    /// Triangles, counter-clockwise in the drawing, in a fixed order.
    pub triangles: Vec<[u32; 3]>,
}

impl Points<'_> {
    /// Number of a point of the lattice.
    pub fn of_lattice(&self, place: usize) -> u32 {
        (self.boundary.points.len() + place) as u32
    }

    /// Number of a free point.
    pub fn of_free(&self, i: usize) -> u32 {
        (self.boundary.points.len() + self.lattice.places() + i) as u32
    }

    /// Triangulates what lies between the outline and the lattice's whole cells; `None` where the outline's points cannot
    /// all be joined, because a part of the panel is too narrow.
    pub fn fill(&self) -> Option<Filled> {
        let rim = Rim::of(&self.lattice);
        let mut at = self.boundary.points.clone();
        at.resize(at.len() + self.lattice.places(), DVec2::NAN);
        let mut nodes: Vec<Node> = Vec::new();
        // Where each number stands among the nodes.
        let mut node_of = vec![u32::MAX; at.len() + self.free.len()];
        let mut add = |number: u32, at: DVec2| {
            node_of[number as usize] = nodes.len() as u32;
            nodes.push(Node { at, number });
        };
        self.boundary.points.iter().enumerate().for_each(|(i, p)| add(i as u32, *p));
        for (place, p) in self.lattice.points() {
            at[self.of_lattice(place) as usize] = p;
            if !rim.inner[place] {
                add(self.of_lattice(place), p);
            }
        }
        for (i, p) in self.free.iter().enumerate() {
            at.push(*p);
            add(self.of_free(i), *p);
        }
        let n = self.boundary.points.len();
        let node = |number: u32| node_of[number as usize] as usize;
        let mut constraints: Vec<[usize; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
        constraints.extend(rim.sides.iter().map(|side| side.map(|p| node(self.of_lattice(p)))));
        let mut conflicts = 0;
        let count = nodes.len();
        let cdt = ConstrainedDelaunayTriangulation::<Node>::try_bulk_load_cdt(nodes, constraints, |_| conflicts += 1);
        let cdt = cdt.ok().filter(|cdt| conflicts == 0 && cdt.num_vertices() == count)?;
        let mut triangles = self.inside(&cdt)?;
        triangles.sort_unstable();
        Some(Filled { at, triangles })
    }

    /// The triangles between the outline and the cells: those that are reached from the outline's inner side without
    /// crossing a constraint.
    fn inside(&self, cdt: &ConstrainedDelaunayTriangulation<Node>) -> Option<Vec<[u32; 3]>> {
        let n = self.boundary.points.len();
        let mut handle: Vec<Option<FixedVertexHandle>> = vec![None; n];
        for vertex in cdt.vertices() {
            if let Some(place) = handle.get_mut(vertex.data().number as usize) {
                *place = Some(vertex.fix());
            }
        }
        let mut seen = vec![false; cdt.num_all_faces()];
        let mut open = Vec::new();
        for i in 0..n {
            let (a, b) = (handle[i]?, handle[(i + 1) % n]?);
            let (a, b) = if self.counter_clockwise { (a, b) } else { (b, a) };
            let edge = cdt.get_edge_from_neighbors(a, b)?;
            open.push(edge.face().as_inner()?.fix());
        }
        let mut triangles = Vec::new();
        while let Some(face) = open.pop() {
            if std::mem::replace(&mut seen[face.index()], true) {
                continue;
            }
            let face = cdt.face(face);
            let corners = face.vertices().map(|v| v.data().number);
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
            triangles.push([0, 1, 2].map(|k| corners[(least + k) % 3]));
            for edge in face.adjacent_edges() {
                if !edge.is_constraint_edge() {
                    open.push(edge.rev().face().as_inner()?.fix());
                }
            }
        }
        Some(triangles)
    }
}

/// The sides of whole cells that border on none, and the points that lie within cells alone.
struct Rim {
    sides: Vec<[usize; 2]>,
    /// Whether a point has whole cells all around `[places]`.
    inner: Vec<bool>,
}

impl Rim {
    fn of(lattice: &Lattice) -> Self {
        let mut around = vec![0u8; lattice.places()];
        let mut sides: Vec<[usize; 2]> = Vec::new();
        for cell in lattice.cells() {
            for k in 0..4 {
                let (a, b) = (cell[k], cell[(k + 1) % 4]);
                sides.push([a.min(b), a.max(b)]);
                around[cell[k]] += 1;
            }
        }
        sides.sort_unstable();
        let once = sides.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect();
        Self { sides: once, inner: around.into_iter().map(|n| n == 4).collect() }
    }
}
