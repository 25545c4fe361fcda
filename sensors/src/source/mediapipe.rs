//! MediaPipe pose landmarks, 33 points: results of its Pose Landmarker as JSON, one a line or in a list.
//!
//! A result is what the task's JavaScript and Python results hold: `worldLandmarks` (m, hips at the origin) and
//! `landmarks` (shares of the image's width and height), each a list of people or one person's 33 points `{x, y, z,
//! visibility}`, under these names, with `pose` before them, or in snake case; and the frame's `timestampMs`. `width` and
//! `height` (px) may stand beside them.
//!
//! World landmarks leave out where the person is; the image says it: [`place`](super::mediapipe_place) puts them there.

use serde::Deserialize;

use super::joint_map::{Format, JointMap};
use super::mediapipe_landmarks::{Image, Landmark, LandmarkPerson, POINTS};
use super::mediapipe_place as place;
use super::{align, tidy};
use crate::error::{FilePlace, ReaderFault};
use crate::limits::MAX_JOINT_FRAMES;
use crate::session::{Session, too_many};
use toile_base::frame::Joints;
use toile_base::limits::MAX_SIDE;

/// Image size that is taken where none is given (px): that of most webcams.
const ASSUMED_SIZE: [f32; 2] = [1280.0, 720.0];

/// Farthest that a landmark may be, in metres or shares of the image.
const FARTHEST: f32 = 100.0;

const CURE: &str = "write the results of the Pose Landmarker again, one JSON object a line with its timestampMs";

/// One person, or a list of people.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum LandmarkLists {
    Many(Vec<Vec<Landmark>>),
    One(Vec<Landmark>),
}

impl LandmarkLists {
    fn people(&self) -> &[Vec<Landmark>] {
        match self {
            Self::Many(people) => people,
            Self::One(person) => std::slice::from_ref(person),
        }
    }
}

impl Default for LandmarkLists {
    fn default() -> Self {
        Self::Many(Vec::new())
    }
}

#[derive(Debug, Deserialize)]
struct LandmarkFrame {
    #[serde(alias = "timestampMs", alias = "timestamp", alias = "timestampInMilliseconds", alias = "time_ms")]
    timestamp_ms: f64,
    #[serde(default, alias = "poseLandmarks", alias = "pose_landmarks")]
    landmarks: LandmarkLists,
    #[serde(default, alias = "worldLandmarks", alias = "poseWorldLandmarks", alias = "pose_world_landmarks")]
    world_landmarks: LandmarkLists,
    #[serde(default, alias = "image_width", alias = "imageWidth")]
    width: Option<f32>,
    #[serde(default, alias = "image_height", alias = "imageHeight")]
    height: Option<f32>,
}

/// Whether the begin of a JSON file shows this kind.
pub(super) fn recognises(head: &[u8]) -> bool {
    head.windows(10).any(|w| w == b"andmarks\":" || w == b"andmarks\" ")
}

pub(super) fn read(bytes: &[u8]) -> Result<Session, ReaderFault> {
    let frames = parse(bytes)?;
    let mut notes = Vec::new();
    let mut people = Vec::with_capacity(frames.len());
    let mut last = None;
    for (i, frame) in frames.iter().enumerate() {
        let person = person(frame, last).map_err(|problem| ReaderFault::new(FilePlace::Frame(i), problem, CURE))?;
        if let Some(person) = person {
            last = person.image.as_ref().map(Image::hips).or(last);
            people.push(person);
        }
    }
    if people.len() < frames.len() {
        notes.push(format!(
            "{} of {} frames show no person and were left out",
            frames.len() - people.len(),
            frames.len()
        ));
    }
    if frames.iter().all(|f| f.width.is_none() || f.height.is_none()) {
        let [w, h] = ASSUMED_SIZE;
        notes.push(format!("the image's size is not given and taken as {w} x {h} pixels"));
    }
    let points = place::in_space(&people, &mut notes);
    let map = JointMap::of(Format::MediaPipe33);
    let frames: Vec<Joints> = people.iter().zip(points).map(|(p, points)| map.joints(p.time_ns, &points)).collect();
    let mut joints = tidy::tidy(frames, &mut notes)?;
    align::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: false, ..Session::default() })
}

fn parse(bytes: &[u8]) -> Result<Vec<LandmarkFrame>, ReaderFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii();
    let fault = |e: serde_json::Error| {
        ReaderFault::new(FilePlace::Line(e.line()), format!("not results of the Pose Landmarker: {e}"), CURE)
    };
    if bytes.starts_with(b"[") {
        let frames: Vec<LandmarkFrame> = serde_json::from_slice(bytes).map_err(fault)?;
        return if frames.len() > MAX_JOINT_FRAMES { Err(too_many(frames.len())) } else { Ok(frames) };
    }
    let mut frames = Vec::new();
    for frame in serde_json::Deserializer::from_slice(bytes).into_iter::<LandmarkFrame>() {
        if frames.len() == MAX_JOINT_FRAMES {
            return Err(too_many(frames.len() + 1));
        }
        frames.push(frame.map_err(fault)?);
    }
    Ok(frames)
}

