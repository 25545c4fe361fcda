//! A scene as data: a shape in a fabric, and what the surroundings do at a time.

use glam::{Affine3A, DVec3, Vec4};
use toile_assets::scene::skirt::{self, SkirtMotion};
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::overrides::Overrides;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Solver};
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::{BONES, Pose, Skeleton};
use toile_engine::body::palette;
use toile_engine::colliders::Colliders;

use super::error::ParetoError;
use crate::worn::on_the_way;

toile_base::named! {
    /// What fibers are solved by.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum SolverChoice {
        /// As the bake and the garment's file choose.
        Mixed = "mixed",
        /// All of them by Gauss-Seidel.
        GaussSeidel = "gauss-seidel",
        /// Warp and weft whole, by the tridiagonal system.
        SemiImplicit = "semi-implicit",
        /// Warp and weft whole and without compliance.
        ZeroStretch = "zero-stretch",
    }
}

impl SolverChoice {
    /// The fibers' solver, in place of what the garment's file says. Shear is soft and always swept.
    fn overrides(self, of_file: Overrides) -> Overrides {
        let all = |solver| Overrides { warp: Some(solver), weft: Some(solver), ..Overrides::default() };
        match self {
            Self::Mixed => of_file,
            Self::GaussSeidel => Overrides { bias: Some(Solver::GaussSeidel), ..all(Solver::GaussSeidel) },
            Self::SemiImplicit => all(Solver::SemiImplicit),
            Self::ZeroStretch => all(Solver::ZeroStretch),
        }
    }
}

/// What moves the pins and the colliders.
#[derive(Debug, Clone)]
pub enum SceneMotion {
    /// A body that does not move: the cloth settles.
    Still,
    /// The benchmark's body.
    Skirt(SkirtMotion),
    /// A mannequin that takes a pose within [`POSE_S`] from the one that garments are cut in, and then stands still.
    Mannequin(Box<Skeleton>, Box<Pose>),
}

/// Time in which the mannequin takes its pose (s).
pub const POSE_S: f64 = 0.75;

/// What x* is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReferenceKind {
    /// The oracle's equilibrium, at the end.
    Equilibrium,
    /// A run with very many substeps, in frames along the way.
    Trajectory,
}

/// A scene in one mesh.
#[derive(Debug, Clone)]
pub struct MeshedScene {
    /// Name of the scene.
    pub scene: &'static str,
    /// Name of the mesh.
    pub mesh: String,
    /// Whether every setting is run on it, or only the qualities' own.
    pub main: bool,
    /// The shape, its file's solvers in it.
    pub shape: Shape,
    /// The fabric that it is made of.
    pub fabric: Fabric,
    /// What moves pins and colliders.
    pub drive: SceneMotion,
    /// The colliders before their first placement.
    pub colliders: Colliders,
    /// Time that is run (s).
    pub seconds: f64,
    /// What its x* is.
    pub truth: ReferenceKind,
}

impl MeshedScene {
    /// The garment, its fibers solved as asked for.
    pub fn bake(&self, choice: SolverChoice) -> Result<Garment, ParetoError> {
        let mut shape = self.shape.clone();
        shape.solver = choice.overrides(shape.solver);
        Ok(bake(self.scene, "one", &shape, &self.fabric)?)
    }

    /// Steps of a run.
    pub fn steps(&self) -> u64 {
        (self.seconds / f64::from(STEP_SECONDS)).round() as u64
    }

    /// Places bones and colliders where they are at a time (s).
    pub fn place(&self, time: f64, bones: &mut [Affine3A; BONES], colliders: &mut Colliders) {
        match &self.drive {
            SceneMotion::Still => {
                let stay: Vec<Vec4> = colliders.end().to_vec();
                colliders.place_spheres(&stay);
            }
            SceneMotion::Skirt(motion) => {
                bones[0] = skirt::root(*motion, time);
                colliders.place_spheres(&skirt::spheres(*motion, time));
            }
            SceneMotion::Mannequin(skeleton, goal) => {
                palette(skeleton, &on_the_way(skeleton, goal, (time / POSE_S).clamp(0.0, 1.0) as f32), bones);
                colliders.place(bones);
            }
        }
    }

    /// Positions by the numbers of the shape's vertices (m).
    pub fn by_vertex(garment: &Garment, positions: impl Fn(usize) -> DVec3) -> Vec<DVec3> {
        let mut at = vec![DVec3::ZERO; garment.source.len()];
        garment.source.iter().enumerate().for_each(|(p, &v)| at[v as usize] = positions(p));
        at
    }
}
