use glam::{DMat3, DVec3, Quat};
use toile_assets::body::{En, Wanted};
use toile_base::body::{Body, Sex};
use toile_base::skeleton::{Joint, Pose};
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::masks::Mask;
use toile_track::fit::measuring::MEASURES;

use super::measured::opposite;
use super::view::CameraSilhouette;
use super::*;
use crate::render::look_at;
use toile_pose::depth_buffer::DepthBuffer;

/// Cameras round the origin at these angles (degrees).
fn cameras(angles: &[f64]) -> Vec<CalibratedCamera> {
    let camera = |(k, a): (usize, &f64)| {
        let (s, c) = a.to_radians().sin_cos();
        let from = DVec3::new(2.6 * s, 1.1, 2.6 * c);
        look_at(&format!("cam{k}"), [480, 640], 620.0, [from, DVec3::new(0.0, 0.9, 0.0)], DVec3::Y)
    };
    angles.iter().enumerate().map(camera).collect()
}

/// Each vertex by the bones of its weights, arms lowered.
fn standing(body: &Body, turned: f32) -> Vec<DVec3> {
    moved(body, turned, 0.0)
}

/// The same with the left arm lifted, the right elbow bent and the left knee raised so far (rad).
fn moved(body: &Body, turned: f32, by: f32) -> Vec<DVec3> {
    let mut pose = Pose::rest(&body.skeleton);
    for (shoulder, side) in [(Joint::LeftShoulder, 1.0), (Joint::RightShoulder, -1.0)] {
        pose.local[shoulder.index()] = Quat::from_rotation_z(-0.3 * side);
    }
    pose.local[Joint::LeftShoulder.index()] = Quat::from_rotation_z(by - 0.3);
    pose.local[Joint::RightElbow.index()] = Quat::from_rotation_x(-by);
    pose.local[Joint::LeftHip.index()] = Quat::from_rotation_x(-0.5 * by);
    pose.local[Joint::LeftKnee.index()] = Quat::from_rotation_x(0.5 * by);
    let mut place = [glam::Vec3::ZERO; toile_base::skeleton::JOINTS];
    let mut spin = [Quat::IDENTITY; toile_base::skeleton::JOINTS];
    for joint in Joint::ALL {
        let i = joint.index();
        match joint.parent().map(Joint::index) {
            None => (place[i], spin[i]) = (pose.root, pose.local[i]),
            Some(p) => {
                place[i] = place[p] + spin[p] * (body.skeleton.at(joint) - body.skeleton.rest[p]);
                spin[i] = spin[p] * pose.local[i];
            }
        }
    }
    let by = |(p, weights): (&glam::Vec3, &toile_base::mesh::SkinWeights)| {
        let parts = weights.iter().map(|(bone, w)| {
            let j = toile_base::skeleton::bone_joint(bone as usize).map_or(0, Joint::index);
            w * (place[j] + spin[j] * (*p - body.skeleton.rest[j]))
        });
        (Quat::from_rotation_y(turned) * parts.sum::<glam::Vec3>()).as_dvec3()
    };
    body.mesh.positions.iter().zip(&body.weights).map(by).collect()
}

