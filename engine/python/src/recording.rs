//! Recordings: a sensor's data of a person, and their measures.

use numpy::PyArray2;
use numpy::ndarray::Array2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use toile_sdk::glam::{Affine3A, Mat3, Vec3};
use toile_sdk::{DepthFrame as SdkDepthFrame, Intrinsics, Measured as SdkMeasured, Recording as SdkRecording, Shopper};

use crate::body::{self, Body};
use crate::failure::{Failure, detached};
use crate::garment::garments;
use crate::numbers::{self, ANY};
use crate::track::{self, Track};
use crate::{results, views, words};

/// A depth image of your own sensor.
///
/// Parameters
/// ----------
/// depth : array_like [height, width]
///     Depth along the camera's axis (mm), whole numbers, rows from the top; 0 where nothing was seen.
/// fx, fy : float
///     Focal lengths (px).
/// cx, cy : float, optional
///     Principal point (px); the image's middle where it is left out.
/// camera_to_world : array_like [3, 4] or [4, 4], optional
///     From the camera (x right, y down, z forward) to the world (m, y up, the floor at y = 0, the person facing +z). Without one,
///     a level camera a metre above the floor that looks along -z.
/// time : float, optional
///     Time since the recording began (s).
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct DepthFrame {
    inner: SdkDepthFrame,
}

/// Height of a camera whose place is not given (m).
const CAMERA_HEIGHT: f32 = 1.0;

/// A camera's place, of a matrix row by row.
fn placed(given: Option<&Bound<'_, PyAny>>) -> PyResult<Affine3A> {
    let Some(given) = given else {
        let turned = Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0));
        return Ok(Affine3A::from_mat3_translation(turned, Vec3::Y * CAMERA_HEIGHT));
    };
    let (m, _) = numbers::finite(given, "rows of camera_to_world", &[&[3, 4], &[4, 4]])?;
    if let Some(last) = m.get(12..)
        && !last.is_empty()
        && *last != [0.0, 0.0, 0.0, 1.0]
    {
        return Err(Failure::input("the last row of camera_to_world is not 0, 0, 0, 1; give rotation and place").into());
    }
    let column = |c: usize| Vec3::new(m[c], m[4 + c], m[8 + c]);
    Ok(Affine3A::from_mat3_translation(Mat3::from_cols(column(0), column(1), column(2)), column(3)))
}

#[pymethods]
impl DepthFrame {
    #[new]
    #[pyo3(signature = (depth, *, fx, fy, cx=None, cy=None, camera_to_world=None, time=0.0))]
    fn new(
        depth: &Bound<'_, PyAny>,
        fx: f32,
        fy: f32,
        cx: Option<f32>,
        cy: Option<f32>,
        camera_to_world: Option<&Bound<'_, PyAny>>,
        time: f64,
    ) -> PyResult<Self> {
        let (depth_mm, shape) = numbers::whole::<u16>(depth, "depths", &[&[ANY, ANY]])?;
        let side = |at: usize| shape.get(at).and_then(|side| u32::try_from(*side).ok()).unwrap_or_default();
        let (height, width) = (side(0), side(1));
        let middle = |pixels: u32| (pixels as f32 - 1.0) / 2.0;
        let (cx, cy) = (cx.unwrap_or(middle(width)), cy.unwrap_or(middle(height)));
        let inner = SdkDepthFrame {
            time_ns: track::nanoseconds(time)?,
            intrinsics: Intrinsics { width, height, fx, fy, cx, cy },
            camera_to_world: placed(camera_to_world)?,
            depth_mm: depth_mm.into(),
        };
        match inner.fault() {
            Some(fault) => Err(Failure::input(format!("{fault}; correct the depth image's camera")).into()),
            None => Ok(Self { inner }),
        }
    }

    /// Depth (mm), uint16 [height, width], read-only and without a copy; 0 where nothing was seen.
    #[getter]
    fn depth<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u16>>> {
        let Intrinsics { width, height, .. } = slf.get().inner.intrinsics;
        views::lent_image(slf, [height as usize, width as usize], |frame| &frame.inner.depth_mm)
    }

    /// World points of all pixels that were measured (m), float32 [n, 3].
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        views::vectors(py, std::sync::Arc::new(self.inner.points().collect()))
    }

    /// Time since the recording began (s).
    #[getter]
    fn time(&self) -> f64 {
        self.inner.time_ns as f64 * 1e-9
    }

    /// fx, fy, cx, cy (px).
    #[getter]
    fn intrinsics(&self) -> (f32, f32, f32, f32) {
        let Intrinsics { fx, fy, cx, cy, .. } = self.inner.intrinsics;
        (fx, fy, cx, cy)
    }

    /// From the camera to the world (m), float32 [3, 4].
    #[getter]
    fn camera_to_world<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        let place = &self.inner.camera_to_world;
        let columns = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis, place.translation];
        numpy::IntoPyArray::into_pyarray(Array2::from_shape_fn((3, 4), |(row, column)| columns[column][row]), py)
    }

    fn __repr__(&self) -> String {
        let Intrinsics { width, height, .. } = self.inner.intrinsics;
        format!("<toile.DepthFrame {width} x {height}, {:.2} s>", self.time())
    }
}

