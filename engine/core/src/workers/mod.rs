//! Worker pool: the workers of a step, the caller's thread and at most one helper.
//!
//! A phase costs one barrier between two cores, under 1 us. A run takes no lock, allocates nothing and uses no channel. The caller
//! is the physics thread; the helper starts at load. This is one of the few modules with unsafe code, because a job that borrows
//! the caller's stack is handed to another thread.
//!
//! A run is a list of phases, a phase is two shares. Both shares of a phase may run at once; all of a phase runs before
//! any of the next. How the data falls into shares is the job's matter and never depends on the number of workers, so
//! one worker, which does share 0 and then share 1, gives the bits of two. A phase for one worker leaves share 1 empty.
//!
//! The helper is never waited for before it has begun: a share that it has not claimed within some microseconds is done
//! by the caller, who then stops waiting for it until it claims one again. Only a share that was begun is waited for.
//!
//! Between runs the helper spins for [`AWAKE`], then parks. Parking it and waking it are the only system calls of a run
//! that goes as planned: at 120 Hz a helper that never slept would burn a whole core, and no other way of sleeping ends
//! when the next step begins. [`WorkerPool::wake`] hides the time of waking behind whatever comes before the cloth.

mod per_share;
mod phase_check;

use std::any::Any;
use std::fmt;
use std::io;
use std::mem::forget;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release, SeqCst};
use std::time::Duration;

use thiserror::Error;

use crate::sync::{
    AtomicBool, AtomicU64, AtomicUsize, HAS_THREADS, Idle, JoinHandle, LOOKS_BEFORE_TAKING, Slot, pause, thread,
};

pub use per_share::PerShare;
pub use phase_check::{PhaseCheck, RunningShare};

/// Shares of a phase, and most workers of a pool.
pub const SHARES: usize = 2;

/// How long the helper stays awake after its last work: longer than the gap between two garments of a step, short
/// beside the step of 8.3 ms.
pub const AWAKE: Duration = Duration::from_micros(100);

/// Why there is no worker pool.
#[derive(Debug, Error)]
pub enum WorkerPoolError {
    /// Not 1 or 2.
    #[error("a pool of {0} workers cannot be made, because a step has {SHARES} shares; ask for 1 or 2 workers")]
    Workers(usize),
    /// Built without the feature `threads`.
    #[error(
        "this program was built without the feature `threads` of toile-engine; build it with that or ask for 1 worker"
    )]
    NoThreads,
    /// The system gave no thread.
    #[error(
        "the helper thread of the cloth could not be started ({0}); raise the limit of threads or ask for 1 worker"
    )]
    Spawn(#[from] io::Error),
}

/// A share of a run panicked; what came after it was not done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("share {share} of phase {phase} panicked and the rest of the run was left out; its message tells the cause")]
pub struct SharePanicked {
    /// The phase, counted from 0.
    pub phase: usize,
    /// The share, 0 or 1.
    pub share: usize,
}

/// Keeps a value that one side writes and the other reads on two cache lines of its own, because processors fetch pairs.
#[derive(Default)]
#[repr(align(128))]
struct Apart<T>(T);

/// A borrowed job with its type and lifetime taken off.
#[derive(Clone, Copy)]
struct Job {
    data: *const (),
    call: unsafe fn(*const (), usize, usize),
    /// Sequence number of its first phase.
    first: u64,
}

/// State that the two threads share. Each phase has a sequence number that never repeats, over all runs.
pub(crate) struct PoolState {
    /// The last sequence number of the run under way.
    open: Apart<AtomicU64>,
    /// The last sequence number whose share 1 was begun. Share 0 is always the caller's.
    claimed: Apart<AtomicU64>,
    /// The last sequence number that is done, for each share.
    done: [Apart<AtomicU64>; SHARES],
    /// Whether the helper sleeps, or is about to.
    asleep: Apart<AtomicBool>,
    /// Whether the helper is to end.
    leaving: AtomicBool,
    /// 0, or 1 + sequence number * SHARES + share of the first panic of the run.
    failed: AtomicU64,
    /// The job. The caller writes it while all phases are done; the thread that holds an unfinished share reads it.
    job: Slot<Job>,
}

