//! One kiosk at a time on a machine: a file that is locked for as long as the program runs. The system releases the lock when
//! the process ends, however it does. The file is empty; nothing is ever written to it.

use std::env;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use crate::error::KioskError;

/// Where the service's lock is when systemd runs it (the unit's `RuntimeDirectory`).
const SERVICE_FOLDER: &str = "/run/toile";

/// Longest name of an instance (bytes).
const MOST_NAME: usize = 32;

/// A lock that this process holds.
#[derive(Debug)]
pub struct InstanceLock {
    _held: File,
}

/// Checks the name of an instance, which is part of a file's name.
///
/// # Errors
/// What a name may consist of.
pub fn name(text: &str) -> Result<String, String> {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if text.is_empty() || text.len() > MOST_NAME || !text.chars().all(allowed) {
        return Err(format!("a name has 1 to {MOST_NAME} letters, digits, - and _"));
    }
    Ok(text.to_owned())
}

impl InstanceLock {
    /// Takes the lock of an instance; none is the only one.
    ///
    /// # Errors
    /// A kiosk of this name that runs, or a folder in which no lock can be made; each with the cure.
    pub fn take(instance: Option<&str>) -> Result<Self, KioskError> {
        let file = instance.map_or_else(|| "toile-kiosk.lock".to_owned(), |name| format!("toile-kiosk-{name}.lock"));
        let folder = folder();
        if folder != Path::new(SERVICE_FOLDER) && is_held(&Path::new(SERVICE_FOLDER).join(&file)) {
            return Err(running());
        }
        Self::at(&folder.join(file))
    }

    fn at(path: &Path) -> Result<Self, KioskError> {
        let refused = |e: &dyn std::fmt::Display| {
            let path = path.display();
            KioskError::Device(format!(
                "the kiosk cannot lock {path} ({e}); set XDG_RUNTIME_DIR to a folder of its own"
            ))
        };
        let file = open(path).map_err(|e| refused(&e))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _held: file }),
            Err(TryLockError::WouldBlock) => Err(running()),
            Err(TryLockError::Error(e)) => Err(refused(&e)),
        }
    }
}

fn running() -> KioskError {
    KioskError::Device(
        "a kiosk already runs on this machine; end it, or give this one a name of its own by `--instance NAME`".into(),
    )
}

/// Opens a lock's file for reading, and makes it where there is none. No link or device in its place is followed or waited for.
fn open(path: &Path) -> io::Result<File> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() => return File::open(path),
        Ok(_) => return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file")),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {}
        Err(e) => return Err(e),
    }
    match File::create_new(path) {
        Ok(made) => allow_reading(&made)?,
        // Another one made it in the meantime.
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
        Err(e) => return Err(e),
    }
    File::open(path)
}

/// Whatever the mask of the process: who cannot open the file cannot see that it is locked.
#[cfg(unix)]
fn allow_reading(file: &File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn allow_reading(_file: &File) -> io::Result<()> {
    Ok(())
}

/// Whether a process holds a lock; a lock that cannot be read counts as free.
fn is_held(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
    // Shared and for a moment: two that look at it do not see each other.
    is_file && File::open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The folder of locks: the service's, the user's, or else that of temporary files.
fn folder() -> PathBuf {
    let named = |variable: &str| {
        let value = env::var_os(variable)?;
        // systemd lists several, separated by colons; the first one counts.
        env::split_paths(&value).next().filter(|path| path.is_absolute() && path.is_dir())
    };
    named("RUNTIME_DIRECTORY").or_else(|| named("XDG_RUNTIME_DIR")).or_else(of_user).unwrap_or_else(env::temp_dir)
}

/// The user's runtime folder where no variable names it, as under `su`.
#[cfg(target_os = "linux")]
fn of_user() -> Option<PathBuf> {
    use std::os::unix::fs::MetadataExt;
    let user = fs::metadata("/proc/self").ok()?.uid();
    Some(PathBuf::from(format!("/run/user/{user}"))).filter(|path| path.is_dir())
}

#[cfg(not(target_os = "linux"))]
fn of_user() -> Option<PathBuf> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let folder = env::temp_dir().join(format!("toile-instance-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_second_one_is_refused_while_the_first_one_lives_and_no_longer() {
        let folder = scratch("second");
        let path = folder.join("a.lock");
        assert!(!is_held(&path));
        let first = InstanceLock::at(&path).unwrap();
        assert!(is_held(&path));
        let refused = InstanceLock::at(&path).unwrap_err();
        assert!(matches!(&refused, KioskError::Device(message) if message.contains("--instance")), "{refused}");
        assert!(InstanceLock::at(&folder.join("b.lock")).is_ok(), "another name is another kiosk");
        drop(first);
        assert!(!is_held(&path));
        assert!(InstanceLock::at(&path).is_ok());
        assert_eq!(fs::metadata(&path).unwrap().len(), 0);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_is_no_regular_file_is_refused() {
        let folder = scratch("folder");
        let message = InstanceLock::at(&folder).unwrap_err().to_string();
        assert!(message.contains("not a regular file") && message.contains("XDG_RUNTIME_DIR"), "{message}");
        let nowhere = InstanceLock::at(&folder.join("none/a.lock")).unwrap_err();
        assert!(matches!(nowhere, KioskError::Device(_)));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_name_is_part_of_a_file_name_and_nothing_else() {
        assert_eq!(name("left-2").as_deref(), Ok("left-2"));
        for bad in ["", "../x", "a b", "ü", &"x".repeat(33)] {
            assert!(name(bad).is_err(), "{bad}");
        }
    }
}
