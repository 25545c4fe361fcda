//! A camera as the loop wants it: depth images in our world with stamps of the loop's clock, and how the camera stands. One that
//! is gone is opened again.

use std::sync::Arc;
use std::time::Duration;

use glam::Affine3A;

use super::error::CameraError;
use super::frame_check::{CameraCounts, CameraState, FrameCheck, FrameVerdict};
use super::frame_pool::FramePool;
use super::live_camera::{Arrival, CameraFrame, CameraInfo, ColourImage, LiveCamera};
use crate::colour_camera::ColourCamera;
use crate::error::{FilePlace, ReaderFault};
use crate::source::depth_converter::DepthConverter;
use crate::source::placement::{CameraPlacement, PlacedCamera};
use toile_base::frame::{DepthFrame, Intrinsics, Joints};

/// Longest that a camera is waited for at once (ns): so often its state is looked at.
pub const PATIENCE_NS: u64 = 10_000_000;

/// Time between two tries to open a camera that is gone (ns).
pub(super) const RETRY_NS: u64 = 250_000_000;

/// A camera from which nothing came for so long is closed and opened anew (ns): its library may not have noticed that it was unplugged.
pub(super) const SILENT_NS: u64 = 2_000_000_000;

/// Opens the camera, the first time and whenever it was gone.
pub type CameraOpener = Box<dyn FnMut() -> Result<Box<dyn LiveCamera>, CameraError> + Send>;

/// Result of a look at the camera.
#[derive(Debug, Clone)]
pub struct LiveUpdate {
    /// How the camera stands.
    pub state: CameraState,
    /// A new depth image in our world, stamped on the loop's clock.
    pub frame: Option<Arc<DepthFrame>>,
    /// When a frame arrived, good or not (ns).
    pub arrived_ns: Option<u64>,
    /// Whether there is no camera to wait for, so that the caller should wait.
    pub is_closed: bool,
}

/// A camera, checked, straightened and placed.
pub struct LiveDepth {
    opener: CameraOpener,
    camera: Option<Box<dyn LiveCamera>>,
    info: CameraInfo,
    check: FrameCheck,
    converter: DepthConverter,
    placement: CameraPlacement,
    pose: Option<Affine3A>,
    pool: FramePool,
    raw: CameraFrame,
    people: Vec<Joints>,
    notes: Vec<String>,
    /// When it was last tried to open, and when something last came (ns).
    tried_ns: u64,
    heard_ns: u64,
}

impl LiveDepth {
    /// Opens the camera for the first time; so many of its images may be kept elsewhere at once. Called at load: it allocates.
    ///
    /// # Errors
    /// Those of the opener; a camera whose lens cannot be straightened.
    pub fn open(mut opener: CameraOpener, kept: usize, now_ns: u64) -> Result<Self, CameraError> {
        let camera = opener()?;
        let info = camera.info().clone();
        let mut notes = Vec::new();
        let converter = converter(&info, &mut notes)?;
        Ok(Self {
            opener,
            camera: Some(camera),
            check: FrameCheck::new(info.sensor().pixels(), info.rate_hz),
            pool: FramePool::new(converter.kept(), kept),
            placement: CameraPlacement::default(),
            pose: info.placed,
            info,
            converter,
            raw: CameraFrame::default(),
            people: Vec::new(),
            notes,
            tried_ns: now_ns,
            heard_ns: now_ns,
        })
    }

    /// Properties of the camera.
    pub fn info(&self) -> &CameraInfo {
        &self.info
    }

    /// The camera of the depth images that come out.
    pub fn intrinsics(&self) -> Intrinsics {
        self.converter.kept()
    }

    /// Assumptions and repairs, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Counts of its frames.
    pub fn counts(&self) -> CameraCounts {
        self.check.counts
    }

    /// The colour image that came last with a frame; of no size where none did.
    pub fn colour(&self) -> &ColourImage {
        &self.raw.colour
    }

    /// The camera of its colour images, in our world; none before it is placed, or where it is not known how it sees.
    pub fn colour_camera(&self) -> Option<ColourCamera> {
        self.info.colour_camera(self.pose?)
    }

