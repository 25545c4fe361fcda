//! The stock: what every visitor wears first, and a shop's catalogue, as both were read.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use toile_assets::catalogue::{Catalogue, CatalogueItem};
use toile_assets::file::{self, FileStamp};
use toile_fitting::dress::garment_source::GarmentSource;
use toile_fitting::dress::try_on::{RequestedGarment, TryOn};

use super::config::Config;
use crate::error::KioskError;

/// Most files of a catalogue's folder that are looked at: its packages, and as many others.
const MOST_FILES: usize = 4_096;

/// What cannot be used, and why in one sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// The package's or file's name.
    pub name: String,
    /// Why, with the cure.
    pub why: String,
}

impl LeftOut {
    /// A file that cannot be used.
    pub fn new(path: &str, why: &dyn std::fmt::Display) -> Self {
        let name = Path::new(path).file_name().map_or_else(|| path.into(), |name| name.to_string_lossy());
        Self { name: name.into_owned(), why: why.to_string() }
    }
}

/// Files by which a change is noticed, each with its stamp.
pub type FilesSeen = Vec<(PathBuf, Option<FileStamp>)>;

/// What is worn first, and what a shop has, as it was read.
#[derive(Debug, Clone)]
pub struct Stock {
    /// The shop's catalogue, where there is one.
    pub catalogue: Option<Arc<Catalogue>>,
    /// What every visitor wears first, open.
    pub first: Arc<TryOn>,
    /// What cannot be used.
    pub left_out: Vec<LeftOut>,
    /// The files as they were before they were read.
    pub seen: FilesSeen,
    /// Stamps of the files of what is worn first.
    stamps: Vec<Option<FileStamp>>,
}

impl Stock {
    /// Reads what a configuration names.
    ///
    /// # Errors
    /// A catalogue that cannot be read or has nothing to wear, a named garment that cannot be used.
    pub fn read(config: &Config) -> Result<Self, KioskError> {
        StockReader { config, before: None, left_out: Vec::new() }.stock()
    }

    /// Reads it again: what has not changed is taken over. A named garment that cannot be used any more is left out.
    ///
    /// # Errors
    /// A catalogue that cannot be read, or nothing to wear.
    pub fn read_again(&self, config: &Config) -> Result<Self, KioskError> {
        StockReader { config, before: Some(self), left_out: Vec::new() }.stock()
    }

    /// Whether every visitor wears the same first as by another stock, of the same files.
    pub fn wears_the_same(&self, other: &Self) -> bool {
        self.first.garments == other.first.garments && self.stamps == other.stamps
    }

    /// Whether there is anything that can change.
    pub fn is_of_files(&self) -> bool {
        !self.seen.is_empty()
    }
}

/// The files of a stock as they are now: those of the catalogue's folder, and what is named in the configuration, with all
/// that goes by its name.
pub fn look(config: &Config) -> FilesSeen {
    let mut found = Vec::new();
    if let Some(folder) = &config.wear.catalogue {
        // A folder that is not there is not the same as an empty one.
        found.push((folder.clone(), file::stamp(folder)));
        found.extend(files(folder, |_| true));
    }
    for name in &config.wear.garments {
        let path = Path::new(name);
        let (Some(stem), Some(_), Some(folder)) = (path.file_stem(), path.extension(), path.parent()) else { continue };
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let begin = format!("{}.", stem.to_string_lossy());
        found.extend(files(folder, |name| name.starts_with(&begin)));
    }
    found
}

/// The files of a folder that have such names, by name.
fn files(folder: &Path, is_one: impl Fn(&str) -> bool) -> FilesSeen {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let named = entries.filter(|entry| is_one(&entry.file_name().to_string_lossy()));
    let mut paths: Vec<PathBuf> = named.map(|entry| entry.path()).take(MOST_FILES).collect();
    paths.sort();
    let stamped = |path: PathBuf| {
        let stamp = file::stamp(&path);
        (path, stamp)
    };
    paths.into_iter().map(stamped).collect()
}

/// A stock that is being read.
struct StockReader<'a> {
    config: &'a Config,
    before: Option<&'a Stock>,
    left_out: Vec<LeftOut>,
}

impl StockReader<'_> {
    fn stock(mut self) -> Result<Stock, KioskError> {
        let seen = look(self.config);
        let before = self.before.and_then(|before| before.catalogue.as_deref());
        let read = |folder: &PathBuf| Catalogue::read_after(folder, before).map(Arc::new).map_err(KioskError::input);
        let catalogue = self.config.wear.catalogue.as_ref().map(read).transpose()?;
        for refused in catalogue.iter().flat_map(|catalogue| &catalogue.refused) {
            self.left_out.push(LeftOut { name: refused.package.clone(), why: refused.why.clone() });
        }
        let mut sources = self.named(catalogue.as_deref())?;
        if sources.is_empty()
            && let Some(catalogue) = &catalogue
        {
            sources.push(self.first_of(catalogue)?);
        }
        if sources.is_empty() {
            return Err(KioskError::Input("nothing that [wear] garments names can be used; name a garment".into()));
        }
        let stamps = sources.iter().map(|source| file::stamp(Path::new(&source.name))).collect();
        let size = &self.config.wear.size;
        let garments = sources.into_iter().map(|source| RequestedGarment::of(source, size.clone())).collect();
        let first = Arc::new(TryOn { garments, ..self.config.request() });
        Ok(Stock { catalogue, first, left_out: self.left_out, seen, stamps })
    }

    /// What the configuration names, article numbers by their packages; nothing where it leaves that to the catalogue.
    fn named(&mut self, catalogue: Option<&Catalogue>) -> Result<Vec<Arc<GarmentSource>>, KioskError> {
        let request = self.config.request();
        request.check_count()?;
        let mut sources = Vec::new();
        if catalogue.is_some() && !self.config.wear.is_named {
            return Ok(sources);
        }
        for name in request.names() {
            let is_it = |item: &&CatalogueItem| item.manifest.article == name;
            let item = catalogue.and_then(|catalogue| catalogue.items.iter().find(is_it));
            let name = item.map_or(name, |item| item.path.display().to_string());
            match self.open(&name) {
                Ok(source) => sources.push(source),
                Err(why) if self.before.is_some() => self.left_out.push(LeftOut::new(&name, &why)),
                Err(why) => return Err(why),
            }
        }
        Ok(sources)
    }

    /// The first garment of a catalogue that can be worn.
    fn first_of(&mut self, catalogue: &Catalogue) -> Result<Arc<GarmentSource>, KioskError> {
        for item in &catalogue.items {
            let name = item.path.display().to_string();
            match self.open(&name) {
                Ok(source) => return Ok(source),
                Err(why) => self.left_out.push(LeftOut::new(&name, &why)),
            }
        }
        let folder = self.config.wear.catalogue.as_ref().map(|folder| folder.display().to_string()).unwrap_or_default();
        Err(KioskError::Input(format!("{folder}: no garment in it can be used; see toile catalogue check")))
    }

    /// A garment, as it was open before where its file is still the same.
    fn open(&self, name: &str) -> Result<Arc<GarmentSource>, KioskError> {
        let stamp = file::stamp(Path::new(name));
        if let Some(before) = self.before {
            let mut open = before.first.garments.iter().zip(&before.stamps);
            if let Some((garment, _)) = open.find(|(garment, was)| garment.name == name && **was == stamp) {
                return garment.source();
            }
        }
        GarmentSource::find(name).map(Arc::new)
    }
}
