//! Recordings: a sensor's data of a person, and their measures.

use std::ffi::{CString, c_char};

use toile_sdk::glam::Affine3A;
use toile_sdk::{DepthFrame, Intrinsics, Joints, Measure, Measured, Recording, Shopper};

use crate::body::{BodyHandle, BodyObject, GivenMeasure, measures, optional_sex};
use crate::border::{Buffer, In, Out, Text};
use crate::failure::{Code, Failure, Result, call};
use crate::garment::{GarmentHandle, garments};
use crate::handle::{Handle, Held, stands_for};
use crate::joints::JointFrame;
use crate::texts::lent;

/// What a sensor saw of one person: frames of joints, depth images, or both.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RecordingHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// A measured person.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MeasuredHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// Filtered frames of joints that a scene can follow.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct TrackHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// A depth image of the caller's own sensor.
#[repr(C)]
#[derive(Debug)]
pub struct DepthImage {
    /// Time since the session began (ns).
    pub time_ns: u64,
    /// Width (px).
    pub width: u32,
    /// Height (px).
    pub height: u32,
    /// Focal length along x (px).
    pub fx: f32,
    /// Focal length along y (px).
    pub fy: f32,
    /// Principal point x (px).
    pub cx: f32,
    /// Principal point y (px).
    pub cy: f32,
    /// Camera (x right, y down, z forward) to world (m): three columns of the rotation, then the place.
    pub camera_to_world: [f32; 12],
    /// Depth of each pixel (mm), row by row from the top; 0 where nothing was seen.
    pub depth_mm: In<u16>,
    /// Pixels that `depth_mm` has: width times height.
    pub pixels: usize,
}

/// What is known of a person before they are measured. Zeros throughout, { 0 }, are: nothing.
#[repr(C)]
#[derive(Debug)]
pub struct ShopperKnown {
    /// A toile_sex.
    pub sex: i32,
    /// Whether it is a child: 1 is yes, -1 is no, 0 is not known.
    pub child: i32,
    /// Whether they wear nothing that stands off the skin; otherwise everyday clothes, which the body lies beneath.
    pub tight_clothes: u8,
    /// Whether they sit: nothing is taken from legs and hips, which a chair hides.
    pub seated: u8,
    /// Measures that were taken by tape; all others follow them. Null is none.
    pub by_tape: In<GivenMeasure>,
    /// How many.
    pub by_tape_count: usize,
}

/// What a recording has.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RecordingFacts {
    /// Time of the last frame (s); the first is at 0.
    pub seconds: f64,
    /// Frames of joints.
    pub joint_frames: usize,
    /// Depth images.
    pub depth_frames: usize,
}

/// A measure of a measured person. Texts are lent by the handle that was asked.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct TakenMeasure {
    /// Its name, such as "waist_girth".
    pub name: *const c_char,
    /// The value (mm).
    pub mm: f64,
    /// Standard deviation of the value (mm).
    pub sigma_mm: f64,
    /// Whether it was seen; where it was not, it is what a body with the others has on average.
    pub seen: bool,
    /// Where it is taken.
    pub definition: *const c_char,
}

/// What is known of a measured person.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MeasuredFacts {
    /// Measures that toile_measured_measure gives.
    pub measures: usize,
    /// Odds that it is a child, 0 to 1; NaN without a stature. Bodies and sizes here are adults'.
    pub child: f32,
}

/// Measures with their texts.
#[derive(Debug)]
pub struct MeasureList(Vec<(Measure, CString, CString)>);

/// What a measured person's handle stands for.
#[derive(Debug)]
pub struct MeasuredObject {
    measured: Measured,
    measures: MeasureList,
}

/// What a recording's handle stands for.
#[derive(Debug)]
pub struct RecordingObject(pub Recording);

/// What a track's handle stands for.
#[derive(Debug)]
pub struct TrackObject(Vec<JointFrame>);

stands_for!(RecordingHandle, RecordingObject, "recording");
stands_for!(MeasuredHandle, MeasuredObject, "measured person");
stands_for!(TrackHandle, TrackObject, "track");