// SAFETY: the job's pointer is the only part that is not an atomic. It may go to another thread, because `WorkerPool::run` takes
// only jobs that are `Sync`.
unsafe impl Send for PoolState {}
// SAFETY: the cell of the job is the only part that is not an atomic. `WorkerPool::run` writes it while every share is done, and
// `work` reads it while a share is not done, so no thread writes it while another accesses it. The job is `Sync`.
unsafe impl Sync for PoolState {}

impl PoolState {
    fn new() -> Self {
        unsafe fn nothing(_: *const (), _: usize, _: usize) {}
        Self {
            open: Apart::default(),
            claimed: Apart::default(),
            done: Default::default(),
            asleep: Apart::default(),
            leaving: AtomicBool::new(false),
            failed: AtomicU64::new(0),
            job: Slot::new(Job { data: std::ptr::null(), call: nothing, first: 1 }),
        }
    }

    /// Takes share 1 of a phase, or returns the last sequence number that was taken.
    ///
    /// Relaxed: the exchange decides who does the share and carries nothing else. What the share reads was acquired
    /// through `open` and `done`. A sequence number is taken once, so a helper that comes late with an old one gets nothing.
    fn claim(&self, sequence: u64) -> Result<(), u64> {
        self.claimed.0.compare_exchange(sequence - 1, sequence, Relaxed, Relaxed).map(|_| ())
    }

    /// Does one share and says so.
    ///
    /// # Safety
    /// The caller holds this share of this phase (share 1 by [`Self::claim`]), and it is not done yet. Then the run is
    /// still on, because [`WorkerPool::run`] waits for both shares of its last phase: the job lives, and its cell is not
    /// written.
    unsafe fn work(&self, sequence: u64, share: usize) {
        // SAFETY: the caller's share is not done, so `WorkerPool::run` does not write the cell. The last write happened before the
        // store of `open`, which this thread has acquired or made.
        let job = unsafe { self.job.read() };
        // Relaxed: only saves work. The caller of the run looks again after it has acquired every `done`.
        if self.failed.load(Relaxed) == 0 {
            let phase = (sequence - job.first) as usize;
            // SAFETY: `call` was made for `data`, which the run borrows until it ends.
            if let Err(payload) = catch_unwind(AssertUnwindSafe(|| unsafe { (job.call)(job.data, phase, share) })) {
                self.fail(sequence, share, payload);
            }
        }
        // Release: a thread that acquires it sees all that the share wrote.
        self.done[share].0.store(sequence, Release);
    }

    #[cold]
    fn fail(&self, sequence: u64, share: usize, payload: Box<dyn Any + Send>) {
        // A payload may panic when it is dropped, which would end the helper: it is left.
        forget(payload);
        let place = 1 + sequence * SHARES as u64 + share as u64;
        // Relaxed: the store of `done` that follows carries it.
        let _ = self.failed.compare_exchange(0, place, Relaxed, Relaxed);
    }

    /// Whether both shares of a phase are done. Acquire: then all that they wrote is seen.
    fn is_done(&self, sequence: u64) -> bool {
        self.done.iter().all(|d| d.0.load(Acquire) >= sequence)
    }
}

