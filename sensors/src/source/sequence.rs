//! Depth images on their way into a session: straightened, counted, put in order of time, and set into our world.

use glam::{Affine3A, Mat3, Vec3};
use toile_assets::numeric::statistics::quantile_of;

use super::camera::Camera;
use super::lens::Straighten;
use crate::clock::SECOND_NS;
use crate::error::{Fault, Place};
use crate::frame::{DepthFrame, Intrinsics};
use crate::limits::MAX_DURATION_NS;
use crate::segment::floor::{Floor, FloorFinder};
use crate::session::{DepthRoom, Session};

/// Rate assumed of images without times (Hz): that of the Kinects.
const ASSUMED_HZ: u64 = 30;

/// Height of a camera of unknown pose above the floor (m): the middle of the 0.6 .. 1.8 m that Kinect's makers advise.
const ASSUMED_CAMERA_HEIGHT: f32 = 1.2;

/// Time of an image that has none: the `index`th at [`ASSUMED_HZ`] (ns).
pub(super) const fn assumed_time(index: usize) -> u64 {
    index as u64 * SECOND_NS / ASSUMED_HZ
}

/// What is said of a recording whose images have no times.
pub(super) fn untimed(images: usize) -> String {
    format!("the file holds no times: its {images} images are taken at {ASSUMED_HZ} Hz")
}

/// Depth images of one camera, as they come.
pub(super) struct Sequence {
    camera: Camera,
    straighten: Option<Straighten>,
    room: DepthRoom,
    start_ns: Option<u64>,
    backwards: usize,
    frames: Vec<DepthFrame>,
    /// What was assumed or repaired.
    pub notes: Vec<String>,
}

impl Sequence {
    /// No images yet; refused where the camera's lens is described by numbers of no lens.
    pub fn new(camera: Camera, mut notes: Vec<String>) -> Result<Self, Fault> {
        let bent = camera.distortion.as_ref();
        let straighten = match bent.map(|lens| Straighten::new(camera.intrinsics, lens)) {
            None => None,
            Some(Some(table)) => {
                let (from, to) = (camera.intrinsics, table.straight);
                notes.push(format!(
                    "the lens bends straight lines: images of {} x {} pixels were straightened to {} x {}",
                    from.width, from.height, to.width, to.height
                ));
                Some(table)
            }
            Some(None) => {
                let cure = "give the coefficients k1 .. k6, p1, p2 of a calibrated lens, or leave them out";
                return Err(Fault::new(Place::Whole, "the distortion folds the image over itself", cure));
            }
        };
        Ok(Self {
            camera,
            straighten,
            room: DepthRoom::default(),
            start_ns: None,
            backwards: 0,
            frames: Vec::new(),
            notes,
        })
    }

    /// The camera that the images come from.
    pub fn sensor(&self) -> Intrinsics {
        self.camera.intrinsics
    }

    /// The camera of the images that are kept.
    fn kept(&self) -> Intrinsics {
        self.straighten.as_ref().map_or(self.camera.intrinsics, |s| s.straight)
    }

    /// Takes one image of the sensor's size (in the camera's units, 0 = nothing). One that goes back in time is dropped
    /// and counted.
    pub fn push(&mut self, time_ns: u64, samples: impl ExactSizeIterator<Item = u16>) -> Result<(), Fault> {
        let index = self.frames.len() + self.backwards;
        if samples.len() != self.camera.intrinsics.pixels() {
            let k = self.camera.intrinsics;
            let problem = format!("{} depths where the camera has {} x {} pixels", samples.len(), k.width, k.height);
            return Err(Fault::new(Place::Frame(index), problem, "give the camera JSON that fits"));
        }
        let start = *self.start_ns.get_or_insert(time_ns);
        let last = self.frames.last().map(|f| f.time_ns);
        let Some(time_ns) = time_ns.checked_sub(start).filter(|t| last.is_none_or(|last| *t > last)) else {
            self.backwards += 1;
            return Ok(());
        };
        if time_ns > MAX_DURATION_NS {
            let problem = "its time lies more than two hours after the first image";
            return Err(Fault::new(Place::Frame(index), problem, "cut the recording where the clock was set"));
        }
        let intrinsics = self.kept();
        self.room.take(&intrinsics)?;
        let scale = self.camera.mm_per_unit;
        let raw: Box<[u16]> = if scale == 1.0 {
            samples.collect()
        } else {
            // What is too far for 16 bits of millimetres was not measured: the cast saturates.
            samples.map(|d| (f32::from(d) * scale).round() as u16).map(|d| if d == u16::MAX { 0 } else { d }).collect()
        };
        let depth_mm = match &self.straighten {
            Some(table) => table.apply(&raw),
            None => raw,
        };
        let camera_to_world = self.camera.pose.unwrap_or_else(level_camera);
        self.frames.push(DepthFrame { time_ns, intrinsics, camera_to_world, depth_mm });
        Ok(())
    }

