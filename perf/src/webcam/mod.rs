//! Joints by a webcam against the truth, and against those of the body fitted to depth: the same people, seen from the same place.

pub mod scene;

use std::path::Path;
use std::time::Instant;

use glam::Vec3;
use serde::Serialize;
use toile_assets::body::BodyError;
use toile_assets::put_line;
use toile_base::frame::Joints;
use toile_base::numeric::statistics::quantile_of;
use toile_base::skeleton::Joint;
use toile_base::skeleton::Joint::*;
use toile_fitting::live::webcam::{WebcamJoints, WebcamOptions};
use toile_pose::files::PoseError;
use toile_pose::tracker::PoseModel;
use toile_sensors::segment::Zone;
use toile_track::fit::FitOptions;
use toile_track::fit::tracker::BodyTracker;

use scene::{Performer, WebcamMoment};
use toile_assets::people::sizes;

/// Pictures a second (Hz): every second one of a webcam's.
const RATE_HZ: u64 = 15;

/// Pictures a second of a film (Hz): a webcam's.
const FILM_HZ: u64 = 30;

/// What is performed: standing, arms lifted, walking on the spot, hips swung; and from then on a turn all around (s).
const TURN_S: f32 = 7.0;
const LENGTH_S: f32 = 9.4;

/// Frames at the begin that do not count: the depth fit takes so many to find its body.
const SETTLING: u64 = 5;

/// What is compared: the middle of two joints to the middle of two others.
const LIMBS: [(&str, [[Joint; 2]; 2]); 13] = [
    ("trunk", [[LeftHip, RightHip], [LeftShoulder, RightShoulder]]),
    ("shoulders", [[RightShoulder, RightShoulder], [LeftShoulder, LeftShoulder]]),
    ("hips", [[RightHip, RightHip], [LeftHip, LeftHip]]),
    ("upper arms", [[LeftShoulder, LeftShoulder], [LeftElbow, LeftElbow]]),
    ("upper arms", [[RightShoulder, RightShoulder], [RightElbow, RightElbow]]),
    ("forearms", [[LeftElbow, LeftElbow], [LeftWrist, LeftWrist]]),
    ("forearms", [[RightElbow, RightElbow], [RightWrist, RightWrist]]),
    ("thighs", [[LeftHip, LeftHip], [LeftKnee, LeftKnee]]),
    ("thighs", [[RightHip, RightHip], [RightKnee, RightKnee]]),
    ("shins", [[LeftKnee, LeftKnee], [LeftAnkle, LeftAnkle]]),
    ("shins", [[RightKnee, RightKnee], [RightAnkle, RightAnkle]]),
    ("feet", [[LeftAnkle, LeftAnkle], [LeftToe, LeftToe]]),
    ("feet", [[RightAnkle, RightAnkle], [RightToe, RightToe]]),
];

/// What finds joints: the two networks, and the body fitted to depth.
const SEERS: [&str; 3] = ["lite", "full", "depth fit"];

/// Angles of one limb (degrees): the median and the 90th percentile of each who sees, without the turn and in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimbRow {
    /// Name of the limb.
    pub limb: &'static str,
    /// By webcam (lite, full) and by depth, before the turn.
    pub facing: [[f32; 2]; 3],
    /// In the turn.
    pub turning: [[f32; 2]; 3],
}

/// One network's time and luck.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModelFigures {
    /// Time of a picture in which a person is followed (ms): median, 99th percentile.
    pub ms: [f64; 2],
    /// Time of a picture in which a person is first searched for (ms).
    pub search_ms: f64,
    /// Share of the pictures in which a person was seen.
    pub seen: f64,
    /// Error of the stature by the floor and the camera's height (mm): mean, largest.
    pub stature_mm: [f32; 2],
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WebcamTable {
    /// People and pictures.
    pub people: usize,
    /// Number of pictures.
    pub pictures: u64,
    /// Degrees from the truth, limb by limb.
    pub limbs: Vec<LimbRow>,
    /// Lite and full.
    pub models: [ModelFigures; 2],
}

/// Why it cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum WebcamError {
    /// A body cannot be made.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// There is no network.
    #[error(transparent)]
    Pose(#[from] PoseError),
}

/// Angles by limb, seer and whether it was in the turn.
type Angles = Vec<[[Vec<f32>; 2]; 3]>;

#[derive(Default)]
struct ModelRecord {
    followed_ms: Vec<f64>,
    searched_ms: Vec<f64>,
    seen: u64,
    stature_mm: Vec<f32>,
}

