//! Pictures as arrays.

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3};
use pyo3::prelude::*;
use toile_sdk::Picture;

use crate::failure::Failure;
use crate::numbers::{self, ANY};

/// Red, green, blue and 255, uint8 [height, width, 4].
pub fn rgba<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let shape = (picture.height() as usize, picture.width() as usize, 4);
    let array = Array3::from_shape_vec(shape, picture.rgba()).map_err(Failure::internal)?;
    Ok(array.into_pyarray(py))
}

/// Colours of a fit map: one of eight steps, which colour-blind readers tell apart.
///
/// Parameters
/// ----------
/// tightness : array_like [n]
///     -1 (loose) .. 1 (tight), as ``Scene.fit_map`` gives it; NaN becomes mid grey.
///
/// Returns
/// -------
/// numpy.ndarray
///     sRGB, uint8 [n, 3].
#[pyfunction]
pub fn fit_colours<'py>(tightness: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let (numbers, _) = numbers::reals(tightness, "values of the fit map", &[&[ANY]])?;
    let colours: Vec<u8> = numbers.iter().flat_map(|value| toile_sdk::fit_colour(*value)).collect();
    let array = Array2::from_shape_vec((numbers.len(), 3), colours).map_err(Failure::internal)?;
    Ok(array.into_pyarray(tightness.py()))
}
