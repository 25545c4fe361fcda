//! RealSense through librealsense2's C interface: depth in units of the device, colour on demand; a recording (`.bag`, `.db3`) is
//! played in time, once.
//!
//! Functions and layouts are declared as in `rs.h`, `rs_types.h`, `rs_pipeline.h`, `rs_config.h`, `rs_frame.h` and `rs_sensor.h`.

#![allow(unsafe_code, reason = "a C library is called")]

use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr;
use std::time::{Duration, Instant};

use super::error::CameraError;
use super::library::{Library, LibraryName, functions};
use super::live_camera::{Arrival, CameraFrame, CameraInfo, CameraOptions, ColourPlace, LiveCamera, is_of_moment};
use super::realsense_lens::{RsExtrinsics, RsIntrinsics};
use crate::colour_camera::ColourCamera;
use crate::source::camera::DepthCamera;

pub(super) const LIBRARY: LibraryName = LibraryName {
    camera: NAME,
    library: "librealsense2",
    names: &[
        "librealsense2.so.2.59",
        "librealsense2.so.2.58",
        "librealsense2.so.2.57",
        "librealsense2.so.2.56",
        "librealsense2.so",
    ],
    stems: &["librealsense2", "pyrealsense2"],
    install: "sudo apt install libpython3.11 libusb-1.0-0 && pip install --no-deps --python-version 3.11 \
              --only-binary=:all: --target /usr/local/lib/toile/cameras pyrealsense2",
};

const NAME: &str = "RealSense";

const STREAM_DEPTH: c_int = 1;
const STREAM_COLOUR: c_int = 2;
const FORMAT_ANY: c_int = 0;
const FORMAT_Z16: c_int = 1;
const FORMAT_RGB8: c_int = 5;

/// The mode that is asked of a camera (px, Hz): all of them have it.
const MODE: [c_int; 3] = [640, 480, 30];

/// Longest that the first frame is waited for, by which the lens is known.
const FIRST: Duration = Duration::from_secs(5);

/// A recording that gives nothing for so long has ended: its player does not say so through a pipeline.
const END: Duration = Duration::from_millis(1_500);

/// Least that is waited for at once (ms).
const LEAST_MS: u128 = 1;

type RsHandle = *mut c_void;
type RsError = *mut c_void;

functions! {
    /// The called functions of librealsense.
    RealSenseApi {
        fn rs2_get_api_version(*mut RsError) -> c_int;
        fn rs2_create_context(c_int, *mut RsError) -> RsHandle;
        fn rs2_delete_context(RsHandle);
        fn rs2_query_devices(RsHandle, *mut RsError) -> RsHandle;
        fn rs2_get_device_count(RsHandle, *mut RsError) -> c_int;
        fn rs2_delete_device_list(RsHandle);
        fn rs2_create_pipeline(RsHandle, *mut RsError) -> RsHandle;
        fn rs2_delete_pipeline(RsHandle);
        fn rs2_create_config(*mut RsError) -> RsHandle;
        fn rs2_delete_config(RsHandle);
        fn rs2_config_enable_stream(RsHandle, c_int, c_int, c_int, c_int, c_int, c_int, *mut RsError);
        fn rs2_config_enable_device(RsHandle, *const c_char, *mut RsError);
        fn rs2_config_enable_device_from_file_repeat_option(RsHandle, *const c_char, c_int, *mut RsError);
        fn rs2_pipeline_start_with_config(RsHandle, RsHandle, *mut RsError) -> RsHandle;
        fn rs2_pipeline_stop(RsHandle, *mut RsError);
        fn rs2_delete_pipeline_profile(RsHandle);
        fn rs2_pipeline_profile_get_streams(RsHandle, *mut RsError) -> RsHandle;
        fn rs2_get_stream_profiles_count(RsHandle, *mut RsError) -> c_int;
        fn rs2_get_stream_profile(RsHandle, c_int, *mut RsError) -> RsHandle;
        fn rs2_delete_stream_profiles_list(RsHandle);
        fn rs2_get_extrinsics(RsHandle, RsHandle, *mut RsExtrinsics, *mut RsError);
        fn rs2_pipeline_try_wait_for_frames(RsHandle, *mut RsHandle, c_uint, *mut RsError) -> c_int;
        fn rs2_embedded_frames_count(RsHandle, *mut RsError) -> c_int;
        fn rs2_extract_frame(RsHandle, c_int, *mut RsError) -> RsHandle;
        fn rs2_release_frame(RsHandle);
        fn rs2_get_frame_stream_profile(RsHandle, *mut RsError) -> RsHandle;
        fn rs2_get_stream_profile_data(RsHandle, *mut c_int, *mut c_int, *mut c_int, *mut c_int, *mut c_int, *mut RsError);
        fn rs2_get_video_stream_intrinsics(RsHandle, *mut RsIntrinsics, *mut RsError);
        fn rs2_depth_frame_get_units(RsHandle, *mut RsError) -> f32;
        fn rs2_get_frame_data(RsHandle, *mut RsError) -> *const c_void;
        fn rs2_get_frame_data_size(RsHandle, *mut RsError) -> c_int;
        fn rs2_get_frame_width(RsHandle, *mut RsError) -> c_int;
        fn rs2_get_frame_height(RsHandle, *mut RsError) -> c_int;
        fn rs2_get_frame_stride_in_bytes(RsHandle, *mut RsError) -> c_int;
        fn rs2_get_frame_timestamp(RsHandle, *mut RsError) -> f64;
        fn rs2_get_error_message(RsError) -> *const c_char;
        fn rs2_free_error(RsError);
    }
}

