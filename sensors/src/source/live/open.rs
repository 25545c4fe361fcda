//! The kinds of cameras, and the way to open each.

use std::path::PathBuf;
use std::str::FromStr;

use super::error::CameraError;
use super::library::{self, LibraryName};
use super::live_camera::{CameraOptions, LiveCamera};
use super::{k4a, kinect, openni, orbbec, realsense, recorded, webcam, webcam_file};
use crate::source::openni_library;

toile_base::named! {
    /// Kinds of camera.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum CameraKind {
        /// Kinect for Xbox 360 and Kinect for Windows (v1), through libfreenect.
        Kinect = "kinect",
        /// Xtion, Astra, Structure and others, through OpenNI 2.
        OpenNi = "openni",
        /// Azure Kinect; Femto Bolt and Mega by Orbbec's wrapper of the same interface.
        K4a = "k4a",
        /// RealSense D4xx and others.
        RealSense = "realsense",
        /// Orbbec Gemini, Astra 2, Femto.
        Orbbec = "orbbec",
        /// Any webcam: colour alone, joints by a network.
        Webcam = "webcam",
        /// Pictures of files in a webcam's place.
        WebcamFile = "webcam-file",
        /// A recording, played in time as a camera.
        Recording = "recording",
    }
}

impl CameraKind {
    /// The libraries that it needs, the first always, the others to play recordings.
    pub const fn libraries(self) -> &'static [LibraryName] {
        match self {
            Self::Kinect => &[kinect::LIBRARY],
            Self::OpenNi => &[openni_library::LIBRARY],
            Self::K4a => &k4a::LIBRARIES,
            Self::RealSense => &[realsense::LIBRARY],
            Self::Orbbec => &[orbbec::LIBRARY],
            Self::Webcam | Self::WebcamFile | Self::Recording => &[],
        }
    }

    /// Whether it gives colour and no depth: it is seen through [`LiveColour`](super::LiveColour).
    pub const fn is_colour(self) -> bool {
        matches!(self, Self::Webcam | Self::WebcamFile)
    }

    /// The file of its first library, if it is installed and can be loaded.
    ///
    /// # Errors
    /// That it is missing, with the command that installs it, or cannot be loaded.
    pub fn installed(self, folders: &[PathBuf]) -> Result<Option<PathBuf>, CameraError> {
        let loaded = self.libraries().first().map(|name| library::Library::load(name, folders));
        Ok(loaded.transpose()?.map(|library| library.path))
    }
}

/// A camera that is asked for: a kind, and which one of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CameraName {
    /// The kind.
    pub kind: CameraKind,
    /// A serial number or address, or the path of a recording that is played in its place; none is the first that is found.
    pub which: Option<String>,
}

impl FromStr for CameraName {
    type Err = CameraError;

    /// `kinect`, or with what follows a colon `kinect:A00365`, `k4a:session.mkv`.
    fn from_str(text: &str) -> Result<Self, CameraError> {
        let (name, which) = text.split_once(':').map_or((text, None), |(name, which)| (name, Some(which)));
        let unknown = || {
            let names = CameraKind::ALL.map(CameraKind::name).join(", ");
            CameraError::Unknown(format!("there is no camera named {name:?}; give one of {names}"))
        };
        let kind = CameraKind::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(unknown)?;
        let which = which.filter(|which| !which.is_empty()).map(str::to_owned);
        if kind == CameraKind::Recording && which.is_none() {
            return Err(CameraError::Unknown("which recording is the camera? give its path: recording:F".into()));
        }
        if kind == CameraKind::WebcamFile && which.is_none() {
            return Err(CameraError::Unknown(
                "which pictures are the camera? give their folder: webcam-file:DIR".into(),
            ));
        }
        Ok(Self { kind, which })
    }
}

impl std::fmt::Display for CameraName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.which {
            None => f.write_str(self.kind.name()),
            Some(which) => write!(f, "{}:{which}", self.kind),
        }
    }
}

/// Opens a camera.
///
/// # Errors
/// A library that is missing, a camera that is not connected or refuses, a recording that cannot be played.
pub fn open(name: &CameraName, options: &CameraOptions) -> Result<Box<dyn LiveCamera>, CameraError> {
    let which = name.which.as_deref();
    Ok(match name.kind {
        CameraKind::Kinect => Box::new(kinect::Kinect::open(which, options)?),
        CameraKind::OpenNi => Box::new(openni::OpenNi::open(which, options)?),
        CameraKind::K4a => Box::new(k4a::K4a::open(which, options)?),
        CameraKind::RealSense => Box::new(realsense::RealSense::open(which, options)?),
        CameraKind::Orbbec => Box::new(orbbec::Orbbec::open(which, options)?),
        CameraKind::Webcam => Box::new(webcam::Webcam::open(which, options)?),
        CameraKind::WebcamFile => Box::new(webcam_file::WebcamFile::open(which.unwrap_or_default(), options)?),
        CameraKind::Recording => Box::new(recorded::RecordedCamera::open(which.unwrap_or_default(), options)?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_named_by_its_kind_and_which_of_it() {
        let name: CameraName = "k4a:session.mkv".parse().unwrap();
        assert_eq!((name.kind, name.which.as_deref()), (CameraKind::K4a, Some("session.mkv")));
        assert_eq!(name.to_string(), "k4a:session.mkv");
        assert_eq!("kinect".parse::<CameraName>().unwrap().to_string(), "kinect");
        assert_eq!("webcam:/dev/video2".parse::<CameraName>().unwrap().to_string(), "webcam:/dev/video2");
        let error = "cctv".parse::<CameraName>().unwrap_err().to_string();
        assert!(error.starts_with("there is no camera named \"cctv\"; give one of kinect, openni"), "{error}");
        assert!("recording".parse::<CameraName>().is_err() && "webcam-file:".parse::<CameraName>().is_err());
    }

    #[test]
    fn every_library_says_how_it_is_installed() {
        for kind in CameraKind::ALL {
            assert!(kind.libraries().iter().all(|l| l.install.contains(" install ")), "{kind}");
        }
    }
}
