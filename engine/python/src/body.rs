//! Bodies.

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use toile_sdk::Body as SdkBody;

use crate::failure::{Failure, detached};
use crate::{views, words};

/// A body in its rest pose, arms half raised, feet on the floor at y = 0, facing +z.
///
/// Made by ``from_measures``, ``average`` or ``open``, or of a measured person (``Measured.body``). It never changes; any
/// thread may use it.
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Body {
    pub inner: SdkBody,
}

#[pymethods]
impl Body {
    /// The body of a sex that has these measures, each within 2 mm.
    ///
    /// Parameters
    /// ----------
    /// sex : {"female", "male"}
    /// **mm : float
    ///     Measures (mm) by the names of ``toile.measure_names()`` or the words for them: ``stature=1720, chest=920``. All others
    ///     are what people with these are expected to have.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     An unknown measure, one that no body has, or measures that none has together.
    #[classmethod]
    #[pyo3(signature = (sex, /, **mm))]
    fn from_measures(_: &Bound<'_, PyType>, sex: &str, mm: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let sex = words::sex(sex)?;
        let given = mm.map(measures).transpose()?.unwrap_or_default();
        if given.is_empty() {
            return Err(Failure::usage(
                "no measure is given; give some in mm, such as stature=1720, or take Body.average",
            )
            .into());
        }
        let borrowed: Vec<(&str, f64)> = given.iter().map(|(name, mm)| (name.as_str(), *mm)).collect();
        let py = mm.map(|mm| mm.py());
        let make = || SdkBody::from_measures_mm(sex, &borrowed);
        let inner = match py {
            Some(py) => detached(py, make)?,
            None => make().map_err(Failure::from)?,
        };
        Ok(Self { inner })
    }

    /// The average body of a sex (ANSUR II).
    ///
    /// Parameters
    /// ----------
    /// sex : {"female", "male"}
    #[classmethod]
    fn average(of: &Bound<'_, PyType>, sex: &str) -> PyResult<Self> {
        let sex = words::sex(sex)?;
        Ok(Self { inner: detached(of.py(), || SdkBody::average(sex))? })
    }

    /// A body that others made: a skinned glTF 2.0 mesh or a VRM avatar.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    /// sex : {"female", "male"}
    ///     Whose garments it wears.
    #[classmethod]
    fn open(of: &Bound<'_, PyType>, path: &Bound<'_, PyAny>, sex: &str) -> PyResult<Self> {
        let (path, sex) = (words::path(path, "file of a body")?, words::sex(sex)?);
        Ok(Self { inner: detached(of.py(), || SdkBody::open(path, sex))? })
    }

    /// "female" or "male": whose drawing it is stretched from.
    #[getter]
    fn sex(&self) -> &'static str {
        self.inner.sex().name()
    }

    /// Measures that are read off the body (mm), a new dict by their names.
    #[getter]
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let measures = PyDict::new(py);
        self.inner.measures_mm().iter().try_for_each(|(name, mm)| measures.set_item(name, mm))?;
        Ok(measures)
    }

    /// One of the measures by its name or a word for it (mm).
    fn measure(&self, name: &str) -> PyResult<f64> {
        Ok(self.inner.measure_mm(name).map_err(Failure::from)?)
    }

    /// Vertices in the rest pose (m), float32 [n, 3], read-only and without a copy.
    #[getter]
    fn positions<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        views::lent_vectors(slf, |body| body.inner.positions())
    }

    /// Triangles, counter-clockwise from outside, uint32 [n, 3], read-only and without a copy.
    #[getter]
    fn faces<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        views::lent_triangles(slf, |body| body.inner.faces())
    }

    /// Notes on how it was made, a sentence each.
    #[getter]
    fn notes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.inner.notes())
    }

    fn __repr__(&self) -> String {
        let named = |name: &str| self.inner.measure_mm(name).unwrap_or(f64::NAN);
        let [stature, chest, waist, hip] = ["stature", "chest", "waist", "hip"].map(named);
        let sex = self.sex();
        format!("<toile.Body {sex}, stature {stature:.0} mm, chest {chest:.0}, waist {waist:.0}, hip {hip:.0}>")
    }
}

/// Measures (mm) that were given by their names.
pub fn measures(given: &Bound<'_, PyDict>) -> PyResult<Vec<(String, f64)>> {
    let measure = |(name, mm): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract().map_err(|_| Failure::usage("a measure's name is no str; give its name"))?;
        let Ok(mm) = mm.extract() else {
            let mm = mm.repr()?;
            return Err(Failure::usage(format!("the {name} is {mm}, which is no number; give it in mm")).into());
        };
        Ok((name, mm))
    };
    given.iter().map(measure).collect()
}
