//! Depth images on their way into a session: straightened, counted, put in order of time, and set into our world.

use glam::{Affine3A, Vec3};

use super::camera::DepthCamera;
use super::depth_converter::DepthConverter;
use super::placement::{self, CameraPlacement};
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_DURATION_NS;
use crate::session::{DepthRoom, Session};
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Intrinsics};

/// Rate assumed of images without times (Hz): that of the Kinects.
const ASSUMED_HZ: u64 = 30;

/// Time of an image that has none: the `index`th at [`ASSUMED_HZ`] (ns).
pub(super) const fn assumed_time(index: usize) -> u64 {
    index as u64 * SECOND_NS / ASSUMED_HZ
}

/// Note for a recording whose images have no times.
pub(super) fn untimed(images: usize) -> String {
    format!("the file holds no times: its {images} images are taken at {ASSUMED_HZ} Hz")
}

/// Depth images of one camera, as they come.
pub(super) struct Sequence {
    camera: DepthCamera,
    converter: DepthConverter,
    room: DepthRoom,
    start_ns: Option<u64>,
    backwards: usize,
    frames: Vec<DepthFrame>,
    /// Assumptions and repairs.
    pub notes: Vec<String>,
}

impl Sequence {
    /// No images yet; refused where the camera's lens is described by numbers of no lens.
    pub fn new(camera: DepthCamera, mut notes: Vec<String>) -> Result<Self, ReaderFault> {
        let converter = DepthConverter::new(camera, &mut notes)?;
        let room = DepthRoom::default();
        Ok(Self { camera, converter, room, start_ns: None, backwards: 0, frames: Vec::new(), notes })
    }

    /// The camera that the images come from.
    pub fn sensor(&self) -> Intrinsics {
        self.camera.intrinsics
    }

    /// Takes one image of the sensor's size (in the camera's units, 0 = nothing). One that goes back in time is dropped
    /// and counted.
    pub fn push(&mut self, time_ns: u64, samples: impl ExactSizeIterator<Item = u16>) -> Result<(), ReaderFault> {
        let index = self.frames.len() + self.backwards;
        if samples.len() != self.camera.intrinsics.pixels() {
            let k = self.camera.intrinsics;
            let problem = format!("{} depths where the camera has {} x {} pixels", samples.len(), k.width, k.height);
            return Err(ReaderFault::new(FilePlace::Frame(index), problem, "give the camera JSON that fits"));
        }
        let start = *self.start_ns.get_or_insert(time_ns);
        let last = self.frames.last().map(|f| f.time_ns);
        let Some(time_ns) = time_ns.checked_sub(start).filter(|t| last.is_none_or(|last| *t > last)) else {
            self.backwards += 1;
            return Ok(());
        };
        if time_ns > MAX_DURATION_NS {
            let problem = "its time lies more than two hours after the first image";
            return Err(ReaderFault::new(
                FilePlace::Frame(index),
                problem,
                "cut the recording where the clock was set",
            ));
        }
        let intrinsics = self.converter.kept();
        self.room.take(&intrinsics)?;
        let depth_mm = self.converter.convert(samples);
        let camera_to_world = self.camera.pose.unwrap_or_else(placement::level_camera);
        self.frames.push(DepthFrame { time_ns, intrinsics, camera_to_world, depth_mm });
        Ok(())
    }

    /// All images as a session in our world.
    pub fn finish(mut self) -> Result<Session, ReaderFault> {
        if self.backwards > 0 {
            let total = self.frames.len() + self.backwards;
            self.notes.push(format!("{} of {total} images went back in time and were dropped", self.backwards));
        }
        place(&mut self.frames, self.camera.pose.is_some(), &mut self.notes)?;
        Ok(Session { depth: self.frames, notes: self.notes, raw_scale_known: true, ..Session::default() })
    }
}

/// Sets the images into our world: the floor at y = 0, centred at what is seen. Where the pose is known, so is the floor, if
/// something stands near y = 0 of the camera's world; otherwise it lies under the lowest points. Of a camera of unknown pose
/// all comes from the floor that is seen.
fn place(depth: &mut [DepthFrame], posed: bool, notes: &mut Vec<String>) -> Result<(), ReaderFault> {
    let pose = if posed { centred(depth, notes) } else { found(depth, notes) };
    let pose = pose.ok_or_else(|| {
        let cure = "record again with a person in view";
        ReaderFault::new(FilePlace::Frame(0), "every depth image is empty", cure)
    })?;
    depth.iter_mut().for_each(|f| f.camera_to_world = pose);
    Ok(())
}

/// The pose of a camera that nothing is known of.
fn found(depth: &[DepthFrame], notes: &mut Vec<String>) -> Option<Affine3A> {
    let mut placement = CameraPlacement::default();
    let placed = depth.iter().find_map(|frame| placement.push(frame)).or_else(|| placement.assumed())?;
    notes.push(placed.note);
    Some(placed.pose)
}

/// Lowest points this near to y = 0 of a known camera's world stand on its floor (m): what lies lower is the noise of pixels
/// at the floor, what lies higher a foot that the picture cuts or that is lost in the floor.
const AT_THE_FLOOR: f32 = 0.15;

/// A known pose, its world's origin under the median point of the first image that shows anything, at the floor.
fn centred(depth: &[DepthFrame], notes: &mut Vec<String>) -> Option<Affine3A> {
    let first = depth.iter().find(|f| placement::shows_anything(f))?;
    let [x, low, z] = placement::middle(first)?;
    let floor = if low.abs() < AT_THE_FLOOR {
        0.0
    } else {
        notes.push(format!(
            "the floor is put under the lowest points of the first image, at y = {low:.3} m of the camera's world"
        ));
        low
    };
    Some(Affine3A::from_translation(-Vec3::new(x, floor, z)) * first.camera_to_world)
}

#[cfg(test)]
mod tests {
    use super::placement::level_camera;
    use super::*;

    /// A board of a person's size at the origin, as a level camera sees it, with its lowest edge at a height (m).
    fn board(camera: &DepthCamera, pose: Affine3A, low: f32) -> Vec<u16> {
        let k = camera.intrinsics;
        let eye = pose.translation;
        let pixel = |i: usize| {
            let (u, v) = ((i % k.width as usize) as f32, (i / k.width as usize) as f32);
            let p = pose.transform_point3(k.unproject(u, v, eye.z));
            if p.x.abs() < 0.25 && (low..low + 1.7).contains(&p.y) { (eye.z * 1e3) as u16 } else { 0 }
        };
        (0..k.pixels()).map(pixel).collect()
    }

    fn height_over_the_floor(low: f32) -> f32 {
        let mut pose = level_camera();
        pose.translation = glam::Vec3A::new(0.3, 0.9, 3.2);
        let camera = DepthCamera { pose: Some(pose), ..DepthCamera::pinhole(Intrinsics::KINECT_V1) };
        let image = board(&camera, pose, low);
        let mut sequence = Sequence::new(camera, Vec::new()).expect("a camera");
        sequence.push(0, image.into_iter()).expect("an image");
        let session = sequence.finish().expect("a session");
        session.depth[0].camera_to_world.translation.y
    }

    #[test]
    fn a_known_camera_keeps_its_floor() {
        // Noise below the floor, or feet lost in it, move no person.
        for low in [-0.03, 0.0, 0.04, 0.12] {
            assert!((height_over_the_floor(low) - 0.9).abs() < 1e-5, "{low}");
        }
        // A world whose y = 0 is somewhere else: the lowest points stand on the floor.
        assert!((height_over_the_floor(-0.3) - 1.2).abs() < 0.02);
    }
}
