//! The same bits at every width and for every split; the same numbers as the scalar reference.

use super::plain::{self, Cone};
use super::*;

/// A few substeps of a crowd, as bits.
fn run(width: Width, spans: &[Vec<(u32, u32)>; 2], far: f32) -> Vec<u32> {
    let (positions, colliders) = crowd(613, 5);
    let mut bed = Bed::split(&positions, &colliders, spans);
    bed.width = width;
    stir(&mut bed, far, 9);
    bed.find(&colliders);
    for k in 0..4 {
        stir(&mut bed, far, 10 + k);
        bed.solve([k as f32 / 4.0, (k + 1) as f32 / 4.0]);
    }
    assert!(bed.contacts.tally().near > 100, "{:?}", bed.contacts.tally());
    bed.bits()
}

#[test]
fn every_width_and_every_split_gives_the_same_bits() {
    let whole = [vec![(0, 613)], vec![]];
    let halves = [vec![(0, 307)], vec![(307, 306)]];
    let crumbs = [vec![(13, 40), (600, 13), (100, 333)], vec![(433, 167), (0, 13), (53, 47)]];
    for far in [0.003, 0.05] {
        let plain = run(Width::One, &whole, far);
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            for spans in [&whole, &halves, &crumbs] {
                assert!(run(width, spans, far) == plain, "{width} lanes, {spans:?}");
            }
        }
    }
}

#[test]
fn contact_agrees_with_the_scalar_reference() {
    let mut random = Random(3);
    let mut touched = 0;
    for case in 0..4_000 {
        let (a, b) = (random.point(0.3), random.point(0.3));
        let (ra, rb) = (random.between(0.03, 0.2), random.between(0.03, 0.2));
        let from = [a.extend(ra), b.extend(if case % 7 == 0 { ra } else { rb })];
        let to = from.map(|s| s + (random.direction() * 0.002).extend(0.0));
        let p = random.point(0.4);
        let colliders = colliders(&from, &to, &[[0, 1]], false);
        let mut bed = Bed::new(&[p], &colliders);
        bed.find(&colliders);
        let way = random.direction() * random.between(0.0, 0.004);
        bed.send(0, p + way);
        let (x, previous) = (bed.at(0).as_dvec3(), p.as_dvec3());
        let offset = f64::from(HOW.offset_m);
        let friction = [f64::from(HOW.friction_static), f64::from(HOW.friction_kinetic)];
        let (x, previous) = plain::solve(x, previous, from, to, offset, friction);
        bed.solve([0.0, 1.0]);
        let off = bed.at(0).as_dvec3().distance(x).max(bed.previous(0).as_dvec3().distance(previous));
        // Where the way out is not unique, or static friction just holds, rounding decides.
        let (distance, ..) = Cone::at(from, to, 1.0).contact(p.as_dvec3());
        let certain = distance > -0.01;
        touched += u32::from(certain && bed.at(0) != p);
        let deep = f64::from(HOW.offset_m) - Cone::at(from, to, 1.0).distance((p + way).as_dvec3());
        assert!(!certain || off < 1e-6 + 1e-4 * deep.max(0.0), "case {case}: off by {off}, {deep} deep");
        let left = f64::from(HOW.offset_m) - Cone::at(from, to, 1.0).distance(bed.at(0).as_dvec3());
        assert!(left < 1e-5, "case {case}: {left} inside");
    }
    assert!(touched > 500, "{touched}");
}

#[test]
fn a_lone_sphere_and_one_that_holds_the_other_push_like_spheres() {
    for ends in [[0, 0], [0, 1], [1, 0]] {
        let spheres = [Vec4::new(0.1, 0.2, 0.3, 0.1), Vec4::new(0.12, 0.2, 0.3, 0.05)];
        let colliders = colliders(&spheres, &spheres, &[ends], false);
        let mut bed = Bed::new(&[Vec3::new(0.1, 0.25, 0.3)], &colliders);
        bed.find(&colliders);
        bed.solve([0.0, 1.0]);
        assert!(bed.at(0).distance(Vec3::new(0.1, 0.302, 0.3)) < 1e-6, "{ends:?} {}", bed.at(0));
    }
}

