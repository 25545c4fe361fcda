//! Shoppers on whom the garment is drawn, and pictures that stay plain.

use std::sync::OnceLock;

use glam::{Affine3A, Mat3, Quat, Vec3};
use toile_assets::drafting;
use toile_assets::scene::{SHOPPER, shopper};
use toile_base::frame::{DepthFrame, Intrinsics, Joints};
use toile_base::garment::Garment;
use toile_base::skeleton::{BONES, JOINTS, Joint};
use toile_engine::body::{JointFrames, palette};
use toile_engine::cloth::Settings;
use toile_engine::world::{Snapshot, World};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::lens::BrownConrady;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::source::live::ColourImage;

use super::repose::Repose;
use super::*;
use crate::image::Size;

/// A dressed shopper, and the camera that sees them.
struct DressedPicture {
    model: std::sync::Arc<OwnPictureModel>,
    snapshot: Snapshot,
    joints: Joints,
    camera: ColourCamera,
    picture: ColourImage,
}

const SIZE: Size = Size::new(320, 240);

/// The dress, put on once for all tests.
static DRESS: OnceLock<Garment> = OnceLock::new();

fn scene() -> DressedPicture {
    let body = toile_assets::body::build(SHOPPER.0, &SHOPPER.1).unwrap();
    let dress = DRESS.get_or_init(|| drafting::package("strap-dress").unwrap().dress("38", &body).unwrap()).clone();
    let (mut world, mut reader) =
        World::new(body.clone(), &toile_assets::rig::fit(&body), vec![dress], Settings::default()).unwrap();
    let pose = shopper(&body.skeleton, 0.5);
    let first = Joints::seen(0, JointFrames::new(&body.skeleton, &pose).position);
    world.dress(&first);
    (0..30).for_each(|_| world.step(&first));
    let snapshot = reader.latest().clone();
    let joints = Joints::seen(1, JointFrames::new(&body.skeleton, &snapshot.pose).position);
    let intrinsics = Intrinsics { width: 320, height: 240, fx: 280.0, fy: 280.0, cx: 159.5, cy: 119.5 };
    let rotation = Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0));
    let place = Affine3A::from_mat3_translation(rotation, Vec3::new(0.0, 0.9, 3.0));
    let picture = ColourImage { width: 320, height: 240, rgb: [150, 140, 130].repeat(320 * 240) };
    let model = OwnPictureModel::of(world.body(), world.garments());
    DressedPicture { model, snapshot, joints, camera: ColourCamera::pinhole(intrinsics, place), picture }
}

impl DressedPicture {
    fn input(&self) -> OwnPictureInput<'_> {
        let Self { picture, camera, joints, .. } = self;
        OwnPictureInput { picture, camera: Some(camera), joints, depth: None, mask: None, colours: &[] }
    }

    /// The outcome of the third of equal pictures: by then the shopper is steady.
    fn draw(&self, mirror: &mut OwnPicture, input: &OwnPictureInput<'_>) -> Result<(), Plain> {
        let options = OwnPictureOptions::of(SIZE);
        (0..2).for_each(|_| _ = mirror.draw(&self.model, &self.snapshot, input, &options));
        mirror.draw(&self.model, &self.snapshot, input, &options)
    }

    fn with(&self, change: impl FnOnce(&mut Joints)) -> Joints {
        let mut joints = self.joints;
        change(&mut joints);
        joints
    }
}

/// Pixels that are not the plain picture's.
fn painted(mirror: &OwnPicture) -> usize {
    mirror.picture().1.as_chunks::<3>().0.iter().filter(|p| **p != [150, 140, 130]).count()
}

#[test]
fn the_shopper_wears_the_garment_in_the_picture() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    assert_eq!(scene.draw(&mut mirror, &scene.input()), Ok(()));
    let cloth = mirror.shown().filter(|is| *is).count();
    assert!((2_000..20_000).contains(&cloth), "{cloth} pixels of cloth");
    let all = painted(&mirror);
    assert!(all >= cloth && all < cloth + 12_000, "{cloth} of cloth, {all} with its shadow");
    // The corners are far from the shopper.
    let bytes = mirror.picture().1;
    assert_eq!(bytes[..3], [150, 140, 130]);
    // Red as it is where it is: the same in other colours is another.
    let red: Vec<u8> = bytes.to_vec();
    let input = OwnPictureInput { colours: &[[0.1, 0.2, 0.9]], ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Ok(()));
    assert!(red != mirror.picture().1);
    mirror.forget();
    assert!(mirror.picture().1.iter().all(|b| *b == 0));
}

#[test]
fn a_hidden_hip_and_shoulder_keep_the_garment() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    assert_eq!(scene.draw(&mut mirror, &scene.input()), Ok(()));
    let whole: Vec<bool> = mirror.shown().collect();
    let hidden = scene.with(|j| {
        [Joint::LeftHip, Joint::RightShoulder].iter().for_each(|joint| j.at_mut(*joint).confidence = 0.0);
    });
    assert_eq!(scene.draw(&mut mirror, &OwnPictureInput { joints: &hidden, ..scene.input() }), Ok(()));
    let other = mirror.shown().zip(&whole).filter(|(now, then)| now != *then).count();
    assert!(other < 60, "{other} pixels are other ones");
}

