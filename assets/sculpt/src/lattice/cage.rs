//! The cage while it grows: vertices, quads, and what each belongs to.

use std::collections::BTreeMap;

use glam::Vec3;
use toile_base::body::Region;

use super::chart::Chart;

/// Columns of half a trunk ring, both middles included.
pub(crate) const HALF: usize = 13;
/// Columns of an arm's and a leg's ring.
pub(crate) const ARM: usize = 12;
pub(crate) const LEG: usize = 16;
/// The armhole's first column and its width; its first row is so many below the trunk's last.
pub(crate) const HOLE: usize = 5;
pub(crate) const HOLE_ROWS: usize = 3;
/// Rows of the trunk above the armhole's upper edge, the base of the neck included.
pub(crate) const ABOVE_HOLE: usize = 3;

/// The part that a vertex of the cage belongs to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tag {
    pub region: Region,
    /// How far the vertex may slide along the surface while the mesh is evened out, 0 to 1.
    pub slide: f32,
}

/// The cage with its starting points (mm).
#[derive(Debug, Default)]
pub(crate) struct Lattice {
    pub points: Vec<Vec3>,
    pub tags: Vec<Tag>,
    pub faces: Vec<[u32; 4]>,
    pub charts: Vec<Chart>,
    /// Each vertex's mirror image; its own in the middle.
    pub mirrors: Vec<u32>,
}

impl Lattice {
    pub(crate) fn push(&mut self, point: Vec3, region: Region, slide: f32) -> u32 {
        self.points.push(point);
        self.tags.push(Tag { region, slide });
        self.points.len() as u32 - 1
    }

    pub(crate) fn quad(&mut self, corners: [u32; 4], chart: Chart) {
        self.faces.push(corners);
        self.charts.push(chart);
    }

    /// A band between two closed rings; the chart of each column's quad is asked for.
    pub(crate) fn band(&mut self, from: &[u32], to: &[u32], chart: impl Fn(usize) -> Chart) {
        for k in 0..from.len() {
            let n = (k + 1) % from.len();
            self.quad([from[k], from[n], to[n], to[k]], chart(k));
        }
    }

    /// Turns faces so that neighbours run against each other along their common edge, and all look outwards.
    pub(crate) fn orient(&mut self) {
        let mut sides: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for (f, q) in self.faces.iter().enumerate() {
            for k in 0..4 {
                let (a, b) = (q[k], q[(k + 1) % 4]);
                sides.entry((a.min(b), a.max(b))).or_default().push(f);
            }
        }
        // The first face lies in front of the groin: it must look forwards.
        let normal = |q: &[u32; 4], points: &[Vec3]| {
            let p = q.map(|v| points[v as usize]);
            (p[2] - p[0]).cross(p[3] - p[1])
        };
        let mut done = vec![false; self.faces.len()];
        let mut queue = vec![0usize];
        done[0] = true;
        if normal(&self.faces[0], &self.points).z < 0.0 {
            self.faces[0] = flipped(self.faces[0]);
        }
        while let Some(f) = queue.pop() {
            let q = self.faces[f];
            for k in 0..4 {
                let (a, b) = (q[k], q[(k + 1) % 4]);
                for &other in &sides[&(a.min(b), a.max(b))] {
                    if done[other] {
                        continue;
                    }
                    let o = self.faces[other];
                    if (0..4).any(|j| (o[j], o[(j + 1) % 4]) == (a, b)) {
                        self.faces[other] = flipped(o);
                    }
                    done[other] = true;
                    queue.push(other);
                }
            }
        }
        assert!(done.iter().all(|&d| d), "the half cage is one piece");
    }

    /// The left half with its mirror image.
    pub(crate) fn mirrored(mut self) -> Self {
        let left = self.points.len();
        let middle = |p: Vec3| p.x.abs() < 1e-6;
        let mut mirrors: Vec<u32> = (0..left as u32).collect();
        for v in 0..left {
            if middle(self.points[v]) {
                self.points[v].x = 0.0;
                continue;
            }
            let p = self.points[v];
            mirrors[v] = self.points.len() as u32;
            self.points.push(Vec3::new(-p.x, p.y, p.z));
            let region = match self.tags[v].region {
                Region::LeftArm => Region::RightArm,
                Region::LeftLeg => Region::RightLeg,
                both => both,
            };
            self.tags.push(Tag { region, ..self.tags[v] });
            mirrors.push(v as u32);
        }
        for f in 0..self.faces.len() {
            let q = flipped(self.faces[f]).map(|v| mirrors[v as usize]);
            self.faces.push(q);
            let chart = self.charts[f].mirror();
            self.charts.push(chart);
        }
        Self { mirrors, ..self }
    }
}

/// A quad run the other way, from the same first corner: its mirror image splits along the same diagonal.
fn flipped([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    [a, d, c, b]
}

/// Where a ray from inside leaves a form (mm): marched in steps, then bisected.
pub(crate) fn cast(from: Vec3, way: Vec3, distance: impl Fn(Vec3) -> f32) -> Vec3 {
    const STEP: f32 = 2.0;
    let mut far = STEP;
    while far < 400.0 && distance(from + way * far) < 0.0 {
        far += STEP;
    }
    let mut near = far - STEP;
    for _ in 0..12 {
        let middle = 0.5 * (near + far);
        if distance(from + way * middle) < 0.0 { near = middle } else { far = middle }
    }
    from + way * near
}
