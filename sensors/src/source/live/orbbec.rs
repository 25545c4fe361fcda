//! Orbbec's own cameras (Gemini, Astra 2, Femto) through OrbbecSDK 2; a recording (`.bag`) is played in time, once.
//!
//! Functions and layouts are declared as in `Pipeline.h`, `Frame.h`, `Context.h`, `Device.h`, `RecordPlayback.h`,
//! `StreamProfile.h` and `ObTypes.h` of version 2.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::time::{Duration, Instant};

use glam::{Mat3, Vec3};

use super::error::CameraError;
use super::library::{Library, LibraryName, functions};
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourPlace, LiveCamera, is_of_moment};
use crate::colour_camera::ColourCamera;
use crate::lens::BrownConrady;
use crate::source::camera::DepthCamera;
use toile_base::frame::Intrinsics;

pub(super) const LIBRARY: LibraryName = LibraryName {
    camera: NAME,
    library: "libOrbbecSDK",
    names: &["libOrbbecSDK.so.2", "libOrbbecSDK.so"],
    stems: &["libOrbbecSDK"],
    install: "pip install --no-deps --target /usr/local/lib/toile/cameras pyorbbecsdk2",
};

const NAME: &str = "camera of OrbbecSDK";

const STREAM_COLOUR: c_int = 2;
const STREAM_DEPTH: c_int = 3;
const FORMAT_RGB: c_int = 22;
const ANY: u32 = 0;
const SEVERITY_OFF: c_int = 5;

/// Distortion models by Brown and Conrady; the last alone has k4 to k6. The first two bend points sideways by their place after the
/// radial part and not before it, which is a twentieth of a pixel.
const BROWN_CONRADY: [c_int; 4] = [1, 2, 3, BROWN_CONRADY_K6];
const BROWN_CONRADY_K6: c_int = 4;

/// Longest that the first frame is waited for, by which the lens is known.
const FIRST: Duration = Duration::from_secs(5);

/// Longest that the first colour image is waited for behind that, where colour is wanted.
const FIRST_COLOUR: Duration = Duration::from_secs(1);

/// A recording that gives nothing for so long has ended.
const END: Duration = Duration::from_millis(1_500);

type ObHandle = *mut c_void;
type ObError = *mut c_void;

#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct ObIntrinsic {
    fx: f32,
    fy: f32,
    cx: f32,
    cy: f32,
    width: i16,
    height: i16,
}

#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct ObDistortion {
    k: [f32; 6],
    p: [f32; 2],
    model: c_int,
}

/// From one stream's axes to another's: a matrix row by row, and mm.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct ObExtrinsic {
    rotation: [f32; 9],
    translation_mm: [f32; 3],
}