/// Draws ten seconds of a woman who performs, at a webcam's 30 Hz: `picture` is given each one as a webcam sends it, in YUYV.
///
/// # Errors
/// A body that cannot be made.
pub fn film(picture: &mut dyn FnMut(&[u8])) -> Result<(), BodyError> {
    let mut performer = Performer::new(&sizes()[1], 0)?;
    let mut bytes = Vec::new();
    for number in 0..(LENGTH_S * FILM_HZ as f32) as u64 {
        let moment = performer.at(number as f32 / FILM_HZ as f32, number, FILM_HZ);
        bytes.clear();
        scene::yuyv(&moment.picture, &mut bytes);
        picture(&bytes);
    }
    Ok(())
}

/// Shows so many people to the networks of a folder; `progress` is given each one's name.
///
/// # Errors
/// A body that cannot be made, a network that is not fetched.
pub fn run(folder: &Path, count: usize, progress: &mut dyn FnMut(&str)) -> Result<WebcamTable, WebcamError> {
    let mut angles: Angles = LIMBS.iter().map(|_| Default::default()).collect();
    let mut records: [ModelRecord; 2] = Default::default();
    let mut pictures = 0;
    // A woman and a man of the middle sizes first.
    let people = [1, 4, 2, 3, 0, 5].map(|i| sizes().swap_remove(i));
    let people = &people[..count.clamp(1, people.len())];
    for (i, person) in people.iter().enumerate() {
        progress(&person.name);
        let mut performer = Performer::new(person, i as u64)?;
        let options = WebcamOptions { sex: person.sex, mount: scene::mount(), ..WebcamOptions::default() };
        let mut webcams = Vec::new();
        for model in PoseModel::ALL {
            webcams.push(WebcamJoints::load(folder, WebcamOptions { model, ..options })?);
        }
        let mut depth = BodyTracker::new(person.sex, Zone::default(), FitOptions::LIVE);
        for number in 0..(LENGTH_S * RATE_HZ as f32) as u64 {
            let seconds = number as f32 / RATE_HZ as f32;
            let moment = performer.at(seconds, number, RATE_HZ);
            pictures += 1;
            let by_webcam = look(&mut webcams, &moment, &mut records);
            let fitted = depth.push(&moment.depth);
            let all = [by_webcam[0], by_webcam[1], fitted.joints];
            if number >= SETTLING {
                compare(&mut angles, &all, &moment.truth, seconds >= TURN_S);
            }
        }
        for (record, webcam) in records.iter_mut().zip(&webcams) {
            record.stature_mm.push((webcam.stature().0 - person.size[0]).abs() * 1e3);
        }
    }
    let models = records.each_ref().map(|record| record.figures(pictures));
    Ok(WebcamTable { people: people.len(), pictures, limbs: rows(&angles), models })
}

/// One picture through both networks.
fn look(webcams: &mut [WebcamJoints], moment: &WebcamMoment, records: &mut [ModelRecord; 2]) -> [Joints; 2] {
    let mut joints = [Joints::absent(moment.time_ns); 2];
    for ((webcam, record), joints) in webcams.iter_mut().zip(records).zip(&mut joints) {
        let had = webcam.found;
        let begun = Instant::now();
        *joints = webcam.push(&moment.picture, moment.time_ns);
        let ms = begun.elapsed().as_secs_f64() * 1e3;
        record.seen += u64::from(webcam.found);
        if had { &mut record.followed_ms } else { &mut record.searched_ms }.push(ms);
    }
    joints
}

impl ModelRecord {
    fn figures(&self, pictures: u64) -> ModelFigures {
        let of = |times: &[f64], share: f64| quantile_of(times.iter().copied(), share).unwrap_or(f64::NAN);
        let mean = self.stature_mm.iter().sum::<f32>() / self.stature_mm.len().max(1) as f32;
        ModelFigures {
            ms: [0.5, 0.99].map(|share| of(&self.followed_ms, share)),
            search_ms: of(&self.searched_ms, 0.5),
            seen: self.seen as f64 / pictures as f64,
            stature_mm: [mean, self.stature_mm.iter().copied().fold(0.0, f32::max)],
        }
    }
}

/// Direction of a limb, where its ends are believed.
fn direction(joints: &Joints, [from, to]: [[Joint; 2]; 2]) -> Option<Vec3> {
    let middle = |[a, b]: [Joint; 2]| Some((joints.believed(a)? + joints.believed(b)?) * 0.5);
    (middle(to)? - middle(from)?).try_normalize()
}

