//! OpenPose keypoints of several calibrated cameras, triangulated: BODY_25 and BODY_25B.
//!
//! A folder holds a calibration (`*.toml`) and a folder of JSON files for each camera, in the order of the calibration's
//! cameras, in itself or one level below; a file is a frame, in the order of their names. In each frame the people that
//! the cameras see are matched, the shopper is followed, and their keypoints become points in space by a
//! weighted linear triangulation.

mod keypoints;
mod people;
mod triangulate;
mod upright;

pub use keypoints::{Keypoint, POINTS, PersonKeypoints};
pub use triangulate::Point;

use std::path::{Path, PathBuf};

use toile_assets::file;

use super::files::{count_bytes, shown};
use super::joint_map::JointMap;
use super::tidy;
use crate::calibration::Rig;
use crate::error::{FilePlace, ReaderFault, SourceError};
use crate::limits::{CAMERA, KEYPOINTS, MAX_CAMERAS, MAX_JOINT_FRAMES};
use crate::session::{Session, too_many};
use keypoints::{ViewFrames, ViewPeople};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;

/// Frames a second where the calibration's metadata has no `frame_rate`: OpenPose writes no time.
const ASSUMED_RATE: f64 = 30.0;

const CURE: &str = "give a folder with the cameras' calibration (.toml) and a folder of OpenPose JSON for each camera";

/// Whether a folder is such a recording: it holds a calibration, or folders of JSON files.
pub(super) fn recognises(folder: &Path) -> Result<bool, SourceError> {
    Ok(list(folder)?.iter().any(|p| has_extension(p, "toml")) || !camera_folders(folder)?.is_empty())
}

/// A recording of keypoints: the cameras, and what each saw of the shopper.
#[derive(Debug, Clone, PartialEq)]
pub struct KeypointRecording {
    /// The cameras.
    pub rig: Rig,
    /// Frames a second: the calibration's, or what is assumed.
    pub rate: f64,
    /// Whether the keypoints are those of BODY_25B; else of BODY_25.
    pub is_25b: bool,
    /// The frames; none where fewer than two cameras show the person.
    pub frames: Vec<Option<KeypointFrame>>,
}

/// The shopper in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct KeypointFrame {
    /// Their keypoints in each camera; none if the camera saw no matching person.
    pub views: Vec<Option<PersonKeypoints>>,
    /// The points that the views meet in.
    pub points: [Point; POINTS],
}

/// Reads a folder of keypoints of several cameras in the cameras' own world.
///
/// # Errors
/// One sentence with the path and the cure where there is no calibration, a camera's folder is missing, or a file is wrong.
pub fn keypoints_of(folder: &Path) -> Result<KeypointRecording, SourceError> {
    let (rig, views) = read_folder(folder)?;
    let is_25b = keypoints::format(&views, &mut Vec::new()) == super::joint_map::Format::OpenPose25B;
    let frames = views.iter().map(Vec::len).min().unwrap_or(0);
    let (mut found, mut last) = (Vec::with_capacity(frames), None);
    for i in 0..frames {
        let seen: Vec<&ViewPeople> = views.iter().map(|view| &view[i]).collect();
        let person = people::shopper(&rig, &seen, last.as_ref());
        found.push(person.map(|points| KeypointFrame { views: people::views(&rig, &seen, &points), points }));
        last = person.or(last);
    }
    let rate = rig.frame_rate.unwrap_or(ASSUMED_RATE);
    Ok(KeypointRecording { rig, rate, is_25b, frames: found })
}

/// Opens a folder of keypoints.
pub(super) fn open(folder: &Path) -> Result<Session, SourceError> {
    let (rig, views) = read_folder(folder)?;
    let mut session = session(&rig, &views).map_err(|fault| fault.at(&shown(folder)))?;
    session.name = folder.file_name().map_or_else(|| "session".to_owned(), |s| s.to_string_lossy().into_owned());
    session.check().map_err(|fault| fault.at(&shown(folder)))?;
    Ok(session)
}

