//! A live depth camera in the loop. Between it and the sensor thread stand two threads: one waits for the camera, one finds the
//! shopper and fits the body, which takes up to an eighth of a second. Each hands on the latest value; neither the sensor thread nor a
//! step ever waits for them.
//!
//! The frames that a shopper is measured from are gathered beside that, shared and not copied. A mutex guards them, which only the
//! tracker's thread and the measuring thread take: no thread of the loop does.

use std::io;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use toile_base::body::Sex;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Joints};
use toile_engine::clock::Clock;
use toile_engine::frame_loop::sensor_thread::{DepthImage, FrameSource, SourceFrame};
use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::meter::Meter;
use toile_engine::triple_buffer::{Reader, TripleBuffer, Writer};
use toile_sensors::segment::Zone;
use toile_sensors::source::live::{LiveDepth, PATIENCE_NS};
use toile_track::fit::FitOptions;
use toile_track::fit::tracker::{BodyTracker, Company};

pub use super::camera_handle::{CameraFigures, CameraHandle, GATHERED};
use super::own_picture::{self, PictureReceiver, PictureSender};

/// Time between two looks of the sensor thread (ns): half a step, so that no frame waits for longer.
const LOOK_NS: u64 = SECOND_NS / 240;

/// Longest that the tracker sleeps without being woken: so soon it sees that it is to end.
const NAP: Duration = Duration::from_millis(50);

/// A frame of the camera on its way to the tracker.
#[derive(Debug, Clone)]
struct CameraNews {
    frame: Arc<DepthFrame>,
    /// Joints of the person whom the camera itself tracks, if any.
    joints: Option<Joints>,
    arrived_ns: u64,
}

/// A frame that was looked at, on its way to the sensor thread.
#[derive(Debug, Clone)]
pub(super) struct TrackedFrame {
    /// Its depth, where the camera has any.
    pub frame: Option<Arc<DepthFrame>>,
    pub joints: Joints,
    pub company: Company,
    pub arrived_ns: u64,
}

/// How the shopper is found and followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackerOptions {
    /// Where a shopper stands.
    pub zone: Zone,
    /// The body model that is fitted first.
    pub sex: Sex,
}

/// Times of the camera's two threads.
#[derive(Debug, Default)]
pub struct CameraMeters {
    /// From the arrival of a frame until it was looked at, by frames in which a person was followed.
    pub followed: Meter,
    /// The same where a person was found for the first time, or none was.
    pub found: Meter,
}

/// The threads of a camera, ended when dropped.
#[derive(Debug)]
pub struct CameraThreads {
    handle: CameraHandle,
    camera: Option<JoinHandle<()>>,
    tracker: Option<JoinHandle<CameraMeters>>,
}

impl CameraThreads {
    /// One thread, which waits for the camera and looks at what comes.
    pub(super) fn one(handle: CameraHandle, tracker: JoinHandle<CameraMeters>) -> Self {
        Self { handle, camera: None, tracker: Some(tracker) }
    }

    /// Ends them; gives how long the tracker took.
    pub fn end(mut self) -> CameraMeters {
        self.stop().unwrap_or_default()
    }

    fn stop(&mut self) -> Option<CameraMeters> {
        self.handle.stop();
        if let Some(camera) = self.camera.take() {
            let _ = camera.join();
        }
        let tracker = self.tracker.take()?;
        tracker.thread().unpark();
        tracker.join().ok()
    }
}

