//! Laws of imports.

use std::path::PathBuf;

/// The folder of shared data; nothing, with a word, where it is not there and need not be.
pub(crate) fn data() -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("TOILE_DATA") else {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "TOILE_DATA is not set: point it at the shared data");
        eprintln!("skipped: TOILE_DATA is not set");
        return None;
    };
    Some(folder.into())
}
