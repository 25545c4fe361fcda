//! Source of the files that a scene names: its own folder, or the program itself.

use std::path::Path;

use crate::file::{self, FileKind};

/// A file that a scene names: a track of a day takes 200 MB.
const NAMED_FILE: FileKind =
    FileKind { name: "a file that a scene names", max_bytes: 512 << 20, cure: "give a smaller one" };

/// A place of files.
#[derive(Debug, Clone, Copy)]
pub enum SceneSource<'a> {
    /// A folder; names are relative to it, absolute ones are taken as they are.
    Folder(&'a Path),
    /// Files inside the program: name and content.
    Inside(&'static [(&'static str, &'static str)]),
    /// Files in memory, by the names that the scene has for them.
    Memory(&'a [(String, Vec<u8>)]),
}

impl SceneSource<'_> {
    /// A file's bytes. The error says where it was looked for.
    pub fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        match self {
            Self::Folder(folder) => {
                let path = folder.join(name);
                file::read(&path, &NAMED_FILE).map_err(|e| {
                    // The path in full, so that a user sees the folder too.
                    let full = std::path::absolute(&path).unwrap_or(path);
                    format!("{} (looked for at {})", e.reason(), full.display())
                })
            }
            Self::Inside(files) => {
                let file = files.iter().find(|(known, _)| *known == name);
                file.map(|(_, text)| text.as_bytes().to_vec()).ok_or_else(|| "no such file in the program".into())
            }
            Self::Memory(files) => {
                let file = files.iter().find(|(known, _)| known == name);
                file.map(|(_, bytes)| bytes.clone()).ok_or_else(|| {
                    let given: Vec<&str> = files.iter().map(|(known, _)| known.as_str()).collect();
                    let given = if given.is_empty() { "none".to_owned() } else { given.join(", ") };
                    format!("no file of this name was given along with the scene (given: {given})")
                })
            }
        }
    }

    /// A file's text.
    pub fn text(&self, name: &str) -> Result<String, String> {
        String::from_utf8(self.read(name)?).map_err(|_| "it is not text in UTF-8".into())
    }
}
