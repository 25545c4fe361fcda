//! A scene of cloth and colliders, as a scene file has it.

use glam::Vec3;
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_base::mesh::vertex_normals;
use toile_engine::cloth::step::measure;
use toile_fitting::scene::Runner;
use toile_view::image::linear;
use toile_view::scene::{Colours, Material, PictureSurface};

use super::vertex_order::triangles;
use super::worn::{GarmentStats, WornGarment, no_body};
use crate::error::{Error, Result};
use crate::picture::{self, Look, Picture, View};

/// A scene file in motion.
#[derive(Debug)]
pub(super) struct ClothScene {
    runner: Runner,
    worn: Vec<WornGarment>,
    triangles: Vec<Vec<[u32; 3]>>,
}

impl ClothScene {
    pub fn new(file: SceneFile) -> Result<Self> {
        let triangles: Vec<Vec<[u32; 3]>> = file.garments.iter().map(|given| triangles(&given.mesh.faces)).collect();
        let described = |(given, triangles): (&toile_assets::scene_file::SceneGarment, &Vec<[u32; 3]>)| WornGarment {
            name: given.name.clone(),
            size: String::new(),
            fabric: given.fabric.name.clone(),
            vertices: given.mesh.start.len(),
            faces: triangles.len(),
            layers: 1,
            fit: None,
            notes: Vec::new(),
        };
        let worn = file.garments.iter().zip(&triangles).map(described).collect();
        Ok(Self { runner: Runner::new(file).map_err(Error::input)?, worn, triangles })
    }

    pub fn parse(name: &str, text: &str, source: SceneSource<'_>) -> Result<Self> {
        Self::new(SceneFile::parse(name, text, source).map_err(Error::input)?)
    }

    pub fn step(&mut self) {
        self.runner.step();
    }

    pub fn steps(&self) -> u64 {
        self.runner.steps()
    }

    pub fn wanted(&self) -> u64 {
        self.runner.scene().steps()
    }

    pub fn time_step(&self) -> f64 {
        self.runner.scene().step_hz.recip()
    }

    pub fn time(&self) -> f64 {
        self.runner.time()
    }

    pub fn worn(&self) -> &[WornGarment] {
        &self.worn
    }

    pub fn triangles(&self, garment: usize) -> &[[u32; 3]] {
        &self.triangles[garment]
    }

    pub fn positions(&self, garment: usize) -> impl Iterator<Item = Vec3> + '_ {
        self.runner.positions(garment)
    }

    pub fn pinned(&self, garment: usize) -> impl Iterator<Item = bool> + '_ {
        let given = &self.runner.scene().garments[garment];
        // What no face uses never moves.
        given.mesh.to_shape.iter().map(|vertex| given.shape.fixed.get(*vertex as usize).copied().unwrap_or(true))
    }

    pub fn stats(&self, garment: usize) -> GarmentStats {
        let mut cloth = self.runner.cloths()[garment].clone();
        let strain = measure::strain(&mut cloth, &self.runner.garments()[garment]);
        let mut stats = GarmentStats::default();
        stats.add(strain, self.runner.penetration(garment).0, &cloth);
        stats
    }

    pub fn pictures(&self, views: &[View], size: [u32; 2], look: Look) -> Result<Vec<Picture>> {
        let size = picture::checked_size(size)?;
        if look != Look::Fabric {
            return Err(no_body("fit map"));
        }
        let mut meshes = Vec::new();
        for (garment, triangles) in self.triangles.iter().enumerate() {
            let positions: Vec<Vec3> = self.positions(garment).collect();
            let mut normals = vec![Vec3::ZERO; positions.len()];
            vertex_normals(&positions, triangles, &mut normals);
            meshes.push((positions, normals));
        }
        let mut surfaces = Vec::new();
        for (((positions, normals), triangles), given) in
            meshes.iter().zip(&self.triangles).zip(&self.runner.scene().garments)
        {
            let colours = Colours::One(Vec3::from_array(given.fabric.colour.map(linear)));
            surfaces.push(PictureSurface {
                positions,
                normals,
                triangles,
                colours,
                material: Material::Cloth,
                look: None,
            });
        }
        Ok(picture::draw(&surfaces, self.runner.colliders().floor, 0.0, views, size))
    }

    pub fn state_hash(&self) -> u64 {
        self.runner.state_hash()
    }

    pub fn warnings(&self) -> Vec<String> {
        self.runner.warnings()
    }
}
