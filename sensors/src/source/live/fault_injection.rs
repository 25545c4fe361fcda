//! Faults of cameras, on purpose: every kind that cables, drivers and people bring about, at times that are given.

use std::sync::Arc;
use std::time::Duration;

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, LiveCamera};
use crate::clock::SECOND_NS;

toile_assets::named! {
    /// What may be wrong with a camera.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum CameraFault {
        /// Unplugged: every call fails, and it cannot be opened until the fault is over.
        Unplugged = "unplugged",
        /// Nothing comes, and nothing is said.
        Silent = "silent",
        /// The same frame comes again and again, with new stamps.
        Frozen = "frozen",
        /// The device's clock is an hour behind, then right again.
        ClockBack = "clock an hour behind",
        /// The device's clock is a day ahead, then right again.
        ClockAhead = "clock a day ahead",
        /// Only the upper half of each image comes.
        Half = "half frames",
        /// Every second frame comes: 15 a second in place of 30.
        Slow = "every second frame",
        /// One frame in twenty does not come.
        Lossy = "one frame in twenty lost",
        /// A hand on the lens: frames come, and measure nothing.
        Covered = "hand on the lens",
    }
}

impl CameraFault {
    /// Whether nothing can be seen while it lasts, which has to be noticed and shown.
    pub const fn is_blind(self) -> bool {
        matches!(self, Self::Unplugged | Self::Silent | Self::Frozen | Self::Half | Self::Covered)
    }
}

/// One fault, on the clock of whoever injects it (ns).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimedFault {
    /// What is wrong.
    pub fault: CameraFault,
    /// When it begins (ns).
    pub from_ns: u64,
    /// When it is over (ns).
    pub until_ns: u64,
}

/// Faults in the order of their times.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaultPlan {
    /// The faults, none of which overlap.
    pub faults: Vec<TimedFault>,
}

impl FaultPlan {
    /// What is wrong at a time (ns).
    pub fn at(&self, now_ns: u64) -> Option<CameraFault> {
        let after = self.faults.partition_point(|f| f.from_ns <= now_ns);
        self.faults[..after].last().filter(|f| now_ns < f.until_ns).map(|f| f.fault)
    }
}

/// The time on the clock of whoever injects (ns).
pub type FaultClock = Arc<dyn Fn() -> u64 + Send + Sync>;

/// A camera with faults.
pub struct FaultyCamera<C> {
    camera: C,
    plan: Arc<FaultPlan>,
    clock: FaultClock,
    /// What a frozen camera shows.
    last: Vec<u16>,
    count: u64,
}

impl<C: LiveCamera> FaultyCamera<C> {
    /// This camera with these faults.
    ///
    /// # Errors
    /// Where it is unplugged just now.
    pub fn open(camera: C, plan: Arc<FaultPlan>, clock: FaultClock) -> Result<Self, CameraError> {
        if plan.at(clock()) == Some(CameraFault::Unplugged) {
            return Err(unplugged());
        }
        Ok(Self { camera, plan, clock, last: Vec::new(), count: 0 })
    }

    /// Spoils a frame; says whether it still comes.
    fn spoil(&mut self, fault: CameraFault, frame: &mut CameraFrame) -> bool {
        match fault {
            CameraFault::Unplugged | CameraFault::Silent => return false,
            CameraFault::Slow => return self.count.is_multiple_of(2),
            CameraFault::Lossy => return !self.count.is_multiple_of(20),
            CameraFault::Frozen => frame.depth.clone_from(&self.last),
            CameraFault::ClockBack => frame.device_ns = frame.device_ns.saturating_sub(3_600 * SECOND_NS),
            CameraFault::ClockAhead => frame.device_ns += 86_400 * SECOND_NS,
            CameraFault::Half => frame.depth.truncate(frame.depth.len() / 2),
            CameraFault::Covered => frame.depth.fill(0),
        }
        true
    }
}

fn unplugged() -> CameraError {
    CameraError::NotConnected { camera: "camera with injected faults", cure: "wait until the fault is over" }
}

impl<C: LiveCamera> LiveCamera for FaultyCamera<C> {
    fn info(&self) -> &CameraInfo {
        self.camera.info()
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        let fault = self.plan.at((self.clock)());
        if fault == Some(CameraFault::Unplugged) {
            return Err(unplugged());
        }
        let arrival = self.camera.read(frame, patience)?;
        if arrival != Arrival::Frame {
            return Ok(arrival);
        }
        self.count += 1;
        let comes = fault.is_none_or(|fault| self.spoil(fault, frame));
        if fault != Some(CameraFault::Frozen) || self.last.is_empty() {
            self.last.clone_from(&frame.depth);
        }
        Ok(if comes { Arrival::Frame } else { Arrival::Nothing })
    }
}
