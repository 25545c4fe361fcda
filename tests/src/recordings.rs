//! Recordings of real sensors, found through the environment variable `TOILE_DATA`.

use std::path::PathBuf;

/// The folder of recordings. Where it is not given, tests that need it are skipped with a word, but not in continuous
/// integration (`CI=true`), where missing data is a failure.
///
/// # Panics
/// In continuous integration without data.
pub fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("TOILE_DATA").map(PathBuf::from);
    if folder.is_none() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "TOILE_DATA must name the folder of recordings");
        eprintln!("skipped: TOILE_DATA does not name the folder of recordings");
    }
    folder
}
