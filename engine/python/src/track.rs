//! Joints of a person, as a sensor or a program of the caller's own has them.

use std::sync::Arc;

use numpy::ndarray::{Array1, Array3};
use numpy::{IntoPyArray, PyArray1, PyArray3};
use pyo3::prelude::*;
use toile_sdk::glam::Vec3;
use toile_sdk::{HandState, Joint, Joints, TrackedJoint};

use crate::failure::Failure;
use crate::numbers::{self, ANY};

/// Joints of a person.
pub const JOINTS: usize = Joint::ALL.len();

/// Latest moment of a recording (s): a day.
const MOST_SECONDS: f64 = 86_400.0;

/// Frames of joints that a body can follow.
///
/// Parameters
/// ----------
/// times : array_like [n]
///     Time of each frame (s), rising.
/// joints : array_like [n, 23, 4] or [n, 23, 3]
///     x, y, z (m, y up, the person facing +z) and the confidence, 0 (not seen) to 1, of each joint of ``toile.JOINTS``; believed
///     from .5. Without confidences all were seen.
#[pyclass(frozen, module = "toile", sequence)]
#[derive(Debug)]
pub struct Track {
    pub frames: Arc<Vec<Joints>>,
}

#[pymethods]
impl Track {
    #[new]
    fn new(times: &Bound<'_, PyAny>, joints: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (numbers, shape) = numbers::reals(joints, "joints", &[&[ANY, JOINTS, 4], &[ANY, JOINTS, 3]])?;
        let (times, _) = numbers::doubles(times, "times", &[&[ANY]])?;
        if times.len() != shape[0] {
            let (times, frames) = (times.len(), shape[0]);
            return Err(Failure::input(format!(
                "{times} times are given for {frames} frames of joints; give one each"
            ))
            .into());
        }
        let width = shape[2];
        let frames = times.iter().zip(numbers.chunks_exact(JOINTS * width));
        let frames = frames.map(|(time, numbers)| Ok(frame(nanoseconds(*time)?, numbers, width)));
        Ok(Self { frames: Arc::new(frames.collect::<Result<_, Failure>>()?) })
    }

    /// Time of each frame (s), float64 [n].
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.frames.iter().map(|frame| frame.time_ns as f64 * 1e-9).collect::<Array1<f64>>().into_pyarray(py)
    }

    /// x, y, z (m) and the confidence of each joint, float32 [n, 23, 4], a copy.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let state = |joint: &TrackedJoint| {
            let [x, y, z] = joint.position.to_array();
            [x, y, z, joint.confidence]
        };
        let numbers: Vec<f32> = self.frames.iter().flat_map(|frame| frame.joints.iter().flat_map(state)).collect();
        let array = Array3::from_shape_vec((self.frames.len(), JOINTS, 4), numbers).map_err(Failure::internal)?;
        Ok(array.into_pyarray(py))
    }

    fn __len__(&self) -> usize {
        self.frames.len()
    }

    fn __repr__(&self) -> String {
        let last = self.frames.last().map_or(0.0, |frame| frame.time_ns as f64 * 1e-9);
        format!("<toile.Track of {} frames, {last:.2} s>", self.frames.len())
    }
}

/// A moment (s) of a recording as the engine has it.
pub fn nanoseconds(seconds: f64) -> Result<u64, Failure> {
    if (0.0..=MOST_SECONDS).contains(&seconds) {
        return Ok((seconds * 1e9).round() as u64);
    }
    Err(Failure::input(format!(
        "{seconds} s is no time of a recording; give seconds from its beginning, 0 to {MOST_SECONDS}"
    )))
}

fn frame(time_ns: u64, numbers: &[f32], width: usize) -> Joints {
    let joint = |j: usize| {
        let of = &numbers[j * width..(j + 1) * width];
        TrackedJoint { position: Vec3::new(of[0], of[1], of[2]), confidence: of.get(3).copied().unwrap_or(1.0) }
    };
    Joints { time_ns, joints: std::array::from_fn(joint), hands: [HandState::Unknown; 2] }
}

/// Joints of one moment.
pub fn one(given: &Bound<'_, PyAny>) -> PyResult<Joints> {
    let (numbers, shape) = numbers::reals(given, "joints", &[&[JOINTS, 4], &[JOINTS, 3]])?;
    Ok(frame(0, &numbers, shape[1]))
}

/// Names of the joints in their order: `left_shoulder`.
pub fn names() -> Vec<String> {
    let name = |joint: Joint| {
        let mut name = String::new();
        for letter in format!("{joint:?}").chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.extend(letter.to_lowercase());
        }
        name
    };
    Joint::ALL.into_iter().map(name).collect()
}