impl Drop for CameraThreads {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Starts the threads of a camera that is open. Gives what the sensor thread reads, and what others ask.
///
/// # Errors
/// Where the system gives no thread.
pub fn start<C>(
    depth: LiveDepth,
    clock: C,
    options: TrackerOptions,
    pictures: Option<PictureSender>,
) -> io::Result<(CameraFeed, CameraHandle)>
where
    C: Clock + Clone + Send + 'static,
{
    let handle = CameraHandle::new();
    handle.follow(options.sex);
    let TripleBuffer { writer: news, reader: seen } = TripleBuffer::new(&None);
    let TripleBuffer { writer: tracked, reader } = TripleBuffer::new(&None);
    let (colours, pictures) =
        pictures.map(|own| (own.relay(), own)).map_or((None, None), |((to, from), own)| (Some(to), Some((from, own))));
    let meters = CameraMeters::default();
    let watcher = Tracking { handle: handle.clone(), clock: clock.clone(), options, meters, pictures };
    let track = move || {
        thread_roles::apply(ThreadRole::Camera);
        watcher.run(seen, tracked)
    };
    let tracker = thread::Builder::new().name("toile-tracker".into()).spawn(track)?;
    let (woken, shared, own) = (tracker.thread().clone(), handle.clone(), clock.clone());
    let wait = move || {
        thread_roles::apply(ThreadRole::Camera);
        wait_for_frames((depth, colours), &own, &shared, news, &woken);
    };
    let camera = thread::Builder::new().name("toile-camera".into()).spawn(wait)?;
    let threads = CameraThreads { handle: handle.clone(), camera: Some(camera), tracker: Some(tracker) };
    Ok((CameraFeed::new(reader, threads, clock), handle))
}

/// What the camera thread runs.
fn wait_for_frames<C: Clock>(
    (mut depth, mut colours): (LiveDepth, Option<PictureSender>),
    clock: &C,
    handle: &CameraHandle,
    mut news: Writer<Option<CameraNews>>,
    tracker: &thread::Thread,
) {
    let patience = Duration::from_nanos(PATIENCE_NS);
    while !handle.is_over() {
        let update = depth.poll(&|| clock.now_ns(), patience);
        handle.publish(update.state, depth.counts());
        if handle.takes_wipe() {
            depth.wipe();
            colours.iter_mut().for_each(PictureSender::forget);
        }
        match update.frame {
            Some(frame) => {
                handle.set_colour(depth.colour());
                if let Some(colours) = colours.as_mut().filter(|_| depth.colour().width > 0) {
                    colours.send(|seen| {
                        (seen.taken_ns, seen.camera) = (frame.time_ns, depth.colour_camera());
                        own_picture::copy(depth.colour(), &mut seen.picture);
                    });
                }
                handle.set_notes(depth.notes());
                let arrived_ns = update.arrived_ns.unwrap_or(frame.time_ns);
                news.publish(Some(CameraNews { frame, joints: depth.people().first().copied(), arrived_ns }));
                tracker.unpark();
            }
            None if update.is_closed => thread::sleep(patience),
            None => {}
        }
        colours.iter_mut().filter(|c| !c.is_on()).for_each(PictureSender::wipe);
    }
}

/// What the tracker's thread runs.
struct Tracking<C> {
    handle: CameraHandle,
    clock: C,
    options: TrackerOptions,
    meters: CameraMeters,
    /// Colour images as they come, and where they go on to with their joints.
    pictures: Option<(PictureReceiver, PictureSender)>,
}

impl<C: Clock> Tracking<C> {
    fn run(mut self, mut news: Reader<Option<CameraNews>>, mut out: Writer<Option<TrackedFrame>>) -> CameraMeters {
        let mut sex = self.options.sex;
        let mut tracker = BodyTracker::new(sex, self.options.zone, FitOptions::LIVE);
        while !self.handle.is_over() {
            let Some(CameraNews { frame, joints, arrived_ns }) = news.news().cloned().flatten() else {
                self.wipe_pictures();
                thread::park_timeout(NAP);
                continue;
            };
            let asked = self.handle.sex();
            if asked != sex {
                sex = asked;
                tracker.set_sex(sex, FitOptions::LIVE);
            }
            self.handle.gather(&frame);
            let fitted = tracker.push(&frame);
            let joints = joints.unwrap_or(fitted.joints);
            self.handle.count_tracked(fitted.found);
            self.send_picture(&frame, &joints, fitted.found, arrived_ns);
            out.publish(Some(TrackedFrame { frame: Some(frame), joints, company: tracker.company(), arrived_ns }));
            let took = self.clock.now_ns().saturating_sub(arrived_ns);
            let meter =
                if fitted.found && !fitted.started { &mut self.meters.followed } else { &mut self.meters.found };
            meter.add(took);
        }
        self.meters
    }

    /// Hands the colour image of a depth image on with its joints, while a shopper looks at themselves.
    fn send_picture(&mut self, frame: &Arc<DepthFrame>, joints: &Joints, found: bool, arrived_ns: u64) {
        let Some((colours, pictures)) = &mut self.pictures else { return };
        let colour = colours.latest();
        if !pictures.is_on() || colour.taken_ns != frame.time_ns {
            self.wipe_pictures();
            return;
        }
        pictures.send(|seen| {
            (seen.taken_ns, seen.arrived_ns, seen.camera) = (frame.time_ns, arrived_ns, colour.camera);
            seen.joints = if found { *joints } else { Joints::absent(frame.time_ns) };
            seen.depth = Some(frame.clone());
            own_picture::copy(&colour.picture, &mut seen.picture);
        });
    }

    fn wipe_pictures(&mut self) {
        if let Some((_, pictures)) = self.pictures.as_mut().filter(|(_, pictures)| !pictures.is_on()) {
            pictures.wipe();
        }
    }
}

/// The end that the sensor thread reads. Its threads end with it.
pub struct CameraFeed {
    reader: Reader<Option<TrackedFrame>>,
    now: Box<dyn Fn() -> u64 + Send>,
    next_ns: u64,
    threads: CameraThreads,
}

impl std::fmt::Debug for CameraFeed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CameraFeed").field("threads", &self.threads).finish_non_exhaustive()
    }
}

