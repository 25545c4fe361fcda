//! Counts of the contact of cloth with cloth for reports, and of pairs and crossings that found a buffer full.

use serde::Serialize;
use toile_base::limits::MAX_GARMENTS;
use toile_engine::cloth::contact::garments::{GarmentContact, GarmentContactCounts, MOST_CROSSINGS, PAIRS_A_PARTICLE};

/// Name of [`PAIRS_A_PARTICLE`] in reports and warnings.
pub const PAIRS_NAME: &str = "PAIRS_A_PARTICLE (pairs of a garment's own particles that one worker keeps, a particle)";

/// Name of [`MOST_CROSSINGS`] in reports and warnings.
pub const CROSSINGS_NAME: &str = "MOST_CROSSINGS (crossings of a garment that one worker keeps)";

/// Counts of contact between garments, and of garments with themselves, since they were made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct ContactReport {
    /// Particles that were looked at, summed over the steps.
    pub asked: u64,
    /// Contacts, summed over the steps.
    pub contacts: u64,
    /// Most contacts of one step.
    pub contacts_most: u64,
    /// Most pairs of its own particles that one worker kept of a garment at once.
    pub pairs_most: u64,
    /// Capacity for such pairs, of the garment that has most.
    pub pairs_room: u64,
    /// Such pairs left out because the buffer was full, summed over the steps.
    pub crowded: u64,
    /// Most crossings that one worker kept of one garment at once.
    pub crossings_most: u64,
    /// Crossings left out because the buffer was full, summed over the steps.
    pub left_out: u64,
}

impl From<GarmentContactCounts> for ContactReport {
    fn from(counts: GarmentContactCounts) -> Self {
        let GarmentContactCounts {
            asked,
            contacts,
            contacts_most,
            pairs_most,
            pairs_room,
            crowded,
            crossings_most,
            left_out,
            // A scene steps its own garments.
            refused: _,
        } = counts;
        Self { asked, contacts, contacts_most, pairs_most, pairs_room, crowded, crossings_most, left_out }
    }
}

impl ContactReport {
    /// What was full, which constant bounds it, and what was kept.
    pub fn warnings(&self) -> Vec<String> {
        let Self { crowded, left_out, .. } = self;
        let mut all = Vec::new();
        if *crowded > 0 {
            all.push(format!(
                "{crowded} times a garment had more near pairs of particles than {PAIRS_NAME} holds, {PAIRS_A_PARTICLE}, and kept the \
                 nearest; build the program with a larger value, or give the garment more ease"
            ));
        }
        if *left_out > 0 {
            all.push(format!(
                "{left_out} times a garment passed through itself more often than {CROSSINGS_NAME} holds, {MOST_CROSSINGS}, \
                 and those that reach least far through were drawn out first; build the program with a larger value"
            ));
        }
        all
    }
}

/// Why garments that are to keep apart do not: there are too many.
pub fn too_many(garments: usize, layers: Option<&GarmentContact>) -> Option<String> {
    (layers.is_none() && garments > MAX_GARMENTS).then(|| {
        format!(
            "{garments} garments are more than MAX_GARMENTS (garments that keep apart), {MAX_GARMENTS}, and pass through each \
             other and themselves; leave some out, or build the program with a larger value"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_full_names_its_constant() {
        assert_eq!(ContactReport { contacts_most: 9, pairs_most: 2, ..ContactReport::default() }.warnings(), [""; 0]);
        let full = ContactReport { crowded: 3, left_out: 4, ..ContactReport::default() }.warnings();
        assert!(
            full[0].starts_with("3 times") && full[0].contains("PAIRS_A_PARTICLE") && full[0].contains(", 8,"),
            "{full:?}"
        );
        assert!(full[1].starts_with("4 times") && full[1].contains("MOST_CROSSINGS"), "{full:?}");
    }

    #[test]
    fn more_garments_than_keep_apart_are_reported() {
        assert_eq!(too_many(MAX_GARMENTS, None), None, "nothing of them has faces");
        assert!(too_many(MAX_GARMENTS + 1, None).unwrap().contains("MAX_GARMENTS"));
    }
}
