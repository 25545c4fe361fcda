//! Distances that the particles of one garment keep from each other: found at load from its start.

use glam::Vec3;
use toile_base::garment::Garment;

use crate::lanes::{MOST, ReadColumn, Store};
use crate::surface::{Clusters, SurfaceMesh};

/// Particles nearer than so many thicknesses where the garment starts are sewn or lie on each other by its cut.
const SEWN: f32 = 1.0;

/// Share of the distance at which they start (1) that particles keep at least, where that is less than what their edges ask for:
/// neighbours over two edges then fold by 120 degrees at most.
const KEPT_SHARE: f32 = 0.5;

/// Two vertices farther apart than so much of the longest edge cannot be of triangles that cross (1): Wu et al. 2020, "A safe
/// and fast repulsion method for GPU-based cloth self collisions", theorem 1.
const OF_EDGE: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// How much farther apart particles keep (1), for edges that are stretched and for what a solve leaves.
const MARGIN: f32 = 1.2;

/// Clusters nearer to each other where the garment starts than so many times what their particles keep apart (1) are near: what
/// lies between them is between them wherever they lie, as long as it is flat.
const NEAR: f32 = 2.0;

/// For each vertex of a cluster a bit for each of another one that it is joined with.
pub type Joined = [u16; MOST];

/// A cluster that lies near to another one where the garment starts.
#[derive(Debug, Clone, Copy)]
pub struct NearCluster {
    /// Which.
    pub other: u32,
    /// Index in the list of joined particles.
    joined: u32,
}

/// How far the particles of a garment keep from each other.
#[derive(Debug, Clone)]
pub struct FoldSurface {
    /// Where each particle's neighbours begin, and the end of the last `[particles + 1]`.
    start: Box<[u32]>,
    /// Those over one edge and the particle itself, each list in order.
    neighbours: Box<[u32]>,
    /// Where the particles start (m), one axis after the other.
    rest: [Store; 3],
    /// Square of the distance under which particles lie on each other where the garment starts (m2).
    sewn2: f32,
    /// Half of what each particle keeps from others (m) `[particles]`.
    radius: Box<[f32]>,
    /// The same, cluster by cluster (m) `[clusters][MOST]`.
    radii: Store,
    /// The largest of each cluster (m) `[clusters]`.
    largest: Store,
    /// Where each cluster's near ones begin in `near`, and the end of the last `[clusters + 1]`.
    near_start: Box<[u32]>,
    near: Box<[NearCluster]>,
    /// Particles of near clusters that are joined with each other; the first entry joins none.
    joined: Box<[Joined]>,
}

impl FoldSurface {
    /// Of a garment, its triangles and their clusters, and the thickness of its cloth (m).
    pub fn new(garment: &Garment, mesh: &SurfaceMesh, clusters: &Clusters, thickness: f32) -> Self {
        let (start, neighbours) = neighbours(mesh, garment.start.len());
        let mut rest = [(); 3].map(|()| Store::zeros(garment.start.len()));
        for (axis, store) in rest.iter_mut().enumerate() {
            store.as_mut().iter_mut().zip(&garment.start).for_each(|(to, p)| *to = p[axis]);
        }
        let radius = radii(mesh, &garment.start, thickness);
        let mut largest = Store::zeros(clusters.len().next_multiple_of(MOST));
        let mut by_cluster = Store::zeros(clusters.len() * MOST);
        for c in 0..clusters.len() {
            let of = clusters.vertices(c).map(|v| radius[v as usize]);
            by_cluster.as_mut()[c * MOST..(c + 1) * MOST].copy_from_slice(&of);
            largest.as_mut()[c] = of.into_iter().fold(0.0, f32::max);
        }
        let sewn2 = (SEWN * thickness).powi(2);
        let (near_start, near, joined) = Default::default();
        let radii = by_cluster;
        let mut all = Self { start, neighbours, rest, sewn2, radius, radii, largest, near_start, near, joined };
        all.take_near(clusters, &garment.start);
        all
    }

    /// How far two particles keep apart (m).
    #[inline(always)]
    pub fn gap(&self, i: u32, j: u32) -> f32 {
        let edges = self.radius[i as usize] + self.radius[j as usize];
        edges.min(KEPT_SHARE * self.start_distance(i, j))
    }

    /// How far apart two particles start (m).
    #[inline(always)]
    pub fn start_distance(&self, i: u32, j: u32) -> f32 {
        self.at(i).distance(self.at(j))
    }

    /// Whether two particles lie so near to each other where the garment starts that only their own fold can bring them together.
    #[inline(always)]
    pub fn is_local(&self, i: u32, j: u32) -> bool {
        self.gap(i, j) < self.radius[i as usize] + self.radius[j as usize]
    }

