//! Photographs of garments: read on a thread of their own when a page shows them, and kept in a cache of fixed size, which drops the
//! least recently shown one first.

use std::path::Path;
use std::sync::Arc;

use toile_assets::catalogue::limits::MAX_PACKAGE_BYTES;
use toile_assets::catalogue::{GarmentPackage, Picture};
use toile_assets::file::{self, FileStamp};
use toile_fitting::live::background::{BackgroundJob, Finished};

use super::screen::{Action, Screen, ScreenPicture};
use super::wardrobe::{Wardrobe, WardrobeItem};
use crate::service::stock::LeftOut;

/// Pixels along the longer side of a photograph as it is kept: what a tile has on a display of 4K.
pub const PHOTOGRAPH_SIDE: u32 = 384;

/// Most bytes of all photographs that are kept: more than forty.
pub const PHOTOGRAPH_BYTES: usize = 20 << 20;

/// Bytes that a photograph is counted with beside its pixels, so that those that cannot be read are bounded too.
const ENTRY_BYTES: usize = 4 << 10;

/// By what a photograph is known: its package, and that as it was read.
type Key = (String, Option<FileStamp>);

/// A photograph that was read; none where it cannot be.
struct Photograph {
    key: Key,
    picture: Option<ScreenPicture>,
}

impl Photograph {
    fn bytes(&self) -> usize {
        ENTRY_BYTES + self.picture.as_ref().map_or(0, |picture| picture.0.bytes())
    }
}

/// The photographs of a wardrobe's garments.
#[derive(Default)]
pub struct Photographs {
    /// The one that was seen last comes last.
    kept: Vec<Photograph>,
    job: BackgroundJob<(Key, Result<Picture, String>)>,
}

impl Photographs {
    /// Gives a screen the photographs of its garments that are there, and reads one of those that are not; returns why one cannot be
    /// read, once.
    pub fn show(&mut self, screen: &mut Screen, wardrobe: &Wardrobe) -> Option<LeftOut> {
        let failed = self.take();
        let mut wanted = None;
        for control in &mut screen.controls {
            let Action::Garment(place) = control.action else { continue };
            let Some(item) = wardrobe.items.get(place).filter(|item| item.photograph.is_some()) else { continue };
            match self.find(item) {
                Some(picture) => control.picture = picture,
                None => wanted = wanted.or(Some(item)),
            }
        }
        if let Some(item) = wanted
            && !self.job.is_running()
        {
            self.read(item);
        }
        failed
    }

    /// Bytes of all that is kept.
    pub fn bytes(&self) -> usize {
        self.kept.iter().map(Photograph::bytes).sum()
    }

    /// The photograph of a garment, where it was read: from now on it is the one that was seen last.
    fn find(&mut self, item: &WardrobeItem) -> Option<Option<ScreenPicture>> {
        let is_it = |kept: &Photograph| kept.key.0 == item.name && kept.key.1 == item.stamp;
        let place = self.kept.iter().position(is_it)?;
        let found = self.kept.remove(place);
        let picture = found.picture.clone();
        self.kept.push(found);
        Some(picture)
    }

    fn read(&mut self, item: &WardrobeItem) {
        let (key, file) = ((item.name.clone(), item.stamp), item.photograph.clone().unwrap_or_default());
        // Where the system gives no thread now, it may with the next screen.
        _ = self.job.start("toile-photograph", move || {
            let picture = picture(&key, &file);
            (key, picture)
        });
    }

    /// Takes what was read, and lets go of what was not seen for longest.
    fn take(&mut self) -> Option<LeftOut> {
        let (key, read) = match self.job.poll()? {
            Finished::Done { value, .. } => value,
            Finished::Panicked => return None,
        };
        let failed = read.as_ref().err().map(|why| LeftOut::new(&key.0, why));
        let picture = read.ok().map(|picture| ScreenPicture(Arc::new(picture)));
        self.kept.push(Photograph { key, picture });
        while self.bytes() > PHOTOGRAPH_BYTES {
            self.kept.remove(0);
        }
        failed
    }
}

/// A package's photograph, if the package is still the one that hangs.
fn picture((package, stamp): &Key, file: &str) -> Result<Picture, String> {
    let mut open = GarmentPackage::open(Path::new(package)).map_err(|e| e.to_string())?;
    let bytes = open.bytes(file, MAX_PACKAGE_BYTES).map_err(|e| e.to_string())?;
    if *stamp != file::stamp(Path::new(package)) {
        return Err(format!("{package}: it was changed since it hangs; it hangs anew soon"));
    }
    Picture::decode(&bytes, PHOTOGRAPH_SIDE).map_err(|why| format!("{package}: {file}: {why}"))
}
