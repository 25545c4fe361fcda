//! Landmarks made steady from frame to frame: One Euro filters, of the settings that MediaPipe has for its own.
//!
//! The joints are filtered once more by the sensor thread as those of any sensor are; this filter serves the network's own
//! needs: the region of the next frame, and directions that do not tremble while a person stands.

use glam::{Vec2, Vec3};
use toile_sensors::filter::one_euro::{OneEuro, OneEuroSettings};

use crate::landmarks::{Landmarks, POINTS};

/// Of the body's landmarks, in metres.
const BODY: OneEuroSettings = OneEuroSettings { min_cutoff: 0.1, beta: 40.0 };

/// Of the body's depth, in sizes of the body at which the landmark moves in the picture: depth is a guess, and what stands still in the
/// picture does not come nearer by jumps.
const DEPTH: OneEuroSettings = OneEuroSettings { min_cutoff: 0.3, beta: 10.0 };

/// Of the landmarks in the picture, in sizes of the body.
const PICTURE: OneEuroSettings = OneEuroSettings { min_cutoff: 0.1, beta: 40.0 };

/// Of the two points that say where to look next, in sizes of the body.
const NEXT: OneEuroSettings = OneEuroSettings { min_cutoff: 0.01, beta: 1.0 };

/// Longest time between two frames that is smoothed across (s).
const LONGEST: f32 = 0.5;

/// Filters of one person.
#[derive(Debug)]
pub struct LandmarkFilter {
    body: [OneEuro; POINTS],
    depth: [OneEuro; POINTS],
    picture: [OneEuro; POINTS],
    next: [OneEuro; 2],
    last_ns: Option<u64>,
}

impl Default for LandmarkFilter {
    fn default() -> Self {
        let one = OneEuro::default();
        Self { body: [one; POINTS], depth: [one; POINTS], picture: [one; POINTS], next: [one; 2], last_ns: None }
    }
}

impl LandmarkFilter {
    /// Forgets the person who was seen.
    pub fn reset(&mut self) {
        self.last_ns = None;
    }

    /// Takes landmarks of a time (ns) in a region of this side (px), and smooths them.
    pub fn push(&mut self, landmarks: &mut Landmarks, side: f32, time_ns: u64) {
        let step = self.last_ns.map(|last| time_ns.saturating_sub(last) as f32 * 1e-9).filter(|dt| *dt <= LONGEST);
        self.last_ns = Some(time_ns);
        let smooth = |filter: &mut OneEuro, measured: Vec3, settings: &OneEuroSettings| {
            match step {
                None => *filter = OneEuro { level: measured, velocity: Vec3::ZERO },
                Some(dt) => filter.update(measured, dt, filter.speed(measured, dt), settings),
            }
            filter.level
        };
        let filters = self.body.iter_mut().zip(&mut self.depth).zip(&mut self.picture);
        for (point, ((body, depth), picture)) in landmarks.points.iter_mut().zip(filters) {
            let away = Vec3::Z * point.world.z;
            point.world = smooth(body, point.world, &BODY);
            point.pixel = scaled(point.pixel, side, |p| smooth(picture, p, &PICTURE));
            point.world.z = match step {
                None => {
                    *depth = OneEuro { level: away, velocity: Vec3::ZERO };
                    away.z
                }
                Some(dt) => {
                    depth.update(away, dt, picture.velocity.length(), &DEPTH);
                    depth.level.z
                }
            };
        }
        for (point, filter) in landmarks.next.iter_mut().zip(&mut self.next) {
            *point = scaled(*point, side, |p| smooth(filter, p, &NEXT));
        }
    }
}

/// Pixels in sizes of the body: how fast something is does not depend on how far away it is.
fn scaled(pixel: Vec2, side: f32, mut smooth: impl FnMut(Vec3) -> Vec3) -> Vec2 {
    smooth((pixel / side).extend(0.0)).truncate() * side
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::landmarks::PoseLandmark;

    fn landmarks(x: f32) -> Landmarks {
        let point = PoseLandmark { pixel: Vec2::splat(100.0 + x), world: Vec3::splat(x * 1e-3), confidence: 1.0 };
        Landmarks { presence: 1.0, points: [point; POINTS], next: [point.pixel; 2] }
    }

    #[test]
    fn what_trembles_becomes_steady_and_what_moves_is_followed() {
        let mut filter = LandmarkFilter::default();
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        for i in 0..60 {
            let mut seen = landmarks(if i % 2 == 0 { 1.0 } else { -1.0 });
            filter.push(&mut seen, 400.0, i * 33_000_000);
            if i > 30 {
                (low, high) = (low.min(seen.points[0].world.x), high.max(seen.points[0].world.x));
            }
        }
        assert!(high - low < 1.5e-3, "2 mm of trembling are {} mm", (high - low) * 1e3);
        for i in 60..70 {
            filter.push(&mut landmarks((i - 60) as f32 * 50.0), 400.0, i * 33_000_000);
        }
        let mut seen = landmarks(500.0);
        filter.push(&mut seen, 400.0, 70 * 33_000_000);
        assert!(seen.points[0].world.x > 0.48, "{}", seen.points[0].world.x);
    }

    #[test]
    fn a_new_person_begins_where_they_are() {
        let mut filter = LandmarkFilter::default();
        filter.push(&mut landmarks(0.0), 400.0, 0);
        filter.reset();
        let mut seen = landmarks(300.0);
        filter.push(&mut seen, 400.0, 33_000_000);
        assert_eq!(seen.points, landmarks(300.0).points);
        // Whatever its stamps do, nothing becomes NaN.
        filter.push(&mut seen, 400.0, 0);
        assert!(seen.is_finite());
    }
}
