//! Times and counts of the physics thread.

use super::quality_control::QUALITY_LEVELS;
use crate::meter::Meter;

/// Times and counts of the loop, beside the world's own stages; all times in ns of the loop's clock.
#[derive(Debug, Clone, Default)]
pub struct LoopMeters {
    /// From when a step was due until it began; of steps that were dropped, until the next began.
    pub late: Meter,
    /// Time to take in sensor frames and other inputs.
    pub intake: Meter,
    /// From begin to publication.
    pub step: Meter,
    /// From when a step was due until it was published, dropped ones included: corrected for coordinated omission.
    pub response: Meter,
    /// From a sensor frame's arrival to the begin of the first step that knew it.
    pub wait: Meter,
    /// From a sensor frame's arrival to the publication of the first snapshot that knew it.
    pub reaction: Meter,
    /// Steps that were taken.
    pub steps: u64,
    /// Steps that were dropped.
    pub dropped: u64,
    /// Steps that were published after their period.
    pub missed: u64,
    /// Steps on each quality level.
    pub level_steps: [u64; QUALITY_LEVELS.len()],
    /// Sensor frames that were overwritten before a step looked.
    pub skipped: u64,
}

impl LoopMeters {
    /// Forgets everything, allocating nothing.
    pub(super) fn clear(&mut self) {
        let Self { late, intake, step, response, wait, reaction, .. } = self;
        [late, intake, step, response, wait, reaction].into_iter().for_each(Meter::clear);
        (self.steps, self.dropped, self.missed, self.skipped) = (0, 0, 0, 0);
        self.level_steps = [0; QUALITY_LEVELS.len()];
    }
}
