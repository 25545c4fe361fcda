//! Model flowing against the truth: cameras, disturbances, springs and references, each with its error over time.

use glam::{DVec3, Vec3};
use image::RgbImage;
use serde::Serialize;
use toile_capture::flow::{FlowSettings, FlowTracker, Reference, Springs};
use toile_capture::recover::{Recovered, VALUES, recover};
use toile_capture::surface::CapturedSurface;
use toile_fitting::scene::RunError;
use toile_pose::depth_buffer::DepthBuffer;

use super::cloth::{Disturbance, FABRIC, FROM, Filmed, FilmedCloth, play, scene};
use super::error::FlowStudyError;

/// Goals: mean error without and with the arm (mm), the last ten frames over the first ten, an iteration (s).
pub const GOALS: [f64; 4] = [0.25, 1.0, 1.5, 0.030];

/// Where the search for the hanging cloth's fabric starts, as parts of it.
const FABRIC_START: [f64; VALUES] = [0.6, 1.5, 1.7, 0.6];

/// Largest part by which a value of the fabric may be off.
pub const FABRIC_GOAL: f64 = 0.1;

/// One row of the study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlowRow {
    /// What it is.
    pub name: String,
    /// Cameras before the cloth.
    pub cameras: usize,
    /// Frames that were followed.
    pub frames: usize,
    /// Mean, 95th percentile and largest distance of a vertex from where it was, over all frames (mm).
    pub error_mm: ErrorMm,
    /// The same of the vertices that two cameras see in that frame, by the truth: a vertex in a fold's hollow cannot be placed.
    pub seen_mm: ErrorMm,
    /// Share of the vertices that are seen so.
    pub seen: f64,
    /// Mean distance of each frame (mm).
    pub over_time_mm: Vec<f64>,
    /// Mean of the last ten frames over that of the first ten.
    pub drift: f64,
    /// Root mean square residual (of 255).
    pub residual: f64,
    /// Least part of the triangles that cameras placed.
    pub least_placed: f64,
    /// Mean iterations a frame.
    pub iterations: f64,
    /// Time of an iteration (s).
    pub seconds_per_iteration: f64,
    /// The fabric that moves as what was followed, where that was looked for.
    pub fabric: Option<FoundFabric>,
    /// Whether it meets its goals; absent where it has none.
    pub met: Option<bool>,
}

/// A fabric found in a motion: stretch and shear (N/m), bending (uN m), damping (1/s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FoundFabric {
    /// What the cloth was stepped with.
    pub truth: [f64; VALUES],
    /// Where the search started.
    pub start: [f64; VALUES],
    /// What was found.
    pub found: [f64; VALUES],
    /// Standard deviation of each, as a part of it.
    pub sigma: [f64; VALUES],
    /// Mean distance of a vertex from the simulation before and after (mm).
    pub error_mm: [f64; 2],
}

/// A distance in its summary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorMm {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Largest.
    pub max: f64,
}

