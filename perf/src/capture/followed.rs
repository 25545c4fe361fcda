//! People who move before calibrated cameras, measured in their first frame and followed by their silhouettes through the others.
//!
//! The people, cameras and masks are those of `silhouettes`; what they do is `StudyPerson::perform`: arms, trunk and legs, each at a pace of
//! its own, while the whole person turns to and fro.

use std::f32::consts::TAU;

use glam::{DVec3, Vec3};
use serde::Serialize;
use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::quantile;
use toile_capture::body::{
    BodyFollower, FollowedFrame, SilhouetteBody, SilhouetteOptions, SilhouetteView, measure, overlay_png,
};
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::masks::Mask;

use super::silhouettes::{SilhouetteStudyError, SilhouetteStudyOptions, people, rig, segmented};
use crate::ansur::Survey;
use crate::measuring::{JointPositions, Moment, StudyPerson};

/// Frames a second.
const HZ: f32 = 30.0;

/// How far a person turns to each side (rad), and how often a second.
const TURNS: [f32; 2] = [0.6, 0.2];

/// Every so many vertices of the truth are compared with the surface that was found.
const EVERY: usize = 3;

/// How people who move were followed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FollowStudy {
    /// `survey` or `makehuman`.
    pub family: &'static str,
    /// Cameras around each person.
    pub cameras: usize,
    /// Whether they stood evenly all round, an even number of them in opposite pairs.
    pub opposite: bool,
    /// People, and those whom no body fits in their first frame.
    pub people: usize,
    /// People who were not measured in their first frame.
    pub lost: usize,
    /// Frames after the first, of all people.
    pub frames: usize,
    /// Of these, frames in which the body was not found.
    pub lost_frames: usize,
    /// Mean distance of the joints from their true places (mm): in the first frames, in the others, its 95th percentile, in the last
    /// tenth of the frames.
    pub joints_mm: [f64; 4],
    /// Mean distance of the true surface from the one that was found (mm): in the first frames, in the others, its 95th percentile.
    pub surface_mm: [f64; 3],
    /// Mean share that drawing and silhouettes have in common.
    pub agreement: f64,
    /// Mean time of a frame after the first (s).
    pub seconds: f64,
}

/// Distances of one frame (mm).
struct FrameOff {
    /// Frame of its person.
    frame: usize,
    joints: f64,
    surface: f64,
    agreement: f64,
    found: bool,
    seconds: f64,
}

/// Frames of a person that are drawn where pictures are asked for.
const DRAWN: usize = 5;

/// Follows people of each survey's sex through so many frames; `progress` is called after each person, with PNG files of some frames, by
/// their numbers, where pictures are asked for.
///
/// # Errors
/// A file that is no survey, files that are not MakeHuman's, a person outside of all ranges.
pub fn follow_study(
    surveys: &[Survey],
    options: &SilhouetteStudyOptions,
    frames: usize,
    progress: &mut dyn FnMut(Vec<(usize, Vec<u8>)>),
) -> Result<FollowStudy, SilhouetteStudyError> {
    let (mut all, mut count, mut lost) = (Vec::new(), 0, 0);
    for survey in surveys {
        for (person, mut rng) in people(survey, options)? {
            count += 1;
            let mut pictures = Vec::new();
            let every = if options.pictures { frames.div_ceil(DRAWN) } else { usize::MAX };
            let found = followed(&person, options, [frames, every], &mut rng, &mut pictures);
            lost += usize::from(found.is_empty());
            all.extend(found);
            progress(pictures);
        }
    }
    let of = |keep: &dyn Fn(&FrameOff) -> bool, what: &dyn Fn(&FrameOff) -> f64| -> Vec<f64> {
        all.iter().filter(|f| keep(f)).map(what).collect()
    };
    let mean = |v: Vec<f64>| v.iter().sum::<f64>() / v.len().max(1) as f64;
    let p95 = |mut v: Vec<f64>| quantile(&mut v, 0.95).unwrap_or(0.0);
    let first = |f: &FrameOff| f.frame == 0;
    let later = |f: &FrameOff| f.frame > 0;
    let last = |f: &FrameOff| f.frame + (frames / 10).max(1) >= frames;
    let joints = |f: &FrameOff| f.joints;
    let surface = |f: &FrameOff| f.surface;
    Ok(FollowStudy {
        family: if options.makehuman.is_some() { "makehuman" } else { "survey" },
        cameras: options.cameras,
        opposite: options.opposite,
        people: count,
        lost,
        frames: all.iter().filter(|f| later(f)).count(),
        lost_frames: all.iter().filter(|f| !f.found).count(),
        joints_mm: [
            mean(of(&first, &joints)),
            mean(of(&later, &joints)),
            p95(of(&later, &joints)),
            mean(of(&last, &joints)),
        ],
        surface_mm: [mean(of(&first, &surface)), mean(of(&later, &surface)), p95(of(&later, &surface))],
        agreement: mean(of(&later, &|f| f.agreement)),
        seconds: mean(of(&later, &|f| f.seconds)),
    })
}

