//! Exceptions: a class for programs, a sentence with the cure for people.

use std::any::Any;
use std::fmt::Display;
use std::panic::{self, AssertUnwindSafe};

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use toile_sdk::{Error, ErrorKind};

/// A call that cannot be done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    kind: ErrorKind,
    sentence: String,
}

impl Failure {
    pub fn new(kind: ErrorKind, sentence: impl Display) -> Self {
        Self { kind, sentence: sentence.to_string() }
    }

    pub fn usage(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Usage, sentence: sentence.to_string() }
    }

    pub fn input(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Input, sentence: sentence.to_string() }
    }

    pub fn internal(sentence: impl Display) -> Self {
        Self { kind: ErrorKind::Internal, sentence: sentence.to_string() }
    }

    /// Of what a panic said.
    fn panicked(said: &(dyn Any + Send)) -> Self {
        let text = said.downcast_ref::<&str>().copied();
        let text = text.or_else(|| said.downcast_ref::<String>().map(String::as_str));
        let text = text.unwrap_or("it does not say why");
        Self::internal(format!(
            "a fault of Toile's own ended the call: {text}; a scene that it was made on can only be closed, please report this"
        ))
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self { kind: error.kind(), sentence: error.sentence().to_owned() }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| match class(py, failure.kind) {
            Ok(class) => Self::from_type(class, failure.sentence),
            Err(missing) => missing,
        })
    }
}

/// The class of an exception, which the package defines in Python.
fn class(py: Python<'_>, kind: ErrorKind) -> PyResult<Bound<'_, PyType>> {
    static CLASSES: [PyOnceLock<Py<PyType>>; 4] = [const { PyOnceLock::new() }; 4];
    let (place, name) = match kind {
        ErrorKind::Usage => (0, "UsageError"),
        ErrorKind::Input => (1, "InputError"),
        ErrorKind::Device => (2, "DeviceError"),
        _ => (3, "InternalError"),
    };
    CLASSES[place].import(py, "toile.errors", name).cloned()
}

/// Does work that holds the interpreter's lock; a panic becomes an exception.
pub fn guarded<T>(work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|said| Err(Failure::panicked(said.as_ref()).into()))
}

/// Does work without the interpreter's lock, so that other threads of Python run meanwhile; a panic becomes an exception.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> toile_sdk::Result<T> + Send) -> PyResult<T> {
    let done =
        py.detach(|| panic::catch_unwind(AssertUnwindSafe(work)).map_err(|said| Failure::panicked(said.as_ref())));
    Ok(done?.map_err(Failure::from)?)
}
