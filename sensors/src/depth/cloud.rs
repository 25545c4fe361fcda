//! The shopper as points of our world in the order of the image, so that a point's neighbours are its image's neighbours.

use glam::{Affine3A, Vec3, Vec3A};

use super::fill::Validity;
use crate::segment::same_surface;
use toile_base::frame::{DepthFrame, Intrinsics};

/// The shopper's cleaned surface as the camera sees it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// When it was seen (ns since the session began).
    pub time_ns: u64,
    /// The camera; its size is that of the arrays.
    pub intrinsics: Option<Intrinsics>,
    /// Camera to world (m).
    pub camera_to_world: Affine3A,
    /// Position of each pixel, world (m); meaningless where the state is unknown `[width * height]`.
    pub points: Vec<Vec3>,
    /// Which way its surface faces, world, unit length, towards the camera; zero where no neighbour shows it
    /// `[width * height]`.
    pub normals: Vec<Vec3>,
    /// State of each pixel `[width * height]`.
    pub validity: Vec<Validity>,
    /// Columns and rows within which all known pixels lie: first, and one beyond the last.
    pub columns: [u32; 2],
    /// Rows within which all known pixels lie: first, and one beyond the last.
    pub rows: [u32; 2],
}

impl Cloud {
    /// Known pixels, row by row: index into the arrays, point (m), normal (zero where unknown).
    pub fn known(&self) -> impl Iterator<Item = (usize, Vec3, Vec3)> + '_ {
        let width = self.intrinsics.map_or(0, |k| k.width as usize);
        let columns = self.columns[0] as usize..self.columns[1] as usize;
        let all = (self.rows[0] as usize..self.rows[1] as usize)
            .flat_map(move |v| columns.clone().map(move |u| v * width + u));
        let known = all.filter(|i| self.validity[*i] != Validity::Nothing);
        known.map(|i| (i, self.points[i], self.normals[i]))
    }

    /// Takes smoothed depth (mm, 0 = nothing) of a frame's camera.
    ///
    /// # Panics
    /// If depth or validity have another length than the image.
    pub fn update(&mut self, frame: &DepthFrame, depth_mm: &[f32], validity: &[Validity]) {
        let k = frame.intrinsics;
        assert!(depth_mm.len() == k.pixels() && validity.len() == k.pixels(), "arrays of the image's size");
        self.time_ns = frame.time_ns;
        self.intrinsics = Some(k);
        self.camera_to_world = frame.camera_to_world;
        self.points.resize(k.pixels(), Vec3::ZERO);
        self.normals.resize(k.pixels(), Vec3::ZERO);
        self.validity.clear();
        self.validity.extend_from_slice(validity);
        self.bound(k.width as usize);
        self.place(&k, depth_mm);
        self.face(&k, depth_mm);
    }

    /// Finds the columns and rows of what is known.
    fn bound(&mut self, width: usize) {
        let known = |v: &Validity| *v != Validity::Nothing;
        (self.columns, self.rows) = ([u32::MAX, 0], [u32::MAX, 0]);
        for (v, row) in (0u32..).zip(self.validity.chunks_exact(width)) {
            let Some(first) = row.iter().position(known) else { continue };
            let last = row.iter().rposition(known).unwrap_or(first);
            self.columns = [self.columns[0].min(first as u32), self.columns[1].max(last as u32 + 1)];
            self.rows = [self.rows[0].min(v), v + 1];
        }
        if self.rows[1] == 0 {
            (self.columns, self.rows) = ([0; 2], [0; 2]);
        }
    }

    fn place(&mut self, k: &Intrinsics, depth_mm: &[f32]) {
        let (axes, origin) = (self.camera_to_world.matrix3, self.camera_to_world.translation);
        let width = k.width as usize;
        for v in self.rows[0]..self.rows[1] {
            // A ray is the row's own part and a step for each column.
            let row = axes * Vec3A::new(-k.cx / k.fx, (v as f32 - k.cy) / k.fy, 1.0);
            let step = axes.x_axis / k.fx;
            for u in self.columns[0]..self.columns[1] {
                let at = v as usize * width + u as usize;
                let ray = row + step * u as f32;
                self.points[at] = (ray * (depth_mm[at] * 1e-3) + origin).into();
            }
        }
    }

    /// Normals by central differences; one-sided beside an edge.
    fn face(&mut self, k: &Intrinsics, depth_mm: &[f32]) {
        let (width, height) = (k.width as usize, k.height as usize);
        let eye = Vec3::from(self.camera_to_world.translation);
        for v in self.rows[0] as usize..self.rows[1] as usize {
            for u in self.columns[0] as usize..self.columns[1] as usize {
                let at = v * width + u;
                if self.validity[at] == Validity::Nothing {
                    continue;
                }
                let z = depth_mm[at];
                let limit = same_surface(z * 1e-3) * 1e3;
                let same = |i: usize| if (depth_mm[i] - z).abs() < limit { i } else { at };
                let left = if u > 0 { same(at - 1) } else { at };
                let right = if u + 1 < width { same(at + 1) } else { at };
                let above = if v > 0 { same(at - width) } else { at };
                let below = if v + 1 < height { same(at + width) } else { at };
                let point = |i: usize| self.points[i];
                let normal = (point(below) - point(above)).cross(point(right) - point(left)).normalize_or_zero();
                let towards = normal.dot(eye - point(at));
                self.normals[at] = if towards < 0.0 { -normal } else { normal };
            }
        }
    }
}
