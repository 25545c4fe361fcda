//! A scene with the bounding volume hierarchy of its triangles.

use glam::Vec3;

use crate::{
    bvh::Bvh,
    scene::{Bounds, PictureScene, PictureSurface},
};

/// A scene ready for ray tracing, from any number of cameras.
#[derive(Debug)]
pub struct TracedScene<'a> {
    pub(crate) scene: PictureScene<'a>,
    pub(crate) bvh: Bvh,
    /// First triangle of each surface in the bvh's numbering.
    pub(crate) starts: Vec<u32>,
    /// Whether anything can be seen through.
    pub(crate) sheer: bool,
}

impl<'a> TracedScene<'a> {
    /// Builds the bvh over every triangle of the scene that has three finite corners and an area.
    pub fn build(scene: PictureScene<'a>) -> Self {
        let mut starts = Vec::with_capacity(scene.surfaces.len());
        let mut next = 0;
        for surface in scene.surfaces {
            starts.push(next);
            next += surface.triangles.len() as u32;
        }
        let corner = |s: &PictureSurface<'_>, i: u32| s.positions.get(i as usize).copied().unwrap_or(Vec3::NAN);
        let faces = scene.surfaces.iter().flat_map(|s| s.triangles.iter().map(move |t| t.map(|i| corner(s, i))));
        let sheer = scene.surfaces.iter().any(|s| s.look.is_some_and(|look| look.opacity < 1.0));
        Self { scene, bvh: Bvh::build(faces), starts, sheer }
    }

    /// The surface that a triangle of the bvh belongs to.
    pub(crate) fn owner(&self, triangle: u32) -> usize {
        self.starts.partition_point(|&s| s <= triangle) - 1
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Bounds {
        self.bvh.bounds()
    }
}