impl CameraFeed {
    pub(super) fn new<C: Clock + Send + 'static>(
        reader: Reader<Option<TrackedFrame>>,
        threads: CameraThreads,
        clock: C,
    ) -> Self {
        let next_ns = clock.now_ns();
        Self { reader, now: Box::new(move || clock.now_ns()), next_ns, threads }
    }

    /// Ends the camera's threads; gives how long the tracker took.
    pub fn end(self) -> CameraMeters {
        self.threads.end()
    }
}

impl FrameSource for CameraFeed {
    fn next_ns(&self) -> Option<u64> {
        Some(self.next_ns)
    }

    fn read(&mut self) -> Option<SourceFrame> {
        self.next_ns = (self.now)() + LOOK_NS;
        let TrackedFrame { frame, joints, company, arrived_ns } = self.reader.news()?.clone()?;
        let time_ns = frame.as_ref().map_or(joints.time_ns, |frame| frame.time_ns);
        let joints = Joints { time_ns, ..joints };
        let depth = frame.map(|frame| -> Arc<dyn DepthImage> { frame });
        let others = (company.others, company.nearer);
        Some(SourceFrame { joints, depth, others, arrived_ns: Some(arrived_ns) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine3A;
    use toile_engine::clock::RealClock;
    use toile_sensors::source::live::CameraState;
    use toile_sensors::source::live::fault_injection::{
        CameraFault, FaultClock, FaultPlan, FaultyCamera, SimulatedCamera, TimedFault,
    };
    use toile_track::fit::measuring::FRAMES;

    const MS: u64 = 1_000_000;

    /// The loop's end of a simulated camera with one fault, on the system's clock.
    fn started(clock: RealClock, fault: Option<TimedFault>) -> (CameraFeed, CameraHandle) {
        let now: FaultClock = Arc::new(move || clock.now_ns());
        let plan = Arc::new(FaultPlan { faults: fault.into_iter().collect() });
        let opener = Box::new(move || {
            let pelvis = |ns: u64| {
                let mut joints = Joints::absent(ns);
                joints.joints[0].confidence = 1.0;
                Some(joints)
            };
            let camera = SimulatedCamera::new(now.clone(), Affine3A::IDENTITY).seeing(Box::new(pelvis));
            Ok(Box::new(FaultyCamera::open(camera, plan.clone(), now.clone())?) as Box<_>)
        });
        let depth = LiveDepth::open(opener, GATHERED, clock.now_ns()).unwrap();
        start(depth, clock, TrackerOptions { zone: Zone::default(), sex: Sex::Female }, None).unwrap()
    }

    #[test]
    fn frames_come_through_both_threads_with_the_cameras_own_joints_and_stamps() {
        let clock = RealClock::starting_at(1_000 * MS);
        let (mut feed, handle) = started(clock, None);
        // Beside other tests, threads wake late: it ends as soon as enough has come.
        let (mut stamps, end) = (Vec::new(), clock.now_ns() + 30_000 * MS);
        handle.gather_anew();
        while clock.now_ns() < end && (stamps.len() < 5 || handle.gathered().len() < 5) {
            clock.sleep_until(feed.next_ns().unwrap());
            if let Some(frame) = feed.read() {
                assert_eq!((frame.joints.joints[0].confidence, frame.depth.is_some()), (1.0, true));
                assert!(frame.arrived_ns.unwrap() >= frame.joints.time_ns);
                stamps.push(frame.joints.time_ns);
            }
        }
        assert!(stamps.len() >= 5 && stamps.windows(2).all(|w| w[0] < w[1]), "{stamps:?}");
        let gathered = handle.gathered();
        assert!(gathered.len() >= 5 && gathered.len() <= FRAMES, "{}", gathered.len());
        handle.forget(Sex::Male);
        assert!(handle.gathered().is_empty());
        assert_eq!(handle.figures().state, CameraState::Seeing);
        feed.end();
    }

    #[test]
    fn a_camera_that_falls_silent_is_known_to_be_lost_and_to_be_back() {
        let clock = RealClock::starting_at(1_000 * MS);
        let (from_ns, until_ns) = (3_000 * MS, 6_000 * MS);
        let fault = TimedFault { fault: CameraFault::Silent, from_ns, until_ns };
        let (feed, handle) = started(clock, Some(fault));
        // Beside compilers, threads wake late: the limits themselves are held in simulated time.
        let comes_before = |state: CameraState, end_ns: u64| {
            while clock.now_ns() < end_ns && handle.figures().state != state {
                clock.sleep_until(clock.now_ns() + 5 * MS);
            }
            handle.figures().state == state
        };
        assert!(comes_before(CameraState::Seeing, from_ns));
        assert!(comes_before(CameraState::Lost, until_ns));
        assert!(comes_before(CameraState::Seeing, until_ns + 10_000 * MS));
        assert_eq!(handle.figures().counts.lost, 1);
        feed.end();
    }
}
