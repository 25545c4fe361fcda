//! Torture: what no cloth ever meets, and how the engine takes it.
//!
//! Reads: the cases and a range of seeds. Writes: a [`Report`]: one [`Outcome`] a case and seed, one [`Summary`] a case.
//! Budget: three minutes for all cases at 100 seeds on two cores; never inside the frame.
//! Thread: two of its own over the seeds; the results stand in the order of the cases and seeds.

mod elements;
mod found;
mod long_rest;
mod piece;
mod poison;
mod random;
mod ratios;
mod start;
mod surround;
mod trial;

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use thiserror::Error;
use toile_assets::garment::MeshError;
use toile_engine::cloth::{Quality, Settings};
use toile_gpu::stepper::{Backend, Means};

use crate::backend::SteppedBy;
use crate::oracle::OracleError;

use found::Found;
pub use found::{Outcome, Report, Summary};
use piece::{CURTAIN, PATCH, Piece};
pub(crate) use random::Random;

/// Seeds of a case where nothing else is said.
pub const SEEDS: u64 = 100;

/// Threads that share the seeds of a case.
const THREADS: usize = 2;

/// Columns and rows of the tube that is twice too small, and its radius as cut (m).
const TUBE: [usize; 2] = [20, 18];
const TUBE_RADIUS_M: f32 = 0.07;

/// One case.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is done, in a few words.
    pub about: &'static str,
    run: fn(&Site, &mut Random, u64) -> Found,
}

/// Every case, in the order of the table.
pub const CASES: [Case; 25] = [
    Case { name: "random-box", about: "every vertex anywhere in a box of 1 m", run: start::random_box },
    Case { name: "crumpled-lawn", about: "the same with thin cloth, in which folds may stay", run: start::crumpled },
    Case { name: "flattened", about: "pressed into a plane", run: start::flattened },
    Case { name: "inverted", about: "mirrored in a plane through its middle", run: start::inverted },
    Case { name: "stretched", about: "stretched 5 times", run: start::stretched },
    Case { name: "collapsed-fiber", about: "all particles of a fiber in one place", run: start::collapsed_fiber },
    Case { name: "collapsed-cloth", about: "all free particles in one place", run: start::collapsed_cloth },
    Case { name: "long-step", about: "substeps 4 times as long, while it swings", run: start::long_step },
    Case { name: "one-iteration", about: "one substep, every set once, while it swings", run: start::one_iteration },
    Case { name: "mass-ratio", about: "masses from 1 to 100,000 at random", run: ratios::mass_ratio },
    Case { name: "stiffness-ratio", about: "warp and weft 1 : 10,000", run: ratios::stiffness_ratio },
    Case { name: "heavy-chain", about: "20 links, the last particle 100,000 times heavier", run: ratios::heavy_chain },
    Case { name: "even-chain", about: "20 particles of 1 kg: the force at the top", run: ratios::even_chain },
    Case { name: "strand", about: "the TinyVBD strand: 1,000 kg swing on 19 links", run: ratios::strand },
    Case { name: "teleport", about: "a capsule jumps through the cloth and back", run: surround::teleport },
    Case { name: "squeeze", about: "two capsules meet with the cloth between them", run: surround::squeeze },
    Case { name: "too-small", about: "a tube on a body twice as wide", run: surround::too_small },
    Case { name: "spin", about: "10 turns a second about any axis, 2 s", run: surround::spin },
    Case { name: "bad-elements", about: "sides without length and faces without area", run: elements::bad_elements },
    Case { name: "bad-surroundings", about: "no numbers in colliders", run: poison::surroundings },
    Case { name: "bad-bones", about: "no numbers in the bones that pins follow", run: poison::bones },
    Case { name: "bad-settings", about: "no numbers in gravity, wind and settings", run: poison::settings },
    Case {
        name: "bad-root-settings",
        about: "the same in the root's settings and substeps",
        run: poison::root_settings,
    },
    Case { name: "bad-state", about: "no numbers in positions and velocities", run: poison::state },
    Case { name: "long-rest", about: "a minute at rest: a step takes as long as before", run: long_rest::long_rest },
];

