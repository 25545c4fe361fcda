//! A session: what a sensor saw of one shopper, from the first frame to the last.
//!
//! Reads: recordings' frames. Writes: `Session`, and its own recording (MCAP). Budget: at load only.
//! Thread: the loading thread.
//!
//! # The recording
//!
//! An [MCAP](https://mcap.dev) file, profile `toile`, chunks uncompressed and with checksums, so that any MCAP tool lists
//! and recovers it. Two channels, messages in order of time, message encoding `toile-le`; each channel's schema (encoding
//! `text/plain`) describes its bytes in words:
//!
//! | topic | schema | a message |
//! |---|---|---|
//! | `/joints` | `toile.joints/1` | u64 time (ns), u32 count, then x, y, z (m), confidence as f32 for each joint |
//! | `/depth` | `toile.depth/1` | u64 time (ns), camera, pose, then a 16-bit grey PNG in millimetres |
//!
//! Numbers are little endian. The metadata record `toile.session` holds `version` (1), `origin`, `name`, `scale` (`known`
//! or `assumed`) and the frame counts; `toile.notes` holds the notes.

mod layout;
mod read;
mod write;

pub use read::read;
pub use write::write;

use crate::error::{Fault, Place};
use crate::frame::{DepthFrame, Intrinsics, Joints};
use crate::limits::{MAX_DEPTH_BYTES, MAX_DEPTH_FRAMES, MAX_JOINT_FRAMES};

/// Version of the recording's format; another one is refused.
const VERSION: u32 = 1;
const JOINTS_TOPIC: &str = "/joints";
const DEPTH_TOPIC: &str = "/depth";
const ENCODING: &str = "toile-le";
const LAYOUT: &str = "text/plain";
const METADATA: &str = "toile.session";
const NOTES: &str = "toile.notes";

/// What a sensor saw of one shopper. World: metres, y up, floor at y = 0, the shopper faces +z near x = z = 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Session {
    /// The recording's name, for reports.
    pub name: String,
    /// Joints, times strictly increasing `[frames]`; may be empty.
    pub joints: Vec<Joints>,
    /// Depth images, times strictly increasing `[frames]`; may be empty.
    pub depth: Vec<DepthFrame>,
    /// What was assumed or repaired, one sentence each.
    pub notes: Vec<String>,
    /// False where the recording's unit is arbitrary (BVH) and the size of the person is therefore unknown.
    pub raw_scale_known: bool,
}

impl Session {
    /// Time of the last frame (ns); the first is at 0.
    pub fn duration_ns(&self) -> u64 {
        let joints = self.joints.last().map_or(0, |f| f.time_ns);
        joints.max(self.depth.last().map_or(0, |f| f.time_ns))
    }

    /// The bytes of the session's recording; the same session gives the same bytes.
    ///
    /// # Errors
    /// Where the session breaks its own promises (order of time, finite numbers, sizes).
    pub fn to_bytes(&self) -> Result<Vec<u8>, crate::error::SourceError> {
        write::to_bytes(self).map_err(|fault| fault.at(&self.name))
    }

    /// Refuses a session that breaks its own promises: empty, too long, times that do not increase, numbers that are
    /// not finite, images of another size than their camera.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        const CURE: &str = "record it again or repair the file";
        if self.joints.is_empty() && self.depth.is_empty() {
            return Err(Fault::new(Place::Whole, "no frame with a person or a depth image in it", CURE));
        }
        if self.joints.len() > MAX_JOINT_FRAMES || self.depth.len() > MAX_DEPTH_FRAMES {
            return Err(too_many(self.joints.len().max(self.depth.len())));
        }
        let late = |i: usize| Fault::new(Place::Frame(i), "its time is not after the frame before", CURE);
        if let Some(i) = self.joints.windows(2).position(|w| w[0].time_ns >= w[1].time_ns) {
            return Err(late(i + 1));
        }
        if let Some(i) = self.depth.windows(2).position(|w| w[0].time_ns >= w[1].time_ns) {
            return Err(late(i + 1));
        }
        if let Some(i) = self.joints.iter().position(|j| !j.is_valid()) {
            return Err(Fault::new(Place::Frame(i), "a joint is not finite, or its confidence not within 0..1", CURE));
        }
        for (i, frame) in self.depth.iter().enumerate() {
            if let Some(fault) = frame.fault() {
                return Err(Fault::new(Place::Frame(i), fault, CURE));
            }
        }
        Ok(())
    }
}

/// What room a session still has for depth images; asked before an image is unpacked.
#[derive(Debug, Default)]
pub(crate) struct DepthRoom {
    frames: usize,
    bytes: u64,
}

impl DepthRoom {
    /// Takes room for one image, or says why there is none.
    pub(crate) fn take(&mut self, camera: &Intrinsics) -> Result<(), Fault> {
        self.frames += 1;
        self.bytes += camera.pixels() as u64 * 2;
        if self.frames > MAX_DEPTH_FRAMES {
            return Err(too_many(self.frames));
        }
        if self.bytes > MAX_DEPTH_BYTES {
            let problem = format!("its depth images take more than {} MiB of memory", MAX_DEPTH_BYTES >> 20);
            return Err(Fault::new(Place::Frame(self.frames - 1), problem, "cut the recording into shorter pieces"));
        }
        Ok(())
    }
}

/// The fault of a recording with more frames than [`MAX_JOINT_FRAMES`] or [`MAX_DEPTH_FRAMES`].
pub(crate) fn too_many(frames: usize) -> Fault {
    let limits = format!("{MAX_JOINT_FRAMES} joint frames and {MAX_DEPTH_FRAMES} depth frames");
    let problem = format!("{frames} frames are more than a session holds ({limits})");
    Fault::new(Place::Whole, problem, "cut the recording into shorter pieces")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_large_images_are_refused_before_they_are_unpacked() {
        let largest = Intrinsics { width: 2048, height: 2048, ..Intrinsics::KINECT_V1 };
        let mut room = DepthRoom::default();
        let fits = (0..MAX_DEPTH_FRAMES).take_while(|_| room.take(&largest).is_ok()).count();
        assert_eq!(fits as u64, MAX_DEPTH_BYTES / (2048 * 2048 * 2));
        let mut room = DepthRoom::default();
        assert!((0..MAX_DEPTH_FRAMES).all(|_| room.take(&Intrinsics::KINECT_V1).is_ok()));
        assert!(room.take(&Intrinsics::KINECT_V1).is_err());
    }
}