    /// Joints of all persons that the camera itself tracked in the last frame, in our world.
    pub fn people(&self) -> &[Joints] {
        &self.people
    }

    /// Wipes all free images after the person in them has left.
    pub fn wipe(&mut self) {
        self.raw.colour.rgb.fill(0);
        self.pool.wipe();
    }

    /// Waits for the next frame, for about so long; `now_ns` is the loop's clock.
    pub fn poll(&mut self, now_ns: &dyn Fn() -> u64, patience: Duration) -> LiveUpdate {
        self.reopen(now_ns());
        let arrival = match &mut self.camera {
            Some(camera) => camera.read(&mut self.raw, patience),
            None => Ok(Arrival::Nothing),
        };
        let now = now_ns();
        let mut update = LiveUpdate { state: CameraState::Starting, frame: None, arrived_ns: None, is_closed: false };
        match arrival {
            Ok(Arrival::Frame) => {
                (self.heard_ns, update.arrived_ns) = (now, Some(now));
                update.frame = self.take(now);
            }
            Ok(Arrival::Nothing) if now.saturating_sub(self.heard_ns) < SILENT_NS => {}
            // Gone, at its end, or silent for too long: opened again.
            Ok(Arrival::Nothing | Arrival::Ended) | Err(_) => self.close(now),
        }
        update.state = self.check.look(now);
        update.is_closed = self.camera.is_none();
        update
    }

    fn close(&mut self, now: u64) {
        if self.camera.take().is_some() {
            self.tried_ns = now;
        }
    }

    /// Opens a camera that is gone, every so often.
    fn reopen(&mut self, now: u64) {
        if self.camera.is_some() || now.saturating_sub(self.tried_ns) < RETRY_NS {
            return;
        }
        (self.tried_ns, self.heard_ns) = (now, now);
        // Why it cannot be opened was said when the program began; now it is lost, and that is shown.
        let Ok(camera) = (self.opener)() else { return };
        if camera.info().sensor() == self.info.sensor() {
            self.camera = Some(camera);
            self.check.reopened();
        }
    }

    /// Judges, straightens and places the frame that was read.
    fn take(&mut self, now: u64) -> Option<Arc<DepthFrame>> {
        self.people.clear();
        let FrameVerdict::Good(time_ns) = self.check.judge(&self.raw, now) else { return None };
        let (converter, samples) = (&mut self.converter, &self.raw.depth);
        let pose = self.pose;
        let frame = self.pool.fill(|frame| {
            frame.time_ns = time_ns;
            frame.camera_to_world = pose.unwrap_or_default();
            converter.convert_into(samples.iter().copied(), &mut frame.depth_mm);
        })?;
        let Some(pose) = pose else { return self.place(frame) };
        let placed = |joints: &Joints| {
            let mut joints = Joints { time_ns, ..*joints };
            joints.joints.iter_mut().for_each(|j| j.position = pose.transform_point3(j.position));
            joints
        };
        self.people.extend(self.raw.people.iter().map(placed));
        Some(frame)
    }

    /// Finds the camera's pose by its first frames; the frame by which it is found is the first that is handed on.
    fn place(&mut self, mut frame: Arc<DepthFrame>) -> Option<Arc<DepthFrame>> {
        let PlacedCamera { pose, note } = self.placement.push(&frame)?;
        (self.pose, self.placement) = (Some(pose), CameraPlacement::default());
        self.notes.push(note);
        // The pool does not lend it again while it is here: this copies one image, once.
        Arc::make_mut(&mut frame).camera_to_world = pose;
        Some(frame)
    }
}

fn converter(info: &CameraInfo, notes: &mut Vec<String>) -> Result<DepthConverter, CameraError> {
    let fault = info.sensor().fault().map(|fault| ReaderFault::new(FilePlace::Whole, fault, "report this camera"));
    let converter = fault.map_or_else(|| DepthConverter::new(info.camera, notes), Err);
    converter.map_err(|fault| CameraError::Recording(fault.at(&info.device).to_string()))
}
