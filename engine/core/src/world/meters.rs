//! What the steps of a session came to, for the report.

#[cfg(feature = "meters")]
use hdrhistogram::Histogram;

use crate::cloth::step::measure::Strain;
#[cfg(feature = "meters")]
use crate::meter::Meter;
use crate::meter::STAGES;

/// Longest step that the meter tells apart from a longer one (ns).
#[cfg(feature = "meters")]
const STEP_MAX_NS: u64 = 1_000_000_000;

/// What the steps of a session came to, for the report.
#[derive(Debug, Clone)]
pub struct Meters {
    /// Time of each step, pose to publish (ns).
    #[cfg(feature = "meters")]
    pub step_ns: Histogram<u64>,
    /// Time of each of [`STAGES`] in each step.
    #[cfg(feature = "meters")]
    pub stages: [Meter; STAGES.len()],
    /// Time of each of them in the last step (ns).
    pub last_ns: [u64; STAGES.len()],
    /// Sum over the measured steps of the mean strain.
    strain_sum: f64,
    /// Sum over the measured steps of the 99th percentile of strain.
    strain_p99_sum: f64,
    /// Worst strain of any edge in any measured step (1).
    pub strain_max: f32,
    /// Deepest penetration in any measured step (m).
    pub penetration_max: f32,
    /// Steps whose strain and penetration were measured.
    pub steps: u64,
}

impl Meters {
    pub(super) fn new() -> Self {
        Self {
            // Bounds are constants that the histogram accepts; three digits keep 0.1 % of each value.
            #[cfg(feature = "meters")]
            step_ns: Histogram::new_with_bounds(1, STEP_MAX_NS, 3).expect("constant bounds are valid"),
            #[cfg(feature = "meters")]
            stages: std::array::from_fn(|_| Meter::new()),
            last_ns: [0; STAGES.len()],
            strain_sum: 0.0,
            strain_p99_sum: 0.0,
            strain_max: 0.0,
            penetration_max: 0.0,
            steps: 0,
        }
    }

    /// Forgets all that was metered, allocating nothing.
    pub(super) fn clear(&mut self) {
        #[cfg(feature = "meters")]
        {
            self.step_ns.reset();
            self.stages.iter_mut().for_each(Meter::clear);
        }
        (self.strain_sum, self.strain_p99_sum, self.steps) = (0.0, 0.0, 0);
        (self.strain_max, self.penetration_max) = (0.0, 0.0);
    }

    /// A step whose stages took so long.
    pub(super) fn timed(&mut self, stages_ns: [u64; STAGES.len()]) {
        #[cfg(feature = "meters")]
        {
            self.step_ns.saturating_record(stages_ns.iter().sum::<u64>().min(STEP_MAX_NS));
            self.stages.iter_mut().zip(stages_ns).for_each(|(meter, ns)| meter.add(ns));
        }
        self.last_ns = stages_ns;
    }

    /// The error of a step: the worst garment's strain, the deepest penetration (m).
    pub(super) fn measured(&mut self, worst: Strain, penetration: f32) {
        self.penetration_max = self.penetration_max.max(penetration);
        self.strain_sum += f64::from(worst.mean);
        self.strain_p99_sum += f64::from(worst.p99);
        self.strain_max = self.strain_max.max(worst.max);
        self.steps += 1;
    }

    /// Strain over the session: mean of the means, mean of the 99th percentiles, worst.
    pub fn strain(&self) -> Strain {
        let steps = self.steps.max(1) as f64;
        Strain {
            mean: (self.strain_sum / steps) as f32,
            p99: (self.strain_p99_sum / steps) as f32,
            max: self.strain_max,
        }
    }
}

/// How long each stage of a step took.
pub(super) struct StageTimes {
    pub(super) ns: [u64; STAGES.len()],
    last: u64,
}

impl StageTimes {
    pub(super) fn from(now_ns: u64) -> Self {
        Self { ns: [0; STAGES.len()], last: now_ns }
    }

    /// A stage ends.
    pub(super) fn lap(&mut self, stage: usize, now_ns: u64) {
        self.ns[stage] += now_ns - self.last;
        self.last = now_ns;
    }
}
