//! Recordings of real sensors, found through the environment variable `TOILE_DATA`. Tests of other crates include this file.

use std::path::PathBuf;

/// The folder of recordings. Where it is not given, tests that need it are skipped with a word, but not in continuous
/// integration (`CI=true`), where missing data is a failure.
///
/// # Panics
/// In continuous integration without data, and where there is no such folder.
pub fn folder() -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("TOILE_DATA") else {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "TOILE_DATA must name the folder of recordings");
        eprintln!("skipped: TOILE_DATA does not name the folder of recordings");
        return None;
    };
    Some(PathBuf::from(folder).canonicalize().expect("TOILE_DATA names no folder"))
}
