//! A garment package: one file, a zip archive that holds `garment.toml` and what it names.

use std::borrow::Cow;
use std::fs;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::error::CatalogueError;
use super::limits::{MAX_FILES, MAX_PACKAGE_BYTES, MAX_PICTURE_PIXELS, MAX_PIXELS, MAX_TOML_BYTES, MAX_UNPACKED_BYTES};
use super::manifest::GarmentManifest;
use super::picture;
use crate::adapt::source;
use crate::file::{self, FileKind};

/// How packages are recognised.
pub const ENDING: &str = ".toile";

/// The manifest's name within a package.
const MANIFEST: &str = "garment.toml";

/// Limits of a manifest file.
const MANIFEST_FILE: FileKind =
    FileKind { name: "a garment's manifest", max_bytes: MAX_TOML_BYTES, cure: "see docs/catalogue.md" };

/// Limits of a package file.
const PACKAGE: FileKind =
    FileKind { name: "a garment package", max_bytes: MAX_PACKAGE_BYTES, cure: "make its photographs smaller" };

/// A package that is open: its bytes, and what is where in them.
pub struct GarmentPackage {
    name: String,
    archive: ZipArchive<Cursor<Vec<u8>>>,
}

impl GarmentPackage {
    /// Opens a package, and looks at the names and sizes of its files.
    ///
    /// # Errors
    /// A file that cannot be read or is no package, names that are none, too many files or too large ones.
    pub fn open(path: &Path) -> Result<Self, CatalogueError> {
        Self::of_bytes(&path.display().to_string(), file::read(path, &PACKAGE)?)
    }

    /// The same from its bytes; `name` stands in error messages.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn of_bytes(name: &str, bytes: Vec<u8>) -> Result<Self, CatalogueError> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| garbled(name, &e))?;
        let mut open = Self { name: name.to_owned(), archive };
        if open.archive.len() > MAX_FILES {
            let reason = format!("it has {} files, more than {MAX_FILES}; leave some out", open.archive.len());
            return Err(open.content("its files", reason));
        }
        let names = open.names()?;
        if let Some(bad) = names.iter().find(|name| !is_plain(name)) {
            let shown: String = bad.chars().take(80).filter(|c| !c.is_control()).collect();
            return Err(open.content(&shown, "its name is no plain file name; pack files without folders".into()));
        }
        let mut unpacked: u64 = 0;
        for i in 0..open.archive.len() {
            let entry = open.archive.by_index_raw(i);
            let entry = entry.map_err(|e| garbled(name, &e))?;
            unpacked = unpacked.saturating_add(entry.size());
        }
        if unpacked > MAX_UNPACKED_BYTES {
            let reason = format!("they unpack to {unpacked} bytes, more than {MAX_UNPACKED_BYTES}; make them smaller");
            return Err(open.content("its files", reason));
        }
        Ok(open)
    }

    /// What the shop says of the garment; every file that it names is there, and photographs are pictures of a size that
    /// can be shown.
    ///
    /// # Errors
    /// A manifest that is missing or wrong, a file that is.
    pub fn manifest(&mut self) -> Result<GarmentManifest, CatalogueError> {
        let text = self.text(MANIFEST, MAX_TOML_BYTES)?;
        let manifest = GarmentManifest::parse(&text).map_err(|reason| self.content(MANIFEST, reason))?;
        let missing = manifest.files().find(|file| self.archive.index_for_name(file).is_none());
        if let Some(missing) = missing {
            return Err(self.content(missing, "it is named in garment.toml and not in the package; add it".into()));
        }
        let laid_on = manifest.image.iter().flat_map(|image| image.files());
        for photograph in manifest.photographs.iter().map(String::as_str).chain(laid_on) {
            self.check_picture(photograph)?;
        }
        Ok(manifest)
    }

    /// The bytes of one of its files, at most so many.
    ///
    /// # Errors
    /// A file that is not there, is garbled, or unpacks to more.
    pub fn bytes(&mut self, file: &str, most: u64) -> Result<Vec<u8>, CatalogueError> {
        let wrong = |reason: String| CatalogueError::Content { package: self.name.clone(), file: file.into(), reason };
        let entry = self.archive.by_name(file).map_err(|e| wrong(format!("{e}; pack the garment again")))?;
        let mut bytes = Vec::new();
        entry.take(most + 1).read_to_end(&mut bytes).map_err(|e| wrong(format!("{e}; pack the garment again")))?;
        if bytes.len() as u64 > most {
            return Err(wrong(format!("it unpacks to more than {most} bytes; make it smaller")));
        }
        Ok(bytes)
    }

    /// The text of one of its files.
    ///
    /// # Errors
    /// As [`Self::bytes`]; what is no text in UTF-8.
    pub fn text(&mut self, file: &str, most: u64) -> Result<String, CatalogueError> {
        let bytes = self.bytes(file, most)?;
        String::from_utf8(bytes).map_err(|_| self.content(file, "it is not text in UTF-8; save it as UTF-8".into()))
    }

    /// Unpacks all files into a folder of its own, which is removed when it is dropped.
    ///
    /// # Errors
    /// A file that is garbled, a folder that cannot be written.
    pub fn unpack(&mut self) -> Result<UnpackedFolder, CatalogueError> {
        let folder = UnpackedFolder::new().map_err(|e| self.content("a folder for temporary files", e))?;
        // What is said of sizes may be a lie: all files together have so much room.
        let mut room = MAX_UNPACKED_BYTES;
        for name in self.names()? {
            let bytes = self.bytes(&name, room)?;
            room -= bytes.len() as u64;
            let written = fs::write(folder.path.join(&name), bytes);
            written.map_err(|e| self.content(&name, format!("it cannot be unpacked ({e}); make room")))?;
        }
        Ok(folder)
    }

    fn names(&self) -> Result<Vec<String>, CatalogueError> {
        let name = |name: Result<Cow<'_, str>, ZipError>| name.map(Cow::into_owned);
        self.archive.file_names().map(name).collect::<Result<_, _>>().map_err(|e| garbled(&self.name, &e))
    }

    fn check_picture(&mut self, file: &str) -> Result<(), CatalogueError> {
        let bytes = self.bytes(file, MAX_PACKAGE_BYTES)?;
        let [width, height] = picture::size(&bytes).map_err(|e| self.content(file, e))?;
        if width.max(height) > MAX_PIXELS {
            let reason =
                format!("it has {width} x {height} pixels, and {MAX_PIXELS} are shown at most; make it smaller");
            return Err(self.content(file, reason));
        }
        let pixels = width as u64 * height as u64;
        if pixels > MAX_PICTURE_PIXELS {
            let reason =
                format!("it has {pixels} pixels, and a photograph has {MAX_PICTURE_PIXELS} at most; make it smaller");
            return Err(self.content(file, reason));
        }
        Ok(())
    }

    /// An error in one of its files.
    pub fn content(&self, file: &str, reason: String) -> CatalogueError {
        CatalogueError::Content { package: self.name.clone(), file: file.into(), reason }
    }
}

