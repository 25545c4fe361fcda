//! Simulate: the loop's lives one after the other, against a clock that only they move. Deterministic, and as fast as the
//! work itself.

use super::ThreadLoop;
use crate::clock::{Clock, SimClock};

/// Most lives that are simulated together.
pub const MOST_LIVES: usize = 8;

/// Calls each life when it wants to be called, the earliest first and of equals the first in the list, until a time
/// (ns). Gives the number of turns. Lives beyond [`MOST_LIVES`] are not called.
pub fn simulate(clock: &SimClock, lives: &mut [&mut dyn ThreadLoop], until_ns: u64) -> u64 {
    let mut due = [Some(0); MOST_LIVES];
    let mut turns = 0;
    loop {
        let next = due.iter().take(lives.len()).enumerate().filter_map(|(i, at)| Some(((*at)?, i))).min();
        let Some((at, i)) = next else { return turns };
        if at.max(clock.now_ns()) >= until_ns {
            return turns;
        }
        clock.sleep_until(at);
        due[i] = lives[i].run_due();
        turns += 1;
    }
}
