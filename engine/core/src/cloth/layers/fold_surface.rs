//! What of a garment's own surface is not a fold: who is whose neighbour. At load.

use glam::Vec3;
use toile_assets::garment::Garment;

use crate::lanes::{MOST, ReadColumn, Store};
use crate::surface::{Clusters, SurfaceMesh};

/// Neighbours over so many edges are the same piece of cloth.
const RINGS: usize = 2;

/// Particles nearer than so many thicknesses where the garment starts are sewn or lie on each other by its cut.
const SEWN: f32 = 1.0;

/// Clusters whose boxes are nearer than so many of the longest edges where the garment starts go on into each other.
const NEXT: f32 = 1.5;

/// Share of the triangles whose longest edge is not longer than the one that is reckoned with: single slivers would make all
/// else look too far.
const USUAL_SHARE: f32 = 0.98;

/// Who of another cluster is of one piece with whom of one.
#[derive(Debug, Clone, Copy)]
pub struct NearCluster {
    /// The other cluster.
    pub other: u32,
    /// For each vertex of the one a bit for each of the other `[MOST]`.
    pub bits: [u16; MOST],
}

/// Who is whose neighbour in a garment.
#[derive(Debug, Clone)]
pub struct FoldSurface {
    /// Where each particle's neighbours begin, and the end of the last `[particles + 1]`.
    start: Box<[u32]>,
    /// Those over [`RINGS`] edges and the particle itself, each list in order.
    ring: Box<[u32]>,
    /// Where the particles start (m), one axis after the other.
    rest: [Store; 3],
    /// Square of the distance under which particles lie on each other where the garment starts (m2).
    sewn2: f32,
    /// How far a point of a face is from the nearest of its corners at most (m).
    pub cover: f32,
    /// Where each cluster's neighbours begin in `near`, and the end of the last `[clusters + 1]`.
    near_start: Box<[u32]>,
    near: Box<[NearCluster]>,
    /// For each cluster a bit for each other that it goes on into, [`MOST`] a word `[clusters][words]`.
    next: Box<[u16]>,
    words: usize,
}

impl FoldSurface {
    /// Of a garment, its triangles and their clusters, and the thickness of its cloth (m).
    pub fn new(garment: &Garment, mesh: &SurfaceMesh, clusters: &Clusters, thickness: f32) -> Self {
        let (start, ring) = rings(mesh, garment.start.len());
        let longest = usual_edge(mesh, &garment.start);
        let (next, words) = next(clusters, &garment.start, (NEXT * longest).max(SEWN * thickness));
        let mut rest = [(); 3].map(|()| Store::zeros(garment.start.len()));
        for (axis, store) in rest.iter_mut().enumerate() {
            store.as_mut().iter_mut().zip(&garment.start).for_each(|(to, p)| *to = p[axis]);
        }
        // Of triangles with sides up to this the equilateral one has its middle farthest from all corners.
        let cover = longest / 3.0f32.sqrt();
        let sewn2 = (SEWN * thickness).powi(2);
        let none = Box::default();
        let mut all = Self { start, ring, rest, sewn2, cover, near_start: none, near: Box::default(), next, words };
        (all.near_start, all.near) = all.near_clusters(clusters);
        all
    }

    /// Whether two particles are of one piece, neighbours or sewn together.
    #[inline(always)]
    pub fn one_piece(&self, i: u32, j: u32) -> bool {
        let range = self.start[i as usize] as usize..self.start[i as usize + 1] as usize;
        if self.ring[range].contains(&j) {
            return true;
        }
        let away = self.at(i) - self.at(j);
        away.length_squared() < self.sewn2
    }

    /// Who of other clusters is of one piece with whom of one, in the order of the others.
    #[inline(always)]
    pub fn near(&self, cluster: usize) -> &[NearCluster] {
        &self.near[self.near_start[cluster] as usize..self.near_start[cluster + 1] as usize]
    }

