//! The body in the camera's own space: the place of the camera from which the joints are seen at their landmarks, and joints that are
//! seen there exactly.
//!
//! Joints have the network's directions and a body's own lengths, so that they are not seen exactly at their landmarks. With the
//! camera's rotation R known (its tilt), its place t is the least squares solution of
//!
//! ```text
//! fx (q.x + t.x) = (u - cx) (q.z + t.z),   fy (q.y + t.y) = (v - cy) (q.z + t.z),   q = R^T joint
//! ```
//!
//! which are linear in t. The rest at each limb's end is removed in the plane of the picture, within a small limit.

use glam::{Affine3A, Mat3, Vec2, Vec3};
use toile_base::frame::{Intrinsics, Joints};
use toile_base::skeleton::Joint;
use toile_sensors::colour_camera::ColourCamera;

use crate::landmarks::Landmarks;
use crate::scale::WebcamMount;

/// How sure a landmark has to be.
const SURE: f32 = 0.5;

/// Fewest joints that say where the camera is.
const FEWEST: usize = 6;

/// Farthest that a joint is moved in the plane of the picture (m): more is another limb, or an error.
const FARTHEST_M: f32 = 0.14;

/// Share of a new distance: size in the picture is noisy, and people do not come nearer by jumps.
const DISTANCE_SHARE: f32 = 0.3;

/// Distances of a person from the camera (m).
const DISTANCES: std::ops::RangeInclusive<f32> = 0.4..=12.0;

/// Landmarks farther than this from a body's joints, in the root of their mean square, are rejected (part of the picture's longer
/// side).
const FARTHEST_OFF: f32 = 0.25;

/// Joints and the landmarks whose middle is theirs.
const SEEN: [(Joint, &[usize]); 15] = {
    use Joint::*;
    [
        (LeftShoulder, &[11]),
        (RightShoulder, &[12]),
        (LeftHip, &[23]),
        (RightHip, &[24]),
        (Head, &[7, 8]),
        (LeftElbow, &[13]),
        (LeftWrist, &[15]),
        (LeftHand, &[17, 19]),
        (RightElbow, &[14]),
        (RightWrist, &[16]),
        (RightHand, &[18, 20]),
        (LeftKnee, &[25]),
        (LeftAnkle, &[27]),
        (RightKnee, &[26]),
        (RightAnkle, &[28]),
    ]
};

/// Pairs whose middle is moved, and not each: their landmarks lie elsewhere than the joints of a body do.
const PAIRS: usize = 4;

/// Joints and the camera that sees them where their landmarks are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureFit {
    /// The camera, in the joints' world.
    pub camera: ColourCamera,
    /// The joints, each seen at its landmark.
    pub joints: Joints,
    /// How far they were off before (px of the picture's longer side, the root of the mean square).
    pub off: f32,
}

/// Fits picture by picture, with the distance of the last ones.
#[derive(Debug, Clone, Copy, Default)]
pub struct PictureFitter {
    distance: Option<f32>,
}

impl PictureFitter {
    /// Another person may stand there.
    pub fn reset(&mut self) {
        self.distance = None;
    }

