//! One trial: a cloth, what is done to it, and what is seen of it from the first step on.

use glam::{Affine3A, Vec3, Vec3A, Vec4};
use toile_base::garment::Garment;
use toile_base::skeleton::BONES;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::cloth::step::guard::GuardEvents;
use toile_engine::cloth::{Cloth, Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::workers::WorkerPool;
use toile_gpu::backend::ClothStepper;
use toile_gpu::cloth_batch::ClothBatch;

use super::crossed::CrossedEdges;
use super::exact::ExactStepper;
use super::piece::{self, Piece};
use super::pieces::Pieces;

/// Within which a cloth counts as back (m).
pub const BACK_M: f64 = 1e-3;

/// In which it has to be back (s).
pub const RECOVER_S: f32 = 5.0;

/// What a cloth did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrialFigures {
    /// Positions and velocities published that were not finite, summed over the steps.
    pub nonfinite: u64,
    /// Greatest speed of a free particle (m/s).
    pub max_speed: f32,
    /// Greatest way of a free particle in a step, over the step (m/s): what contact pushes out of a collider moves without
    /// having that speed.
    pub max_way: f32,
    /// Substeps that the oracle did not solve as exactly as asked for, where it stepped.
    pub unsolved: u64,
}

/// How a cloth came back.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrialRecovery {
    /// Time from which on it stayed within [`BACK_M`] of its place of rest (s).
    pub after_s: Option<f32>,
    /// Hausdorff distance to its place of rest at the end (m).
    pub hausdorff_m: f64,
}

/// What keeps a cloth out of itself, which the processor steps.
#[derive(Debug)]
struct Folds {
    layers: GarmentContact,
    pool: WorkerPool,
    crossed: CrossedEdges,
}

/// A cloth among colliders.
#[derive(Debug)]
pub struct Trial<'a> {
    /// The garment that is tried.
    pub garment: &'a Garment,
    /// State of the garment.
    pub cloth: Cloth,
    /// The colliders that it meets.
    pub colliders: Colliders,
    /// Where the spheres are said to be in the next step (m); where there are none of them, they follow the bones.
    pub spheres: Option<Vec<Vec4>>,
    /// Where the bones are.
    pub palette: Box<[Affine3A; BONES]>,
    /// How it is stepped.
    pub settings: Settings,
    /// What was seen so far.
    pub seen: TrialFigures,
    stepper: ClothStepper,
    folds: Option<Folds>,
    /// What steps it once more and exactly, where that is asked for.
    exact: Option<ExactStepper>,
    before: Box<[Vec3A]>,
    /// The events up to which jumps were explained.
    explained: GuardEvents,
}

impl<'a> Trial<'a> {
    /// A cloth as it starts, with nothing about it.
    pub fn new(pieces: &Pieces, garment: &'a Garment, settings: &Settings) -> Self {
        let none = Colliders::new(&[], &[], false).expect("no colliders are within every limit");
        let cloth = Cloth::new(garment, &none).in_wind(garment);
        Self::with(pieces, garment, cloth, none, settings)
    }

    /// A piece at rest, with nothing about it.
    pub fn at_rest(pieces: &Pieces, piece: &'a Piece, settings: &Settings) -> Self {
        let none = Colliders::new(&[], &[], false).expect("no colliders are within every limit");
        Self::with(pieces, &piece.garment, piece.settled.clone(), none, settings)
    }

    /// A piece that hangs as it was cut, among spheres joined to capsules.
    pub fn among(
        pieces: &Pieces,
        piece: &'a Piece,
        spheres: &[Vec4],
        capsules: &[[u8; 2]],
        settings: &Settings,
    ) -> Self {
        let mut colliders = rig(spheres, capsules);
        colliders.place_spheres(spheres);
        let cloth = Cloth::new(&piece.garment, &colliders).in_wind(&piece.garment);
        let mut this = Self::with(pieces, &piece.garment, cloth, colliders, settings);
        this.spheres = Some(spheres.to_vec());
        this
    }

    fn with(pieces: &Pieces, garment: &'a Garment, cloth: Cloth, colliders: Colliders, settings: &Settings) -> Self {
        let exact = || ExactStepper::new(garment, settings, &cloth).expect("the figures of what was baked are sound");
        Self {
            before: cloth.positions.clone(),
            explained: cloth.events,
            stepper: pieces.backends.stepper(),
            folds: None,
            exact: pieces.exact.then(exact),
            garment,
            cloth,
            colliders,
            spheres: None,
            palette: Box::new([Affine3A::IDENTITY; BONES]),
            settings: *settings,
            seen: TrialFigures::default(),
        }
    }

    /// The same cloth, kept out of itself, with its crossings counted.
    pub fn with_folds(mut self) -> Self {
        let layers = GarmentContact::new(std::slice::from_ref(self.garment));
        let pool = WorkerPool::new(1).expect("one worker is the caller's thread");
        let crossed = CrossedEdges::new(&[&self.garment.triangles]);
        self.settings.contact.folds = 1;
        self.folds = layers.map(|layers| Folds { layers, pool, crossed });
        self
    }

    /// Crossings of the cloth with itself, where they are counted.
    pub fn crossed(&mut self) -> Option<&mut CrossedEdges> {
        self.folds.as_mut().map(|folds| &mut folds.crossed)
    }

    /// Edges that pass through faces now, where they are counted.
    pub fn crossings(&self) -> Option<u64> {
        self.folds.as_ref().map(|folds| folds.crossed.now)
    }

    /// Counts the crossings of the cloth as it is, and forgets those before.
    pub fn count_crossings_from_here(&mut self) {
        if let Some(folds) = &mut self.folds {
            folds.crossed.restart();
            folds.crossed.look(&[&self.cloth.positions]);
        }
    }