/// The cameras of a folder and what each saw.
fn read_folder(folder: &Path) -> Result<(Rig, Vec<ViewFrames>), SourceError> {
    let whole = |problem: String| ReaderFault::new(FilePlace::Whole, problem, CURE).at(&shown(folder));
    let toml = list(folder)?.into_iter().find(|p| has_extension(p, "toml"));
    let toml = toml.ok_or_else(|| whole("the folder holds no calibration (.toml)".to_owned()))?;
    let rig = crate::calibration::read_toml(&file::read(&toml, &CAMERA)?).map_err(|fault| fault.at(&shown(&toml)))?;
    let folders = camera_folders(folder)?;
    if folders.len() != rig.cameras.len() {
        return Err(whole(format!("{} folders of JSON files for {} cameras", folders.len(), rig.cameras.len())));
    }
    let mut views = Vec::with_capacity(folders.len());
    let mut total = 0;
    for folder in &folders {
        views.push(view(folder, &mut total)?);
    }
    Ok((rig, views))
}

/// One camera's frames; `total` counts the bytes of all cameras.
fn view(folder: &Path, total: &mut u64) -> Result<ViewFrames, SourceError> {
    let files: Vec<PathBuf> = list(folder)?.into_iter().filter(|p| has_extension(p, "json")).collect();
    if files.len() > MAX_JOINT_FRAMES {
        return Err(too_many(files.len()).at(&shown(folder)));
    }
    let mut frames = Vec::with_capacity(files.len());
    for path in files {
        let bytes = file::read(&path, &KEYPOINTS)?;
        count_bytes(total, &bytes).map_err(|fault| fault.at(&shown(folder)))?;
        frames.push(keypoints::read(&bytes).map_err(|fault| fault.at(&shown(&path)))?);
    }
    Ok(frames)
}

/// Folders that hold JSON files, in the folder itself or one level below, by name; no more than cameras are read.
fn camera_folders(folder: &Path) -> Result<Vec<PathBuf>, SourceError> {
    let (mut found, mut inner) = (Vec::new(), Vec::new());
    for path in list(folder)?.into_iter().filter(|p| p.is_dir()) {
        if list(&path)?.iter().any(|p| has_extension(p, "json")) {
            found.push(path);
        } else {
            inner.push(path);
        }
    }
    for folder in if found.is_empty() { inner } else { Vec::new() } {
        for path in list(&folder)?.into_iter().filter(|p| p.is_dir()) {
            if found.len() <= MAX_CAMERAS && list(&path)?.iter().any(|p| has_extension(p, "json")) {
                found.push(path);
            }
        }
    }
    Ok(found)
}

