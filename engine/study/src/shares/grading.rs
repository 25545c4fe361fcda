//! The size that suits true girths, and its change where a step between two sizes is made larger or smaller.

use serde::Serialize;
use toile_track::recommend::{OFF_MIDDLE, TIGHT_TO_LOOSE};

use super::interval::{Bootstrap, Share};
use super::wearers::{Wearers, ZONES};
use crate::garments::GarmentNote;

/// How much a step is changed (mm).
const CHANGE_MM: f64 = 10.0;

/// What a change of a step between two sizes does.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GradingStep {
    /// The zone whose girth is changed.
    pub zone: String,
    /// The smaller of the two sizes; none where all sizes are changed alike.
    pub from: Option<String>,
    /// The larger one, which is changed with all that are larger still.
    pub to: String,
    /// By how much (mm).
    pub change_mm: f64,
    /// Share of people who are fitted then, less the share of now.
    pub gain: Share,
}

/// How a size is on girths: its ease at each judged zone, outside of what is comfortable or not.
pub(super) struct ZoneFits {
    /// -1 tight, 0 good, 1 loose `[judged zones]`.
    pub verdicts: Vec<i8>,
    penalty: f64,
}

impl ZoneFits {
    /// Whether every zone is good.
    pub fn fits(&self) -> bool {
        self.verdicts.iter().all(|v| *v == 0)
    }
}

/// Girth of a person at a judged zone.
fn girth(note: &GarmentNote, zone: usize, girths: [f64; 3]) -> f64 {
    ZONES.iter().position(|name| *name == note.comfort_mm[zone].0).map_or(f64::NAN, |at| girths[at])
}

/// Judges a size by the recommender's own rule for measures that are known exactly; `more` is what each zone of the size has
/// more than it is made with (mm).
pub(super) fn judge(note: &GarmentNote, size: usize, girths: [f64; 3], more: impl Fn(usize) -> f64) -> ZoneFits {
    let (mut verdicts, mut penalty) = (Vec::with_capacity(note.comfort_mm.len()), 0.0);
    for (zone, (_, [least, most])) in note.comfort_mm.iter().enumerate() {
        let Some(made) = note.sizes[size].1[zone] else { continue };
        let ease = made + more(zone) - girth(note, zone, girths);
        verdicts.push(if ease < *least { -1 } else { i8::from(ease > *most) });
        let outside = f64::from(TIGHT_TO_LOOSE) * (least - ease).max(0.0) + (ease - most).max(0.0);
        penalty += note.weight[zone] * (outside + f64::from(OFF_MIDDLE) * (ease - 0.5 * (least + most)).abs());
    }
    ZoneFits { verdicts, penalty }
}

/// The size that suits girths best, and how it does.
pub(super) fn best(note: &GarmentNote, girths: [f64; 3], more: impl Fn(usize, usize) -> f64) -> (usize, ZoneFits) {
    let mut found: Option<(usize, ZoneFits)> = None;
    for size in 0..note.sizes.len() {
        let fits = judge(note, size, girths, |zone| more(size, zone));
        if found.as_ref().is_none_or(|(_, least)| fits.penalty < least.penalty) {
            found = Some((size, fits));
        }
    }
    found.unwrap_or((0, ZoneFits { verdicts: Vec::new(), penalty: 0.0 }))
}

/// Every change of one step by 10 mm, the most helpful first.
pub(super) fn steps(wearers: &Wearers, bootstrap: &Bootstrap) -> Vec<GradingStep> {
    let note = &wearers.note;
    let now: Vec<bool> = wearers.all.iter().map(|w| best(note, w.girths, |_, _| 0.0).1.fits()).collect();
    let mut found = Vec::new();
    for (zone, (name, _)) in note.comfort_mm.iter().enumerate() {
        for first in 0..note.sizes.len() {
            for change_mm in [CHANGE_MM, -CHANGE_MM] {
                let more = |size: usize, at: usize| if at == zone && size >= first { change_mm } else { 0.0 };
                let gain = wearers.all.iter().zip(&now).map(|(w, now)| {
                    let then = best(note, w.girths, more).1.fits();
                    ((f64::from(u8::from(then)) - f64::from(u8::from(*now))) * w.weight, w.weight)
                });
                found.push(GradingStep {
                    zone: name.clone(),
                    from: first.checked_sub(1).map(|before| note.sizes[before].0.clone()),
                    to: note.sizes[first].0.clone(),
                    change_mm,
                    gain: bootstrap.mean(gain),
                });
            }
        }
    }
    // Of changes that help alike, one of a step comes before one of all sizes.
    found.sort_by(|a, b| b.gain.share.total_cmp(&a.gain.share).then(b.from.is_some().cmp(&a.from.is_some())));
    found
}

#[cfg(test)]
mod tests {
    use super::super::wearers::Wearer;
    use super::*;

    /// Two sizes of a skirt, judged at the hip alone: 900 and 1000 mm over bodies, comfortable from 20 to 60.
    fn skirt() -> GarmentNote {
        GarmentNote {
            name: "skirt".into(),
            kind: "skirt".into(),
            table: "women".into(),
            primary: "hip".into(),
            comfort_mm: vec![("hip".into(), [20.0, 60.0])],
            weight: vec![1.0],
            sizes: vec![("S".into(), vec![Some(940.0)]), ("M".into(), vec![Some(1040.0)])],
            tried: vec!["S".into(), "M".into()],
            sha256: None,
        }
    }

    #[test]
    fn a_step_that_is_too_large_is_found() {
        // Between the sizes' bodies, 880..920 and 980..1020, no person is fitted; most people are just below the larger one.
        let hips = [890.0, 900.0, 970.0, 972.0, 974.0, 976.0, 1000.0];
        let wearer = |hip: &f64| Wearer { weight: 1.0, girths: [0.0, 0.0, *hip], ..Wearer::default() };
        let wearers = Wearers { all: hips.iter().map(wearer).collect(), ..Wearers::of_note(skirt()) };
        assert_eq!(best(&skirt(), [0.0, 0.0, 900.0], |_, _| 0.0).0, 0);
        let steps = steps(&wearers, &Bootstrap::new(hips.len(), 1));
        let first = &steps[0];
        assert_eq!((first.from.as_deref(), first.to.as_str(), first.change_mm), (Some("S"), "M", -10.0));
        assert!((first.gain.share - 4.0 / 7.0).abs() < 1e-12, "{first:?}");
    }
}