/// Loop of the helper: claims share 1 of one phase after the other.
fn help(state: &PoolState) {
    let (mut sequence, mut looks) = (1, 0);
    let mut rest = Idle::until(AWAKE);
    loop {
        // Acquire: the job was written before.
        if state.open.0.load(Acquire) < sequence {
            // Relaxed: it is stored before the wake-up that ends a park, or seen at a later look.
            if state.leaving.load(Relaxed) {
                return;
            }
            looks += 1;
            if rest.is_over(looks) {
                sleep(state, sequence);
                rest = Idle::until(AWAKE);
            }
            pause(0);
        } else if !state.is_done(sequence - 1) {
            // The barrier: the phase before is not over.
            looks += 1;
            pause(looks);
        } else {
            match state.claim(sequence) {
                Ok(()) => {
                    // SAFETY: share 1 was claimed, its run is open, and the phases before it are done.
                    unsafe { state.work(sequence, 1) };
                    sequence += 1;
                    rest = Idle::until(AWAKE);
                }
                // The caller did not wait; go on behind the last phase that it took.
                Err(taken) => sequence = taken + 1,
            }
            looks = 0;
        }
    }
}

/// Parks the helper unless there is work.
///
/// All SeqCst, with those in [`WorkerPool::run`], [`WorkerPool::wake`] and `drop`: either the helper sees the new `open` (or
/// `leaving`) or the other side sees it `asleep` and wakes it. With any weaker order both could look too early.
fn sleep(state: &PoolState, sequence: u64) {
    state.asleep.0.store(true, SeqCst);
    if state.open.0.load(SeqCst) < sequence && !state.leaving.load(SeqCst) {
        thread::park();
    }
    state.asleep.0.store(false, SeqCst);
}

/// The workers. A run borrows the pool, so two runs cannot overlap and a job cannot start another.
pub struct WorkerPool {
    pub(crate) state: Arc<PoolState>,
    helper: Option<JoinHandle<()>>,
    last: u64,
    taken: u64,
}

impl WorkerPool {
    /// A pool of 1 or 2 workers; the second is a thread that lives as long as the pool. At load.
    pub fn new(workers: usize) -> Result<Self, WorkerPoolError> {
        Self::beginning(workers, || ())
    }

    /// The same, whose helper does something first, such as to ask for a core of its own.
    pub fn beginning(workers: usize, begin: impl FnOnce() + Send + 'static) -> Result<Self, WorkerPoolError> {
        if !(1..=SHARES).contains(&workers) {
            return Err(WorkerPoolError::Workers(workers));
        }
        if workers > 1 && !HAS_THREADS {
            return Err(WorkerPoolError::NoThreads);
        }
        let state = Arc::new(PoolState::new());
        let theirs = state.clone();
        let life = move || {
            begin();
            help(&theirs);
        };
        let start = || thread::Builder::new().name("toile-cloth".into()).spawn(life);
        let helper = if workers == SHARES { Some(start()?) } else { None };
        Ok(Self { state, helper, last: 0, taken: 0 })
    }

    /// Number of workers, the calling thread among them.
    pub fn workers(&self) -> usize {
        1 + usize::from(self.helper.is_some())
    }

    /// Shares that the helper should have done and came too late for, since the pool was made.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// Wakes the helper if it sleeps, which takes it some 20 us; to be called as the frame begins, before the body is
    /// posed. Says whether it slept.
    pub fn wake(&self) -> bool {
        let Some(helper) = &self.helper else { return false };
        // SeqCst: see `sleep`.
        let asleep = self.state.asleep.0.load(SeqCst);
        if asleep {
            helper.thread().unpark();
        }
        asleep
    }