    /// Fits the camera and the joints of a picture of this size (px); none where too little is seen, or what no body can be.
    pub fn fit(
        &mut self,
        landmarks: &Landmarks,
        joints: &Joints,
        size: [u32; 2],
        mount: &WebcamMount,
    ) -> Option<PictureFit> {
        let intrinsics = intrinsics(size, mount);
        let rotation = rotation(mount);
        let into = rotation.transpose();
        let mut points: heapless::Vec<(Joint, Vec2, Vec3), 15> = heapless::Vec::new();
        for (joint, of) in SEEN {
            let confidence = of.iter().map(|k| landmarks.points[*k].confidence).fold(1.0, f32::min);
            if let Some(place) = joints.believed(joint).filter(|_| confidence >= SURE) {
                let pixel: Vec2 = of.iter().map(|k| landmarks.points[*k].pixel).sum::<Vec2>() / of.len() as f32;
                // As many as there is room for.
                _ = points.push((joint, pixel - 0.5, into * place));
            }
        }
        if points.len() < FEWEST {
            return None;
        }
        let found = place(&points, &intrinsics)?;
        let distance = found.z + points.iter().map(|(_, _, q)| q.z).sum::<f32>() / points.len() as f32;
        if !DISTANCES.contains(&distance) {
            return None;
        }
        let followed = self.distance.map_or(distance, |was| was + DISTANCE_SHARE * (distance - was));
        let depth = found.z + followed - distance;
        let at = aside(&points, &intrinsics, depth).extend(depth);
        let camera_to_world = Affine3A::from_mat3_translation(rotation, rotation * -at);
        let camera = ColourCamera::pinhole(intrinsics, camera_to_world);
        let (mut fitted, mut off) = (*joints, 0.0);
        let mut moves: heapless::Vec<(Joint, Vec3), 15> = heapless::Vec::new();
        for (joint, pixel, q) in &points {
            let p = *q + at;
            let seen = camera.project(p)?;
            let by = (*pixel - seen) * Vec2::new(p.z / intrinsics.fx, p.z / intrinsics.fy);
            off += (*pixel - seen).length_squared();
            _ = moves.push((*joint, rotation * by.clamp_length_max(FARTHEST_M).extend(0.0)));
        }
        shift(&mut fitted, &moves);
        let off = (off / points.len() as f32).sqrt();
        let farthest = FARTHEST_OFF * size[0].max(size[1]) as f32;
        if !(off <= farthest && fitted.is_valid()) {
            return None;
        }
        self.distance = Some(followed);
        Some(PictureFit { camera, joints: fitted, off })
    }
}

/// A webcam of this mount whose place is not known: at the world's middle.
pub fn webcam(size: [u32; 2], mount: &WebcamMount) -> ColourCamera {
    ColourCamera::pinhole(intrinsics(size, mount), Affine3A::from_mat3(rotation(mount)))
}

/// From the camera's axes to the world's: x to the right of the picture, y up, z towards the camera.
fn rotation(mount: &WebcamMount) -> Mat3 {
    Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0)) * Mat3::from_rotation_x(-mount.down)
}

/// Moves shoulders and hips by what their middles are off, all other joints by what each is off; the spine lies between.
fn shift(joints: &mut Joints, moves: &[(Joint, Vec3)]) {
    use Joint::*;
    let of = |joint: Joint| moves.iter().find(|(j, _)| *j == joint).map(|(_, by)| *by);
    let both = |a: Joint, b: Joint| Some((of(a)? + of(b)?) * 0.5);
    let (hips, shoulders) =
        (both(LeftHip, RightHip).unwrap_or_default(), both(LeftShoulder, RightShoulder).unwrap_or_default());
    let trunk = [(Pelvis, 0.0), (LeftHip, 0.0), (RightHip, 0.0), (Spine, 0.35), (Chest, 0.8)];
    let above = [Neck, LeftClavicle, RightClavicle, LeftShoulder, RightShoulder].map(|j| (j, 1.0));
    for (joint, share) in trunk.into_iter().chain(above) {
        joints.at_mut(joint).position += hips.lerp(shoulders, share);
    }
    for (joint, by) in moves.iter().filter(|(joint, _)| !SEEN[..PAIRS].iter().any(|(pair, _)| pair == joint)) {
        joints.at_mut(*joint).position += *by;
    }
    for (toe, ankle) in [(LeftToe, LeftAnkle), (RightToe, RightAnkle)] {
        joints.at_mut(toe).position += of(ankle).unwrap_or_default();
    }
}

/// The lens of a webcam of this mount.
fn intrinsics([width, height]: [u32; 2], mount: &WebcamMount) -> Intrinsics {
    let focal = mount.focal * width.max(height) as f32;
    Intrinsics { width, height, fx: focal, fy: focal, cx: 0.5 * width as f32 - 0.5, cy: 0.5 * height as f32 - 0.5 }
}

/// The camera's place against the joints, in its own axes (m).
fn place(points: &[(Joint, Vec2, Vec3)], k: &Intrinsics) -> Option<Vec3> {
    let (mut square, mut right) = (Mat3::ZERO, Vec3::ZERO);
    for (_, pixel, q) in points {
        for (f, c, axis) in [(k.fx, pixel.x - k.cx, Vec3::X), (k.fy, pixel.y - k.cy, Vec3::Y)] {
            let row = axis * f - Vec3::Z * c;
            let known = -(f * q.dot(axis) - c * q.z);
            square += Mat3::from_cols(row * row.x, row * row.y, row * row.z);
            right += row * known;
        }
    }
    let found = square.inverse() * right;
    (square.determinant().abs() > 1e-3 && found.is_finite()).then_some(found)
}

