//! A depth camera that fails, with all that stands between it and the joints but the fit: the checks of its frames, its clock on the
//! loop's, the pool of its images, the opening anew. On the simulated clock the camera is a loop beside the others; on the system's it
//! has the two threads of a kiosk, the tracker's among them.

use std::sync::Arc;
use std::sync::atomic::AtomicU8;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::Duration;

use glam::{Affine3A, Vec3};
use toile_base::body::Sex;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Joints, TrackedJoint};
use toile_base::numeric::random::SplitMix64;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::sensor_thread::{DepthImage, FrameSource, SourceFrame};
use toile_engine::triple_buffer::{Reader, TripleBuffer, Writer};
use toile_fitting::live::depth_camera::{self, CameraFeed, TrackerOptions};
use toile_sensors::segment::Zone;
use toile_sensors::source::live::fault_injection::{FaultClock, FaultPlan, FaultyCamera, SimulatedCamera, TimedFault};
use toile_sensors::source::live::{
    Arrival, CameraError, CameraFrame, CameraInfo, CameraOpener, CameraState, LiveCamera, LiveDepth,
};

use super::camera::{NOISE_M, ScenarioCamera};
use super::error::SoakError;
use super::scenario::Scenario;

/// Time between two looks of the camera and of the sensor thread (ns): half a step.
const LOOK_NS: u64 = SECOND_NS / 240;

/// Images that the loop and those behind it hold at once: its queues, drained ten times a second, and room to spare.
const HELD: usize = 32;

/// How long a simulated camera on the system's clock waits where nothing has come.
const PAUSE: Duration = Duration::from_millis(2);

/// Tells how the camera stands.
pub type CameraWatch = Box<dyn Fn() -> CameraState + Send>;

/// What the sensor thread of a soak reads.
#[derive(Debug)]
pub enum SoakSource<C> {
    /// Joints of a sensor.
    Joints(ScenarioCamera<C>),
    /// A depth camera on the simulated clock.
    Simulated(DepthSource<C>),
    /// A depth camera with the threads of a kiosk.
    Live(CameraFeed),
}

impl<C: Clock + Send> FrameSource for SoakSource<C> {
    fn next_ns(&self) -> Option<u64> {
        match self {
            Self::Joints(camera) => camera.next_ns(),
            Self::Simulated(source) => source.next_ns(),
            Self::Live(feed) => feed.next_ns(),
        }
    }

    fn read(&mut self) -> Option<SourceFrame> {
        match self {
            Self::Joints(camera) => camera.read(),
            Self::Simulated(source) => source.read(),
            Self::Live(feed) => feed.read(),
        }
    }
}

/// A frame of the camera on its way to the sensor thread.
#[derive(Debug, Clone)]
struct DepthNews {
    frame: Arc<DepthFrame>,
    joints: Joints,
    arrived_ns: u64,
}

/// The end that the sensor thread reads on the simulated clock.
#[derive(Debug)]
pub struct DepthSource<C> {
    reader: Reader<Option<DepthNews>>,
    clock: C,
    next_ns: u64,
}

impl<C: Clock> DepthSource<C> {
    fn next_ns(&self) -> Option<u64> {
        Some(self.next_ns)
    }

    fn read(&mut self) -> Option<SourceFrame> {
        self.next_ns = self.clock.now_ns() + LOOK_NS;
        let DepthNews { frame, joints, arrived_ns } = self.reader.news()?.clone()?;
        let depth: Arc<dyn DepthImage> = frame;
        Some(SourceFrame { joints, depth: Some(depth), others: (0, false), arrived_ns: Some(arrived_ns) })
    }
}

/// The camera's thread on the simulated clock.
pub struct CameraLoop<C> {
    depth: LiveDepth,
    clock: C,
    writer: Writer<Option<DepthNews>>,
    state: Arc<AtomicU8>,
}

impl<C: Clock> ThreadLoop for CameraLoop<C> {
    fn run_due(&mut self) -> Option<u64> {
        let update = self.depth.poll(&|| self.clock.now_ns(), Duration::ZERO);
        self.state.store(update.state as u8, Relaxed);
        if let Some(frame) = update.frame {
            let joints = self.depth.people().first().copied().unwrap_or_else(|| Joints::absent(frame.time_ns));
            let arrived_ns = update.arrived_ns.unwrap_or(frame.time_ns);
            self.writer.publish(Some(DepthNews { frame, joints, arrived_ns }));
        }
        Some(self.clock.now_ns() + LOOK_NS)
    }
}

