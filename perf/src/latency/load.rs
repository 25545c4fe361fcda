//! Load: threads that want everything that the loop wants: cores, caches, memory, and short sleeps between.

use std::hint::black_box;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Memory that each thread goes through: more than any cache of a core.
const BYTES: usize = 32 << 20;

/// Threads of load; they end when this does.
#[derive(Debug)]
pub struct LoadThreads {
    stop: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl LoadThreads {
    /// So many threads, at normal priority and on any core.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(threads: usize) -> std::io::Result<Self> {
        let mut load = Self { stop: Arc::default(), threads: Vec::new() };
        for i in 0..threads {
            let stop = load.stop.clone();
            let work = move || press(&stop, i as u64);
            load.threads.push(thread::Builder::new().name("toile-load".into()).spawn(work)?);
        }
        Ok(load)
    }
}

impl Drop for LoadThreads {
    fn drop(&mut self) {
        // Relaxed: the flag carries nothing else.
        self.stop.store(true, Relaxed);
        self.threads.drain(..).for_each(|t| _ = t.join());
    }
}

/// Rounds of reading and writing memory out of order, of arithmetic, of sleep.
fn press(stop: &AtomicBool, seed: u64) {
    let mut memory = vec![0u64; BYTES / 8];
    let mut state = seed | 1;
    let mut round = 0u64;
    // Relaxed: see above.
    while !stop.load(Relaxed) {
        for _ in 0..200_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let i = (state >> 33) as usize % memory.len();
            memory[i] = memory[i].rotate_left(7) ^ state;
        }
        round += 1;
        if round.is_multiple_of(16) {
            thread::sleep(Duration::from_micros(500));
        }
    }
    black_box(memory);
}
