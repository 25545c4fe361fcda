//! Libraries of cameras, loaded at run time where they are installed: nothing is needed to build, and a machine without a
//! camera needs none of them.
//!
//! A library stays loaded until the program ends, because the code of its own threads must not be unloaded.

#![allow(unsafe_code, reason = "libraries are loaded and their functions looked up")]

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};

use super::error::CameraError;

/// Folders, parted by colons, in which libraries are sought before the system's own.
pub const FOLDERS_VARIABLE: &str = "TOILE_CAMERA_LIBRARIES";

/// Where libraries are put that no package of the system holds; each in a folder of its own below it.
pub const OWN_FOLDER: &str = "/usr/local/lib/toile/cameras";

/// Folders of the system that its loader does not look into for a name without a version.
const SYSTEM_FOLDERS: [&str; 4] =
    ["/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/local/lib", "/usr/lib"];

/// A library, as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LibraryName {
    /// The kind of camera that it is for.
    pub camera: &'static str,
    /// Its name in words.
    pub library: &'static str,
    /// Names that the system's loader knows.
    pub names: &'static [&'static str],
    /// What its file's name begins with, whatever version or hash follows.
    pub stems: &'static [&'static str],
    /// Command that installs it.
    pub install: &'static str,
}

/// A library that is loaded.
#[derive(Debug)]
pub(in crate::source) struct Library {
    handle: ManuallyDrop<libloading::Library>,
    /// Its file, or its name where the system's loader found it.
    pub path: PathBuf,
}

impl Library {
    /// Loads a library from these folders, or from where the system has it.
    pub fn load(name: &LibraryName, folders: &[PathBuf]) -> Result<Self, CameraError> {
        let mut unfit = None;
        for path in candidates(name, folders) {
            match open(&path) {
                Ok(handle) => return Ok(Self { handle: ManuallyDrop::new(handle), path }),
                // A name without a folder that the loader does not find is not there; a file that it refuses is unfit.
                Err(problem) if path.is_file() => {
                    unfit.get_or_insert(CameraError::LibraryUnfit { path, problem });
                }
                Err(_) => {}
            }
        }
        Err(unfit.unwrap_or_else(|| CameraError::LibraryMissing {
            camera: name.camera,
            library: name.library,
            cure: format!("install it: `{}`", name.install),
        }))
    }

    /// A function of the library.
    ///
    /// # Safety
    /// `T` must be the type of a function pointer with the signature that the library's header gives it.
    pub unsafe fn function<T: Copy>(&self, name: &str) -> Result<T, CameraError> {
        // SAFETY: the caller promises the type. What is looked up is copied, and the library is never unloaded.
        let found = unsafe { self.handle.get::<T>(name.as_bytes()) };
        found.map(|symbol| *symbol).map_err(|e| CameraError::LibraryUnfit {
            path: self.path.clone(),
            problem: format!("it has no function {}: {e}", name.trim_end_matches('\0')),
        })
    }
}

/// A table of a library's functions, loaded by their names.
macro_rules! functions {
    ($(#[$about:meta])* $name:ident { $(fn $f:ident($($a:ty),* $(,)?) $(-> $r:ty)?;)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        #[allow(non_snake_case, reason = "functions have the names of their library")]
        struct $name { $($f: unsafe extern "C" fn($($a),*) $(-> $r)?,)+ }

        impl $name {
            fn of(library: &crate::source::live::library::Library) -> Result<Self, crate::source::live::error::CameraError> {
                // SAFETY: each signature below is that of the library's header.
                Ok(unsafe { Self { $($f: library.function(concat!(stringify!($f), "\0"))?,)+ } })
            }
        }
    };
}
pub(in crate::source) use functions;

/// The folders of the environment, then Toile's own.
pub fn folders() -> Vec<PathBuf> {
    let given = env::var_os(FOLDERS_VARIABLE);
    let given = given.iter().flat_map(env::split_paths).filter(|folder| !folder.as_os_str().is_empty());
    given.chain([PathBuf::from(OWN_FOLDER)]).collect()
}

/// Where a library may be: in the folders and the folders in them, where the loader finds it, in the system's folders.
fn candidates(name: &LibraryName, folders: &[PathBuf]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in folders {
        found.extend(matching(folder, name.stems));
        let mut below: Vec<PathBuf> = entries(folder).filter(|path| path.is_dir()).collect();
        below.sort();
        found.extend(below.iter().flat_map(|folder| matching(folder, name.stems)));
    }
    found.extend(name.names.iter().map(PathBuf::from));
    found.extend(SYSTEM_FOLDERS.iter().flat_map(|folder| matching(Path::new(folder), name.stems)));
    found
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
}

/// The shared objects of a folder whose names begin with one of the stems, the newest name first.
fn matching(folder: &Path, stems: &[&str]) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = entries(folder).filter(|path| is_named(path.file_name(), stems)).collect();
    found.sort();
    found.reverse();
    found
}

