//! Coulomb's law, and that a push is no speed.

use super::*;

const DT: f32 = 1.0 / 480.0;
const GRAVITY: f32 = 9.81;

/// A particle on a plane under gravity: how far it went down the slope of `tangent` in `seconds`, from speed `v` down it.
fn slope(tangent: f32, v: f32, seconds: f32) -> f32 {
    let up = Vec3::new(tangent, 1.0, 0.0).normalize();
    let down = Vec3::new(up.y, -up.x, 0.0);
    let mut colliders = colliders(&[], &[], &[], false);
    colliders.set_planes(&[up.extend(0.0)]).unwrap();
    let mut bed = Bed::new(&[up * HOW.offset_m], &colliders);
    let mut velocity = down * v;
    for k in 0..(seconds / DT) as u32 {
        if k % 4 == 0 {
            set(bed.state.columns().v, 0, velocity.into());
            bed.find(&colliders);
        }
        velocity.y -= GRAVITY * DT;
        let p = bed.at(0);
        bed.send(0, p + velocity * DT);
        bed.solve([(k % 4) as f32 / 4.0, (k % 4 + 1) as f32 / 4.0]);
        velocity = (bed.at(0) - bed.previous(0)) / DT;
    }
    bed.at(0).dot(down)
}

#[test]
fn a_slope_holds_below_the_static_angle_and_not_beyond() {
    assert!(slope(HOW.friction_static * 0.98, 0.0, 1.0).abs() < 1e-5);
    // Beyond it the kinetic coefficient brakes: s = g (sin - mu cos) t^2 / 2.
    let tangent = HOW.friction_static * 1.05;
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let exact = 0.5 * GRAVITY * cosine * (tangent - HOW.friction_kinetic);
    let went = slope(tangent, 0.0, 1.0);
    assert!((went / exact - 1.0).abs() < 0.01, "{went} m instead of {exact} m");
}

#[test]
fn sliding_on_the_level_stops_after_coulombs_distance() {
    let v = 1.0;
    let exact = v * v / (2.0 * HOW.friction_kinetic * GRAVITY);
    let went = slope(0.0, v, 1.0);
    assert!((went / exact - 1.0).abs() < 0.02, "{went} m instead of {exact} m");
}

#[test]
fn below_the_static_angle_what_slides_beyond_the_kinetic_one_goes_on_until_it_sticks() {
    // tan between kinetic and static: at speed it keeps sliding and gains, at rest it holds.
    let tangent = 0.35;
    assert!(slope(tangent, 0.0, 1.0).abs() < 1e-5);
    assert!(slope(tangent, 1.0, 0.5) > 0.5);
}

#[test]
fn a_particle_found_inside_comes_out_without_speed() {
    let sphere = [Vec4::new(0.0, 0.0, 0.0, 0.1)];
    let colliders = colliders(&sphere, &sphere, &[[0, 0]], true);
    let mut bed = Bed::new(&[Vec3::new(0.0, 0.05, 0.0), Vec3::new(0.7, -0.2, 0.0)], &colliders);
    bed.find(&colliders);
    bed.solve([0.0, 1.0]);
    assert!((bed.at(0).y - 0.102).abs() < 1e-6 && (bed.at(1).y - 0.002).abs() < 1e-6);
    for i in 0..2 {
        assert!(bed.at(i).distance(bed.previous(i)) < 1e-6, "{} {}", bed.at(i), bed.previous(i));
    }
}

#[test]
fn an_impact_takes_the_speed_into_the_surface_and_no_more() {
    let colliders = colliders(&[], &[], &[], true);
    let mut bed = Bed::new(&[Vec3::new(0.0, 0.004, 0.0)], &colliders);
    bed.how.friction_static = 0.0;
    bed.how.friction_kinetic = 0.0;
    bed.find(&colliders);
    bed.send(0, Vec3::new(0.001, -0.003, 0.0));
    bed.solve([0.0, 1.0]);
    let moved = bed.at(0) - bed.previous(0);
    assert!((bed.at(0).y - 0.002).abs() < 1e-7 && (moved - Vec3::new(0.001, -0.002, 0.0)).length() < 1e-7, "{moved}");
}

/// Carried along by a capsule for a tenth of a second; where the particle ends relative to where the surface took it.
fn carried(turn: f32, shift: Vec3, load: f32) -> (Vec3, Vec3) {
    let (steps, radius) = (12, 0.05);
    let rotated = |k: f32| glam::Quat::from_rotation_z(turn * k / steps as f32);
    let ends =
        |k: f32| [-0.2, 0.2].map(|x| (rotated(k) * Vec3::new(x, 0.0, 0.0) + shift * k / steps as f32).extend(radius));
    let top = Vec3::new(0.1, radius + HOW.offset_m, 0.0);
    let mut bed = Bed::new(&[top], &colliders(&ends(0.0), &ends(0.0), &[[0, 1]], false));
    for k in 0..steps {
        let colliders = colliders(&ends(k as f32), &ends(k as f32 + 1.0), &[[0, 1]], false);
        bed.find(&colliders);
        for s in 0..4 {
            let p = bed.at(0);
            // Held against the surface wherever that has turned to.
            let down = rotated(k as f32 + s as f32 / 4.0) * -Vec3::Y;
            bed.send(0, p + down * load);
            bed.solve([s as f32 / 4.0, (s + 1) as f32 / 4.0]);
        }
    }
    (bed.at(0), rotated(steps as f32) * top + shift)
}

#[test]
fn a_moving_surface_carries_what_is_pressed_on_it() {
    for (turn, shift) in [(0.0, Vec3::new(0.05, 0.02, 0.03)), (0.3, Vec3::ZERO), (-0.3, Vec3::new(0.0, 0.0, 0.04))] {
        let (at, with) = carried(turn, shift, 0.01);
        assert!(at.distance(with) < 1e-3, "turned {turn}, shifted {shift}: {at} instead of {with}");
    }
    let (at, with) = carried(0.0, Vec3::new(0.3, 0.0, 0.0), 0.001);
    assert!(at.distance(with) > 0.1, "a light load slips: {at}, surface {with}");
}
