//! Which clusters of a garment lie flat: there no particle comes near to another that is not its neighbour.
//!
//! A region whose normals have one half-space in common does not meet itself (Volino and Magnenat-Thalmann 1994, "Efficient
//! self-collision detection on smoothly discretized surface animations using geometrical shape regularity").

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, MOST, Mask, V3, Width, reciprocal_root};
use crate::surface::{Clusters, SurfaceMesh};

/// Every so many times each cluster is looked at: 33 ms, in which a flat one is not folded.
const LOOKED_TIMES: usize = 4;

/// Cosine between the normals of a cluster's triangles and its first one's from which on it is flat: 45 degrees.
const FLAT: f32 = 0.7;

/// Cosine between the first normals of two flat clusters from which on they look the same way: 53 degrees.
const ALIKE: f32 = 0.6;

/// Which clusters lie flat, and which way they look.
#[derive(Debug, Clone)]
pub struct Flatness {
    /// Where each cluster's triangles begin, a multiple of [`MOST`], and the end of the last `[clusters + 1]`.
    start: Box<[u32]>,
    /// Corners of the triangles around the vertices of each cluster, the first filling up the last vector.
    corners: [Box<[u32]>; 3],
    /// Normal of the first triangle of each cluster `[clusters]`.
    front: Box<[[f32; 3]]>,
    /// Whether each lies flat `[clusters]`.
    flat: Box<[bool]>,
    /// Times that was looked.
    times: u64,
}

impl Flatness {
    /// Room for the clusters of a mesh; none of them is taken to be flat yet. At load.
    pub fn new(clusters: &Clusters, mesh: &SurfaceMesh) -> Self {
        let (mut start, mut corners) = (vec![0], [Vec::new(), Vec::new(), Vec::new()]);
        for c in 0..clusters.len() {
            let mut around: Vec<u32> = clusters.vertices(c).iter().flat_map(|&v| mesh.fan(v)).copied().collect();
            around.sort_unstable();
            around.dedup();
            let first = around[0];
            around.resize(around.len().next_multiple_of(MOST), first);
            around.iter().map(|&t| mesh.corners(t)).for_each(|t| (0..3).for_each(|k| corners[k].push(t[k])));
            start.push(corners[0].len() as u32);
        }
        Self {
            start: start.into(),
            corners: corners.map(Vec::into),
            front: vec![[0.0; 3]; clusters.len()].into(),
            flat: vec![false; clusters.len()].into(),
            times: 0,
        }
    }

    /// Looks at a part of the clusters; at first at all.
    pub fn look(&mut self, columns: ParticleColumns<'_>, width: Width) {
        width.run(LookAtClusters { columns, to: self });
        self.times += 1;
    }

    /// Whether two clusters lie flat and look the same way.
    #[inline(always)]
    pub fn are_flat(&self, a: usize, b: usize) -> bool {
        let ([ax, ay, az], [bx, by, bz]) = (self.front[a], self.front[b]);
        self.flat[a] && self.flat[b] && ax * bx + ay * by + az * bz > ALIKE
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        let corners = self.corners.iter().map(|c| size_of_val(&**c)).sum::<usize>();
        size_of_val(&*self.start) + corners + size_of_val(&*self.front) + size_of_val(&*self.flat)
    }
}

struct LookAtClusters<'a> {
    columns: ParticleColumns<'a>,
    to: &'a mut Flatness,
}

impl Kernel for LookAtClusters<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { columns, to } = self;
        let all = to.times == 0;
        let mut c = if all { 0 } else { (to.times % LOOKED_TIMES as u64) as usize };
        while c < to.flat.len() {
            let (begin, end) = (to.start[c] as usize, to.start[c + 1] as usize);
            let mut front = [0.0; 3];
            let mut flat = true;
            let mut from = begin;
            while from < end && flat {
                let normals = to.normals::<L>(columns, from);
                if from == begin {
                    front = [normals.x.to_array()[0], normals.y.to_array()[0], normals.z.to_array()[0]];
                }
                let [x, y, z] = front;
                let along = normals.x * L::splat(x) + normals.y * L::splat(y) + normals.z * L::splat(z);
                // Not so where it is not a number.
                flat = L::splat(FLAT).lt(along).bits() == ((1u64 << L::N) - 1) as u32;
                from += L::N;
            }
            (to.front[c], to.flat[c]) = (front, flat);
            c += if all { 1 } else { LOOKED_TIMES };
        }
    }
}

impl Flatness {
    /// Unit normals of some triangles.
    #[inline(always)]
    fn normals<L: Lanes>(&self, columns: ParticleColumns<'_>, from: usize) -> V3<L> {
        let [a, b, c] = &self.corners;
        let a = V3::<L>::gather(columns.x, &a[from..from + L::N], L::N);
        let b = V3::<L>::gather(columns.x, &b[from..from + L::N], L::N);
        let c = V3::<L>::gather(columns.x, &c[from..from + L::N], L::N);
        let normal = (b - a).cross(c - a);
        normal * reciprocal_root(normal.dot(normal))
    }
}