functions! {
    /// The called functions of OrbbecSDK.
    OrbbecApi {
        fn ob_set_logger_severity(c_int, *mut ObError);
        fn ob_create_context(*mut ObError) -> ObHandle;
        fn ob_delete_context(ObHandle, *mut ObError);
        fn ob_query_device_list(ObHandle, *mut ObError) -> ObHandle;
        fn ob_device_list_get_count(ObHandle, *mut ObError) -> u32;
        fn ob_device_list_get_device(ObHandle, u32, *mut ObError) -> ObHandle;
        fn ob_device_list_get_device_by_serial_number(ObHandle, *const c_char, *mut ObError) -> ObHandle;
        fn ob_delete_device_list(ObHandle, *mut ObError);
        fn ob_create_playback_device(*const c_char, *mut ObError) -> ObHandle;
        fn ob_delete_device(ObHandle, *mut ObError);
        fn ob_create_pipeline_with_device(ObHandle, *mut ObError) -> ObHandle;
        fn ob_delete_pipeline(ObHandle, *mut ObError);
        fn ob_create_config(*mut ObError) -> ObHandle;
        fn ob_delete_config(ObHandle, *mut ObError);
        fn ob_config_enable_stream(ObHandle, c_int, *mut ObError);
        fn ob_config_enable_video_stream(ObHandle, c_int, u32, u32, u32, c_int, *mut ObError);
        fn ob_pipeline_start_with_config(ObHandle, ObHandle, *mut ObError);
        fn ob_pipeline_stop(ObHandle, *mut ObError);
        fn ob_pipeline_wait_for_frameset(ObHandle, u32, *mut ObError) -> ObHandle;
        fn ob_frameset_get_depth_frame(ObHandle, *mut ObError) -> ObHandle;
        fn ob_frameset_get_color_frame(ObHandle, *mut ObError) -> ObHandle;
        fn ob_delete_frame(ObHandle, *mut ObError);
        fn ob_frame_get_stream_profile(ObHandle, *mut ObError) -> ObHandle;
        fn ob_delete_stream_profile(ObHandle, *mut ObError);
        fn ob_video_stream_profile_get_fps(ObHandle, *mut ObError) -> u32;
        fn ob_video_stream_profile_get_intrinsic(ObHandle, *mut ObError) -> ObIntrinsic;
        fn ob_video_stream_profile_get_distortion(ObHandle, *mut ObError) -> ObDistortion;
        fn ob_stream_profile_get_extrinsic_to(ObHandle, ObHandle, *mut ObError) -> ObExtrinsic;
        fn ob_pipeline_enable_frame_sync(ObHandle, *mut ObError);
        fn ob_depth_frame_get_value_scale(ObHandle, *mut ObError) -> f32;
        fn ob_frame_get_format(ObHandle, *mut ObError) -> c_int;
        fn ob_frame_get_timestamp_us(ObHandle, *mut ObError) -> u64;
        fn ob_frame_get_data(ObHandle, *mut ObError) -> *mut u8;
        fn ob_frame_get_data_size(ObHandle, *mut ObError) -> u32;
        fn ob_video_frame_get_width(ObHandle, *mut ObError) -> u32;
        fn ob_video_frame_get_height(ObHandle, *mut ObError) -> u32;
        fn ob_error_get_message(ObError) -> *const c_char;
        fn ob_delete_error(ObError);
    }
}

/// A camera or a recording that is open.
pub(super) struct Orbbec {
    parts: Parts,
    info: CameraInfo,
    is_recording: bool,
    heard: Instant,
    first: Option<ObFrame>,
}

/// The parts of a pipeline, undone when dropped.
struct Parts {
    api: OrbbecApi,
    context: ObHandle,
    device: ObHandle,
    pipeline: ObHandle,
    config: ObHandle,
    started: bool,
}

/// Frames of one moment, or one frame, given back when dropped.
struct ObFrame(ObHandle, OrbbecApi);

/// The stream of a frame, given back when dropped.
struct ObProfile(ObHandle, OrbbecApi);

// SAFETY: the library may be called from any thread; `&mut self` lets one at a time.
unsafe impl Send for Orbbec {}

impl OrbbecApi {
    /// Calls a function with a place for its error, which becomes a sentence.
    fn call<T>(&self, what: &str, call: impl FnOnce(*mut ObError) -> T) -> Result<T, CameraError> {
        let mut error = ptr::null_mut();
        let value = call(&mut error);
        if error.is_null() {
            return Ok(value);
        }
        // SAFETY: the library made the error; its text ends with a zero and is read before the error is deleted, once.
        let said_by_library = unsafe {
            let text = (self.ob_error_get_message)(error);
            let text = if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() };
            (self.ob_delete_error)(error);
            text
        };
        Err(refused(what, said_by_library))
    }
}

fn refused(what: &str, said_by_library: String) -> CameraError {
    let cure = "plug it into a USB 3 port, and see that no other program has it and your user may use it";
    CameraError::Refused { camera: NAME, what: what.to_owned(), said_by_library, cure }
}

