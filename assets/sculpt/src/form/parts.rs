//! The parts that a form is made of, each a distance to its surface (mm), negative inside.

use glam::{EulerRot, Mat3, Quat, Vec3};
use serde::Deserialize;

use super::spline::Spline;
use toile_base::cone::round_cone;

/// A limb or trunk: superellipse sections across a straight axis.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TubeRow {
    #[serde(rename = "name")]
    pub _name: String,
    /// A point of the axis, its direction, and the two directions of its sections, all at right angles.
    pub origin: [f32; 3],
    pub axis: [f32; 3],
    pub u: [f32; 3],
    pub v: [f32; 3],
    /// Radius of the fillet where it meets the parts before it.
    pub blend: f32,
    /// Radius of the rounding of its two ends.
    pub round: f32,
    /// `[place, centre u, centre v, +u, +v, -u, -v, exponent on the side of +v, of -v]`.
    pub sections: Vec<[f32; 9]>,
}

/// A chain of balls joined by round cones.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BallChain {
    #[serde(rename = "name")]
    pub _name: String,
    pub blend: f32,
    /// `[x, y, z, radius]`.
    pub balls: Vec<[f32; 4]>,
}

/// An ellipsoid, added or (with `carve`) taken away.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ellipsoid {
    #[serde(rename = "name")]
    pub _name: String,
    pub at: [f32; 3],
    pub radii: [f32; 3],
    /// Turns about x, then y, then z (degrees).
    #[serde(default)]
    pub turn: [f32; 3],
    pub blend: f32,
    #[serde(default)]
    pub carve: bool,
    #[serde(skip)]
    axes: Mat3,
}

/// A swelling (or with a negative height a hollow) of the finished surface: a Gaussian about a point.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bump {
    #[serde(rename = "name")]
    pub _name: String,
    pub at: [f32; 3],
    /// Standard deviations along its own axes.
    pub size: [f32; 3],
    #[serde(default)]
    pub turn: [f32; 3],
    pub height: f32,
    #[serde(skip)]
    axes: Mat3,
}

/// A [`TubeRow`] ready to be asked.
#[derive(Debug)]
pub(super) struct Tube {
    origin: Vec3,
    axis: Vec3,
    u: Vec3,
    v: Vec3,
    pub blend: f32,
    round: f32,
    sections: Spline,
}

impl Tube {
    pub(super) fn new(row: &TubeRow) -> Self {
        let axis = Vec3::from(row.axis).normalize();
        let v = Vec3::from(row.v).reject_from_normalized(axis).normalize();
        let u = Vec3::from(row.u).reject_from_normalized(axis).normalize();
        let sections = Spline::new(&row.sections);
        Self { origin: row.origin.into(), axis, u, v, blend: row.blend, round: row.round, sections }
    }

    /// Distance, first order near the surface.
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        let d = p - self.origin;
        let place = d.dot(self.axis);
        let (s, slope) = self.sections.at(place);
        let (u, v) = (d.dot(self.u) - s[0], d.dot(self.v) - s[1]);
        let away = (u * u + v * v).sqrt().max(1e-3);
        let (h, radius) = radial(u, v, away, &s);
        // The radius a millimetre on, for the slope of the surface against the axis.
        let ahead: [f32; 8] = std::array::from_fn(|k| s[k] + slope[k]);
        let (u2, v2) = (d.dot(self.u) - ahead[0], d.dot(self.v) - ahead[1]);
        let away2 = (u2 * u2 + v2 * v2).sqrt().max(1e-3);
        let lean = ((away2 - radial(u2, v2, away2, &ahead).1) - (away - radius)).abs().min(6.0);
        let side = (away * (1.0 - 1.0 / h.max(1e-3))).max(-radius) / (1.0 + lean * lean).sqrt();
        let [first, last] = self.sections.range();
        let end = (first - place).max(place - last);
        smooth_max(side, end, self.round)
    }
}

/// How far out (u, v) lies as a share of the section's radius that way, and that radius.
fn radial(u: f32, v: f32, away: f32, s: &[f32; 8]) -> (f32, f32) {
    let a = if u >= 0.0 { s[2] } else { s[4] }.max(1.0);
    let (b, n) = if v >= 0.0 { (s[3].max(1.0), s[6]) } else { (s[5].max(1.0), s[7]) };
    let h = ((u / a).abs().powf(n) + (v / b).abs().powf(n)).powf(1.0 / n);
    (h, away / h.max(1e-6))
}

impl BallChain {
    pub(super) fn mirrored(&self) -> Option<Self> {
        let beside = self.balls.iter().any(|b| b[0].abs() > 0.1);
        beside.then(|| Self { balls: self.balls.iter().map(|b| [-b[0], b[1], b[2], b[3]]).collect(), ..self.clone() })
    }

    pub(super) fn distance(&self, p: Vec3) -> f32 {
        let ball = |b: &[f32; 4]| (Vec3::new(b[0], b[1], b[2]), b[3]);
        let joined = self.balls.windows(2).map(|w| round_cone(p, ball(&w[0]), ball(&w[1])).0);
        joined.fold(f32::MAX, f32::min)
    }
}

/// The axes of a turned part, as columns.
fn axes(turn: [f32; 3]) -> Mat3 {
    let [x, y, z] = turn.map(f32::to_radians);
    Mat3::from_quat(Quat::from_euler(EulerRot::ZYX, z, y, x))
}

/// A point, a direction's turn, mirrored in x = 0.
fn mirrored_turn([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, -y, -z]
}

impl Ellipsoid {
    pub(super) fn mirrored(&self) -> Option<Self> {
        let [x, y, z] = self.at;
        (x.abs() > 0.1).then(|| Self { at: [-x, y, z], turn: mirrored_turn(self.turn), ..self.clone() })
    }

    pub(super) fn turned(self) -> Self {
        Self { axes: axes(self.turn), ..self }
    }

    /// Distance, first order near the surface.
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        let q = self.axes.transpose() * (p - Vec3::from(self.at));
        let radii = Vec3::from(self.radii);
        let (k0, k1) = ((q / radii).length(), (q / (radii * radii)).length());
        if k1 < 1e-9 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
    }
}

impl Bump {
    pub(super) fn mirrored(&self) -> Option<Self> {
        let [x, y, z] = self.at;
        (x.abs() > 0.1).then(|| Self { at: [-x, y, z], turn: mirrored_turn(self.turn), ..self.clone() })
    }

    pub(super) fn turned(self) -> Self {
        Self { axes: axes(self.turn), ..self }
    }

    pub(super) fn swelling(&self, p: Vec3) -> f32 {
        let d = p - Vec3::from(self.at);
        let reach = 3.5 * self.size[0].max(self.size[1]).max(self.size[2]);
        if d.length_squared() > reach * reach {
            return 0.0;
        }
        let q = self.axes.transpose() * d / Vec3::from(self.size);
        self.height * (-0.5 * q.length_squared()).exp()
    }
}

/// The lesser of two distances, with a fillet where they are within `k` of each other (cubic, continuous curvature).
pub(super) fn smooth_min(a: f32, b: f32, k: f32) -> f32 {
    if k <= 0.0 {
        return a.min(b);
    }
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * h * k / 6.0
}

/// The greater of two distances, its edge rounded.
pub(super) fn smooth_max(a: f32, b: f32, k: f32) -> f32 {
    -smooth_min(-a, -b, k)
}