/// Whether a file's name is a stem, a version or a hash, and the ending of a shared object.
fn is_named(name: Option<&OsStr>, stems: &[&str]) -> bool {
    let Some(name) = name.and_then(OsStr::to_str) else { return false };
    let follows = |rest: &str| rest.starts_with(['.', '-']) && (rest.ends_with(".so") || rest.contains(".so."));
    !name.ends_with(".debug") && stems.iter().any(|stem| name.strip_prefix(stem).is_some_and(follows))
}

#[cfg(unix)]
fn open(path: &Path) -> Result<libloading::Library, String> {
    use libloading::os::unix::{Library as Opened, RTLD_GLOBAL, RTLD_LAZY};
    if let Some(python) = python_of(path) {
        // SAFETY: Python's own library, whose initialisers run no code of Python. A module of Python, which librealsense ships in,
        // has references to its data.
        if let Ok(python) = unsafe { Opened::open(Some(python), RTLD_LAZY | RTLD_GLOBAL) } {
            std::mem::forget(python);
        }
    }
    // SAFETY: a camera's library, which was installed to be run; its initialisers are as trusted as its functions.
    let opened = unsafe { Opened::open(Some(path), RTLD_LAZY) };
    opened.map(libloading::Library::from).map_err(|e| e.to_string())
}

#[cfg(not(unix))]
fn open(path: &Path) -> Result<libloading::Library, String> {
    // SAFETY: a camera's library, which was installed to be run; its initialisers are as trusted as its functions.
    unsafe { libloading::Library::new(path) }.map_err(|e| e.to_string())
}

/// The library of the Python that a module is built for, by its name: `x.cpython-311-y.so`.
#[cfg(unix)]
fn python_of(module: &Path) -> Option<String> {
    let name = module.file_name()?.to_str()?;
    let (_, rest) = name.split_once(".cpython-")?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let (major, minor) = digits.split_at_checked(1)?;
    (!minor.is_empty()).then(|| format!("libpython{major}.{minor}.so.1.0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: LibraryName = LibraryName {
        camera: "Nothing",
        library: "libnothing",
        names: &["libtoile-has-no-such-library.so"],
        stems: &["libtoile-has-no-such-library"],
        install: "sudo apt install nothing",
    };

    #[test]
    fn a_library_is_known_by_its_stem_whatever_version_or_hash_follows() {
        let named = |name: &str, stem: &str| is_named(Some(OsStr::new(name)), &[stem]);
        assert!(named("libk4a-f64cb9eb.so.1.4.2", "libk4a") && named("libk4a.so", "libk4a"));
        assert!(!named("libk4arecord-939c.so.1.4.2", "libk4a") && !named("libk4a.txt", "libk4a"));
        assert!(named("pyrealsense2.cpython-311-x86_64-linux-gnu.so", "pyrealsense2"));
        assert!(!named("pyrealsense2.cpython-311-x86_64-linux-gnu.so.debug", "pyrealsense2"));
    }

    #[test]
    fn a_library_that_is_not_there_is_named_with_the_command_that_installs_it() {
        let error = Library::load(&NONE, &[]).unwrap_err().to_string();
        assert_eq!(error, "a Nothing needs libnothing, which is not installed; install it: `sudo apt install nothing`");
    }

    #[test]
    fn a_file_that_is_no_library_is_named() {
        let folder = env::temp_dir().join(format!("toile-library-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("libtoile-has-no-such-library.so.1"), "not a library").unwrap();
        let error = Library::load(&NONE, std::slice::from_ref(&folder)).unwrap_err();
        fs::remove_dir_all(&folder).unwrap();
        assert!(matches!(error, CameraError::LibraryUnfit { .. }), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_module_of_python_needs_the_library_of_that_python() {
        assert_eq!(python_of(Path::new("a/b.cpython-311-x86_64.so")).as_deref(), Some("libpython3.11.so.1.0"));
        assert_eq!(python_of(Path::new("a/librealsense2.so")), None);
    }
}
