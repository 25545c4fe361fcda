//! The table: every case and its result.

use serde::Serialize;

use super::exact::{capstan, incline, weight};
use super::off::off;
use super::order::order;
use super::row::{ContactError, ContactRow};
use super::sheets::{pile, stack};
use super::skin::{poses, skin};
use super::twist::{skirt, twist};
use super::worn::outfits;

/// The table of targets.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactTable {
    /// A row a target.
    pub rows: Vec<ContactRow>,
}

impl ContactTable {
    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let rows = self.rows.iter().map(|r| r.markdown() + "\n").collect::<String>();
        format!("| case | target, at most | got | unit | |\n|---|---|---|---|---|\n{rows}")
    }
}

/// A case of the table.
type Case = fn() -> Result<Vec<ContactRow>, ContactError>;

/// The cases by name; those of whole garments last, because they take longest.
const CASES: [(&str, Case); 12] = [
    ("three sheets on a floor", stack),
    ("sheet on sheet on an incline", incline),
    ("sheet over sheet on a cylinder", capstan),
    ("sheet under a coat", weight),
    ("lost order", order),
    ("twist", twist),
    ("pile over a cylinder", pile),
    ("skirt against itself", skirt),
    ("contact off", off),
    ("skin in place of cones", skin),
    ("skin in four poses", poses),
    ("outfit in layers", outfits),
];

/// Runs the cases whose names contain `only`, all with none; says which is begun.
///
/// # Errors
/// A scene or a garment that cannot be made.
pub fn run(only: Option<&str>, words: &mut dyn FnMut(&str)) -> Result<ContactTable, ContactError> {
    let mut rows = Vec::new();
    for (name, case) in CASES.into_iter().filter(|(name, _)| only.is_none_or(|o| name.contains(o))) {
        words(name);
        rows.extend(case()?);
    }
    Ok(ContactTable { rows })
}
