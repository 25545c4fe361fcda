//! Laws of the skin: what linear blending does to a twisted tube, an independent f64 twin, and what is refused.

use std::f64::consts::TAU;

use glam::{Affine3A, DAffine3, DVec3, Quat, Vec3};
use toile_assets::mesh::SkinWeights;
use toile_assets::skeleton::BONES;

use super::{LANES, SkinError, SkinningJob};

/// Agreement of the f32 kernel with the f64 twin (m), within 3 m of the origin.
const TWIN_TOLERANCE: f64 = 1e-6;

/// The twin: the plain sum of weighted matrices, in f64, one vertex after the other.
fn reference(positions: &[Vec3], normals: &[Vec3], weights: &[SkinWeights], palette: &[Affine3A]) -> Vec<[DVec3; 2]> {
    let wide = |m: &Affine3A| DAffine3 {
        matrix3: glam::Mat3::from(m.matrix3).as_dmat3(),
        translation: Vec3::from(m.translation).as_dvec3(),
    };
    let vertex = |((p, n), w): ((&Vec3, &Vec3), &SkinWeights)| {
        let sum: f64 = w.weights.iter().map(|w| f64::from(*w)).sum();
        let mut position = DVec3::ZERO;
        let mut normal = DVec3::ZERO;
        for (bone, weight) in w.bones.iter().zip(w.weights) {
            let matrix = wide(&palette[usize::from(*bone)]);
            position += matrix.transform_point3(p.as_dvec3()) * (f64::from(weight) / sum);
            normal += matrix.transform_vector3(n.as_dvec3()) * (f64::from(weight) / sum);
        }
        [position, normal.normalize_or_zero()]
    };
    positions.iter().zip(normals).zip(weights).map(vertex).collect()
}

/// A generator of our own: uniform in 0..1.
fn uniform(state: &mut u64) -> f32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f32 / (1 << 24) as f32
}

/// A crowd of vertices with one to four influences, and a palette of any rotations.
fn crowd(vertices: usize) -> (Vec<Vec3>, Vec<Vec3>, Vec<SkinWeights>, [Affine3A; BONES]) {
    let mut state = 11;
    let mut u = || uniform(&mut state);
    let positions = (0..vertices).map(|_| Vec3::new(u() - 0.5, 1.8 * u(), u() - 0.5)).collect();
    let normals =
        (0..vertices).map(|_| (Vec3::from_array(std::array::from_fn(|_| u())) - 0.5).normalize_or(Vec3::Y)).collect();
    let weights = (0..vertices)
        .map(|v| {
            let mut w = std::array::from_fn(|i| if i <= v % 4 { 0.05 + u() } else { 0.0 });
            let sum: f32 = w.iter().sum();
            w = w.map(|x| x / sum);
            SkinWeights { bones: std::array::from_fn(|_| (u() * BONES as f32) as u8), weights: w }
        })
        .collect();
    let palette = std::array::from_fn(|_| {
        let axis = (Vec3::from_array(std::array::from_fn(|_| u())) - 0.5).normalize_or(Vec3::Y);
        Affine3A::from_rotation_translation(
            Quat::from_axis_angle(axis, 2.0 * u()),
            (Vec3::from_array(std::array::from_fn(|_| u())) - 0.5) * 2.0,
        )
    });
    (positions, normals, weights, palette)
}

fn run(job: &SkinningJob, palette: &[Affine3A; BONES]) -> (Vec<Vec3>, Vec<Vec3>) {
    let mut positions = vec![Vec3::ZERO; job.vertices()];
    let mut normals = positions.clone();
    job.run(palette, &mut positions, &mut normals);
    (positions, normals)
}

#[test]
fn skin_agrees_with_its_f64_twin() {
    let (positions, normals, weights, palette) = crowd(4_001);
    let got = run(&SkinningJob::new(&positions, &normals, &weights).unwrap(), &palette);
    let truth = reference(&positions, &normals, &weights, &palette);
    let mut worst: f64 = 0.0;
    for (v, [p, n]) in truth.into_iter().enumerate() {
        worst = worst.max(got.0[v].as_dvec3().distance(p));
        assert!(got.1[v].as_dvec3().distance(n) < 1e-5, "normal {v}");
    }
    assert!(worst < TWIN_TOLERANCE, "worst position {worst} m");
}

#[test]
fn a_vertex_is_the_same_bits_whatever_its_neighbours_in_the_block() {
    let (positions, normals, weights, palette) = crowd(64);
    let all = run(&SkinningJob::new(&positions, &normals, &weights).unwrap(), &palette);
    for first in 1..2 * LANES {
        let job = SkinningJob::new(&positions[first..], &normals[first..], &weights[first..]).unwrap();
        let some = run(&job, &palette);
        assert_eq!(some.0, all.0[first..]);
        assert_eq!(some.1, all.1[first..]);
    }
}