impl MeasureList {
    pub fn new(measures: Vec<Measure>) -> Self {
        let texts = |measure: Measure| (measure, lent(measure.name), lent(measure.definition));
        Self(measures.into_iter().map(texts).collect())
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// One by its number.
    pub fn at(&self, index: usize) -> Result<TakenMeasure> {
        let found = self.0.get(index);
        let (measure, name, definition) = found.ok_or_else(|| {
            Failure::usage(format!("there is no measure {index}: there are {}, counted from 0", self.len()))
        })?;
        let Measure { mm, sigma_mm, seen, .. } = *measure;
        Ok(TakenMeasure { name: name.as_ptr(), mm, sigma_mm, seen, definition: definition.as_ptr() })
    }
}

impl ShopperKnown {
    /// The facts as the SDK has them; of null nothing is known.
    pub fn shopper(given: &In<Self>) -> Result<Shopper> {
        let Some(given) = given.optional("shopper")? else {
            return Ok(Shopper::default());
        };
        let child = match given.child {
            0 => None,
            1 => Some(true),
            -1 => Some(false),
            other => {
                return Err(Failure::usage(format!("{other} does not say whether it is a child; give 1, -1 or 0")));
            }
        };
        let by_tape = measures(&given.by_tape, given.by_tape_count)?;
        Ok(Shopper {
            sex: optional_sex(given.sex)?,
            child,
            tight_clothes: given.tight_clothes != 0,
            seated: given.seated != 0,
            by_tape_mm: by_tape.into_iter().map(|(name, mm)| (name.to_owned(), mm)).collect(),
        })
    }
}

impl DepthImage {
    fn frame(&self) -> Result<DepthFrame> {
        let camera = &self.camera_to_world;
        if !camera.iter().all(|number| number.is_finite()) {
            return Err(Failure::input(
                "the place of a depth image's camera is not finite; give three columns and the place",
            ));
        }
        let Self { width, height, fx, fy, cx, cy, .. } = *self;
        Ok(DepthFrame {
            time_ns: self.time_ns,
            intrinsics: Intrinsics { width, height, fx, fy, cx, cy },
            camera_to_world: Affine3A::from_cols_array(camera),
            depth_mm: self.depth_mm.slice(self.pixels, "pixels of a depth image")?.into(),
        })
    }
}

/// Opens a recording: MCAP, Kinect CSV, Kinectron JSON, BVH, Azure Kinect, OpenNI, OpenPose, depth images and others (docs/depth.md).
/// `camera` is null, or a JSON file that describes the camera of depth images which have none of their own.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_open(path: Text, camera: Text, recording: Out<RecordingHandle>) -> Code {
    call("toile_recording_open", || {
        let place = recording.empty("recording")?;
        let path = path.of("path")?;
        let opened = match camera.optional("camera")? {
            Some(camera) => Recording::open_with_camera(path, camera)?,
            None => Recording::open(path)?,
        };
        place.set(RecordingHandle::open(RecordingObject(opened)));
        Ok(())
    })
}

/// The recording that comes with Toile.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_embedded(recording: Out<RecordingHandle>) -> Code {
    call("toile_recording_embedded", || {
        let place = recording.empty("recording")?;
        place.set(RecordingHandle::open(RecordingObject(Recording::embedded()?)));
        Ok(())
    })
}

/// Frames that a sensor of the caller's own saw, in metres, y up, the floor at y = 0, the person facing +z; times rise from frame to
/// frame. One of the two may be none.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_from_frames(
    name: Text,
    joints: In<JointFrame>,
    joint_frames: usize,
    depth: In<DepthImage>,
    depth_frames: usize,
    recording: Out<RecordingHandle>,
) -> Code {
    call("toile_recording_from_frames", || {
        let place = recording.empty("recording")?;
        let joints: Vec<Joints> = joints.slice(joint_frames, "frames of joints")?.iter().map(Into::into).collect();
        let depth = depth.slice(depth_frames, "depth images")?.iter().map(DepthImage::frame);
        let made = Recording::from_frames(name.of("name")?, joints, depth.collect::<Result<_>>()?)?;
        place.set(RecordingHandle::open(RecordingObject(made)));
        Ok(())
    })
}

