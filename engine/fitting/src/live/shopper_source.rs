//! Source of a shopper's measures: a recording, received joints, or a live camera.

use std::sync::Arc;

use toile_base::body::Sex;
use toile_base::frame::Joints;
use toile_sensors::source::Session;

use super::depth_camera::CameraHandle;
use crate::dress::session;

/// Where a shopper is measured from.
#[derive(Debug, Clone)]
pub enum ShopperSource {
    /// The recording that is played, with its depth.
    Recording(Arc<Session>),
    /// The joints of the last second, which are all that a live sender gives.
    Joints(Vec<Joints>),
    /// A live camera: what it has gathered since the measuring began.
    Camera(CameraHandle),
}

impl ShopperSource {
    /// Begins to measure a person: what a camera gathered before is dropped.
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