/// Why no torture can be done.
#[derive(Debug, Error)]
pub enum TortureError {
    /// A piece that cannot be baked.
    #[error("a piece of cloth cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// A piece whose equilibrium is not found.
    #[error("a piece of cloth has no equilibrium: {0}")]
    Oracle(#[from] OracleError),
}

/// What is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// One case by its name; all of them if none is given.
    pub case: Option<String>,
    /// The seeds of each case.
    pub seeds: Range<u64>,
    /// How the cloth is stepped where a case does not choose for itself.
    pub quality: Quality,
    /// What steps it.
    pub backend: Backend,
}

impl Default for Options {
    fn default() -> Self {
        Self { case: None, seeds: 0..SEEDS, quality: Quality::default(), backend: Backend::Cpu }
    }
}

/// The pieces that cases share.
#[derive(Debug)]
struct Site {
    by: Means,
    settings: Settings,
    curtain: Piece,
    lawn: Piece,
    patch: Piece,
    tube: Piece,
}

impl Site {
    fn new(quality: Quality, by: Means) -> Result<Self, TortureError> {
        let settings = Settings { quality, workers: 1, ..Settings::default() };
        let fabric = piece::denim();
        Ok(Self {
            curtain: Piece::new(&piece::sheet(CURTAIN), &fabric, &settings)?,
            lawn: Piece::new(&piece::sheet(CURTAIN), &piece::lawn(), &settings)?,
            patch: Piece::new(&piece::sheet(PATCH), &fabric, &settings)?,
            tube: Piece::new(&piece::tube(TUBE, TUBE_RADIUS_M, 2.0 * TUBE_RADIUS_M), &fabric, &settings)?,
            settings,
            by,
        })
    }
}

/// Runs the cases that are asked for; `told` is given the summary of each as it ends.
///
/// # Errors
/// Where a piece cannot be baked or has no equilibrium, which would be an error of the bake or of the oracle.
pub fn run(options: &Options, told: &mut dyn FnMut(&Summary)) -> Result<Report, TortureError> {
    let site = Site::new(options.quality, Means::open(options.backend))?;
    let off = |piece: &Piece| piece.off() * 1e3;
    let undisturbed_mm = [off(&site.curtain), off(&site.lawn), off(&site.patch), off(&site.tube)];
    let mut report = Report { quality: options.quality.name(), undisturbed_mm, ..Report::default() };
    for case in CASES.iter().filter(|c| options.case.as_ref().is_none_or(|name| c.name == name)) {
        let outcomes = of_seeds(case, &site, options.seeds.clone());
        let summary = Summary::of(case, &outcomes);
        told(&summary);
        report.summary.push(summary);
        report.cases.extend(outcomes);
    }
    report.stepped_by = SteppedBy::of(&site.by);
    Ok(report)
}

/// The outcomes of one case, in the order of the seeds.
fn of_seeds(case: &Case, site: &Site, seeds: Range<u64>) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let seeds: Vec<u64> = seeds.collect();
    let done = Mutex::new(vec![None; seeds.len()]);
    let work = || {
        // Relaxed: who takes which seed orders nothing else; the results are handed over by the lock.
        while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
            let outcome = Outcome::of(case, seed, (case.run)(site, &mut Random::new(case.name, seed), seed));
            let place = (seed - seeds[0]) as usize;
            if let Ok(mut done) = done.lock() {
                done[place] = Some(outcome);
            }
        }
    };
    std::thread::scope(|scope| (0..THREADS).for_each(|_| drop(scope.spawn(work))));
    done.into_inner().map(|done| done.into_iter().flatten().collect()).unwrap_or_default()
}
