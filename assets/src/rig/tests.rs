//! The collision body against brute force and against its own promises.

use super::union::{RestSpheres, nearest};
use super::*;
use toile_base::body::{Measures, Sex};

/// Small, average and large bodies of both sexes.
fn people() -> Vec<(String, Body)> {
    let sized = |sex: Sex, scale: f32| {
        let m = Measures::average(sex);
        let [stature, shoulder_breadth] = [m.stature, m.shoulder_breadth].map(|length| length * scale);
        let [chest_girth, waist_girth, hip_girth] =
            [m.chest_girth, m.waist_girth, m.hip_girth].map(|girth| girth * scale);
        let measures = Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth };
        (format!("{sex:?} {scale}"), crate::body::build(sex, &measures).unwrap())
    };
    [Sex::Female, Sex::Male].into_iter().flat_map(|sex| [0.95, 1.0, 1.05].map(|scale| sized(sex, scale))).collect()
}

#[test]
fn rig_is_symmetric_and_complete() {
    for (_, body) in people() {
        let rig = fit(&body);
        let (sides, middle) = rig.spheres.split_at(2 * PAIRS);
        for pair in sides.chunks(2) {
            let (l, r) = (pair[0], pair[1]);
            assert_eq!(Joint::ALL[usize::from(l.bone)].mirror().index(), usize::from(r.bone));
            assert!((l.offset * Vec3::new(-1.0, 1.0, 1.0)).distance(r.offset) < 1e-6 && l.radius == r.radius);
        }
        assert!(middle.iter().all(|s| s.offset.x == 0.0));
        for s in &rig.spheres {
            assert!(s.radius > 0.01 && s.radius < 0.25 && s.offset.length() < 0.4, "{s:?}");
        }
        let mirrored = |s: u8| if usize::from(s) < 2 * PAIRS { s ^ 1 } else { s };
        let same = |c: &[u8; 2], d: &[u8; 2]| (d[0], d[1]) == (c[0], c[1]) || (d[1], d[0]) == (c[0], c[1]);
        for (i, c) in rig.capsules.iter().enumerate() {
            assert!(c[0] != c[1] && c.iter().all(|&s| usize::from(s) < SPHERES));
            assert!(!rig.capsules[..i].iter().any(|d| same(c, d)), "capsule {i} stands twice");
            assert!(rig.capsules.iter().any(|d| same(&c.map(mirrored), d)), "capsule {i} has no mirror image");
        }
        assert!((0..SPHERES).all(|s| rig.capsules.iter().flatten().any(|e| usize::from(*e) == s)), "none is idle");
    }
}

#[test]
fn reports_are_what_the_distance_says() {
    let body = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let rig = fit(&body);
    let report = report(&rig, &body);
    for (zone, report) in Zone::ALL.into_iter().zip(report.zones) {
        let within = (0..body.mesh.positions.len()).filter(|&v| Zone::of(&body, v) == zone);
        let distances: Vec<f32> = within.map(|v| rig.distance(&body, body.mesh.positions[v]) * 1e3).collect();
        let furthest = distances.iter().copied().fold(0.0, f32::max);
        assert!((furthest - report.max_inside_mm).abs() < 1e-2, "{}", zone.name());
        // Where several capsules overlap, the way out of all is longer than that of the deepest one.
        let deepest = distances.iter().copied().fold(0.0, f32::min);
        assert!(report.max_outside_mm >= -deepest - 1e-2, "{}", zone.name());
    }
}

#[test]
fn way_out_leads_out() {
    let body = crate::body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
    let placed = fit(&body).placed(&body);
    let mut inside = 0;
    for (p, n) in body.mesh.positions.iter().zip(&body.normals).step_by(7) {
        let (deepest, way) = (nearest(&placed, *p).0, report::way_out(&placed, *p, *n));
        assert!(way <= deepest + 1e-6, "{p}: {way} {deepest}");
        inside += u32::from(way < 0.0);
    }
    assert!(inside > 100);
}

/// Points of the union's surface lie on it, and their areas are those of a sphere's that the rest of it does not cover.
#[test]
fn surface_of_the_union_is_sampled_evenly() {
    let alone: RestSpheres = std::array::from_fn(|i| (Vec3::new(i as f32, 0.0, 0.0), 0.0));
    let mut spread = alone;
    // The last one shares its ends with no other.
    let [a, b] = CAPSULES[CAPSULES.len() - 1].map(usize::from);
    (spread[a], spread[b]) = ((Vec3::ZERO, 0.1), (Vec3::Y * 0.3, 0.06));
    let points = report::surface(&spread);
    assert!(points.iter().all(|(p, _)| nearest(&spread, *p).0.abs() < 2e-4));
    // A round cone's surface: two caps and the slanted side between them.
    let sine = 0.04 / 0.3f32;
    let cosine2 = 1.0 - sine * sine;
    let caps = std::f32::consts::TAU * (0.1 * 0.1 * (1.0 + sine) + 0.06 * 0.06 * (1.0 - sine));
    let side = std::f32::consts::PI * (0.1 + 0.06) * 0.3 * cosine2;
    let found: f32 = points.iter().filter(|(p, _)| p.x.abs() < 0.2).map(|p| p.1).sum();
    // Where cap and side meet, a strip of some millimetres counts on both.
    assert!((found - caps - side).abs() < 0.02 * (caps + side), "{found} {}", caps + side);
}

#[test]
fn same_body_gives_the_same_bits() {
    let body = crate::body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
    assert_eq!(fit(&body), fit(&body));
}
