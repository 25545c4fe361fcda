//! Look of each triangle to each camera, taken in the first frame in which it was seen, and the agreement of two cameras.

use serde::{Deserialize, Serialize};

use super::residual::{PatchSums, Tone};
use super::settings::Reference;
use super::state::{FlowState, SEEN};
use crate::plane::Pyramid;

/// Standard deviation of a print below which correlation says nothing (of 255).
pub(super) const PRINTED: f32 = 6.0;

/// How the mesh fits the pictures of the first frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FirstFrame {
    /// Mean correlation of a triangle's pictures in two cameras, -1 to 1.
    pub agreement: f32,
    /// Root mean square difference of them after their brightness is adjusted (of 255).
    pub residual: f32,
    /// Pairs of a triangle's pictures that were compared.
    pub pairs: usize,
}

impl FlowState {
    /// Takes what cameras see now as reference, where there is none yet or the frame before is the reference.
    pub fn take_references(&mut self, pyramids: &[Pyramid], frame: u32) {
        let always = self.settings.reference == Reference::Previous;
        for (c, pyramid) in pyramids.iter().enumerate() {
            let open: Vec<bool> = self.taken[c].iter().map(|t| always || t.is_none()).collect();
            if !open.contains(&true) {
                continue;
            }
            for level in (0..self.settings.levels.min(pyramid.levels.len())).rev() {
                self.take_level(c, pyramid, level, &open, frame);
            }
        }
    }

    fn take_level(&mut self, c: usize, pyramid: &Pyramid, level: usize, open: &[bool], frame: u32) {
        let mask = self.mask(c, level, false);
        let view = self.view(c, pyramid, level);
        let channels = self.settings.channels;
        let always = self.settings.reference == Reference::Previous;
        let samples = &mut self.levels[level];
        for (t, corners) in self.surface.triangles.iter().enumerate().filter(|(t, _)| open[*t]) {
            let range = samples.starts[t]..samples.starts[t + 1];
            let seen: f32 = mask[range.clone()].iter().sum();
            let enough = seen >= SEEN * range.len() as f32;
            if !enough {
                samples.known[c][range].fill(0.0);
                continue;
            }
            let axes = corners.map(|v| view.axes(self.positions[v as usize]));
            for k in range {
                let value = (mask[k] > 0.0).then(|| view.values(axes, samples.shares[k])).flatten();
                samples.known[c][k] = f32::from(u8::from(value.is_some()));
                if let Some(value) = value {
                    samples.seen[c][k * channels..(k + 1) * channels].copy_from_slice(&value[..channels]);
                }
            }
            if level == 0 {
                self.taken[c][t] = Some(frame);
                self.sides[c][t] = self.views[c].facing[t];
                if always {
                    self.tones[c][t] = Tone::SAME;
                }
            }
        }
    }

    /// How well the references of any two cameras agree: they do where the mesh lies on the surface that was filmed.
    pub fn agreement(&self) -> FirstFrame {
        let (samples, channels) = (&self.levels[0], self.settings.channels);
        let (mut sum, mut squares, mut pairs) = (0.0, 0.0, 0usize);
        for a in 0..self.cameras.len() {
            for b in a + 1..self.cameras.len() {
                for t in 0..self.surface.triangles.len() {
                    let both = compare(
                        [&samples.seen[a], &samples.seen[b]],
                        [&samples.known[a], &samples.known[b]],
                        samples.starts[t]..samples.starts[t + 1],
                        channels,
                    );
                    let enough = both.count >= SEEN * (samples.starts[t + 1] - samples.starts[t]) as f32;
                    let (correlation, print) = both.agreement(channels);
                    if enough && print >= PRINTED {
                        sum += correlation;
                        squares += difference(&both, channels);
                        pairs += 1;
                    }
                }
            }
        }
        let n = pairs.max(1) as f32;
        FirstFrame { agreement: sum / n, residual: (squares / n).sqrt(), pairs }
    }
}

fn compare([a, b]: [&[f32]; 2], known: [&[f32]; 2], range: std::ops::Range<usize>, channels: usize) -> PatchSums {
    let mut sums = PatchSums::NONE;
    for k in range {
        if known[0][k] * known[1][k] > 0.0 {
            sums.count += 1.0;
            for c in 0..channels {
                let (i, t) = (a[k * channels + c], b[k * channels + c]);
                for (m, v) in sums.moments.iter_mut().zip([i, t, i * i, i * t, t * t]) {
                    *m += v;
                }
            }
        }
    }
    sums
}

/// Mean square of what is left after the brightness is adjusted.
fn difference(sums: &PatchSums, channels: usize) -> f32 {
    let (g, o) = (sums.tone(channels).gain, sums.tone(channels).offset);
    let n = sums.count * channels as f32;
    let [i, t, ii, it, tt] = sums.moments.map(|m| m / n);
    (g * g * ii + o * o + tt + 2.0 * (g * o * i - g * it - o * t)).max(0.0)
}
