//! The floor: a plane found by random sampling (Fischler and Bolles 1981, with its own seed) and fitted by iteratively
//! reweighted least squares with Tukey's biweight.

use glam::{Affine3A, Mat3, Vec3};

use toile_base::frame::DepthFrame;
use toile_base::numeric::random::SplitMix64;

/// Planes that are tried where none is known, through points of the lower half of what is seen: where the floor holds a
/// quarter of that half, all tries miss it once in a hundred times; half of it, which is usual, never.
const TRIES: usize = 300;

/// Every so many of them judge a try; all of them the fit.
const SPARSE: usize = 4;

/// Points looked at, spread over the image.
const SAMPLES: usize = 4_000;

/// The floor is at most so far from where the pose says that it is (rad), 40 degrees: a pose may be assumed.
const LARGEST_TILT: f32 = 40.0 * std::f32::consts::PI / 180.0;

/// Heights at which a camera is mounted (m).
const CAMERA_HEIGHT: std::ops::RangeInclusive<f32> = 0.15..=3.0;

/// Nearer than this a depth camera measures nothing, and farther it sees a floor too askew to count (mm).
const FIRST_MM: u16 = 300;
const FARTHEST_MM: u16 = 6_000;

/// A floor reaches at least so far in both directions (m); soles, seats and shelves do not.
const SHORTEST: f32 = 0.5;

/// A floor holds at least this fraction of what is seen, and below it lies at most this fraction of it.
const SMALLEST_SHARE: f32 = 0.03;
const LARGEST_UNDER: f32 = 0.2;

/// Rounds of the robust fit.
const ROUNDS: usize = 6;

/// A floor that shows less than this of what it was found on is sought anew.
const WORN: f32 = 0.4;

/// Standard deviation of depth at depth `z` (m), that of a Kinect v1 (Nguyen et al. 2012): other sensors are better.
pub(super) fn sigma(z: f32) -> f32 {
    0.0012 + 0.0019 * (z - 0.4) * (z - 0.4)
}

/// A plane in camera axes: the height of a point p above it is `up . p + height`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Unit normal, upward, in camera axes.
    pub up: Vec3,
    /// Height of the camera above it (m).
    pub height: f32,
}

impl Floor {
    /// The pose (camera to world, m) of a camera that sees this floor at y = 0 and looks towards -z.
    pub fn pose(&self) -> Affine3A {
        let ahead = (Vec3::Z - self.up * self.up.z).try_normalize().unwrap_or(Vec3::NEG_Y);
        let right = ahead.cross(self.up);
        let rotation = Mat3::from_cols(right, self.up, -ahead).transpose();
        Affine3A::from_mat3_translation(rotation, Vec3::Y * self.height)
    }

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

/// Half of the thickness of a floor at a distance, seen from a height (m): its unevenness, and two deviations of the noise
/// along the line of sight as far as that is upright.
fn thickness(z: f32, height: f32) -> f32 {
    0.006 + 2.0 * sigma(z) * (height / z).min(1.0)
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
    pub fn push(&mut self, frame: &DepthFrame, up: Vec3) {
        // Single pixels, not the nearest of a cell, which at a grazing view would lie above the floor.
        let (k, width) = (frame.intrinsics, frame.intrinsics.width as usize);
        let seen = |i: usize| (FIRST_MM..FARTHEST_MM).contains(&frame.depth_mm[i]);
        let valid = (0..frame.depth_mm.len()).filter(|i| seen(*i)).count();
        let stride = (valid / SAMPLES).max(1);
        self.points.clear();
        let pixels = (0..frame.depth_mm.len()).filter(|i| seen(*i)).step_by(stride);
        self.points.extend(
            pixels.map(|i| k.unproject((i % width) as f32, (i / width) as f32, f32::from(frame.depth_mm[i]) * 1e-3)),
        );
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
    if points.len() < 200 {
        return None;
    }
    let mut low = points.to_vec();
    let middle = low.len() / 2;
    low.select_nth_unstable_by(middle, |a, b| a.dot(up).total_cmp(&b.dot(up)));
    low.truncate(middle);
    let mut rng = SplitMix64::new(0x000f_1008);
    let few: Vec<Vec3> = points.iter().copied().step_by(SPARSE).collect();
    let mut best: Option<(f32, Floor)> = None;
    for _ in 0..TRIES {
        let [a, b, c] = std::array::from_fn(|_| low[(rng.next_u64() % low.len() as u64) as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let normal = if normal.dot(up) < 0.0 { -normal } else { normal };
        let floor = Floor { up: normal, height: -normal.dot(a) };
        if normal.angle_between(up) > LARGEST_TILT || !CAMERA_HEIGHT.contains(&floor.height) {
            continue;
        }
        let value = score(&few, &floor);
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
        let residual = floor.above(*p) / (2.0 * thickness(p.z, floor.height));
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
            let weight = biweight(above / (2.0 * thickness(p.z, floor.height)));
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
        if above.abs() < thickness(p.z, floor.height) {
            let place = Vec3::new(p.dot(right), p.dot(ahead), 0.0);
            (low, high) = (low.min(place), high.max(place));
            on += 1;
        } else if above < -3.0 * thickness(p.z, floor.height) {
            under += 1;
        }
    }
    let reach = high - low;
    let (on, under) = (on as f32, under as f32);
    on > SMALLEST_SHARE * points.len() as f32 && under < LARGEST_UNDER * on && reach.x > SHORTEST && reach.y > SHORTEST
}
