//! Matches the people seen by several cameras, and chooses the shopper.
//!
//! Any two people of two cameras are a guess; its points are triangulated, and every other camera adds the person whose
//! keypoints lie nearest to where those points are seen, if near enough. The guess with the most keypoints that agree is
//! the shopper; after the first frame the one who is nearest to where the shopper was, if that is a step away at most.

use super::keypoints::{POINTS, PersonKeypoints, ViewPeople};
use super::triangulate::{Point, Ray, triangulate};
use crate::calibration::Rig;

/// Mean distance of a camera's keypoints from where a guess is seen, up to which they are the same person (px at a
/// focal length of 1000): a hand's breadth at three metres.
const SAME_PERSON: f64 = 40.0;

/// Fewest points by which two views are the same person.
const FEWEST: usize = 4;

/// Farthest that the shopper moves between two frames (m).
const LONGEST_STEP: f64 = 0.5;

/// A person in space.
pub type InSpace = [Point; POINTS];

/// The shopper in one frame, seen by the cameras in order; `last` is the shopper in the last frame.
pub fn shopper(rig: &Rig, seen: &[&ViewPeople], last: Option<&InSpace>) -> Option<InSpace> {
    let mut best: Option<(f64, InSpace)> = None;
    for first in 0..seen.len() {
        for second in first + 1..seen.len() {
            for a in seen[first] {
                for b in seen[second] {
                    let mut chosen = vec![None; seen.len()];
                    (chosen[first], chosen[second]) = (Some(a), Some(b));
                    let Some(person) = grown(rig, seen, &mut chosen) else { continue };
                    let score = score(&person, last);
                    if best.as_ref().is_none_or(|(most, _)| score > *most) {
                        best = Some((score, person));
                    }
                }
            }
        }
    }
    best.map(|(_, person)| person)
}

/// A guess of two views with the other cameras' views of the same person added.
fn grown<'a>(rig: &Rig, seen: &[&'a ViewPeople], chosen: &mut [Option<&'a PersonKeypoints>]) -> Option<InSpace> {
    let guess = in_space(rig, chosen);
    if found(&guess) < FEWEST {
        return None;
    }
    for (camera, people) in seen.iter().enumerate() {
        if chosen[camera].is_none() {
            let off = |person: &PersonKeypoints| distance(rig, camera, person, &guess).unwrap_or(f64::INFINITY);
            let nearest = people.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            chosen[camera] = nearest.filter(|p| off(p) < SAME_PERSON);
        }
    }
    Some(in_space(rig, chosen))
}

/// Each camera's view of a person in space: the one whose keypoints lie nearest to where the points are seen, if near enough.
pub fn views(rig: &Rig, seen: &[&ViewPeople], person: &InSpace) -> Vec<Option<PersonKeypoints>> {
    let view = |(camera, people): (usize, &&ViewPeople)| {
        let off = |p: &PersonKeypoints| distance(rig, camera, p, person).unwrap_or(f64::INFINITY);
        people.iter().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|p| off(p) < SAME_PERSON).copied()
    };
    seen.iter().enumerate().map(view).collect()
}

/// The points of the person whom each camera's choice shows.
fn in_space(rig: &Rig, chosen: &[Option<&PersonKeypoints>]) -> InSpace {
    std::array::from_fn(|k| {
        let mut rays: Vec<Ray> = Vec::with_capacity(chosen.len());
        for (camera, person) in rig.cameras.iter().zip(chosen) {
            if let Some(point) = person.map(|p| p[k]).filter(|p| p.score > 0.0) {
                rays.push((camera, camera.ray(point.pixel), point.score));
            }
        }
        triangulate(&rays).unwrap_or_default()
    })
}

fn found(person: &InSpace) -> usize {
    person.iter().filter(|p| p.confidence > 0.0).count()
}

/// Mean distance of a view's keypoints from where the points of a guess are seen.
fn distance(rig: &Rig, camera: usize, person: &PersonKeypoints, guess: &InSpace) -> Option<f64> {
    let camera = &rig.cameras[camera];
    let (mut sum, mut count) = (0.0, 0);
    for (seen, point) in person.iter().zip(guess) {
        if seen.score > 0.0 && point.confidence > 0.0 {
            sum += camera.project(point.position)?.distance(camera.ray(seen.pixel)) * 1e3;
            count += 1;
        }
    }
    (count >= FEWEST).then(|| sum / count as f64)
}

/// How much a guess is to be believed: the sum of its points' confidence, far more where the shopper was.
fn score(person: &InSpace, last: Option<&InSpace>) -> f64 {
    let sum: f64 = person.iter().map(|p| f64::from(p.confidence)).sum();
    let near = last.and_then(|last| moved(person, last)).is_some_and(|d| d < LONGEST_STEP);
    if near { sum + POINTS as f64 } else { sum }
}

/// Mean distance between the points of two moments (m).
fn moved(now: &InSpace, last: &InSpace) -> Option<f64> {
    let both = || now.iter().zip(last).filter(|(a, b)| a.confidence.min(b.confidence) > 0.0);
    let count = both().count();
    (count > 0).then(|| both().map(|(a, b)| a.position.distance(b.position)).sum::<f64>() / count as f64)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::keypoints::Keypoint;
    use super::*;
    use crate::calibration::tests::read;
    use crate::calibration::tests::{TWO, pixel};

    fn body(at: DVec3) -> [DVec3; POINTS] {
        std::array::from_fn(|k| at + DVec3::new(0.1 * (k % 3) as f64, 0.05 * (k % 4) as f64, 0.06 * k as f64))
    }

    fn view(rig: &Rig, camera: usize, bodies: &[[DVec3; POINTS]]) -> ViewPeople {
        let camera = &rig.cameras[camera];
        bodies.iter().map(|b| b.map(|p| Keypoint { pixel: pixel(camera, p), score: 0.7 })).collect()
    }

    #[test]
    fn of_two_people_each_is_matched_with_themselves_and_the_shopper_is_kept() {
        let rig = read(TWO.as_bytes()).unwrap();
        let (shopper_at, other_at) = (DVec3::new(0.0, 0.0, 0.0), DVec3::new(0.5, 0.7, 0.05));
        let views =
            [view(&rig, 0, &[body(shopper_at), body(other_at)]), view(&rig, 1, &[body(other_at), body(shopper_at)])];
        let seen: Vec<&ViewPeople> = views.iter().collect();
        for start in [shopper_at, other_at] {
            let last = body(start).map(|position| Point { position, confidence: 1.0, error: 0.0 });
            let found = shopper(&rig, &seen, Some(&last)).unwrap();
            assert_eq!(super::found(&found), POINTS);
            assert!(moved(&found, &last).unwrap() < 1e-6);
        }
    }

    #[test]
    fn no_view_and_one_view_give_no_person() {
        let rig = read(TWO.as_bytes()).unwrap();
        let one = view(&rig, 0, &[body(DVec3::ZERO)]);
        assert!(shopper(&rig, &[&one, &Vec::new()], None).is_none());
        assert!(shopper(&rig, &[&Vec::new(), &Vec::new()], None).is_none());
    }
}
