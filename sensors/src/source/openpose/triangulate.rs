//! A point in space from the pixels of several cameras: the direct linear transform (Hartley and Zisserman 2003, section
//! 12.2, the inhomogeneous form), each camera's two equations weighted by the keypoint's score.
//!
//! Camera with rows P1, P2, P3 and ray (x, y): (x P3 - P1) X = 0 and (y P3 - P2) X = 0. One camera whose pixel lies far
//! from the point that the others agree on is left out: it sees another person, or mistakes left for right.

use glam::{DMat3, DVec2, DVec3};

use crate::calibration::CalibratedCamera;

/// Farthest that a point may be seen from where it should (px), for an image of a thousand pixels' focal length.
const LARGEST_ERROR: f64 = 15.0;

/// Error of the views at which they are believed half (px): a hip or a crown, which no edge marks, is 5 to 10 off.
const HALF_ERROR: f64 = 12.0;

/// Score from which a keypoint counts as seen without doubt: those that lie right have .4 to .8.
const CERTAIN: f32 = 0.5;

/// Least determinant of the equations, over the cube of their trace: rays that are nearly parallel meet nowhere.
const LEAST_DETERMINANT: f64 = 1e-7;

/// One camera's view of a point: the camera, the ray without distortion, the score.
pub type Ray<'a> = (&'a CalibratedCamera, DVec2, f32);

/// A point in space; a confidence of 0 says that it is not seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Position in the world (m).
    pub position: DVec3,
    /// Confidence of the point, 0 to 1.
    pub confidence: f32,
    /// Mean distance of the pixels used from where the point is seen (px at a focal length of 1000).
    pub error: f64,
}

/// The point that the rays meet in; `None` where fewer than two agree.
pub fn triangulate(rays: &[Ray]) -> Option<Point> {
    let whole = solve(rays)?;
    if whole.error <= LARGEST_ERROR {
        return Some(whole);
    }
    // Without each in turn, the best of what is left.
    let mut best: Option<Point> = None;
    for out in 0..rays.len() {
        let kept: Vec<Ray> = rays.iter().enumerate().filter(|(i, _)| *i != out).map(|(_, ray)| *ray).collect();
        let point = if kept.len() >= 2 { solve(&kept) } else { None };
        best = best.into_iter().chain(point).min_by(|a, b| a.error.total_cmp(&b.error));
    }
    best.filter(|p| p.error <= LARGEST_ERROR)
}

fn solve(rays: &[Ray]) -> Option<Point> {
    if rays.len() < 2 {
        return None;
    }
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (camera, ray, score) in rays {
        let ([r1, r2, r3], t) = camera.rows();
        let weight = f64::from(*score) * f64::from(*score);
        for (row, constant) in [(r3 * ray.x - r1, t.z * ray.x - t.x), (r3 * ray.y - r2, t.z * ray.y - t.y)] {
            normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
            right -= row * (constant * weight);
        }
    }
    let trace = normal.x_axis.x + normal.y_axis.y + normal.z_axis.z;
    let determinant = normal.determinant();
    if determinant.is_nan() || determinant <= LEAST_DETERMINANT * trace.powi(3) {
        return None;
    }
    let position = normal.inverse() * right;
    let mut sum = 0.0;
    for (camera, ray, _) in rays {
        sum += camera.project(position)?.distance(*ray) * 1e3;
    }
    let error = sum / rays.len() as f64;
    let score = rays.iter().map(|r| r.2).sum::<f32>() / rays.len() as f32;
    let agreement = (1.0 / (1.0 + (error / HALF_ERROR).powi(2))) as f32;
    Some(Point { position, confidence: (score / CERTAIN).min(1.0) * agreement, error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::tests::{TWO, pixel};
    use crate::calibration::{Rig, tests::read};

    fn rays(rig: &Rig, point: DVec3) -> Vec<Ray<'_>> {
        rig.cameras.iter().map(|c| (c, c.ray(pixel(c, point)), 0.8)).collect()
    }

    #[test]
    fn rays_meet_where_they_came_from() {
        let rig = read(TWO.as_bytes()).unwrap();
        for point in [DVec3::new(0.3, 0.2, 1.1), DVec3::new(-0.5, 0.4, 0.1)] {
            let found = triangulate(&rays(&rig, point)).unwrap();
            assert!(found.position.distance(point) < 1e-6 && found.error < 1e-3, "{found:?}");
            assert!(found.confidence > 0.999);
        }
    }

    #[test]
    fn rays_that_pass_each_other_meet_nowhere() {
        let rig = read(TWO.as_bytes()).unwrap();
        let mut wrong = rays(&rig, DVec3::new(0.3, 0.2, 1.1));
        wrong[1].1.y += 0.2;
        assert_eq!(triangulate(&wrong), None);
        assert_eq!(triangulate(&wrong[..1]), None);
        // The same camera twice sees the point from one place.
        let twice = [wrong[0], wrong[0]];
        assert_eq!(triangulate(&twice), None);
    }

    #[test]
    fn one_camera_that_is_wrong_is_left_out() {
        let text = TWO.replace("[a]", "[c]").replace("[b]", "[d]").replace("[metadata]\nframe_rate = 50\n", "");
        let text = format!("{TWO}{}", text.replace("translation = [0.0, 1.0, 3.0]", "translation = [0.4, 1.0, 3.0]"));
        let rig = read(text.as_bytes()).unwrap();
        let point = DVec3::new(0.1, 0.2, 1.3);
        let mut seen = rays(&rig, point);
        seen[2].1 += DVec2::new(0.15, -0.1);
        let found = triangulate(&seen).unwrap();
        assert!(found.position.distance(point) < 1e-6, "{found:?}");
    }
}
