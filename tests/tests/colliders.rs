//! Tests of the collision body as it moves: capsules follow their bones, and the skin stays near them where joints bend.

use glam::{Affine3A, Quat, Vec3};
use toile_assets::rig::Zone;
use toile_base::body::{Body, Measures, Sex};
use toile_base::limits::MAX_CAPSULES;
use toile_base::skeleton::{BONES, Joint, Pose};
use toile_engine::body::palette;
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::cone::RoundCone;
use toile_engine::skin::SkinningJob;
use toile_engine::world::BLEND;
use toile_workspace::tolerance;

/// A bend: what it is called, the joint of the left side, and its turn (axis times rad). The right side mirrors it.
const BENDS: [(&str, Joint, Vec3); 7] = [
    ("elbow 90", Joint::LeftElbow, Vec3::new(0.0, -1.57, 0.0)),
    ("forearm twisted 80", Joint::LeftWrist, Vec3::new(0.9, -1.07, 0.0)),
    ("arm down 45", Joint::LeftShoulder, Vec3::new(0.0, 0.0, -0.785)),
    ("arm up 60", Joint::LeftShoulder, Vec3::new(0.0, 0.0, 1.05)),
    ("arm forward 60", Joint::LeftShoulder, Vec3::new(0.0, -1.05, 0.0)),
    ("hip 60", Joint::LeftHip, Vec3::new(-1.05, 0.0, 0.0)),
    ("knee 90", Joint::LeftKnee, Vec3::new(1.57, 0.0, 0.0)),
];

/// The turn of the right side: the mirror image in x = 0.
fn mirrored(turn: Vec3) -> Vec3 {
    Vec3::new(turn.x, -turn.y, -turn.z)
}

fn bent(body: &Body, joint: Joint, turn: Vec3) -> Pose {
    let mut pose = Pose::rest(&body.skeleton);
    pose.local[joint.index()] = Quat::from_scaled_axis(turn);
    pose.local[joint.mirror().index()] = Quat::from_scaled_axis(mirrored(turn));
    pose
}

/// The skin and the capsules in a pose.
fn posed(body: &Body, pose: &Pose) -> (Vec<Vec3>, [RoundCone; MAX_CAPSULES]) {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&body.skeleton, pose, &mut bones);
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).expect("a body of ours");
    let mut skin = job.posed();
    job.run(BLEND, &bones, &mut skin);
    let (mut positions, mut normals) = (body.mesh.positions.clone(), body.normals.clone());
    skin.read(&mut positions, &mut normals);
    let rig = toile_assets::rig::fit(body);
    let spheres = rig.spheres.map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
    let mut colliders = Colliders::new(&spheres, &rig.capsules, true).expect("a rig of ours");
    colliders.place(&bones);
    (positions, colliders.cones_at(1.0))
}

/// Signed distance to the union of the capsules (m), inside that of the deepest.
fn distance(cones: &[RoundCone], p: Vec3) -> f32 {
    cones.iter().map(|cone| cone.distance(p).0).fold(f32::INFINITY, f32::min)
}

/// Mean distance (mm, absolute) and 95th percentile of the vertices in the zones that are asked for, and the furthest that
/// skin is outside of the capsules.
fn figures(body: &Body, pose: &Pose, asked: impl Fn(Zone) -> bool) -> [f32; 3] {
    let (positions, cones) = posed(body, pose);
    let of = |v: usize| distance(&cones, positions[v]) * 1e3;
    let all: Vec<f32> = (0..positions.len()).filter(|v| asked(Zone::of(body, *v))).map(of).collect();
    let outside = all.iter().copied().fold(0.0, f32::max);
    let mut away: Vec<f32> = all.iter().map(|d| d.abs()).collect();
    away.sort_by(f32::total_cmp);
    [away.iter().sum::<f32>() / away.len() as f32, away[away.len() * 95 / 100], outside]
}

/// Head, hands and feet do not bend and are no capsules.
fn dressed(zone: Zone) -> bool {
    !matches!(zone, Zone::Head | Zone::Hand | Zone::Foot)
}

#[test]
fn capsules_follow_the_skin_where_joints_bend() {
    for sex in [Sex::Female, Sex::Male] {
        let body = toile_assets::body::build(sex, &Measures::average(sex)).expect("a mean body");
        let rest = figures(&body, &Pose::rest(&body.skeleton), dressed);
        eprintln!("{sex:?} at rest: mean {:.1}, 95 % {:.1}, outside {:.1} mm", rest[0], rest[1], rest[2]);
        for (name, joint, turn) in BENDS {
            let [mean, p95, outside] = figures(&body, &bent(&body, joint, turn), dressed);
            eprintln!("{sex:?} {name}: mean {mean:.1}, 95 % {p95:.1}, outside {outside:.1} mm");
            assert!(mean < tolerance::BENT_MEAN_MM, "{sex:?} {name}: mean {mean} mm");
            assert!(p95 < tolerance::BENT_P95_MM, "{sex:?} {name}: 95 % {p95} mm");
            assert!(outside < tolerance::BENT_OUTSIDE_MM, "{sex:?} {name}: skin {outside} mm outside of the capsules");
        }
    }
}

#[test]
fn capsules_left_and_right_bend_alike() {
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).expect("a mean body");
    for (name, joint, turn) in BENDS {
        let (positions, cones) = posed(&body, &bent(&body, joint, turn));
        for p in positions.iter().step_by(29) {
            let [here, there] = [*p, *p * Vec3::new(-1.0, 1.0, 1.0)].map(|p| distance(&cones, p));
            assert!((here - there).abs() < 1e-5, "{name}: {here} m and {there} m");
        }
    }
}

#[test]
fn a_body_that_is_carried_and_turned_takes_its_capsules_along() {
    let body = toile_assets::body::build(Sex::Male, &Measures::average(Sex::Male)).expect("a mean body");
    let still = Pose::rest(&body.skeleton);
    let mut moved = still;
    moved.root += Vec3::new(0.4, 0.1, -0.3);
    moved.local[Joint::Pelvis.index()] = Quat::from_rotation_y(1.1);
    let (a, b) = (posed(&body, &still), posed(&body, &moved));
    for v in (0..a.0.len()).step_by(17) {
        let [here, there] = [distance(&a.1, a.0[v]), distance(&b.1, b.0[v])];
        assert!((here - there).abs() < 2e-5, "{here} m and {there} m");
    }
}
