//! One piece of cloth that hangs over something, stepped and drawn.

use glam::{Affine3A, DVec2, DVec3, Vec3};
use thiserror::Error;
use toile_assets::fabric::FabricError;
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::check::MeshError;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Part};
use toile_base::mesh::{SkinWeights, vertex_normals};
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Quality, Settings, Step};
use toile_engine::colliders::{ColliderError, Colliders};
use toile_view::image::{Image, Size, linear};
use toile_view::scene::{Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{self, TraceQuality};

/// Why a drape cannot be run.
#[derive(Debug, Error)]
pub enum DrapeError {
    /// No such fabric, or one that cannot be used.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// A mesh that cannot be baked.
    #[error("the specimen cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// Colliders that the engine does not take.
    #[error("the table is refused: {0}")]
    Colliders(#[from] ColliderError),
}

/// A piece of cloth, cut level: its points are (x, z), some of them held where they are.
pub struct SpecimenPiece {
    /// Where each point is as cut (m).
    pub points: Vec<DVec2>,
    /// Whether it is held.
    pub held: Vec<bool>,
    /// Its faces.
    pub faces: Vec<[u32; 4]>,
}

/// The cloth on its way.
pub struct DrapedCloth {
    /// As it was baked.
    pub garment: Garment,
    cloth: Cloth,
    settings: Settings,
    colliders: Colliders,
    bones: [Affine3A; BONES],
    /// Steps so far.
    ticks: u64,
    times_ns: Vec<u64>,
}

impl DrapedCloth {
    /// Level and at rest, the warp along z.
    pub fn new(
        piece: &SpecimenPiece,
        fabric: &Fabric,
        mut colliders: Colliders,
        quality: Quality,
    ) -> Result<Self, DrapeError> {
        let mut shape = Shape { faces: piece.faces.clone(), ..Shape::default() };
        for (p, held) in piece.points.iter().zip(&piece.held) {
            let (x, z) = (p.x as f32, p.y as f32);
            shape.push(Vec3::new(x, -z, 0.0), Vec3::new(x, 0.0, z), *held, Part::All);
            shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
        }
        let garment = bake("drape", "one", &shape, fabric)?;
        let stay = colliders.end().to_vec();
        colliders.place_spheres(&stay);
        Ok(Self {
            cloth: Cloth::new(&garment, &colliders),
            garment,
            settings: Settings { quality, workers: 1, ..Settings::default() },
            colliders,
            bones: [Affine3A::IDENTITY; BONES],
            ticks: 0,
            times_ns: Vec::new(),
        })
    }

    /// Steps until a time from its start (s).
    pub fn run_to(&mut self, seconds: f64) {
        let until = (seconds / f64::from(self.settings.step_seconds)).round() as u64;
        while self.ticks < until {
            let stay = self.colliders.end().to_vec();
            self.colliders.place_spheres(&stay);
            let begun = std::time::Instant::now();
            let step = Step { palette: &self.bones, colliders: &self.colliders, settings: &self.settings };
            self.cloth.step(&self.garment, &step);
            self.times_ns.push(begun.elapsed().as_nanos() as u64);
            self.ticks += 1;
        }
    }

    /// Where each point of the piece is (m).
    pub fn places(&self) -> Vec<DVec3> {
        let mut at = vec![DVec3::ZERO; self.garment.source.len()];
        for (particle, &point) in self.garment.source.iter().enumerate() {
            at[point as usize] = self.cloth.positions[particle].as_dvec3();
        }
        at
    }

    /// Speed of the fastest particle (m/s).
    pub fn fastest(&self) -> f64 {
        let speed = |i: usize| self.cloth.velocity(i).length();
        f64::from((0..self.garment.particles()).map(speed).fold(0.0, f32::max))
    }

    /// Median time of a step (us).
    pub fn step_us(&mut self) -> f64 {
        toile_base::numeric::statistics::median(&mut self.times_ns).map_or(0.0, |ns| ns as f64 * 1e-3)
    }

    /// A picture of it, from above and before.
    pub fn picture(&self, camera: &OrbitCamera, size: Size) -> Image {
        let positions: Vec<Vec3> = self.cloth.positions.iter().map(|p| Vec3::from(*p)).collect();
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, &self.garment.triangles, &mut normals);
        let [r, g, b] = self.garment.fabric.colour.map(linear);
        let surfaces = [PictureSurface {
            positions: &positions,
            normals: &normals,
            triangles: &self.garment.triangles,
            colours: Colours::One(Vec3::new(r, g, b)),
            material: Material::Cloth,
            look: None,
        }];
        trace::render(&PictureScene { surfaces: &surfaces, floor: false }, camera, size, TraceQuality::Still)
    }
}