#[test]
fn pictures_without_the_shopper_stay_plain() {
    let scene = scene();
    let absent = Joints::absent(1);
    let far = scene.with(|j| j.joints.iter_mut().for_each(|j| j.position.x += 1.5));
    let long = scene.with(|j| j.at_mut(Joint::LeftWrist).position += Vec3::new(0.5, 0.2, 0.0));
    let flat = scene.with(|j| j.joints.iter_mut().for_each(|j| j.position.y *= 0.5));
    let spun = scene.with(|j| j.joints.iter_mut().for_each(|j| j.position = Vec3::splat(f32::NAN)));
    let cut = scene.with(|j| {
        [Joint::LeftHip, Joint::RightHip].iter().for_each(|hip| j.at_mut(*hip).confidence = 0.0);
    });
    for (joints, why) in [
        (absent, Plain::Nobody),
        (far, Plain::Unsure),
        (long, Plain::Unsure),
        (flat, Plain::Unsure),
        (spun, Plain::Nobody),
        (cut, Plain::Nobody),
    ] {
        let mut mirror = OwnPicture::new();
        let input = OwnPictureInput { joints: &joints, ..scene.input() };
        assert_eq!(scene.draw(&mut mirror, &input), Err(why));
        assert_eq!(painted(&mirror), 0, "{why:?} shows the picture as it came");
    }
}

#[test]
fn pictures_that_are_none_are_black_and_cameras_that_are_not_known_stay_plain() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    let cut = ColourImage { rgb: scene.picture.rgb[..1_000].to_vec(), ..scene.picture.clone() };
    let huge = ColourImage { width: 16_000, height: 16_000, rgb: Vec::new() };
    for picture in [cut, huge, ColourImage::default()] {
        let input = OwnPictureInput { picture: &picture, ..scene.input() };
        assert_eq!(scene.draw(&mut mirror, &input), Err(Plain::NoPicture));
        assert!(mirror.picture().1.iter().all(|b| *b == 0));
    }
    let input = OwnPictureInput { camera: None, ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Err(Plain::UnknownCamera));
    let lens = BrownConrady { k: [f32::NAN; 6], p: [0.0; 2], centre: [0.0; 2], widest: 1.0 };
    let broken = ColourCamera { lens: Some(lens), ..scene.camera };
    let input = OwnPictureInput { camera: Some(&broken), ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Err(Plain::UnknownCamera));
    // Black, with a shopper in it all the same: cloth in the dark is dark.
    let black = ColourImage { rgb: vec![0; 320 * 240 * 3], ..scene.picture.clone() };
    let input = OwnPictureInput { picture: &black, ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Ok(()));
    assert!(mirror.picture().1.iter().all(|b| *b < 90), "{:?}", mirror.picture().1.iter().max());
}

#[test]
fn a_camera_that_changes_its_resolution_shows_the_garment_where_it_was() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    let options = OwnPictureOptions::of(SIZE);
    scene.draw(&mut mirror, &scene.input()).unwrap();
    let before: Vec<bool> = mirror.shown().collect();
    for [width, height] in [[640, 480], [160, 120], [320, 240]] {
        let rgb = [150, 140, 130].repeat(width as usize * height as usize);
        let picture = ColourImage { width, height, rgb };
        let input = OwnPictureInput { picture: &picture, ..scene.input() };
        assert_eq!(mirror.draw(&scene.model, &scene.snapshot, &input, &options), Ok(()));
        let differ = before.iter().zip(mirror.shown()).filter(|(a, b)| **a != *b).count();
        assert!(differ < 120, "{width} x {height}: {differ} pixels elsewhere");
    }
}

#[test]
fn a_wall_and_low_odds_deny_the_body() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    let depth = |mm: u16| DepthFrame {
        time_ns: 1,
        intrinsics: scene.camera.intrinsics,
        camera_to_world: scene.camera.camera_to_world,
        depth_mm: vec![mm; 320 * 240].into(),
    };
    // A picture of a person on a wall, or on the shirt of a person who stands nearer and is not the fitted one.
    for (mm, outcome) in [(3_900, Err(Plain::Unsure)), (0, Ok(()))] {
        let depth = depth(mm);
        let input = OwnPictureInput { depth: Some(&depth), ..scene.input() };
        assert_eq!(scene.draw(&mut mirror, &input), outcome, "{mm} mm");
    }
    // Another person stands before them: all of the garment is behind that.
    let near = depth(1_200);
    let input = OwnPictureInput { depth: Some(&near), ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Ok(()));
    assert_eq!(mirror.shown().filter(|is| *is).count(), 0);
    let from_picture = glam::Affine2::from_scale(glam::Vec2::splat(1.0 / 320.0));
    let no_person = PersonMask { side: 2, odds: vec![0.05; 4], from_picture };
    let input = OwnPictureInput { mask: Some(&no_person), ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Err(Plain::Unsure));
}