/// What a recording has.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_read(recording: RecordingHandle, facts: Out<RecordingFacts>) -> Code {
    call("toile_recording_read", || {
        let (place, of) = (facts.place("facts")?, recording.get()?);
        let (joint_frames, depth_frames) = (of.0.joints().len(), of.0.depth().len());
        place.set(RecordingFacts { seconds: of.0.seconds(), joint_frames, depth_frames });
        Ok(())
    })
}

/// Measures the person in a recording: by a body fitted to depth where there is any, by the joints otherwise. `shopper` may be
/// null: nothing is known before.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_measure(
    recording: RecordingHandle,
    shopper: In<ShopperKnown>,
    measured: Out<MeasuredHandle>,
) -> Code {
    call("toile_recording_measure", || {
        let place = measured.empty("measured person")?;
        let taken = recording.get()?.0.measure(&ShopperKnown::shopper(&shopper)?)?;
        let measures = MeasureList::new(taken.measures());
        place.set(MeasuredHandle::open(MeasuredObject { measured: taken, measures }));
        Ok(())
    })
}

/// The filtered joints from the moment on at which the person can be dressed; of depth alone, the body is followed through it.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_track(
    recording: RecordingHandle,
    measured: MeasuredHandle,
    track: Out<TrackHandle>,
) -> Code {
    call("toile_recording_track", || {
        let place = track.empty("track")?;
        let joints = recording.get()?.0.track(&measured.get()?.measured)?;
        place.set(TrackHandle::open(TrackObject(joints.iter().map(Into::into).collect())));
        Ok(())
    })
}

/// The frames of a track, lent by it: what toile_dress_options takes.
#[unsafe(no_mangle)]
pub extern "C" fn toile_track_frames(track: TrackHandle, frames: Out<*const JointFrame>, count: Out<usize>) -> Code {
    call("toile_track_frames", || {
        let (frames, count, of) = (frames.place("frames")?, count.place("count")?, track.get()?);
        frames.set(of.0.as_ptr());
        count.set(of.0.len());
        Ok(())
    })
}

/// What is known of a measured person.
#[unsafe(no_mangle)]
pub extern "C" fn toile_measured_read(measured: MeasuredHandle, facts: Out<MeasuredFacts>) -> Code {
    call("toile_measured_read", || {
        let (place, of) = (facts.place("facts")?, measured.get()?);
        place.set(MeasuredFacts { measures: of.measures.len(), child: of.measured.child().unwrap_or(f32::NAN) });
        Ok(())
    })
}

/// A measure of a person by its number from 0.
#[unsafe(no_mangle)]
pub extern "C" fn toile_measured_measure(measured: MeasuredHandle, index: usize, measure: Out<TakenMeasure>) -> Code {
    call("toile_measured_measure", || {
        let (place, of) = (measure.place("measure")?, measured.get()?);
        place.set(of.measures.at(index)?);
        Ok(())
    })
}

/// Notes on the measures, a line each, as a text into `bytes`; its length with the closing zero into `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_measured_notes(
    measured: MeasuredHandle,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_measured_notes", || bytes.text(&measured.get()?.measured.notes().join("\n"), room, &needed))
}

/// The body of a person's measures. Where the sex is neither known nor seen it is that of whom the garments are made for, of none a
/// woman's.
#[unsafe(no_mangle)]
pub extern "C" fn toile_measured_body(
    measured: MeasuredHandle,
    worn: In<GarmentHandle>,
    count: usize,
    body: Out<BodyHandle>,
) -> Code {
    call("toile_measured_body", || {
        let place = body.empty("body")?;
        let made = measured.get()?.measured.body_for(&garments(&worn, count)?)?;
        place.set(BodyHandle::open(BodyObject::new(made)));
        Ok(())
    })
}

/// Closes a recording.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recording_close(recording: RecordingHandle) -> Code {
    call("toile_recording_close", || recording.close())
}

/// Closes what is known of a person.
#[unsafe(no_mangle)]
pub extern "C" fn toile_measured_close(measured: MeasuredHandle) -> Code {
    call("toile_measured_close", || measured.close())
}

/// Closes a track. Scenes that follow it keep what they need.
#[unsafe(no_mangle)]
pub extern "C" fn toile_track_close(track: TrackHandle) -> Code {
    call("toile_track_close", || track.close())
}
