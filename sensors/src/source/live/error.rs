//! Why a camera cannot be used: one sentence that says what, where, and the cure.

use std::path::PathBuf;

/// Error that stops a camera.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// Its library is not installed.
    #[error("a {camera} needs {library}, which is not installed; {cure}")]
    LibraryMissing {
        /// The kind of camera.
        camera: &'static str,
        /// The library's name.
        library: &'static str,
        /// How it is installed.
        cure: String,
    },
    /// Its library is there and cannot be used.
    #[error("{} cannot be used ({problem}); install the version that `toile doctor` names", path.display())]
    LibraryUnfit {
        /// The library's file.
        path: PathBuf,
        /// The loader's message.
        problem: String,
    },
    /// No camera is connected.
    #[error("no {camera} is connected; {cure}")]
    NotConnected {
        /// The kind of camera.
        camera: &'static str,
        /// The cure.
        cure: &'static str,
    },
    /// The library refuses.
    #[error("{camera}: {what}{}; {cure}", said(said_by_library))]
    Refused {
        /// The kind of camera.
        camera: &'static str,
        /// The call that failed.
        what: String,
        /// The library's message.
        said_by_library: String,
        /// The cure.
        cure: &'static str,
    },
    /// A recording that was to be played as a camera, in the words of its reader.
    #[error("{0}")]
    Recording(String),
    /// No such camera.
    #[error("{0}")]
    Unknown(String),
}

impl CameraError {
    /// Whether what was given is at fault, and no device.
    pub const fn is_input(&self) -> bool {
        matches!(self, Self::Recording(_) | Self::Unknown(_))
    }
}

/// What a library says, in parentheses, shortened to a line.
fn said(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let line: String = words.join(" ").chars().take(200).collect();
    if line.is_empty() { line } else { format!(" ({line})") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_library_says_becomes_one_line() {
        let what = "its depth cannot be started".to_owned();
        let refused = |text: &str| CameraError::Refused {
            camera: "Kinect",
            what: what.clone(),
            said_by_library: text.to_owned(),
            cure: "plug it in again",
        };
        assert_eq!(refused("").to_string(), "Kinect: its depth cannot be started; plug it in again");
        assert_eq!(refused("a\n b").to_string(), "Kinect: its depth cannot be started (a b); plug it in again");
    }
}
