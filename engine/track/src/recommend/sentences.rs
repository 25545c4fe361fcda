//! A recommendation in sentences.

use super::feel::{self, Feel};
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
    zones: &[ZoneFit],
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
        let misfits = misfits(zones, &[Verdict::Tight, Verdict::Loose]);
        return match misfits.is_empty() {
            true => format!("Size {size} fits best: {percent:.0} % sure."),
            false => format!("Size {size} is the nearest: {misfits} ({percent:.0} % sure that no other is nearer)."),
        };
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
    let misfits = misfits(zones, &[Verdict::Tight, Verdict::Loose, Verdict::Unknown]);
    let how = if misfits.is_empty() { "it fits" } else { &misfits };
    format!("There is one size, {}: {how}.", size.code)
}

/// Where it does not fit: `tight at the chest and hip, loose at the waist`.
fn misfits(zones: &[ZoneFit], verdicts: &[Verdict]) -> String {
    let named = |verdict: &Verdict| {
        let at =
            zones.iter().filter(|z| z.verdict == *verdict).map(|z| z.zone.name()).collect::<Vec<_>>().join(" and ");
        (!at.is_empty()).then(|| match verdict {
            Verdict::Unknown => format!("not known at the {at}"),
            _ => format!("{} at the {at}", verdict.name()),
        })
    };
    verdicts.iter().filter_map(named).collect::<Vec<_>>().join(", ")
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
    let sigma = zone.body.sigma;
    let cm = |m: f32| m * 100.0;
    let feels = |ease: f32| Feel::at(feel::place(ease, [least, most]));
    let feel = (!zone.guessed).then(|| feels(ease));
    let verdict = match feel {
        None => Verdict::Unknown,
        Some(Feel::TooTight | Feel::Tight) => Verdict::Tight,
        Some(Feel::Loose | Feel::TooLoose) => Verdict::Loose,
        Some(_) => Verdict::Good,
    };
    let differs = |p: &Feel| feel.is_some_and(|feel| feel.is_comfortable() != p.is_comfortable());
    let perhaps = [ease - sigma, ease + sigma].map(feels).into_iter().find(differs);
    let sentence = match feel {
        None => format!(
            "How the {0} fits is not known: its ease of {1:.1} cm, give or take {2:.1} cm, is a guess from the stature and the \
             shoulders; take the {0} by tape.",
            at.name(),
            cm(ease),
            cm(sigma)
        ),
        Some(feel) => {
            let by = match verdict {
                Verdict::Tight => format!(" by {:.1} cm", cm(least - ease)),
                Verdict::Loose => format!(" by {:.1} cm", cm(ease - most)),
                Verdict::Good | Verdict::Unknown => String::new(),
            };
            let doubt = perhaps.map_or_else(String::new, |other| format!(", perhaps {}", other.name()));
            format!(
                "The {} has {:.1} cm of ease, give or take {:.1} cm: {}{by}{doubt} ({:.0} to {:.0} cm is comfortable).",
                at.name(),
                cm(ease),
                cm(sigma),
                feel.name(),
                cm(least),
                cm(most)
            )
        }
    };
    let tightness = feel.map(|_| feel::tightness(feel::place(ease, [least, most])));
    Some(ZoneFit {
        zone: at,
        primary: zone.weight == WEIGHTS[0],
        ease,
        sigma,
        verdict,
        feel,
        perhaps,
        tightness,
        sentence,
    })
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
