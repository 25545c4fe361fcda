//! Cloth by itself: sheets of one cell size, a fabric with only the properties under test, and steps in an empty
//! world.

use glam::{Affine3A, DVec3, Vec3, Vec3A};
use toile_bake::Shape;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Part};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::Colliders;
use toile_perf::oracle::State;

/// A flat sheet, `columns` x `rows` cells of `cell` metres, hanging from `top` down; the upper edge is fixed if asked.
pub fn sheet(columns: u32, rows: u32, cell: f32, top: Vec3, pinned: bool) -> Shape {
    let mut shape = Shape::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let p = top + Vec3::new(column as f32 * cell, -(row as f32) * cell, 0.0);
            shape.push(p, p, pinned && row == 0, Part::All);
            shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
        }
    }
    let at = |row: u32, column: u32| row * (columns + 1) + column;
    for row in 0..rows {
        for column in 0..columns {
            shape.faces.push([at(row + 1, column), at(row + 1, column + 1), at(row, column + 1), at(row, column)]);
        }
    }
    shape
}

/// A fabric with only the properties under test: no bending, hardly any shear, no air unless asked.
///
/// # Panics
/// Never: its base is built in.
pub fn plain_fabric(density_kg_m2: f32, stretch_n_m: f32, damping_per_s: f32) -> Fabric {
    Fabric {
        density_kg_m2,
        stretch_warp_n_m: stretch_n_m,
        stretch_weft_n_m: stretch_n_m,
        shear_n_m: 1.0,
        bend_warp_un_m: 0.0,
        bend_weft_un_m: 0.0,
        damping_per_s,
        ..toile_assets::fabric::built_in("cotton-lawn").expect("a fabric that is built in")
    }
}

/// A garment in an empty world, its bones at rest.
pub struct Alone<'a> {
    /// The garment that is stepped.
    pub garment: &'a Garment,
    /// State of the garment.
    pub cloth: Cloth,
    colliders: Colliders,
}

impl<'a> Alone<'a> {
    /// As it was cut.
    ///
    /// # Panics
    /// Never: no colliders are within every limit.
    pub fn new(garment: &'a Garment) -> Self {
        let colliders = Colliders::new(&[], &[], false).expect("no colliders at all");
        Self { garment, cloth: Cloth::new(garment, &colliders), colliders }
    }

    /// Steps the garment once.
    pub fn step(&mut self, settings: &Settings) {
        let palette = &[Affine3A::IDENTITY; BONES];
        self.cloth.step(self.garment, &Step { palette, colliders: &self.colliders, settings });
    }

    /// Puts the free particles elsewhere: `to` is given the vertex and where it is, and gives place and velocity.
    pub fn disturb(&mut self, to: impl Fn(u32, Vec3) -> (Vec3, Vec3)) {
        for (i, &vertex) in self.garment.source.iter().enumerate() {
            if self.garment.inverse_mass[i] > 0.0 {
                let (place, velocity) = to(vertex, self.cloth.positions[i].into());
                self.cloth.disturb(i, place.into(), velocity.into());
            }
        }
    }

    /// Places and velocities in f64.
    pub fn state(&self) -> State {
        let wide = |v: Vec3A| Vec3::from(v).as_dvec3();
        State {
            x: self.cloth.positions.iter().map(|p| wide(*p)).collect(),
            v: (0..self.garment.particles()).map(|i| wide(self.cloth.velocity(i))).collect(),
        }
    }

    /// Momentum (kg m/s), angular momentum about the origin (kg m2/s), and the sums of the sizes of both.
    pub fn momenta(&self) -> ([DVec3; 2], [f64; 2]) {
        let state = self.state();
        let mut sums = ([DVec3::ZERO; 2], [0.0; 2]);
        for (i, w) in self.garment.inverse_mass.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            let p = state.v[i] / f64::from(*w);
            for (k, part) in [p, state.x[i].cross(p)].into_iter().enumerate() {
                sums.0[k] += part;
                sums.1[k] += part.length();
            }
        }
        sums
    }
}

/// A smooth motion of a sheet about its middle: neighbours go nearly the same way (m/s).
pub fn ripple(p: Vec3, speed: f32) -> Vec3 {
    let [a, b] = [p.x * 9.0 + p.y * 4.0, p.y * 11.0 - p.x * 3.0].map(f32::sin);
    Vec3::new(0.3 * b, -0.2 * a, 0.7 * a + 0.5 * b) * speed
}

/// A swing out of the sheet's own plane, that neither crumples nor folds it (m/s).
pub fn swing(p: Vec3, speed: f32) -> Vec3 {
    Vec3::Z * speed * (0.6 - p.y) * (1.0 + 0.4 * (5.0 * p.x).sin())
}
