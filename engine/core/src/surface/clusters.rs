//! Clusters: sixteen vertices that lie together, and their boxes; by them a nearest vertex is looked for from anew.
//!
//! A walk ends where no neighbour is nearer, which across a fold or a gap is not the nearest of all. So each particle is
//! looked for from anew every so many steps.

use glam::Vec3;

use super::mesh::SurfaceMesh;
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, Store, V3};

/// Bits of a coordinate in a place along the curve that vertices are sorted by.
const CURVE_BITS: u32 = 10;

/// Vertices of a surface in groups of [`MOST`] that lie together where it starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    /// The vertices of each; the last is filled up with its own last vertex `[clusters]`.
    vertices: Box<[[u32; MOST]]>,
    /// How many of the last one's are its own.
    last: usize,
}

/// Boxes of the clusters of one surface in one step: lower and upper ends, one column an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct ClusterBoxes {
    ends: [Store; 6],
}

impl ClusterBoxes {
    /// Room for the boxes of some clusters. At load.
    pub fn new(clusters: &Clusters) -> Self {
        let len = clusters.vertices.len().next_multiple_of(MOST);
        let mut ends = [(); 6].map(|()| Store::zeros(len));
        // What no cluster fills is a box that nothing is in.
        ends[..3].iter_mut().for_each(|e| e.as_mut().fill(f32::INFINITY));
        ends[3..].iter_mut().for_each(|e| e.as_mut().fill(f32::NEG_INFINITY));
        Self { ends }
    }

    /// Lower, then upper ends (m), one column an axis; past the last cluster boxes that nothing is in.
    pub fn columns(&self) -> [ReadColumn<'_>; 6] {
        self.ends.each_ref().map(|e| ReadColumn::new(e.as_slice()))
    }

    /// Memory that they hold (bytes).
    pub fn bytes(&self) -> usize {
        self.ends.iter().map(Store::bytes).sum()
    }
}

impl Clusters {
    /// Groups the vertices of a mesh that have triangles by where they start (m).
    pub fn new(mesh: &SurfaceMesh, start: &[Vec3]) -> Self {
        let (mut low, mut high) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
        for p in start.iter().filter(|p| p.is_finite()) {
            (low, high) = (low.min(*p), high.max(*p));
        }
        let size = (high - low).max_element().max(1e-6);
        let place = |v: u32| {
            let p = (start[v as usize] - low) / size * ((1 << CURVE_BITS) - 1) as f32;
            (0..CURVE_BITS).fold(0u32, |key, bit| {
                let of = |x: f32, axis: u32| (x.max(0.0) as u32 >> bit & 1) << (3 * bit + axis);
                key | of(p.x, 0) | of(p.y, 1) | of(p.z, 2)
            })
        };
        let mut sorted: Vec<u32> = (0..start.len() as u32).filter(|v| !mesh.fan(*v).is_empty()).collect();
        sorted.sort_by_key(|v| (place(*v), *v));
        let full = |group: &[u32]| std::array::from_fn(|i| group[i.min(group.len() - 1)]);
        let last = (sorted.len() + MOST - 1) % MOST + 1;
        Self { vertices: sorted.chunks(MOST).map(full).collect(), last }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// The vertices of one.
    pub fn vertices(&self, cluster: usize) -> &[u32; MOST] {
        &self.vertices[cluster]
    }

    /// Which places of a cluster hold a vertex of its own, one bit each: in the last one they may be filled up.
    #[inline(always)]
    pub fn members(&self, cluster: usize) -> u32 {
        if cluster + 1 == self.len() { (1 << self.last) - 1 } else { (1 << MOST) - 1 }
    }

    /// Memory that they hold (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.vertices)
    }
}

/// The boxes of a range of clusters, where the vertices are now. Two workers may each fill half.
pub struct FillBoxes<'a> {
    /// The clusters.
    pub clusters: &'a Clusters,
    /// Where the vertices are (m).
    pub surface: [ReadColumn<'a>; 3],
    /// Their boxes.
    pub boxes: &'a mut ClusterBoxes,
}

impl Kernel for FillBoxes<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let [lx, ly, lz, hx, hy, hz] = self.boxes.ends.each_mut().map(Store::as_mut);
        for (c, vertices) in self.clusters.vertices.iter().enumerate() {
            let mut low = [f32::INFINITY; 3];
            let mut high = [f32::INFINITY; 3];
            let mut from = 0;
            while from < MOST {
                let p = V3::<L>::gather(self.surface, &vertices[from..from + L::N], L::N);
                low = [low[0].min(p.x.least()), low[1].min(p.y.least()), low[2].min(p.z.least())];
                high = [high[0].min((-p.x).least()), high[1].min((-p.y).least()), high[2].min((-p.z).least())];
                from += L::N;
            }
            (lx[c], ly[c], lz[c]) = (low[0], low[1], low[2]);
            (hx[c], hy[c], hz[c]) = (-high[0], -high[1], -high[2]);
        }
    }
}

/// The vertex of a surface that is nearest to a point, if any is nearer than a distance.
pub struct NearestVertex<'a> {
    /// The clusters.
    pub clusters: &'a Clusters,
    /// Their boxes in this step.
    pub boxes: &'a ClusterBoxes,
    /// Where the vertices are (m).
    pub surface: [ReadColumn<'a>; 3],
    /// The point (m).
    pub point: [f32; 3],
    /// Square of the distance (m2).
    pub within2: f32,
}

impl Kernel for NearestVertex<'_> {
    type Out = Option<u32>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Option<u32> {
        let [x, y, z] = self.point;
        let (x, y, z) = (L::splat(x), L::splat(y), L::splat(z));
        let point = V3 { x, y, z };
        let (mut best, mut found) = (self.within2, None);
        let ends = self.boxes.columns();
        let mut from = 0;
        while from < self.clusters.len() {
            let away = V3 {
                x: outside(L::load(ends[0], from), x, L::load(ends[3], from)),
                y: outside(L::load(ends[1], from), y, L::load(ends[4], from)),
                z: outside(L::load(ends[2], from), z, L::load(ends[5], from)),
            };
            let mut near = away.dot(away).lt(L::splat(best)).bits();
            while near != 0 {
                let c = from + near.trailing_zeros() as usize;
                near &= near - 1;
                if let Some((v, d2)) = self.within::<L>(c, point, best) {
                    (best, found) = (d2, Some(v));
                }
            }
            from += L::N;
        }
        found
    }
}

/// How far a number is out of a range.
#[inline(always)]
fn outside<L: Lanes>(low: L, p: L, high: L) -> L {
    (low - p).max(p - high).max(L::splat(0.0))
}

impl NearestVertex<'_> {
    /// The nearest vertex of a cluster, if it is nearer than `best` (m2); the first of several.
    #[inline(always)]
    fn within<L: Lanes>(&self, cluster: usize, point: V3<L>, best: f32) -> Option<(u32, f32)> {
        let vertices = self.clusters.vertices.get(cluster)?;
        let (mut best, mut found) = (best, None);
        let mut from = 0;
        while from < MOST {
            let away = V3::<L>::gather(self.surface, &vertices[from..from + L::N], L::N) - point;
            let d2 = away.dot(away);
            let nearer = d2.lt(L::splat(best)).bits();
            if nearer != 0 {
                best = d2.select(L::Mask::of(nearer), L::splat(f32::MAX)).least();
                let exact = !L::splat(best).lt(d2).bits() & nearer;
                found = Some((vertices[from + exact.trailing_zeros() as usize], best));
            }
            from += L::N;
        }
        found
    }
}
