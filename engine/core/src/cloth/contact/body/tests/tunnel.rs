//! Nothing goes through a capsule, however fast either moves.

use glam::{DVec3, Vec4Swizzles};

use super::plain::Cone;
use super::*;

/// When, on the straight ways of a substep, the particle is first inside of the capsule; 1 if it never is.
fn impact(from: [Vec4; 2], to: [Vec4; 2], p: DVec3, q: DVec3) -> f64 {
    let inside = |t: &f64| Cone::at(from, to, *t).distance(p.lerp(q, *t)) < -1e-4;
    (1..400).map(|k| f64::from(k) / 400.0).find(inside).unwrap_or(1.0)
}

/// A capsule, its motion in a substep, and a particle outside of it with its way: (from, to, particle, way).
fn case(random: &mut Random, particle_speed: f32) -> Option<([Vec4; 2], [Vec4; 2], Vec3, Vec3)> {
    let ends = [random.point(0.15), random.point(0.15)];
    let radius = [random.between(0.03, 0.08), random.between(0.03, 0.08)];
    let from = [ends[0].extend(radius[0]), ends[1].extend(radius[1])];
    let shift = random.direction() * random.between(0.0, 0.08);
    let to = [from[0] + shift.extend(0.0), from[1] + (shift + random.direction() * 0.02).extend(0.0)];
    // Somewhere before the surface, on its way more or less towards the axis; the capsule's own way is any.
    let axis = ends[0].lerp(ends[1], random.unit());
    let p = axis + random.direction() * (radius[0].max(radius[1]) + random.between(0.0, 0.04));
    let way = (axis - p + random.point(0.06)).normalize() * random.between(0.0, particle_speed / 480.0);
    // An axis that does not turn by more than an ankle's at 80 mm a substep.
    let outside = Cone::at(from, to, 0.0).distance(p.as_dvec3()) > 1e-4 && ends[0].distance(ends[1]) > 0.1;
    outside.then_some((from, to, p, way))
}

#[test]
fn fast_particles_and_capsules_never_pass_through_each_other() {
    let mut random = Random(11);
    let (mut crossings, mut would_tunnel, mut lowest) = (0, 0, f64::MAX);
    for k in 0..60_000 {
        let Some((from, to, p, way)) = case(&mut random, 15.0) else { continue };
        let (a, b) = (p.as_dvec3(), (p + way).as_dvec3());
        let crossed = impact(from, to, a, b) < 1.0;
        let colliders = colliders(&from, &to, &[[0, 1]], false);
        let mut bed = Bed::new(&[p], &colliders);
        set(bed.state.columns().v, 0, Vec3A::from(way * 480.0));
        bed.find(&colliders);
        bed.send(0, p + way);
        bed.solve([0.0, 1.0]);
        let end = bed.at(0);
        let cone = Cone::at(from, to, 1.0);
        let left = cone.distance(end.as_dvec3());
        assert!(left > f64::from(HOW.offset_m) - 1e-5 || (!crossed && end == p + way), "case {k}: {left}");
        if !crossed {
            continue;
        }
        crossings += 1;
        would_tunnel += u32::from(cone.distance(b) > 0.0);
        // On the side where it came from: before the tangent plane of the impact as the capsule carried it along. The
        // quick and the turned may cut a little into the round.
        let t = impact(from, to, a, b);
        let (_, normal, along) = Cone::at(from, to, t).contact(a.lerp(b, t));
        let radius = cone.ra + (cone.rb - cone.ra) * along;
        let height = (end.as_dvec3() - cone.a.lerp(cone.b, along)).dot(normal);
        assert!(height > 0.75 * radius, "case {k}: {height} of {radius}, {from:?} {to:?} {p} {way}");
        lowest = lowest.min(height / radius);
    }
    eprintln!("{crossings} {would_tunnel} {lowest}");
    assert!(crossings > 3_000 && would_tunnel > 300, "{crossings} {would_tunnel}");
}

#[test]
fn a_particle_at_rest_is_taken_along_by_an_ankle_at_any_speed() {
    for mm in (5..=120).step_by(5) {
        for radius in [0.03, 0.05] {
            // From in front, resting against the ankle, a little off its middle.
            for (gap, off) in [(0.0, 0.0), (0.0, 0.01), (0.004, 0.02), (0.03, 0.005)] {
                let step = Vec3::new(0.0, 0.0, mm as f32 * 1e-3 * 4.0);
                let from = [Vec4::new(0.0, 0.5, 0.0, 0.07), Vec4::new(0.0, 0.1, 0.0, radius)];
                let to = [from[0], from[1] + step.extend(0.0)];
                let start = Vec3::new(off, 0.12, radius + 0.01 + HOW.offset_m + gap);
                let colliders = colliders(&from, &to, &[[0, 1]], false);
                let mut bed = Bed::new(&[start], &colliders);
                bed.find(&colliders);
                for s in 0..4 {
                    let p = bed.at(0);
                    bed.send(0, p);
                    bed.solve([s as f32 / 4.0, (s + 1) as f32 / 4.0]);
                    let t = (s + 1) as f32 / 4.0;
                    let centre = (from[1] + (to[1] - from[1]) * t).xyz();
                    let reached = centre.z > start.z - radius;
                    // In front of it still, or slid off sideways.
                    let p = bed.at(0);
                    let axis = centre.lerp(from[0].xyz(), ((p.y - 0.1) / 0.4).clamp(0.0, 1.0));
                    let kept = p.z > axis.z || p.x > radius;
                    assert!(!reached || kept, "{mm} mm a substep, radius {radius}, gap {gap}, off {off}, {s}: {p}");
                }
            }
        }
    }
}

#[test]
fn a_capsule_that_teleports_sweeps_nothing_along() {
    let from = [Vec4::new(0.0, 1.0, -1.0, 0.05)];
    let to = [Vec4::new(0.0, 1.0, 1.0, 0.05)];
    let colliders = colliders(&from, &to, &[[0, 0]], false);
    let mut bed = Bed::new(&[Vec3::Y, Vec3::new(0.0, 1.0, 0.97)], &colliders);
    bed.find(&colliders);
    bed.solve([0.0, 0.5]);
    bed.solve([0.5, 1.0]);
    assert_eq!(bed.at(0), Vec3::Y);
    let (x, previous) = (bed.at(1), bed.previous(1));
    assert!((x.z - 0.948).abs() < 1e-5 && x.distance(previous) < 1e-5, "{x} {previous}");
    assert_eq!(bed.contacts.tally().swept, 0);
}

#[test]
fn without_continuous_contact_what_is_fast_goes_through() {
    let ends = [Vec4::new(-0.1, 0.0, 0.0, 0.03), Vec4::new(0.1, 0.0, 0.0, 0.03)];
    let colliders = colliders(&ends, &ends, &[[0, 1]], false);
    let ends_at = |continuous: bool| {
        let mut bed = Bed::new(&[Vec3::new(0.0, 0.05, 0.0)], &colliders);
        bed.how.continuous = continuous;
        set(bed.state.columns().v, 0, Vec3A::NEG_Y * 12.0);
        bed.find(&colliders);
        bed.send(0, Vec3::new(0.0, -0.05, 0.0));
        bed.solve([0.0, 1.0]);
        (bed.at(0).y, bed.contacts.tally().swept)
    };
    assert_eq!(ends_at(false), (-0.05, 0));
    let (y, swept) = ends_at(true);
    assert!(y > 0.03 && swept == 1, "{y} {swept}");
}
