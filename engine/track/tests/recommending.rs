//! Recommending: rules that a size must obey.

use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_base::numeric::random::SplitMix64;
use toile_track::estimate::Estimate;
use toile_track::measure::{Measurements, Source};
use toile_track::measures::Measures;
use toile_track::recommend::{EaseRange, MadeSize, Offer, SURE, Verdict, Zone, ZoneGirth, evaluate, recommend};

fn person(chest: f32, waist: f32, hip: f32, sigma: f32) -> Measurements {
    let e = |v| Some(Estimate::new(v, sigma));
    let measures = Measures { chest_girth: e(chest), waist_girth: e(waist), hip_girth: e(hip), ..Measures::default() };
    Measurements { measures, valid_pixels: 1, people: 1, frames: 30, source: Source::Depth, notes: Vec::new() }
}

/// A dress with 6 cm of ease at the chest, 8 at the waist and 10 at the hip over the body of each size.
fn dress(table: &SizeTable) -> Vec<MadeSize> {
    let made = |code: &str| {
        let body = table.size_body(code).unwrap();
        let zones = [
            (Zone::Chest, body.chest_girth + 0.06),
            (Zone::Waist, body.waist_girth + 0.08),
            (Zone::Hip, body.hip_girth + 0.10),
        ];
        MadeSize { code: code.to_owned(), zones: zones.map(|(zone, girth_m)| ZoneGirth { zone, girth_m }).to_vec() }
    };
    table.codes().into_iter().map(made).collect()
}

const EASE: [EaseRange; 3] = [
    EaseRange { zone: Zone::Chest, least: 0.03, most: 0.09 },
    EaseRange { zone: Zone::Waist, least: 0.03, most: 0.15 },
    EaseRange { zone: Zone::Hip, least: 0.05, most: 0.20 },
];

fn with(test: impl Fn(&Offer)) {
    let table = SizeTable::embedded("women").unwrap();
    let sizes = dress(&table);
    test(&Offer { garment: "strap-dress", kind: GarmentKind::Dress, table: &table, sizes: &sizes, ease: &EASE });
}

#[test]
fn the_body_of_a_size_is_recommended_that_size_and_all_zones_fit() {
    with(|offer| {
        for code in offer.table.codes() {
            let b = offer.table.size_body(code).unwrap();
            let r = recommend(&person(b.chest_girth, b.waist_girth, b.hip_girth, 0.005), offer).unwrap();
            assert_eq!(r.size, code);
            assert!(r.zones.iter().all(|z| z.verdict == Verdict::Good), "{r:?}");
            assert!(r.zones[0].primary && r.zones[0].zone == Zone::Chest);
            assert!(r.note.is_none() && r.probability > 0.9, "{r:?}");
        }
    });
}

#[test]
fn the_primary_measure_decides_where_the_zones_disagree() {
    // The bust of a 42 over the waist and hips of a 36 and less: a dress is chosen by the bust.
    with(|offer| {
        let r = recommend(&person(0.96, 0.66, 0.90, 0.005), offer).unwrap();
        assert_eq!(r.size, "42", "{r:?}");
        assert_eq!(
            r.zones.iter().map(|z| z.verdict).collect::<Vec<_>>(),
            [Verdict::Good, Verdict::Loose, Verdict::Loose]
        );
    });
}

#[test]
fn between_two_sizes_uncertainty_prefers_the_larger_and_names_the_other() {
    with(|offer| {
        let r = recommend(&person(0.90, 0.74, 0.98, 0.03), offer).unwrap();
        assert_eq!(r.size, "40", "{r:?}");
        assert_eq!(r.runner_up.as_ref().unwrap().size, "38");
        let p = r.runner_up.unwrap().probability;
        assert!((0.1..0.6).contains(&p), "{p}");
    });
}

#[test]
fn more_uncertainty_never_recommends_a_smaller_size() {
    with(|offer| {
        let index = |sigma: f32, chest: f32| {
            let r = recommend(&person(chest, chest - 0.16, chest + 0.08, sigma), offer).unwrap();
            offer.sizes.iter().position(|s| s.code == r.size).unwrap()
        };
        for mm in (780..1020).step_by(7) {
            let chest = mm as f32 / 1000.0;
            assert!(index(0.03, chest) >= index(0.002, chest), "{chest}");
        }
    });
}

