//! Threads: each part of the loop on a thread of its own, pinned and raised as far as the machine allows, ended by a flag.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::sync::mpsc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::ThreadLoop;
use super::thread_roles::{self, RolePlacement, ThreadRole};
use crate::clock::Clock;
use crate::workers::{WorkerPool, WorkerPoolError};

/// Longest sleep of a thread (ns): after at most that it sees that it is to end.
const LONGEST_SLEEP_NS: u64 = 50_000_000;

/// Longest that a new thread is waited for until it says which place it got.
const LONGEST_START: Duration = Duration::from_secs(5);

/// Tells all threads to end.
///
/// Relaxed: the flag carries nothing else; the thread that joins another sees all that it wrote.
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Ends all threads within 50 ms.
    pub fn now(&self) {
        self.0.store(true, Relaxed);
    }

    /// Whether they are to end.
    pub fn is_set(&self) -> bool {
        self.0.load(Relaxed)
    }
}

/// A part of the loop on its thread.
#[derive(Debug)]
pub struct LoopThread<T> {
    thread: JoinHandle<(T, bool)>,
    /// Turns taken so far: what a watchdog looks at.
    turns: Arc<AtomicU64>,
    placement: mpsc::Receiver<RolePlacement>,
}

impl<T> LoopThread<T> {
    /// Turns taken so far. Relaxed: a number to look at, which orders nothing.
    pub fn turns(&self) -> u64 {
        self.turns.load(Relaxed)
    }

    /// Whether it has ended by itself.
    pub fn is_over(&self) -> bool {
        self.thread.is_finished()
    }

    /// The place that the thread got, once, as soon as it says so; none if it does not within seconds.
    pub fn placement(&self) -> Option<RolePlacement> {
        self.placement.recv_timeout(LONGEST_START).ok()
    }

    /// Waits for its end, which [`Stop`] brings about, and gives back what lived; none where it panicked.
    pub fn join(self) -> Option<T> {
        self.thread.join().ok().and_then(|(life, whole)| whole.then_some(life))
    }

    /// The same, also where it panicked: what it held can serve the next one. What it was about when it died may be half
    /// done.
    pub fn salvage(self) -> Option<T> {
        self.thread.join().ok().map(|(life, _)| life)
    }
}

/// Starts a thread of the loop. Everything is allocated before its first turn.
///
/// # Errors
/// Where the system gives no thread.
pub fn start<T, C>(role: ThreadRole, mut life: T, clock: C, stop: &Stop) -> io::Result<LoopThread<T>>
where
    T: ThreadLoop + Send + 'static,
    C: Clock + Send + 'static,
{
    let turns = Arc::new(AtomicU64::new(0));
    let (stop, mine) = (stop.clone(), turns.clone());
    let (send_placement, placement) = mpsc::sync_channel(1);
    let work = move || {
        // The receiver may be gone.
        let _ = send_placement.send(thread_roles::apply(role));
        let live = || {
            life.begin();
            while !stop.is_set() {
                let Some(next) = life.run_due() else { break };
                mine.fetch_add(1, Relaxed);
                clock.sleep_until(next.min(clock.now_ns() + LONGEST_SLEEP_NS));
            }
        };
        let whole = catch_unwind(AssertUnwindSafe(live)).is_ok();
        (life, whole)
    };
    let thread = thread::Builder::new().name(format!("toile-{}", role.name())).spawn(work)?;
    Ok(LoopThread { thread, turns, placement })
}

/// The cloth's workers, for runs that a thread of the role `caller` calls: the second worker is never pinned to that thread's core. Gives
/// the place that it got, where it has one of its own.
///
/// # Errors
/// As [`WorkerPool::new`].
pub fn worker_pool(workers: usize, caller: ThreadRole) -> Result<(WorkerPool, Option<RolePlacement>), WorkerPoolError> {
    let (send_placement, placed) = mpsc::sync_channel(1);
    let begin = move || match caller.second_worker() {
        Some(role) => _ = send_placement.send(thread_roles::apply(role)),
        // It would inherit the core of the thread that makes the pool.
        None => thread_roles::release(),
    };
    let pool = WorkerPool::beginning(workers, begin)?;
    Ok((pool, placed.recv_timeout(LONGEST_START).ok()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::RealClock;

    struct Counting(u64, RealClock);

    impl ThreadLoop for Counting {
        fn run_due(&mut self) -> Option<u64> {
            self.0 += 1;
            (self.0 < 40).then(|| self.1.now_ns() + 100_000)
        }
    }

    #[test]
    fn a_life_ends_by_itself_or_when_told() {
        let clock = RealClock::default();
        let own = start(ThreadRole::Render, Counting(0, clock), clock, &Stop::default()).unwrap();
        assert_eq!(own.placement().unwrap().role, ThreadRole::Render);
        assert_eq!(own.join().unwrap().0, 40);
        let stop = Stop::default();
        let placed = start(ThreadRole::Render, Counting(u64::MAX / 2, clock), clock, &stop).unwrap();
        stop.now();
        assert!(placed.join().is_some());
    }

    struct Dying(u64);

    impl ThreadLoop for Dying {
        fn run_due(&mut self) -> Option<u64> {
            self.0 += 1;
            // Without the hook: no words on the test's output.
            if self.0 == 3 { std::panic::resume_unwind(Box::new(())) } else { Some(0) }
        }
    }

    #[test]
    fn what_a_dead_life_held_can_be_had_but_not_as_if_it_had_lived_on() {
        let clock = RealClock::default();
        let begun = || start(ThreadRole::Render, Dying(0), clock, &Stop::default()).unwrap();
        assert!(begun().join().is_none());
        assert_eq!(begun().salvage().unwrap().0, 3);
    }

    #[test]
    fn a_crew_of_two_says_where_its_worker_is() {
        let (one, helper) = worker_pool(1, ThreadRole::Physics).unwrap();
        assert_eq!((one.workers(), helper), (1, None));
        let (two, worker) = worker_pool(2, ThreadRole::Physics).unwrap();
        assert_eq!((two.workers(), worker.unwrap().role), (2, ThreadRole::Worker));
        let (other, worker) = worker_pool(2, ThreadRole::Background).unwrap();
        assert_eq!((other.workers(), worker), (2, None), "it may run wherever its caller is not");
    }
}