/// Packs a folder's `garment.toml` and the files that it names; returns the package's bytes and its manifest.
///
/// # Errors
/// A manifest that is wrong, a file that is missing or too large, names that are none.
pub fn pack(folder: &Path) -> Result<(Vec<u8>, GarmentManifest), CatalogueError> {
    let shown = folder.display().to_string();
    let text = file::read_text(&folder.join(MANIFEST), &MANIFEST_FILE)?;
    let wrong =
        |file: &str, reason: String| CatalogueError::Content { package: shown.clone(), file: file.into(), reason };
    let manifest = GarmentManifest::parse(&text).map_err(|reason| wrong(MANIFEST, reason))?;
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let mut add = |name: &str, bytes: &[u8]| {
        let unwritten = |e: &dyn std::fmt::Display| wrong(name, format!("it cannot be packed ({e}); check the file"));
        zip.start_file(name, options).map_err(|e| unwritten(&e))?;
        zip.write_all(bytes).map_err(|e| unwritten(&e))
    };
    add(MANIFEST, text.as_bytes())?;
    // A mesh comes with its materials, measures and the body of a MakeHuman garment under the same name.
    let pictures = || source::material_files(&folder.join(&manifest.garment));
    let there = |name: &String| folder.join(name).is_file();
    let beside = manifest.is_mesh().then(|| siblings(folder, &manifest.garment).into_iter().chain(pictures()));
    let beside = beside.into_iter().flatten().filter(there);
    let beside = beside.chain(printed(folder, &manifest));
    let mut packed = vec![MANIFEST.to_owned()];
    for name in manifest.files().map(str::to_owned).chain(beside) {
        if packed.contains(&name) {
            continue;
        }
        let bytes = if is_plain(&name) {
            file::read(&folder.join(&name), &PACKAGE)?
        } else {
            return Err(wrong(&name, "its name is no plain file name; rename it".into()));
        };
        add(&name, &bytes)?;
        packed.push(name);
    }
    let bytes = zip.finish().map_err(|e| garbled(&shown, &e))?.into_inner();
    GarmentPackage::of_bytes(&shown, bytes.clone())?.manifest()?;
    Ok((bytes, manifest))
}

/// The picture that the fabric of a garment is printed with, if it names one.
fn printed(folder: &Path, manifest: &GarmentManifest) -> Option<String> {
    let file = manifest.fabric.as_deref().filter(|name| name.ends_with(".toml"))?;
    let text = file::read_text(&folder.join(file), &MANIFEST_FILE).ok()?;
    crate::fabric::parse(file, &text).ok()?.print?.picture
}

/// The files of a folder that go by a mesh's name with another ending.
fn siblings(folder: &Path, mesh: &str) -> Vec<String> {
    let stem = Path::new(mesh).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| name.strip_prefix(&stem).is_some_and(|rest| rest.starts_with('.')));
    names.sort();
    names
}

fn garbled(package: &str, error: &ZipError) -> CatalogueError {
    CatalogueError::Archive { package: package.to_owned(), reason: error.to_string() }
}

/// Whether a name is that of a file, and no path: letters, digits, and a few signs.
pub(super) fn is_plain(name: &str) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || " ._-+()".contains(c);
    !name.is_empty() && name.len() <= 120 && !name.starts_with('.') && name.chars().all(allowed)
}

/// A folder of unpacked files, removed when it is dropped.
pub struct UnpackedFolder {
    /// Its path.
    pub path: PathBuf,
}

impl UnpackedFolder {
    fn new() -> Result<Self, String> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let mut last = String::new();
        // A folder of a process of the same number may have been left behind.
        for _ in 0..16 {
            let name = format!("toile-package-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
            let path = std::env::temp_dir().join(name);
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self { path }),
                Err(e) => last = format!("{} cannot be made ({e}); set TMPDIR", path.display()),
            }
        }
        Err(last)
    }
}

impl Drop for UnpackedFolder {
    fn drop(&mut self) {
        // What cannot be removed is the system's temporary folder's to clear.
        _ = fs::remove_dir_all(&self.path);
    }
}