/// A camera or a recording that is open.
pub(super) struct RealSense {
    pipeline: Pipeline,
    info: CameraInfo,
    is_recording: bool,
    heard: Instant,
    /// The first frames, by which the lens is known.
    first: Option<Frames>,
}

/// The pipeline and what it is made of, undone when dropped.
struct Pipeline {
    api: RealSenseApi,
    context: RsHandle,
    pipeline: RsHandle,
    config: RsHandle,
    profile: RsHandle,
}

/// Frames of one moment, or one frame, given back when dropped.
struct Frames(RsHandle, RealSenseApi);

// SAFETY: the library may be called from any thread; `&mut self` lets one at a time.
unsafe impl Send for RealSense {}

/// Kind of one stream.
struct StreamKind {
    stream: c_int,
    format: c_int,
    rate: c_int,
}

impl RealSenseApi {
    /// Calls a function with a place for its error, which becomes a sentence.
    fn call<T>(&self, what: &str, call: impl FnOnce(*mut RsError) -> T) -> Result<T, CameraError> {
        let mut error = ptr::null_mut();
        let value = call(&mut error);
        if error.is_null() {
            return Ok(value);
        }
        // SAFETY: the library made the error; its text ends with a zero and is read before the error is freed, once.
        let said_by_library = unsafe {
            let text = (self.rs2_get_error_message)(error);
            let text = if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() };
            (self.rs2_free_error)(error);
            text
        };
        let cure = "plug it into a USB 3 port, and see that no other program has it and your user may use it";
        Err(CameraError::Refused { camera: NAME, what: what.to_owned(), said_by_library, cure })
    }

    /// What a profile is of.
    fn kind_of(&self, profile: RsHandle) -> Option<StreamKind> {
        let (mut kind, mut index, mut id) = (StreamKind { stream: 0, format: 0, rate: 0 }, 0, 0);
        let StreamKind { stream, format, rate } = &mut kind;
        // SAFETY: the profile is valid, and five places for a number are handed over.
        self.call("", |e| unsafe {
            (self.rs2_get_stream_profile_data)(profile, stream, format, &mut index, &mut id, rate, e);
        })
        .ok()?;
        Some(kind)
    }
}

impl RealSense {
    pub fn open(which: Option<&str>, options: &CameraOptions) -> Result<Self, CameraError> {
        let library = Library::load(&LIBRARY, &options.libraries)?;
        let api = RealSenseApi::of(&library)?;
        let recording = which.filter(|which| Path::new(which).exists());
        let mut pipeline = Pipeline::new(api)?;
        pipeline.configure(which, recording, options.colour)?;
        if recording.is_none() && pipeline.devices()? == 0 {
            // Asked first: a pipeline waits for a quarter of a minute until a camera is plugged in.
            let cure = "plug it into a USB 3 port, and see that librealsense's rules for udev let your user use it";
            return Err(CameraError::NotConnected { camera: NAME, cure });
        }
        if let Err(error) = pipeline.start() {
            return Err(explained(error, recording));
        }
        let until = Instant::now() + FIRST;
        let first = loop {
            match pipeline.wait(FIRST)? {
                Some(frames) if frames.depth().is_some() => break frames,
                _ if Instant::now() < until => {}
                _ => return Err(refused("no depth comes of it")),
            }
        };
        let (camera, rate_hz) = first.depth().ok_or_else(|| refused("no depth comes of it"))?.camera()?;
        let camera = DepthCamera { quarter_turns: options.quarter_turns, ..camera };
        let colour = pipeline.colour_camera().map_or(ColourPlace::Unknown, ColourPlace::Beside);
        let device = which.map_or_else(|| NAME.to_owned(), |which| format!("{NAME} {which}"));
        let info = CameraInfo { device, camera, rate_hz, placed: None, colour };
        Ok(Self { pipeline, info, is_recording: recording.is_some(), heard: Instant::now(), first: Some(first) })
    }
}