/// What a sensor saw of one person: frames of joints, depth images, or both.
///
/// Made by ``open``, ``embedded`` or ``from_frames``. It never changes; any thread may use it.
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Recording {
    pub inner: SdkRecording,
}

#[pymethods]
impl Recording {
    /// Opens a recording: MCAP, Kinect CSV, Kinectron JSON, BVH, Azure Kinect, OpenNI, OpenPose, depth images and others.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    /// camera : str or os.PathLike, optional
    ///     A JSON file that describes the camera of depth images which have none of their own.
    #[classmethod]
    #[pyo3(signature = (path, camera=None))]
    fn open(of: &Bound<'_, PyType>, path: &Bound<'_, PyAny>, camera: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let path = words::path(path, "recording")?;
        let camera = camera.map(|camera| words::path(camera, "file of the camera")).transpose()?;
        let inner = detached(of.py(), || match camera {
            Some(camera) => SdkRecording::open_with_camera(path, camera),
            None => SdkRecording::open(path),
        })?;
        Ok(Self { inner })
    }

    /// The recording that comes with Toile.
    #[classmethod]
    fn embedded(of: &Bound<'_, PyType>) -> PyResult<Self> {
        Ok(Self { inner: detached(of.py(), SdkRecording::embedded)? })
    }

    /// Frames that a sensor of your own saw; times rise from frame to frame. One of the two may be left out.
    ///
    /// Parameters
    /// ----------
    /// depth : DepthFrame or sequence of DepthFrame, optional
    /// joints : Track, optional
    /// name : str, optional
    ///     What reports call it.
    #[classmethod]
    #[pyo3(signature = (depth=None, joints=None, *, name="recording"))]
    fn from_frames(
        of: &Bound<'_, PyType>,
        depth: Option<&Bound<'_, PyAny>>,
        joints: Option<&Bound<'_, Track>>,
        name: &str,
    ) -> PyResult<Self> {
        let depth = depth.map(depth_frames).transpose()?.unwrap_or_default();
        let joints = joints.map(|track| track.get().frames.to_vec()).unwrap_or_default();
        Ok(Self { inner: detached(of.py(), || SdkRecording::from_frames(name, joints, depth))? })
    }

    /// Its name, for reports.
    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    /// Time of the last frame (s); the first is at 0.
    #[getter]
    fn seconds(&self) -> f64 {
        self.inner.seconds()
    }

    /// Frames of joints as the sensor has them.
    #[getter]
    fn joints(&self) -> Track {
        Track { frames: std::sync::Arc::new(self.inner.joints().to_vec()) }
    }

    /// How many depth images there are.
    #[getter]
    fn depth_count(&self) -> usize {
        self.inner.depth().len()
    }

    /// A depth image by its number from 0, a copy.
    fn depth_frame(&self, index: i64) -> PyResult<DepthFrame> {
        let (index, all) = (words::counted(index, "depth image")?, self.inner.depth());
        let found = all.get(index).cloned();
        let inner = found.ok_or_else(|| {
            Failure::usage(format!("there is no depth image {index}: there are {}, counted from 0", all.len()))
        })?;
        Ok(DepthFrame { inner })
    }

    /// The filtered joints from the moment on at which the person can be dressed; of depth alone, the body is followed through it.
    ///
    /// Parameters
    /// ----------
    /// measured : Measured
    ///     Who stands in it.
    fn track(&self, py: Python<'_>, measured: &Bound<'_, Measured>) -> PyResult<Track> {
        let measured = &measured.get().inner;
        let frames = detached(py, || self.inner.track(measured))?;
        Ok(Track { frames: std::sync::Arc::new(frames) })
    }

    fn __repr__(&self) -> String {
        let (joints, depth) = (self.inner.joints().len(), self.inner.depth().len());
        let (name, seconds) = (self.inner.name(), self.inner.seconds());
        format!("<toile.Recording {name:?}, {seconds:.1} s, {joints} frames of joints, {depth} depth images>")
    }
}

/// A measured person (``toile.measure``).
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Measured {
    inner: SdkMeasured,
}

