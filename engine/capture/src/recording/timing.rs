//! Cameras out of step: found by the amount of motion in each camera's pictures, frame by frame.
//!
//! A thing that moves before one camera moves before the others at the same time. The mean change of each camera's pictures is correlated
//! with that of all others, shifted by some frames; a shift that agrees clearly better than none is reported.

use std::fmt;

use image::RgbImage;

/// Farthest shift that is looked for (frames).
const FARTHEST: isize = 8;

/// Fewest frames by which cameras can be told apart.
const FEWEST: usize = 24;

/// A shift has to correlate at least so much, and so much better than none.
const LEAST: f64 = 0.5;
const BETTER: f64 = 0.15;

/// Change of a pixel that noise explains (of 255).
const NOISE: u8 = 8;

/// One pixel in so many, in rows and columns, is compared.
const THINNED: usize = 4;

/// A camera whose pictures come earlier or later than those of the others.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfStep {
    /// The camera, in the order of the calibration.
    pub camera: usize,
    /// Frames that it comes late; early where negative.
    pub late: isize,
    /// Correlation with the others as it is, and shifted.
    pub agreement: [f64; 2],
}

impl fmt::Display for OutOfStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (by, word) = (self.late.unsigned_abs(), if self.late > 0 { "late" } else { "early" });
        let [now, shifted] = self.agreement;
        write!(
            f,
            "its pictures come {by} frames {word} (their motion correlates {shifted:.2} with the others' when shifted, {now:.2} \
             as it is)"
        )
    }
}

/// How much changes from one picture to the next, of 255.
pub fn change(before: &RgbImage, now: &RgbImage) -> f64 {
    let width = before.width() as usize * 3;
    let rows = before.as_raw().chunks_exact(width).zip(now.as_raw().chunks_exact(width)).step_by(THINNED);
    let (mut sum, mut count) = (0u64, 0u64);
    for (a, b) in rows {
        // Green alone: it has the least noise.
        for (a, b) in a.iter().skip(1).step_by(3 * THINNED).zip(b.iter().skip(1).step_by(3 * THINNED)) {
            sum += u64::from(a.abs_diff(*b).saturating_sub(NOISE));
            count += 1;
        }
    }
    sum as f64 / count.max(1) as f64
}

/// The camera that is most out of step, by the changes of each camera `[cameras][frames]`; none where they agree as they are.
pub fn in_step(changes: &[Vec<f64>]) -> Option<OutOfStep> {
    let frames = changes.iter().map(Vec::len).min()?;
    if frames < FEWEST || changes.len() < 2 {
        return None;
    }
    let mut worst: Option<OutOfStep> = None;
    for (camera, own) in changes.iter().enumerate() {
        let others = |f: usize| {
            let rest = changes.iter().enumerate().filter(|(k, _)| *k != camera);
            rest.map(|(_, c)| c[f] / mean(c)).sum::<f64>()
        };
        let others: Vec<f64> = (0..frames).map(others).collect();
        let at = |shift| correlation(&own[..frames], &others, shift);
        let none = at(0);
        // The smaller of equal shifts.
        let mut order: Vec<isize> = (-FARTHEST..=FARTHEST).collect();
        order.sort_by_key(|s| s.abs());
        let best = order.into_iter().map(|s| (s, at(s))).fold((0, none), |b, c| if c.1 > b.1 + 1e-9 { c } else { b });
        let (late, shifted) = best;
        if shifted > LEAST && shifted > none + BETTER {
            let found = OutOfStep { camera, late, agreement: [none, shifted] };
            let gain = |o: &OutOfStep| o.agreement[1] - o.agreement[0];
            if worst.as_ref().is_none_or(|w| gain(&found) > gain(w)) {
                worst = Some(found);
            }
        }
    }
    worst
}

fn mean(values: &[f64]) -> f64 {
    (values.iter().sum::<f64>() / values.len().max(1) as f64).max(1e-9)
}

/// Correlation of `own` moved back by `shift` frames with `others`.
fn correlation(own: &[f64], others: &[f64], shift: isize) -> f64 {
    let pairs = || (0..others.len()).filter_map(move |f| Some((*own.get(f.checked_add_signed(shift)?)?, others[f])));
    let n = pairs().count() as f64;
    let (a, b) = pairs().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in pairs() {
        xx += (x - a) * (x - a);
        xy += (x - a) * (y - b);
        yy += (y - b) * (y - b);
    }
    xy / (xx * yy).sqrt().max(1e-12)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(frame: f64) -> f64 {
        2.0 + (frame * 0.5).sin() + 0.7 * (frame * 0.21 + 1.0).sin() + 0.4 * (frame * 1.1).cos()
    }

    #[test]
    fn a_camera_that_comes_late_is_found_and_others_are_not() {
        let with = |late: [f64; 3]| late.map(|l| (0..60).map(|f| motion(f as f64 - l) * 3.0).collect::<Vec<_>>());
        assert_eq!(in_step(&with([0.0; 3])), None);
        for late in [3.0, -2.0] {
            let found = in_step(&with([0.0, late, 0.0])).unwrap();
            assert_eq!((found.camera, found.late as f64), (1, late));
        }
        assert!(in_step(&with([0.0, 4.0, 0.0])).unwrap().to_string().contains("4 frames late"));
    }
}
