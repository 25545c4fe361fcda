//! The scene as Python has it.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use toile_sdk::Scene as SdkScene;
use toile_sdk::glam::Vec3;

use super::options;
use super::state::{SceneLock, SceneState};
use crate::body::Body;
use crate::failure::{Failure, detached};
use crate::garment::garments;
use crate::numbers::{self, ANY};
use crate::results::{self, answer};
use crate::{pictures, track, views, words};

/// Most steps of one call: 96 days of time in the scene.
const MOST_STEPS: usize = 1_000_000_000;

/// Positions and normals of a surface.
type Surface<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>);

/// A scene in motion: a dressed body, or the cloth and colliders of a scene file (``open``, ``parse``, ``of_mesh``).
///
/// Garments are numbered from 0, inner first; lengths are metres, y is up. A scene takes one call at a time, of any thread; one that
/// comes meanwhile is refused. Arrays that it gives are read-only, show the scene's memory without a copy and never change: they are
/// of the step at which they were asked for, and outlive the scene.
///
/// Parameters
/// ----------
/// body : Body
/// garments : Garment or sequence of Garment
///     Inner first, each in the size that was asked for or the one that fits.
/// motion : {"standing", "sitting"} or Track or array_like [23, 4], optional
///     How the body moves; joints of one moment are moved on by ``step_to``.
/// quality : {"shop", "draft", "fine"}, optional
///     Tested settings of the cloth.
/// workers : {1, 2}, optional
///     Threads that share a step; both give the same bits.
/// wind : Wind, optional
/// tuck : sequence of str, optional
///     Names of garments that are tucked into the next one under them that has a waistband.
///
/// Raises
/// ------
/// InputError
///     A garment that cannot be laid on this body, joints that give no pose.
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Scene {
    inner: SceneLock,
}

impl Scene {
    pub fn of(scene: SdkScene) -> PyResult<Self> {
        Ok(Self { inner: SceneLock::new(scene)? })
    }

