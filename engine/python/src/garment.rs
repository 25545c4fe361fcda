//! Garments.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use toile_sdk::Garment as SdkGarment;

use crate::body::Body;
use crate::failure::{Failure, detached, guarded};
use crate::{results, words};

/// A garment, open and checked.
///
/// It can be put on many bodies. It never changes; any thread may use it.
///
/// Parameters
/// ----------
/// name : str or os.PathLike
///     A name of ``toile.garment_names()``, or the path of a mesh (OBJ, glTF, GLB), of a sewn pattern (GarmentCode or FreeSewing
///     JSON, DXF) or of a garment package. Behind a colon a built-in fabric may stand: ``"shirt:lawn-gingham"``.
/// size : str, optional
///     A size that is made; without one it is worn in the size that fits.
/// fabric : str or os.PathLike, optional
///     A name of ``toile.fabric_names()``, or the path of a fabric's TOML file.
///
/// Raises
/// ------
/// InputError
///     An unknown name, size or fabric, a file that cannot be used.
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Garment {
    pub inner: SdkGarment,
}

#[pymethods]
impl Garment {
    #[new]
    #[pyo3(signature = (name, size=None, fabric=None))]
    fn new(name: &Bound<'_, PyAny>, size: Option<&str>, fabric: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let py = name.py();
        let name = words::path(name, "garment")?;
        let name = words::text(&name)?;
        let fabric = fabric.map(|fabric| words::path(fabric, "fabric")).transpose()?;
        let fabric = fabric.as_deref().map(words::text).transpose()?;
        let inner = detached(py, || {
            let mut opened = SdkGarment::open(name)?;
            if let Some(fabric) = fabric {
                opened = opened.in_fabric(fabric)?;
            }
            match size {
                Some(size) => opened.in_size(size),
                None => Ok(opened),
            }
        })?;
        Ok(Self { inner })
    }

    /// What it was opened by.
    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    /// The size that was asked for; None is the one that fits.
    #[getter]
    fn size(&self) -> Option<&str> {
        self.inner.size()
    }

    /// The sizes that are made, smallest first; empty of a mesh that has none.
    #[getter]
    fn sizes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, guarded(|| Ok(self.inner.sizes().map_err(Failure::from)?))?)
    }

    /// The fabric that it is made of.
    #[getter]
    fn fabric(&self) -> PyResult<String> {
        guarded(|| Ok(self.inner.fabric().map_err(Failure::from)?))
    }

    /// The size that fits a body, or how the one that was asked for does; the same as ``toile.recommend``.
    ///
    /// Parameters
    /// ----------
    /// body : Body
    ///
    /// Returns
    /// -------
    /// Recommendation
    fn fit<'py>(&self, py: Python<'py>, body: &Bound<'py, Body>) -> PyResult<Bound<'py, PyAny>> {
        judge(py, body.get(), self)
    }

    fn __repr__(&self) -> String {
        let size = self.inner.size().unwrap_or("that fits");
        format!("<toile.Garment {:?}, size {size}>", self.inner.name())
    }
}

fn judge<'py>(py: Python<'py>, body: &Body, garment: &Garment) -> PyResult<Bound<'py, PyAny>> {
    let fit = detached(py, || toile_sdk::recommend(&body.inner, &garment.inner))?;
    results::recommendation(py, &fit)
}

/// The size of a garment that fits a body, or how the one that was asked for does, worn over nothing else.
///
/// Parameters
/// ----------
/// body : Body
/// garment : Garment
///
/// Returns
/// -------
/// Recommendation
///     Size, chance of each size, ease, sigma and words for each zone.
///
/// Raises
/// ------
/// InputError
///     A garment that has no sizes, or cannot be laid on the body.
#[pyfunction]
pub fn recommend<'py>(body: &Bound<'py, Body>, garment: &Bound<'py, Garment>) -> PyResult<Bound<'py, PyAny>> {
    judge(body.py(), body.get(), garment.get())
}

/// One garment, or some, inner first.
pub fn garments(given: &Bound<'_, PyAny>) -> PyResult<Vec<SdkGarment>> {
    if let Ok(one) = given.cast::<Garment>() {
        return Ok(vec![one.get().inner.clone()]);
    }
    let wrong = |given: &Bound<'_, PyAny>| -> PyErr {
        let given = given.repr().map_or_else(|_| "what is given".to_owned(), |repr| repr.to_string());
        Failure::usage(format!("{given} is no garment; give a toile.Garment, or a list of them, inner first")).into()
    };
    let each = given.try_iter().map_err(|_| wrong(given))?;
    each.map(|one| {
        let one = one?;
        one.cast::<Garment>().map(|garment| garment.get().inner.clone()).map_err(|_| wrong(&one))
    })
    .collect()
}
