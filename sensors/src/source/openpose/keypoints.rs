//! OpenPose's JSON: people with 25 keypoints of x, y (px) and score, and which of two models they are of.

use glam::{DVec2, Vec3};
use serde::Deserialize;
use toile_base::skeleton::Joint;

use super::triangulate::Point;
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_VIEW_PEOPLE;
use crate::source::joint_map::{Format, JointMap, middle};
use toile_base::frame::{Joints, TrackedJoint};

/// Keypoints of either model.
pub const POINTS: usize = Format::OpenPose25.points();

/// Score from which a keypoint is used: fainter ones are guesses that lie anywhere.
pub const FAINTEST: f32 = 0.1;

const CURE: &str = "write it again with OpenPose and --write_json";

/// One keypoint; a score of 0 says that it is not seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Keypoint {
    /// Position in the image (px).
    pub pixel: DVec2,
    /// Confidence of the keypoint, 0 to 1.
    pub score: f32,
}

/// One person in one view.
pub type PersonKeypoints = [Keypoint; POINTS];

/// All people of one frame of one view.
pub type ViewPeople = Vec<PersonKeypoints>;

/// One camera's frames.
pub type ViewFrames = Vec<ViewPeople>;

#[derive(Deserialize)]
struct KeypointFile {
    people: Vec<KeypointBody>,
}

#[derive(Deserialize)]
struct KeypointBody {
    pose_keypoints_2d: Vec<f32>,
}

/// The people of a file: those of the highest scores, where there are too many.
pub fn read(bytes: &[u8]) -> Result<ViewPeople, ReaderFault> {
    let fault = |place, problem| ReaderFault::new(place, problem, CURE);
    let file: KeypointFile = serde_json::from_slice(bytes)
        .map_err(|e| fault(FilePlace::Line(e.line()), format!("not OpenPose keypoints: {e}")))?;
    let mut people = Vec::with_capacity(file.people.len());
    for body in &file.people {
        people.push(person(&body.pose_keypoints_2d).map_err(|problem| fault(FilePlace::Whole, problem))?);
    }
    let score = |p: &PersonKeypoints| p.iter().map(|k| k.score).sum::<f32>();
    people.sort_by(|a, b| score(b).total_cmp(&score(a)));
    people.truncate(MAX_VIEW_PEOPLE);
    Ok(people)
}

fn person(numbers: &[f32]) -> Result<PersonKeypoints, String> {
    if numbers.len() != 3 * POINTS {
        return Err(format!("{} numbers where a person of BODY_25 has {}", numbers.len(), 3 * POINTS));
    }
    let mut person = [Keypoint::default(); POINTS];
    for (k, (point, at)) in person.iter_mut().zip(numbers.chunks_exact(3)).enumerate() {
        let pixel = DVec2::new(f64::from(at[0]), f64::from(at[1]));
        if !pixel.is_finite() || pixel.abs().max_element() > 1e6 || !(0.0..=1.5).contains(&at[2]) {
            return Err(format!(
                "keypoint {k} at ({}, {}) of score {} is not a pixel with a score",
                at[0], at[1], at[2]
            ));
        }
        if at[2] >= FAINTEST {
            *point = Keypoint { pixel, score: at[2].min(1.0) };
        }
    }
    Ok(person)
}

/// Which model the people are of: the one in whose numbering the neck lies between the shoulders, and the hips where
/// its middle of the hips is, over all that is seen.
pub fn format(views: &[ViewFrames], notes: &mut Vec<String>) -> Format {
    let people = || views.iter().flatten().flatten();
    // Neck and shoulders: the neck's distance from their middle over their own distance.
    let off = |neck: usize, left: usize, right: usize| {
        let (mut sum, mut count) = (0.0, 0);
        for p in people().filter(|p| [neck, left, right].iter().all(|k| p[*k].score > 0.0)) {
            let [neck, left, right] = [neck, left, right].map(|k| p[k].pixel);
            let trunk = left.distance(right).max(1.0);
            sum += (neck.distance((left + right) * 0.5) / trunk).min(5.0);
            count += 1;
        }
        if count > 0 { sum / f64::from(count) } else { f64::INFINITY }
    };
    let (a, b) = (off(1, 5, 2).min(off(8, 12, 9)), off(17, 5, 6));
    let format = if b < a { Format::OpenPose25B } else { Format::OpenPose25 };
    let name = if b < a { "BODY_25B" } else { "BODY_25" };
    notes.push(format!("the keypoints are taken to be those of {name}, by where the neck lies"));
    format
}

