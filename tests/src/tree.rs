//! The files of the workspace.

use std::fs;
use std::path::{Path, PathBuf};

/// The crates, in order: a crate imports only those before it. Folder and name. A new crate gets a line here;
/// the order of its modules stands in its own `lib.rs`, as groups of `mod` parted by blank lines.
pub const CRATES: &[(&str, &str)] = &[
    ("assets/base", "toile-base"),
    ("assets/bake", "toile-bake"),
    ("assets", "toile-assets"),
    ("assets/sculpt", "toile-sculpt"),
    ("sensors", "toile-sensors"),
    ("engine/core", "toile-engine"),
    ("engine/gpu", "toile-gpu"),
    ("engine/pose", "toile-pose"),
    ("engine/track", "toile-track"),
    ("engine/view", "toile-view"),
    ("engine/fitting", "toile-fitting"),
    ("engine/cli", "toile-cli"),
    ("engine/sdk", "toile-sdk"),
    ("engine/study", "toile-study"),
    ("engine/c", "toile-c"),
    ("engine/python", "toile-python"),
    ("engine/kiosk", "toile-kiosk"),
    ("engine/capture", "toile-capture"),
    ("engine/app", "toile"),
    ("perf", "toile-perf"),
    ("tests/models", "toile-models"),
    ("tests/platforms", "toile-platforms"),
    ("tests", "toile-workspace"),
];

/// The workspace's folder.
///
/// # Panics
/// Where the crate does not lie in a workspace.
pub fn root() -> PathBuf {
    let parent = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    parent.expect("the tests' crate lies one folder below the workspace").to_path_buf()
}

/// Every file below a folder, sorted, that `keep` takes; build output, git's own folder and a run's output are
/// passed over.
///
/// # Panics
/// Where a folder cannot be read.
pub fn files(folder: &Path, keep: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(folder) = open.pop() {
        let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{} cannot be read: {e}", folder.display()));
        for entry in entries {
            let path = entry.expect("an entry can be read").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() {
                if !["target", ".git", "out"].contains(&name.as_str()) {
                    open.push(path);
                }
            } else if name != ".git" && keep(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Every Rust file of a crate, sorted.
pub fn crate_files(folder: &str) -> Vec<PathBuf> {
    rust_files(&root().join(folder))
}

/// Every Rust file below a folder, sorted; those of crates that lie inside it are not its own.
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let inner = |path: &Path| {
        let mut between = path.ancestors().skip(1).take_while(|above| *above != folder);
        between.any(|above| above.join("Cargo.toml").exists())
    };
    files(folder, |path| path.extension().is_some_and(|e| e == "rs") && !inner(path))
}

/// A file's text.
///
/// # Panics
/// Where it cannot be read.
pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{} cannot be read: {e}", path.display()))
}

/// A path as people name it: relative to the workspace.
pub fn name(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

/// The modules that lead to a file of `src`: `src/a/mod.rs` and `src/a.rs` are `[a]`, `src/a/b.rs` is `[a, b]`.
pub fn module_path(src: &Path, file: &Path) -> Vec<String> {
    let inside = file.strip_prefix(src).unwrap_or(file).with_extension("");
    let mut path: Vec<String> = inside.iter().map(|s| s.to_string_lossy().into_owned()).collect();
    if path.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        path.pop();
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn module_paths_follow_the_files() {
        let of = |file: &str| module_path(Path::new("src"), Path::new(file)).join("::");
        assert_eq!(of("src/lib.rs"), "");
        assert_eq!(of("src/a.rs"), "a");
        assert_eq!(of("src/a/mod.rs"), "a");
        assert_eq!(of("src/a/b.rs"), "a::b");
    }

    #[test]
    fn every_crate_is_there() {
        for (folder, name) in CRATES {
            let manifest = read(&root().join(folder).join("Cargo.toml"));
            assert!(manifest.contains(&format!("name = \"{name}\"")), "{folder}");
        }
    }
}