fn compare(angles: &mut Angles, seen: &[Joints; 3], truth: &Joints, turning: bool) {
    for ((_, limb), angles) in LIMBS.iter().zip(angles) {
        let Some(real) = direction(truth, *limb) else { continue };
        for (joints, angles) in seen.iter().zip(angles) {
            if let Some(found) = direction(joints, *limb) {
                angles[usize::from(turning)].push(found.angle_between(real).to_degrees());
            }
        }
    }
}

fn rows(angles: &Angles) -> Vec<LimbRow> {
    let mut names: Vec<&'static str> = LIMBS.iter().map(|limb| limb.0).collect();
    names.dedup();
    let row = |limb: &'static str| {
        let of = |seer: usize, turning: usize| {
            let own = LIMBS.iter().zip(angles).filter(|(l, _)| l.0 == limb);
            let all: Vec<f32> = own.flat_map(|(_, angles)| angles[seer][turning].iter().copied()).collect();
            [0.5, 0.9].map(|share| quantile_of(all.iter().copied(), share).unwrap_or(f32::NAN))
        };
        LimbRow { limb, facing: [0, 1, 2].map(|seer| of(seer, 0)), turning: [0, 1, 2].map(|seer| of(seer, 1)) }
    };
    names.into_iter().map(row).collect()
}

impl WebcamTable {
    /// The table for a person to read.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        put_line!(text, "{} people, {} pictures of 640 x 480.\n", self.people, self.pictures);
        put_line!(text, "| degrees, p50 / p90 | {} | {} in a turn |", SEERS.join(" | "), SEERS.join(" in a turn | "));
        put_line!(text, "|---|---|---|---|---|---|---|");
        for row in &self.limbs {
            let cell = |[p50, p90]: [f32; 2]| format!("{p50:.1} / {p90:.1}");
            let cells: Vec<String> = row.facing.into_iter().chain(row.turning).map(cell).collect();
            put_line!(text, "| {} | {} |", row.limb, cells.join(" | "));
        }
        put_line!(
            text,
            "\n| network | a picture, p50 / p99 (ms) | the first (ms) | seen | stature by the floor, mean / largest error (mm) |"
        );
        put_line!(text, "|---|---|---|---|---|");
        for (name, model) in SEERS.iter().zip(&self.models) {
            let ([p50, p99], [mean, most]) = (model.ms, model.stature_mm);
            put_line!(
                text,
                "| {name} | {p50:.1} / {p99:.1} | {:.1} | {:.1} % | {mean:.0} / {most:.0} |",
                model.search_ms,
                100.0 * model.seen
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_as_it_is_has_no_angle_and_a_quarter_has_ninety_degrees() {
        let mut places = [Vec3::ZERO; toile_base::skeleton::JOINTS];
        places[LeftElbow.index()] = Vec3::X;
        let truth = Joints::seen(0, places);
        places[LeftElbow.index()] = Vec3::Y * 0.3;
        let mut angles: Angles = LIMBS.iter().map(|_| Default::default()).collect();
        compare(&mut angles, &[truth, Joints::seen(0, places), Joints::absent(0)], &truth, false);
        let arm = &angles[3];
        assert!(arm[0][0][0].abs() < 0.1 && (arm[1][0][0] - 90.0).abs() < 1e-3 && arm[2][0].is_empty());
        let rows = rows(&angles);
        assert_eq!((rows.len(), rows[3].limb), (8, "upper arms"));
    }

    #[test]
    fn both_cameras_see_the_same_person_from_the_same_place() {
        let mut performer = Performer::new(&sizes()[1], 1).unwrap();
        let moment = performer.at(0.0, 0, RATE_HZ);
        let [w, h] = scene::SIZE.map(|n| n as usize);
        // Where the head is in depth, the picture is not the wall.
        let camera = moment.depth.camera_to_world.inverse();
        let head = camera.transform_point3(moment.truth.at(Head).position);
        let (u, v) = moment.depth.intrinsics.project(head).unwrap();
        let pixel = |u: usize, v: usize| moment.picture.rgb[3 * (v * w + u)];
        let (u, v) = (u as usize, v as usize);
        assert!(pixel(u, v).abs_diff(pixel(w / 8, v)) > 10, "{} {}", pixel(u, v), pixel(w / 8, v));
        let near = moment.depth.depth_mm[v * w + u];
        assert!(u < w && v < h && near > 2_000 && near < 3_100, "{near}");
    }
}
