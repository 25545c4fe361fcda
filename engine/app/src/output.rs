//! The output folder: all of a run's files appear complete, or none of them does.
//!
//! A file is written under a temporary name in the folder itself, because only a rename within one file system is
//! atomic. [`OutputFolder::commit`] renames all; dropping the folder before that takes everything back.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder cannot be made or written in.
    #[error("output folder `{path}` cannot be written ({reason}); name another one with `--out DIR`")]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// A file in the folder cannot be written.
    #[error(
        "file `{path}` cannot be written ({reason}); free some space there or name another folder with `--out DIR`"
    )]
    File {
        /// The file under its final name.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// A name that would leave the folder.
    #[error("output file name `{name}` is not a plain file name; use one without a path")]
    Name {
        /// The name.
        name: String,
    },
}

const PART: &str = ".toile-part-";

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
        };
        this.prove().map_err(|reason| OutputError::Folder { path: folder.to_path_buf(), reason })?;
        this.sweep();
        Ok(this)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Promises a file of this name and returns the temporary path to write it to. The extension is kept, as some
    /// writers go by it.
    ///
    /// # Errors
    /// [`OutputError::Name`] for anything but a plain file name.
    pub fn stage(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        let plain = Path::new(name).file_name().is_some_and(|n| n == name);
        if !plain || name.starts_with(PART) {
            return Err(OutputError::Name { name: name.to_owned() });
        }
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
        written.map_err(|reason| OutputError::File { path: self.folder.join(name), reason })
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
            // Renaming onto a folder fails; it is found here, while nothing has been renamed.
            if last.is_dir() {
                return Err(OutputError::File { path: last.clone(), reason: io::ErrorKind::IsADirectory.into() });
            }
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
                // One that cannot be removed is in nobody's way.
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
