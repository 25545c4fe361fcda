//! A webcam in the loop: one thread waits for its pictures, makes them red, green and blue, and finds the joints in them, in about half of
//! the time between two. It hands on the latest joints as a depth camera's threads do; neither the sensor thread nor a step waits for it.

use std::io;
use std::path::Path;
use std::thread;
use std::time::Duration;

use toile_base::body::Sex;
use toile_base::frame::Joints;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::triple_buffer::{TripleBuffer, Writer};
use toile_pose::files::PoseError;
use toile_pose::joints::JointPlacer;
use toile_pose::picture_fit::{self, PictureFit, PictureFitter};
use toile_pose::scale::{StatureEstimate, StatureSource, WebcamMount};
use toile_pose::tracker::{PoseModel, PoseTracker};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::{ColourImage, LiveColour, PATIENCE_NS};
use toile_track::fit::tracker::Company;

use super::depth_camera::{CameraFeed, CameraHandle, CameraMeters, CameraThreads, TrackedFrame};
use super::own_picture::{PictureSender, copy};

/// How a person is seen through a webcam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WebcamOptions {
    /// Whose mean body has the lengths of the limbs.
    pub sex: Sex,
    /// Which network finds the landmarks.
    pub model: PoseModel,
    /// How the camera stands.
    pub mount: WebcamMount,
    /// Their stature, where they say it (m).
    pub stature_m: Option<f32>,
    /// Whether the shopper may see their own picture: then it is found where in it they are.
    pub own_picture: bool,
}

impl Default for WebcamOptions {
    fn default() -> Self {
        Self {
            sex: Sex::Female,
            model: PoseModel::Lite,
            mount: WebcamMount::default(),
            stature_m: None,
            own_picture: false,
        }
    }
}

/// From pictures to joints.
#[derive(Debug)]
pub struct WebcamJoints {
    tracker: PoseTracker,
    placer: JointPlacer,
    stature: StatureEstimate,
    options: WebcamOptions,
    fitter: PictureFitter,
    fit: Option<PictureFit>,
    /// Whether a person was seen in the last picture.
    pub found: bool,
}

impl WebcamJoints {
    /// With the network's files of a folder. Called at load: it allocates.
    ///
    /// # Errors
    /// Files that are missing or others than those that are known, with the command that fetches them.
    pub fn load(folder: &Path, options: WebcamOptions) -> Result<Self, PoseError> {
        Ok(Self {
            tracker: PoseTracker::load(folder, options.model, options.own_picture)?,
            placer: JointPlacer::new(options.sex, options.mount),
            stature: StatureEstimate::new(options.stature_m),
            options,
            fitter: PictureFitter::default(),
            fit: None,
            found: false,
        })
    }

    /// Joints of a picture that was taken at a time (ns); all are absent where no person is in view, or the picture cannot be read.
    pub fn push(&mut self, picture: &ColourImage, time_ns: u64) -> Joints {
        let seen = self.tracker.push(picture, time_ns);
        self.fit = None;
        let Ok(Some(landmarks)) = seen else {
            if self.found && self.tracker.region().is_none() {
                self.reset();
            }
            self.found = false;
            return Joints::absent(time_ns);
        };
        self.found = true;
        let size = [picture.width, picture.height];
        self.stature.push(&landmarks, size, &self.options.mount);
        let joints = self.placer.joints(&landmarks, size, self.stature.stature().0, time_ns);
        if self.options.own_picture {
            self.fit = self.fitter.fit(&landmarks, &joints, size, &self.options.mount);
        }
        joints
    }

    /// The camera of the last picture, and joints as seen in it; none where no person is in view, or own pictures are not shown.
    pub fn picture_fit(&self) -> Option<&PictureFit> {
        self.fit.as_ref()
    }

    /// How the webcam sees, where it is not known where it stands: as if at the world's middle.
    pub fn camera(&self, picture: &ColourImage) -> ColourCamera {
        picture_fit::webcam([picture.width, picture.height], &self.options.mount)
    }

    /// Which parts of the last picture show the person; none where own pictures are not shown.
    pub fn mask(&self) -> Option<&PersonMask> {
        self.tracker.mask()
    }

    /// Stature that the person in view is taken to have (m), and its source.
    pub fn stature(&self) -> (f32, StatureSource) {
        self.stature.stature()
    }

