//! Report of the worn garments.

use toile_assets::adapt::dress as own;
use toile_fitting::dress::garment_source::FittedGarment;

use crate::report::RecommendationReport;

/// What is said of each garment.
pub fn recommendations(worn: &[FittedGarment]) -> Vec<RecommendationReport> {
    let said = |worn: &FittedGarment| match &worn.fit {
        Some(fit) => fit.clone().into(),
        None => RecommendationReport {
            garment: worn.mesh.as_ref().map(|mesh| mesh.file.clone()).unwrap_or_default(),
            size: own::UNKNOWN.to_owned(),
            ..RecommendationReport::default()
        },
    };
    worn.iter().map(said).collect()
}
