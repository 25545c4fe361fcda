//! Where the files that a scene names come from: its own folder, or the program itself.

use std::path::Path;

/// Largest file that a scene may name (bytes): a track of a day takes 200 MB.
const MAX_BYTES: u64 = 512 << 20;

/// A place of files.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// A folder; names are relative to it, absolute ones are taken as they are.
    Folder(&'a Path),
    /// Files inside the program: name and content.
    Inside(&'static [(&'static str, &'static str)]),
}

impl Source<'_> {
    /// A file's bytes. The error says where it was looked for.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        match self {
            Self::Folder(folder) => {
                let path = folder.join(name);
                let failed = |e: std::io::Error| format!("{e} (looked for at {})", shown(&path).display());
                let info = std::fs::metadata(&path).map_err(failed)?;
                if info.is_dir() {
                    return Err(format!("{} is a folder", shown(&path).display()));
                }
                if info.len() > MAX_BYTES {
                    return Err(format!("it has {} bytes, more than the {MAX_BYTES} that are read", info.len()));
                }
                std::fs::read(&path).map_err(failed)
            }
            Self::Inside(files) => {
                let file = files.iter().find(|(known, _)| *known == name);
                file.map(|(_, text)| text.as_bytes().to_vec()).ok_or_else(|| "no such file in the program".into())
            }
        }
    }

    /// A file's text.
    pub fn text(&self, name: &str) -> Result<String, String> {
        String::from_utf8(self.read(name)?).map_err(|_| "it is not text in UTF-8".into())
    }
}

/// The path in full, so that a user sees the folder too.
fn shown(path: &Path) -> std::path::PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}
