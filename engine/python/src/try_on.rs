//! A whole try-on: a recording in; measures, size, pictures and the moving scene out.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use toile_sdk::{Picture, TryOnOptions};

use crate::failure::detached;
use crate::garment::garments;
use crate::results::{self, answer};
use crate::scene::{Scene, strings};
use crate::{pictures, recording, words};

/// Names of a try-on's views, in their order.
const VIEW_NAMES: [&str; toile_sdk::VIEWS.len()] = ["front", "side", "back"];

/// Pictures by their views.
fn by_view<'py>(py: Python<'py>, drawn: &[Picture]) -> PyResult<Bound<'py, PyDict>> {
    let views = PyDict::new(py);
    VIEW_NAMES.iter().zip(drawn).try_for_each(|(view, of)| views.set_item(view, pictures::rgba(py, of)?))?;
    Ok(views)
}

/// Measures the person in a recording, puts the garments on a body of those measures, lets them move as the recording does and
/// draws its end: the same measures, sizes and bits as ``toile try-on``.
///
/// Parameters
/// ----------
/// source : Recording or str or os.PathLike or DepthFrame or sequence of DepthFrame
/// garments : Garment or sequence of Garment
///     Inner first.
/// shopper : Shopper, optional
///     What is known of the person.
/// quality : {"shop", "draft", "fine"}, optional
///     Tested settings of the cloth.
/// picture : tuple of int, optional
///     Width and height of each picture (px); without them none is drawn.
/// tuck : sequence of str, optional
///     Names of garments that are tucked in.
///
/// Returns
/// -------
/// TryOn
///     Measures, notes, fits, pictures and fit maps by view (uint8 [height, width, 4]), and the scene as the recording ended.
#[pyfunction]
#[pyo3(signature = (source, garments, *, shopper=None, quality="shop", picture=None, tuck=None))]
pub fn try_on<'py>(
    source: &Bound<'py, PyAny>,
    garments: &Bound<'py, PyAny>,
    shopper: Option<&Bound<'py, PyAny>>,
    quality: &str,
    picture: Option<(u32, u32)>,
    tuck: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, worn) = (source.py(), self::garments(garments)?);
    let options = TryOnOptions {
        shopper: recording::shopper(shopper)?,
        quality: words::quality(quality)?,
        picture: picture.map(Into::into),
        tuck: strings(tuck, "names of garments to tuck in")?,
    };
    let recording = recording::source(source)?;
    let made = detached(py, || toile_sdk::try_on(&recording, &worn, &options))?;
    let fits = made.fits.iter().map(|fit| results::optional_recommendation(py, fit.as_ref()));
    let fits = PyTuple::new(py, fits.collect::<PyResult<Vec<_>>>()?)?;
    let (drawn, fit_maps) = (by_view(py, &made.pictures)?, by_view(py, &made.fit_maps)?);
    let (measures, notes) = (recording::measures(py, &made.measures)?, PyTuple::new(py, &made.notes)?);
    answer!(py, "TryOn", (measures, notes, fits, drawn, fit_maps, Scene::of(made.scene)?))
}
