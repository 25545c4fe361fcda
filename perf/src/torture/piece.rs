//! The pieces that are tortured: small cloths whose place of rest is the only one.

use std::f32::consts::TAU;

use glam::{Affine3A, DVec3, Vec3, Vec3A};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Part};
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::Colliders;

use super::error::TortureError;
use crate::oracle::{Oracle, OracleError, Problem, Solids};

/// Columns and rows of the curtain: 360 particles of which the upper row is held.
pub const CURTAIN: [usize; 2] = [15, 24];

/// Columns and rows of the patch, for cases in which each seed has a cloth of its own, and for long rests.
pub const PATCH: [usize; 2] = [9, 14];

/// From thread to thread (m).
pub const CELL_M: f32 = 0.02;

/// Where the upper edge hangs (m): in the height of a person, because f32 is coarser there than about the origin.
pub const TOP: Vec3 = Vec3::new(0.0, 1.5, 0.0);

/// Rate at which the air damps motion (1/s). The built-in fabrics have 1/s, with which a swing of 0.3 m is still one of 20
/// mm after five seconds, with any solver; with this rate it is one of 1e-6 m, and what is farther away is an error.
pub const DAMPING_PER_S: f32 = 6.0;

/// Force left on a particle that still counts as an equilibrium, over the weight of the whole (1): it moves a cloth that
/// hangs half a metre by less than 50 um.
const RESIDUAL: f64 = 1e-4;

/// Steps until a piece that was left alone counts as at rest.
const SETTLE_STEPS: usize = 1_800;

/// A garment, and where it rests.
#[derive(Debug, Clone)]
pub struct Piece {
    /// The garment that is tried.
    pub garment: Garment,
    /// The cloth at rest.
    pub settled: Cloth,
    /// Where each particle then is (m) `[particles]`.
    pub rest: Box<[Vec3]>,
}

impl Piece {
    /// Bakes a shape, lets it come to rest by itself, and asks the oracle where it should.
    ///
    /// # Errors
    /// Where the shape cannot be baked, or has no place of rest.
    pub fn new(shape: &Shape, fabric: &Fabric, settings: &Settings) -> Result<Self, TortureError> {
        let garment = bake("torture", "one", shape, fabric)?;
        let rest = equilibrium(&garment, settings, &garment.start)?;
        Ok(Self { settled: settled(&garment, settings), garment, rest })
    }

    /// How far the undisturbed cloth is from the oracle's equilibrium (m).
    pub fn off(&self) -> f64 {
        let apart = |(p, q): (&Vec3A, &Vec3)| f64::from(Vec3::from(*p).distance(*q));
        self.settled.positions.iter().zip(&self.rest).map(apart).fold(0.0, f64::max)
    }

    /// The particles of a vertex row by row: particle `[vertex]`.
    pub fn particles(&self) -> Vec<usize> {
        let mut particle = vec![0; self.garment.particles()];
        self.garment.source.iter().enumerate().for_each(|(i, &v)| particle[v as usize] = i);
        particle
    }
}

/// The equilibrium that is reached downhill from some places (m), by the oracle.
pub fn equilibrium(garment: &Garment, settings: &Settings, from: &[Vec3]) -> Result<Box<[Vec3]>, TortureError> {
    let problem = Problem { gravity: Vec3::from(settings.gravity).as_dvec3(), ..Problem::of(garment) };
    let from: Vec<DVec3> = from.iter().map(|p| p.as_dvec3()).collect();
    let weight = problem.free_mass() * problem.gravity.length();
    let solved = match Oracle::new(problem)?.equilibrium(&from, &Solids::default()) {
        // Faces a micrometre wide leave more of the sum of forces than the oracle's own tolerance, and still nothing.
        Err(OracleError::NotConverged(near)) if near.report.residual_n < RESIDUAL * weight => *near,
        other => other?,
    };
    Ok(solved.state.x.iter().map(|x| x.as_vec3()).collect())
}

/// The garment after it was left alone with nothing about it.
fn settled(garment: &Garment, settings: &Settings) -> Cloth {
    let colliders = Colliders::new(&[], &[], false).expect("no colliders are within every limit");
    let palette = [Affine3A::IDENTITY; BONES];
    let mut cloth = Cloth::new(garment, &colliders).in_wind(garment);
    for _ in 0..SETTLE_STEPS {
        cloth.step(garment, &Step { palette: &palette, colliders: &colliders, settings });
    }
    cloth
}

/// Light cotton in much air. Crumpled, it has more than one place of rest: the oracle finds folds in it that stay.
///
/// # Panics
/// Where the fabric is not built in, which its own tests rule out.
pub fn lawn() -> Fabric {
    let lawn = toile_assets::fabric::built_in("cotton-lawn").expect("a fabric that is built in");
    Fabric { damping_per_s: DAMPING_PER_S, ..lawn }
}

/// Denim of 11 oz in much air, as measured (density .324 kg/m2, bending rigidity up to 97 uN m): stiff enough to open
/// every fold, so that a curtain of it has one place of rest, however it was crumpled.
pub fn denim() -> Fabric {
    Fabric { name: "denim".into(), density_kg_m2: 0.324, bend_warp_un_m: 97.0, bend_weft_un_m: 97.0, ..lawn() }
}

/// A cloth that hangs by its whole upper edge; the pins follow bones 0 and 1, half each. Vertices row by row from above.
pub fn sheet([columns, rows]: [usize; 2]) -> Shape {
    let mut shape = Shape::default();
    for v in 0..columns * rows {
        let (row, column) = (v / columns, v % columns);
        let x = (column as f32 - 0.5 * (columns - 1) as f32) * CELL_M;
        let p = TOP + Vec3::new(x, -(row as f32) * CELL_M, 0.0);
        shape.push(p, p, row == 0, Part::All);
        shape.weights.push(SkinWeights { bones: [0, 1, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] });
    }
    let at = |row: usize, column: usize| (row * columns + column) as u32;
    for row in 1..rows {
        for column in 1..columns {
            shape.faces.push([at(row, column - 1), at(row, column), at(row - 1, column), at(row - 1, column - 1)]);
        }
    }
    shape
}

/// A tube that hangs by its upper ring, cut `cut_radius` wide and, below that ring, worn `worn_radius` wide (m).
pub fn tube([columns, rows]: [usize; 2], cut_radius: f32, worn_radius: f32) -> Shape {
    let mut shape = Shape::default();
    for v in 0..columns * rows {
        let (row, column) = (v / columns, v % columns);
        let (sin, cos) = (column as f32 / columns as f32 * TAU).sin_cos();
        let at = |radius: f32| TOP + Vec3::new(radius * cos, -(row as f32) * CELL_M, radius * sin);
        shape.push(at(cut_radius), at(if row == 0 { cut_radius } else { worn_radius }), row == 0, Part::All);
        shape.weights.push(SkinWeights { bones: [0, 1, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] });
    }
    let at = |row: usize, column: usize| (row * columns + column % columns) as u32;
    for row in 1..rows {
        for column in 0..columns {
            shape.faces.push([at(row, column + 1), at(row, column), at(row - 1, column), at(row - 1, column + 1)]);
        }
    }
    shape
}

/// Whether every position of a cloth, and every velocity, is a number.
pub fn nonfinite(cloth: &Cloth) -> u64 {
    let bad = |v: &Vec3A| !v.is_finite();
    let velocities = (0..cloth.positions.len()).map(|i| cloth.velocity(i));
    (cloth.positions.iter().filter(|p| bad(p)).count() + velocities.filter(bad).count()) as u64
}