/// That a file is no recording, in place of a device's cure.
fn explained(error: CameraError, recording: Option<&str>) -> CameraError {
    match (&error, recording) {
        (CameraError::Refused { said_by_library, .. }, Some(path)) => {
            CameraError::Recording(format!("{path}: it cannot be played ({said_by_library}); record it again"))
        }
        _ => error,
    }
}

fn refused(what: &str) -> CameraError {
    let cure = "plug it into a USB 3 port, and see that no other program has it";
    CameraError::Refused { camera: NAME, what: what.to_owned(), said_by_library: String::new(), cure }
}

impl Pipeline {
    fn new(api: RealSenseApi) -> Result<Self, CameraError> {
        let what = "librealsense cannot be started";
        // SAFETY: a place for an error is handed over, as to every call below.
        let version = api.call(what, |e| unsafe { (api.rs2_get_api_version)(e) })?;
        let null = ptr::null_mut();
        let mut all = Self { api, context: null, pipeline: null, config: null, profile: null };
        // SAFETY: the version is the library's own.
        all.context = api.call(what, |e| unsafe { (api.rs2_create_context)(version, e) })?;
        // SAFETY: the context was made above.
        all.pipeline = api.call(what, |e| unsafe { (api.rs2_create_pipeline)(all.context, e) })?;
        // SAFETY: takes nothing else.
        all.config = api.call(what, |e| unsafe { (api.rs2_create_config)(e) })?;
        Ok(all)
    }

    /// How many cameras are connected.
    fn devices(&self) -> Result<c_int, CameraError> {
        let (api, what) = (self.api, "its devices cannot be listed");
        // SAFETY: the context is valid.
        let list = api.call(what, |e| unsafe { (api.rs2_query_devices)(self.context, e) })?;
        // SAFETY: the list was made above, and is deleted once.
        let count = api.call(what, |e| unsafe { (api.rs2_get_device_count)(list, e) });
        // SAFETY: the list was made above and is not used after this.
        unsafe { (api.rs2_delete_device_list)(list) };
        count
    }

    /// Chooses the device or the recording, and its streams.
    fn configure(&self, which: Option<&str>, recording: Option<&str>, colour: bool) -> Result<(), CameraError> {
        let (api, config) = (self.api, self.config);
        let [width, height, rate] = MODE;
        let text = which.map(CString::new).transpose().map_err(|_| refused("its name has a zero in it"))?;
        if let (Some(text), true) = (&text, recording.is_some()) {
            // SAFETY: the configuration is valid, and the path ends with a zero and outlives the call. All recorded streams are played.
            return api
                .call("the recording cannot be opened", |e| unsafe {
                    (api.rs2_config_enable_device_from_file_repeat_option)(config, text.as_ptr(), 0, e);
                })
                .map_err(|error| explained(error, recording));
        }
        if let Some(serial) = &text {
            // SAFETY: the configuration is valid, and the serial number ends with a zero and outlives the call.
            api.call("it cannot be chosen", |e| unsafe { (api.rs2_config_enable_device)(config, serial.as_ptr(), e) })?;
        }
        // SAFETY: the configuration is valid.
        api.call("its depth cannot be chosen", |e| unsafe {
            (api.rs2_config_enable_stream)(config, STREAM_DEPTH, -1, width, height, FORMAT_Z16, rate, e);
        })?;
        if colour {
            // SAFETY: the configuration is valid.
            api.call("its colour cannot be chosen", |e| unsafe {
                (api.rs2_config_enable_stream)(config, STREAM_COLOUR, -1, width, height, FORMAT_RGB8, rate, e);
            })?;
        }
        Ok(())
    }

