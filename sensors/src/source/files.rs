//! Shared code of the readers of files and folders.

use std::path::{Path, PathBuf};

use crate::error::{FilePlace, ReaderFault};
use crate::limits::{MAX_FILE_BYTES, RECORDING};

/// How to open a recording.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// JSON that describes the camera of depth images: `width`, `height`, `fx`, `fy`, `cx`, `cy` (px) and optionally
    /// `cam_to_world` (4 x 4, mm, y up), `distortion` (`k1` .. `k6`, `p1`, `p2`) and `mm_per_unit`.
    pub camera: Option<PathBuf>,
}

/// Counts the bytes of a folder's files, which together are at most [`MAX_FILE_BYTES`].
pub(super) fn count_bytes(total: &mut u64, bytes: &[u8]) -> Result<(), ReaderFault> {
    *total += bytes.len() as u64;
    if *total > MAX_FILE_BYTES {
        let problem = format!("its files have more than the {MAX_FILE_BYTES} bytes that are read of a recording");
        return Err(ReaderFault::new(FilePlace::Whole, problem, RECORDING.cure));
    }
    Ok(())
}

/// A path as errors name it.
pub(super) fn shown(path: &Path) -> String {
    path.display().to_string()
}