fn mask(camera: &CalibratedCamera, positions: &[DVec3], triangles: &[[u32; 3]]) -> Mask {
    let mut buffer = DepthBuffer::new(camera.size, 2.0);
    buffer.draw(camera, positions, triangles);
    let [width, height] = camera.size.map(|s| s as usize);
    let at = |x: usize, y: usize| f32::from(u8::from(buffer.triangle[y * buffer.width + x] != u32::MAX));
    let coverage = |i: usize| {
        let (x, y) = (2 * (i % width), 2 * (i / width));
        (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4.0
    };
    Mask { width, height, coverage: (0..width * height).map(coverage).collect() }
}

fn masks(rig: &[CalibratedCamera], positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Mask> {
    rig.iter().map(|c| mask(c, positions, triangles)).collect()
}

fn views<'a>(rig: &'a [CalibratedCamera], masks: &'a [Mask]) -> Vec<SilhouetteView<'a>> {
    rig.iter().zip(masks).map(|(camera, mask)| SilhouetteView { camera, mask }).collect()
}

#[test]
fn a_body_of_the_own_family_comes_back_from_four_silhouettes() {
    let wanted = Wanted::<En>::new().with(En::Stature, 1.71).with(En::WaistGirth, 0.79).with(En::HipGirth, 1.03);
    let truth = toile_assets::body::fitted(Sex::Female, &wanted).unwrap();
    // Turned by half a radian: the fit is not told which way a person faces.
    let positions = standing(&truth.body, 0.5);
    let rig = cameras(&[0.0, 90.0, 180.0, 270.0]);
    let masks = masks(&rig, &positions, &truth.body.mesh.triangles);
    let found = measure(&views(&rig, &masks), &SilhouetteOptions::default()).unwrap();
    println!(
        "agreement {:.3}, off {:.2} mm, woman {:.2}, {} stretches",
        found.agreement,
        1e3 * found.off,
        found.woman,
        found.stretches
    );
    for ((name, kind, _), e) in MEASURES.iter().zip(&found.measures) {
        let of = kind.of(&truth.readings);
        println!(
            "{name:16} {:7.1} found {:7.1} +- {:.1} off {:+.1} mm",
            1e3 * of,
            1e3 * e.value,
            1e3 * e.sigma,
            1e3 * (e.value - of)
        );
        assert!((e.value - of).abs() < 0.012, "{name}");
    }
    assert!(found.agreement > 0.975 && found.woman > 0.5);
    let off: f64 = found.standing.iter().zip(&positions).map(|(a, b)| a.distance(*b)).sum::<f64>();
    let off = off / positions.len() as f64;
    assert!(off < 0.008, "vertices lie {off} m from where they were");
    // The same input gives the same bits, and a sex that is ruled out changes none.
    let woman = SilhouetteOptions { sex: Some(Sex::Female), ..SilhouetteOptions::default() };
    let again = measure(&views(&rig, &masks), &woman).unwrap();
    assert_eq!(again.measures, found.measures);
    // Two pairs of cameras see two outlines: a note for the user.
    let told = "the same outline: cam0 and cam2, cam1 and cam3. Ways of looking 45 degrees apart";
    assert!(found.notes.iter().any(|n| n.contains(told)), "{:?}", found.notes);
}

#[test]
fn cameras_that_stand_opposite_each_other_are_named_where_they_leave_few_ways_of_looking() {
    let said = |angles: &[f64]| {
        let mask = Mask { width: 64, height: 64, coverage: vec![0.0; 64 * 64] };
        let seen: Vec<CameraSilhouette> =
            cameras(angles).iter().map(|c| CameraSilhouette::new(&mask, c, DMat3::IDENTITY)).collect();
        opposite(&seen)
    };
    assert!(said(&[0.0, 90.0, 180.0]).is_some_and(|n| n.contains("60 degrees apart")));
    // More pairs than cameras.
    assert!(said(&[0.0, 1.0, 180.0, 181.0, 179.0]).is_some_and(|n| n.contains("cam1 and cam4")));
    let eight: Vec<f64> = (0..8).map(|k| 45.0 * f64::from(k)).collect();
    for few_opposite in [&[0.0, 90.0, 225.0, 315.0][..], &[0.0, 90.0], &[0.0, 120.0, 240.0], &eight] {
        assert_eq!(said(few_opposite), None, "{few_opposite:?}");
    }
}

#[test]
fn a_moving_person_is_followed_by_silhouettes() {
    let wanted = Wanted::<En>::new().with(En::Stature, 1.68).with(En::WaistGirth, 0.81).with(En::HipGirth, 1.02);
    let truth = toile_assets::body::fitted(Sex::Female, &wanted).unwrap();
    let triangles = &truth.body.mesh.triangles;
    let rig = cameras(&[0.0, 90.0, 180.0, 270.0]);
    let film = |frame: usize| {
        let positions = moved(&truth.body, 0.3 + 0.03 * frame as f32, 0.09 * frame as f32);
        let masks = masks(&rig, &positions, triangles);
        (positions, masks)
    };
    let options = SilhouetteOptions { sex: Some(Sex::Female), ..SilhouetteOptions::default() };
    let first = measure(&views(&rig, &film(0).1), &options).unwrap();
    let mut follower = BodyFollower::new(&first);
    let mut worst = 0.0f64;
    for frame in 1..=8 {
        let (positions, masks) = film(frame);
        let mut seen = views(&rig, &masks);
        match frame {
            // One camera sees no person; then all but one do, and the body stands where it was.
            4 => drop(seen.remove(1)),
            6 => seen.truncate(1),
            _ => {}
        }
        let found = follower.next(&seen, &[]);
        assert_eq!(found.found, frame != 6);
        if found.found {
            let off: f64 = found.standing.iter().zip(&positions).map(|(a, b)| a.distance(*b)).sum();
            worst = worst.max(off / positions.len() as f64);
            assert!(found.agreement > 0.96, "{frame}: {:.3}", found.agreement);
        }
    }
    println!("vertices lie {:.1} mm from where they are at most, in the mean of a frame", 1e3 * worst);
    assert!(worst < 0.010, "{worst}");
    // What is no person moves nothing: the same upside down.
    let (_, mut masks) = film(8);
    masks.iter_mut().for_each(|mask| mask.coverage.reverse());
    assert!(!follower.next(&views(&rig, &masks), &[]).found);
}

#[test]
fn what_no_body_made_is_refused_in_a_sentence() {
    let rig = cameras(&[0.0, 90.0]);
    let woman = SilhouetteOptions { sex: Some(Sex::Female), ..SilhouetteOptions::default() };
    let said = |masks: &[Mask]| measure(&views(&rig, masks), &woman).unwrap_err().to_string();
    let square = |x: std::ops::Range<usize>, y: std::ops::Range<usize>| {
        let coverage = |i: usize| f32::from(u8::from(x.contains(&(i % 480)) && y.contains(&(i / 480))));
        Mask { width: 480, height: 640, coverage: (0..480 * 640).map(coverage).collect() }
    };
    let low = square(200..260, 300..350);
    assert!(said(&[low.clone(), low]).contains("which no standing person is"));
    let box_like = square(140..340, 100..540);
    assert!(said(&[box_like.clone(), box_like]).contains("share only"));
    let one = measure(&views(&rig, &[square(140..340, 100..540)]), &SilhouetteOptions::default());
    assert!(one.unwrap_err().to_string().contains("at least 2 are needed"));
}
