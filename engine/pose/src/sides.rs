//! Keeps left and right from picture to picture: in single pictures the network takes a person's front for their back, and limbs change their
//! sides, all of them or some, in the picture, in its body in metres, or in both, with depth to match.
//!
//! With d the way from the right to the left one of a pair, a person who turns round shows a profile first, in which d is short. A d that is long in two
//! pictures, one after the other, and points the other way in the second is no turn; nor is a body in metres whose d points the other way
//! than that of the picture. Such a picture counts for nothing: the landmarks of the last one stay.

use glam::Vec2;

use crate::landmarks::{Landmarks, POINTS, PoseLandmark};
use crate::plausible::{HIPS, SHOULDERS};

/// Landmarks of a picture.
type Points = [PoseLandmark; POINTS];

/// Pairs that are looked at, left and right.
const PAIRS: [[usize; 2]; 6] = [SHOULDERS, HIPS, [13, 14], [15, 16], [25, 26], [27, 28]];

/// A pair lies apart from this on (lengths of the trunk): hips that are seen from the front do.
const APART: f32 = 0.3;

/// A way is the opposite of the last one but for so much of it (1): a person who turned since then has another length of it.
const OPPOSITE: f32 = 0.5;

/// The body in metres points another way than the picture from this cosine on (1): 120 degrees.
const TORN: f32 = -0.5;

/// Longest time between two pictures that are compared (ns): a person could have turned round by then.
const LONGEST_NS: u64 = 100_000_000;

/// Pictures after which the network is believed, for it may have been wrong before: a third of a second.
const MOST: u32 = 10;

/// The last picture that counted.
#[derive(Debug, Clone, Copy, Default)]
pub struct SideKeeper {
    last: Option<Points>,
    /// When something was last seen (ns), and pictures with exchanged sides since it counted.
    seen_ns: u64,
    exchanged: u32,
}

impl SideKeeper {
    /// Forgets the person who was seen.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Takes the landmarks of a picture of a time (ns); where sides are exchanged in it they become those of the last one, and it says so.
    pub fn keep(&mut self, landmarks: &mut Landmarks, time_ns: u64) -> bool {
        let soon = time_ns.saturating_sub(self.seen_ns) <= LONGEST_NS;
        self.seen_ns = time_ns;
        let is_wrong = |last: &Points| is_torn(&landmarks.points) || is_exchanged(last, &landmarks.points);
        let last = self.last.filter(|last| soon && self.exchanged < MOST && is_wrong(last));
        if let Some(last) = last {
            landmarks.points = last;
            self.exchanged += 1;
            return true;
        }
        (self.last, self.exchanged) = (Some(landmarks.points), 0);
        false
    }
}

/// Whether any pair has changed its sides, in the picture or in metres.
fn is_exchanged(last: &Points, now: &Points) -> bool {
    [pixel as LandmarkPlace, metre].iter().any(|place| {
        let apart = APART * trunk(last, *place);
        PAIRS.iter().any(|pair| {
            let (before, after) = (across(last, *pair, *place), across(now, *pair, *place));
            let least = before.length().min(after.length());
            least > apart && (before + after).length() < OPPOSITE * least
        })
    })
}

/// Whether the body in metres has a pair on other sides than the picture has it.
fn is_torn(now: &Points) -> bool {
    let [size, metres] = [pixel as LandmarkPlace, metre].map(|place| APART * trunk(now, place));
    PAIRS.iter().any(|pair| {
        let (seen, body) = (across(now, *pair, pixel), across(now, *pair, metre));
        let apart = seen.length() > size && body.length() > metres;
        apart && seen.dot(body) < TORN * seen.length() * body.length()
    })
}

/// Where a landmark is across: in the picture (px), or in the network's body (m).
type LandmarkPlace = fn(&PoseLandmark) -> Vec2;

fn pixel(point: &PoseLandmark) -> Vec2 {
    point.pixel
}

fn metre(point: &PoseLandmark) -> Vec2 {
    point.world.truncate()
}

fn across(points: &Points, [left, right]: [usize; 2], place: LandmarkPlace) -> Vec2 {
    place(&points[left]) - place(&points[right])
}

fn trunk(points: &Points, place: LandmarkPlace) -> f32 {
    let middle = |[left, right]: [usize; 2]| (place(&points[left]) + place(&points[right])) * 0.5;
    middle(SHOULDERS).distance(middle(HIPS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use std::f32::consts::{PI, TAU};

    const PICTURE_NS: u64 = 33_000_000;

    /// Landmarks that a person is made of here: left and right, half of the way between them, and the row (px).
    const BODY: [([usize; 2], f32, f32); 5] = [
        (SHOULDERS, 34.0, 140.0),
        ([15, 16], 150.0, 150.0),
        (HIPS, 18.0, 237.0),
        ([25, 26], 18.0, 315.0),
        ([27, 28], 18.0, 380.0),
    ];

    /// A person turned by an angle from facing the camera (rad).
    fn turned(angle: f32) -> Landmarks {
        let mut points = [PoseLandmark { confidence: 1.0, ..PoseLandmark::default() }; POINTS];
        let (sin, cos) = angle.sin_cos();
        for (pair, half, y) in BODY {
            for (k, side) in pair.into_iter().zip([1.0, -1.0]) {
                points[k].pixel = Vec2::new(320.0 + side * half * cos, y);
                points[k].world = Vec3::new(side * half * cos, y - 237.0, side * half * sin + 5.0) * 4e-3;
            }
        }
        Landmarks { presence: 1.0, points, next: Default::default() }
    }

    #[test]
    fn single_pictures_of_a_back_count_for_nothing() {
        let (mut keeper, front) = (SideKeeper::default(), turned(0.0));
        for picture in 0..30_u64 {
            let back = [3, 4, 5, 12, 20].contains(&picture);
            let mut seen = turned(if back { PI } else { 0.0 });
            assert_eq!(keeper.keep(&mut seen, picture * PICTURE_NS), back);
            assert_eq!(seen.points, front.points);
        }
        // The arms alone, and that is no picture to be believed either.
        let mut seen = turned(0.0);
        seen.points.swap(15, 16);
        assert!(keeper.keep(&mut seen, 30 * PICTURE_NS));
        assert_eq!(seen.points, front.points);
        // The body in metres alone, which the picture denies.
        let mut seen = turned(0.0);
        seen.points.iter_mut().for_each(|p| p.world.x = -p.world.x);
        assert!(is_torn(&seen.points) && keeper.keep(&mut seen, 31 * PICTURE_NS));
        assert_eq!(seen.points, front.points);
    }

    #[test]
    fn turns_are_kept_and_wrong_starts_are_corrected() {
        let mut keeper = SideKeeper::default();
        // A turn in a second, with arms held out: they are beside each other in one picture, and that may be lost.
        let spin = |picture: u64| turned(picture as f32 / 30.0 * TAU);
        let lost: Vec<u64> = (0..90).filter(|n| keeper.keep(&mut spin(*n), n * PICTURE_NS)).collect();
        assert!(lost.len() <= 6 && lost.windows(2).all(|w| w[1] > w[0] + 1), "{lost:?}");
        keeper.reset();
        keeper.keep(&mut turned(PI), 0);
        let exchanged = (1..40_u64).filter(|n| keeper.keep(&mut turned(0.0), n * PICTURE_NS)).count();
        assert_eq!(exchanged, MOST as usize);
        // After a gap nothing is known of which side they show.
        assert!(!keeper.keep(&mut turned(PI), 60 * PICTURE_NS));
    }
}
