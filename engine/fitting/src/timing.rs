//! Timing: a job is warmed up, run many times, and its median is given.

use std::time::{Duration, Instant};

use toile_base::numeric::statistics::median_of;
use toile_engine::workers::WorkerPool;

/// Runs before the first that counts: caches, branch predictors and the clock of the core settle in them.
const WARM_UP: usize = 3;

/// Fewest and most runs of which the median is taken.
const RUNS: [usize; 2] = [7, 401];

/// Time after which no further run is begun, once there are enough.
const ENOUGH: Duration = Duration::from_millis(500);

/// Median time of a job (us).
pub fn median_us(mut job: impl FnMut()) -> f64 {
    for _ in 0..WARM_UP {
        job();
    }
    let begun = Instant::now();
    let mut runs = Vec::with_capacity(RUNS[1]);
    while runs.len() < RUNS[0] || (runs.len() < RUNS[1] && begun.elapsed() < ENOUGH) {
        let start = Instant::now();
        job();
        runs.push(start.elapsed());
    }
    median_of(runs.iter().map(Duration::as_secs_f64)).unwrap_or(0.0) * 1e6
}

/// What a frame does between waking the cloth's helper and the cloth's step, posing and skinning the body, takes at
/// least so long; the helper is awake by then.
const BEFORE_CLOTH: Duration = Duration::from_micros(80);

/// Wakes the helper of two workers, and waits as long as the frame's other work would.
pub fn wake(pool: &mut WorkerPool) {
    if pool.wake() {
        let woken = Instant::now();
        while woken.elapsed() < BEFORE_CLOTH {
            std::hint::spin_loop();
        }
    }
}

/// A stopwatch for work that is too rare to be repeated: on Linux it counts the time that its thread has a core, so that
/// other work on the machine is not counted as this one's; elsewhere all time.
pub struct OnCore {
    begun: Instant,
    had: Option<u64>,
}

impl OnCore {
    /// Begins to count.
    pub fn begin() -> Self {
        Self { begun: Instant::now(), had: had_ns() }
    }

    /// Processor time of this thread since [`Self::begin`].
    pub fn elapsed(&self) -> Duration {
        match (self.had, had_ns()) {
            (Some(before), Some(after)) => Duration::from_nanos(after.saturating_sub(before)),
            _ => self.begun.elapsed(),
        }
    }
}

/// How long this thread had a core (ns), by Linux's scheduler.
fn had_ns() -> Option<u64> {
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_counts_and_no_more_than_all_time() {
        let (watch, all) = (OnCore::begin(), Instant::now());
        let mut x = 1u64;
        while all.elapsed() < Duration::from_millis(60) {
            (0..1000).for_each(|k| x = std::hint::black_box(x.wrapping_mul(k + 3)));
        }
        let worked = watch.elapsed();
        assert!(worked > Duration::from_micros(100), "{worked:?}");
        assert!(worked <= all.elapsed() + Duration::from_millis(10), "{worked:?} of {:?}", all.elapsed());
    }

    #[test]
    fn the_median_is_of_many_runs_after_a_warm_up() {
        let mut runs = 0;
        let us = median_us(|| {
            runs += 1;
            // The first runs are slow, as cold ones are: they must not count.
            std::thread::sleep(Duration::from_millis(if runs <= WARM_UP { 50 } else { 2 }));
        });
        assert!(runs >= WARM_UP + RUNS[0], "{runs} runs");
        assert!((2_000.0..40_000.0).contains(&us), "{us} us");
    }
}
