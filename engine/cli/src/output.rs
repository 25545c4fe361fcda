//! The output folder: all of a run's files appear complete, or none of them does.
//!
//! A file is written under a temporary name in the folder itself, because only a rename within one file system is
//! atomic. [`OutputFolder::commit`] renames all; dropping the folder before that takes everything back.
//!
//! A rename replaces whatever has the name. So a name that a device, a FIFO, a socket or a folder has is refused, and so
//! is a file that the run reads.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use toile_assets::file::irregular;

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder cannot be made or written in.
    #[error("output folder `{path}` cannot be written ({reason}); name another one with `--out DIR`")]
    Folder {
        /// Path of the output folder.
        path: PathBuf,
        /// Error of the operating system.
        reason: io::Error,
    },
    /// A file in the folder cannot be written.
    #[error(
        "file `{path}` cannot be written ({reason}); free some space there or name another folder with `--out DIR`"
    )]
    File {
        /// The file under its final name.
        path: PathBuf,
        /// Error of the operating system.
        reason: io::Error,
    },
    /// A path that ends in no file name.
    #[error("`--out {path}` names no file; give one such as shopper.mcap")]
    NoFile {
        /// Path that was given.
        path: PathBuf,
    },
    /// What is there is not a regular file.
    #[error("`{path}` is {found}, which is not overwritten; name another file or folder for the output")]
    NotRegular {
        /// The file under its final name.
        path: PathBuf,
        /// What it is, with its article.
        found: &'static str,
    },
    /// What is there is read by the same run.
    #[error("`{path}` is read by this command, and so is not overwritten; name another file or folder for the output")]
    Input {
        /// The file under its final name.
        path: PathBuf,
    },
    /// A name that would leave the folder.
    #[error("output file name `{name}` is not a plain file name; use one without a path")]
    Name {
        /// The file name that was refused.
        name: String,
    },
}

const PART: &str = ".toile-part-";

/// What makes a file one and the same by whatever path: device and inode.
#[cfg(unix)]
type Identity = (u64, u64);
#[cfg(not(unix))]
type Identity = PathBuf;

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).ok().map(|data| (data.dev(), data.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    fs::canonicalize(path).ok()
}

/// Files that a run reads, and folders of such files: none of them may be overwritten.
#[derive(Debug, Clone, Default)]
pub struct Inputs(Vec<Identity>);

impl Inputs {
    /// These files and folders; what is not there is not an input.
    pub fn new<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Self {
        Self(paths.into_iter().filter_map(|path| identity(path.as_ref())).collect())
    }

    /// Refuses a place where writing would lose something: an input, or what is not a regular file, through links too.
    ///
    /// # Errors
    /// [`OutputError::Input`], [`OutputError::NotRegular`].
    pub fn check(&self, path: &Path) -> Result<(), OutputError> {
        let Ok(there) = fs::symlink_metadata(path) else { return Ok(()) };
        let found = if there.is_symlink() {
            fs::metadata(path).map_or(Some("a link to nothing"), |target| irregular(&target))
        } else {
            irregular(&there)
        };
        if let Some(found) = found {
            return Err(OutputError::NotRegular { path: path.to_path_buf(), found });
        }
        let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        let read = whole.ancestors().filter_map(identity).any(|place| self.0.contains(&place));
        if read { Err(OutputError::Input { path: path.to_path_buf() }) } else { Ok(()) }
    }
}

/// One output file, which appears complete or not at all.
#[derive(Debug)]
pub struct OutputFile {
    folder: OutputFolder,
    name: String,
}

impl OutputFile {
    /// Proves that this file can be written, before any work is begun.
    ///
    /// # Errors
    /// [`OutputError`]: a path that names no file, a folder that cannot be written, and a place that
    /// [`Inputs::check`] refuses.
    pub fn prepare(path: &Path, inputs: Inputs) -> Result<Self, OutputError> {
        let name = path.file_name().and_then(|name| name.to_str()).map(str::to_owned);
        let name = name.ok_or_else(|| OutputError::NoFile { path: path.to_path_buf() })?;
        inputs.check(path)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Self { folder: OutputFolder::prepare(folder)?.sparing(inputs), name })
    }

    /// Writes the whole file and returns its path, in a list as reports have it.
    ///
    /// # Errors
    /// [`OutputError`] where it cannot be written.
    pub fn write(mut self, bytes: &[u8]) -> Result<Vec<PathBuf>, OutputError> {
        self.folder.write(&self.name, bytes)?;
        self.folder.commit()
    }
}

/// Files being written; nothing is visible under its own name before [`OutputFolder::commit`].
#[derive(Debug)]
pub struct OutputFolder {
    folder: PathBuf,
    /// The topmost folder that this run has made, so that a failed run can take it back.
    made: Option<PathBuf>,
    /// Temporary and final path of each file, in the order of their making.
    files: Vec<(PathBuf, PathBuf)>,
    /// Their names; a name may be staged again.
    names: BTreeSet<String>,
    /// Input files, which must not be overwritten.
    inputs: Inputs,
}

