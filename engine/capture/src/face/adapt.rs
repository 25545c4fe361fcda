//! The head adapted to marked points: its pose before the cameras and its field of displacements, in turn.

use glam::{DMat3, DQuat, DVec2, DVec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{Region, Sex};
use toile_assets::numeric::linear::{self, Pivot};
use toile_assets::skeleton::Joint;
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};
use toile_sensors::face_points::FACE_POINTS;

use super::landmarks::FaceLandmarks;
use super::prior::{Field, Observation};
use crate::error::CaptureError;

/// Rounds of pose and field in turn, and of the pose in each.
const ROUNDS: usize = 8;
const POSE_ROUNDS: usize = 10;

/// Robust distance of a point (standard deviations): one that was marked elsewhere counts little.
const ROBUST: f64 = 4.0;

/// Residual over which points are those of no face, or in another order (px a thousand of focal length).
const LARGEST_RESIDUAL: f64 = 12.0;

/// Standard deviation of the logarithm of a head's size, which one photograph cannot tell.
const SIZE: f64 = 0.04;

/// Height above the head's lowest vertex over which the neck takes over (m).
const NECK: f64 = 0.05;

/// Focal length over the longer side of a picture whose lens nobody knows: a portrait's.
const PORTRAIT: f64 = 1.6;

/// One photograph with its camera.
#[derive(Debug, Clone)]
pub struct FaceView {
    /// The camera.
    pub camera: CalibratedCamera,
    /// Where the 68 points are (px).
    pub points: [Option<DVec2>; FACE_POINTS],
    /// Standard deviation of a point (px).
    pub sigma_px: f64,
}

/// An adapted head.
#[derive(Debug, Clone)]
pub struct AdaptedHead {
    /// Whose drawing it was adapted from.
    pub sex: Sex,
    /// The whole body at rest with the adapted head (m) `[vertices]`.
    pub rest: Vec<DVec3>,
    /// The same where it stands before the cameras (m) `[vertices]`.
    pub placed: Vec<DVec3>,
    /// Triangles of the head.
    pub triangles: Vec<[u32; 3]>,
    /// Root mean square distance of the points from where they were marked (px).
    pub residual_px: f64,
    /// Points that were used, over all photographs.
    pub points: usize,
    /// Mean displacement of the face from the mannequin's (m).
    pub moved: f64,
}

/// The camera of a photograph of so many pixels that no calibration knows: at the origin, looking along z.
///
/// # Errors
/// A picture without pixels.
pub fn assumed_camera(size: [u32; 2], focal_px: Option<f64>) -> Result<CalibratedCamera, CaptureError> {
    let focal = focal_px.unwrap_or(PORTRAIT * f64::from(size[0].max(size[1])));
    let middle = size.map(|s| f64::from(s) / 2.0 - 0.5);
    let given = CameraParameters {
        size: size.map(f64::from),
        matrix: [[focal, 0.0, middle[0]], [0.0, focal, middle[1]], [0.0, 0.0, 1.0]],
        distortion: Vec::new(),
        rotation: DMat3::IDENTITY,
        translation: DVec3::ZERO,
    };
    CalibratedCamera::new("photograph", &given)
        .map_err(|problem| CaptureError::unfit("the photograph", problem, "give another"))
}

/// Where a head stands: rotation, place and size of the mannequin's.
#[derive(Debug, Clone, Copy)]
struct HeadPose {
    turn: DQuat,
    place: DVec3,
    size: f64,
}

impl HeadPose {
    fn to_world(self, p: DVec3) -> DVec3 {
        self.place + self.turn * (p * self.size)
    }
}

