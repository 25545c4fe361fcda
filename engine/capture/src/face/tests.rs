use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use image::{Rgb, RgbImage};
use toile_assets::body::shape::Shapes;
use toile_base::body::{Region, Sex};
use toile_base::numeric::random::SplitMix64;
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::face_points::FACE_POINTS;

use super::head_mesh::middle;
use super::*;
use crate::render::look_at;

/// A head that no field of the prior made: sides of a head stretched, waves over it, another nose and chin, not quite symmetric.
pub(super) fn stranger(sex: Sex, seed: u64) -> Vec<DVec3> {
    let mut rng = SplitMix64::new(seed);
    let mut g = || f64::from(rng.gaussian());
    let base = Shapes::of(sex).base();
    let origin = middle(sex);
    let stretch = DVec3::new(1.0 + 0.04 * g(), 1.0 + 0.03 * g(), 1.0 + 0.04 * g());
    let (nose, chin) = (DVec3::new(0.0, 0.002 * g(), 0.003 * g()), DVec3::new(0.0, 0.003 * g(), 0.003 * g()));
    let waves: Vec<(DVec3, DVec3, f64)> = (0..6)
        .map(|_| {
            let along = DVec3::new(g(), g(), g()).normalize() * (TAU / (0.09 + 0.03 * g().abs()));
            (along, DVec3::new(g(), g(), g()) * 0.0008, TAU * g())
        })
        .collect();
    let tip = FaceLandmarks::new().on(&base.positions.iter().map(|p| p.as_dvec3() - origin).collect::<Vec<_>>());
    let bump = |p: DVec3, at: DVec3, wide: f64| (-p.distance_squared(at) / (2.0 * wide * wide)).exp();
    base.positions
        .iter()
        .map(|p| {
            let p = p.as_dvec3() - origin;
            let mut out = p * stretch + nose * bump(p, tip[30], 0.014) + chin * bump(p, tip[8], 0.022);
            let sided = DVec3::new(p.x.abs() + 0.12 * p.x, p.y, p.z);
            for (along, by, phase) in &waves {
                let side = DVec3::new(if p.x < 0.0 { -1.0 } else { 1.0 } * (p.x.abs() / 0.02).min(1.0), 1.0, 1.0);
                out += *by * side * (along.dot(sided) + phase).sin();
            }
            out
        })
        .collect()
}

/// Cameras before a face at these angles (degrees), 1.2 m off.
pub(super) fn cameras(angles: &[f64]) -> Vec<CalibratedCamera> {
    let at = |(k, a): (usize, &f64)| {
        let (s, c) = a.to_radians().sin_cos();
        look_at(&format!("cam{k}"), [1200, 1600], 3_600.0, [DVec3::new(1.2 * s, 0.05, 1.2 * c), DVec3::ZERO], DVec3::Y)
    };
    angles.iter().enumerate().map(at).collect()
}

/// Points with noise, where they can be seen at all.
pub(super) fn marked(
    truth: &[DVec3],
    normals: &[DVec3],
    rig: &[CalibratedCamera],
    sigma: f64,
    seed: u64,
) -> Vec<FaceView> {
    let mut rng = SplitMix64::new(seed);
    rig.iter()
        .map(|camera| {
            let points = std::array::from_fn(|i| {
                let seen = normals[i].dot((camera.position() - truth[i]).normalize()) > 0.05;
                let noise = DVec2::new(f64::from(rng.gaussian()), f64::from(rng.gaussian())) * sigma;
                camera.pixel(truth[i]).filter(|_| seen).map(|p| p + noise)
            });
            FaceView { camera: camera.clone(), points, outlines: Vec::new(), sigma_px: sigma }
        })
        .collect()
}

pub(super) struct Case {
    pub truth: Vec<DVec3>,
    pub views: Vec<FaceView>,
    pub face: Vec<usize>,
}

pub(super) fn case(sex: Sex, seed: u64, angles: &[f64]) -> Case {
    let turn = DQuat::from_rotation_y(0.1) * DQuat::from_rotation_x(-0.06);
    let truth: Vec<DVec3> = stranger(sex, seed).iter().map(|p| turn * *p + DVec3::new(0.01, -0.02, 0.015)).collect();
    let base = Shapes::of(sex).base();
    let landmarks = FaceLandmarks::new();
    let normal = |p: &SurfacePoint| {
        let [a, b, c] = p.corners.map(|v| truth[v as usize]);
        (b - a).cross(c - a).normalize()
    };
    let normals: Vec<DVec3> = landmarks.points.iter().map(normal).collect();
    let views = marked(&landmarks.on(&truth), &normals, &cameras(angles), 1.0, seed);
    let origin = middle(sex);
    let is_face = |v: &usize| {
        let p = base.positions[*v].as_dvec3() - origin;
        base.regions[*v] == Region::Head && p.z > 0.02 && p.y < 0.09 && p.y > -0.06
    };
    Case { truth, views, face: (0..base.positions.len()).filter(is_face).collect() }
}