impl OutputFolder {
    /// Makes the folder if it is missing and proves that it can be written, before any work is begun.
    ///
    /// # Errors
    /// [`OutputError::Folder`].
    pub fn prepare(folder: &Path) -> Result<Self, OutputError> {
        let missing = folder.ancestors().take_while(|p| !p.as_os_str().is_empty() && !p.exists()).last();
        let mut this = Self {
            folder: folder.to_path_buf(),
            made: missing.map(Path::to_path_buf),
            files: Vec::new(),
            names: BTreeSet::new(),
            inputs: Inputs::default(),
        };
        this.prove().map_err(|reason| OutputError::Folder { path: folder.to_path_buf(), reason })?;
        this.sweep();
        Ok(this)
    }

    /// The same, which refuses to overwrite these inputs.
    pub fn sparing(mut self, inputs: Inputs) -> Self {
        self.inputs = inputs;
        self
    }

    /// Refuses these names, before any work is begun, where they could not be written.
    ///
    /// # Errors
    /// What [`Inputs::check`] refuses.
    pub fn check(&self, names: &[&str]) -> Result<(), OutputError> {
        names.iter().try_for_each(|name| self.inputs.check(&self.folder.join(name)))
    }

    /// Promises a file of this name and returns the temporary path to write it to. The extension is kept, as some
    /// writers go by it.
    ///
    /// # Errors
    /// [`OutputError::Name`] for anything but a plain file name; a name that [`Inputs::check`] refuses.
    pub fn stage(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        let plain = Path::new(name).file_name().is_some_and(|n| n == name);
        if !plain || name.starts_with(PART) {
            return Err(OutputError::Name { name: name.to_owned() });
        }
        self.inputs.check(&self.folder.join(name))?;
        let part = self.part(name);
        if self.names.insert(name.to_owned()) {
            self.files.push((part.clone(), self.folder.join(name)));
        }
        Ok(part)
    }

