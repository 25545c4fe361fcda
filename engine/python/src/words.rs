//! Names of enumerated values.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use toile_sdk::{Look, Quality, Sex, View};

use crate::failure::Failure;

/// A sex that has to be known.
pub fn sex(word: &str) -> Result<Sex, Failure> {
    let found = Sex::ALL.into_iter().find(|sex| sex.name() == word);
    found.ok_or_else(|| Failure::usage(format!("there is no sex {word:?}; give \"female\" or \"male\"")))
}

/// A sex, or that it is not known.
pub fn optional_sex(word: Option<&str>) -> Result<Option<Sex>, Failure> {
    word.map(sex).transpose()
}

/// Tested settings of the cloth.
pub fn quality(word: &str) -> Result<Quality, Failure> {
    word.parse().map_err(Failure::usage)
}

/// What a picture shows of cloth.
pub fn look(word: &str) -> Result<Look, Failure> {
    match word {
        "fabric" => Ok(Look::Fabric),
        "fit_map" => Ok(Look::FitMap),
        _ => Err(Failure::usage(format!("there is no look {word:?}; give \"fabric\" or \"fit_map\""))),
    }
}

/// From where a picture is taken: a word, or degrees.
pub fn view(given: &Bound<'_, PyAny>) -> PyResult<View> {
    if let Ok(degrees) = given.extract::<f32>() {
        if degrees.is_finite() {
            return Ok(View::Turned(degrees));
        }
        return Err(Failure::usage("a view is turned by finite degrees; give a number").into());
    }
    let word = given.extract::<String>();
    match word.as_deref() {
        Ok("front") => Ok(View::Front),
        Ok("side") => Ok(View::Side),
        Ok("back") => Ok(View::Back),
        _ => {
            let given = given.repr()?;
            Err(Failure::usage(format!("there is no view {given}; give \"front\", \"side\", \"back\" or degrees"))
                .into())
        }
    }
}

/// A text or a path as text.
pub fn text(path: &Path) -> Result<&str, Failure> {
    path.to_str().ok_or_else(|| Failure::input(format!("{} is not UTF-8; rename it", path.display())))
}

/// What `pathlib` has, or a text.
pub fn path(given: &Bound<'_, PyAny>, what: &str) -> PyResult<PathBuf> {
    given.extract().map_err(|_| {
        let kind = given.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string());
        Failure::usage(format!("the {what} is of type {kind}; give a str or a path")).into()
    })
}

/// A number that counts from 0: of garments, of steps, of images.
pub fn counted(number: i64, what: &str) -> Result<usize, Failure> {
    usize::try_from(number).map_err(|_| Failure::usage(format!("{number} is no {what}; they are counted from 0")))
}