/// The camera of a scenario on the simulated clock: its loop, what the sensor thread reads, and who tells how it stands. At load.
///
/// # Errors
/// A camera that cannot be opened.
pub fn simulated<C>(
    scenario: &Arc<Scenario>,
    clock: &C,
    origin_ns: u64,
) -> Result<(CameraLoop<C>, SoakSource<C>, CameraWatch), SoakError>
where
    C: Clock + Clone + Send + Sync + 'static,
{
    let depth = LiveDepth::open(opener(scenario, clock, origin_ns, false), HELD, clock.now_ns())?;
    let TripleBuffer { writer, reader } = TripleBuffer::new(&None);
    let state = Arc::new(AtomicU8::new(CameraState::Starting as u8));
    let shown = state.clone();
    let watch: CameraWatch = Box::new(move || CameraState::ALL[usize::from(shown.load(Relaxed))]);
    let source = DepthSource { reader, clock: clock.clone(), next_ns: clock.now_ns() };
    Ok((CameraLoop { depth, clock: clock.clone(), writer, state }, SoakSource::Simulated(source), watch))
}

/// The same with the threads of a kiosk. At load.
///
/// # Errors
/// A camera that cannot be opened, and threads that the system does not give.
pub fn live<C>(scenario: &Arc<Scenario>, clock: &C, origin_ns: u64) -> Result<(SoakSource<C>, CameraWatch), SoakError>
where
    C: Clock + Clone + Send + Sync + 'static,
{
    let depth = LiveDepth::open(opener(scenario, clock, origin_ns, true), HELD, clock.now_ns())?;
    let options = TrackerOptions { zone: Zone::default(), sex: Sex::Female };
    let (feed, handle) = depth_camera::start(depth, clock.clone(), options, None)?;
    Ok((SoakSource::Live(feed), Box::new(move || handle.figures().state)))
}

/// Opens the scenario's camera, at first and whenever it was gone.
fn opener<C>(scenario: &Arc<Scenario>, clock: &C, origin_ns: u64, paced: bool) -> CameraOpener
where
    C: Clock + Clone + Send + Sync + 'static,
{
    let plan = Arc::new(plan(scenario, origin_ns));
    let now: FaultClock = {
        let clock = clock.clone();
        Arc::new(move || clock.now_ns())
    };
    let scenario = scenario.clone();
    Box::new(move || {
        let seen = scenario.clone();
        let people = Box::new(move |ns| Some(joints(&seen, ns, origin_ns)));
        let camera = SimulatedCamera::new(now.clone(), Affine3A::IDENTITY).seeing(people);
        let camera = FaultyCamera::open(camera, plan.clone(), now.clone())?;
        Ok(if paced { Box::new(Paced(camera)) } else { Box::new(camera) as Box<dyn LiveCamera> })
    })
}

/// The scenario's faults of the camera, on the loop's clock.
fn plan(scenario: &Scenario, origin_ns: u64) -> FaultPlan {
    let timed = scenario.faults.iter().filter_map(|fault| {
        let [from_ns, until_ns] = [fault.from_ns, fault.until_ns].map(|ns| origin_ns + ns);
        Some(TimedFault { fault: fault.kind.camera_fault()?, from_ns, until_ns })
    });
    FaultPlan { faults: timed.collect() }
}

/// Joints of the shopper in view at a time of the loop's clock, with noise.
fn joints(scenario: &Scenario, taken_ns: u64, origin_ns: u64) -> Joints {
    let (ns, mut joints) = (taken_ns.saturating_sub(origin_ns), Joints::absent(taken_ns));
    if let Some(visit) = scenario.visit_at(ns) {
        let mut rng = SplitMix64::new(scenario.plan.seed ^ taken_ns);
        let mut noise = || NOISE_M * rng.gaussian();
        for (to, at) in joints.joints.iter_mut().zip(visit.joints(ns)) {
            *to = TrackedJoint { position: at + Vec3::new(noise(), noise(), noise()), confidence: 1.0 };
        }
    }
    joints
}

/// A simulated camera on the system's clock, whose calls wait as those of a device do.
struct Paced<C>(FaultyCamera<C>);

impl<C: LiveCamera> LiveCamera for Paced<C> {
    fn info(&self) -> &CameraInfo {
        self.0.info()
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        let arrival = self.0.read(frame, patience)?;
        if arrival == Arrival::Nothing {
            thread::sleep(patience.min(PAUSE));
        }
        Ok(arrival)
    }
}
