//! Camera: the joints of the shopper from a sensor of 30 Hz, and their faults.

use std::sync::Arc;

use glam::Vec3;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::numeric::random::SplitMix64;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::sensor_thread::{FrameSource, SourceFrame};

use super::fault_kind::FaultKind;
use super::scenario::{CAMERA_HZ, Scenario, SoakFault};

/// From a frame's stamp to its arrival (ns).
const DELAY_NS: u64 = 20_000_000;

/// Noise of a joint (m).
pub(super) const NOISE_M: f32 = 0.002;

/// Frames that wait in the camera while nothing reads them; older ones are lost.
const WAITING: u64 = 4;

/// What a stamp of another day is off by (ns).
const DAY_NS: u64 = 86_400 * SECOND_NS;

/// Where another person stands (m).
const BESIDE_M: Vec3 = Vec3::new(0.7, 0.0, -0.4);

/// A simulated camera that plays the scenario's visits, with its faults.
#[derive(Debug)]
pub struct ScenarioCamera<C> {
    scenario: Arc<Scenario>,
    clock: C,
    origin_ns: u64,
    next: u64,
}

impl<C: Clock> ScenarioCamera<C> {
    /// One whose first frame is of this time on the loop's clock (ns).
    pub fn new(scenario: Arc<Scenario>, clock: C, origin_ns: u64) -> Self {
        Self { scenario, clock, origin_ns, next: 0 }
    }

    /// What is seen in a frame, in time since the run's begin.
    fn seen(&self, frame: u64) -> Joints {
        let ns = stamp(frame);
        let mut joints = Joints::absent(ns);
        if let Some(visit) = self.scenario.visit_at(ns) {
            let mut rng = SplitMix64::new(self.scenario.plan.seed ^ frame);
            let mut noise = || NOISE_M * rng.gaussian();
            for (to, at) in joints.joints.iter_mut().zip(visit.joints(ns)) {
                let position = at + Vec3::new(noise(), noise(), noise());
                *to = TrackedJoint { position, confidence: 1.0 };
            }
        }
        joints
    }

    /// The same frame when something is wrong; none where none comes.
    fn spoilt(&self, frame: u64, fault: &SoakFault) -> Option<Joints> {
        let ns = stamp(frame);
        let mut rng = SplitMix64::new(self.scenario.plan.seed ^ !frame);
        Some(match fault.kind {
            FaultKind::CameraLost => return None,
            FaultKind::Frozen => Joints { time_ns: ns, ..self.seen(fault.from_ns.div_ceil(SECOND_NS / CAMERA_HZ)) },
            FaultKind::Repeated => self.seen(frame - frame % 4),
            FaultKind::OutOfOrder => self.seen(frame ^ 1),
            FaultKind::NanJoints | FaultKind::Infinite => {
                let values = if fault.kind == FaultKind::NanJoints {
                    [f32::NAN; 3]
                } else {
                    [f32::INFINITY, -1e30, f32::NEG_INFINITY]
                };
                let mut joints = self.seen(frame);
                for joint in &mut joints.joints {
                    if rng.uniform() < 0.5 {
                        let axis = rng.next_u64() as usize % 3;
                        joint.position[axis] = values[axis];
                    }
                }
                joints
            }
            FaultKind::Swapped => {
                let (mut joints, scenario) = (self.seen(frame), &self.scenario);
                let other = &scenario.visits[rng_place(fault, scenario.visits.len())];
                let at = other.joints(other.from_ns + ns % (5 * SECOND_NS));
                for (to, at) in joints.joints.iter_mut().zip(at) {
                    *to = TrackedJoint { position: at + BESIDE_M, confidence: 1.0 };
                }
                joints
            }
            _ => self.seen(frame),
        })
    }
}

/// Picks one of `count` people, the same for as long as the fault lasts.
fn rng_place(fault: &SoakFault, count: usize) -> usize {
    SplitMix64::new(fault.from_ns).next_u64() as usize % count
}

/// When a frame is taken, since the begin (ns).
fn stamp(frame: u64) -> u64 {
    frame / CAMERA_HZ * SECOND_NS + frame % CAMERA_HZ * SECOND_NS / CAMERA_HZ
}

impl<C: Clock + Send> FrameSource for ScenarioCamera<C> {
    fn next_ns(&self) -> Option<u64> {
        Some(self.origin_ns + stamp(self.next) + DELAY_NS)
    }

    fn read(&mut self) -> Option<SourceFrame> {
        // Unread frames are overwritten.
        let since = self.clock.now_ns().saturating_sub(self.origin_ns + DELAY_NS);
        let newest = since / SECOND_NS * CAMERA_HZ + since % SECOND_NS * CAMERA_HZ / SECOND_NS;
        if newest > self.next + WAITING {
            self.next = newest;
        }
        let frame = self.next;
        self.next += 1;
        let fault = self.scenario.fault_at(stamp(frame)).copied();
        let joints = match fault {
            Some(fault) => self.spoilt(frame, &fault)?,
            None => self.seen(frame),
        };
        let at = self.origin_ns + joints.time_ns;
        let time_ns = match fault.map(|f| f.kind) {
            Some(FaultKind::StampsAhead) => at + DAY_NS,
            Some(FaultKind::StampsBehind) => at.saturating_sub(DAY_NS),
            _ => at,
        };
        Some(Joints { time_ns, ..joints }.into())
    }
}
