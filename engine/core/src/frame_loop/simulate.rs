//! Simulate: the loop's threads one after the other, against a clock that only they move. Deterministic, and as fast as the
//! work itself.

use super::ThreadLoop;
use crate::clock::{Clock, SimClock};

/// Most threads that are simulated together.
pub const MAX_SIMULATED: usize = 8;

/// Calls each thread's part when it wants to be called, the earliest first and of equals the first in the list, until a time
/// (ns). Gives the number of turns. Those beyond [`MAX_SIMULATED`] are not called.
pub fn simulate(clock: &SimClock, threads: &mut [&mut dyn ThreadLoop], until_ns: u64) -> u64 {
    let mut due = [Some(0); MAX_SIMULATED];
    let mut turns = 0;
    loop {
        let next = due.iter().take(threads.len()).enumerate().filter_map(|(i, at)| Some(((*at)?, i))).min();
        let Some((at, i)) = next else { return turns };
        if at.max(clock.now_ns()) >= until_ns {
            return turns;
        }
        clock.sleep_until(at);
        due[i] = threads[i].run_due();
        turns += 1;
    }
}