    /// Finds those of all clusters.
    fn near_clusters(&self, clusters: &Clusters) -> (Box<[u32]>, Box<[NearCluster]>) {
        let mut cluster_of = vec![0; self.start.len() - 1];
        for c in 0..clusters.len() {
            clusters.vertices(c).iter().for_each(|v| cluster_of[*v as usize] = c);
        }
        let (mut start, mut near) = (vec![0], Vec::new());
        for c in 0..clusters.len() {
            let own = clusters.vertices(c);
            let mut others: Vec<usize> =
                (0..clusters.len()).filter(|b| self.next(c, b / MOST * MOST) >> (b % MOST) & 1 != 0).collect();
            for &i in own {
                let ring = self.start[i as usize] as usize..self.start[i as usize + 1] as usize;
                others.extend(self.ring[ring].iter().map(|j| cluster_of[*j as usize]));
            }
            others.sort_unstable();
            others.dedup();
            for other in others {
                let there = clusters.vertices(other);
                let bits = own.map(|i| {
                    let bit = |k: usize| u16::from(self.one_piece(i, there[k])) << k;
                    (0..MOST).map(bit).fold(0, |all, bit| all | bit)
                });
                if bits.iter().any(|b| *b != 0) {
                    near.push(NearCluster { other: other as u32, bits });
                }
            }
            start.push(near.len() as u32);
        }
        (start.into(), near.into())
    }

    /// The clusters from `from` on, a multiple of [`MOST`], that one goes on into: a bit each.
    #[inline(always)]
    pub fn next(&self, cluster: usize, from: usize) -> u16 {
        self.next[cluster * self.words + from / MOST]
    }

    fn at(&self, i: u32) -> Vec3 {
        Vec3::from_array(self.rest.each_ref().map(|c| ReadColumn::new(c.as_slice()).get(i as usize)))
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.start)
            + size_of_val(&*self.ring)
            + size_of_val(&*self.next)
            + size_of_val(&*self.near_start)
            + size_of_val(&*self.near)
            + self.rest.iter().map(Store::bytes).sum::<usize>()
    }
}

/// Neighbours of each particle.
fn rings(mesh: &SurfaceMesh, particles: usize) -> (Box<[u32]>, Box<[u32]>) {
    let (mut start, mut ring) = (vec![0u32], Vec::new());
    for i in 0..particles as u32 {
        let mut near = vec![i];
        for _ in 0..RINGS {
            let around = near.iter().flat_map(|&v| mesh.fan(v)).flat_map(|&t| mesh.corners(t));
            near = near.iter().copied().chain(around).collect();
            near.sort_unstable();
            near.dedup();
        }
        ring.extend(near);
        start.push(ring.len() as u32);
    }
    (start.into(), ring.into())
}

/// The length (m) that all edges of most triangles do not exceed.
fn usual_edge(mesh: &SurfaceMesh, at: &[Vec3]) -> f32 {
    let longest = |t: u32| {
        let [a, b, c] = mesh.corners(t).map(|v| at[v as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    };
    let mut edges: Vec<f32> = (0..mesh.len() as u32).map(longest).collect();
    edges.sort_by(f32::total_cmp);
    edges.get((edges.len() as f32 * USUAL_SHARE) as usize).copied().unwrap_or(0.0)
}

/// Which clusters go on into which.
fn next(clusters: &Clusters, at: &[Vec3], within: f32) -> (Box<[u16]>, usize) {
    let boxes: Vec<[Vec3; 2]> = (0..clusters.len())
        .map(|c| {
            let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            let all = clusters.vertices(c).iter().map(|&v| at[v as usize]);
            all.fold(none, |[low, high], p| [low.min(p), high.max(p)])
        })
        .collect();
    let words = clusters.len().div_ceil(MOST);
    let mut bits = vec![0u16; clusters.len() * words];
    for (a, [low, high]) in boxes.iter().enumerate() {
        for (b, [other_low, other_high]) in boxes.iter().enumerate() {
            let apart = (*low - *other_high).max(*other_low - *high).max(Vec3::ZERO);
            if apart.length_squared() < within * within {
                bits[a * words + b / MOST] |= 1 << (b % MOST);
            }
        }
    }
    (bits.into(), words)
}