/// A person followed; nothing where their first frame was not enough. Every so many frames are drawn.
fn followed(
    person: &StudyPerson,
    options: &SilhouetteStudyOptions,
    [frames, every]: [usize; 2],
    rng: &mut SplitMix64,
    pictures: &mut Vec<(usize, Vec<u8>)>,
) -> Vec<FrameOff> {
    let rig = rig(options, rng);
    let facing = rng.uniform() * TAU;
    let mut filmed = |frame: usize| {
        let time = frame as f32 / HZ;
        let moment = Moment { time, turned: facing + TURNS[0] * (TAU * TURNS[1] * time).sin() };
        let mut surface = Vec::new();
        let joints = person.perform(moment, &mut surface);
        let masks = segmented(person, &surface, &rig, rng);
        (joints, surface, masks)
    };
    let (joints, surface, masks) = filmed(0);
    let Ok(first) = measure(&views(&rig, &masks), &SilhouetteOptions::default()) else { return Vec::new() };
    let mut follower = BodyFollower::new(&first);
    let mut all = vec![off(0, &begun(&first, &mut follower, &views(&rig, &masks)), &first, (&joints, &surface), 0.0)];
    for frame in 1..frames {
        let (joints, surface, masks) = filmed(frame);
        let seen = views(&rig, &masks);
        let begun = std::time::Instant::now();
        let found = follower.next(&seen, &[]);
        all.push(off(frame, &found, &first, (&joints, &surface), begun.elapsed().as_secs_f64()));
        if frame.is_multiple_of(every) {
            let drawn = overlay_png(&seen, &found.standing, &first.body.body.mesh.triangles);
            pictures.extend(drawn.ok().map(|png| (frame, png)));
        }
    }
    all
}

/// The first frame as the others are.
fn begun(first: &SilhouetteBody, follower: &mut BodyFollower, seen: &[SilhouetteView]) -> FollowedFrame {
    FollowedFrame { standing: first.standing.clone(), ..follower.next(seen, &[]) }
}

fn views<'a>(rig: &'a [(CalibratedCamera, CalibratedCamera)], masks: &'a [Mask]) -> Vec<SilhouetteView<'a>> {
    rig.iter().zip(masks).map(|((said, _), mask)| SilhouetteView { camera: said, mask }).collect()
}

fn off(
    frame: usize,
    found: &FollowedFrame,
    first: &SilhouetteBody,
    (joints, surface): (&JointPositions, &[Vec3]),
    seconds: f64,
) -> FrameOff {
    let apart = found.joints.iter().zip(joints).map(|(a, b)| a.distance(b.as_dvec3()));
    FrameOff {
        frame,
        joints: 1e3 * apart.sum::<f64>() / joints.len() as f64,
        surface: 1e3 * surface_off(surface, &found.standing, &first.body.body.mesh.triangles),
        agreement: found.agreement,
        found: found.found,
        seconds,
    }
}

/// Mean distance of the vertices of a surface from the plane of another at its nearest vertex (m).
fn surface_off(truth: &[Vec3], found: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let found: Vec<Vec3> = found.iter().map(|p| p.as_vec3()).collect();
    let mut normals = vec![Vec3::ZERO; found.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|v| found[v as usize]);
        corners.iter().for_each(|v| normals[*v as usize] += (b - a).cross(c - a));
    }
    let off = truth.iter().step_by(EVERY).map(|p| {
        let nearest =
            found.iter().enumerate().min_by(|a, b| p.distance_squared(*a.1).total_cmp(&p.distance_squared(*b.1)));
        nearest.map_or(0.0, |(v, q)| f64::from(normals[v].normalize_or_zero().dot(*p - *q).abs()))
    });
    off.sum::<f64>() / truth.len().div_ceil(EVERY).max(1) as f64
}
