//! Interpolation between two snapshots, for the time of display.
//!
//! Physics publishes at 120 Hz and the display shows at its own rate, so a picture falls between two snapshots. It is drawn
//! one step late, between the newest and the one before, vertex by vertex along a straight line: nothing that was not
//! computed on both sides is ever shown, as extrapolation would.

use glam::Vec3;

/// One surface at one time.
#[derive(Debug, Clone, PartialEq, Default)]
struct SurfaceSnapshot {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl SurfaceSnapshot {
    fn take(&mut self, positions: &[Vec3], normals: &[Vec3]) {
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        self.normals.clear();
        self.normals.extend_from_slice(normals);
    }
}

/// The previous and the newest places of one surface, and what lies between them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceInterpolation {
    previous: SurfaceSnapshot,
    newest: SurfaceSnapshot,
    shown: SurfaceSnapshot,
    times_ns: [u64; 2],
    known: usize,
}

impl SurfaceInterpolation {
    /// Interpolation before the first snapshot.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes over a snapshot of this time (ns, the clock of its publication): positions (m) and unit normals `[vertices]`.
    /// One of another length, or older than the newest, starts over: there is nothing to interpolate between two garments.
    pub fn push(&mut self, time_ns: u64, positions: &[Vec3], normals: &[Vec3]) {
        let alike = self.newest.positions.len() == positions.len() && self.newest.normals.len() == normals.len();
        if !alike || time_ns < self.times_ns[1] {
            self.known = 0;
        }
        std::mem::swap(&mut self.previous, &mut self.newest);
        self.newest.take(positions, normals);
        self.times_ns = [if self.known == 0 { time_ns } else { self.times_ns[1] }, time_ns];
        self.known = (self.known + 1).min(2);
    }

    /// True once there is something to show.
    pub fn ready(&self) -> bool {
        self.known > 0
    }

    /// The share of the way from the previous to the newest (0..1) that a picture shown at this time stands at (ns): one
    /// period after the newest was published it stands at the newest.
    pub fn share(&self, now_ns: u64) -> f32 {
        let [from, to] = self.times_ns;
        let period = to.saturating_sub(from);
        if period == 0 {
            return 1.0;
        }
        (now_ns.saturating_sub(to) as f64 / period as f64).min(1.0) as f32
    }

    /// Positions (m) and unit normals `[vertices]` at a share of the way, cut to 0..1. A vertex whose normals cancel keeps
    /// the newest one.
    pub fn at(&mut self, share: f32) -> (&[Vec3], &[Vec3]) {
        let share = if share.is_nan() { 1.0 } else { share.clamp(0.0, 1.0) };
        if self.known < 2 || share == 1.0 {
            return (&self.newest.positions, &self.newest.normals);
        }
        let between = |(a, b): (&Vec3, &Vec3)| a.lerp(*b, share);
        let turned = |(a, b): (&Vec3, &Vec3)| a.lerp(*b, share).normalize_or(*b);
        let Self { previous, newest, shown, .. } = self;
        shown.positions.clear();
        shown.positions.extend(previous.positions.iter().zip(&newest.positions).map(between));
        shown.normals.clear();
        shown.normals.extend(previous.normals.iter().zip(&newest.normals).map(turned));
        (&self.shown.positions, &self.shown.normals)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halfway_is_halfway_and_the_ends_are_exact() {
        let mut blend = SurfaceInterpolation::new();
        assert!(!blend.ready());
        blend.push(1_000, &[Vec3::ZERO, Vec3::ONE], &[Vec3::X, Vec3::Y]);
        assert_eq!(blend.at(0.3).0, [Vec3::ZERO, Vec3::ONE], "one snapshot is shown as it is");
        blend.push(9_000, &[Vec3::X, Vec3::ONE], &[Vec3::Y, Vec3::Y]);
        assert_eq!(blend.at(0.0).0, [Vec3::ZERO, Vec3::ONE]);
        assert_eq!(blend.at(1.0).0, [Vec3::X, Vec3::ONE]);
        let (positions, normals) = blend.at(0.5);
        assert_eq!(positions, [Vec3::X * 0.5, Vec3::ONE]);
        assert!(normals[0].is_normalized() && (normals[0].x - normals[0].y).abs() < 1e-6);
        assert_eq!(blend.at(f32::NAN).0[0], Vec3::X);
        assert_eq!(blend.at(7.0).0[0], Vec3::X);
    }

    #[test]
    fn the_share_grows_over_one_period_and_then_waits() {
        let mut blend = SurfaceInterpolation::new();
        assert_eq!(blend.share(5), 1.0);
        blend.push(1_000, &[Vec3::ZERO], &[]);
        assert_eq!(blend.share(1_000), 1.0, "one snapshot has nothing before it");
        blend.push(9_000, &[Vec3::X], &[]);
        assert_eq!(blend.share(8_000), 0.0);
        assert_eq!(blend.share(9_000), 0.0);
        assert_eq!(blend.share(13_000), 0.5);
        assert_eq!(blend.share(90_000), 1.0);
    }

    #[test]
    fn another_garment_or_a_clock_that_steps_back_begins_anew() {
        let mut blend = SurfaceInterpolation::new();
        blend.push(1_000, &[Vec3::ZERO], &[Vec3::X]);
        blend.push(2_000, &[Vec3::X; 3], &[Vec3::X; 3]);
        assert_eq!(blend.at(0.0).0, [Vec3::X; 3]);
        blend.push(1_500, &[Vec3::Y; 3], &[Vec3::X; 3]);
        assert_eq!(blend.at(0.0).0, [Vec3::Y; 3]);
    }

    #[test]
    fn normals_that_cancel_keep_the_newest() {
        let mut blend = SurfaceInterpolation::new();
        blend.push(1, &[Vec3::ZERO], &[Vec3::X]);
        blend.push(2, &[Vec3::ZERO], &[Vec3::NEG_X]);
        assert_eq!(blend.at(0.5).1, [Vec3::NEG_X]);
    }
}