/// The person of a frame whose hips are nearest to `last` in the image, or who is seen largest; `None` without a person.
fn person(frame: &LandmarkFrame, last: Option<[f32; 2]>) -> Result<Option<LandmarkPerson>, String> {
    let ms = frame.timestamp_ms;
    if !ms.is_finite() || !(0.0..1e15).contains(&ms) {
        return Err(format!("the time stamp {ms} is not in milliseconds"));
    }
    let size = [frame.width.unwrap_or(ASSUMED_SIZE[0]), frame.height.unwrap_or(ASSUMED_SIZE[1])];
    if size.iter().any(|s| !(1.0..=MAX_SIDE as f32).contains(s)) {
        return Err(format!("an image cannot have {} x {} pixels", size[0], size[1]));
    }
    let mut images = Vec::new();
    for points in frame.landmarks.people() {
        images.push(Image { points: checked(points)?, size });
    }
    let cost = |image: &Image| match last {
        Some([u, v]) => (image.hips()[0] - u).hypot(image.hips()[1] - v),
        None => -image.height(),
    };
    let chosen = (0..images.len()).min_by(|a, b| cost(&images[*a]).total_cmp(&cost(&images[*b])));
    let world = frame.world_landmarks.people().get(chosen.unwrap_or(0)).map(|points| checked(points)).transpose()?;
    let image = chosen.map(|k| images.swap_remove(k));
    let time_ns = (ms * 1e6) as u64;
    Ok((image.is_some() || world.is_some()).then_some(LandmarkPerson { time_ns, image, world }))
}

/// The points, if there are 33 of them and all are numbers.
fn checked(points: &[Landmark]) -> Result<[Landmark; POINTS], String> {
    let all = points.try_into().map_err(|_| format!("{} landmarks where a pose has {POINTS}", points.len()))?;
    for (k, p) in points.iter().enumerate() {
        let far = [p.x, p.y, p.z].iter().any(|x| !x.is_finite() || x.abs() > FARTHEST);
        if far || !(0.0..=1.0).contains(&p.visibility) {
            return Err(format!(
                "landmark {k} at ({}, {}, {}), visible to {}, is not in the room",
                p.x, p.y, p.z, p.visibility
            ));
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(x: f32) -> String {
        let all: Vec<String> = (0..33)
            .map(|i| format!("{{\"x\":{x},\"y\":{},\"z\":0.0,\"visibility\":0.9}}", 0.1 + 0.02 * i as f32))
            .collect();
        format!("[{}]", all.join(","))
    }

    #[test]
    fn every_way_of_writing_a_result_is_understood() {
        for text in [
            format!("{{\"timestampMs\":5,\"landmarks\":[{0}],\"worldLandmarks\":[{0}]}}", points(0.5)),
            format!("{{\"timestamp_ms\":5,\"poseLandmarks\":{0},\"poseWorldLandmarks\":{0}}}", points(0.5)),
            format!("[{{\"timestamp\":5,\"pose_landmarks\":[{0}],\"pose_world_landmarks\":[{0}]}}]", points(0.5)),
        ] {
            assert!(recognises(&text.as_bytes()[..80]), "{text}");
            let frames = parse(text.as_bytes()).unwrap();
            let person = person(&frames[0], None).unwrap().unwrap();
            assert_eq!(person.time_ns, 5_000_000);
            assert!(person.image.is_some() && person.world.is_some());
        }
    }

    #[test]
    fn of_two_people_the_one_near_the_last_place_is_followed() {
        let text = format!("{{\"timestampMs\":5,\"landmarks\":[{},{}]}}", points(0.2), points(0.8));
        let frames = parse(text.as_bytes()).unwrap();
        let hips = |last| person(&frames[0], last).unwrap().unwrap().image.unwrap().hips()[0];
        assert!((hips(Some([1000.0, 300.0])) - 0.8 * 1280.0).abs() < 1.0);
        assert!((hips(Some([300.0, 300.0])) - 0.2 * 1280.0).abs() < 1.0);
    }

    #[test]
    fn empty_frames_pass_and_wrong_numbers_are_refused() {
        let of = |text: &str| parse(text.as_bytes()).map(|f| person(&f[0], None).map(|p| p.is_some()));
        assert_eq!(of("{\"timestampMs\":5,\"landmarks\":[],\"worldLandmarks\":[]}"), Ok(Ok(false)));
        let one = points(0.5);
        let wrong = [one.replacen("0.9", "7", 1), one.replacen("0.5", "1e30", 1), "[{\"x\":0,\"y\":0}]".to_owned()];
        for points in wrong {
            assert!(of(&format!("{{\"timestampMs\":5,\"landmarks\":[{points}]}}")).unwrap().is_err());
        }
        assert!(of(&format!("{{\"timestampMs\":-1,\"landmarks\":[{one}]}}")).unwrap().is_err());
        assert!(of("{\"landmarks\":[]}").is_err());
        assert!(of(&format!("{{\"timestampMs\":1,\"width\":0,\"height\":0,\"landmarks\":[{one}]}}")).unwrap().is_err());
    }
}
