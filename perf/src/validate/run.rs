//! Runs cases side by side and gathers their rows in the order of the cases.

use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, OnceLock};
use std::time::Instant;

use serde::Serialize;
use toile_gpu::backend::{Backend, Backends};

use super::case::{ValidationCase, ValidationRow};
use super::specimen::SpecimenError;
use super::{Level, cases};
use crate::backend::SteppedBy;

/// What is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidationOptions {
    /// The one name of which cases are run, or all.
    pub case: Option<String>,
    /// Of these only what has this parameter, as the table says it, or all.
    pub parameter: Option<String>,
    /// The levels that rows are reported of.
    pub levels: Vec<Level>,
    /// Threads: cases are independent of each other.
    pub threads: usize,
    /// One in so many cases of each name is run: a small version of the set.
    pub every: usize,
    /// What steps the cloth.
    pub backend: Backend,
}

impl Default for ValidationOptions {
    fn default() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get().min(2));
        Self { case: None, parameter: None, levels: Level::ALL.to_vec(), threads, every: 1, backend: Backend::Cpu }
    }
}

/// The table of validation: a row for each case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValidationReport {
    /// Rows in the order of the cases.
    pub cases: Vec<ValidationRow>,
    /// Rows with a target that was met, and all with one.
    pub passed: [usize; 2],
    /// Threads that it was run on.
    pub threads: usize,
    /// What stepped the cloth.
    pub stepped_by: SteppedBy,
    /// How long it took (s).
    pub wall_s: f64,
}

impl ValidationReport {
    /// The rows whose target was missed.
    pub fn failed(&self) -> impl Iterator<Item = &ValidationRow> {
        self.cases.iter().filter(|row| row.pass == Some(false))
    }
}

/// Stack of a thread: kernels that are not optimised keep every vector of theirs there.
const STACK_BYTES: usize = 32 << 20;

/// The names of all cases, in the order of the table: known without working out what is exact, which takes seconds.
pub const NAMES: [&str; 28] = [
    "cantilever",
    "peirce",
    "elastica",
    "bias",
    "residual",
    "creep",
    "greenhill",
    "euler",
    "lateral",
    "strip",
    "top-force",
    "catenary",
    "shear-sag",
    "stretch-curve",
    "loop",
    "chain-mode",
    "pendulum",
    "spring",
    "wave",
    "free-fall",
    "energy",
    "capstan",
    "incline",
    "stopping",
    "layer-capstan",
    "layer-incline",
    "layer-weight",
    "invariance",
];

/// Runs cases; `progress` is called after each that is done, with how many there are.
///
/// # Errors
/// Where a case's own mesh or colliders are refused.
pub fn run(options: &ValidationOptions, progress: &(impl Fn(usize) + Sync)) -> Result<ValidationReport, SpecimenError> {
    let begun = Instant::now();
    let chosen = chosen(options);
    let backends = Backends::open(options.backend);
    let rows = Mutex::new((0..chosen.len()).map(|_| None).collect::<Vec<_>>());
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            // Relaxed: the counter hands out numbers; results are published by the lock.
            let at = next.fetch_add(1, Relaxed);
            let Some(case) = chosen.get(at) else { return };
            let found = case.rows(&options.levels, &backends);
            if let Ok(mut rows) = rows.lock() {
                rows[at] = Some(found);
            }
            progress(chosen.len());
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..options.threads.max(1) {
            // If no thread can be started, the calling thread does the work.
            if std::thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work).is_err() {
                work();
            }
        }
    });
    let rows = rows.into_inner().unwrap_or_default();
    let mut cases = Vec::new();
    for found in rows.into_iter().flatten() {
        cases.extend(found?);
    }
    let passed = [true, false].map(|pass| cases.iter().filter(|row| row.pass == Some(pass)).count());
    Ok(ValidationReport {
        cases,
        passed: [passed[0], passed[0] + passed[1]],
        threads: options.threads,
        stepped_by: SteppedBy::of(&backends),
        wall_s: begun.elapsed().as_secs_f64(),
    })
}

/// All cases, made once: their exact values take seconds.
fn all() -> &'static [ValidationCase] {
    static ALL: OnceLock<Vec<ValidationCase>> = OnceLock::new();
    ALL.get_or_init(cases::all)
}

/// The cases that are run.
fn chosen(options: &ValidationOptions) -> Vec<&'static ValidationCase> {
    let named = |case: &ValidationCase| options.case.as_ref().is_none_or(|name| name == case.name);
    let wanted = |case: &ValidationCase| named(case) && options.parameter.as_ref().is_none_or(|p| *p == case.parameter);
    let mut number = 0;
    let mut before = "";
    let mut one_in = |case: &ValidationCase| {
        number = if case.name == before { number + 1 } else { 0 };
        before = case.name;
        number % options.every.max(1) == 0
    };
    all().iter().filter(|case| wanted(case) && one_in(case)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_its_name_in_the_list() {
        let mut names: Vec<&str> = Vec::new();
        for case in all() {
            if !names.contains(&case.name) {
                names.push(case.name);
            }
        }
        assert_eq!(names, NAMES);
    }
}
