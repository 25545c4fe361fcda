use std::hint::spin_loop;

use crate::workers::*;
use std::sync::Arc;
use std::sync::atomic::Ordering::{Relaxed, SeqCst};
use std::time::Duration;

use crate::lanes::{Shared, WriteColumn};
use crate::sync::{AtomicBool, AtomicUsize, thread};

/// A job that fails where a phase begins before the one before it is over, and that writes plain memory which the other
/// share reads in the next phase.
fn ordered(pool: &mut WorkerPool, phases: usize, weight: impl Fn(usize, usize) -> u32 + Sync) -> Vec<f32> {
    let over: Vec<[AtomicUsize; 2]> = (0..=phases).map(|_| Default::default()).collect();
    let mut sums = vec![0.0f32; phases * 2];
    let shared = Shared::new(WriteColumn::new(&mut sums));
    let job = |phase: usize, share: usize| {
        let (mut seen, column) = (7.0, shared.open_in_test());
        if phase > 0 {
            let before = [0, 1].map(|s| over[phase - 1][s].load(Relaxed));
            assert_eq!(before, [1, 1], "phase {phase} began too early");
            seen = (column.get(phase * 2 - 2) * 3.0 + column.get(phase * 2 - 1)) % 99_991.0;
        }
        (0..weight(phase, share)).for_each(|_| spin_loop());
        column.set(phase * 2 + share, seen + (phase * 2 + share) as f32);
        over[phase][share].fetch_add(1, Relaxed);
    };
    pool.run(phases, job).unwrap();
    assert!(over[..phases].iter().flatten().all(|n| n.load(Relaxed) == 1), "a share was done twice or not at all");
    sums
}

#[test]
fn one_worker_and_two_give_the_same_in_order_however_long_the_shares_are() {
    let (mut one, mut two) = (WorkerPool::new(1).unwrap(), WorkerPool::new(2).unwrap());
    assert_eq!((one.workers(), two.workers()), (1, 2));
    let even = |_: usize, _: usize| 0;
    let odd = |phase: usize, share: usize| (phase * 7_919 + share * 104_729) as u32 % 64;
    let late = |phase: usize, share: usize| if share == 1 && phase.is_multiple_of(50) { 5_000 } else { 0 };
    for round in 0..200 {
        let phases = [1, 2, 3, 500][round % 4];
        assert_eq!(ordered(&mut one, phases, even), ordered(&mut two, phases, even));
        assert_eq!(ordered(&mut one, phases, odd), ordered(&mut two, phases, odd));
    }
    assert_eq!(ordered(&mut one, 400, late), ordered(&mut two, 400, late));
    assert_eq!(one.taken(), 0, "there is no helper to take a share from");
    two.run(0, |_, _| panic!("there is no phase")).unwrap();
}

#[test]
fn a_helper_that_sleeps_or_starves_is_not_waited_for() {
    let mut pool = WorkerPool::new(2).unwrap();
    // Long asleep: the short run is over before it is awake, or it comes in between; both have to be right.
    for _ in 0..20 {
        thread::sleep(AWAKE * 20);
        ordered(&mut pool, 50, |_, _| 0);
    }
    assert!(pool.taken() > 0, "no run of some microseconds was over before a sleeping thread woke");
    // Starved: more busy threads than cores, for which the helper loses its core at any moment.
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| (0u64..).take_while(|_| !stop.load(Relaxed)).for_each(|_| spin_loop()));
        }
        for _ in 0..50 {
            ordered(&mut pool, 100, |phase, share| ((phase + share) % 3 * 50) as u32);
        }
        stop.store(true, Relaxed);
    });
}

#[test]
fn the_shares_of_a_phase_run_at_once_when_the_helper_is_awake() {
    let mut pool = WorkerPool::new(2).unwrap();
    // Share 0 ends only after share 1 began, which the caller cannot have done.
    let begun: Vec<AtomicBool> = (0..100).map(|_| AtomicBool::new(false)).collect();
    let job = |phase: usize, share: usize| {
        begun[phase].fetch_or(share == 1, SeqCst);
        while !begun[phase].load(SeqCst) {
            thread::yield_now();
        }
    };
    pool.run(begun.len(), job).unwrap();
    assert_eq!(pool.taken(), 0);
}

#[test]
fn a_panic_in_either_share_ends_the_run_and_not_the_crew() {
    for workers in [1, 2] {
        let mut pool = WorkerPool::new(workers).unwrap();
        for share in [0, 1] {
            for phase in [0, 5, 19] {
                let after = AtomicUsize::new(0);
                let error = pool.run(20, |p, s| {
                    assert!((p, s) != (phase, share), "as the test wants it");
                    after.fetch_add(usize::from(p > phase), Relaxed);
                });
                assert_eq!(error, Err(SharePanicked { phase, share }));
                assert_eq!(after.load(Relaxed), 0);
                assert!(error.unwrap_err().to_string().contains(&format!("share {share} of phase {phase} ")));
            }
        }
        ordered(&mut pool, 100, |_, _| 0);
    }
}

#[test]
fn each_item_is_done_once() {
    for workers in [1, 2] {
        let mut pool = WorkerPool::new(workers).unwrap();
        for n in [0, 1, 2, 3, 100] {
            let mut items: Vec<u64> = (0..n).collect();
            pool.each(&mut items, |i, item| {
                assert_eq!(*item, i as u64);
                *item += 1_000;
            })
            .unwrap();
            assert!(items.iter().zip(0..).all(|(item, i)| *item == i + 1_000));
        }
        assert!(pool.each(&mut [1, 2, 3], |i, _| assert!(i != 1, "as the test wants it")).is_err());
    }
}

#[test]
fn two_crews_work_side_by_side() {
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                let mut pool = WorkerPool::new(2).unwrap();
                (0..50).for_each(|_| drop(ordered(&mut pool, 100, |phase, _| phase as u32 % 5)));
            });
        }
    });
}

#[test]
fn a_dropped_crew_leaves_no_thread_awake_asleep_or_just_born() {
    for pause in [Duration::ZERO, AWAKE / 4, AWAKE * 3] {
        for _ in 0..20 {
            let mut pool = WorkerPool::new(2).unwrap();
            pool.run(2, |_, _| ()).unwrap();
            thread::sleep(pause);
            let state = Arc::downgrade(&pool.state);
            drop(pool);
            assert!(state.upgrade().is_none(), "the helper still holds the shared state");
        }
    }
    drop(WorkerPool::new(2).unwrap());
}

#[test]
fn waking_early_is_harmless_and_bad_crews_are_refused() {
    let mut pool = WorkerPool::new(2).unwrap();
    // On a busy machine it takes a while until the helper gets to sleep.
    let slept = (0..500).any(|_| {
        thread::sleep(AWAKE * 20);
        pool.wake()
    });
    assert!(slept, "it never slept");
    ordered(&mut pool, 10, |_, _| 0);
    assert!(!WorkerPool::new(1).unwrap().wake());
    for workers in [0, 3] {
        let error = WorkerPool::new(workers).unwrap_err().to_string();
        assert!(error.contains(&format!("a pool of {workers} workers")), "{error}");
    }
}