impl ErrorMm {
    /// Of distances (mm) in any order.
    fn of(mut all: Vec<f64>) -> Self {
        all.sort_by(f64::total_cmp);
        let count = all.len();
        let at = |k: usize| all.get(k).copied().unwrap_or(0.0);
        Self { mean: mean(&all), p95: at(count * 95 / 100), max: at(count.saturating_sub(1)) }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Pixels of a depth buffer a pixel of a picture: a vertex is some twenty of those from the next.
const SIGHT: f64 = 0.5;

/// How far behind the nearest surface about it a vertex may lie and is seen (m): a surface at 60 degrees to the view recedes by so much in two
/// pixels of the buffer.
const BEHIND_M: f64 = 0.003;

/// Cameras that have to see a vertex to place it.
const SEEN_BY: usize = 2;

/// Which vertices of the true cloth enough cameras see in a frame `[vertices]`.
fn seen(cloth: &FilmedCloth, frame: usize) -> Vec<bool> {
    let places = &cloth.frames[frame];
    let mut cameras = vec![0; places.len()];
    for camera in &cloth.cameras {
        let mut buffer = DepthBuffer::new(camera.size, SIGHT);
        buffer.draw(camera, places, &cloth.triangles);
        for (place, cameras) in places.iter().zip(&mut cameras) {
            let at = buffer.project(camera, *place);
            let nearest = f64::from(buffer.nearest_around(at.truncate()));
            *cameras += usize::from(nearest.is_finite() && at.z < nearest + BEHIND_M);
        }
    }
    cameras.into_iter().map(|c| c >= SEEN_BY).collect()
}

/// What a row is run with.
#[derive(Debug, Clone)]
pub struct FlowCase {
    /// What it is called.
    pub name: &'static str,
    /// What is filmed.
    pub filmed: Filmed,
    /// Cameras.
    pub cameras: usize,
    /// Whether the fabric is looked for in what was followed.
    pub fabric: bool,
    /// What disturbs them.
    pub disturbed: Disturbance,
    /// How it is followed.
    pub settings: FlowSettings,
    /// Largest mean error and drift; none where it only compares.
    pub goals: Option<[f64; 2]>,
}

/// All rows of the study.
pub fn cases() -> Vec<FlowCase> {
    let plain = FlowSettings::default();
    let (none, shadow) = (Disturbance::default(), Disturbance { shadow: true, arm: false });
    let both = Disturbance { shadow: true, arm: true };
    let [mean, arm, drift, _] = GOALS;
    let case = |name, cameras, disturbed, settings, goals| {
        let filmed = Filmed::Hanging;
        FlowCase { name, filmed, cameras, fabric: false, disturbed, settings, goals }
    };
    // Its pictures have thirty times the pixels of the cloth's: every other one of its samples, in each direction, will do.
    let sparse = FlowSettings { spacing: 2.0 * plain.spacing, ..plain };
    let skirt =
        FlowCase { filmed: Filmed::WalkingSkirt, ..case("walking skirt", 8, none, sparse, Some([mean, drift])) };
    vec![
        case("plain", 2, none, plain, Some([mean, drift])),
        FlowCase { fabric: true, ..case("plain", 4, none, plain, Some([mean, drift])) },
        case("plain", 8, none, plain, Some([mean, drift])),
        case("shadow", 4, shadow, plain, Some([mean, drift])),
        case("shadow and arm", 4, both, plain, Some([arm, f64::INFINITY])),
        case("shadow and arm", 8, both, plain, Some([arm, f64::INFINITY])),
        case("shadow, brightness as it is", 4, shadow, FlowSettings { brightness: false, ..plain }, None),
        case("linear springs", 2, none, FlowSettings { springs: Springs::Linear, ..plain }, None),
        case("no springs", 2, none, FlowSettings { springs: Springs::Off, ..plain }, None),
        case("linear springs, arm", 4, both, FlowSettings { springs: Springs::Linear, ..plain }, None),
        case("no springs, arm", 4, both, FlowSettings { springs: Springs::Off, ..plain }, None),
        case("frame before as reference", 4, none, FlowSettings { reference: Reference::Previous, ..plain }, None),
        skirt,
        case("three channels", 4, none, FlowSettings { channels: 3, ..plain }, None),
    ]
}

/// A moment of a row, for its contact sheet: the frame, a camera's picture, the mesh as it was found, its distances from the truth (m).
pub struct FollowedMoment<'a> {
    /// The frame.
    pub frame: usize,
    /// The pictures of all cameras.
    pub pictures: &'a [RgbImage],
    /// Where the mesh was found.
    pub found: &'a [DVec3],
    /// Distance of each vertex from the truth (m).
    pub off: &'a [f64],
    /// The truth.
    pub cloth: &'a FilmedCloth,
}

/// Runs one row over so many frames; `see` is called after each.
///
/// # Errors
/// A cloth that cannot be stepped, a capture that was refused.
pub fn run(case: &FlowCase, frames: usize, mut see: impl FnMut(FollowedMoment<'_>)) -> Result<FlowRow, FlowStudyError> {
    let cloth = FilmedCloth::new(case.filmed, frames, case.cameras)?;
    let surface = CapturedSurface::new("the cloth", cloth.frames[0].clone(), Vec::new(), cloth.triangles.clone())?;
    let mut tracker = FlowTracker::new(surface, cloth.cameras.clone(), case.settings)?;
    tracker.start(&cloth.pictures(0, case.disturbed))?;
    let (mut all, mut of_seen, mut over_time) = (Vec::new(), Vec::new(), Vec::new());
    let mut followed = vec![cloth.frames[0].clone()];
    let (mut residual, mut placed, mut iterations, mut seconds) = (0.0, 1.0_f64, 0, 0.0);
    for frame in 1..frames {
        let pictures = cloth.pictures(frame, case.disturbed);
        let outcome = tracker.step(&pictures)?;
        let off: Vec<f64> = cloth.frames[frame].iter().zip(tracker.positions()).map(|(a, b)| a.distance(*b)).collect();
        over_time.push(1e3 * mean(&off));
        see(FollowedMoment { frame, pictures: &pictures, found: tracker.positions(), off: &off, cloth: &cloth });
        if case.fabric {
            followed.push(tracker.positions().to_vec());
        }
        all.extend(off.iter().map(|d| d * 1e3));
        of_seen.extend(off.iter().zip(seen(&cloth, frame)).filter(|(_, seen)| *seen).map(|(d, _)| d * 1e3));
        residual += outcome.residual / (frames - 1) as f64;
        placed = placed.min(outcome.placed);
        iterations += outcome.iterations;
        seconds += outcome.seconds;
    }
    let ten = over_time.len().min(10);
    let drift = mean(&over_time[over_time.len() - ten..]) / mean(&over_time[..ten]);
    let seen = of_seen.len() as f64 / all.len().max(1) as f64;
    let (error_mm, seen_mm) = (ErrorMm::of(all), ErrorMm::of(of_seen));
    let seconds_per_iteration = seconds / iterations as f64;
    let fabric = if case.fabric { Some(fabric_of(&followed)?) } else { None };
    let found = fabric.is_none_or(|f| f.found.iter().zip(f.truth).all(|(v, t)| (v / t - 1.0).abs() <= FABRIC_GOAL));
    let met = case.goals.map(|[most, drifts]| error_mm.mean <= most && drift <= drifts && found);
    Ok(FlowRow {
        name: case.name.to_owned(),
        cameras: case.cameras,
        frames,
        error_mm,
        seen_mm,
        seen,
        over_time_mm: over_time,
        drift,
        residual,
        least_placed: placed,
        iterations: iterations as f64 / (frames - 1) as f64,
        seconds_per_iteration,
        fabric,
        met,
    })
}

/// The fabric of the hanging cloth that moves as what was followed.
fn fabric_of(followed: &[Vec<DVec3>]) -> Result<FoundFabric, RunError> {
    let observed: Vec<Vec<Vec3>> = followed.iter().map(|f| f.iter().map(|p| p.as_vec3()).collect()).collect();
    let start = std::array::from_fn(|k| FABRIC[k] * FABRIC_START[k]);
    let simulate = |v: &[f64; VALUES], frames| play(&scene(*v), FROM, frames);
    let Recovered { values, sigma, error_mm, .. } = recover(start, &observed, simulate)?;
    Ok(FoundFabric { truth: FABRIC, start, found: values, sigma, error_mm })
}