/// Adapts the mannequin's head of a sex to the photographs.
///
/// # Errors
/// One sentence where the points are those of no head before these cameras.
pub fn adapt(views: &[FaceView], sex: Sex) -> Result<AdaptedHead, CaptureError> {
    let base = Shapes::of(sex).base();
    let origin = middle(sex);
    let positions: Vec<DVec3> = base.positions.iter().map(|p| p.as_dvec3() - origin).collect();
    let marks = FaceLandmarks::new().on(&positions);
    let mut at = marks.clone();
    let mut pose = first_pose(views, &at)?;
    let mut field = Field::default();
    for _ in 0..ROUNDS {
        for _ in 0..POSE_ROUNDS {
            pose = pose_step(views, &at, pose);
        }
        field = Field::of(&observations(views, &marks, &at, pose));
        at = marks.iter().map(|p| *p + field.at(*p)).collect();
    }
    for _ in 0..POSE_ROUNDS {
        pose = pose_step(views, &at, pose);
    }
    let (residual, points, relative) = residual(views, &at, pose);
    if relative.is_nan() || relative >= LARGEST_RESIDUAL {
        let problem = format!("they lie {residual:.1} px from those of any head that stands before these cameras");
        let cure = "check their order, left and right (the wearer's right is point 0), and the cameras' names";
        return Err(CaptureError::unfit("the points", problem, cure));
    }
    Ok(adapted(sex, &positions, &field, pose, origin, (residual, points)))
}

fn adapted(
    sex: Sex,
    positions: &[DVec3],
    field: &Field,
    pose: HeadPose,
    origin: DVec3,
    (residual_px, points): (f64, usize),
) -> AdaptedHead {
    let base = Shapes::of(sex).base();
    let head = |v: usize| base.regions[v] == Region::Head;
    let lowest = (0..positions.len()).filter(|v| head(*v)).map(|v| positions[v].y).fold(f64::MAX, f64::min);
    // The neck is the body's: what moves fades towards it.
    let share = |p: DVec3| ((p.y - lowest) / NECK).clamp(0.0, 1.0);
    let mut moved = (0.0, 0.0);
    let own: Vec<DVec3> = positions
        .iter()
        .enumerate()
        .map(|(v, p)| {
            if !head(v) {
                return *p;
            }
            let by = field.at(*p);
            if p.z > 0.03 {
                moved = (moved.0 + by.length(), moved.1 + 1.0);
            }
            *p + by * share(*p)
        })
        .collect();
    let sized = |v: usize, p: &DVec3| {
        let size = if head(v) { 1.0 + (pose.size - 1.0) * share(positions[v]) } else { 1.0 };
        // About the joint of head and neck, so that the chin stays over the throat.
        *p * size + origin
    };
    AdaptedHead {
        sex,
        rest: own.iter().enumerate().map(|(v, p)| sized(v, p)).collect(),
        placed: own.iter().map(|p| pose.to_world(*p)).collect(),
        triangles: base.triangles.iter().filter(|t| t.iter().all(|v| head(*v as usize))).copied().collect(),
        residual_px,
        points,
        moved: moved.0 / f64::max(moved.1, 1.0),
    }
}

/// The middle of a head: what places are counted from (m).
pub(super) fn middle(sex: Sex) -> DVec3 {
    let base = Shapes::of(sex).base();
    let joint = base.skeleton.at(Joint::Head).as_dvec3();
    joint + DVec3::new(0.0, 0.06, 0.03)
}

/// A first pose: facing the mean of the cameras, at the distance where the points are as far apart as they are seen.
fn first_pose(views: &[FaceView], marks: &[DVec3]) -> Result<HeadPose, CaptureError> {
    let spread = |of: &[DVec2]| {
        let mean = of.iter().sum::<DVec2>() / of.len().max(1) as f64;
        (mean, (of.iter().map(|p| p.distance_squared(mean)).sum::<f64>() / of.len().max(1) as f64).sqrt())
    };
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
        return Err(CaptureError::unfit("the points", "they give the head no place", cure));
    }
    let turn = DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z));
    let mut best = HeadPose { turn, place, size: 1.0 };
    // Cameras that stand all on one side of the face leave the way it faces open.
    let mut least = f64::MAX;
    for k in -3..=3 {
        let mut tried = HeadPose { turn: turn * DQuat::from_rotation_y(0.35 * f64::from(k)), place, size: 1.0 };
        for _ in 0..POSE_ROUNDS {
            tried = pose_step(views, marks, tried);
        }
        let off = residual(views, marks, tried).0;
        if off < least {
            (least, best) = (off, tried);
        }
    }
    Ok(best)
}

