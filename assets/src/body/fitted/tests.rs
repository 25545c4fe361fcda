//! Tests that every body built to measure keeps.

use glam::DVec3;

use super::super::sound;
use super::*;
use crate::body::reading::{Ansur, READINGS};
use toile_base::numeric::random::SplitMix64;

const SEXES: [Sex; 2] = [Sex::Female, Sex::Male];

/// The measures of a body between the mean and another, both built from stature, chest, waist and hip.
fn random_person(sex: Sex, random: &mut SplitMix64) -> Fitted {
    let mut around = |mean: f32, by: f32| mean * (1.0 + by * (2.0 * random.uniform() - 1.0));
    let m = Measures::average(sex);
    let stout = around(1.0, 0.18);
    let wanted = Wanted::new()
        .with(En::Stature, around(m.stature, 0.09))
        .with(En::BustGirth, around(m.chest_girth * stout, 0.06))
        .with(En::WaistGirth, around(m.waist_girth * stout, 0.08))
        .with(En::HipGirth, around(m.hip_girth * stout, 0.06))
        .with(En::InsideLegHeight, around(m.stature * 0.48, 0.07))
        .with(En::ArmLength, around(m.stature * 0.365, 0.06))
        .with(En::CalfGirth, around(0.375 * stout, 0.08));
    fitted(sex, &wanted).expect("people of these measures exist")
}

#[test]
fn any_subset_of_a_bodys_own_measures_is_met() {
    let mut random = SplitMix64::new(5);
    for sex in SEXES {
        for _ in 0..12 {
            let person = random_person(sex, &mut random);
            let mut wanted = Wanted::new();
            for &m in En::ALL {
                if random.uniform() < 0.5 {
                    wanted = wanted.with(m, person.readings.of(m));
                }
            }
            let fitted = fitted(sex, &wanted).unwrap();
            for &(m, value) in wanted.given() {
                let off = (fitted.readings.of(m) - value).abs();
                assert!(off < TOLERANCE, "{sex:?}: {} is off by {off} m of {wanted:?}", m.name());
            }
        }
    }
}

/// Moves one measure at a time by 4 % each way.
fn each_alone<V: Vocabulary>(sex: Sex) {
    let mean = fitted(sex, &Wanted::<V>::new()).unwrap();
    for &m in V::ALL {
        for by in [0.96, 1.04] {
            let value = mean.readings.of(m) * by;
            let fitted = fitted(sex, &Wanted::new().with(m, value)).unwrap();
            assert!((fitted.readings.of(m) - value).abs() < TOLERANCE, "{sex:?} {} x {by}", m.name());
        }
    }
}

#[test]
fn each_measure_alone_can_be_changed() {
    for sex in SEXES {
        each_alone::<En>(sex);
        each_alone::<Ansur>(sex);
    }
}

#[test]
fn what_is_not_given_follows_as_in_people() {
    for sex in SEXES {
        let m = Measures::average(sex);
        let hips = |chest: f32| {
            let wanted = Wanted::new().with(En::Stature, m.stature).with(En::BustGirth, chest);
            fitted(sex, &wanted).unwrap().readings.of(En::HipGirth)
        };
        let [slight, stout] = [0.85, 1.15].map(|by| hips(m.chest_girth * by));
        assert!(stout - slight > 0.1, "{sex:?}: broad chests go with broad hips: {slight} {stout}");
        let arm =
            |stature: f32| fitted(sex, &Wanted::new().with(En::Stature, stature)).unwrap().readings.of(En::ArmLength);
        assert!(arm(m.stature * 1.08) - arm(m.stature * 0.92) > 0.05, "{sex:?}: tall people have long arms");
    }
}

#[test]
fn tape_outside_agrees_with_the_gauge() {
    for sex in SEXES {
        let f = random_person(sex, &mut SplitMix64::new(9));
        for (level, measure) in [
            (f.body.levels.chest, En::BustGirth),
            (f.body.levels.waist, En::WaistGirth),
            (f.body.levels.hip, En::HipGirth),
        ] {
            let (tape, gauge) = (super::super::tape::girth(&f.body, level), f.readings.of(measure));
            assert!((tape - gauge).abs() < 1e-4, "{measure:?}: {tape} {gauge}");
        }
    }
}

