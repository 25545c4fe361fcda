//! A recorded session and its rules.

use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{MAX_DEPTH_BYTES, MAX_DEPTH_FRAMES, MAX_DURATION_NS, MAX_GAP_NS, MAX_JOINT_FRAMES};
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Intrinsics, Joints};

/// A sensor's data of one shopper. World: metres, y up, floor at y = 0, the shopper faces +z near x = z = 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Session {
    /// The recording's name, for reports.
    pub name: String,
    /// Joints, times strictly increasing `[frames]`; may be empty.
    pub joints: Vec<Joints>,
    /// Depth images, times strictly increasing `[frames]`; may be empty.
    pub depth: Vec<DepthFrame>,
    /// Assumptions and repairs, one sentence each.
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

    /// The session itself, where it keeps its promises: what a sensor of the caller's own saw.
    ///
    /// # Errors
    /// As a recording that breaks them: empty, too long, times that do not increase, numbers that are not finite, images of
    /// another size than their camera.
    pub fn checked(self) -> Result<Self, SourceError> {
        self.check().map_err(|fault| fault.at(&self.name))?;
        Ok(self)
    }

    /// Refuses a session that breaks its own promises: empty, too long, times that do not increase, numbers that are
    /// not finite, images of another size than their camera.
    pub(crate) fn check(&self) -> Result<(), ReaderFault> {
        const CURE: &str = "record it again or repair the file";
        if self.joints.is_empty() && self.depth.is_empty() {
            return Err(ReaderFault::new(FilePlace::Whole, "no frame with a person or a depth image in it", CURE));
        }
        if self.joints.len() > MAX_JOINT_FRAMES || self.depth.len() > MAX_DEPTH_FRAMES {
            return Err(too_many(self.joints.len().max(self.depth.len())));
        }
        check_times(self.joints.iter().map(|f| f.time_ns))?;
        check_times(self.depth.iter().map(|f| f.time_ns))?;
        if let Some(i) = self.joints.iter().position(|j| !j.is_valid()) {
            return Err(ReaderFault::new(
                FilePlace::Frame(i),
                "a joint is not finite, or its confidence not within 0..1",
                CURE,
            ));
        }
        for (i, frame) in self.depth.iter().enumerate() {
            if let Some(fault) = frame.fault() {
                return Err(ReaderFault::new(FilePlace::Frame(i), fault, CURE));
            }
        }
        Ok(())
    }
}

/// Refuses times that do not increase, that pause for longer than [`MAX_GAP_NS`], or that end after [`MAX_DURATION_NS`].
fn check_times(times: impl Iterator<Item = u64>) -> Result<(), ReaderFault> {
    let seconds = |ns: u64| ns as f64 / SECOND_NS as f64;
    let mut last: Option<u64> = None;
    for (i, time) in times.enumerate() {
        let fault = |problem: String, cure| Err(ReaderFault::new(FilePlace::Frame(i), problem, cure));
        match last.map(|last| time.checked_sub(last)) {
            Some(None | Some(0)) => {
                return fault(
                    "its time is not after that of the frame before".into(),
                    "record it again or repair the file",
                );
            }
            Some(Some(gap)) if gap > MAX_GAP_NS => {
                let (gap, most) = (seconds(gap), seconds(MAX_GAP_NS));
                let problem =
                    format!("it comes {gap:.0} s after the frame before, and a recording pauses for at most {most} s");
                return fault(problem, "cut the recording there");
            }
            _ if time > MAX_DURATION_NS => {
                let (time, most) = (seconds(time), seconds(MAX_DURATION_NS));
                let problem = format!("its time is {time:.0} s, and a recording lasts at most {most} s");
                return fault(problem, "cut the recording into shorter pieces whose times begin at 0");
            }
            _ => last = Some(time),
        }
    }
    Ok(())
}

/// Space left in a session for depth images; asked before an image is unpacked.
#[derive(Debug, Default)]
pub(crate) struct DepthRoom {
    frames: usize,
    bytes: u64,
}

impl DepthRoom {
    /// Takes room for one image, or says why there is none.
    pub(crate) fn take(&mut self, camera: &Intrinsics) -> Result<(), ReaderFault> {
        self.frames += 1;
        self.bytes += camera.pixels() as u64 * 2;
        if self.frames > MAX_DEPTH_FRAMES {
            return Err(too_many(self.frames));
        }
        if self.bytes > MAX_DEPTH_BYTES {
            let problem = format!("its depth images take more than {} MiB of memory", MAX_DEPTH_BYTES >> 20);
            return Err(ReaderFault::new(
                FilePlace::Frame(self.frames - 1),
                problem,
                "cut the recording into shorter pieces",
            ));
        }
        Ok(())
    }
}

/// The fault of a recording with more frames than [`MAX_JOINT_FRAMES`] or [`MAX_DEPTH_FRAMES`].
pub(crate) fn too_many(frames: usize) -> ReaderFault {
    let limits = format!("{MAX_JOINT_FRAMES} joint frames and {MAX_DEPTH_FRAMES} depth frames");
    let problem = format!("{frames} frames are more than a session holds ({limits})");
    ReaderFault::new(FilePlace::Whole, problem, "cut the recording into shorter pieces")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_increase_pause_for_a_minute_at_most_and_end_within_two_hours() {
        let refused = |times: &[u64]| check_times(times.iter().map(|s| s * SECOND_NS)).err().map(|fault| fault.place);
        assert_eq!(refused(&[0, 60, 120]), None);
        assert_eq!(refused(&[0, 60, 121]), Some(FilePlace::Frame(2)));
        assert_eq!(refused(&[0, 86_400]), Some(FilePlace::Frame(1)));
        assert_eq!(refused(&[5, 5]), Some(FilePlace::Frame(1)));
        assert_eq!(refused(&[5, 6, 4]), Some(FilePlace::Frame(2)));
        assert_eq!(refused(&[7_201]), Some(FilePlace::Frame(0)));
        assert!(check_times([0, u64::MAX].into_iter()).is_err());
    }

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