    /// What a garment has, by its number.
    fn of_garment<T>(
        &self,
        garment: i64,
        read: impl FnOnce(&mut SceneState, usize) -> toile_sdk::Result<T>,
    ) -> PyResult<T> {
        let garment = words::counted(garment, "garment")?;
        self.inner.with(|state| {
            state.worn(garment).map_err(Failure::from)?;
            Ok(read(state, garment).map_err(Failure::from)?)
        })
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (body, garments, *, motion=None, quality="shop", workers=None, wind=None, tuck=None))]
    #[expect(clippy::too_many_arguments, reason = "options of Python's, each by its name")]
    fn new(
        py: Python<'_>,
        body: &Bound<'_, Body>,
        garments: &Bound<'_, PyAny>,
        motion: Option<&Bound<'_, PyAny>>,
        quality: &str,
        workers: Option<i64>,
        wind: Option<&Bound<'_, PyAny>>,
        tuck: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let worn = self::garments(garments)?;
        let options = options::dressing(motion, quality, workers, wind, tuck)?;
        let body = &body.get().inner;
        Self::of(detached(py, || SdkScene::dress_with(body, &worn, &options))?)
    }

    /// Reads a scene file, with the files beside it that it names, and honours all that it says (docs/scene.md).
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    #[classmethod]
    fn open(of: &Bound<'_, PyType>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let path = words::path(path, "scene file")?;
        Self::of(detached(of.py(), || SdkScene::open(path))?)
    }

    /// The scene of a scene file's text.
    ///
    /// Parameters
    /// ----------
    /// text : str
    /// files : dict of str to bytes, optional
    ///     The files that it names, by the names that it has for them; no other is read.
    /// name : str, optional
    ///     What messages call the text.
    #[classmethod]
    #[pyo3(signature = (text, files=None, *, name="scene"))]
    fn parse(of: &Bound<'_, PyType>, text: &str, files: Option<&Bound<'_, PyDict>>, name: &str) -> PyResult<Self> {
        let file = |(name, bytes): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let of_wrong_type =
                |_: PyErr| Failure::usage("files are no dict of str to bytes; give file contents as bytes");
            let name: String = name.extract().map_err(of_wrong_type)?;
            Ok((name, bytes.extract::<Vec<u8>>().map_err(of_wrong_type)?))
        };
        let files = files.map(|files| files.iter().map(file).collect::<PyResult<Vec<_>>>()).transpose()?;
        let files = files.unwrap_or_default();
        Self::of(detached(of.py(), || SdkScene::parse(name, text, &files))?)
    }

    /// A piece of cloth of your own triangles in a built-in fabric.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like [n, 3]
    ///     Vertices (m).
    /// faces : array_like [m, 3]
    ///     Triangles by the vertices, counted from 0.
    /// pins : array_like [k], optional
    ///     Vertices that stay at exactly these positions.
    /// fabric : str, optional
    ///     A name of ``toile.fabric_names()``.
    #[classmethod]
    #[pyo3(signature = (positions, faces, pins=None, fabric="cotton-lawn"))]
    fn of_mesh(
        of: &Bound<'_, PyType>,
        positions: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        pins: Option<&Bound<'_, PyAny>>,
        fabric: &str,
    ) -> PyResult<Self> {
        let (positions, _) = numbers::finite(positions, "positions", &[&[ANY, 3]])?;
        let positions = numbers::threes(&positions, Vec3::from_array);
        let (faces, _) = numbers::whole::<u32>(faces, "faces", &[&[ANY, 3]])?;
        let faces = numbers::threes(&faces, |face| face);
        let pins = pins.map(|pins| numbers::whole::<u32>(pins, "pins", &[&[ANY]])).transpose()?;
        let pins = pins.map_or_else(Vec::new, |(pins, _)| pins);
        Self::of(detached(of.py(), || SdkScene::of_mesh(&positions, &faces, &pins, fabric))?)
    }

    /// So many steps of ``time_step`` each, without the interpreter's lock: other threads of Python run meanwhile.
    ///
    /// A body that follows a track goes on as in its last frame once that has ended. Ctrl-C ends a call between two steps.
    ///
    /// Parameters
    /// ----------
    /// n : int, optional
    #[pyo3(signature = (n=1))]
    fn step(&self, py: Python<'_>, n: i64) -> PyResult<()> {
        let steps = words::counted(n, "number of steps")?;
        if steps > MOST_STEPS {
            return Err(Failure::usage(format!("{steps} steps are more than {MOST_STEPS}; give fewer")).into());
        }
        self.inner.step(py, steps as u64)
    }

    /// One step of a dressed body to joints of your own, those at the step's end; it stays there until moved on.
    ///
    /// Parameters
    /// ----------
    /// joints : array_like [23, 4] or [23, 3]
    ///     As in ``Track``. Not of a body that follows a track.
    fn step_to(&self, py: Python<'_>, joints: &Bound<'_, PyAny>) -> PyResult<()> {
        let joints = track::one(joints)?;
        self.inner.detached(py, |state| state.scene.step_to(&joints))
    }

    /// Steps taken so far.
    #[getter]
    fn steps(&self) -> PyResult<u64> {
        self.inner.with(|state| Ok(state.scene.steps()))
    }

    /// Time reached (s).
    #[getter]
    fn time(&self) -> PyResult<f64> {
        self.inner.with(|state| Ok(state.scene.time()))
    }

    /// Length of a step (s): ``toile.TIME_STEP``, or as a scene file says.
    #[getter]
    fn time_step(&self) -> PyResult<f64> {
        self.inner.with(|state| Ok(state.scene.time_step()))
    }

    /// Steps from beginning to end: of the track that is followed, or of the scene file's duration; None of a body that stands.
    #[getter]
    fn duration_steps(&self) -> PyResult<Option<u64>> {
        self.inner.with(|state| Ok(state.scene.duration_steps()))
    }

    /// The garments, inner first, a tuple of WornGarment.
    #[getter]
    fn garments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.inner.with(|state| {
            let worn = state.scene.garments().iter().map(|worn| results::worn(py, worn));
            PyTuple::new(py, worn.collect::<PyResult<Vec<_>>>()?)
        })
    }

    /// Where the vertices of a garment are now (m), in the order of your own mesh or of the garment's draft.
    ///
    /// Parameters
    /// ----------
    /// garment : int, optional
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     float32 [n, 3], read-only, without a copy. Always finite. It never changes; ask again after a step.
    #[pyo3(signature = (garment=0))]
    fn positions<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let now = self.of_garment(garment, |state, garment| state.moments[garment].now(&state.scene, garment))?;
        views::vectors(py, now)
    }

    /// Triangles of a garment, uint32 [m, 3], read-only and without a copy; quads are split. They never change.
    #[pyo3(signature = (garment=0))]
    fn faces<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let faces = self.of_garment(garment, |state, garment| Ok(Arc::clone(&state.faces[garment])))?;
        views::triangles(py, faces)
    }

    /// Unit normals of a garment's vertices, float32 [n, 3]; zero where a vertex has no face.
    #[pyo3(signature = (garment=0))]
    fn normals<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let normals = self.of_garment(garment, |state, garment| state.scene.normals(garment))?;
        views::vectors(py, Arc::new(normals))
    }

    /// Vertices of a garment that are held, uint32 [k]: by pins, by the body where it is worn close, or without a face.
    #[pyo3(signature = (garment=0))]
    fn pinned<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyArray1<u32>>> {
        let pinned = self.of_garment(garment, |state, garment| state.scene.pinned(garment))?;
        views::indices(py, pinned)
    }

    /// How tight a garment sits at each vertex, float32 [n], -1 (loose) .. 1 (tight); NaN where a vertex has no face.
    ///
    /// ``toile.fit_colours`` gives the colours. Not of a scene file.
    #[pyo3(signature = (garment=0))]
    fn fit_map<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let map = self.of_garment(garment, |state, garment| state.scene.fit_map(garment))?;
        views::numbers(py, map)
    }

    /// How a garment does at the moment: stretch, penetration (GarmentStats). Not for every frame of a display.
    #[pyo3(signature = (garment=0))]
    fn stats<'py>(&self, py: Python<'py>, garment: i64) -> PyResult<Bound<'py, PyAny>> {
        let stats = self.of_garment(garment, |state, garment| state.scene.stats(garment))?;
        results::stats(py, &stats)
    }

    /// Vertices of the body as it stands now (m) and their unit normals, float32 [n, 3] each. Not of a scene file.
    fn body<'py>(&self, py: Python<'py>) -> PyResult<Surface<'py>> {
        let (positions, normals) = self.inner.with(|state| Ok(state.scene.body().map_err(Failure::from)?))?;
        Ok((views::vectors(py, Arc::new(positions))?, views::vectors(py, Arc::new(normals))?))
    }

    /// Triangles of the body, uint32 [m, 3]. They never change. Not of a scene file.
    #[getter]
    fn body_faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let faces = self.inner.with(|state| Ok(state.scene.body_faces().map_err(Failure::from)?.into()))?;
        views::triangles(py, faces)
    }

    /// Everything that a display needs of this moment (Snapshot), which never changes.
    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let taken = self.inner.with(|state| Ok(state.scene.snapshot()))?;
        let worn = taken.garments.into_iter().map(|positions| views::vectors(py, Arc::new(positions)));
        let worn = PyTuple::new(py, worn.collect::<PyResult<Vec<_>>>()?)?;
        let body = views::vectors(py, Arc::new(taken.body))?;
        let normals = views::vectors(py, Arc::new(taken.body_normals))?;
        answer!(py, "Snapshot", (taken.step, taken.time_s, worn, body, normals))
    }

    /// A picture of this moment by the ray tracer, which takes every core.
    ///
    /// Parameters
    /// ----------
    /// view : {"front", "side", "back"} or float, optional
    ///     A number turns from the front towards the body's left (degrees).
    /// size : tuple of int, optional
    ///     Width and height (px).
    /// look : {"fabric", "fit_map"}, optional
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Red, green, blue and 255, sRGB, uint8 [height, width, 4].
    #[pyo3(signature = (view=None, *, size=(540, 960), look="fabric"))]
    fn picture<'py>(
        &self,
        py: Python<'py>,
        view: Option<&Bound<'py, PyAny>>,
        size: (u32, u32),
        look: &str,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let view = view.map_or(Ok(toile_sdk::View::Front), words::view)?;
        let look = words::look(look)?;
        let drawn = self.inner.detached(py, |state| state.scene.pictures(&[view], size.into(), look))?;
        let picture = drawn.first().ok_or_else(|| Failure::internal("no picture was drawn; please report this"))?;
        pictures::rgba(py, picture)
    }

    /// A hash of the whole state: the same input gives the same one on every run of a build, with one worker or two.
    #[getter]
    fn state_hash(&self) -> PyResult<u64> {
        self.inner.with(|state| Ok(state.scene.state_hash()))
    }

    /// What the steps so far had to repair or leave out, a sentence each.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.inner.with(|state| PyTuple::new(py, state.scene.warnings()))
    }

    /// Ends the scene and its threads; arrays that it gave stay. Also at the end of a ``with`` block. Nothing of a closed scene.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        self.inner.close(py)
    }

    fn __enter__(slf: Bound<'_, Self>) -> PyResult<Bound<'_, Self>> {
        slf.get().inner.with(|_| Ok(()))?;
        Ok(slf)
    }

    #[pyo3(signature = (*_error))]
    fn __exit__(&self, py: Python<'_>, _error: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.inner.close(py)
    }

    fn __repr__(&self) -> String {
        let says = self.inner.with(|state| {
            let names: Vec<&str> = state.scene.garments().iter().map(|worn| worn.name.as_str()).collect();
            Ok(format!("<toile.Scene of {}, step {}>", names.join(", "), state.scene.steps()))
        });
        says.unwrap_or_else(|_| "<toile.Scene, closed or at work>".to_owned())
    }
}
