//! The dresser: measures a shopper and dresses a body of their size, or dresses the mannequin, in the background.

use std::sync::Arc;

use toile_base::body::Sex;
use toile_base::frame::Joints;
use toile_sensors::source::Session;

use super::background::{BackgroundJob, Finished};
use super::depth_camera::CameraHandle;
use crate::FittingError;
use crate::dress::attire::Attire;
use crate::dress::dressed::{self, Dressed};
use crate::dress::session;

/// A job for the dresser.
#[derive(Debug, Clone)]
pub enum DressJob {
    /// Measure a shopper and dress them.
    Shopper(ShopperSource),
    /// Dress the mannequin, as these joints stand.
    Mannequin(Box<Joints>),
}

/// Where a shopper is measured from.
#[derive(Debug, Clone)]
pub enum ShopperSource {
    /// The recording that is played, with its depth.
    Recording(Arc<Session>),
    /// The joints of the last second, which are all that a live sender gives.
    Joints(Vec<Joints>),
    /// A live camera: what it has gathered since somebody began to be measured.
    Camera(CameraHandle),
}

impl ShopperSource {
    /// Somebody begins to be measured: what a camera gathered before is of no use.
    pub fn begin(&self) {
        if let Self::Camera(camera) = self {
            camera.gather_anew();
        }
    }

    /// The shopper has left: what a camera gathered is thrown away and wiped.
    pub fn forget(&self) {
        if let Self::Camera(camera) = self {
            camera.forget(Sex::Female);
        }
    }

    /// The live camera, if it is one.
    pub fn camera(&self) -> Option<&CameraHandle> {
        match self {
            Self::Camera(camera) => Some(camera),
            Self::Recording(_) | Self::Joints(_) => None,
        }
    }

    /// The same as a session.
    pub fn session(self) -> Arc<Session> {
        match self {
            Self::Recording(session) => session,
            Self::Joints(joints) => Arc::new(session::of_joints(joints)),
            Self::Camera(camera) => Arc::new(camera.session()),
        }
    }
}

/// Result of a job.
pub enum DressOutcome {
    /// Somebody is dressed: a shopper, or the mannequin, which stands still.
    Done(Box<Dressed>),
    /// They could not be measured; why is not reported to anybody, for it may tell of them.
    Failed,
    /// The thread that dresses panicked.
    Panicked,
}

/// Dresses everybody in the same.
#[derive(Debug)]
pub struct Dresser {
    attire: Arc<Attire>,
    job: BackgroundJob<Result<Dressed, FittingError>>,
}

impl Dresser {
    /// One that dresses everybody in this.
    pub fn new(attire: Arc<Attire>) -> Self {
        Self { attire, job: BackgroundJob::default() }
    }

    /// From the next job on, everybody is dressed in something else.
    pub fn change(&mut self, attire: Arc<Attire>) {
        self.attire = attire;
    }

    /// Whether a job is under way, wanted or not.
    pub fn is_busy(&self) -> bool {
        self.job.is_running()
    }

    /// Begins a job.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn begin(&mut self, job: DressJob) -> std::io::Result<()> {
        let attire = self.attire.clone();
        self.job.start("toile-dresser", move || match job {
            DressJob::Shopper(source) => dressed::shopper(&source.session(), &attire),
            DressJob::Mannequin(pose) => dressed::mannequin_in(&attire, &pose),
        })
    }

    /// The shopper has left: what comes of their job is thrown away. A mannequin is kept, for it tells of nobody.
    pub fn forget(&mut self) {
        self.job.abandon();
    }

    /// What has come of a job, once, when it has ended.
    pub fn poll(&mut self) -> Option<DressOutcome> {
        match self.job.poll()? {
            Finished::Panicked => Some(DressOutcome::Panicked),
            Finished::Done { value: Ok(dressed), wanted } if wanted || dressed.dressing.still => {
                Some(DressOutcome::Done(Box::new(dressed)))
            }
            Finished::Done { value: Err(_), wanted: true } => Some(DressOutcome::Failed),
            Finished::Done { .. } => None,
        }
    }
}