#[pymethods]
impl Measured {
    /// The measures, a new dict of Measure by their names: stature, shoulder breadth, girths of chest, waist and hip always, others
    /// where they were taken.
    #[getter]
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        measures(py, &self.inner.measures())
    }

    /// Odds that it is a child, 0 to 1; None without a stature. Bodies and sizes here are adults'.
    #[getter]
    fn child(&self) -> Option<f32> {
        self.inner.child()
    }

    /// Notes on the measures, a sentence each.
    #[getter]
    fn notes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.inner.notes())
    }

    /// The body of these measures.
    ///
    /// Parameters
    /// ----------
    /// garments : Garment or sequence of Garment, optional
    ///     Where the sex is neither known nor seen it is that of whom these are made for; of none, a woman's.
    #[pyo3(signature = (garments=None))]
    fn body(&self, py: Python<'_>, garments: Option<&Bound<'_, PyAny>>) -> PyResult<Body> {
        let worn = garments.map(self::garments).transpose()?.unwrap_or_default();
        Ok(Body { inner: detached(py, || self.inner.body_for(&worn))? })
    }

    fn __repr__(&self) -> String {
        let all = self.inner.measures();
        let all: Vec<String> = all.iter().map(|m| format!("{} {:.0} ({:.0})", m.name, m.mm, m.sigma_mm)).collect();
        format!("<toile.Measured, mm (sigma): {}>", all.join(", "))
    }
}

/// Measures by their names.
pub fn measures<'py>(py: Python<'py>, all: &[toile_sdk::Measure]) -> PyResult<Bound<'py, PyDict>> {
    let measures = PyDict::new(py);
    all.iter().try_for_each(|of| measures.set_item(of.name, results::measure(py, of)?))?;
    Ok(measures)
}

/// What is known of a person, as the package's dataclass has it.
#[derive(FromPyObject)]
struct GivenShopper<'py> {
    sex: Option<String>,
    child: Option<bool>,
    tight_clothes: bool,
    seated: bool,
    by_tape: Bound<'py, PyDict>,
}

/// What is known of a person; nothing where none is given.
pub fn shopper(given: Option<&Bound<'_, PyAny>>) -> PyResult<Shopper> {
    let Some(given) = given else { return Ok(Shopper::default()) };
    let known: GivenShopper<'_> = given.extract().map_err(|_| {
        let given = given.repr().map_or_else(|_| "what is given".to_owned(), |repr| repr.to_string());
        Failure::usage(format!("{given} is no shopper; give toile.Shopper(sex=\"female\", by_tape={{\"waist\": 760}})"))
    })?;
    Ok(Shopper {
        sex: words::optional_sex(known.sex.as_deref())?,
        child: known.child,
        tight_clothes: known.tight_clothes,
        seated: known.seated,
        by_tape_mm: body::measures(&known.by_tape)?,
    })
}

/// One depth image, or some.
fn depth_frames(given: &Bound<'_, PyAny>) -> PyResult<Vec<SdkDepthFrame>> {
    if let Ok(one) = given.cast::<DepthFrame>() {
        return Ok(vec![one.get().inner.clone()]);
    }
    let wrong = || {
        let kind = given.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string());
        Failure::usage(format!(
            "an object of type {kind} is no depth image; give a toile.DepthFrame, a list of them, a toile.Recording or its path"
        ))
    };
    let each = given.try_iter().map_err(|_| wrong())?;
    each.map(|one| Ok(one?.cast::<DepthFrame>().map_err(|_| wrong())?.get().inner.clone())).collect()
}

/// A recording, the path of one, or depth images.
pub fn source(given: &Bound<'_, PyAny>) -> PyResult<SdkRecording> {
    if let Ok(recording) = given.cast::<Recording>() {
        return Ok(recording.get().inner.clone());
    }
    if let Ok(path) = given.extract::<std::path::PathBuf>() {
        return detached(given.py(), || SdkRecording::open(path));
    }
    let frames = depth_frames(given)?;
    detached(given.py(), || SdkRecording::from_frames("depth", Vec::new(), frames))
}

/// Measures the person in a recording: by a body fitted to depth where there is any, by the joints otherwise.
///
/// Parameters
/// ----------
/// source : Recording or str or os.PathLike or DepthFrame or sequence of DepthFrame
/// shopper : Shopper, optional
///     What is known before.
///
/// Returns
/// -------
/// Measured
///
/// Raises
/// ------
/// InputError
///     A recording that shows no person who can be measured; a measure by tape outside of people's range.
#[pyfunction]
#[pyo3(signature = (source, shopper=None))]
pub fn measure(source: &Bound<'_, PyAny>, shopper: Option<&Bound<'_, PyAny>>) -> PyResult<Measured> {
    let (py, recording, shopper) = (source.py(), self::source(source)?, self::shopper(shopper)?);
    Ok(Measured { inner: detached(py, || recording.measure(&shopper))? })
}