    /// Half of what each particle keeps from others (m), cluster by cluster `[clusters][MOST]`.
    pub fn radii(&self) -> ReadColumn<'_> {
        ReadColumn::new(self.radii.as_slice())
    }

    /// The largest of each cluster (m) `[clusters]`.
    pub fn largest(&self) -> ReadColumn<'_> {
        ReadColumn::new(self.largest.as_slice())
    }

    /// The clusters near to one, in their order.
    #[inline(always)]
    pub fn near(&self, cluster: usize) -> &[NearCluster] {
        &self.near[self.near_start[cluster] as usize..self.near_start[cluster + 1] as usize]
    }

    /// Particles of a cluster that are joined with those of a near one; no pair if `near` is `None`.
    #[inline(always)]
    pub fn joined(&self, near: Option<&NearCluster>) -> &Joined {
        &self.joined[near.map_or(0, |n| n.joined as usize)]
    }

    /// Whether two particles share an edge, are sewn together, or are the same.
    fn are_joined(&self, i: u32, j: u32) -> bool {
        let range = self.start[i as usize] as usize..self.start[i as usize + 1] as usize;
        self.neighbours[range].contains(&j) || self.at(i).distance_squared(self.at(j)) < self.sewn2
    }

    /// Finds the clusters that are near to each other, and their joined particles.
    fn take_near(&mut self, clusters: &Clusters, at: &[Vec3]) {
        let mut cluster_of = vec![0; self.start.len() - 1];
        for c in 0..clusters.len() {
            clusters.vertices(c).iter().for_each(|v| cluster_of[*v as usize] = c);
        }
        let boxes: Vec<[Vec3; 2]> = (0..clusters.len()).map(|c| bounds(clusters.vertices(c), at)).collect();
        let largest = self.largest.as_slice();
        let are_near = |a: usize, b: usize| {
            let apart = (boxes[a][0] - boxes[b][1]).max(boxes[b][0] - boxes[a][1]).max(Vec3::ZERO);
            apart.length() < NEAR * (largest[a] + largest[b])
        };
        let (mut start, mut near, mut joined) = (vec![0], Vec::new(), vec![[0; MOST]]);
        for c in 0..clusters.len() {
            let own = clusters.vertices(c);
            let mut others: Vec<usize> = (0..clusters.len()).filter(|&b| are_near(c, b)).collect();
            for &i in own {
                let around = self.start[i as usize] as usize..self.start[i as usize + 1] as usize;
                others.extend(self.neighbours[around].iter().map(|j| cluster_of[*j as usize]));
            }
            others.sort_unstable();
            others.dedup();
            for other in others {
                let there = clusters.vertices(other);
                let bits = own.map(|i| {
                    let bit = |k: usize| u16::from(self.are_joined(i, there[k])) << k;
                    (0..MOST).map(bit).fold(0, |all, bit| all | bit)
                });
                let any = bits.iter().any(|b| *b != 0);
                near.push(NearCluster { other: other as u32, joined: if any { joined.len() as u32 } else { 0 } });
                joined.extend(any.then_some(bits));
            }
            start.push(near.len() as u32);
        }
        (self.near_start, self.near, self.joined) = (start.into(), near.into(), joined.into());
    }

    fn at(&self, i: u32) -> Vec3 {
        Vec3::from_array(self.rest.each_ref().map(|c| ReadColumn::new(c.as_slice()).get(i as usize)))
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.start)
            + size_of_val(&*self.neighbours)
            + size_of_val(&*self.radius)
            + self.radii.bytes()
            + self.largest.bytes()
            + size_of_val(&*self.near_start)
            + size_of_val(&*self.near)
            + size_of_val(&*self.joined)
            + self.rest.iter().map(Store::bytes).sum::<usize>()
    }
}

/// Lower and upper end of where some vertices are (m).
fn bounds(vertices: &[u32], at: &[Vec3]) -> [Vec3; 2] {
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    vertices.iter().map(|&v| at[v as usize]).fold(none, |[low, high], p| [low.min(p), high.max(p)])
}

/// Each particle and its neighbours over an edge.
fn neighbours(mesh: &SurfaceMesh, particles: usize) -> (Box<[u32]>, Box<[u32]>) {
    let (mut start, mut all) = (vec![0u32], Vec::new());
    for i in 0..particles as u32 {
        let mut near = vec![i];
        near.extend(mesh.fan(i).iter().flat_map(|&t| mesh.corners(t)));
        near.sort_unstable();
        near.dedup();
        all.extend(near);
        start.push(all.len() as u32);
    }
    (start.into(), all.into())
}

/// Half of what each particle keeps from others (m): what the mean of the longest edges of its triangles asks for, and not less
/// than half of the cloth's thickness.
fn radii(mesh: &SurfaceMesh, at: &[Vec3], thickness: f32) -> Box<[f32]> {
    let longest = |t: u32| {
        let [a, b, c] = mesh.corners(t).map(|v| at[v as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    };
    let of = |v: u32| {
        let fan = mesh.fan(v);
        let mean = fan.iter().map(|&t| longest(t)).sum::<f32>() / fan.len().max(1) as f32;
        0.5 * (OF_EDGE * MARGIN * mean).max(thickness)
    };
    (0..at.len() as u32).map(of).collect()
}