    /// Puts every free particle somewhere else, with a velocity: `to` is given the particle and where it is.
    pub fn disturb(&mut self, mut to: impl FnMut(usize, Vec3) -> (Vec3, Vec3)) {
        for i in 0..self.garment.particles() {
            if self.garment.inverse_mass[i] > 0.0 {
                let (place, velocity) = to(i, self.cloth.positions[i].into());
                self.cloth.disturb(i, place.into(), velocity.into());
            }
        }
    }

    /// One step, and a look at what came of it.
    pub fn step(&mut self) {
        match &self.spheres {
            Some(spheres) => self.colliders.place_spheres(spheres),
            None => self.colliders.place(&self.palette),
        }
        self.before.copy_from_slice(&self.cloth.positions);
        self.exact.iter_mut().for_each(|exact| exact.take(&self.cloth));
        let step = Step { palette: &self.palette, colliders: &self.colliders, settings: &self.settings };
        let cloths = std::slice::from_mut(&mut self.cloth);
        // Without another worker there is none that could panic.
        let _ = match &mut self.folds {
            Some(folds) => folds.layers.step(&mut folds.pool, cloths, std::slice::from_ref(self.garment), &step),
            None => self.stepper.step(&mut ClothBatch { cloths, garments: &[self.garment], steps: &[step] }, None),
        };
        if let Some(exact) = &mut self.exact {
            exact.step(&mut self.cloth, self.garment, &self.settings, &self.colliders);
            self.seen.unsolved = exact.unsolved;
        }
        self.folds.iter_mut().for_each(|folds| folds.crossed.after_step(&[&self.cloth.positions]));
        self.look();
    }

    /// Takes so many steps.
    pub fn run(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.step());
    }

    /// Counts what is not finite, and takes the greatest speed, and the longest way except where the engine says that it has
    /// put the cloth back.
    fn look(&mut self) {
        self.seen.nonfinite += piece::nonfinite(&self.cloth);
        let put = |e: &GuardEvents| (e.repaired, e.rolled_back, e.teleports);
        let moved = put(&self.cloth.events) == put(&self.explained);
        self.explained = self.cloth.events;
        // What no step can be made with is not what the step was made with.
        let dt = self.settings.sound().step_seconds;
        for (i, w) in self.garment.inverse_mass.iter().enumerate() {
            if *w > 0.0 {
                let way = if moved { self.cloth.positions[i].distance(self.before[i]) / dt } else { 0.0 };
                // NaN is counted above.
                self.seen.max_speed = self.seen.max_speed.max(self.cloth.velocity(i).length());
                self.seen.max_way = self.seen.max_way.max(way);
            }
        }
    }

    /// Lets it come to rest, for [`RECOVER_S`].
    pub fn recover(&mut self, rest: &[Vec3]) -> TrialRecovery {
        let dt = self.settings.step_seconds;
        let mut since = None;
        for step in 1..=(RECOVER_S / dt).round() as usize {
            self.step();
            since = if is_near(&self.cloth.positions, rest) { since.or(Some(step as f32 * dt)) } else { None };
        }
        TrialRecovery { after_s: since, hausdorff_m: hausdorff(&self.cloth.positions, rest) }
    }
}

/// Colliders of spheres that are given in the world.
fn rig(spheres: &[Vec4], capsules: &[[u8; 2]]) -> Colliders {
    let still = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.0 };
    Colliders::new(&vec![still; spheres.len()], capsules, false).expect("the trials' colliders are within the limits")
}

/// Distance of a point to the nearest of some others (m).
fn nearest(p: Vec3, others: impl Iterator<Item = Vec3>) -> f64 {
    f64::from(others.map(|q| p.distance_squared(q)).fold(f32::INFINITY, f32::min)).sqrt()
}

/// Hausdorff distance of two sets of particles (m): the farthest that any is from the nearest of the others.
pub fn hausdorff(positions: &[Vec3A], rest: &[Vec3]) -> f64 {
    let there = positions.iter().map(|p| nearest((*p).into(), rest.iter().copied()));
    let back = rest.iter().map(|q| nearest(*q, positions.iter().map(|p| Vec3::from(*p))));
    there.chain(back).fold(0.0, f64::max)
}

/// Whether two sets of particles are within [`BACK_M`] of each other. Only what is not where it belongs has to look for
/// another that is.
fn is_near(positions: &[Vec3A], rest: &[Vec3]) -> bool {
    let off = |(p, q): &(&Vec3A, &Vec3)| f64::from(Vec3::from(**p).distance(**q)) > BACK_M;
    positions.iter().zip(rest).filter(off).all(|(p, q)| {
        nearest((*p).into(), rest.iter().copied()) <= BACK_M
            && nearest(*q, positions.iter().map(|p| Vec3::from(*p))) <= BACK_M
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hausdorff_looks_both_ways() {
        let rest = [Vec3::ZERO, Vec3::X];
        let at = |p: [Vec3; 2]| p.map(Vec3A::from);
        assert_eq!(hausdorff(&at(rest), &rest), 0.0);
        assert_eq!(hausdorff(&at([Vec3::X, Vec3::ZERO]), &rest), 0.0, "sets know no order");
        assert_eq!(hausdorff(&at([Vec3::ZERO, Vec3::ZERO]), &rest), 1.0, "nothing is at X");
        assert_eq!(hausdorff(&at([Vec3::ZERO, Vec3::X * 3.0]), &rest), 2.0);
        for p in [[Vec3::X, Vec3::ZERO], [Vec3::ZERO, Vec3::ZERO], [Vec3::ZERO, Vec3::X * 1.0005]] {
            assert_eq!(is_near(&at(p), &rest), hausdorff(&at(p), &rest) <= BACK_M);
        }
    }
}