impl Orbbec {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        let library = Library::load(&LIBRARY, &options.libraries)?;
        let api = OrbbecApi::of(&library)?;
        let recording = which.filter(|which| Path::new(which).exists());
        let null = ptr::null_mut();
        let mut parts = Parts { api, context: null, device: null, pipeline: null, config: null, started: false };
        parts.find(which, recording)?;
        parts.start(options.colour, recording.is_some())?;
        let first = parts.first(options.colour && recording.is_none())?;
        let none = || refused("no depth comes of it", String::new());
        let (camera, rate_hz) = first.depth().ok_or_else(none)?.camera()?;
        let camera = DepthCamera { quarter_turns: options.quarter_turns, ..camera };
        let colour = first.colour_camera().map_or(ColourPlace::Unknown, ColourPlace::Beside);
        let device = which.map_or_else(|| "Orbbec".to_owned(), |which| format!("Orbbec {which}"));
        let info = CameraInfo { device, camera, rate_hz, placed: None, colour };
        Ok(Self { parts, info, is_recording: recording.is_some(), heard: Instant::now(), first: Some(first) })
    }
}

impl Parts {
    /// Finds the device, or opens the recording.
    fn find(&mut self, which: Option<&str>, recording: Option<&str>) -> Result<(), CameraError> {
        let api = self.api;
        let text = which.map(CString::new).transpose();
        let text = text.map_err(|_| refused("its name has a zero in it", String::new()))?;
        // SAFETY: a number and a place for an error, which every call below gets too.
        api.call("", |e| unsafe { (api.ob_set_logger_severity)(SEVERITY_OFF, e) })?;
        // SAFETY: takes nothing else.
        self.context = api.call("OrbbecSDK cannot be started", |e| unsafe { (api.ob_create_context)(e) })?;
        if let (Some(path), Some(text)) = (recording, &text) {
            // SAFETY: the path ends with a zero and outlives the call.
            let opened = api.call("", |e| unsafe { (api.ob_create_playback_device)(text.as_ptr(), e) });
            self.device = opened.map_err(|_| {
                CameraError::Recording(format!("{path}: it is no recording of OrbbecSDK; record it again"))
            })?;
            return Ok(());
        }
        // SAFETY: the context is valid.
        let list =
            api.call("its devices cannot be listed", |e| unsafe { (api.ob_query_device_list)(self.context, e) })?;
        let device = match &text {
            // SAFETY: the list is valid until it is deleted below, and the serial number ends with a zero.
            Some(serial) => api.call("it cannot be opened", |e| unsafe {
                (api.ob_device_list_get_device_by_serial_number)(list, serial.as_ptr(), e)
            }),
            // SAFETY: the list is valid until it is deleted below.
            None => match api.call("", |e| unsafe { (api.ob_device_list_get_count)(list, e) }) {
                Ok(0) | Err(_) => Err(CameraError::NotConnected {
                    camera: NAME,
                    cure: "plug it into a USB 3 port, and see that OrbbecSDK's rules for udev let your user use it",
                }),
                // SAFETY: the list is valid until it is deleted below, and it has a device 0 since its count is not 0.
                Ok(_) => api.call("it cannot be opened", |e| unsafe { (api.ob_device_list_get_device)(list, 0, e) }),
            },
        };
        // SAFETY: the list is valid, and is used no more.
        let _ = api.call("", |e| unsafe { (api.ob_delete_device_list)(list, e) });
        self.device = device?;
        Ok(())
    }

