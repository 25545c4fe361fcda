//! Rows gathered: the facts of each person in each garment.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{Result, StudyError};
use crate::garments::GarmentNote;
use crate::parquet_file::{self, Notes};
use crate::row::StudyRow;

/// The measures by which zones are named, in the order in which girths are kept.
pub(super) const ZONES: [&str; 3] = ["chest", "waist", "hip"];

/// A person in a garment.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Wearer {
    pub person: i64,
    pub weight: f64,
    pub stature: f64,
    /// True chest, waist and hip (mm).
    pub girths: [f64; 3],
    /// Sizes as indices into those that are made.
    pub best: Option<usize>,
    pub seen: Option<usize>,
    pub by_table: Option<usize>,
    /// Sizes that were draped, with whether anything pulls in any pose.
    pub draped: BTreeMap<usize, bool>,
}

impl Wearer {
    /// The smallest size that was draped in which nothing pulls.
    pub fn by_physics(&self) -> Option<usize> {
        self.draped.iter().find(|(_, pulls)| !**pulls).map(|(size, _)| *size)
    }
}

/// All of one garment.
#[derive(Debug, Clone)]
pub(super) struct Wearers {
    pub note: GarmentNote,
    pub all: Vec<Wearer>,
    /// Ease by girths and worn, where both are known, of sizes that were draped while standing (mm) `[zones]`.
    pub eases: [Vec<[f64; 2]>; 3],
    pub strain_p99: Vec<f64>,
    /// Mean and 99th percentile of what had not settled (mm), and the change of the ease.
    pub unsettled: Vec<[f64; 3]>,
    /// Of those who were compared: rows, and those in which other zones pull once all has settled.
    pub compared: [u64; 2],
    pub troubles: Vec<String>,
    pub draped_rows: u64,
}

/// Reads the file of a study.
pub(super) fn read(path: &Path) -> Result<(Notes, Vec<Wearers>)> {
    // The notes say what the garments are; they come first, without any row.
    let notes = parquet_file::notes(path)?;
    let text = note(&notes, "toile.garments")?;
    let garments: Vec<GarmentNote> = serde_json::from_str(text).map_err(StudyError::input)?;
    let mut found: Vec<Wearers> = garments.into_iter().map(Wearers::of_note).collect();
    parquet_file::read(path, |row| {
        if let Some(wearers) = found.iter_mut().find(|w| w.note.name == row.garment) {
            wearers.add(&row);
        }
        Ok(())
    })?;
    Ok((notes, found))
}

/// A note of a file by its name.
pub(super) fn note<'n>(notes: &'n Notes, name: &str) -> Result<&'n str> {
    let found = notes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str());
    found.ok_or_else(|| {
        StudyError::Input(format!("the file of rows has no note {name}; make it again by `toile study`"))
    })
}

impl Wearers {
    /// A garment that no person has tried on yet.
    pub fn of_note(note: GarmentNote) -> Self {
        Self {
            note,
            all: Vec::new(),
            eases: Default::default(),
            strain_p99: Vec::new(),
            unsettled: Vec::new(),
            compared: [0; 2],
            troubles: Vec::new(),
            draped_rows: 0,
        }
    }

    fn add(&mut self, row: &StudyRow) {
        if !row.offered {
            return;
        }
        let index =
            |size: Option<&String>| size.and_then(|code| self.note.sizes.iter().position(|(made, _)| made == code));
        if self.all.last().is_none_or(|last| last.person != row.person) {
            self.all.push(Wearer {
                person: row.person,
                weight: row.weight,
                stature: row.stature_mm,
                girths: [row.chest_mm, row.waist_mm, row.hip_mm],
                best: index(row.best_size.as_ref()),
                seen: index(row.seen_size.as_ref()),
                by_table: index(row.table_size.as_ref()),
                draped: BTreeMap::new(),
            });
        }
        self.troubles.extend(row.trouble.clone());
        let size = index(Some(&row.size));
        let (Some(size), Some(wearer), true) = (size, self.all.last_mut(), row.draped) else { return };
        self.draped_rows += 1;
        *wearer.draped.entry(size).or_default() |= row.pulls.as_deref().is_some_and(|pulls| !pulls.is_empty());
        self.strain_p99.extend(row.strain_p99);
        if let (Some(mean), Some(p99)) = (row.unsettled_mean_mm, row.unsettled_p99_mm) {
            self.unsettled.push([mean, p99, row.unsettled_ease_mm.unwrap_or(0.0)]);
            self.compared[0] += 1;
            self.compared[1] += u64::from(row.pulls != row.settled_pulls);
        }
        if row.pose == "standing" {
            let girths = [row.chest_ease_mm, row.waist_ease_mm, row.hip_ease_mm];
            let worn = [row.chest_worn_ease_mm, row.waist_worn_ease_mm, row.hip_worn_ease_mm];
            for (all, pair) in self.eases.iter_mut().zip(girths.into_iter().zip(worn)) {
                if let (Some(girth), Some(worn)) = pair {
                    all.push([girth, worn]);
                }
            }
        }
    }
}