/// The seen points: view, point, distance of where it is seen from where it was marked (px) and how that changes with its place.
fn seen<'a>(
    views: &'a [FaceView],
    at: &'a [DVec3],
    pose: HeadPose,
) -> impl Iterator<Item = (usize, DVec3, DVec2, [DVec3; 2], f64)> + 'a {
    views.iter().flat_map(move |view| {
        let rows = view.camera.rotation().transpose();
        view.points.iter().enumerate().filter_map(move |(i, marked)| {
            let world = pose.to_world(at[i]);
            let p = view.camera.to_camera(world);
            let marked = (*marked)?;
            if p.z < 0.05 {
                return None;
            }
            let focal = view.camera.focal();
            let off = (p.truncate() / p.z - view.camera.ray(marked)) * focal;
            let jacobian = [(DVec3::X, focal.x, p.x), (DVec3::Y, focal.y, p.y)]
                .map(|(axis, f, along)| rows * ((axis * p.z - DVec3::Z * along) * (f / (p.z * p.z))));
            Some((i, world, off, jacobian, view.sigma_px))
        })
    })
}

fn weight(off: DVec2, sigma: f64) -> f64 {
    let share = off.length_squared() / (ROBUST * sigma).powi(2);
    1.0 / ((1.0 + share).powi(2) * sigma * sigma)
}

/// A Gauss-Newton step of the pose.
fn pose_step(views: &[FaceView], at: &[DVec3], pose: HeadPose) -> HeadPose {
    const N: usize = 7;
    let mut a = [[0.0; N]; N];
    let mut x = [0.0; N];
    for (_, world, off, jacobian, sigma) in seen(views, at, pose) {
        // Coarsely at first, so that all points pull: the robust weight is taken from the residuals themselves.
        let w = weight(off, sigma.max(0.05 * off.length()));
        for (r, j) in off.to_array().into_iter().zip(jacobian) {
            let arm = world - pose.place;
            let turn = arm.cross(j);
            let row = [j.x, j.y, j.z, turn.x, turn.y, turn.z, j.dot(arm)];
            for i in 0..N {
                for k in 0..=i {
                    a[i][k] += w * row[i] * row[k];
                }
                x[i] -= w * row[i] * r;
            }
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
    let by = DVec3::new(x[3], x[4], x[5]).clamp_length_max(0.4);
    HeadPose {
        turn: (DQuat::from_scaled_axis(by) * pose.turn).normalize(),
        place: pose.place + DVec3::new(x[0], x[1], x[2]).clamp_length_max(0.3),
        size: (pose.size.ln() + x[6].clamp(-0.1, 0.1)).exp(),
    }
}

/// What the marked points say of the field, linearised at where the points are now.
fn observations(views: &[FaceView], marks: &[DVec3], at: &[DVec3], pose: HeadPose) -> Vec<Observation> {
    let back = DMat3::from_quat(pose.turn).transpose() * pose.size;
    seen(views, at, pose)
        .flat_map(|(i, _, off, jacobian, sigma)| {
            let robust = weight(off, sigma).sqrt().recip();
            let moved = at[i] - marks[i];
            jacobian.into_iter().zip(off.to_array()).map(move |(j, r)| {
                let along = back * j;
                Observation { place: marks[i], along, value: along.dot(moved) - r, sigma: robust }
            })
        })
        .collect()
}

/// Root mean square distance of the points (px), their number, and the same distance in thousandths of the focal length.
fn residual(views: &[FaceView], at: &[DVec3], pose: HeadPose) -> (f64, usize, f64) {
    let all: Vec<f64> = seen(views, at, pose).map(|(_, _, off, _, _)| off.length_squared()).collect();
    let root = (all.iter().sum::<f64>() / all.len().max(1) as f64).sqrt();
    let focal = views.iter().map(|v| v.camera.focal().x).fold(f64::MAX, f64::min);
    let off = if all.is_empty() { f64::INFINITY } else { root };
    (off, all.len(), 1e3 * off / focal)
}