    /// All images as a session in our world.
    pub fn finish(mut self) -> Result<Session, Fault> {
        if self.backwards > 0 {
            let total = self.frames.len() + self.backwards;
            self.notes.push(format!("{} of {total} images went back in time and were dropped", self.backwards));
        }
        place(&mut self.frames, self.camera.pose.is_some(), &mut self.notes)?;
        Ok(Session { depth: self.frames, notes: self.notes, raw_scale_known: true, ..Session::default() })
    }
}

/// A level camera that the shopper faces: image right is the shopper's left (+x), down is -y, forward is -z.
fn level_camera() -> Affine3A {
    let rotation = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z);
    Affine3A::from_mat3_translation(rotation, Vec3::Y * ASSUMED_CAMERA_HEIGHT)
}

/// Sets the images into our world: the floor at y = 0, centred at what is seen. Where the pose is known, so is the floor, if
/// something stands near y = 0 of the camera's world; otherwise it lies under the lowest points. Of a camera of unknown pose
/// all comes from the floor that is seen.
fn place(depth: &mut [DepthFrame], posed: bool, notes: &mut Vec<String>) -> Result<(), Fault> {
    if !posed && let Some(floor) = depth.iter().take(TRIED).find_map(floor_of) {
        notes.push(format!(
            "the camera's pose is unknown: from the floor that it sees, it stands {:.2} m high and is tilted by {:.0} degrees",
            floor.height,
            floor.up.angle_between(Vec3::NEG_Y).to_degrees()
        ));
        depth.iter_mut().for_each(|f| f.camera_to_world = floor.pose());
        return centre(depth, |_| 0.0);
    }
    let mut floor_height = |low: f32| {
        if posed && low.abs() < AT_THE_FLOOR {
            return 0.0;
        }
        if posed {
            notes.push(format!(
                "the floor is put under the lowest points of the first image, at y = {low:.3} m of the camera's world"
            ));
            return low;
        }
        notes.push(format!(
            "the camera's pose is unknown and no floor is seen: level, {ASSUMED_CAMERA_HEIGHT} m above the floor is assumed, and heights depend on it"
        ));
        0.0
    };
    centre(depth, &mut floor_height)
}

/// Lowest points this near to y = 0 of a known camera's world stand on its floor (m): what lies lower is the noise of pixels
/// at the floor, what lies higher a foot that the picture cuts or that is lost in the floor.
const AT_THE_FLOOR: f32 = 0.15;

/// Images in which the floor is sought.
const TRIED: usize = 5;

/// The floor that a frame of unknown pose shows.
fn floor_of(frame: &DepthFrame) -> Option<Floor> {
    let mut finder = FloorFinder::default();
    finder.push(frame, Vec3::NEG_Y);
    finder.floor().copied()
}

/// Moves the world's origin under the median point of the first image that shows anything, at the floor.
fn centre(depth: &mut [DepthFrame], floor: impl FnOnce(f32) -> f32) -> Result<(), Fault> {
    let first = depth.iter().find(|f| f.depth_mm.iter().any(|d| *d != 0));
    let points: Vec<Vec3> = first.map(|f| f.points().collect()).unwrap_or_default();
    let axis = |k: usize, fraction| quantile_of(points.iter().map(|p| p[k]), fraction);
    let (Some(x), Some(low), Some(z)) = (axis(0, 0.5), axis(1, 0.002), axis(2, 0.5)) else {
        let cure = "record again with somebody in view";
        return Err(Fault::new(Place::Frame(0), "every depth image is empty", cure));
    };
    let floor = floor(low);
    let shift = Affine3A::from_translation(-Vec3::new(x, floor, z));
    for frame in depth {
        frame.camera_to_world = shift * frame.camera_to_world;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A board of a person's size at the origin, as a level camera sees it, with its lowest edge at a height (m).
    fn board(camera: &Camera, pose: Affine3A, low: f32) -> Vec<u16> {
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
        let camera = Camera { pose: Some(pose), ..Camera::pinhole(Intrinsics::KINECT_V1) };
        let image = board(&camera, pose, low);
        let mut sequence = Sequence::new(camera, Vec::new()).expect("a camera");
        sequence.push(0, image.into_iter()).expect("an image");
        let session = sequence.finish().expect("a session");
        session.depth[0].camera_to_world.translation.y
    }

    #[test]
    fn a_known_camera_keeps_its_floor_where_somebody_stands_on_it() {
        // Noise below the floor, or feet lost in it, move nobody.
        for low in [-0.03, 0.0, 0.04, 0.12] {
            assert!((height_over_the_floor(low) - 0.9).abs() < 1e-5, "{low}");
        }
        // A world whose y = 0 is somewhere else: the lowest points stand on the floor.
        assert!((height_over_the_floor(-0.3) - 1.2).abs() < 0.02);
    }
}
