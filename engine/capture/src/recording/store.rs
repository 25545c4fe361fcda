//! Files that a run writes, and reads again when it goes on.

use std::fs;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use toile_assets::export::{motion_glb, ply, ply_positions};
use toile_assets::file::{self, FileKind};

use crate::error::CaptureError;
use crate::flow::{FirstFrame, FlowMemory, FrameOutcome};

/// Name of the file that holds the state of a run.
const STATE: &str = "flow-state.json";

/// Name of the file with the whole motion.
const MOTION: &str = "motion.glb";

/// Most frames whose motion is written as one GLB file: each is a morph target, and weights grow with their square.
const MOST_MOTION: usize = 600;

/// Largest files that are read again.
const FILE: FileKind =
    FileKind { name: "a file of an earlier run", max_bytes: 1 << 30, cure: "give an empty output folder" };

/// Name of the mesh of a frame, by the number in its pictures' names.
pub fn mesh_name(number: u64) -> String {
    format!("mesh_{number:06}.ply")
}

/// The state of a run after a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct RunState {
    /// What it was begun with: mesh, cameras, pictures, settings.
    pub begun_with: String,
    /// Frames that are done, the first included.
    pub frames: u32,
    /// How each after the first was followed.
    pub outcomes: Vec<FrameOutcome>,
    /// How the mesh fits the first.
    pub first: FirstFrame,
    pub memory: FlowMemory,
}

/// A folder that a run writes into.
#[derive(Debug, Clone)]
pub(super) struct RunFolder {
    path: PathBuf,
    /// Number of the first frame.
    first: u64,
}

impl RunFolder {
    pub fn new(path: &Path, first: u64) -> Result<Self, CaptureError> {
        fs::create_dir_all(path).map_err(|error| io(path, "written", error))?;
        Ok(Self { path: path.to_path_buf(), first })
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, CaptureError> {
        let path = self.path.join(name);
        // A file that is half written is never taken for a whole one.
        let part = self.path.join(format!("{name}.part"));
        fs::write(&part, bytes).and_then(|()| fs::rename(&part, &path)).map_err(|error| io(&path, "written", error))?;
        Ok(path)
    }

    pub fn write_mesh(&self, frame: u32, x: &[DVec3], triangles: &[[u32; 3]]) -> Result<PathBuf, CaptureError> {
        let points: Vec<Vec3> = x.iter().map(|p| p.as_vec3()).collect();
        let bytes = ply(&points, triangles.iter().map(|t| &t[..]));
        self.write(&mesh_name(self.first + u64::from(frame)), &bytes)
    }

    pub fn read_mesh(&self, frame: u32) -> Result<Vec<DVec3>, CaptureError> {
        let path = self.path.join(mesh_name(self.first + u64::from(frame)));
        let bytes = file::read(&path, &FILE).map_err(|e| CaptureError::Source(e.into()))?;
        let points = ply_positions(&bytes).map_err(|problem| {
            CaptureError::unfit(path.display().to_string(), problem, "give an empty output folder to begin anew")
        })?;
        Ok(points.iter().map(|p| p.as_dvec3()).collect())
    }

    pub fn write_state(&self, state: &RunState) -> Result<(), CaptureError> {
        let bytes = serde_json::to_vec(state).map_err(|e| io(&self.path.join(STATE), "written", e.into()))?;
        self.write(STATE, &bytes).map(|_| ())
    }

    /// The state of an earlier run, or none where there was none.
    pub fn read_state(&self) -> Result<Option<RunState>, CaptureError> {
        let path = self.path.join(STATE);
        if !path.exists() {
            return Ok(None);
        }
        let bytes = file::read(&path, &FILE).map_err(|e| CaptureError::Source(e.into()))?;
        serde_json::from_slice(&bytes).map(Some).map_err(|e| {
            let problem = format!("it is no state of a run ({e})");
            CaptureError::unfit(path.display().to_string(), problem, "give an empty output folder to begin anew")
        })
    }

    /// Writes the whole motion, read from the meshes of all frames; nothing where there are too many of them.
    pub fn write_motion(
        &self,
        frames: u32,
        triangles: &[[u32; 3]],
        rate: f64,
    ) -> Result<Option<PathBuf>, CaptureError> {
        if frames as usize > MOST_MOTION {
            return Ok(None);
        }
        let mut all = Vec::with_capacity(frames as usize);
        for frame in 0..frames {
            all.push(self.read_mesh(frame)?.iter().map(|p| p.as_vec3()).collect());
        }
        motion_glb("captured", &all, triangles, rate as f32).map(|bytes| self.write(MOTION, &bytes)).transpose()
    }
}

fn io(path: &Path, action: &'static str, error: std::io::Error) -> CaptureError {
    CaptureError::Io { path: path.display().to_string(), action, error }
}
