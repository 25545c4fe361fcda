//! The mesh of a surface: the neighbours of each triangle. Made at load.

use std::collections::HashMap;

use glam::Vec3A;
use toile_base::numeric::portable;

/// Instead of a triangle: there is none.
pub const NO_TRIANGLE: u32 = u32::MAX;

/// A share of a corner below this is none: a nearest point there lies on the opposite edge.
const ON_EDGE: f32 = 1e-5;

/// What a point of a triangle lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Inside the triangle.
    Face,
    /// On the edge opposite to this corner.
    Edge(usize),
    /// On this corner.
    Corner(usize),
}

/// A triangle as walking reads it: half a cache line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C, align(32))]
struct Linked {
    /// Its vertices, counter-clockwise seen from the front.
    corners: [u32; 3],
    /// The triangles across the edges opposite to these; [`NO_TRIANGLE`] at a border.
    across: [u32; 3],
}

/// Triangles with their neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    triangles: Box<[Linked]>,
    /// Where the fan of each vertex begins in `fan`, and the end of the last `[vertices + 1]`.
    fan_start: Box<[u32]>,
    /// Triangles at each vertex, one vertex after the other.
    fan: Box<[u32]>,
    /// Whether each vertex lies on a border `[vertices]`.
    border: Box<[bool]>,
}

impl SurfaceMesh {
    /// Links triangles over `vertices` vertices. Triangles that name a vertex twice or a missing one are left out of
    /// what can be near; where more than two share an edge, the first two are neighbours.
    pub fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let sound =
            |t: &[u32; 3]| t.iter().all(|&v| (v as usize) < vertices) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let corners: Vec<[u32; 3]> = triangles.iter().copied().filter(sound).collect();
        let mut linked: Vec<Linked> =
            corners.iter().map(|&corners| Linked { corners, across: [NO_TRIANGLE; 3] }).collect();
        let mut open: HashMap<(u32, u32), (u32, usize)> = HashMap::new();
        for (t, c) in corners.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (c[(k + 1) % 3], c[(k + 2) % 3]);
                let edge = (a.min(b), a.max(b));
                match open.remove(&edge) {
                    Some((other, side)) => {
                        linked[t].across[k] = other;
                        linked[other as usize].across[side] = t as u32;
                    }
                    None => {
                        open.insert(edge, (t as u32, k));
                    }
                }
            }
        }
        let mut border = vec![false; vertices];
        for &(a, b) in open.keys() {
            (border[a as usize], border[b as usize]) = (true, true);
        }
        let (fan_start, fan) = fans(&corners, vertices);
        Self { triangles: linked.into(), fan_start, fan, border: border.into() }
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Vertices of a triangle.
    #[inline(always)]
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize].corners
    }

    /// The triangles across the edges opposite to its corners.
    #[inline(always)]
    pub fn across(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize].across
    }

    /// Triangles at a vertex.
    pub fn fan(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.fan[self.fan_start[v] as usize..self.fan_start[v + 1] as usize]
    }

    /// Whether a vertex lies on a border.
    pub fn is_border(&self, vertex: u32) -> bool {
        self.border[vertex as usize]
    }

    /// The edges that only one triangle has, as this runs around.
    pub fn border_edges(&self) -> impl Iterator<Item = [u32; 2]> {
        let of = |t: &Linked| {
            let Linked { corners, across } = *t;
            (0..3).filter(move |k| across[*k] == NO_TRIANGLE).map(move |k| [corners[(k + 1) % 3], corners[(k + 2) % 3]])
        };
        self.triangles.iter().flat_map(of)
    }

    /// What the point of a triangle with these shares lies on.
    pub fn feature(shares: [f32; 3]) -> Feature {
        let none = shares.map(|s| s < ON_EDGE);
        match none {
            [false, true, true] => Feature::Corner(0),
            [true, false, true] => Feature::Corner(1),
            [true, true, false] => Feature::Corner(2),
            [true, _, _] => Feature::Edge(0),
            [_, true, _] => Feature::Edge(1),
            [_, _, true] => Feature::Edge(2),
            _ => Feature::Face,
        }
    }

    /// Whether such a point lies on the border of the surface.
    pub fn on_border(&self, triangle: u32, feature: Feature) -> bool {
        match feature {
            Feature::Face => false,
            Feature::Edge(k) => self.across(triangle)[k] == NO_TRIANGLE,
            Feature::Corner(k) => self.is_border(self.corners(triangle)[k]),
        }
    }

    /// The normal of the surface at a point of a triangle, of unit length, towards the front: the face's, the mean of two
    /// faces on an edge, of all around on a corner, weighted by their angles (Baerentzen, Aanaes 2005, "Signed distance
    /// computation using the angle weighted pseudonormal"), so that its sign tells front from back wherever the point is
    /// nearest. Zero where the faces have no area.
    pub fn normal(&self, triangle: u32, feature: Feature, at: impl Fn(u32) -> Vec3A) -> Vec3A {
        let face = |t: u32| {
            let [a, b, c] = self.corners(t).map(&at);
            portable::cross(b - a, c - a).normalize_or_zero()
        };
        match feature {
            Feature::Face => face(triangle),
            Feature::Edge(k) => {
                let other = self.across(triangle)[k];
                let across = if other == NO_TRIANGLE { Vec3A::ZERO } else { face(other) };
                (face(triangle) + across).normalize_or_zero()
            }
            Feature::Corner(k) => {
                let vertex = self.corners(triangle)[k];
                let angled = |&t: &u32| {
                    let corners = self.corners(t);
                    let turn = corners.iter().position(|c| *c == vertex).unwrap_or(0);
                    let [a, b, c] = [0, 1, 2].map(|j| at(corners[(turn + j) % 3]));
                    let (u, v) = ((b - a).normalize_or_zero(), (c - a).normalize_or_zero());
                    face(t) * angle(u.dot(v))
                };
                self.fan(vertex).iter().map(angled).sum::<Vec3A>().normalize_or_zero()
            }
        }
    }

    /// The normal at a vertex, of unit length, its faces weighted by their areas; zero where they have none.
    pub fn vertex_normal(&self, vertex: u32, at: impl Fn(u32) -> Vec3A) -> Vec3A {
        let face = |&t: &u32| {
            let [a, b, c] = self.corners(t).map(&at);
            portable::cross(b - a, c - a)
        };
        self.fan(vertex).iter().map(face).sum::<Vec3A>().normalize_or_zero()
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.triangles)
            + size_of_val(&*self.fan_start)
            + size_of_val(&*self.fan)
            + size_of_val(&*self.border)
    }
}

/// The angle of a cosine to 7 degrees (rad), from exactly rounded operations only: weights need no more.
fn angle(cosine: f32) -> f32 {
    let c = cosine.clamp(-1.0, 1.0);
    let of_positive = (1.0 - c.abs()).sqrt() * (std::f32::consts::FRAC_PI_2 - 0.2 * c.abs());
    if c < 0.0 { std::f32::consts::PI - of_positive } else { of_positive }
}

/// Triangles at each vertex, in their order.
fn fans(corners: &[[u32; 3]], vertices: usize) -> (Box<[u32]>, Box<[u32]>) {
    let mut start = vec![0u32; vertices + 1];
    corners.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
    for v in 0..vertices {
        start[v + 1] += start[v];
    }
    let mut next = start.clone();
    let mut fan = vec![0u32; 3 * corners.len()];
    for (t, c) in corners.iter().enumerate() {
        for &v in c {
            fan[next[v as usize] as usize] = t as u32;
            next[v as usize] += 1;
        }
    }
    (start.into(), fan.into())
}