/// How far the head's joint lies behind the nose, and below the top of the head (m): between the ears.
const NOSE_AHEAD: f32 = 0.10;
const TOP_ABOVE: f32 = 0.13;

/// Our joints of a person in space (m, the cameras' world).
pub fn joints(map: &JointMap, format: Format, time_ns: u64, person: &[Point; POINTS]) -> Joints {
    let points = person.map(|p| TrackedJoint { position: p.position.as_vec3(), confidence: p.confidence });
    let mut joints = map.joints(time_ns, &points);
    *joints.at_mut(Joint::Head) = head(format, &points, &joints);
    joints
}

/// The head's joint: between the ears, or beside the point that the model has where that is seen better.
fn head(format: Format, points: &[TrackedJoint; POINTS], joints: &Joints) -> TrackedJoint {
    let ears = if format == Format::OpenPose25 { [17, 18] } else { [3, 4] };
    let between = middle(points[ears[0]], points[ears[1]]);
    let at = |joint| Some(joints.at(joint)).filter(|j| j.confidence > 0.0).map(|j| j.position);
    let offset = || -> Option<Vec3> {
        let (chest, pelvis) = (at(Joint::Chest)?, at(Joint::Pelvis)?);
        let up = (chest - pelvis).try_normalize()?;
        if format == Format::OpenPose25B {
            return Some(up * -TOP_ABOVE);
        }
        let across = at(Joint::LeftShoulder)? - at(Joint::RightShoulder)?;
        Some(across.cross(up).try_normalize()? * -NOSE_AHEAD)
    };
    let beside = points[if format == Format::OpenPose25 { 0 } else { 18 }];
    match offset() {
        Some(offset) if beside.confidence > between.confidence => {
            TrackedJoint { position: beside.position + offset, ..beside }
        }
        _ => between,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(people: usize, x: &str, score: &str) -> String {
        let person =
            format!("{{\"person_id\":[-1],\"pose_keypoints_2d\":[{}]}}", vec![format!("{x},20,{score}"); 25].join(","));
        format!("{{\"version\":1.3,\"people\":[{}]}}", vec![person; people].join(","))
    }

    #[test]
    fn faint_points_are_none_and_crowds_are_thinned() {
        assert_eq!(read(file(3, "10", "0.5").as_bytes()).unwrap().len(), 3);
        assert_eq!(read(file(50, "10", "0.5").as_bytes()).unwrap().len(), MAX_VIEW_PEOPLE);
        assert_eq!(read(file(1, "10", "0.05").as_bytes()).unwrap()[0][3], Keypoint::default());
        assert!(read(b"{\"people\":[]}").unwrap().is_empty());
    }

    #[test]
    fn what_is_no_keypoint_is_refused() {
        for (x, score) in [("1e30", "0.5"), ("1e39", "0.5"), ("10", "7"), ("10", "-1"), ("null", "0.5")] {
            assert!(read(file(1, x, score).as_bytes()).is_err(), "{x} {score}");
        }
        for text in ["", "[]", "{}", "{\"people\":[{\"pose_keypoints_2d\":[1,2,3]}]}"] {
            assert!(read(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn the_neck_shows_the_model() {
        let mut old = [Keypoint::default(); POINTS];
        let mut put = |k: usize, x: f64, y: f64| old[k] = Keypoint { pixel: DVec2::new(x, y), score: 1.0 };
        put(1, 100.0, 50.0);
        put(5, 120.0, 51.0);
        put(2, 80.0, 51.0);
        put(6, 125.0, 90.0);
        put(17, 95.0, 30.0);
        let mut new = [Keypoint::default(); POINTS];
        (new[5], new[6], new[17], new[1]) = (old[5], old[2], old[1], old[17]);
        new[2] = Keypoint { pixel: DVec2::new(90.0, 28.0), score: 1.0 };
        assert_eq!(format(&[vec![vec![old]]], &mut Vec::new()), Format::OpenPose25);
        assert_eq!(format(&[vec![vec![new]]], &mut Vec::new()), Format::OpenPose25B);
    }
}
