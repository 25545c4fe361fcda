//! Timing: a job is warmed up, run many times, and its median is told.

use std::time::{Duration, Instant};

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
    runs.sort_unstable();
    runs[runs.len() / 2].as_secs_f64() * 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

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
