//! The frames of a recording, one after the other.

use std::path::PathBuf;

use image::RgbImage;
use serde::Serialize;
use toile_base::numeric::hash;
use toile_sensors::calibration::Rig;
use toile_sensors::error::SourceError;
use toile_sensors::pictures::PictureSequence;

use super::store::{RunFolder, RunState};
use super::timing::{change, in_step};
use crate::error::CaptureError;
use crate::flow::{FirstFrame, FlowSettings, FlowTracker, FrameOutcome};
use crate::surface::CapturedSurface;

/// Frames that are looked at before any is followed, to see whether cameras are in step.
const LOOKED_AT: usize = 64;

/// What is followed, through which pictures, and where the results go.
#[derive(Debug, Clone)]
pub struct FlowJob {
    /// The mesh of the first frame.
    pub surface: CapturedSurface,
    /// The cameras.
    pub rig: Rig,
    /// Their pictures.
    pub sequence: PictureSequence,
    /// The output folder.
    pub out: PathBuf,
    /// How it is followed.
    pub settings: FlowSettings,
    /// Most frames that are followed, the first included.
    pub frames: Option<usize>,
    /// Frames a second, where the calibration does not say.
    pub rate: f64,
    /// Goes on although cameras are out of step.
    pub unsynchronised: bool,
}

/// A frame that is done: how many are, of how many, and how it went.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Frames that are done.
    pub done: usize,
    /// Frames in all.
    pub of: usize,
    /// How the last was followed; none for the first.
    pub outcome: Option<FrameOutcome>,
}

/// What a run came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlowSummary {
    /// Frames that have a mesh.
    pub frames: usize,
    /// Frames that an earlier run had done.
    pub resumed: usize,
    /// Vertices and triangles of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Cameras.
    pub cameras: usize,
    /// How the mesh fits the first frame.
    pub first: FirstFrame,
    /// Root mean square residual of the frames, mean over them (of 255).
    pub residual: f64,
    /// Least part of the triangles that cameras placed in any frame.
    pub least_placed: f64,
    /// Iterations of all frames of this run.
    pub iterations: usize,
    /// Time of an iteration (s).
    pub seconds_per_iteration: f64,
    /// Greatest strain of the edges, root mean square over a frame.
    pub strain: f64,
    /// How each frame after the first was followed.
    pub outcomes: Vec<FrameOutcome>,
    /// The files that were written.
    pub files: Vec<PathBuf>,
}

impl FlowJob {
    /// Follows the surface; each frame's mesh is written before the next is begun.
    ///
    /// # Errors
    /// One sentence: pictures that cannot be read, cameras out of step, a mesh that does not fit, an output folder of another run.
    pub fn run(self, mut progress: impl FnMut(Progress)) -> Result<FlowSummary, CaptureError> {
        let frames = self.frames.unwrap_or(usize::MAX).min(self.sequence.frames());
        if !self.unsynchronised {
            self.check_timing(frames)?;
        }
        let folder = RunFolder::new(&self.out, self.sequence.first())?;
        let mut tracker = FlowTracker::new(self.surface.clone(), self.rig.cameras.clone(), self.settings)?;
        let begun_with = self.begun_with();
        let mut state = match folder.read_state()? {
            Some(state) => self.go_on(&mut tracker, &folder, state, &begun_with)?,
            None => {
                let first = tracker.start(&self.pictures(0)?)?;
                folder.write_mesh(0, tracker.positions(), &self.surface.triangles)?;
                let state = RunState { begun_with, frames: 1, outcomes: Vec::new(), first, memory: tracker.memory() };
                folder.write_state(&state)?;
                state
            }
        };
        let resumed = state.frames as usize;
        progress(Progress { done: resumed, of: frames, outcome: None });
        for frame in resumed..frames {
            let outcome = tracker.step(&self.pictures(frame)?)?;
            folder.write_mesh(frame as u32, tracker.positions(), &self.surface.triangles)?;
            state.frames += 1;
            state.outcomes.push(outcome);
            state.memory = tracker.memory();
            folder.write_state(&state)?;
            progress(Progress { done: frame + 1, of: frames, outcome: Some(outcome) });
        }
        let rate = self.rig.frame_rate.unwrap_or(self.rate);
        let motion = folder.write_motion(state.frames, &self.surface.triangles, rate)?;
        Ok(self.summary(&state, resumed, motion))
    }

