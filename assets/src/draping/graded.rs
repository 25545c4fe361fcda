//! A pattern in all of its sizes: as drafted for some, graded between them.

use super::package::{PackageError, PatternPackage};
use super::pattern_sizes::{SizedDraft, TO_MEASURE};
use crate::import::pattern;
use crate::pattern::Pattern;
use crate::sizes::{GarmentKind, Girth, Size, SizeTable};
use toile_base::body::Measures;

/// A draft, the girth that it is for (m), and its size.
#[derive(Debug, Clone)]
struct Graded {
    girth: f64,
    size: String,
    pattern: Pattern,
}

/// A pattern in sizes: the drafts from the smallest up, and between two of them what lies between.
#[derive(Debug, Clone)]
pub struct GradedPattern {
    /// The table of its sizes.
    pub table: SizeTable,
    /// The kind of garment.
    pub kind: GarmentKind,
    /// The girth by which it is graded.
    pub girth: Girth,
    drafts: Vec<Graded>,
}

impl PatternPackage {
    /// The pattern in its sizes; none for a draft without sizes.
    ///
    /// # Errors
    /// A draft that cannot be read, a size or kind that the table does not have.
    pub fn graded(&self) -> Result<Option<GradedPattern>, PackageError> {
        let Some(sizes) = &self.sizes else { return Ok(None) };
        let table = SizeTable::embedded(&sizes.table)?;
        let named = |reason| PackageError::Content { file: self.name.clone(), reason };
        let girth = table
            .designation(sizes.kind)
            .and_then(|d| d.primary.first().copied())
            .ok_or_else(|| named(format!("the size table {} designates no {}", table.name, sizes.kind.name())))?;
        let mut drafts = vec![Graded { girth: 0.0, size: sizes.size.clone(), pattern: self.parse()? }];
        for SizedDraft { size, pattern, seams } in &sizes.drafts {
            let names = [format!("{} for {size}", self.name), format!("the seams of {} for {size}", self.name)];
            let pattern = pattern::parse(&names[0], pattern, seams.as_deref().map(|text| (names[1].as_str(), text)))?;
            drafts.push(Graded { girth: 0.0, size: size.clone(), pattern });
        }
        for draft in &mut drafts {
            draft.girth = middle(table.size(&draft.size)?, girth);
        }
        drafts.sort_by(|a, b| a.girth.total_cmp(&b.girth));
        if let Some(twice) = drafts.windows(2).find(|pair| pair[0].size == pair[1].size) {
            return Err(named(format!("it has two drafts for size {}", twice[0].size)));
        }
        Ok(Some(GradedPattern { table, kind: sizes.kind, girth, drafts }))
    }
}

/// The middle of a size's girth (m).
fn middle(size: &Size, girth: Girth) -> f64 {
    let [low, high] = size.range(girth).map(f64::from);
    0.5 * (low + high)
}

impl GradedPattern {
    /// The sizes that are made, smallest first, each with its pattern: those that are drafted, and those between two drafts
    /// of the same panels.
    pub fn made(&self) -> Vec<(String, Pattern)> {
        let made = |size: &Size| Some((size.code.clone(), self.in_size(size)?));
        self.table.sizes.iter().filter_map(made).collect()
    }

    /// The pattern in one size; none where it is not made.
    fn in_size(&self, size: &Size) -> Option<Pattern> {
        if let Some(draft) = self.drafts.iter().find(|d| d.size == size.code) {
            return Some(draft.pattern.clone());
        }
        let girth = middle(size, self.girth);
        let pair = self.drafts.windows(2).find(|pair| pair[0].girth < girth && girth < pair[1].girth)?;
        mix(pair, girth)
    }

    /// The pattern for one body: graded to its own girth; the nearest draft where it is smaller than all or larger, or where
    /// nothing lies between two drafts.
    pub fn to_measure(&self, body: &Measures) -> Pattern {
        let girth = f64::from(self.girth.of(body));
        let pair = self.drafts.windows(2).find(|pair| pair[0].girth < girth && girth < pair[1].girth);
        pair.and_then(|pair| mix(pair, girth)).unwrap_or_else(|| {
            let off = |d: &&Graded| (d.girth - girth).abs();
            let nearest = self.drafts.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            nearest.map_or_else(|| self.drafts[0].pattern.clone(), |d| d.pattern.clone())
        })
    }

    /// The girths between which it can be made to measure (m).
    pub fn reach(&self) -> [f64; 2] {
        let girths = self.drafts.iter().map(|d| d.girth);
        [girths.clone().fold(f64::MAX, f64::min), girths.fold(f64::MIN, f64::max)]
    }

    /// The pattern in a size by its code, `to measure` for the body that is given.
    ///
    /// # Errors
    /// A size that is not made.
    pub fn sized(&self, name: &str, code: &str, body: &Measures) -> Result<Pattern, PackageError> {
        if code == TO_MEASURE {
            return Ok(self.to_measure(body));
        }
        let made = self.table.sizes.iter().find(|s| s.code == code).and_then(|size| self.in_size(size));
        made.ok_or_else(|| {
            let codes: Vec<String> = self.made().into_iter().map(|(code, _)| code).collect();
            PackageError::NotMade { name: name.into(), size: code.into(), made: codes.join(", ") }
        })
    }
}

/// What lies between two drafts at a girth (m).
fn mix(pair: &[Graded], girth: f64) -> Option<Pattern> {
    let [a, b] = pair else { return None };
    a.pattern.between(&b.pattern, (girth - a.girth) / (b.girth - a.girth)).ok()
}