#[test]
fn what_is_outside_of_the_picture_is_said() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    let close = ColourCamera {
        camera_to_world: Affine3A { translation: glam::Vec3A::new(0.0, 1.75, 1.0), ..scene.camera.camera_to_world },
        ..scene.camera
    };
    let input = OwnPictureInput { camera: Some(&close), ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Err(Plain::OutOfPicture));
}

#[test]
fn arms_before_the_garment_hide_it_by_the_body_alone() {
    let (scene, mut mirror) = (scene(), OwnPicture::new());
    scene.draw(&mut mirror, &scene.input()).unwrap();
    let before = mirror.shown().filter(|is| *is).count();
    // The left forearm across the waist, some centimetres before it.
    let crossed = scene.with(|j| {
        let elbow = j.at(Joint::LeftShoulder).position + Vec3::new(0.05, -0.26, 0.08);
        j.at_mut(Joint::LeftElbow).position = elbow;
        j.at_mut(Joint::LeftWrist).position = elbow + Vec3::new(-0.21, 0.0, 0.10);
        j.at_mut(Joint::LeftHand).position = elbow + Vec3::new(-0.29, 0.0, 0.10);
    });
    let input = OwnPictureInput { joints: &crossed, ..scene.input() };
    assert_eq!(scene.draw(&mut mirror, &input), Ok(()));
    let after = mirror.shown().filter(|is| *is).count();
    assert!(after + 120 < before, "{before} pixels of cloth, {after} behind an arm");
}

#[test]
fn a_snapshot_of_another_moment_is_brought_to_the_picture() {
    let scene = scene();
    // The body that is posed anew with bones is where the joints that were seen bring the old one.
    let body = toile_assets::body::build(SHOPPER.0, &SHOPPER.1).unwrap();
    let mut pose = scene.snapshot.pose;
    pose.root += Vec3::new(0.08, 0.0, 0.03);
    pose.local[Joint::LeftHip.index()] = Quat::from_rotation_x(-0.3) * pose.local[Joint::LeftHip.index()];
    pose.local[Joint::RightShoulder.index()] = Quat::from_rotation_z(-0.2) * pose.local[Joint::RightShoulder.index()];
    let seen = Joints::seen(1, JointFrames::new(&body.skeleton, &pose).position);
    let from: [Vec3; JOINTS] = JointFrames::new(&body.skeleton, &scene.snapshot.pose).position;
    let repose = Repose::new(&from, &seen).unwrap();
    assert!(repose.lengths[0] > 0.99 && repose.lengths[1] < 1.01, "{:?}", repose.lengths);
    let skinned = |pose| {
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&body.skeleton, pose, &mut bones);
        let of = |(p, w): (&Vec3, &toile_base::mesh::SkinWeights)| -> Vec3 {
            w.iter().map(|(bone, weight)| bones[usize::from(bone)].transform_point3(*p) * weight).sum()
        };
        body.mesh.positions.iter().zip(&body.weights).map(of).collect::<Vec<Vec3>>()
    };
    let (mut points, goal) = (skinned(&scene.snapshot.pose), skinned(&pose));
    let mut normals = body.normals.clone();
    repose.apply(&body.weights, &mut points, &mut normals);
    let off: Vec<f32> = points.iter().zip(&goal).map(|(a, b)| a.distance(*b)).collect();
    let mean = off.iter().sum::<f32>() / off.len() as f32;
    assert!(mean < 0.004, "{mean} m off on average, {:?} at most", off.iter().copied().fold(0.0, f32::max));
}

#[test]
fn no_limb_is_drawn_longer_or_shorter_than_a_body_could_be() {
    let scene = scene();
    let from: [Vec3; JOINTS] =
        JointFrames::new(&toile_assets::body::build(SHOPPER.0, &SHOPPER.1).unwrap().skeleton, &scene.snapshot.pose)
            .position;
    for (k, scale) in [0.6_f32, 0.8, 1.0, 1.25, 1.6].into_iter().enumerate() {
        let seen = scene.with(|j| {
            let (elbow, wrist) = (j.at(Joint::LeftElbow).position, j.at(Joint::LeftWrist).position);
            j.at_mut(Joint::LeftWrist).position = elbow + (wrist - elbow) * scale;
        });
        let repose = Repose::new(&from, &seen).unwrap();
        let limb = repose.moves[Joint::LeftElbow.index()].matrix3;
        let drawn = (from[Joint::LeftWrist.index()] - from[Joint::LeftElbow.index()]).normalize();
        let stretch = (limb * glam::Vec3A::from(drawn)).length();
        assert!((0.89..=1.13).contains(&stretch), "{k}: {stretch}");
    }
}
