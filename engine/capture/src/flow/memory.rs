//! State written beside the meshes, so that a run goes on where it stopped with the same bits.

use std::collections::BTreeSet;

use glam::DVec3;
use image::RgbImage;
use serde::{Deserialize, Serialize};

use super::residual::Tone;
use super::settings::Reference;
use super::tracker::FlowTracker;
use crate::error::CaptureError;

/// The brightness and the references of all triangles: what a run needs to go on where it stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlowMemory {
    /// Gain and offset of each triangle in each camera, as bits `[cameras x triangles]`.
    tones: Vec<[u32; 2]>,
    /// Frame in which each camera first saw each triangle, or none `[cameras x triangles]`.
    taken: Vec<Option<u32>>,
}

impl FlowTracker {
    /// What a later run needs besides the meshes of the last two frames and the pictures of those frames that it names.
    pub fn memory(&self) -> FlowMemory {
        let bits = |t: &Tone| [t.gain.to_bits(), t.offset.to_bits()];
        FlowMemory {
            tones: self.state.tones.iter().flatten().map(bits).collect(),
            taken: self.state.taken.iter().flatten().copied().collect(),
        }
    }

    /// Frames whose pictures and meshes [`FlowTracker::resume`] reads again.
    pub fn frames_of(memory: &FlowMemory) -> Vec<u32> {
        let frames: BTreeSet<u32> = memory.taken.iter().flatten().copied().collect();
        frames.into_iter().collect()
    }

    /// Goes on where a run stopped: `earlier` gives the mesh and the pictures of a frame, `last` are the meshes of the last two.
    ///
    /// # Errors
    /// As `earlier` and [`FlowTracker::step`].
    pub fn resume(
        &mut self,
        memory: &FlowMemory,
        frame: u32,
        last: [Vec<DVec3>; 2],
        mut earlier: impl FnMut(u32) -> Result<(Vec<DVec3>, Vec<RgbImage>), CaptureError>,
    ) -> Result<(), CaptureError> {
        let t = self.state.surface.triangles.len();
        if memory.taken.len() != t * self.state.cameras.len() {
            let cure = "give another output folder, or the mesh, cameras and settings that it was begun with";
            return Err(CaptureError::unfit(
                "the run that is resumed",
                "it is of another mesh or other settings",
                cure,
            ));
        }
        let mut frames = Self::frames_of(memory);
        if self.state.settings.reference == Reference::Previous {
            frames = vec![frame - 1];
        }
        for of in frames {
            let (positions, pictures) = earlier(of)?;
            self.state.positions = positions;
            let pyramids = self.state.pyramids(&pictures)?;
            self.state.look();
            self.state.take_references(&pyramids, of);
        }
        for (k, [gain, offset]) in memory.tones.iter().enumerate() {
            self.state.tones[k / t][k % t] = Tone { gain: f32::from_bits(*gain), offset: f32::from_bits(*offset) };
        }
        let [before, now] = last;
        (self.state.before, self.state.positions, self.state.frame) = (before, now, frame);
        Ok(())
    }
}
