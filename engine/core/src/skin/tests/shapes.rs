//! What the blends do to shapes: the tube that is twisted and the one that is bent, against closed forms.

use std::f64::consts::{PI, TAU};

use toile_base::skeleton::{Joint, Twist};

use super::*;

const SIDES: usize = 96;

/// A ring of a unit tube at height `w` of the blend region, its bones 1 - w and w, the upper one as in `palette`.
fn ring(w: f64, upper: Affine3A, blend: Blend) -> Vec<Vec3> {
    let points: Vec<Vec3> = (0..SIDES)
        .map(|i| {
            let (s, c) = (TAU * i as f64 / SIDES as f64).sin_cos();
            Vec3::new(c as f32, w as f32, s as f32)
        })
        .collect();
    let weights = vec![SkinWeights { bones: [0, 1, 0, 0], weights: [1.0 - w as f32, w as f32, 0.0, 0.0] }; SIDES];
    let mut palette = [Affine3A::IDENTITY; BONES];
    palette[1] = upper;
    let job = SkinningJob::new(&points, &points, &weights).unwrap();
    let posed = posed(&job, blend, &palette);
    (0..SIDES).map(|v| posed.position(v)).collect()
}

/// Area of the ring twisted by `theta` over that at rest.
fn ring_area(theta: f64, w: f64, blend: Blend) -> f64 {
    let area = |p: &[Vec3]| -> f64 {
        let next = p.iter().cycle().skip(1);
        p.iter().zip(next).map(|(a, b)| f64::from(a.x) * f64::from(b.z) - f64::from(b.x) * f64::from(a.z)).sum()
    };
    area(&ring(w, Affine3A::from_rotation_y(theta as f32), blend)) / area(&ring(w, Affine3A::IDENTITY, blend))
}

fn volume(theta: f64, blend: Blend) -> f64 {
    const SLICES: usize = 200;
    let slice = |i: usize| ring_area(theta, (i as f64 + 0.5) / SLICES as f64, blend);
    (0..SLICES).map(slice).sum::<f64>() / SLICES as f64
}

#[test]
fn a_twisted_tube_loses_the_area_that_linear_blending_loses() {
    for theta in [45.0_f64, 90.0, 120.0, 180.0] {
        let lost = 1.0 - theta.to_radians().cos();
        for w in [0.0, 0.1, 0.25, 0.5, 0.8, 1.0] {
            let expected = 1.0 - 2.0 * w * (1.0 - w) * lost;
            let got = ring_area(theta.to_radians(), w, Blend::Linear);
            assert!((got - expected).abs() < 1e-5, "{theta} degrees, w {w}: {got} against {expected}");
        }
        let middle = (theta.to_radians() / 2.0).cos().powi(2);
        assert!((ring_area(theta.to_radians(), 0.5, Blend::Linear) - middle).abs() < 1e-5);
    }
}

#[test]
fn a_twisted_tube_loses_the_volume_that_linear_blending_loses_and_dual_quaternions_keep() {
    for (theta, expected) in [(90.0_f64, 2.0 / 3.0), (120.0, 0.5), (180.0, 1.0 / 3.0)] {
        let linear = volume(theta.to_radians(), Blend::Linear);
        assert!((linear - expected).abs() < 1e-4, "{theta} degrees: {linear} against {expected}");
        let dual = volume(theta.to_radians(), Blend::Dual);
        assert!((dual - 1.0).abs() < 1e-4, "{theta} degrees: {dual}");
    }
}

#[test]
fn a_split_forearm_keeps_its_volume_by_either_blend() {
    let forearm = Twist::towards(Joint::LeftWrist).unwrap();
    let of_a_stretch = 120.0_f64.to_radians() * f64::from(forearm.share(1));
    for blend in Blend::ALL {
        let kept = volume(of_a_stretch, blend);
        assert!(kept > 0.98, "{blend}: {kept}");
    }
}

/// Radii, across the bend, of the joint's ring of a tube that is bent about x by `theta`: the largest and the least.
fn hinge(theta: f64, blend: Blend) -> [f64; 2] {
    // The joint stands at the height of the ring: the bones turn about its middle.
    let middle = Vec3::Y * 0.5;
    let bend = Affine3A::from_translation(middle)
        * Affine3A::from_rotation_x(theta as f32)
        * Affine3A::from_translation(-middle);
    let ring = ring(0.5, bend, blend);
    // Seen along the axis of the hinge, whose points stay where they are.
    let radius =
        |i: usize| f64::from((ring[i] - middle).with_x(0.0).length()) / (TAU * i as f64 / SIDES as f64).sin().abs();
    let moving = (0..SIDES).filter(|i| i % (SIDES / 2) != 0);
    moving.map(radius).fold([0.0, f64::MAX], |[most, least], r| [most.max(r), least.min(r)])
}

#[test]
fn a_hinge_shrinks_under_linear_blending_and_keeps_its_radius_under_dual_quaternions() {
    for theta in [30.0, 60.0, 90.0, 120.0_f64].map(|d| d * PI / 180.0) {
        let [most, least] = hinge(theta, Blend::Linear);
        let expected = (theta / 2.0).cos();
        assert!((most - expected).abs() < 1e-5 && (least - expected).abs() < 1e-5, "{most}, {least}: {expected}");
        let [most, least] = hinge(theta, Blend::Dual);
        assert!((most - 1.0).abs() < 1e-5 && (least - 1.0).abs() < 1e-5, "{most}, {least}");
    }
}
