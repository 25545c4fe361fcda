//! Errors of a scene, in one sentence: the file, the line, the key and the cure.

use std::path::PathBuf;

use thiserror::Error;

use crate::toml_keys;

/// Why a scene cannot be run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SceneError {
    /// The scene file itself cannot be read.
    #[error("scene {}: {reason}; give the path of a readable TOML file", path.display())]
    Read {
        /// The file's path as the user gave it.
        path: PathBuf,
        /// Error of the operating system.
        reason: String,
    },
    /// Something in it is wrong.
    #[error("{file}:{line}:{column}: {message}")]
    At {
        /// The scene file.
        file: String,
        /// Line in the file, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// One sentence that names the key and the cure.
        message: String,
    },
    /// No example of that name.
    #[error("there is no example named {name}; choose one of {known}")]
    NoExample {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
}

/// The text of a scene and its name, by which errors name places in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SceneDocument<'t> {
    /// The file as the user named it.
    pub file: &'t str,
    /// The whole text, in TOML.
    pub text: &'t str,
}

impl SceneDocument<'_> {
    /// An error at a byte of the text.
    pub fn error(&self, at: usize, message: impl Into<String>) -> SceneError {
        let (line, column) = toml_keys::place(self.text, at);
        let message = message.into().split_whitespace().collect::<Vec<_>>().join(" ");
        SceneError::At { file: self.file.into(), line, column, message }
    }
}
