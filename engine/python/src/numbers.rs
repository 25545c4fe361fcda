//! Arrays that Python hands over, checked before they are used: kind of numbers, shape, range.

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::failure::Failure;

/// A side of a shape: a number that it has to be, or any.
pub const ANY: usize = usize::MAX;

fn numpy(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    AS_ARRAY.import(py, "numpy", "asarray")
}

/// What was given as numpy has it, with the letter of its kind of numbers and its shape.
fn array<'py>(given: &Bound<'py, PyAny>, what: &str) -> PyResult<(Bound<'py, PyUntypedArray>, String)> {
    let array = numpy(given.py())?.call1((given,)).map_err(|error| {
        Failure::input(format!(
            "the {what} are no array: {}; give numbers in rows of one length",
            error.value(given.py())
        ))
    })?;
    let array = array.cast_into::<PyUntypedArray>().map_err(PyErr::from)?;
    let kind: String = array.dtype().getattr(intern!(given.py(), "kind"))?.extract()?;
    Ok((array, kind))
}

/// A shape in words: `(n, 3)`.
fn words(shape: &[usize]) -> String {
    let sides: Vec<String> =
        shape.iter().map(|side| if *side == ANY { "n".to_owned() } else { side.to_string() }).collect();
    if let [one] = sides.as_slice() { format!("({one},)") } else { format!("({})", sides.join(", ")) }
}

fn check_shape(array: &Bound<'_, PyUntypedArray>, what: &str, wanted: &[&[usize]]) -> PyResult<()> {
    let shape = array.shape();
    let fits = |wanted: &&[usize]| {
        wanted.len() == shape.len() && wanted.iter().zip(shape).all(|(wanted, side)| *wanted == ANY || wanted == side)
    };
    if wanted.iter().any(fits) {
        return Ok(());
    }
    let wanted: Vec<String> = wanted.iter().map(|shape| words(shape)).collect();
    Err(Failure::input(format!("the {what} have the shape {}; give {}", words(shape), wanted.join(" or "))).into())
}

/// The numbers row by row as numpy converts them to a type.
fn converted<T: numpy::Element + Copy>(array: &Bound<'_, PyUntypedArray>) -> PyResult<Vec<T>> {
    let py = array.py();
    let options = PyDict::new(py);
    options.set_item(intern!(py, "dtype"), numpy::dtype::<T>(py))?;
    options.set_item(intern!(py, "order"), "C")?;
    let made = numpy(py)?.call((array,), Some(&options))?;
    let made = made.cast_into::<PyArrayDyn<T>>().map_err(PyErr::from)?;
    made.to_vec().map_err(|e| PyTypeError::new_err(e.to_string()))
}

/// Numbers with a fraction, finite or not, and their shape.
pub fn doubles(given: &Bound<'_, PyAny>, what: &str, wanted: &[&[usize]]) -> PyResult<(Vec<f64>, Vec<usize>)> {
    let (array, kind) = array(given, what)?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        return Err(
            Failure::input(format!("the {what} are of dtype {}; give float32 or float64", array.dtype())).into()
        );
    }
    check_shape(&array, what, wanted)?;
    Ok((converted(&array)?, array.shape().to_vec()))
}

/// The same as `f32`; what is beyond one becomes infinite, by `as`, which does not warn as numpy does.
pub fn reals(given: &Bound<'_, PyAny>, what: &str, wanted: &[&[usize]]) -> PyResult<(Vec<f32>, Vec<usize>)> {
    let (numbers, shape) = doubles(given, what, wanted)?;
    Ok((numbers.into_iter().map(|number| number as f32).collect(), shape))
}

/// Finite numbers with a fraction.
pub fn finite(given: &Bound<'_, PyAny>, what: &str, wanted: &[&[usize]]) -> PyResult<(Vec<f32>, Vec<usize>)> {
    let (numbers, shape) = reals(given, what, wanted)?;
    let Some(at) = numbers.iter().position(|number| !number.is_finite()) else {
        return Ok((numbers, shape));
    };
    let row = at / shape.iter().skip(1).product::<usize>().max(1);
    Err(Failure::input(format!("row {row} of the {what} is not finite; give numbers throughout")).into())
}

/// Whole numbers from 0 to the largest that `T` has, and their shape.
pub fn whole<T>(given: &Bound<'_, PyAny>, what: &str, wanted: &[&[usize]]) -> PyResult<(Vec<T>, Vec<usize>)>
where
    T: TryFrom<i64>,
{
    let (array, kind) = array(given, what)?;
    // An empty list has no kind of its own.
    if array.shape().contains(&0) {
        return Ok((Vec::new(), array.shape().to_vec()));
    }
    if !["i", "u"].contains(&kind.as_str()) {
        return Err(Failure::input(format!(
            "the {what} are of dtype {}; give whole numbers, such as an array of dtype {}",
            array.dtype(),
            if size_of::<T>() == 2 { "uint16" } else { "uint32" }
        ))
        .into());
    }
    check_shape(&array, what, wanted)?;
    let numbers: Vec<i64> = converted(&array)?;
    let whole: Option<Vec<T>> = numbers.iter().map(|number| T::try_from(*number).ok()).collect();
    let whole = whole.ok_or_else(|| {
        let most = (1_u64 << (8 * size_of::<T>())) - 1;
        Failure::input(format!("one of the {what} is not within 0 to {most}; correct it"))
    })?;
    Ok((whole, array.shape().to_vec()))
}

/// Numbers three by three.
pub fn threes<T: Copy, V>(numbers: &[T], of: impl Fn([T; 3]) -> V) -> Vec<V> {
    numbers.chunks_exact(3).map(|three| of([three[0], three[1], three[2]])).collect()
}
