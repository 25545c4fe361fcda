//! Pose of a head before the cameras, by Gauss-Newton on its sightings.

use glam::{DMat3, DQuat, DVec2, DVec3};
use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

use super::sighting::{HeadPose, Sighting, equations, marked_points, residual};
use super::unfit::UnfitFace;
use super::view::FaceView;

/// Steps of a pose.
pub(super) const POSE_ROUNDS: usize = 10;

/// Standard deviation of the logarithm of a head's size, which one photograph cannot tell.
const SIZE: f64 = 0.04;

/// Turns to each side that a first pose tries, and the angle between them (rad).
const TRIED: i32 = 3;
const TURN: f64 = 0.35;

/// A Gauss-Newton step of the pose.
pub(super) fn pose_step(views: &[FaceView], sightings: &[Sighting], pose: HeadPose) -> HeadPose {
    const N: usize = 7;
    let mut a = [[0.0; N]; N];
    let mut x = [0.0; N];
    for e in equations(views, sightings, pose) {
        // Coarsely at first, so that all points pull: the robust weight is taken from the residuals themselves.
        let w = sightings[e.of].weight(e.length, true);
        let arm = e.world - pose.place;
        let turn = arm.cross(e.along);
        let row = [e.along.x, e.along.y, e.along.z, turn.x, turn.y, turn.z, e.along.dot(arm)];
        for i in 0..N {
            for k in 0..=i {
                a[i][k] += w * row[i] * row[k];
            }
            x[i] -= w * row[i] * e.off;
        }
    }
    a[6][6] += SIZE.powi(-2);
    x[6] -= pose.size.ln() / (SIZE * SIZE);
    for (i, row) in a.iter_mut().enumerate() {
        row[i] *= 1.0 + 1e-6;
    }
    if linear::factor(&mut a, Pivot::AtLeast(1e-9)).is_none() {
        return pose;
    }
    linear::solve(&a, &mut x);
    let moved = moved(pose, [x[0], x[1], x[2], x[3], x[4], x[5]]);
    HeadPose { size: (pose.size.ln() + x[6].clamp(-0.1, 0.1)).exp(), ..moved }
}

/// A pose moved and turned by a step (m, rad), of which no more than a third of a metre and 23 degrees are taken.
pub(super) fn moved(pose: HeadPose, by: [f64; 6]) -> HeadPose {
    let [x, y, z, rx, ry, rz] = by;
    HeadPose {
        turn: (DQuat::from_scaled_axis(DVec3::new(rx, ry, rz).clamp_length_max(0.4)) * pose.turn).normalize(),
        place: pose.place + DVec3::new(x, y, z).clamp_length_max(0.3),
        size: pose.size,
    }
}

/// A first pose: facing the mean of the cameras, at the distance where the points are as far apart as they are seen.
///
/// # Errors
/// Points that give the head no place.
pub(super) fn first_pose(views: &[FaceView], marks: &[DVec3]) -> Result<HeadPose, UnfitFace> {
    let mut places = Vec::new();
    let mut towards = DVec3::ZERO;
    for view in views {
        let rays: Vec<DVec2> = view.points.iter().flatten().map(|p| view.camera.ray(*p)).collect();
        let (mean, seen) = spread(&rays);
        let own: Vec<DVec2> =
            marks.iter().zip(&view.points).filter(|(_, p)| p.is_some()).map(|(m, _)| DVec2::new(m.x, m.y)).collect();
        let (_, there) = spread(&own);
        let deep = there / seen.max(1e-6);
        let inside = mean.extend(1.0) * deep;
        let rotation = view.camera.rotation().transpose();
        places.push(view.camera.position() + rotation * inside);
        towards -= rotation * DVec3::Z;
    }
    let place = places.iter().sum::<DVec3>() / places.len().max(1) as f64;
    let up: DVec3 = views.iter().map(|v| -(v.camera.rotation().transpose() * DVec3::Y)).sum();
    let z = towards.normalize_or(DVec3::Z);
    let x = up.cross(z).normalize_or(DVec3::X);
    if !place.is_finite() {
        let cure = "mark them again, in the picture's pixels";
        return Err(UnfitFace::new("the points", "they give the head no place", cure));
    }
    Ok(best_turn(
        views,
        marks,
        HeadPose { turn: DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)), place, size: 1.0 },
    ))
}

/// The best of several turns about the vertical: cameras that stand all on one side of the face leave the way it faces open.
fn best_turn(views: &[FaceView], marks: &[DVec3], from: HeadPose) -> HeadPose {
    let points = marked_points(views, marks, marks);
    let (mut least, mut best) = (f64::MAX, from);
    for k in -TRIED..=TRIED {
        let mut tried = HeadPose { turn: from.turn * DQuat::from_rotation_y(TURN * f64::from(k)), ..from };
        for _ in 0..POSE_ROUNDS {
            tried = pose_step(views, &points, tried);
        }
        let [off, _] = residual(views, &points, tried);
        if off < least {
            (least, best) = (off, tried);
        }
    }
    best
}

/// Mean of places and their root mean square distance from it.
fn spread(of: &[DVec2]) -> (DVec2, f64) {
    let count = of.len().max(1) as f64;
    let mean = of.iter().sum::<DVec2>() / count;
    (mean, (of.iter().map(|p| p.distance_squared(mean)).sum::<f64>() / count).sqrt())
}