/// The same across the picture, at a depth that is known.
fn aside(points: &[(Joint, Vec2, Vec3)], k: &Intrinsics, depth: f32) -> Vec2 {
    let of = |(_, pixel, q): &(Joint, Vec2, Vec3)| {
        let z = q.z + depth;
        Vec2::new((pixel.x - k.cx) * z / k.fx - q.x, (pixel.y - k.cy) * z / k.fy - q.y)
    };
    points.iter().map(of).sum::<Vec2>() / points.len() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::landmarks::{POINTS, PoseLandmark};
    use toile_assets::body::shape::Shapes;
    use toile_base::body::Sex;

    /// Landmarks of joints as a camera sees them.
    fn seen(joints: &Joints, camera: &ColourCamera) -> Landmarks {
        let mut points = [PoseLandmark::default(); POINTS];
        let into = camera.camera_to_world.inverse();
        for (joint, of) in SEEN {
            let pixel = camera.project(into.transform_point3(joints.at(joint).position)).unwrap() + 0.5;
            of.iter().for_each(|k| points[*k] = PoseLandmark { pixel, confidence: 0.9, ..PoseLandmark::default() });
        }
        Landmarks { presence: 1.0, points, next: Default::default() }
    }

    #[test]
    fn the_camera_is_found_where_it_stands_and_joints_are_seen_at_their_landmarks() {
        let shapes = Shapes::of(Sex::Female);
        let rest = Joints::seen(0, shapes.skeleton(shapes.mean()).rest);
        let mount = WebcamMount { down: 0.15, ..WebcamMount::default() };
        let size = [640, 480];
        let rotation = Mat3::from_diagonal(Vec3::new(1.0, -1.0, -1.0)) * Mat3::from_rotation_x(-mount.down);
        let place = Vec3::new(0.3, 1.35, 2.9);
        let real = ColourCamera::pinhole(intrinsics(size, &mount), Affine3A::from_mat3_translation(rotation, place));
        let mut landmarks = seen(&rest, &real);
        let fit = PictureFitter::default().fit(&landmarks, &rest, size, &mount).unwrap();
        assert!(Vec3::from(fit.camera.camera_to_world.translation).distance(place) < 1e-3 && fit.off < 0.05, "{fit:?}");
        // A wrist that is seen elsewhere is moved to be seen there.
        landmarks.points[15].pixel += Vec2::new(12.0, -6.0);
        let fit = PictureFitter::default().fit(&landmarks, &rest, size, &mount).unwrap();
        let wrist = fit.camera.camera_to_world.inverse().transform_point3(fit.joints.at(Joint::LeftWrist).position);
        assert!(fit.camera.project(wrist).unwrap().distance(landmarks.points[15].pixel - 0.5) < 0.2);
        // One that is half a picture away is not stretched to it.
        landmarks.points[15].pixel += Vec2::new(300.0, 0.0);
        let fit = PictureFitter::default().fit(&landmarks, &rest, size, &mount).unwrap();
        assert!(
            fit.joints.at(Joint::LeftWrist).position.distance(rest.at(Joint::LeftWrist).position) <= FARTHEST_M + 1e-3
        );
    }

    #[test]
    fn too_little_or_nonsense_has_no_camera() {
        let shapes = Shapes::of(Sex::Female);
        let rest = Joints::seen(0, shapes.skeleton(shapes.mean()).rest);
        let nothing = Landmarks { presence: 1.0, points: [PoseLandmark::default(); POINTS], next: Default::default() };
        let mount = WebcamMount::default();
        assert_eq!(PictureFitter::default().fit(&nothing, &rest, [640, 480], &mount), None);
        let one = PoseLandmark { pixel: Vec2::splat(100.0), confidence: 1.0, ..PoseLandmark::default() };
        let stacked = Landmarks { points: [one; POINTS], ..nothing };
        assert_eq!(PictureFitter::default().fit(&stacked, &rest, [640, 480], &mount), None);
    }
}
