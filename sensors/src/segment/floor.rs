//! The floor: a plane found by random sampling (Fischler and Bolles 1981, with its own seed) and fitted by iteratively
//! reweighted least squares with Tukey's biweight.

use glam::{Mat3, Vec3};

use super::grid::Grid;
use crate::rng::Rng;

/// Planes that are tried where none is known: with a tenth of all points on the floor, one try in a thousand hits three
/// of them, but a floor worth having holds a quarter, of which 300 tries miss one in 100.
const TRIES: usize = 300;

/// Points looked at, spread over the image.
const SAMPLES: usize = 4_000;

/// The floor is at most so far from where the pose says that it is (rad), 40 degrees: a pose may be assumed.
const LARGEST_TILT: f32 = 40.0 * std::f32::consts::PI / 180.0;

/// Heights at which a camera is mounted (m).
const CAMERA_HEIGHT: std::ops::RangeInclusive<f32> = 0.15..=3.0;

/// Farther than this a depth camera sees a floor too askew to count (m).
const FARTHEST: f32 = 6.0;

/// A floor reaches at least so far in both directions (m); soles, seats and shelves do not.
const SHORTEST: f32 = 0.5;

/// A floor holds at least this fraction of what is seen, and below it lies at most this fraction of it.
const SMALLEST_SHARE: f32 = 0.03;
const LARGEST_UNDER: f32 = 0.2;

/// Rounds of the robust fit.
const ROUNDS: usize = 6;

/// A floor that shows less than this of what it was found on is sought anew.
const WORN: f32 = 0.4;

/// A plane in camera axes: the height of a point p above it is `up . p + height`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Unit normal, upward, in camera axes.
    pub up: Vec3,
    /// Height of the camera above it (m).
    pub height: f32,
}

impl Floor {
    /// Height of a point in camera axes (m).
    pub fn above(&self, p: Vec3) -> f32 {
        self.up.dot(p) + self.height
    }
}

/// Where no floor was found, it is sought again after so many frames: the search costs more than all that follows.
const PAUSE: u32 = 15;

/// Finds the floor and keeps it: a camera in a shop does not move.
#[derive(Debug, Clone, Default)]
pub struct FloorFinder {
    floor: Option<Floor>,
    /// Weight of the points that it was found on.
    support: f32,
    /// Frames until the next search.
    pause: u32,
    points: Vec<Vec3>,
}

/// Half of the thickness of a floor at a distance (m): its noise and its unevenness.
fn thickness(z: f32) -> f32 {
    0.012 + 0.003 * z * z
}

/// Tukey's biweight of a residual, both in units of where it ends.
fn biweight(residual: f32) -> f32 {
    let inside = (1.0 - residual * residual).max(0.0);
    inside * inside
}

impl FloorFinder {
    /// The floor, once it was seen.
    pub fn floor(&self) -> Option<&Floor> {
        self.floor.as_ref()
    }

    /// Looks at the next frame. `up` is where the camera's pose says that up is, in camera axes.
    pub(super) fn push(&mut self, grid: &Grid, up: Vec3) {
        let valid = grid.depth.iter().filter(|z| **z > 0.0 && **z < FARTHEST).count();
        let stride = valid.div_ceil(SAMPLES).max(1);
        self.points.clear();
        let cells = (0..grid.depth.len()).filter(|c| grid.depth[*c] > 0.0 && grid.depth[*c] < FARTHEST);
        self.points.extend(cells.step_by(stride).map(|c| grid.point(c)));
        let kept = self.floor.map(|floor| fit(&self.points, floor, 2)).filter(|f| is_floor(&self.points, f, up));
        if let Some(floor) = kept
            && score(&self.points, &floor) > WORN * self.support
        {
            self.floor = Some(floor);
            return;
        }
        self.pause = self.pause.saturating_sub(1);
        if self.pause > 0 {
            return;
        }
        self.pause = PAUSE;
        if let Some(floor) = sought(&self.points, up) {
            self.support = score(&self.points, &floor);
            self.floor = Some(floor);
        }
    }
}

/// The floor among some points, if there is one.
fn sought(points: &[Vec3], up: Vec3) -> Option<Floor> {
    let count = points.len() as u64;
    if count < 200 {
        return None;
    }
    let mut rng = Rng::new(0x000f_1008);
    let mut best: Option<(f32, Floor)> = None;
    for _ in 0..TRIES {
        let [a, b, c] = std::array::from_fn(|_| points[(rng.next_u64() % count) as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let normal = if normal.dot(up) < 0.0 { -normal } else { normal };
        let floor = Floor { up: normal, height: -normal.dot(a) };
        if normal.angle_between(up) > LARGEST_TILT || !CAMERA_HEIGHT.contains(&floor.height) {
            continue;
        }
        let value = score(points, &floor);
        if best.is_none_or(|(b, _)| value > b) {
            best = Some((value, floor));
        }
    }
    let floor = fit(points, best?.1, ROUNDS);
    is_floor(points, &floor, up).then_some(floor)
}

/// How much lies on a plane, less twice what lies below it: a shelf has a floor under it.
fn score(points: &[Vec3], floor: &Floor) -> f32 {
    let value = |p: &Vec3| {
        let residual = floor.above(*p) / (2.0 * thickness(p.z));
        if residual < -2.0 { -2.0 } else { biweight(residual) }
    };
    points.iter().map(value).sum()
}

/// The plane again, fitted to what lies near it: its height over the two directions along it, by weighted least squares.
fn fit(points: &[Vec3], floor: Floor, rounds: usize) -> Floor {
    let mut floor = floor;
    for _ in 0..rounds {
        let along = floor.up.any_orthonormal_vector();
        let across = floor.up.cross(along);
        let (mut normal, mut right) = (Mat3::ZERO, Vec3::ZERO);
        for p in points {
            let above = floor.above(*p);
            let weight = biweight(above / (2.0 * thickness(p.z)));
            let row = Vec3::new(p.dot(along), p.dot(across), 1.0);
            normal += Mat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
            right += row * (weight * above);
        }
        if normal.determinant().abs() < 1e-6 {
            return floor;
        }
        let slope = normal.inverse() * right;
        let up = floor.up - along * slope.x - across * slope.y;
        let length = up.length();
        let next = Floor { up: up / length, height: (floor.height - slope.z) / length };
        if !next.up.is_finite() || !next.height.is_finite() {
            return floor;
        }
        floor = next;
    }
    floor
}

/// Whether a plane is a floor: level enough, below the camera, wide both ways, with little beneath.
fn is_floor(points: &[Vec3], floor: &Floor, up: Vec3) -> bool {
    if floor.up.angle_between(up) > LARGEST_TILT || !CAMERA_HEIGHT.contains(&floor.height) {
        return false;
    }
    let ahead = (Vec3::Z - floor.up * floor.up.z).normalize_or_zero();
    let right = floor.up.cross(ahead);
    let (mut on, mut under) = (0, 0);
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for p in points {
        let above = floor.above(*p);
        if above.abs() < thickness(p.z) {
            let place = Vec3::new(p.dot(right), p.dot(ahead), 0.0);
            (low, high) = (low.min(place), high.max(place));
            on += 1;
        } else if above < -3.0 * thickness(p.z) {
            under += 1;
        }
    }
    let reach = high - low;
    let (on, under) = (on as f32, under as f32);
    on > SMALLEST_SHARE * points.len() as f32 && under < LARGEST_UNDER * on && reach.x > SHORTEST && reach.y > SHORTEST
}