/// Files of a folder, sorted by name.
fn list(folder: &Path) -> Result<Vec<PathBuf>, SourceError> {
    let refused = |error| SourceError::Io { path: shown(folder), action: "read", error };
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        all.push(entry.map_err(refused)?.path());
    }
    all.sort_unstable();
    Ok(all)
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// A session of all cameras' frames. Frames past the end of the shortest recording are left out.
fn session(rig: &Rig, views: &[ViewFrames]) -> Result<Session, ReaderFault> {
    let frames = views.iter().map(Vec::len).min().unwrap_or(0);
    let rate = rig.frame_rate.unwrap_or(ASSUMED_RATE);
    let mut notes = Vec::new();
    if rig.frame_rate.is_none() {
        notes.push(format!("OpenPose writes no time: taken as {rate:.0} frames a second"));
    }
    let format = keypoints::format(views, &mut notes);
    let map = JointMap::of(format);
    let (mut joints, mut last, mut most) = (Vec::with_capacity(frames), None, 0);
    for i in 0..frames {
        let seen: Vec<&ViewPeople> = views.iter().map(|view| &view[i]).collect();
        most = most.max(seen.iter().map(|people| people.len()).max().unwrap_or(0));
        if let Some(person) = people::shopper(rig, &seen, last.as_ref()) {
            let time_ns = (i as f64 / rate * SECOND_NS as f64).round() as u64;
            joints.push(keypoints::joints(&map, format, time_ns, &person));
            last = Some(person);
        }
    }
    if most > 1 {
        notes.push(format!("up to {most} people are in view: the one whom most cameras see is followed"));
    }
    if joints.len() < frames {
        notes.push(format!(
            "{} of {frames} frames show no person to two cameras and were left out",
            frames - joints.len()
        ));
    }
    let mut joints: Vec<Joints> = tidy::tidy(joints, &mut notes)?;
    upright::to_world(&mut joints, &mut notes)?;
    Ok(Session { joints, notes, raw_scale_known: true, ..Session::default() })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::source::joint_map::Format;
    use toile_base::skeleton::Joint;

    /// The shared recording, or nothing where it is not set up; with CI=true that is a failure.
    fn shared() -> Option<PathBuf> {
        Some(crate::recordings::folder()?.join("multiview/pose2sim"))
    }

    /// Markers of a .trc file: names, and a position of each in each frame (m, the cameras' world).
    fn markers(folder: &Path) -> (Vec<String>, Vec<Vec<DVec3>>) {
        let text = std::fs::read_to_string(folder.join("S00_P00_T01_BalancingTrial_0-100.trc")).unwrap();
        let mut lines = text.lines().skip(3);
        let names = lines.next().unwrap().split('\t').skip(2).filter(|n| !n.trim().is_empty()).map(str::to_owned);
        let names: Vec<String> = names.collect();
        let frames = lines.skip(1).filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
        let frame = |line: &str| -> Vec<DVec3> {
            let numbers: Vec<f64> = line.split('\t').skip(2).map(|n| n.parse().unwrap_or(f64::NAN)).collect();
            // TRC has X, Y, Z = the world's Y, Z, X.
            numbers.chunks_exact(3).map(|p| DVec3::new(p[2], p[0], p[1])).collect()
        };
        (names, frames.map(frame).collect())
    }

    #[test]
    fn the_points_are_those_that_others_triangulated() {
        let Some(folder) = shared() else { return };
        let rig = crate::calibration::read_toml(&std::fs::read(folder.join("Calib_qualisys.toml")).unwrap()).unwrap();
        let views: Vec<ViewFrames> =
            camera_folders(&folder).unwrap().iter().map(|f| view(f, &mut 0).unwrap()).collect();
        assert_eq!(keypoints::format(&views, &mut Vec::new()), Format::OpenPose25B);
        let (names, frames) = markers(&folder);
        let known = [
            ("RHip", 12),
            ("RKnee", 14),
            ("RAnkle", 16),
            ("RBigToe", 22),
            ("LHip", 11),
            ("LKnee", 13),
            ("LAnkle", 15),
            ("LBigToe", 19),
            ("Neck", 17),
            ("Head", 18),
            ("RShoulder", 6),
            ("RElbow", 8),
            ("RWrist", 10),
            ("LShoulder", 5),
            ("LElbow", 7),
            ("LWrist", 9),
        ];
        let (mut off, mut last, mut missing) = (Vec::new(), None, 0);
        for (i, frame) in frames.iter().enumerate() {
            let seen: Vec<&ViewPeople> = views.iter().map(|v| &v[i]).collect();
            let person = people::shopper(&rig, &seen, last.as_ref()).unwrap();
            for (name, k) in known {
                let truth = frame[names.iter().position(|n| n == name).unwrap()];
                if person[k].confidence == 0.0 {
                    missing += 1;
                } else {
                    off.push(person[k].position.distance(truth) * 1e3);
                }
            }
            last = Some(person);
        }
        off.sort_by(f64::total_cmp);
        let [median, p95] = [off[off.len() / 2], off[off.len() * 95 / 100]];
        println!("{} points: median {median:.1} mm, p95 {p95:.1} mm, {missing} missing", off.len());
        assert!(off.len() >= 1500 && missing < 50, "{} points", off.len());
        assert!(median < 8.0 && p95 < 80.0, "median {median} mm, p95 {p95} mm");
    }

    #[test]
    fn the_folder_opens_as_a_standing_person() {
        let Some(folder) = shared() else { return };
        let session = open(&folder).unwrap();
        println!("{:#?}", session.notes);
        assert_eq!(session.joints.len(), 100);
        let median = |joint: Joint| {
            let mut y: Vec<f32> = session.joints.iter().filter_map(|f| f.believed(joint)).map(|p| p.y).collect();
            assert!(y.len() > 40, "{joint:?} is seen in {} frames", y.len());
            y.sort_by(f32::total_cmp);
            y[y.len() / 2]
        };
        println!(
            "head {:.2}, pelvis {:.2}, toe {:.2}",
            median(Joint::Head),
            median(Joint::Pelvis),
            median(Joint::LeftToe)
        );
        assert!((1.3..1.8).contains(&median(Joint::Head)));
        assert!((0.7..1.1).contains(&median(Joint::Pelvis)));
    }
}