    fn start(&mut self, colour: bool, is_recording: bool) -> Result<(), CameraError> {
        let (api, what) = (self.api, "it cannot be started");
        // SAFETY: the device is valid.
        self.pipeline = api.call(what, |e| unsafe { (api.ob_create_pipeline_with_device)(self.device, e) })?;
        // SAFETY: takes nothing else.
        self.config = api.call(what, |e| unsafe { (api.ob_create_config)(e) })?;
        // SAFETY: the configuration is valid, here and below.
        api.call("its depth cannot be chosen", |e| unsafe {
            (api.ob_config_enable_stream)(self.config, STREAM_DEPTH, e);
        })?;
        if colour && !is_recording {
            // SAFETY: the configuration was made above and is valid.
            api.call("its colour cannot be chosen", |e| unsafe {
                (api.ob_config_enable_video_stream)(self.config, STREAM_COLOUR, ANY, ANY, ANY, FORMAT_RGB, e);
            })?;
            // A device that cannot take both at one time gives what it has; what is too far apart is passed over.
            // SAFETY: the pipeline is valid.
            let _ = api.call("", |e| unsafe { (api.ob_pipeline_enable_frame_sync)(self.pipeline, e) });
        }
        // SAFETY: both live.
        api.call(what, |e| unsafe { (api.ob_pipeline_start_with_config)(self.pipeline, self.config, e) })?;
        self.started = true;
        Ok(())
    }

    /// The first frames that hold depth, and colour where it is waited for and comes.
    fn first(&mut self, colour: bool) -> Result<ObFrame, CameraError> {
        let mut until = Instant::now() + FIRST;
        let mut first = None;
        while Instant::now() < until {
            let Some(frames) = self.wait(FIRST)?.filter(|frames| frames.depth().is_some()) else { continue };
            if !colour || frames.colour().is_some() {
                return Ok(frames);
            }
            if first.is_none() {
                until = Instant::now() + FIRST_COLOUR;
            }
            first = Some(frames);
        }
        first.ok_or_else(|| refused("no depth comes of it", String::new()))
    }

    /// The frames of the next moment; none in that time.
    fn wait(&mut self, patience: Duration) -> Result<Option<ObFrame>, CameraError> {
        let (api, ms) = (self.api, patience.as_millis().max(1) as u32);
        // SAFETY: the pipeline is valid and is started.
        let frames =
            api.call("it is gone", |e| unsafe { (api.ob_pipeline_wait_for_frameset)(self.pipeline, ms, e) })?;
        Ok((!frames.is_null()).then_some(ObFrame(frames, api)))
    }
}

impl Drop for Parts {
    fn drop(&mut self) {
        let api = self.api;
        let undo = |handle: ObHandle, f: unsafe extern "C" fn(ObHandle, *mut ObError)| {
            if !handle.is_null() {
                // SAFETY: the library made it, and it is undone once, what uses another before that.
                let _ = api.call("", |e| unsafe { f(handle, e) });
            }
        };
        if self.started {
            undo(self.pipeline, api.ob_pipeline_stop);
        }
        undo(self.config, api.ob_delete_config);
        undo(self.pipeline, api.ob_delete_pipeline);
        undo(self.device, api.ob_delete_device);
        undo(self.context, api.ob_delete_context);
    }
}

impl ObFrame {
    fn part(&self, f: unsafe extern "C" fn(ObHandle, *mut ObError) -> ObHandle) -> Option<ObFrame> {
        // SAFETY: the frames live; what is given is a reference of our own, or nothing.
        let frame = self.1.call("", |e| unsafe { f(self.0, e) }).ok()?;
        (!frame.is_null()).then_some(ObFrame(frame, self.1))
    }

    fn depth(&self) -> Option<ObFrame> {
        self.part(self.1.ob_frameset_get_depth_frame)
    }

    fn colour(&self) -> Option<ObFrame> {
        self.part(self.1.ob_frameset_get_color_frame)
    }

