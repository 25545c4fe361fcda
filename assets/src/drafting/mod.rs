//! Drafting: our own sewn patterns, drawn for a size's body after the usual block drafts.

mod block;
mod bodice;
mod collar;
mod dart;
mod dress;
mod garment;
mod panel;
mod poncho;
mod scarf;
mod skirt;
mod sleeve;
mod styles;
mod text;
mod tops;
mod trims;
mod trousers;
mod waistband;

pub use block::DraftBlock;
pub use garment::DraftGarment;
pub use styles::{DraftStyle, STYLES};

use crate::draping::{PatternPackage, PatternSizes, SizeGirths, SizedDraft};
use crate::sizes::{Population, SizeError, SizeTable};
use thiserror::Error;
use toile_base::body::Sex;

/// Names of the garments that are drafted here.
pub fn names() -> Vec<&'static str> {
    STYLES.iter().map(|style| style.name).collect()
}

/// Garments of earlier versions, and those that took their places.
const SUCCESSORS: [(&str, &str); 4] =
    [("sun-dress", "strap-dress"), ("t-shirt", "tee"), ("wide-trousers", "wide-leg-trousers"), ("jacket", "blazer")];

/// Why no garment of the wardrobe has a name.
#[derive(Debug, Error)]
pub enum WardrobeError {
    /// A garment of an earlier version.
    #[error("the garment {name} is no longer built in; ask for {successor}, which took its place")]
    Replaced {
        /// The name asked for.
        name: String,
        /// The garment that took its place.
        successor: &'static str,
    },
    /// No such garment.
    #[error("there is no garment named {name}; choose one of {known}, or give the path of an OBJ file")]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A size table that cannot be used.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// A garment that is drafted here, in all of its sizes.
///
/// # Errors
/// A name that no garment has.
pub fn package(name: &str) -> Result<PatternPackage, WardrobeError> {
    Ok(named(name)?.package()?)
}

/// A garment that is drafted here, by its name.
///
/// # Errors
/// A name that no garment has, with the garment that took the place of one of an earlier version.
pub fn named(name: &str) -> Result<&'static DraftStyle, WardrobeError> {
    let successor = SUCCESSORS.iter().find(|(old, _)| *old == name).map(|(_, new)| *new);
    style(name).ok_or_else(|| match successor {
        Some(successor) => WardrobeError::Replaced { name: name.into(), successor },
        None => WardrobeError::Unknown { name: name.into(), known: names().join(", ") },
    })
}

/// A garment that is drafted here, by its name.
pub fn style(name: &str) -> Option<&'static DraftStyle> {
    STYLES.iter().find(|style| style.name == name)
}

impl DraftStyle {
    /// Its name as words: `Men's tee` for `mens-tee`.
    pub fn title(&self) -> String {
        let words = self.name.replace("mens-", "men's ").replace('-', " ");
        let mut letters = words.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }

    /// The draft for a size of a table.
    ///
    /// # Errors
    /// A size that there is not.
    pub fn draft(&self, table: &SizeTable, size: &str) -> Result<DraftGarment, SizeError> {
        let sex = if table.population == Population::Men { Sex::Male } else { Sex::Female };
        Ok((self.draw)(&DraftBlock::new(sex, &table.size_body(size)?)))
    }

    /// The garment in all of its sizes.
    ///
    /// # Errors
    /// A table or size that there is not.
    pub fn package(&self) -> Result<PatternPackage, SizeError> {
        let table = SizeTable::embedded(self.table)?;
        let [small, middle, large] = self.sizes;
        let text = |size| Ok::<_, SizeError>(text::garment_code(&self.draft(&table, size)?));
        let drafts = [small, large].map(|size| Ok(SizedDraft { size: size.into(), pattern: text(size)?, seams: None }));
        let drafts = drafts.into_iter().collect::<Result<_, SizeError>>()?;
        let girths = self.girths(&table)?;
        let sizes = PatternSizes { table: self.table.into(), kind: self.kind, size: middle.into(), drafts, girths };
        let mut package = PatternPackage::new(self.name.into(), text(middle)?);
        package.spacing_mm = self.spacing_mm;
        package.fabric = self.fabric.into();
        package.layer = Some(self.layer);
        package.sizes = Some(sizes);
        Ok(package)
    }

    /// Finished girths of every size that is made, by the draft's own rules.
    fn girths(&self, table: &SizeTable) -> Result<Vec<SizeGirths>, SizeError> {
        let one = |code: &str| {
            let [chest_mm, waist_mm, hip_mm] =
                self.draft(table, code)?.girths.map(|girth| girth.map(|m| (m * 1e3).round()));
            Ok(SizeGirths { size: code.into(), chest_mm, waist_mm, hip_mm })
        };
        let [small, _, large] = self.sizes;
        let codes = table.codes();
        let place = |size: &str| codes.iter().position(|code| *code == size);
        let made = place(small).unwrap_or(0)..=place(large).unwrap_or(codes.len() - 1);
        codes[made].iter().map(|code| one(code)).collect()
    }
}

#[cfg(test)]
mod tests;
