//! Times corrected: from 0, strictly increasing, bursts merged.

use toile_base::numeric::statistics::quantile_of;

use crate::error::{FilePlace, ReaderFault};
use crate::limits::{MAX_DURATION_NS, MAX_JOINT_FRAMES};
use crate::session::too_many;
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;

/// Makes times start at 0 and strictly increase. A frame that follows within a third of the nominal period (the median
/// distance) takes the place of the one before: such pairs are late frames handed over in a burst, and the last is
/// nearest to its own time. Frames that go back in time are dropped.
pub(super) fn tidy(frames: Vec<Joints>, notes: &mut Vec<String>) -> Result<Vec<Joints>, ReaderFault> {
    if frames.len() > MAX_JOINT_FRAMES {
        return Err(too_many(frames.len()));
    }
    let Some(start) = frames.first().map(|f| f.time_ns) else { return Ok(frames) };
    let (total, period) = (frames.len(), median_step_ns(&frames));
    let mut kept: Vec<Joints> = Vec::with_capacity(total);
    let (mut merged, mut backwards) = (0, 0);
    let mut group_begin = 0;
    for mut frame in frames {
        let Some(time) = frame.time_ns.checked_sub(start) else {
            backwards += 1;
            continue;
        };
        frame.time_ns = time;
        if time > MAX_DURATION_NS {
            let problem = "its time lies more than two hours after the first frame";
            return Err(ReaderFault::new(
                FilePlace::Frame(kept.len()),
                problem,
                "cut the recording where the clock was set",
            ));
        }
        match kept.last_mut() {
            Some(last) if time < last.time_ns => backwards += 1,
            Some(last) if time == last.time_ns || time - group_begin < period / 3 => {
                *last = Joints { time_ns: time.max(last.time_ns), ..frame };
                merged += 1;
            }
            _ => {
                group_begin = time;
                kept.push(frame);
            }
        }
    }
    // The first group may have moved on from 0.
    let first = kept.first().map_or(0, |f| f.time_ns);
    kept.iter_mut().for_each(|f| f.time_ns -= first);
    describe(&kept, period, [total, merged, backwards], notes);
    Ok(kept)
}

/// Identities that are counted: a sensor follows six people, and more than this many a session is a broken file.
const IDENTITIES: usize = 64;

/// The identity that most frames show; the first of equals.
pub(super) fn most_frequent<T: PartialEq>(identities: impl Iterator<Item = T>) -> Option<T> {
    let mut counts: Vec<(T, usize)> = Vec::new();
    for id in identities {
        match counts.iter().position(|(known, _)| *known == id) {
            Some(i) => counts[i].1 += 1,
            None if counts.len() < IDENTITIES => counts.push((id, 1)),
            None => {}
        }
    }
    counts.into_iter().rev().max_by_key(|(_, n)| *n).map(|(id, _)| id)
}

fn median_step_ns(frames: &[Joints]) -> u64 {
    quantile_of(frames.windows(2).filter_map(|w| w[1].time_ns.checked_sub(w[0].time_ns)), 0.5).unwrap_or(0)
}

fn describe(kept: &[Joints], period: u64, [total, merged, backwards]: [usize; 3], notes: &mut Vec<String>) {
    let ms = |ns: u64| ns as f64 * 1e3 / SECOND_NS as f64;
    if merged > 0 {
        notes.push(format!(
            "{merged} of {total} frames came closer than a third of the {:.1} ms period after another and replaced it",
            ms(period)
        ));
    }
    if backwards > 0 {
        notes.push(format!("{backwards} of {total} frames went back in time and were dropped"));
    }
    let gap = kept.windows(2).map(|w| w[1].time_ns - w[0].time_ns).max().unwrap_or(0);
    if gap > period + period / 2 {
        notes.push(format!(
            "frames are missing: the longest gap is {:.0} ms at a period of {:.1} ms",
            ms(gap),
            ms(period)
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_ms(times: &[u64]) -> Vec<Joints> {
        times.iter().map(|ms| Joints::absent(ms * 1_000_000)).collect()
    }

    #[test]
    fn bursts_merge_and_backward_frames_go() {
        let mut notes = Vec::new();
        let kept = tidy(at_ms(&[100, 133, 300, 301, 333, 320, 366, 400]), &mut notes).unwrap();
        let ms: Vec<u64> = kept.iter().map(|f| f.time_ns / 1_000_000).collect();
        assert_eq!(ms, [0, 33, 201, 233, 266, 300]);
        assert_eq!(notes.len(), 3, "{notes:?}");
    }

    #[test]
    fn a_burst_at_the_begin_still_starts_at_zero() {
        let kept = tidy(at_ms(&[0, 1, 33, 66, 66]), &mut Vec::new()).unwrap();
        let ms: Vec<u64> = kept.iter().map(|f| f.time_ns / 1_000_000).collect();
        assert_eq!(ms, [0, 32, 65]);
    }

    #[test]
    fn a_clock_that_jumps_hours_is_refused() {
        assert!(tidy(at_ms(&[0, 33, 7_200_001]), &mut Vec::new()).is_err());
    }
}