/// Cross-section of a unit tube at height `w` of the blend region, its top twisted by `theta`: area over rest area.
fn ring_area(theta: f64, w: f64) -> f64 {
    const SIDES: usize = 96;
    let ring: Vec<Vec3> = (0..SIDES)
        .map(|i| {
            let (s, c) = (TAU * i as f64 / SIDES as f64).sin_cos();
            Vec3::new(c as f32, w as f32, s as f32)
        })
        .collect();
    let weights = vec![SkinWeights { bones: [0, 1, 0, 0], weights: [1.0 - w as f32, w as f32, 0.0, 0.0] }; SIDES];
    let mut palette = [Affine3A::IDENTITY; BONES];
    palette[1] = Affine3A::from_rotation_y(theta as f32);
    let (posed, _) = run(&SkinningJob::new(&ring, &ring, &weights).unwrap(), &palette);
    let area = |p: &[Vec3]| -> f64 {
        let next = p.iter().cycle().skip(1);
        p.iter().zip(next).map(|(a, b)| f64::from(a.x) * f64::from(b.z) - f64::from(b.x) * f64::from(a.z)).sum()
    };
    area(&posed) / area(&ring)
}

#[test]
fn a_twisted_tube_loses_the_area_that_linear_blending_loses() {
    for theta in [45.0_f64, 90.0, 120.0, 180.0] {
        let lost = 1.0 - theta.to_radians().cos();
        for w in [0.0, 0.1, 0.25, 0.5, 0.8, 1.0] {
            let expected = 1.0 - 2.0 * w * (1.0 - w) * lost;
            let got = ring_area(theta.to_radians(), w);
            assert!((got - expected).abs() < 1e-5, "{theta} degrees, w {w}: {got} against {expected}");
        }
        let middle = (theta.to_radians() / 2.0).cos().powi(2);
        assert!((ring_area(theta.to_radians(), 0.5) - middle).abs() < 1e-5);
    }
}

#[test]
fn a_twisted_tube_loses_the_volume_that_linear_blending_loses() {
    const SLICES: usize = 200;
    for (theta, expected) in [(90.0_f64, 2.0 / 3.0), (120.0, 0.5), (180.0, 1.0 / 3.0)] {
        let slice = |i: usize| ring_area(theta.to_radians(), (i as f64 + 0.5) / SLICES as f64);
        let volume = (0..SLICES).map(slice).sum::<f64>() / SLICES as f64;
        assert!((volume - expected).abs() < 1e-4, "{theta} degrees: {volume} against {expected}");
    }
}

#[test]
fn bad_skins_are_refused_with_the_vertex() {
    let (positions, normals, weights, _) = crowd(8);
    let with = |vertex: usize, bad: SkinWeights| {
        let mut weights = weights.clone();
        weights[vertex] = bad;
        SkinningJob::new(&positions, &normals, &weights).err()
    };
    let one = |w: f32| SkinWeights { bones: [1, 200, 0, 0], weights: [w, 0.0, 0.0, 0.0] };
    assert_eq!(with(5, one(1.0)), None, "a bone without weight is not looked at");
    assert_eq!(with(5, one(0.5)), Some(SkinError::BadWeights { vertex: 5, sum: 0.5 }));
    assert!(matches!(with(5, one(f32::NAN)), Some(SkinError::BadWeights { vertex: 5, .. })));
    let negative = SkinWeights { bones: [0; 4], weights: [1.5, -0.5, 0.0, 0.0] };
    assert!(matches!(with(2, negative), Some(SkinError::BadWeights { vertex: 2, .. })));
    let stray = SkinWeights { bones: [27, 0, 0, 0], weights: [1.0, 0.0, 0.0, 0.0] };
    assert_eq!(with(7, stray), Some(SkinError::NoSuchBone { vertex: 7, bone: 27 }));
    let short = SkinningJob::new(&positions[1..], &normals, &weights).err();
    assert_eq!(short, Some(SkinError::Lengths { positions: 7, normals: 8, weights: 8 }));
    let mut torn = positions.clone();
    torn[3].y = f32::INFINITY;
    assert_eq!(SkinningJob::new(&torn, &normals, &weights).err(), Some(SkinError::NotFinite(3)));
}

#[test]
fn a_collapsed_normal_is_zero_and_an_empty_skin_does_nothing() {
    let weights = [SkinWeights { bones: [0, 1, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] }];
    let mut palette = [Affine3A::IDENTITY; BONES];
    palette[1].matrix3 = -palette[1].matrix3;
    let (_, normals) = run(&SkinningJob::new(&[Vec3::X], &[Vec3::X], &weights).unwrap(), &palette);
    assert_eq!(normals[0], Vec3::ZERO);
    SkinningJob::new(&[], &[], &[]).unwrap().run(&palette, &mut [], &mut []);
}
