//! The one way to read a user's file: a regular file, of a bounded size, or one sentence that says what is wrong.
//!
//! Anything but a regular file is refused before it is opened, because opening a FIFO waits for a writer and reading a
//! device may never end. The opened file is looked at again, in case it was exchanged in between, and the bytes are
//! counted while they are read, because a file may grow and those of `/proc` say that they are empty.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;
use std::time::SystemTime;

use thiserror::Error;

/// What a file is read as: the words of its errors, and how large it may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileKind {
    /// What it is, with its article: "a scene file".
    pub name: &'static str,
    /// Most bytes that are read.
    pub max_bytes: u64,
    /// What to do where it is larger: "cut the recording into shorter pieces".
    pub cure: &'static str,
}

/// Why a file was not read: what, where, and the cure.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FileError {
    /// The operating system refused to read it.
    #[error("{path}: cannot be read ({reason}); give the path of {name}, and check that you may read it", name = kind.name)]
    Refused {
        /// The file's path as the user gave it.
        path: String,
        /// Kind of file that was expected.
        kind: FileKind,
        /// Error of the operating system.
        reason: String,
    },
    /// A folder, a FIFO, a socket or a device.
    #[error("{path}: it is {found}, not {name}; give the path of a regular file", name = kind.name)]
    NotRegular {
        /// The file's path as the user gave it.
        path: String,
        /// Kind of file that was expected.
        kind: FileKind,
        /// What it is, with its article.
        found: &'static str,
    },
    /// Larger than [`FileKind::max_bytes`].
    #[error("{path}: it has {size}, and of {name} at most {most} bytes are read; {cure}", size = shown_size(*bytes),
        name = kind.name, most = kind.max_bytes, cure = kind.cure)]
    TooLarge {
        /// The file's path as the user gave it.
        path: String,
        /// Kind of file that was expected.
        kind: FileKind,
        /// Its size, where the system knows it.
        bytes: Option<u64>,
    },
    /// The content is not UTF-8.
    #[error("{path}: {name} is text in UTF-8, and this is not; save it as UTF-8", name = kind.name)]
    NotText {
        /// The file's path as the user gave it.
        path: String,
        /// Kind of file that was expected.
        kind: FileKind,
    },
}

impl FileError {
    /// The fault, without the path and the cure: for sentences that name both themselves.
    pub fn reason(&self) -> String {
        match self {
            Self::Refused { reason, .. } => reason.clone(),
            Self::NotRegular { found, .. } => format!("it is {found}, not a regular file"),
            Self::TooLarge { bytes, kind, .. } => {
                format!("it has {}, more than the {} that are read", shown_size(*bytes), kind.max_bytes)
            }
            Self::NotText { .. } => "it is not text in UTF-8".to_owned(),
        }
    }
}

/// Reads a whole file.
///
/// # Errors
/// If it is absent, not a regular file, or larger than its kind may be.
pub fn read(path: &Path, kind: &FileKind) -> Result<Vec<u8>, FileError> {
    let shown = || path.display().to_string();
    let refused = |e: io::Error| FileError::Refused { path: shown(), kind: *kind, reason: e.to_string() };
    let too_large = |bytes| FileError::TooLarge { path: shown(), kind: *kind, bytes };
    let regular = |data: &Metadata| match irregular(data) {
        Some(found) => Err(FileError::NotRegular { path: shown(), kind: *kind, found }),
        None => Ok(()),
    };
    regular(&std::fs::metadata(path).map_err(refused)?)?;
    let file = File::open(path).map_err(refused)?;
    let data = file.metadata().map_err(refused)?;
    regular(&data)?;
    if data.len() > kind.max_bytes {
        return Err(too_large(Some(data.len())));
    }
    let mut bytes = Vec::with_capacity(data.len() as usize + 1);
    file.take(kind.max_bytes + 1).read_to_end(&mut bytes).map_err(refused)?;
    if bytes.len() as u64 > kind.max_bytes {
        return Err(too_large(None));
    }
    Ok(bytes)
}

/// By what a file is known to be still the same: another one, or another content, has another stamp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileStamp {
    /// When it was written last, where the file system knows that.
    modified: Option<SystemTime>,
    bytes: u64,
    /// Its number in the file system, which a file that takes its place does not have.
    number: u64,
}

/// The stamp of a file; none of what is not there.
pub fn stamp(path: &Path) -> Option<FileStamp> {
    let data = std::fs::metadata(path).ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&data);
    #[cfg(not(unix))]
    let number = 0;
    Some(FileStamp { modified: data.modified().ok(), bytes: data.len(), number })
}

/// Reads a whole file as text.
///
/// # Errors
/// As [`read`], and where it is not UTF-8.
pub fn read_text(path: &Path, kind: &FileKind) -> Result<String, FileError> {
    let not_text = |_| FileError::NotText { path: path.display().to_string(), kind: *kind };
    String::from_utf8(read(path, kind)?).map_err(not_text)
}

/// What a file is that is not regular, with its article; `None` for a regular one.
pub fn irregular(data: &Metadata) -> Option<&'static str> {
    let kind = data.file_type();
    if kind.is_file() {
        return None;
    }
    if kind.is_dir() {
        return Some("a folder");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("a pipe (FIFO)");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
    }
    Some("not a regular file")
}

fn shown_size(bytes: Option<u64>) -> String {
    bytes.map_or_else(|| "more bytes than it says".to_owned(), |b| format!("{b} bytes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: FileKind = FileKind { name: "a note", max_bytes: 8, cure: "shorten it" };

    /// A folder of the test's own, deleted at its end.
    struct Folder(std::path::PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("toile-file-{name}-{}", std::process::id()));
            std::fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn message(path: &Path) -> String {
        let message = read(path, &SMALL).unwrap_err().to_string();
        assert!(message.starts_with(&format!("{}: ", path.display())) && !message.contains('\n'), "{message}");
        message
    }

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = Folder::new("limit");
        let path = folder.0.join("note");
        std::fs::write(&path, b"12345678").unwrap();
        assert_eq!(read_text(&path, &SMALL).unwrap(), "12345678");
        std::fs::write(&path, b"123456789").unwrap();
        assert!(message(&path).contains("it has 9 bytes, and of a note at most 8 bytes are read; shorten it"));
        std::fs::write(&path, b"\xff").unwrap();
        assert!(read_text(&path, &SMALL).unwrap_err().to_string().contains("UTF-8"));
    }

    #[test]
    fn what_is_not_a_regular_file_is_refused_before_it_is_opened() {
        let folder = Folder::new("irregular");
        assert!(message(&folder.0).contains("it is a folder, not a note; give"));
        assert!(message(&folder.0.join("absent")).contains("cannot be read"));
        #[cfg(unix)]
        {
            let socket = folder.0.join("socket");
            let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
            assert!(message(&socket).contains("a socket"));
            assert!(message(Path::new("/dev/zero")).contains("a device"));
            let fifo = folder.0.join("fifo");
            if std::process::Command::new("mkfifo").arg(&fifo).status().is_ok_and(|s| s.success()) {
                assert!(message(&fifo).contains("a pipe"));
            }
        }
    }

    /// The system says that a file of `/proc` is empty; it is read to its limit all the same.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_that_claims_to_be_empty_is_bounded_too() {
        let status = Path::new("/proc/self/status");
        assert!(message(status).contains("more bytes than it says"));
        assert!(read_text(status, &FileKind { max_bytes: 1 << 16, ..SMALL }).unwrap().contains("Name:"));
    }
}