    /// Calls `job(phase, share)` for every phase below `phases`, in order, and for both shares of each; returns when
    /// all are done. After a panic nothing further is begun.
    pub fn run<F: Fn(usize, usize) + Sync>(&mut self, phases: usize, job: F) -> Result<(), SharePanicked> {
        /// # Safety
        /// `data` is an `F` that lives during the call.
        unsafe fn call<F: Fn(usize, usize)>(data: *const (), phase: usize, share: usize) {
            // SAFETY: the caller passes a pointer to an `F` that lives during the call. Shares call it through a shared reference.
            unsafe { (*data.cast::<F>())(phase, share) }
        }
        let state = &*self.state;
        let first = self.last + 1;
        self.last += phases as u64;
        // SAFETY: every phase so far is done, so no thread reads the cell: `work` is entered only with a sequence number that is
        // open and not done.
        unsafe { state.job.write(Job { data: (&raw const job).cast(), call: call::<F>, first }) };
        // Relaxed: published by `open`.
        state.failed.store(0, Relaxed);
        // SeqCst: publishes the job as a release does, and see `sleep`.
        state.open.0.store(self.last, SeqCst);
        let mut helped = self.helper.is_some() && !self.wake();
        for sequence in first..=self.last {
            // SAFETY: share 0 is this thread's, and that of this phase was not done before.
            unsafe { state.work(sequence, 0) };
            helped = barrier(state, sequence, helped);
            self.taken += u64::from(!helped && self.helper.is_some());
        }
        // Relaxed: every `done` of the run was acquired.
        match state.failed.load(Relaxed).checked_sub(1) {
            None => Ok(()),
            Some(place) => Err(SharePanicked {
                phase: (place / SHARES as u64 - first) as usize,
                share: (place % SHARES as u64) as usize,
            }),
        }
    }

    /// Calls `task(i, &mut items[i])` for every item, whichever worker is free: one garment each. Items should not
    /// depend on each other; those with most work come best first.
    pub fn each<T: Send, F: Fn(usize, &mut T) + Sync>(
        &mut self,
        items: &mut [T],
        task: F,
    ) -> Result<(), SharePanicked> {
        let (next, items) = (AtomicUsize::new(0), Items::new(items));
        self.run(1, |_, _| {
            loop {
                // Relaxed: gives out each number once; the barriers before and after the phase carry the items.
                let i = next.fetch_add(1, Relaxed);
                // SAFETY: `fetch_add` gives out no number twice, and `each` borrows the slice until `run` returns.
                let Some(item) = (unsafe { items.get(i) }) else { return };
                task(i, item);
            }
        })
    }
}

/// Barrier after share 0: waits for share 1 of this phase if it was begun, and does it otherwise. Says whether the helper did it.
fn barrier(state: &PoolState, sequence: u64, helped: bool) -> bool {
    let (mut looks, mut begun) = (0, false);
    // A helper that was late is not waited for again before it is back.
    let patience = if helped { LOOKS_BEFORE_TAKING } else { 0 };
    // Acquire: all that the share wrote is seen.
    while state.done[1].0.load(Acquire) < sequence {
        if !begun && looks >= patience {
            if state.claim(sequence).is_ok() {
                // SAFETY: share 1 was claimed, and share 0 and all phases before were done by or for this thread.
                unsafe { state.work(sequence, 1) };
                return false;
            }
            begun = true;
        }
        pause(looks);
        looks += 1;
    }
    true
}

impl Drop for WorkerPool {
    fn drop(&mut self) {
        let Some(helper) = self.helper.take() else { return };
        // SeqCst: see `sleep`. The wake-up is unconditional: it costs nothing here.
        self.state.leaving.store(true, SeqCst);
        helper.thread().unpark();
        // It cannot have panicked: every share is caught.
        let _ = helper.join();
    }
}

impl fmt::Debug for WorkerPool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WorkerPool").field("workers", &self.workers()).field("taken", &self.taken).finish()
    }
}

/// Items of which each is given out once.
struct Items<T> {
    data: *mut T,
    len: usize,
}

// SAFETY: it hands `&mut T` to other threads and nothing else, and `T` may be sent.
unsafe impl<T: Send> Sync for Items<T> {}

impl<T> Items<T> {
    fn new(items: &mut [T]) -> Self {
        Self { data: items.as_mut_ptr(), len: items.len() }
    }

    /// # Safety
    /// No index is asked for twice, and the slice is still borrowed.
    #[expect(clippy::mut_from_ref, reason = "each item is given out once")]
    unsafe fn get(&self, i: usize) -> Option<&mut T> {
        // SAFETY: `i` was compared with the length. The caller asks for each index once while the slice is borrowed, so this is
        // the only reference to the item.
        (i < self.len).then(|| unsafe { &mut *self.data.add(i) })
    }
}