    /// People in the last whole picture that was searched, beside the one who is followed.
    pub fn others(&self) -> u8 {
        self.tracker.counts.people.saturating_sub(1).min(u64::from(u8::MAX)) as u8
    }

    /// Another person may stand there.
    fn reset(&mut self) {
        self.stature.reset();
        self.placer.reset();
        self.fitter.reset();
    }

    fn set_sex(&mut self, sex: Sex) {
        if self.options.sex != sex {
            self.options.sex = sex;
            self.placer = JointPlacer::new(sex, self.options.mount);
        }
    }

    fn note(&self) -> String {
        let (stature, source) = self.stature();
        let cure = match source {
            StatureSource::Given => "",
            StatureSource::Floor => "; a tape measure knows it better",
            StatureSource::Assumed => "; say it, or the camera's height",
        };
        format!("A picture has no scale: the stature is {stature:.2} m ({source}){cure}.")
    }
}

/// Starts the thread of a webcam that is open. Gives what the sensor thread reads, and what others ask.
///
/// # Errors
/// Where the system gives no thread.
pub fn start<C>(
    colour: LiveColour,
    joints: WebcamJoints,
    clock: C,
    pictures: Option<PictureSender>,
) -> io::Result<(CameraFeed, CameraHandle)>
where
    C: Clock + Clone + Send + 'static,
{
    let handle = CameraHandle::new();
    handle.follow(joints.options.sex);
    let TripleBuffer { writer, reader } = TripleBuffer::new(&None);
    let (shared, own) = (handle.clone(), clock.clone());
    let work = move || {
        thread_roles::apply(ThreadRole::Camera);
        look_at_pictures((colour, joints, pictures), &own, &shared, writer)
    };
    let thread = thread::Builder::new().name("toile-webcam".into()).spawn(work)?;
    let threads = CameraThreads::one(handle.clone(), thread);
    Ok((CameraFeed::new(reader, threads, clock), handle))
}

/// What the webcam's thread runs.
fn look_at_pictures<C: Clock>(
    (mut colour, mut joints, mut pictures): (LiveColour, WebcamJoints, Option<PictureSender>),
    clock: &C,
    handle: &CameraHandle,
    mut out: Writer<Option<TrackedFrame>>,
) -> CameraMeters {
    let patience = Duration::from_nanos(PATIENCE_NS);
    let mut meters = CameraMeters::default();
    let mut noted = None;
    while !handle.is_over() {
        joints.set_sex(handle.sex());
        let update = colour.poll(&|| clock.now_ns(), patience);
        handle.publish(update.state, colour.counts());
        if handle.takes_wipe() {
            colour.wipe();
            pictures.iter_mut().for_each(PictureSender::forget);
        }
        let (Some(taken_ns), Some(arrived_ns)) = (update.taken_ns, update.arrived_ns) else {
            if update.is_closed {
                thread::sleep(patience);
            }
            pictures.iter_mut().filter(|p| !p.is_on()).for_each(PictureSender::wipe);
            continue;
        };
        let had = joints.found;
        let found = joints.push(colour.picture(), taken_ns);
        if let Some(pictures) = &mut pictures {
            pictures.send(|seen| {
                (seen.taken_ns, seen.arrived_ns, seen.depth) = (taken_ns, arrived_ns, None);
                copy(colour.picture(), &mut seen.picture);
                let fit = joints.picture_fit();
                seen.camera = fit.map(|fit| fit.camera).or(Some(joints.camera(colour.picture())));
                seen.joints = fit.map_or(Joints::absent(taken_ns), |fit| fit.joints);
                joints.mask().into_iter().for_each(|mask| seen.mask.take(mask));
            });
        }
        handle.count_tracked(joints.found);
        handle.set_colour(colour.picture());
        if joints.found {
            handle.gather_joints(&found);
            let source = Some(joints.stature().1);
            if noted != source {
                handle.set_notes(&[joints.note()]);
                noted = source;
            }
        }
        let company = Company { others: joints.others(), nearer: false };
        out.publish(Some(TrackedFrame { frame: None, joints: found, company, arrived_ns }));
        let meter = if had && joints.found { &mut meters.followed } else { &mut meters.found };
        meter.add(clock.now_ns().saturating_sub(arrived_ns));
    }
    meters
}