    /// The camera of a depth frame, and its rate (Hz).
    fn camera(&self) -> Result<(DepthCamera, f32), CameraError> {
        let (api, what) = (self.1, "its lens cannot be read");
        let profile = self.profile().ok_or_else(|| refused(what, String::new()))?;
        let (intrinsics, lens) = self.lens(&profile)?;
        // SAFETY: the profile is valid.
        let rate = api.call(what, |e| unsafe { (api.ob_video_stream_profile_get_fps)(profile.0, e) })?;
        // SAFETY: a depth frame that is valid.
        let scale = api.call(what, |e| unsafe { (api.ob_depth_frame_get_value_scale)(self.0, e) })?;
        let mm_per_unit = if scale > 0.0 { scale } else { 1.0 };
        let camera = DepthCamera { distortion: lens.lens(), mm_per_unit, ..DepthCamera::pinhole(intrinsics) };
        Ok((camera, rate.max(1) as f32))
    }

    /// The colour camera of frames that hold colour, in the depth camera's axes; none where its lens is not known here.
    fn colour_camera(&self) -> Option<ColourCamera> {
        let api = self.1;
        let (depth, colour) = (self.depth()?.profile()?, self.colour()?);
        let profile = colour.profile()?;
        let (intrinsics, lens) = colour.lens(&profile).ok()?;
        // SAFETY: both profiles are valid.
        let extrinsic = |e| unsafe { (api.ob_stream_profile_get_extrinsic_to)(depth.0, profile.0, e) };
        let place = api.call("", extrinsic).ok()?;
        lens.is_known().then(|| {
            let rotation = Mat3::from_cols_array(&place.rotation).transpose();
            ColourCamera::beside(intrinsics, lens.lens(), rotation, Vec3::from_array(place.translation_mm) * 1e-3)
        })
    }

    fn profile(&self) -> Option<ObProfile> {
        let api = self.1;
        // SAFETY: the frame is valid; the profile is a reference of our own.
        let profile = api.call("", |e| unsafe { (api.ob_frame_get_stream_profile)(self.0, e) }).ok()?;
        (!profile.is_null()).then_some(ObProfile(profile, api))
    }

    /// The lens of a video frame of this profile.
    fn lens(&self, profile: &ObProfile) -> Result<(Intrinsics, ObDistortion), CameraError> {
        let (api, what) = (self.1, "its lens cannot be read");
        // SAFETY: the profile is valid, here and below.
        let k = api.call(what, |e| unsafe { (api.ob_video_stream_profile_get_intrinsic)(profile.0, e) })?;
        // SAFETY: `profile` holds a reference of ours to the profile until it is dropped.
        let lens = api.call(what, |e| unsafe { (api.ob_video_stream_profile_get_distortion)(profile.0, e) })?;
        let [width, height] = self.size().ok_or_else(|| refused(what, String::new()))?;
        Ok((Intrinsics { width, height, fx: k.fx, fy: k.fy, cx: k.cx, cy: k.cy }, lens))
    }

    fn time_ns(&self) -> Option<u64> {
        let api = self.1;
        // SAFETY: the frame is valid.
        let us = api.call("", |e| unsafe { (api.ob_frame_get_timestamp_us)(self.0, e) }).ok()?;
        Some(us.saturating_mul(1_000))
    }

    fn size(&self) -> Option<[u32; 2]> {
        let api = self.1;
        // SAFETY: a video frame that is valid.
        let side =
            |f: unsafe extern "C" fn(ObHandle, *mut ObError) -> u32| api.call("", |e| unsafe { f(self.0, e) }).ok();
        Some([side(api.ob_video_frame_get_width)?, side(api.ob_video_frame_get_height)?])
    }

    /// The bytes of a video frame of so many a pixel; none where it is shorter than its size.
    fn bytes(&self, bytes: usize) -> Option<&[u8]> {
        let (api, [w, h]) = (self.1, self.size()?);
        // SAFETY: the frame is valid.
        let data = api.call("", |e| unsafe { (api.ob_frame_get_data)(self.0, e) }).ok()?;
        // SAFETY: `self` keeps the frame until it is dropped.
        let size = api.call("", |e| unsafe { (api.ob_frame_get_data_size)(self.0, e) }).ok()? as usize;
        let wanted = (w as usize).checked_mul(h as usize)?.checked_mul(bytes)?;
        if data.is_null() || size < wanted {
            return None;
        }
        // SAFETY: the library says that `size` bytes lie there, and keeps them until the frame is deleted.
        Some(&unsafe { std::slice::from_raw_parts(data, size) }[..wanted])
    }
}

