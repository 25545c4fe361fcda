//! The collision body against brute force and against its own promises.

use super::*;
use crate::body::{Measures, Sex};

/// The distance by walking the axis in small steps and testing every sphere.
fn walked(p: Vec3, (a, ra): (Vec3, f32), (b, rb): (Vec3, f32)) -> f32 {
    let steps = 20_000;
    let at = |i: i32| i as f32 / steps as f32;
    (0..=steps).map(|i| p.distance(a.lerp(b, at(i))) - (ra + (rb - ra) * at(i))).fold(f32::MAX, f32::min)
}

#[test]
fn round_cone_agrees_with_brute_force() {
    let cones = [
        ((Vec3::ZERO, 0.1), (Vec3::new(0.3, 0.1, -0.2), 0.05)),
        ((Vec3::ONE, 0.05), (Vec3::new(1.0, 1.4, 1.0), 0.05)),
        ((Vec3::ZERO, 0.2), (Vec3::new(0.05, 0.0, 0.0), 0.1)),
        ((Vec3::X, 0.01), (Vec3::X, 0.02)),
        ((Vec3::ZERO, 0.12), (Vec3::new(0.0, -0.1, 0.0), 0.03)),
    ];
    for (a, b) in cones {
        for i in 0..1000 {
            let spread = |k: f32| (i as f32 * k).fract() - 0.5;
            let p = a.0 + Vec3::new(spread(0.618_034), spread(0.414_214), spread(0.732_051)) * 0.8;
            let (found, t) = round_cone(p, a, b);
            assert!((found - walked(p, a, b)).abs() < 1e-5, "{p} {found}");
            assert!((0.0..=1.0).contains(&t));
        }
    }
}

#[test]
fn round_cone_distance_inside_is_the_way_out() {
    let (a, b) = ((Vec3::ZERO, 0.1), (Vec3::new(0.4, 0.0, 0.0), 0.06));
    let p = Vec3::new(0.2, 0.03, 0.01);
    let depth = -round_cone(p, a, b).0;
    let directions = (0..20_000).map(|i| {
        let (s, c) = (i as f32 * 2.399_963).sin_cos();
        let z = 1.0 - 2.0 * (i as f32 + 0.5) / 20_000.0;
        Vec3::new(c * (1.0 - z * z).sqrt(), s * (1.0 - z * z).sqrt(), z)
    });
    let mut reached = 0;
    for d in directions {
        assert!(round_cone(p + d * (depth - 1e-5), a, b).0 < 0.0, "a ball of that radius fits");
        reached += u32::from(round_cone(p + d * (depth + 2e-4), a, b).0 > 0.0);
    }
    assert!(reached > 0, "and touches");
}

fn people() -> Vec<Body> {
    let mut people = Vec::new();
    for sex in [Sex::Female, Sex::Male] {
        let mean = Measures::average(sex);
        for [stature, girth] in [[1.0, 1.0], [0.93, 0.85], [1.05, 1.2]] {
            let wanted = Measures {
                stature: mean.stature * stature,
                shoulder_breadth: mean.shoulder_breadth * stature,
                chest_girth: mean.chest_girth * girth,
                waist_girth: mean.waist_girth * girth,
                hip_girth: mean.hip_girth * girth,
            };
            people.push(Body::build(sex, &wanted).unwrap());
        }
    }
    people
}

#[test]
fn union_follows_the_body() {
    for body in people() {
        let report = Rig::fit(&body).report;
        assert!(report.mean_mm < 9.0 && report.p95_mm < 22.0, "{report:?}");
        assert!(report.max_outside_mm < 38.0 && report.max_inside_mm < 28.0, "{report:?}");
    }
}

#[test]
fn rig_is_symmetric_and_complete() {
    for body in people() {
        let rig = Rig::fit(&body);
        for pair in rig.spheres.chunks(2) {
            let (l, r) = (pair[0], pair[1]);
            assert_eq!(Joint::ALL[usize::from(l.bone)].mirror().index(), usize::from(r.bone));
            assert!((l.offset * Vec3::new(-1.0, 1.0, 1.0)).distance(r.offset) < 1e-6 && l.radius == r.radius);
            assert!(l.radius > 0.01 && l.radius < 0.25 && l.offset.length() < 0.3);
        }
        for (i, c) in rig.capsules.iter().enumerate() {
            assert!(c[0] != c[1] && c.iter().all(|&s| usize::from(s) < MAX_SPHERES));
            let same = |d: &[u8; 2]| (d[0], d[1]) == (c[0], c[1]) || (d[1], d[0]) == (c[0], c[1]);
            assert!(!rig.capsules[..i].iter().any(same), "capsule {i} stands twice");
        }
    }
}

#[test]
fn report_is_what_the_distance_says() {
    let body = Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let rig = Rig::fit(&body);
    let covered = (0..body.mesh.positions.len()).filter(|&v| clothed(&body, v));
    let furthest = covered.map(|v| rig.distance(&body, body.mesh.positions[v]) * 1e3).fold(0.0, f32::max);
    assert!((furthest - rig.report.max_inside_mm).abs() < 1e-2);
}

#[test]
fn same_body_gives_the_same_bits() {
    let body = Body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
    assert_eq!(Rig::fit(&body), Rig::fit(&body));
}