#[test]
fn who_fits_no_size_gets_the_nearest_and_a_sentence() {
    with(|offer| {
        let r = recommend(&person(1.60, 1.50, 1.60, 0.02), offer).unwrap();
        assert_eq!(r.size, "54");
        assert!(r.note.unwrap().contains("larger than the largest size"), "a sentence");
        assert_eq!(r.zones[0].verdict, Verdict::Tight);
        let r = recommend(&person(0.60, 0.50, 0.70, 0.02), offer).unwrap();
        assert_eq!(r.size, "32");
        assert!(r.note.unwrap().contains("smaller than the smallest size"), "a sentence");
        assert_eq!(r.zones[0].verdict, Verdict::Loose);
    });
}

#[test]
fn a_size_insisted_on_is_judged_and_the_better_one_named() {
    with(|offer| {
        let r = evaluate(&person(0.88, 0.72, 0.96, 0.01), offer, "34").unwrap();
        assert_eq!(r.size, "34");
        assert_eq!(r.zones[0].verdict, Verdict::Tight);
        assert!((r.zones[0].ease + 0.02).abs() < 1e-5, "{r:?}");
        assert_eq!(r.runner_up.unwrap().size, "38");
        let message = evaluate(&person(0.88, 0.72, 0.96, 0.01), offer, "XL").unwrap_err().to_string();
        assert!(message.contains("32, 34") && message.ends_with('.'), "{message}");
    });
}

#[test]
fn a_measure_that_was_not_seen_is_guessed_and_said_to_be() {
    with(|offer| {
        let mut unseen = person(0.88, 0.72, 0.96, 0.01);
        unseen.measures.chest_girth = None;
        let r = recommend(&unseen, offer).unwrap();
        assert!(r.note.unwrap().contains("guessed"), "a sentence");
        assert!(r.zones[0].sigma > 0.05);
    });
}

#[test]
fn from_joints_alone_no_zone_gets_a_verdict_but_one_that_was_taken_by_tape() {
    with(|offer| {
        let from_joints = Measurements { source: Source::Joints, ..person(0.92, 0.76, 0.98, 0.08) };
        let judged = recommend(&from_joints, offer).unwrap();
        assert!(judged.zones.iter().all(|z| z.verdict == Verdict::Unknown), "{judged:?}");
        assert!(judged.zones.iter().all(|z| z.sentence.contains("take the") && z.sentence.contains("by tape")));
        let mut taped = from_joints;
        taped.measures.chest_girth = Some(Estimate::new(0.92, 0.005));
        let verdicts: Vec<Verdict> = recommend(&taped, offer).unwrap().zones.iter().map(|z| z.verdict).collect();
        assert_eq!(verdicts, [Verdict::Good, Verdict::Unknown, Verdict::Unknown]);
        // Nothing is known of a waist that no depth showed either.
        let mut hidden = person(0.92, 0.76, 0.98, 0.02);
        hidden.measures.waist_girth = None;
        let of = |m: &Measurements| recommend(m, offer).unwrap().zones.iter().map(|z| z.verdict).collect::<Vec<_>>();
        assert_eq!(of(&hidden)[1], Verdict::Unknown);
    });
}

#[test]
fn bad_offers_are_refused_in_one_sentence() {
    let who = person(0.88, 0.72, 0.96, 0.01);
    let men = SizeTable::embedded("men").unwrap();
    with(|offer| {
        let bad = [
            (Offer { table: &men, ..*offer }, "designates no dress"),
            (Offer { sizes: &[], ..*offer }, "no sizes"),
            (Offer { ease: &EASE[1..], ..*offer }, "chosen by"),
        ];
        for (offer, part) in bad {
            let message = recommend(&who, &offer).unwrap_err().to_string();
            assert!(message.contains(part) && message.ends_with('.'), "{message}");
        }
    });
}

/// A random person between the smallest and the largest size, with errors of up to 4 cm.
fn drawn_person(rng: &mut SplitMix64) -> ([f32; 3], f32) {
    let chest = 0.76 + 0.5 * rng.uniform();
    ([chest, chest - 0.16 + 0.05 * rng.gaussian(), chest + 0.08 + 0.05 * rng.gaussian()], 0.04 * rng.uniform())
}

