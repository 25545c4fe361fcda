//! Arms that point at the camera or aside: the body fit finds them, and the trunk does not take them for its own.

use glam::{Quat, Vec3};
use toile_base::body::{Measures, Sex};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::skeleton::{Joint, Pose};
use toile_engine::body::JointFrames;
use toile_fitting::dress::depth::posed;
use toile_sensors::source::synthetic::SyntheticCamera;
use toile_track::fit::{BodyFit, FitOptions};

/// An average man whose left arm points a way, as a camera 2.3 m before him sees him; and where his joints are (m).
fn pointing(way: Vec3) -> (DepthFrame, [Vec3; toile_base::skeleton::JOINTS]) {
    let body = toile_assets::body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
    let mut pose = Pose::rest(&body.skeleton);
    let along = body.skeleton.at(Joint::LeftElbow) - body.skeleton.at(Joint::LeftShoulder);
    pose.local[Joint::LeftShoulder.index()] = Quat::from_rotation_arc(along.normalize(), way.normalize());
    let intrinsics = Intrinsics { width: 320, height: 288, fx: 252.0, fy: 252.0, cx: 159.5, cy: 143.5 };
    let camera = SyntheticCamera::looking_at(intrinsics, Vec3::new(0.0, 1.0, 2.3), Vec3::new(0.0, 1.0, 0.0));
    let mut image = vec![0.0; camera.intrinsics.pixels()];
    camera.render(&posed(&body, &pose), &body.mesh.triangles, &mut image);
    let mm = |z: &f32| if z.is_finite() { (z * 1e3).round() as u16 } else { 0 };
    (camera.frame(0, image.iter().map(mm).collect()), JointFrames::new(&body.skeleton, &pose).position)
}

#[test]
fn an_arm_that_points_is_found_and_not_fitted_across_the_trunk() {
    for (name, way) in [
        ("at the camera", Vec3::new(0.15, -0.1, 1.0)),
        ("aside", Vec3::new(1.0, 0.05, 0.1)),
        ("ahead and aside", Vec3::new(0.7, 0.0, 0.7)),
    ] {
        let (frame, truth) = pointing(way);
        let mut fit = BodyFit::new(Sex::Male, FitOptions { clothed: false, ..FitOptions::LIVE });
        let mut seen = fit.push(&frame);
        for _ in 0..3 {
            seen = fit.push(&frame);
        }
        assert!(seen.found && seen.explained > 0.9, "{name}: {} explained", seen.explained);
        let off = |joint: Joint| seen.joints.at(joint).position.distance(truth[joint.index()]);
        println!(
            "{name}: wrist {:.3}, elbow {:.3}, other wrist {:.3}, chest {:.3} m off",
            off(Joint::LeftWrist),
            off(Joint::LeftElbow),
            off(Joint::RightWrist),
            off(Joint::Chest)
        );
        assert!(off(Joint::LeftWrist) < 0.10 && off(Joint::LeftElbow) < 0.10, "{name}");
        assert!(off(Joint::RightWrist) < 0.05 && off(Joint::Chest) < 0.05, "{name}");
    }
}