/// Mean distance of the face's vertices from the truth (mm); one photograph cannot tell a head's size, so that it is taken out.
pub(super) fn off(case: &Case, placed: &[DVec3], sized: bool) -> f64 {
    let mean = |of: &[DVec3]| case.face.iter().map(|v| of[*v]).sum::<DVec3>() / case.face.len() as f64;
    let (a, b) = (mean(placed), mean(&case.truth));
    let spread = |of: &[DVec3], m: DVec3| case.face.iter().map(|v| of[*v].distance_squared(m)).sum::<f64>().sqrt();
    let scale = if sized { spread(&case.truth, b) / spread(placed, a) } else { 1.0 };
    let moved = |v: usize| if sized { (placed[v] - a) * scale + b } else { placed[v] };
    1e3 * case.face.iter().map(|v| moved(*v).distance(case.truth[*v])).sum::<f64>() / case.face.len() as f64
}

#[test]
fn all_points_are_on_the_head_left_and_right_alike() {
    let landmarks = FaceLandmarks::new();
    assert_eq!(landmarks.points.len(), FACE_POINTS);
    for sex in Sex::ALL {
        let positions: Vec<DVec3> = Shapes::of(sex).base().positions.iter().map(|p| p.as_dvec3()).collect();
        let at = landmarks.on(&positions);
        assert!(at[36].distance(at[45] * DVec3::new(-1.0, 1.0, 1.0)) < 1e-3, "{} {}", at[36], at[45]);
        assert!(at[0].x < at[16].x && at[30].z > at[8].z && at[19].y > at[41].y && at[8].y < at[57].y);
    }
}

#[test]
fn a_strangers_head_comes_back_from_three_photographs_and_from_one() {
    let (mut three, mut one, mut before) = (Vec::new(), Vec::new(), Vec::new());
    for (k, sex) in [Sex::Female, Sex::Male, Sex::Female, Sex::Male].into_iter().enumerate() {
        let seed = 900 + k as u64;
        let views = case(sex, seed, &[-35.0, 0.0, 35.0]);
        let head = adapt(&views.views, sex).unwrap();
        three.push(off(&views, &head.placed, false));
        let single = case(sex, seed, &[0.0]);
        let head = adapt(&single.views, sex).unwrap();
        one.push(off(&single, &head.placed, true));
        let plain: Vec<DVec3> = Shapes::of(sex).base().positions.iter().map(|p| p.as_dvec3()).collect();
        before.push(off(&single, &plain, true));
    }
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    println!(
        "before {before:.2?}, three {three:.2?} mm (mean {:.2}), one {one:.2?} mm (mean {:.2})",
        mean(&three),
        mean(&one)
    );
    assert!(mean(&three) <= 2.0 && mean(&one) <= 4.0);
    assert!(mean(&one) < mean(&before));
}

#[test]
fn points_of_no_face_are_refused() {
    let mut wrong = case(Sex::Female, 3, &[0.0]);
    let mut rng = SplitMix64::new(5);
    for p in wrong.views[0].points.iter_mut() {
        *p = Some(DVec2::new(f64::from(rng.uniform()) * 1200.0, f64::from(rng.uniform()) * 1600.0));
    }
    let said = adapt(&wrong.views, Sex::Female).unwrap_err().to_string();
    assert!(said.contains("any head that stands before these cameras") && !said.contains('\n'), "{said}");
}

#[test]
fn the_photograph_comes_back_from_the_texture() {
    let views = case(Sex::Female, 12, &[-35.0, 0.0, 35.0]);
    let head = adapt(&views.views, Sex::Female).unwrap();
    // A photograph of one colour gives a head of that colour, and the skin's.
    let photographs: Vec<RgbImage> = (0..3).map(|_| RgbImage::from_pixel(1200, 1600, Rgb([200, 150, 120]))).collect();
    let found = texture(&head, &views.views, &photographs);
    assert_eq!(found.skin, [200, 150, 120]);
    assert!(found.seen > 0.3 && found.seen < 0.95, "{}", found.seen);
    assert!(found.picture.pixels().all(|p| p.0 == [200, 150, 120]));
}
