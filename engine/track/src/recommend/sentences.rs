//! A recommendation in sentences.

use super::probability::ease_of;
use super::{
    EaseRange, MadeSize, Offer, SURE, ScoredZone, SizeProbability, TapeAdvice, Verdict, WEIGHTS, WORTH_NAMING, Zone,
    ZoneFit,
};
use crate::measure::Measurements;

/// The verdict on the size chosen, beside the one that is best.
pub(super) fn verdict(
    sizes: &[SizeProbability],
    [chosen, best]: [usize; 2],
    girth_to_take: Option<&TapeAdvice>,
) -> String {
    let SizeProbability { size, probability } = &sizes[chosen];
    let percent = 100.0 * probability;
    if chosen != best {
        let SizeProbability { size: better, probability } = &sizes[best];
        return format!(
            "Size {size} was asked for ({percent:.0} % likely to be the best): size {better} would fit better ({:.0} %).",
            100.0 * probability
        );
    }
    if *probability >= SURE {
        return format!("Size {size} fits best: {percent:.0} % sure.");
    }
    let mut others: Vec<&SizeProbability> =
        sizes.iter().filter(|s| s.size != *size && s.probability >= WORTH_NAMING).collect();
    others.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let others: Vec<String> = others.iter().map(|s| format!("{} ({:.0} %)", s.size, 100.0 * s.probability)).collect();
    let mut text = format!("Not sure: size {size} is the best guess ({percent:.0} %)");
    if !others.is_empty() {
        text.push_str(&format!(", but it may be {}", others.join(" or ")));
    }
    text.push('.');
    if let Some(girth_to_take) = girth_to_take {
        text.push(' ');
        text.push_str(&girth_to_take.sentence);
    }
    text
}

/// The verdict on a garment that there is in one size.
pub(super) fn only(size: &MadeSize, zones: &[ZoneFit]) -> String {
    let at = |verdict: Verdict| {
        zones.iter().filter(|z| z.verdict == verdict).map(|z| z.zone.name()).collect::<Vec<_>>().join(" and ")
    };
    let parts = [Verdict::Tight, Verdict::Loose, Verdict::Unknown].map(|verdict| (verdict, at(verdict)));
    let wrong: Vec<String> = parts
        .into_iter()
        .filter(|(_, zones)| !zones.is_empty())
        .map(|(verdict, zones)| match verdict {
            Verdict::Unknown => format!("not known at the {zones}"),
            _ => format!("{} at the {zones}", verdict.name()),
        })
        .collect();
    let how = if wrong.is_empty() { "it fits".to_owned() } else { wrong.join(", ") };
    format!("There is one size, {}: {how}.", size.code)
}

/// What taking a girth by tape is good for.
pub(super) fn girth_to_take(zone: Zone, now: f32, then: f32) -> String {
    let (now, then) = (100.0 * now, 100.0 * then);
    format!("Take the {} by tape: the size is then {then:.0} % sure on average, not {now:.0} %.", zone.name())
}

/// How one zone fits.
pub(super) fn fit(zone: &ScoredZone, size: &MadeSize) -> Option<ZoneFit> {
    let ease = ease_of(zone, size)?;
    let EaseRange { least, most, zone: at } = zone.ease;
    let verdict = match ease {
        _ if zone.guessed => Verdict::Unknown,
        e if e < least => Verdict::Tight,
        e if e > most => Verdict::Loose,
        _ => Verdict::Good,
    };
    let sigma = zone.body.sigma;
    let cm = |m: f32| m * 100.0;
    let how = match verdict {
        Verdict::Tight => format!("tight by {:.1} cm", cm(least - ease)),
        Verdict::Loose => format!("loose by {:.1} cm", cm(ease - most)),
        Verdict::Good => "good".to_owned(),
        Verdict::Unknown => {
            let sentence = format!(
                "How the {0} fits is not known: its ease of {1:.1} cm, give or take {2:.1} cm, is a guess from the stature and the \
                 shoulders; take the {0} by tape.",
                at.name(),
                cm(ease),
                cm(sigma)
            );
            return Some(ZoneFit { zone: at, primary: zone.weight == WEIGHTS[0], ease, sigma, verdict, sentence });
        }
    };
    let doubt = match verdict {
        Verdict::Good if ease - least < sigma && ease - least < most - ease => ", perhaps tight",
        Verdict::Good if most - ease < sigma => ", perhaps loose",
        Verdict::Tight if least - ease < sigma => ", perhaps good",
        Verdict::Loose if ease - most < sigma => ", perhaps good",
        _ => "",
    };
    let sentence = format!(
        "The {} has {:.1} cm of ease, give or take {:.1} cm: {how}{doubt} ({:.0} to {:.0} cm is comfortable).",
        at.name(),
        cm(ease),
        cm(sigma),
        cm(least),
        cm(most)
    );
    Some(ZoneFit { zone: at, primary: zone.weight == WEIGHTS[0], ease, sigma, verdict, sentence })
}

/// What the person should know besides: that no size is made for them.
pub(super) fn note(measured: &Measurements, offer: &Offer, zones: &[ScoredZone]) -> Option<String> {
    let primary = zones.first()?;
    let zone = primary.ease.zone;
    let smallest = offer.table.size(&offer.sizes.first()?.code).ok()?;
    let largest = offer.table.size(&offer.sizes.last()?.code).ok()?;
    let cm = |m: f32| m * 100.0;
    let (name, value) = (zone.name(), cm(primary.body.value));
    if primary.body.value < smallest.range(zone)[0] {
        let (code, limit) = (&smallest.code, cm(smallest.range(zone)[0]));
        return Some(format!(
            "The {name} of {value:.0} cm is smaller than the smallest size made, {code}, is meant for ({limit:.0} cm \
             and up): it is the nearest."
        ));
    }
    if primary.body.value > largest.range(zone)[1] {
        let (code, limit) = (&largest.code, cm(largest.range(zone)[1]));
        return Some(format!(
            "The {name} of {value:.0} cm is larger than the largest size made, {code}, is meant for (up to \
             {limit:.0} cm): it is the nearest."
        ));
    }
    unseen(measured, zone)
}

/// Said where the girth at a zone was guessed.
pub(super) fn unseen(measured: &Measurements, zone: Zone) -> Option<String> {
    let m = &measured.measures;
    let taken = match zone {
        Zone::Chest => m.chest_girth,
        Zone::Waist => m.waist_girth,
        Zone::Hip => m.hip_girth,
    };
    let name = zone.name();
    taken
        .is_none()
        .then(|| format!("The {name} was not seen: its girth is guessed from the stature and the shoulders."))
}