    fn go_on(
        &self,
        tracker: &mut FlowTracker,
        folder: &RunFolder,
        state: RunState,
        begun_with: &str,
    ) -> Result<RunState, CaptureError> {
        if state.begun_with != begun_with {
            let problem = "it holds a run of another mesh, other cameras, pictures or settings";
            let cure = "give another output folder, or what that run was begun with";
            return Err(CaptureError::unfit(self.out.display().to_string(), problem, cure));
        }
        let last = state.frames - 1;
        let meshes = [folder.read_mesh(last.saturating_sub(1))?, folder.read_mesh(last)?];
        let earlier = |frame: u32| Ok((folder.read_mesh(frame)?, self.pictures(frame as usize)?));
        tracker.resume(&state.memory, state.frames, meshes, earlier)?;
        Ok(state)
    }

    /// All that the bits of the result depend on.
    fn begun_with(&self) -> String {
        let numbers = self.surface.rest.iter().flat_map(|p| p.as_vec3().to_array());
        let corners = self.surface.triangles.iter().flatten().map(|i| f32::from_bits(*i));
        let hash = hash::of_numbers(numbers.chain(corners));
        format!("{hash:016x} {:?} {:?} {}", self.rig.cameras, self.settings, self.sequence.path())
    }

    /// The pictures of a frame, decoded by a thread a camera.
    fn pictures(&self, frame: usize) -> Result<Vec<RgbImage>, CaptureError> {
        let read = |k: usize| self.sequence.read(k, frame, self.rig.cameras[k].size);
        let all: Vec<Result<RgbImage, SourceError>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..self.rig.cameras.len()).map(|k| scope.spawn(move || read(k))).collect();
            threads.into_iter().map(|t| t.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        });
        all.into_iter().map(|r| r.map_err(CaptureError::from)).collect()
    }

    fn check_timing(&self, frames: usize) -> Result<(), CaptureError> {
        let mut changes = vec![Vec::new(); self.rig.cameras.len()];
        let mut before = self.pictures(0)?;
        for frame in 1..frames.min(LOOKED_AT) {
            let now = self.pictures(frame)?;
            for ((changes, a), b) in changes.iter_mut().zip(&before).zip(&now) {
                changes.push(change(a, b));
            }
            before = now;
        }
        let Some(found) = in_step(&changes) else { return Ok(()) };
        let camera = format!("camera {}", self.rig.cameras[found.camera].name);
        Err(CaptureError::unfit(
            camera,
            found.to_string(),
            "start its pictures at another frame, or give --unsynchronised",
        ))
    }

    fn summary(&self, state: &RunState, resumed: usize, motion: Option<PathBuf>) -> FlowSummary {
        let done = &state.outcomes;
        let own = &done[(resumed - 1).min(done.len())..];
        let iterations: usize = own.iter().map(|o| o.iterations).sum();
        let seconds: f64 = own.iter().map(|o| o.seconds).sum();
        let count = done.len().max(1) as f64;
        FlowSummary {
            frames: state.frames as usize,
            resumed: if resumed > 1 { resumed } else { 0 },
            vertices: self.surface.rest.len(),
            triangles: self.surface.triangles.len(),
            cameras: self.rig.cameras.len(),
            first: state.first,
            residual: done.iter().map(|o| o.residual).sum::<f64>() / count,
            least_placed: done.iter().map(|o| o.placed).fold(1.0, f64::min),
            iterations,
            seconds_per_iteration: seconds / iterations.max(1) as f64,
            strain: done.iter().map(|o| o.strain).fold(0.0, f64::max),
            outcomes: done.clone(),
            files: motion.into_iter().collect(),
        }
    }
}