impl Drop for ObProfile {
    fn drop(&mut self) {
        let api = self.1;
        // SAFETY: the profile is our own reference, given back once.
        let _ = api.call("", |e| unsafe { (api.ob_delete_stream_profile)(self.0, e) });
    }
}

impl Drop for ObFrame {
    fn drop(&mut self) {
        let api = self.1;
        // SAFETY: the frame is our own reference, given back once.
        let _ = api.call("", |e| unsafe { (api.ob_delete_frame)(self.0, e) });
    }
}

impl ObDistortion {
    /// Whether it is known how the lens bends: a fisheye's is not.
    fn is_known(&self) -> bool {
        let bends = self.k.iter().chain(&self.p).any(|c| *c != 0.0);
        BROWN_CONRADY.contains(&self.model) || self.model == 0 || !bends
    }

    /// The lens, where it bends by a model that is known here.
    fn lens(&self) -> Option<BrownConrady> {
        let bends = BROWN_CONRADY.contains(&self.model) && self.k.iter().chain(&self.p).any(|c| *c != 0.0);
        let mut k = self.k;
        if self.model != BROWN_CONRADY_K6 {
            k[3..].fill(0.0);
        }
        bends.then_some(BrownConrady { k, p: self.p, centre: [0.0; 2], widest: f32::INFINITY })
    }
}

impl LiveCamera for Orbbec {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let frames = match self.first.take() {
            Some(first) => Some(first),
            None => self.parts.wait(patience)?,
        };
        let Some(depth) = frames.as_ref().and_then(ObFrame::depth) else {
            let ended = self.is_recording && self.heard.elapsed() > END;
            return Ok(if ended { Arrival::Ended } else { Arrival::Nothing });
        };
        self.heard = Instant::now();
        let api = self.parts.api;
        frame.device_ns = depth.time_ns().ok_or_else(|| refused("its stamps cannot be read", String::new()))?;
        if let Some(bytes) = depth.bytes(2) {
            frame.depth.extend(bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])));
        }
        let (depth_ns, rate_hz) = (frame.device_ns, self.info.rate_hz);
        let of_moment = |colour: &ObFrame| colour.time_ns().is_some_and(|ns| is_of_moment(depth_ns, ns, rate_hz));
        if let Some(colour) = frames.as_ref().and_then(ObFrame::colour).filter(of_moment) {
            // SAFETY: the frame is valid.
            let format = api.call("", |e| unsafe { (api.ob_frame_get_format)(colour.0, e) })?;
            if let (Some([w, h]), Some(bytes), FORMAT_RGB) = (colour.size(), colour.bytes(3), format) {
                (frame.colour.width, frame.colour.height) = (w, h);
                frame.colour.rgb.extend_from_slice(bytes);
            }
        }
        Ok(Arrival::Frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layouts_are_those_of_the_headers() {
        assert_eq!((size_of::<ObIntrinsic>(), size_of::<ObDistortion>(), size_of::<ObExtrinsic>()), (20, 36, 48));
    }

    #[test]
    fn lenses_of_four_models_are_known_and_a_fisheyes_is_not() {
        assert!(ObDistortion { k: [0.0; 6], p: [0.0; 2], model: 4 }.lens().is_none());
        for model in 0..=5 {
            let lens = ObDistortion { k: [0.1; 6], p: [0.0; 2], model };
            assert_eq!(lens.is_known(), model < 5, "{model}");
            let rational = lens.lens().map(|lens| lens.k[3]);
            assert_eq!(rational, [None, Some(0.0), Some(0.0), Some(0.0), Some(0.1), None][model as usize]);
        }
    }
}
