//! Fit of a garment, as reports show it.

use toile_track::recommend;

use crate::report::{RecommendationReport, SizeChance, TapeMeasure, ZoneFitReport};

impl From<recommend::Recommendation> for RecommendationReport {
    fn from(judged: recommend::Recommendation) -> Self {
        let mm = |m: f32| (f64::from(m) * 1e4).round() / 10.0;
        let zones = judged.zones.iter().map(|fit| ZoneFitReport {
            zone: fit.zone.name().into(),
            ease_mm: mm(fit.ease),
            sigma_mm: mm(fit.sigma),
            verdict: fit.verdict.name().into(),
            feel: fit.feel.map(|feel| feel.name().into()),
            sentence: fit.sentence.clone(),
        });
        let share = |p: f32| (f64::from(p) * 1e3).round() / 1e3;
        let sizes = judged.sizes.into_iter().map(|s| SizeChance { size: s.size, probability: share(s.probability) });
        let tape = judged.girth_to_take.map(|t| TapeMeasure {
            zone: t.zone.name().into(),
            probability: share(t.probability),
            sentence: t.sentence,
        });
        Self {
            garment: judged.garment,
            size: judged.size,
            probability: share(judged.probability),
            zones: zones.collect(),
            sizes: sizes.collect(),
            uncertain: judged.uncertain,
            tape,
            verdict: judged.verdict,
            runner_up: judged.runner_up.map(|r| r.size),
            note: judged.note,
        }
    }
}