#[test]
fn the_centre_and_the_axis_have_a_way_out() {
    let spheres = [Vec4::new(0.0, 0.0, 0.0, 0.1), Vec4::new(0.0, 1.0, 0.0, 0.1)];
    let colliders = colliders(&spheres, &spheres, &[[0, 1]], false);
    let mut bed = Bed::new(&[Vec3::ZERO, Vec3::Y * 0.5, Vec3::Y], &colliders);
    bed.find(&colliders);
    bed.solve([0.0, 1.0]);
    for i in 0..3 {
        let p = bed.at(i);
        assert!((p.x.hypot(p.z) - 0.102).abs() < 1e-5, "{p}");
    }
}

#[test]
fn what_nothing_is_near_costs_no_pair_and_does_not_move() {
    let (positions, colliders) = crowd(64, 2);
    let far: Vec<Vec3> = positions.iter().map(|p| *p + Vec3::splat(3.0)).collect();
    let mut bed = Bed::new(&far, &colliders);
    bed.find(&colliders);
    bed.solve([0.0, 1.0]);
    // Four blocks of 16 and five capsules: room for all, and none used.
    assert_eq!(bed.contacts.tally(), ContactCounts { most_pairs: [0, 20], ..ContactCounts::default() });
    assert_eq!(bed.positions(), far);
}

#[test]
fn no_collider_makes_a_particle_that_is_not_finite() {
    let mut random = Random(77);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, -1e38, 1e-40, 1e20, 0.0];
    for case in 0..3_000 {
        let mut any =
            || if random.unit() < 0.5 { odd[(random.unit() * 7.99) as usize] } else { random.between(-1.0, 1.0) };
        let mut sphere = || Vec4::new(any(), any(), any(), any());
        let (from, to) = ([sphere(), sphere(), sphere()], [sphere(), sphere(), sphere()]);
        let colliders = colliders(&from, &to, &[[0, 1], [1, 2], [2, 2]], true);
        let positions: Vec<Vec3> = (0..40).map(|i| random.point(if i % 5 == 0 { 1e30 } else { 1.0 })).collect();
        let mut bed = Bed::new(&positions, &colliders);
        let far = if case % 3 == 0 { 1e30 } else { 0.1 };
        stir(&mut bed, far, case);
        bed.find(&colliders);
        bed.solve([0.0, 0.5]);
        bed.solve([0.5, 1.0]);
        assert!(bed.bits().iter().all(|b| f32::from_bits(*b).is_finite()), "case {case}: {from:?} {to:?}");
    }
}

#[test]
fn a_capsule_that_is_not_finite_is_ignored_and_counted_and_the_others_act() {
    let good = Vec4::new(0.0, 0.0, 0.0, 0.1);
    let bad = Vec4::new(f32::NAN, 0.0, 0.0, 0.1);
    let colliders = colliders(&[good, good], &[good, bad], &[[1, 1], [0, 1], [0, 0]], false);
    let mut bed = Bed::new(&[Vec3::Y * 0.05], &colliders);
    bed.find(&colliders);
    bed.solve([0.0, 1.0]);
    assert!(bed.at(0).distance(Vec3::Y * 0.102) < 1e-6);
    assert_eq!(bed.contacts.tally().ignored, 2);
}

#[test]
fn a_pinned_particle_never_moves() {
    let (positions, colliders) = crowd(200, 4);
    let mut bed = Bed::new(&positions, &colliders);
    (0..200).step_by(3).for_each(|i| bed.state.columns().w.set(i, 0.0));
    bed.find(&colliders);
    bed.solve([0.0, 1.0]);
    let moved = |i: &usize| bed.state.positions()[0][*i] != positions[*i].x;
    assert!(!(0..200).step_by(3).any(|i| moved(&i)) && (0..200).any(|i| moved(&i)));
}
