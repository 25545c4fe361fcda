//! Runs cases over their seeds.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use toile_engine::cloth::Quality;
use toile_gpu::backend::{Backend, Backends};

use super::cases::{CASES, TortureCase};
use super::error::TortureError;
use super::outcome::{CaseSummary, SeedOutcome, TortureReport};
use super::piece::Piece;
use super::pieces::Pieces;
use crate::backend::SteppedBy;
use crate::random::CaseRandom;

/// Seeds of a case where nothing else is said.
pub const SEEDS: u64 = 100;

/// Threads that share the seeds of a case.
const THREADS: usize = 2;

/// What is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct TortureOptions {
    /// One case by its name; all of them if none is given.
    pub case: Option<String>,
    /// The seeds of each case.
    pub seeds: Range<u64>,
    /// How the cloth is stepped where a case does not choose for itself.
    pub quality: Quality,
    /// What steps it.
    pub backend: Backend,
    /// Whether the oracle steps it instead, exactly and slowly.
    pub exact: bool,
}

impl Default for TortureOptions {
    fn default() -> Self {
        Self { case: None, seeds: 0..SEEDS, quality: Quality::default(), backend: Backend::Cpu, exact: false }
    }
}

/// Runs the cases that are asked for; `progress` is given the summary of each as it ends.
///
/// # Errors
/// Where a piece cannot be baked or has no equilibrium, which would be an error of the bake or of the oracle; where the oracle
/// cannot step the case that is asked for.
pub fn run(options: &TortureOptions, progress: &mut dyn FnMut(&CaseSummary)) -> Result<TortureReport, TortureError> {
    let asked = |c: &&TortureCase| options.case.as_ref().map_or(c.exact || !options.exact, |name| c.name == name);
    if let Some(case) = CASES.iter().filter(asked).find(|case| options.exact && !case.exact) {
        return Err(TortureError::NotExact(case.name));
    }
    let pieces = Pieces::new(options.quality, Backends::open(options.backend), options.exact)?;
    let off = |piece: &Piece| piece.off() * 1e3;
    let undisturbed_mm = [off(&pieces.curtain), off(&pieces.lawn), off(&pieces.patch), off(&pieces.tube)];
    let mut report = TortureReport {
        quality: options.quality.name(),
        oracle: options.exact,
        undisturbed_mm,
        ..TortureReport::default()
    };
    for case in CASES.iter().filter(asked) {
        let outcomes = of_seeds(case, &pieces, options.seeds.clone());
        let summary = CaseSummary::of(case.name, case.about, &outcomes);
        progress(&summary);
        report.summary.push(summary);
        report.cases.extend(outcomes);
    }
    report.stepped_by = SteppedBy::of(&pieces.backends);
    Ok(report)
}

/// The outcomes of one case, in the order of the seeds.
fn of_seeds(case: &TortureCase, pieces: &Pieces, seeds: Range<u64>) -> Vec<SeedOutcome> {
    let next = AtomicUsize::new(0);
    let seeds: Vec<u64> = seeds.collect();
    let done = Mutex::new(vec![None; seeds.len()]);
    let work = || {
        // Relaxed: who takes which seed orders nothing else; the results are handed over by the lock.
        while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
            let outcome =
                SeedOutcome::of(case.name, seed, (case.run)(pieces, &mut CaseRandom::new(case.name, seed), seed));
            let place = (seed - seeds[0]) as usize;
            if let Ok(mut done) = done.lock() {
                done[place] = Some(outcome);
            }
        }
    };
    std::thread::scope(|scope| (0..THREADS).for_each(|_| drop(scope.spawn(work))));
    done.into_inner().map(|done| done.into_iter().flatten().collect()).unwrap_or_default()
}
