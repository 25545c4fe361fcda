//! Faults of cameras, on purpose: every kind that cables, drivers and people bring about, at times that are given.

use std::sync::Arc;
use std::time::Duration;

use glam::Affine3A;
use toile_base::numeric::random::SplitMix64;

use super::error::CameraError;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, ColourPlace, LiveCamera};
use crate::source::camera::DepthCamera;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{Intrinsics, Joints};

toile_base::named! {
    /// Faults of a camera.
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

/// One fault, on the injector's clock (ns).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimedFault {
    /// The fault.
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
    /// The fault at a time (ns).
    pub fn at(&self, now_ns: u64) -> Option<CameraFault> {
        let after = self.faults.partition_point(|f| f.from_ns <= now_ns);
        self.faults[..after].last().filter(|f| now_ns < f.until_ns).map(|f| f.fault)
    }
}

/// The time on the injector's clock (ns).
pub type FaultClock = Arc<dyn Fn() -> u64 + Send + Sync>;

/// A camera with faults.
pub struct FaultyCamera<C> {
    camera: C,
    plan: Arc<FaultPlan>,
    clock: FaultClock,
    /// The image of a frozen camera.
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

/// Images of a simulated camera (px): small, for hours of them are looked at.
const SIMULATED: Intrinsics = Intrinsics { width: 40, height: 30, fx: 36.0, fy: 36.0, cx: 19.5, cy: 14.5 };

/// Frames a second of a simulated camera (Hz).
const SIMULATED_HZ: u64 = 30;

/// What the simulated device's own clock shows when ours shows nothing (ns): two days.
const DEVICE_BEGIN_NS: u64 = 2 * 86_400 * SECOND_NS;

/// From when a frame is taken until it arrives (ns).
const DELAY_NS: u64 = 15_000_000;

/// A camera that looks at a wall, on a clock that is moved by hand: each frame has noise of its own.
pub struct SimulatedCamera {
    info: CameraInfo,
    clock: FaultClock,
    /// The next frame, by its number since the clock's begin.
    next: u64,
    /// What it is to see of people at a time (ns), in its own axes.
    people: Option<Box<dyn FnMut(u64) -> Option<Joints> + Send>>,
}

impl SimulatedCamera {
    /// At this place in our world; its first frame is that of now.
    pub fn new(clock: FaultClock, pose: Affine3A) -> Self {
        let info = CameraInfo {
            device: "simulated camera".to_owned(),
            camera: DepthCamera::pinhole(SIMULATED),
            rate_hz: SIMULATED_HZ as f32,
            placed: Some(pose),
            colour: ColourPlace::Unknown,
        };
        let next = clock() * SIMULATED_HZ / SECOND_NS + 1;
        Self { info, clock, next, people: None }
    }

    /// The same, which tracks joints by itself.
    #[must_use]
    pub fn seeing(self, people: Box<dyn FnMut(u64) -> Option<Joints> + Send>) -> Self {
        Self { people: Some(people), ..self }
    }
}

impl LiveCamera for SimulatedCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, _: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let taken_ns = self.next * SECOND_NS / SIMULATED_HZ;
        let now = (self.clock)();
        if now < taken_ns + DELAY_NS {
            return Ok(Arrival::Nothing);
        }
        // An unread frame is overwritten, as in any camera.
        self.next = self.next.max((now - DELAY_NS) * SIMULATED_HZ / SECOND_NS) + 1;
        frame.device_ns = DEVICE_BEGIN_NS + taken_ns;
        let noise = SplitMix64::new(taken_ns).next_u64();
        frame
            .depth
            .extend((0..SIMULATED.pixels() as u64).map(|i| 2_000 + ((i * 7).wrapping_add(noise) % 1_009) as u16));
        frame.people.extend(self.people.as_mut().and_then(|people| people(taken_ns)));
        Ok(Arrival::Frame)
    }
}
