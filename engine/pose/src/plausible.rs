//! Checks that landmarks are those of a person: a network that has lost its way gives impossible bodies.

use glam::Vec3;

use crate::landmarks::Landmarks;

/// Landmarks of hips and shoulders, left and right.
pub const HIPS: [usize; 2] = [23, 24];
/// Landmarks of the left and the right shoulder.
pub const SHOULDERS: [usize; 2] = [11, 12];

/// Limbs, left and right: from, to; and the shortest and the longest that a landmark's own metres have for people (m), from a child of
/// 1.0 m to a person of 2.2 m, and a third of error.
const LIMBS: [([usize; 2], [f32; 2]); 8] = [
    ([11, 13], [0.10, 0.55]),
    ([12, 14], [0.10, 0.55]),
    ([13, 15], [0.08, 0.50]),
    ([14, 16], [0.08, 0.50]),
    ([23, 25], [0.14, 0.75]),
    ([24, 26], [0.14, 0.75]),
    ([25, 27], [0.14, 0.75]),
    ([26, 28], [0.14, 0.75]),
];

/// Length of a trunk (m).
const TRUNK: [f32; 2] = [0.18, 0.90];

/// Breadth of shoulders (m): of a person seen from the side the network may have it short.
const BREADTH: [f32; 2] = [0.05, 0.65];

/// How sure a landmark has to be to count.
const SURE: f32 = 0.5;

/// Whether shoulders or hips are seen, and every limb that is seen has a length that people have.
pub fn is_body(landmarks: &Landmarks) -> bool {
    let at = |k: usize| landmarks.points[k].world;
    let sure = |k: usize| landmarks.points[k].confidence >= SURE;
    let within = |length: f32, [least, most]: [f32; 2]| (least..=most).contains(&length);
    let seen = |pair: [usize; 2]| pair.iter().all(|k| sure(*k));
    let middle = |pair: [usize; 2]| -> Vec3 { (at(pair[0]) + at(pair[1])) * 0.5 };
    let trunk = (middle(SHOULDERS) - middle(HIPS)).length();
    let limbs = LIMBS.iter().filter(|([a, b], _)| sure(*a) && sure(*b));
    let breadth = at(SHOULDERS[0]).distance(at(SHOULDERS[1]));
    (seen(SHOULDERS) || seen(HIPS))
        && within(trunk, TRUNK)
        && (!seen(SHOULDERS) || within(breadth, BREADTH))
        && limbs.into_iter().all(|([a, b], range)| within(at(*a).distance(at(*b)), *range))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::landmarks::{POINTS, PoseLandmark};

    fn person() -> Landmarks {
        let mut points = [PoseLandmark { confidence: 1.0, ..PoseLandmark::default() }; POINTS];
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let places = [(11, [0.18, -0.5]), (13, [0.2, -0.22]), (15, [0.2, 0.04])];
            let legs = [(23, [0.1, 0.0]), (25, [0.1, 0.4]), (27, [0.1, 0.8])];
            for (k, [x, y]) in places.into_iter().chain(legs) {
                points[k + side].world = Vec3::new(sign * x, y, 0.0);
            }
        }
        Landmarks { presence: 1.0, points, next: Default::default() }
    }

    #[test]
    fn a_person_is_a_body_and_one_with_an_arm_of_a_metre_is_none() {
        assert!(is_body(&person()));
        let mut long = person();
        long.points[15].world.y += 1.0;
        assert!(!is_body(&long));
        // What is not seen does not count.
        long.points[15].confidence = 0.1;
        assert!(is_body(&long));
    }

    #[test]
    fn a_body_without_shoulders_and_hips_or_of_no_height_is_none() {
        let mut hidden = person();
        [11, 23].iter().for_each(|k| hidden.points[*k].confidence = 0.2);
        assert!(!is_body(&hidden));
        let mut flat = person();
        flat.points.iter_mut().for_each(|p| p.world.y *= 0.1);
        assert!(!is_body(&flat));
    }
}