    fn start(&mut self) -> Result<(), CameraError> {
        let (api, pipeline, config) = (self.api, self.pipeline, self.config);
        // SAFETY: both live.
        self.profile =
            api.call("it cannot be started", |e| unsafe { (api.rs2_pipeline_start_with_config)(pipeline, config, e) })?;
        Ok(())
    }

    /// The colour camera in the depth camera's axes; none where there is none, or its lens is not known here.
    fn colour_camera(&self) -> Option<ColourCamera> {
        let api = self.api;
        // SAFETY: the profile was given by the start of the pipeline, and lives as long.
        let list = api.call("", |e| unsafe { (api.rs2_pipeline_profile_get_streams)(self.profile, e) }).ok()?;
        let found = self.colour_of(list);
        // SAFETY: the list was made above, and is deleted once. What it holds belongs to the pipeline.
        unsafe { (api.rs2_delete_stream_profiles_list)(list) };
        found
    }

    fn colour_of(&self, list: RsHandle) -> Option<ColourCamera> {
        let api = self.api;
        // SAFETY: the list lives, here and below.
        let count = api.call("", |e| unsafe { (api.rs2_get_stream_profiles_count)(list, e) }).ok()?;
        let profile = |stream: c_int| {
            (0..count).find_map(|i| {
                // SAFETY: there are so many.
                let profile = api.call("", |e| unsafe { (api.rs2_get_stream_profile)(list, i, e) }).ok()?;
                let is = !profile.is_null() && api.kind_of(profile)?.stream == stream;
                is.then_some(profile)
            })
        };
        let (depth, colour) = (profile(STREAM_DEPTH)?, profile(STREAM_COLOUR)?);
        let (mut k, mut place) = (RsIntrinsics::default(), RsExtrinsics::default());
        // SAFETY: the profile is valid, and a place for the intrinsics is handed over.
        api.call("", |e| unsafe { (api.rs2_get_video_stream_intrinsics)(colour, &mut k, e) }).ok()?;
        // SAFETY: both are valid, and a place for the extrinsics is handed over.
        api.call("", |e| unsafe { (api.rs2_get_extrinsics)(depth, colour, &mut place, e) }).ok()?;
        k.beside(&place)
    }

    /// The frames of the next moment; none in that time.
    fn wait(&mut self, patience: Duration) -> Result<Option<Frames>, CameraError> {
        let (api, pipeline) = (self.api, self.pipeline);
        let (mut frames, patience) = (ptr::null_mut(), patience.as_millis().max(LEAST_MS) as c_uint);
        // SAFETY: the pipeline is valid and is started, and `frames` is a place for one pointer.
        let came = api.call("it is gone", |e| unsafe {
            (api.rs2_pipeline_try_wait_for_frames)(pipeline, &mut frames, patience, e)
        })?;
        Ok((came != 0 && !frames.is_null()).then_some(Frames(frames, api)))
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        let Self { api, context, pipeline, config, profile } = *self;
        // SAFETY: what is not null was made by the library, and is deleted once, what uses another before that.
        unsafe {
            if !profile.is_null() {
                let _ = api.call("", |e| (api.rs2_pipeline_stop)(pipeline, e));
                (api.rs2_delete_pipeline_profile)(profile);
            }
            if !config.is_null() {
                (api.rs2_delete_config)(config);
            }
            if !pipeline.is_null() {
                (api.rs2_delete_pipeline)(pipeline);
            }
            if !context.is_null() {
                (api.rs2_delete_context)(context);
            }
        }
    }
}

impl Frames {
    /// The frame of a stream and a format, if there is one.
    fn find(&self, stream: c_int, format: c_int) -> Option<Frames> {
        let api = self.1;
        // SAFETY: the frames live, here and below.
        let count = api.call("", |e| unsafe { (api.rs2_embedded_frames_count)(self.0, e) }).ok()?;
        (0..count).find_map(|i| {
            // SAFETY: there are so many; what is given is a reference of our own.
            let frame = api.call("", |e| unsafe { (api.rs2_extract_frame)(self.0, i, e) }).ok()?;
            let frame = (!frame.is_null()).then_some(Frames(frame, api))?;
            let kind = frame.kind()?;
            (kind.stream == stream && (format == FORMAT_ANY || kind.format == format)).then_some(frame)
        })
    }

    fn depth(&self) -> Option<Frames> {
        self.find(STREAM_DEPTH, FORMAT_Z16)
    }