#[test]
fn gradients_are_those_of_the_readings() {
    for sex in SEXES {
        let model = model(sex);
        let setting = model.calibrate(&[(MeshMeasure::ChestGirth, 1.05), (MeshMeasure::Stature, 1.7)]).setting;
        let positions = model.morphs.positions(&setting);
        let mut gradients = std::array::from_fn::<_, READINGS, _>(|_| Vec::new());
        let _ = model.gauge.read(&positions, Some(&mut gradients));
        for slider in super::super::slider::Slider::ALL {
            let step = if slider.is_length() { 2e-4 } else { 1e-3 };
            let at = |by: f32| {
                let mut moved = setting;
                moved.sliders[slider.index()] += by;
                model.gauge.read(&model.morphs.positions(&moved), None)
            };
            let (less, more) = (at(-step), at(step));
            for r in 0..READINGS {
                let found = f64::from(more[r] - less[r]) / f64::from(2.0 * step);
                let expected: f64 = gradients[r]
                    .iter()
                    .flat_map(|&(v, g)| model.morphs.moves(v as usize).iter().map(move |m| (m, g)))
                    .filter(|((k, _), _)| *k as usize == slider.index())
                    .map(|((_, d), g)| f64::from(g.dot(*d) * setting.scale))
                    .sum();
                // Extents and hulls change corners within the step: a few per cent at most.
                assert!(
                    (found - expected).abs() < 0.02 + 0.06 * expected.abs(),
                    "{sex:?} {slider:?} reading {r}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn sides_are_mirror_images_to_the_bit() {
    for sex in SEXES {
        let body = random_person(sex, &mut SplitMix64::new(3)).body;
        let mirror = &model(sex).morphs.near.mirror;
        for (v, &other) in mirror.iter().enumerate() {
            for values in [&body.mesh.positions, &body.normals] {
                let (a, b) = (values[v], values[other as usize]);
                assert!(a.x == -b.x && a.y == b.y && a.z == b.z, "vertex {v}: {a} {b}");
            }
        }
        for joint in Joint::ALL {
            let (a, b) = (body.skeleton.at(joint), body.skeleton.at(joint.mirror()));
            assert!(a.x == -b.x && a.y == b.y && a.z == b.z, "{joint:?}");
        }
    }
}

#[test]
fn soles_stay_on_the_floor() {
    for sex in SEXES {
        let drawn = &model(sex).morphs.base.positions;
        let soles: Vec<usize> = (0..drawn.len()).filter(|&v| drawn[v].y < 2e-3).collect();
        let body = random_person(sex, &mut SplitMix64::new(4)).body;
        let lowest = body.mesh.positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        assert!(soles.len() > 8 && lowest.abs() < 1e-3, "{sex:?}: {} vertices, {lowest} m", soles.len());
        assert!(soles.iter().all(|&v| (body.mesh.positions[v].y - drawn[v].y).abs() < 1e-3));
    }
}

/// The body of a sex as it is drawn, before any morph.
fn drawn(sex: Sex) -> Body {
    let model = model(sex);
    model.fitted(&model.as_drawn()).body
}

/// Roughness of a surface (Ugur 2008, equation 7.2): the mean distance of a vertex from the mean of its neighbours, over the mean length
/// of the edges, so that size alone makes no body rough.
fn roughness(mesh: &Mesh) -> f64 {
    let at = |v: u32| mesh.positions[v as usize].as_dvec3();
    let mut ways = vec![(DVec3::ZERO, 0u32); mesh.positions.len()];
    let mut edges = 0.0;
    // The mesh is closed: each edge comes once each way.
    for (a, b) in mesh.triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]) {
        let way = &mut ways[a as usize];
        *way = (way.0 + at(b) - at(a), way.1 + 1);
        edges += at(a).distance(at(b));
    }
    let rough: f64 = ways.iter().map(|(sum, count)| (*sum / f64::from((*count).max(1))).length()).sum();
    rough / ways.len() as f64 / (edges / (3 * mesh.triangles.len()) as f64)
}

#[test]
fn morphed_bodies_stay_smooth_and_whole() {
    let mut random = SplitMix64::new(8);
    for sex in SEXES {
        let drawn = drawn(sex);
        for _ in 0..6 {
            let body = random_person(sex, &mut random).body;
            let ratio = roughness(&body.mesh) / roughness(&drawn.mesh);
            assert!((0.8..1.10).contains(&ratio), "{sex:?}: roughness {ratio}");
            assert_eq!(sound::crossings(&body.mesh), [], "{sex:?}");
        }
    }
}

#[test]
fn roughness_knows_a_dent() {
    let mut body = drawn(Sex::Female);
    let smooth = roughness(&body.mesh);
    for (v, p) in body.mesh.positions.iter_mut().enumerate() {
        p.x += if v % 2 == 0 { 4e-3 } else { -4e-3 };
    }
    assert!(roughness(&body.mesh) > 1.5 * smooth);
}

#[test]
fn impossible_measures_give_the_nearest_body() {
    for sex in SEXES {
        let wanted = Wanted::new().with(En::Stature, 1.5).with(En::InsideLegHeight, 1.1);
        let Err(BodyError::Unreachable { measure, value, reached, against, nearest }) = fitted(sex, &wanted) else {
            panic!("legs of 1.1 m on a person of 1.5 m");
        };
        let pair = [measure, against.expect("each of the two can be had alone").0];
        assert!(pair.contains(&"stature") && pair.contains(&"inside leg height"), "{pair:?}");
        assert!(["stature", "inside leg height"].contains(&measure) && (value - reached).abs() > TOLERANCE);
        assert!(nearest.body.mesh.positions.iter().all(|p| p.is_finite()));
        assert!(nearest.readings.of(En::InsideLegHeight) > 0.8, "it goes as far as it can");
        let message = fitted(sex, &wanted).unwrap_err().to_string();
        assert!(message.contains(measure) && message.contains("check") && !message.contains('\n'), "{message}");
    }
}

#[test]
fn out_of_range_is_refused_by_the_name_of_the_measure() {
    for (wanted, name) in [
        (Wanted::new().with(En::CalfGirth, 3.7), "calf girth"),
        (Wanted::new().with(En::ArmLength, f32::NAN), "arm length"),
        (Wanted::new().with(En::WaistGirth, f32::INFINITY), "waist girth"),
    ] {
        let message = fitted(Sex::Female, &wanted).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
    }
    let wanted = Wanted::new().with(Ansur::WaistCircumferenceOmphalion, 0.1);
    assert!(fitted(Sex::Male, &wanted).unwrap_err().to_string().contains("omphalion"));
}

#[test]
fn other_units_are_recognised_and_told() {
    for (value, expected) in
        [(66.0, "as inches it would be 1.676 m"), (168.0, "as centimetres"), (1680.0, "as millimetres")]
    {
        let message = fitted(Sex::Female, &Wanted::new().with(En::Stature, value)).unwrap_err().to_string();
        assert!(message.contains(expected) && message.ends_with("so give metres"), "{message}");
    }
    let message = fitted(Sex::Male, &Wanted::new().with(En::Stature, -1.7)).unwrap_err().to_string();
    assert!(message.ends_with("check the measure and its unit"), "{message}");
}

#[test]
fn measures_that_contradict_each_other_are_told_by_name() {
    let contradictions = [
        Wanted::new().with(En::Stature, 1.6).with(En::KneeHeight, 0.68).with(En::InsideLegHeight, 0.65),
        Wanted::new().with(En::CervicalHeight, 1.8).with(En::HipGirth, 1.0).with(En::Stature, 1.6),
        Wanted::new().with(En::ThighGirth, 1.0).with(En::HipGirth, 0.8).with(En::Stature, 1.7),
    ];
    for sex in SEXES {
        for wanted in &contradictions {
            let Err(error @ BodyError::Unreachable { .. }) = fitted(sex, wanted) else {
                panic!("{sex:?} {wanted:?} was met");
            };
            let message = error.to_string();
            let named = wanted.given().iter().filter(|(m, _)| message.contains(m.name())).count();
            let BodyError::Unreachable { nearest, against, .. } = error else { continue };
            assert_eq!(named, 1 + usize::from(against.is_some()), "{message}");
            assert!(nearest.body.mesh.positions.iter().chain(&nearest.body.normals).all(|p| p.is_finite()));
        }
    }
}

#[test]
fn last_word_about_a_measure_counts() {
    let wanted = Wanted::new().with(En::Stature, 1.6).with(En::HipGirth, 1.0).with(En::Stature, 1.7);
    assert_eq!(wanted.given(), [(En::HipGirth, 1.0), (En::Stature, 1.7)]);
}

#[test]
fn landmarks_lie_where_they_are_drawn() {
    use super::super::landmarks::Landmarks;
    for sex in SEXES {
        let base = &model(sex).morphs.base;
        for (landmark, wanted) in Landmark::ALL.into_iter().zip(Landmarks::drawn(sex)) {
            let at = base.landmarks.mark(landmark).on(&base.positions);
            assert!((at.y - wanted.y).abs() < 5e-3, "{landmark:?}: {at} {wanted}");
            assert!(at.distance(wanted) < 0.03, "{landmark:?}: {at} {wanted}");
        }
    }
}
