//! The workers of a step, in every order of their steps that differs by at most [`PREEMPTIONS`] forced switches.

use std::sync::atomic::Ordering::Relaxed;

use loom::cell::Cell;
use loom::sync::atomic::AtomicUsize;
use toile_models::workers::{PerShare, WorkerPool};

/// Switches of threads that nothing but the scheduler asks for. Most faults of such protocols need no more than two (Musuvathi
/// and Qadeer 2007, "Iterative context bounding").
const PREEMPTIONS: usize = 2;

fn explore(model: impl Fn() + Sync + Send + 'static) {
    let mut builder = loom::model::Builder::new();
    builder.preemption_bound = Some(PREEMPTIONS);
    builder.max_branches = 20_000;
    builder.check(model);
}

/// Plain memory of a job: the model ends where two threads meet in it.
struct Plain([Cell<u64>; 2]);

// A job is shared by reference; loom's cell watches its users.
#[expect(unsafe_code, reason = "the cells are what the model watches")]
// SAFETY: loom's cells end the model at the first race.
unsafe impl Sync for Plain {}

#[test]
fn a_phase_sees_all_of_the_one_before_and_each_share_runs_once() {
    explore(|| {
        let mut pool = WorkerPool::new(2).unwrap();
        let plain = Plain([Cell::new(0), Cell::new(0)]);
        let runs = [AtomicUsize::new(0), AtomicUsize::new(0)];
        pool.run(2, |phase, share| {
            let plain = &plain;
            if phase == 0 {
                plain.0[share].set(share as u64 + 1);
            } else {
                // What the other share wrote in the phase before is read without an atomic.
                assert_eq!(plain.0[1 - share].get(), 2 - share as u64);
            }
            runs[phase].fetch_add(1, Relaxed);
        })
        .unwrap();
        // After the run the caller has everything.
        assert_eq!([plain.0[0].get(), plain.0[1].get()], [1, 2]);
        assert_eq!(runs.each_ref().map(|n| n.load(Relaxed)), [2, 2]);
    });
}

#[test]
fn one_run_after_another_never_gives_a_late_helper_an_old_job() {
    explore(|| {
        let mut pool = WorkerPool::new(2).unwrap();
        for round in 0..2 {
            // The job lives on this stack frame only.
            let here = [AtomicUsize::new(0), AtomicUsize::new(0)];
            pool.wake();
            pool.run(1, |_, share| _ = here[share].fetch_add(1 + round, Relaxed)).unwrap();
            assert_eq!(here.map(|n| n.load(Relaxed)), [1 + round; 2]);
        }
    });
}

#[test]
fn a_helper_that_goes_to_sleep_is_woken_or_not_waited_for_and_always_leaves() {
    // The model ends with an error where a thread parks for ever: a lost wake-up.
    explore(|| {
        let pool = WorkerPool::new(2).unwrap();
        pool.wake();
        drop(pool);
    });
}

#[test]
fn what_belongs_to_a_share_is_lent_to_one_at_a_time() {
    explore(|| {
        let mut pool = WorkerPool::new(2).unwrap();
        let mut numbers = [0u64, 10];
        let lent = PerShare::new(&mut numbers);
        let got = AtomicUsize::new(0);
        // Both want what is share 0's: a job that does not keep to its share.
        pool.run(1, |_, _| {
            if lent.with(0, |n| *n += 1).is_some() {
                got.fetch_add(1, Relaxed);
            }
        })
        .unwrap();
        let got = got.load(Relaxed) as u64;
        assert!((1..=2).contains(&got));
        assert_eq!(numbers, [got, 10]);
    });
}