    fn profile(&self) -> Option<RsHandle> {
        let api = self.1;
        // SAFETY: the frame is valid, and so does its profile as long as the pipeline.
        api.call("", |e| unsafe { (api.rs2_get_frame_stream_profile)(self.0, e) }).ok().filter(|p| !p.is_null())
    }

    fn kind(&self) -> Option<StreamKind> {
        self.1.kind_of(self.profile()?)
    }

    /// The camera of a depth frame, and its rate (Hz).
    fn camera(&self) -> Result<(DepthCamera, f32), CameraError> {
        let (api, what) = (self.1, "its lens cannot be read");
        let (profile, kind) = self.profile().zip(self.kind()).ok_or_else(|| refused(what))?;
        let mut k = RsIntrinsics::default();
        // SAFETY: the profile is valid, and a place for the intrinsics is handed over.
        api.call(what, |e| unsafe { (api.rs2_get_video_stream_intrinsics)(profile, &mut k, e) })?;
        // SAFETY: a depth frame that is valid.
        let units = api.call(what, |e| unsafe { (api.rs2_depth_frame_get_units)(self.0, e) })?;
        let mm_per_unit = if units > 0.0 { units * 1e3 } else { 1.0 };
        Ok((
            DepthCamera { distortion: k.lens(), mm_per_unit, ..DepthCamera::pinhole(k.intrinsics()) },
            kind.rate.max(1) as f32,
        ))
    }

    /// The rows of a video frame of so many bytes a pixel, with its width and height.
    fn rows(&self, bytes: usize) -> Option<([usize; 2], impl Iterator<Item = &[u8]>)> {
        let api = self.1;
        let number = |f: unsafe extern "C" fn(RsHandle, *mut RsError) -> c_int| {
            // SAFETY: `self` keeps the frame until it is dropped, and the four functions below ask for a valid video frame only.
            usize::try_from(api.call("", |e| unsafe { f(self.0, e) }).ok()?).ok()
        };
        let (width, height) = (number(api.rs2_get_frame_width)?, number(api.rs2_get_frame_height)?);
        let (stride, size) = (number(api.rs2_get_frame_stride_in_bytes)?, number(api.rs2_get_frame_data_size)?);
        // SAFETY: `self` keeps the frame until it is dropped.
        let data = api.call("", |e| unsafe { (api.rs2_get_frame_data)(self.0, e) }).ok()?;
        let whole = stride >= width * bytes && stride > 0 && stride.checked_mul(height)? <= size;
        if data.is_null() || !whole {
            return None;
        }
        // SAFETY: the library says that `size` bytes lie there, and keeps them until the frame is released.
        let all = unsafe { std::slice::from_raw_parts(data.cast::<u8>(), size) };
        Some(([width, height], all.chunks_exact(stride).take(height).map(move |row| &row[..width * bytes])))
    }

    fn time_ns(&self) -> u64 {
        let api = self.1;
        // SAFETY: the frame is valid.
        let ms = api.call("", |e| unsafe { (api.rs2_get_frame_timestamp)(self.0, e) }).unwrap_or(0.0);
        (ms.max(0.0) * 1e6) as u64
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
        // SAFETY: the frame is our own reference, given back once.
        unsafe { (self.1.rs2_release_frame)(self.0) };
    }
}

impl LiveCamera for RealSense {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn read(&mut self, frame: &mut CameraFrame, patience: Duration) -> Result<Arrival, CameraError> {
        frame.clear();
        let frames = match self.first.take() {
            Some(first) => Some(first),
            None => self.pipeline.wait(patience)?,
        };
        let Some(frames) = frames else {
            let ended = self.is_recording && self.heard.elapsed() > END;
            return Ok(if ended { Arrival::Ended } else { Arrival::Nothing });
        };
        let Some(depth) = frames.depth() else { return Ok(Arrival::Nothing) };
        self.heard = Instant::now();
        frame.device_ns = depth.time_ns();
        if let Some((_, rows)) = depth.rows(2) {
            frame.depth.extend(rows.flat_map(|row| row.chunks_exact(2)).map(|b| u16::from_le_bytes([b[0], b[1]])));
        }
        if let Some(colour) = frames.find(STREAM_COLOUR, FORMAT_RGB8)
            && is_of_moment(frame.device_ns, colour.time_ns(), self.info.rate_hz)
            && let Some(([width, height], rows)) = colour.rows(3)
        {
            frame.colour.rgb.extend(rows.flatten());
            (frame.colour.width, frame.colour.height) = (width as u32, height as u32);
        }
        Ok(Arrival::Frame)
    }
}