    /// Writes one whole file.
    ///
    /// # Errors
    /// [`OutputError::File`] where it cannot be written, [`OutputError::Name`] for anything but a plain file name.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        let part = self.stage(name)?;
        let written = File::create(&part).and_then(|mut f| f.write_all(bytes));
        written.map_err(|reason| self.failed(name, reason))
    }

    /// That a file of this name cannot be written, in words.
    pub fn failed(&self, name: &str, reason: io::Error) -> OutputError {
        OutputError::File { path: self.folder.join(name), reason }
    }

    /// The files' final paths, in the order of their making.
    pub fn files(&self) -> Vec<PathBuf> {
        self.files.iter().map(|(_, last)| last.clone()).collect()
    }

    /// Gives every file its own name and returns these, in the order of their making.
    ///
    /// # Errors
    /// [`OutputError::File`] where a promised file was not written or cannot be renamed.
    pub fn commit(mut self) -> Result<Vec<PathBuf>, OutputError> {
        // All are looked for before the first is renamed: a promise not kept must not leave half a result.
        for (part, last) in &self.files {
            fs::metadata(part).map_err(|reason| OutputError::File { path: last.clone(), reason })?;
            // Looked at again while nothing has been renamed: it may have come up since.
            self.inputs.check(last)?;
        }
        for (part, last) in &self.files {
            fs::rename(part, last).map_err(|reason| OutputError::File { path: last.clone(), reason })?;
            self.made = None;
        }
        Ok(self.files.drain(..).map(|(_, last)| last).collect())
    }

    fn part(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{PART}{}-{name}", std::process::id()))
    }

    fn prove(&self) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let probe = self.part("probe");
        File::create(&probe)?.write_all(b"toile")?;
        fs::remove_file(&probe)
    }

    /// Removes what a killed run has left here: parts whose process is gone.
    fn sweep(&mut self) {
        if !Path::new("/proc/self").exists() {
            return;
        }
        for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let owner = name.to_str().and_then(|n| n.strip_prefix(PART)).and_then(|n| n.split('-').next());
            if owner.is_some_and(|pid| pid.parse::<u32>().is_ok() && !Path::new("/proc").join(pid).exists()) {
                // One that cannot be removed does no harm.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        for (part, _) in &self.files {
            let _ = fs::remove_file(part);
        }
        let Some(made) = &self.made else { return };
        // Only empty folders go: `remove_dir` refuses the others, and what others wrote there stays.
        for folder in self.folder.ancestors() {
            if fs::remove_dir(folder).is_err() || folder == made {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("toile-output-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        path
    }

    #[test]
    fn committed_files_have_their_names_and_no_part_stays() {
        let folder = scratch("commit").join("deeper");
        let mut out = OutputFolder::prepare(&folder).unwrap();
        out.write("a.txt", b"a").unwrap();
        fs::write(out.stage("b.txt").unwrap(), b"b").unwrap();
        assert!(!folder.join("a.txt").exists(), "nothing is visible before the commit");
        assert_eq!(out.commit().unwrap(), [folder.join("a.txt"), folder.join("b.txt")]);
        let mut left: Vec<_> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["a.txt", "b.txt"]);
        fs::remove_dir_all(scratch("commit")).unwrap_or_default();
    }

    #[test]
    fn a_dropped_run_leaves_nothing_and_keeps_what_was_there() {
        let made = scratch("drop");
        let mut out = OutputFolder::prepare(&made.join("deeper")).unwrap();
        out.write("a.txt", b"a").unwrap();
        drop(out);
        assert!(!made.exists(), "folders made for the run go with it");

        fs::create_dir_all(&made).unwrap();
        fs::write(made.join("a.txt"), b"old").unwrap();
        let mut out = OutputFolder::prepare(&made).unwrap();
        out.write("a.txt", b"new").unwrap();
        drop(out);
        assert_eq!(fs::read(made.join("a.txt")).unwrap(), b"old");
        assert_eq!(fs::read_dir(&made).unwrap().count(), 1);
        fs::remove_dir_all(&made).unwrap();
    }

    #[test]
    fn a_promise_not_kept_commits_nothing() {
        let folder = scratch("promise");
        let mut out = OutputFolder::prepare(&folder).unwrap();
        out.write("a.txt", b"a").unwrap();
        out.stage("never-written.txt").unwrap();
        assert!(matches!(out.commit(), Err(OutputError::File { .. })));
        assert!(!folder.exists());
    }

    #[test]
    fn a_folder_below_a_file_and_a_name_with_a_path_are_refused() {
        let file = scratch("file");
        fs::write(&file, b"x").unwrap();
        assert!(matches!(OutputFolder::prepare(&file.join("out")), Err(OutputError::Folder { .. })));
        assert!(matches!(OutputFolder::prepare(&file), Err(OutputError::Folder { .. })));
        fs::remove_file(&file).unwrap();
        let folder = scratch("name");
        let mut out = OutputFolder::prepare(&folder).unwrap();
        for name in ["../up.txt", "", "a/b", ".."] {
            assert!(matches!(out.stage(name), Err(OutputError::Name { .. })), "{name}");
        }
    }

    #[test]
    fn an_input_is_not_overwritten_by_any_name() {
        let folder = scratch("input");
        fs::create_dir_all(folder.join("frames")).unwrap();
        let (input, frame) = (folder.join("in.mcap"), folder.join("frames/0.png"));
        fs::write(&input, b"kept").unwrap();
        fs::write(&frame, b"kept").unwrap();
        let inputs = || Inputs::new([input.clone(), folder.join("frames"), folder.join("absent")]);
        let refused = |path: PathBuf| match OutputFile::prepare(&path, inputs()) {
            Err(OutputError::Input { .. }) => {}
            other => panic!("{}: {other:?}", path.display()),
        };
        refused(input.clone());
        refused(folder.join("frames/../in.mcap"));
        refused(frame);
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&input, folder.join("link.mcap")).unwrap();
            fs::hard_link(&input, folder.join("second.mcap")).unwrap();
            refused(folder.join("link.mcap"));
            refused(folder.join("second.mcap"));
        }
        OutputFile::prepare(&folder.join("frames/new.mcap"), inputs()).unwrap().write(b"new").unwrap();
        OutputFile::prepare(&folder.join("other.mcap"), inputs()).unwrap().write(b"new").unwrap();
        assert_eq!(fs::read(&input).unwrap(), b"kept");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_no_regular_file_is_not_overwritten() {
        let folder = scratch("irregular");
        fs::create_dir_all(folder.join("a.png")).unwrap();
        let mut out = OutputFolder::prepare(&folder).unwrap();
        assert!(matches!(out.write("a.png", b"x"), Err(OutputError::NotRegular { found: "a folder", .. })));
        #[cfg(unix)]
        {
            let socket = std::os::unix::net::UnixListener::bind(folder.join("b.png")).unwrap();
            assert!(matches!(out.write("b.png", b"x"), Err(OutputError::NotRegular { found: "a socket", .. })));
            drop(socket);
            for (name, target) in [("c.png", "/dev/null"), ("d.png", "nothing")] {
                std::os::unix::fs::symlink(target, folder.join(name)).unwrap();
                assert!(matches!(out.write(name, b"x"), Err(OutputError::NotRegular { .. })), "{target}");
            }
            assert!(Inputs::default().check(Path::new("/dev/null")).is_err());
        }
        assert!(matches!(OutputFile::prepare(Path::new(".."), Inputs::default()), Err(OutputError::NoFile { .. })));
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn parts_of_a_killed_run_are_swept() {
        let folder = scratch("sweep");
        fs::create_dir_all(&folder).unwrap();
        // Above the kernel's largest process number, so never alive.
        let stale = folder.join(format!("{PART}99999999-a.png"));
        fs::write(&stale, b"half").unwrap();
        drop(OutputFolder::prepare(&folder).unwrap());
        assert_eq!(stale.exists(), !Path::new("/proc/self").exists());
        fs::remove_dir_all(&folder).unwrap();
    }
}
