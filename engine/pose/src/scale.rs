//! Stature of a person: as they say, or by the floor and the camera's height; never as the network guesses.
//!
//! The heels stand on the floor, the eyes are above them. A camera of known height that is level, or whose tilt is known, sees both
//! under angles that say how far away the heels are, and how high the eyes:
//!
//! ```text
//! distance = camera height / tan(angle down to the heels)
//! height of the eyes = camera height + distance tan(angle up to the eyes)
//! ```
//!
//! Eyes are at 0.936 of the stature (Drillis and Contini 1966).

use glam::Vec2;
use toile_base::numeric::statistics::median;

use crate::landmarks::Landmarks;

/// Landmarks of the eyes and of the heels.
const EYES: [usize; 2] = [2, 5];
const HEELS: [usize; 2] = [29, 30];

/// How sure they have to be.
const SURE: f32 = 0.5;

/// Height of the eyes over the stature.
const EYE_HEIGHT: f32 = 0.936;

/// Stature of whom nothing is known (m): the middle of women and men.
pub const ASSUMED_STATURE: f32 = 1.70;

/// Statures that people have (m).
const STATURES: std::ops::RangeInclusive<f32> = 0.9..=2.3;

/// Least angle under which heels are seen (rad): below it, a pixel is a decimetre.
const LEAST_ANGLE: f32 = 0.05;

/// Estimates whose median is taken: a second.
const ESTIMATES: usize = 31;

/// Fewest of them that count.
const FEWEST: usize = 8;

/// How a webcam stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WebcamMount {
    /// Focal length over the longer side of the picture: 0.87 sees 60 degrees.
    pub focal: f32,
    /// Its height above the floor (m), where that is known.
    pub height_m: Option<f32>,
    /// By how much it looks down (rad).
    pub down: f32,
}

impl Default for WebcamMount {
    fn default() -> Self {
        Self { focal: 0.87, height_m: None, down: 0.0 }
    }
}

toile_base::named! {
    /// Where a stature comes from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum StatureSource {
        /// It was given.
        Given = "as given",
        /// From the floor and the camera's height.
        Floor = "floor and camera height",
        /// Assumed: the middle of all people.
        Assumed = "assumed",
    }
}

/// A person's stature, from frame to frame.
#[derive(Debug)]
pub struct StatureEstimate {
    given: Option<f32>,
    estimates: [f32; ESTIMATES],
    count: usize,
}

impl StatureEstimate {
    /// With what they say (m), where they say it.
    pub fn new(given: Option<f32>) -> Self {
        Self { given: given.filter(|m| STATURES.contains(m)), estimates: [0.0; ESTIMATES], count: 0 }
    }

    /// Another person may stand there.
    pub fn reset(&mut self) {
        self.count = 0;
    }

    /// Looks at landmarks in a picture of this size (px).
    pub fn push(&mut self, landmarks: &Landmarks, size: [u32; 2], mount: &WebcamMount) {
        if let Some(stature) = of_floor(landmarks, size, mount) {
            self.estimates[self.count % ESTIMATES] = stature;
            self.count += 1;
        }
    }

    /// The stature (m), and where it comes from.
    pub fn stature(&self) -> (f32, StatureSource) {
        if let Some(given) = self.given {
            return (given, StatureSource::Given);
        }
        let mut estimates = self.estimates;
        let found = median(&mut estimates[..self.count.min(ESTIMATES)]).filter(|_| self.count >= FEWEST);
        found.map_or((ASSUMED_STATURE, StatureSource::Assumed), |stature| (stature, StatureSource::Floor))
    }
}

/// The stature of one picture (m), where eyes and heels are seen.
fn of_floor(landmarks: &Landmarks, size: [u32; 2], mount: &WebcamMount) -> Option<f32> {
    let height = mount.height_m?;
    let focal = mount.focal * size[0].max(size[1]) as f32;
    let row = |pair: [usize; 2]| -> Option<f32> {
        let seen: Vec2 = pair.iter().map(|k| landmarks.points[*k].pixel).sum();
        pair.iter().all(|k| landmarks.points[*k].confidence >= SURE).then_some(seen.y * 0.5)
    };
    // Angles below the horizon.
    let below = |row: f32| ((row - 0.5 * size[1] as f32) / focal).atan() + mount.down;
    let (heels, eyes) = (below(row(HEELS)?), below(row(EYES)?));
    if heels < LEAST_ANGLE {
        return None;
    }
    let distance = height / heels.tan();
    let stature = (height - distance * eyes.tan()) / EYE_HEIGHT;
    STATURES.contains(&stature).then_some(stature)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::landmarks::{POINTS, PoseLandmark};

    /// A person of a stature as a camera sees them.
    fn seen(stature: f32, distance: f32, mount: &WebcamMount) -> Landmarks {
        let size = [1280.0_f32, 720.0];
        let mut points = [PoseLandmark { confidence: 1.0, ..PoseLandmark::default() }; POINTS];
        let row = |height: f32| {
            let angle = ((mount.height_m.unwrap() - height) / distance).atan() - mount.down;
            360.0 + mount.focal * size[0] * angle.tan()
        };
        EYES.iter().for_each(|k| points[*k].pixel.y = row(EYE_HEIGHT * stature));
        HEELS.iter().for_each(|k| points[*k].pixel.y = row(0.0));
        Landmarks { presence: 1.0, points, next: Default::default() }
    }

    #[test]
    fn the_floor_and_the_cameras_height_give_the_stature() {
        for (stature, distance, height, down) in [(1.7, 2.5, 1.2, 0.0), (1.55, 3.0, 1.6, 0.2), (1.95, 4.0, 1.0, -0.1)] {
            let mount = WebcamMount { height_m: Some(height), down, ..WebcamMount::default() };
            let mut estimate = StatureEstimate::new(None);
            for i in 0..2 * ESTIMATES {
                estimate.push(&seen(stature, distance, &mount), [1280, 720], &mount);
                assert_eq!(estimate.stature().1 == StatureSource::Floor, i + 1 >= FEWEST);
            }
            assert!((estimate.stature().0 - stature).abs() < 2e-3, "{:?} for {stature}", estimate.stature());
            estimate.reset();
            assert_eq!(estimate.stature(), (ASSUMED_STATURE, StatureSource::Assumed));
        }
    }

    #[test]
    fn what_is_given_counts_and_what_cannot_be_does_not() {
        let mount = WebcamMount { height_m: Some(1.2), ..WebcamMount::default() };
        let mut estimate = StatureEstimate::new(Some(1.62));
        (0..FEWEST).for_each(|_| estimate.push(&seen(1.9, 3.0, &mount), [1280, 720], &mount));
        assert_eq!(estimate.stature(), (1.62, StatureSource::Given));
        assert_eq!(StatureEstimate::new(Some(17.0)).stature().1, StatureSource::Assumed);
        let mut hidden = seen(1.9, 3.0, &mount);
        hidden.points[HEELS[0]].confidence = 0.1;
        assert_eq!(of_floor(&hidden, [1280, 720], &mount), None);
        assert_eq!(of_floor(&seen(1.9, 3.0, &mount), [1280, 720], &WebcamMount::default()), None);
    }
}