#[test]
fn probabilities_are_those_of_all_sizes_and_sum_to_one() {
    with(|offer| {
        let mut rng = SplitMix64::new(11);
        for _ in 0..100 {
            let ([chest, waist, hip], sigma) = drawn_person(&mut rng);
            let r = recommend(&person(chest, waist, hip, sigma), offer).unwrap();
            assert_eq!(r.sizes.iter().map(|s| s.size.as_str()).collect::<Vec<_>>(), offer.table.codes());
            let sum: f32 = r.sizes.iter().map(|s| s.probability).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{sum}");
            assert_eq!(r.sizes.iter().find(|s| s.size == r.size).unwrap().probability, r.probability);
        }
    });
}

#[test]
fn a_larger_body_never_gets_a_smaller_size() {
    with(|offer| {
        let index = |[chest, waist, hip]: [f32; 3], sigma: f32| {
            let r = recommend(&person(chest, waist, hip, sigma), offer).unwrap();
            offer.sizes.iter().position(|s| s.code == r.size).unwrap()
        };
        let mut rng = SplitMix64::new(12);
        for _ in 0..60 {
            let (body, sigma) = drawn_person(&mut rng);
            for zone in 0..3 {
                let mut larger = body;
                larger[zone] += 0.12 * rng.uniform();
                assert!(index(larger, sigma) >= index(body, sigma), "{body:?} {larger:?} +- {sigma}");
            }
        }
    });
}

#[test]
fn a_body_known_exactly_gets_a_certain_size_and_no_tape() {
    with(|offer| {
        let mut rng = SplitMix64::new(13);
        for _ in 0..60 {
            let ([chest, waist, hip], _) = drawn_person(&mut rng);
            let r = recommend(&person(chest, waist, hip, 0.0), offer).unwrap();
            assert_eq!(r.probability, 1.0, "{r:?}");
            assert!(!r.uncertain && r.girth_to_take.is_none() && r.verdict.contains("100 % sure"), "{r:?}");
        }
    });
}

#[test]
fn who_is_uncertain_is_told_so_and_which_measure_to_take() {
    with(|offer| {
        let r = recommend(&person(0.90, 0.74, 0.98, 0.03), offer).unwrap();
        assert!(r.uncertain && r.probability < SURE, "{r:?}");
        let girth_to_take = r.girth_to_take.as_ref().unwrap();
        assert_eq!(girth_to_take.zone, Zone::Chest);
        assert!(girth_to_take.probability > r.probability + 0.1, "{girth_to_take:?}");
        assert!(r.verdict.starts_with("Not sure") && r.verdict.contains("38 (") && r.verdict.ends_with("%."), "{r:?}");
        assert!(r.verdict.contains("Take the chest by tape"), "{}", r.verdict);
        // The same body measured to a millimetre less than a step away is sure, and says so.
        let r = recommend(&person(0.88, 0.72, 0.96, 0.005), offer).unwrap();
        assert!(!r.uncertain && r.girth_to_take.is_none() && r.verdict.contains("sure"), "{r:?}");
    });
}

/// The tape is named by what it gains, not by rank: with a bust that is known and a waist and hips that are not, it is one
/// of those that decides, though the bust is primary.
#[test]
fn the_tape_goes_where_the_doubt_is() {
    with(|offer| {
        let mut who = person(0.90, 0.78, 1.02, 0.0);
        who.measures.hip_girth = Some(Estimate::new(1.02, 0.08));
        who.measures.chest_girth = Some(Estimate::new(0.9, 0.001));
        let ease = [EASE[0], EaseRange { least: 0.08, most: 0.12, ..EASE[2] }];
        let offer = Offer { ease: &ease, ..*offer };
        let r = recommend(&who, &offer).unwrap();
        assert!(r.uncertain, "{r:?}");
        assert_eq!(r.girth_to_take.unwrap().zone, Zone::Hip);
    });
}

/// A size insisted on is said to be second to the better one.
#[test]
fn the_verdict_on_a_size_insisted_on_names_the_better_one() {
    with(|offer| {
        let r = evaluate(&person(0.88, 0.72, 0.96, 0.01), offer, "34").unwrap();
        assert!(r.verdict.contains("34 was asked for") && r.verdict.contains("size 38 would fit better"), "{r:?}");
    });
}
