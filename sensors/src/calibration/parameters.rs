//! Parameters of one calibrated camera. Impossible values are refused, and the message names the mistake behind them.

use glam::{DMat3, DVec3};

use toile_base::limits::{MAX_COORDINATE, MAX_SIDE};

/// Largest distortion coefficient of a lens that is no fisheye.
const LARGEST_DISTORTION: f64 = 10.0;

/// Most distortion coefficients that are read.
const MOST_DISTORTION: usize = 5;

/// Farthest that a rotation's columns may be from unit length and from a right angle.
const ORTHONORMAL: f64 = 1e-3;

/// A principal point within this fraction of the picture's side from its middle is an ordinary one.
const NEAR_MIDDLE: f64 = 0.2;

/// Fewest metres that would be plausible as millimetres: a camera nearer than that shows nothing of a person.
const LEAST_MILLIMETRES: f64 = 200.0;

/// Calibration of one camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraParameters {
    /// Width and height of its pictures (px).
    pub size: [f64; 2],
    /// The matrix K, by rows.
    pub matrix: [[f64; 3]; 3],
    /// k1, k2, p1, p2 and k3: Brown 1971.
    pub distortion: Vec<f64>,
    /// From world to camera.
    pub rotation: DMat3,
    /// From world to camera (m).
    pub translation: DVec3,
}

impl CameraParameters {
    /// Whether a camera can have them.
    pub(super) fn check(&self) -> Result<(), String> {
        let side = f64::from(MAX_SIDE);
        if !self.size.iter().all(|s| (1.0..=side).contains(s)) {
            return Err("its image has no plausible size".to_owned());
        }
        matrix(self)?;
        if self.distortion.len() > MOST_DISTORTION {
            let count = self.distortion.len();
            return Err(format!("{count} distortion coefficients where at most {MOST_DISTORTION} are read"));
        }
        if !self.distortion.iter().all(|k| k.abs() < LARGEST_DISTORTION) {
            return Err("its distortion is not that of a camera".to_owned());
        }
        rotation(&self.rotation)?;
        let t = self.translation;
        if !t.is_finite() || t.abs().max_element() > f64::from(MAX_COORDINATE) {
            let far = t.length();
            return Err(if (LEAST_MILLIMETRES..1e5).contains(&far) {
                format!("its translation is {far:.0} long, which is {:.1} m in millimetres; give metres", far / 1e3)
            } else {
                "its pose is not that of a camera".to_owned()
            });
        }
        Ok(())
    }
}

fn matrix(given: &CameraParameters) -> Result<(), String> {
    let [[fx, _, cx], [_, fy, cy], [a, b, _]] = given.matrix;
    if a.abs() > 1.0 && b.abs() > 1.0 && cx == 0.0 && cy == 0.0 {
        return Err(
            "its matrix is transposed: the principal point stands in the last row and not in the last column".into()
        );
    }
    if ![fx, fy].iter().all(|f| (1.0..1e6).contains(f)) || ![cx, cy].iter().all(|c| c.abs() < 1e6) {
        return Err("its matrix is not that of a camera".to_owned());
    }
    let [w, h] = given.size;
    let near = |c: f64, side: f64| (c - side / 2.0).abs() <= NEAR_MIDDLE * side;
    if !(near(cx, w) && near(cy, h)) && near(cy, w) && near(cx, h) {
        return Err(format!(
            "its principal point ({cx:.0}, {cy:.0}) fits a picture of {h:.0} x {w:.0} and not of {w:.0} x {h:.0}: two columns are exchanged"
        ));
    }
    Ok(())
}

fn rotation(r: &DMat3) -> Result<(), String> {
    if !r.is_finite() {
        return Err("its rotation is not that of a camera".to_owned());
    }
    let [x, y, z] = [r.x_axis, r.y_axis, r.z_axis];
    let lengths = [x, y, z].iter().all(|c| (c.length() - 1.0).abs() < ORTHONORMAL);
    let angles = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|d| d.abs() < ORTHONORMAL);
    if !lengths || !angles {
        return Err("its rotation is no rotation: columns are not of length 1 at right angles".to_owned());
    }
    if r.determinant() < 0.0 {
        return Err("its rotation mirrors (determinant -1): the world is left-handed or two columns are exchanged; \
                    turn one axis round"
            .to_owned());
    }
    Ok(())
}
