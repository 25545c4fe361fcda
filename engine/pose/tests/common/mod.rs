//! The network's files for tests.

pub mod references;

use std::env;
use std::path::PathBuf;

use toile_pose::files;

/// The folder of the network; none, with a word, where it is not fetched. Where continuous integration names a folder, they
/// must be there.
pub fn network_folder() -> Option<PathBuf> {
    let folder = files::folder();
    match files::check(&folder) {
        Ok(()) => Some(folder),
        Err(error) => {
            assert!(env::var_os(files::FOLDER_VARIABLE).is_none(), "{error}");
            eprintln!("skipped, did not run: {error}");
            None
        }
    }
}
