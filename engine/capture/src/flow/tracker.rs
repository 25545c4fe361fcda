//! The surface followed from frame to frame.

use std::time::Instant;

use glam::DVec3;
use image::RgbImage;
use serde::{Deserialize, Serialize};
use toile_sensors::calibration::CalibratedCamera;

use super::pass::Pass;
use super::references::FirstFrame;
use super::settings::FlowSettings;
use super::state::{FlowState, written};
use crate::error::CaptureError;
use crate::plane::Pyramid;
use crate::surface::CapturedSurface;

/// Mean step below which a level is done (px of the level).
const STILL: f64 = 0.01;

/// Residuals may grow by this part and the iterations go on: triangles come into view and leave it.
const GROWTH: f64 = 0.05;

/// Standard deviation that residuals are taken to have at the coarsest level, and when another begins (of 255); it then follows them.
const BEGIN: [f32; 2] = [20.0, 10.0];

/// Longest step of a vertex (px of the level): farther, a picture is not what its derivatives say.
const LONGEST: f64 = 3.0;

/// Steps of the conjugate gradients, and the part of the residual that they leave.
const MOST_STEPS: usize = 60;
const LEFT: f64 = 2e-2;

/// Least mean correlation between cameras in the first frame: a mesh beside its place by two pixels of print has less.
const LEAST_AGREEMENT: f32 = 0.5;

/// A surface of which cameras place less than this part in so many frames one after the other is lost.
const LEAST_PLACED: f64 = 0.1;
const PATIENCE: u32 = 5;

/// How one frame was followed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrameOutcome {
    /// Root mean square residual of the samples that count (of 255).
    pub residual: f64,
    /// Part of the triangles that enough cameras placed.
    pub placed: f64,
    /// Iterations, of all levels.
    pub iterations: usize,
    /// Time of the iterations, without reading pictures (s).
    pub seconds: f64,
    /// Strain of the edges over the first frame, root mean square.
    pub strain: f64,
}

/// A surface that is followed.
pub struct FlowTracker {
    pub(super) state: FlowState,
}

impl FlowTracker {
    /// A tracker of a surface that these cameras see.
    ///
    /// # Errors
    /// One sentence where there are fewer than two cameras, or one does not see the surface.
    pub fn new(
        surface: CapturedSurface,
        cameras: Vec<CalibratedCamera>,
        settings: FlowSettings,
    ) -> Result<Self, CaptureError> {
        Ok(Self { state: FlowState::new(surface, cameras, settings)? })
    }

    /// The surface that is followed.
    pub const fn surface(&self) -> &CapturedSurface {
        &self.state.surface
    }

    /// Where it is now (m, world) `[vertices]`.
    pub fn positions(&self) -> &[DVec3] {
        &self.state.positions
    }

    /// Frames that were followed, the first included.
    pub const fn frame(&self) -> u32 {
        self.state.frame
    }

    /// Takes the first frame, in which the mesh is known, as reference.
    ///
    /// # Errors
    /// One sentence where the mesh does not fit the pictures.
    pub fn start(&mut self, pictures: &[RgbImage]) -> Result<FirstFrame, CaptureError> {
        let pyramids = self.state.pyramids(pictures)?;
        self.state.look();
        self.state.take_references(&pyramids, 0);
        self.state.frame = 1;
        let first = self.state.agreement();
        if first.pairs == 0 || first.agreement >= LEAST_AGREEMENT {
            return Ok(first);
        }
        let FirstFrame { agreement, residual, .. } = first;
        let problem = format!(
            "it does not fit the first frame: its pictures in two cameras correlate {agreement:.2} where {LEAST_AGREEMENT} is the \
             least, and differ by {residual:.0} of 255"
        );
        Err(CaptureError::unfit("the mesh", problem, "fit it to the first frame, in the world of the cameras"))
    }

    /// Follows the surface into the next frame.
    ///
    /// # Errors
    /// One sentence where it has left a camera's pictures.
    pub fn step(&mut self, pictures: &[RgbImage]) -> Result<FrameOutcome, CaptureError> {
        let state = &mut self.state;
        let pyramids = state.pyramids(pictures)?;
        let begun = Instant::now();
        let carried = state.carried();
        state.before.clone_from(&state.positions);
        state.positions.clone_from(&carried);
        let mut iterations = 0;
        let mut last = Pass::default();
        let coarsest = pyramids.iter().map(|p| p.levels.len()).min().unwrap_or(1).min(state.settings.levels);
        state.look();
        for level in (0..coarsest).rev() {
            if level == 0 {
                state.look();
            }
            let begin = if level + 1 == coarsest { BEGIN[0] } else { BEGIN[1] };
            let (pass, taken) = state.descend(&pyramids, level, &carried, begin);
            iterations += taken;
            last = pass;
        }
        let seconds = begun.elapsed().as_secs_f64();
        state.positions = written(&state.positions);
        state.look();
        let frame = state.frame;
        state.take_references(&pyramids, frame);
        state.frame += 1;
        let triangles = state.surface.triangles.len() as f64;
        let placed = last.placed as f64 / triangles;
        state.unseen = if placed < LEAST_PLACED { state.unseen + 1 } else { 0 };
        if state.unseen >= PATIENCE {
            let problem = format!("it was lost before frame {frame}: cameras place {:.0} % of it", 100.0 * placed);
            let cure = "follow it from there with a mesh of that frame, with more --levels where it moves fast, or with more cameras";
            return Err(CaptureError::unfit("the mesh", problem, cure));
        }
        Ok(FrameOutcome { residual: f64::from(last.scatter), placed, iterations, seconds, strain: state.strain() })
    }
}

impl FlowState {
    /// Iterations at one level, until the surface is still or its cost grows, as in the source's main loop.
    fn descend(&mut self, pyramids: &[Pyramid], level: usize, carried: &[DVec3], begin: f32) -> (Pass, usize) {
        let masks = self.masks(level, true);
        let pixel = self.pixel(level);
        let mut kept: Option<(Pass, Vec<DVec3>)> = None;
        let mut scatter = begin;
        let mut step = Vec::new();
        for k in 0.. {
            let pass = self.pass(pyramids, level, &masks, carried, scatter);
            scatter = pass.scatter;
            if let Some((before, positions)) = kept.as_ref().filter(|(b, _)| pass.cost > b.cost * (1.0 + GROWTH)) {
                self.positions.clone_from(positions);
                return (*before, k);
            }
            self.system.solve(&mut step, LEFT, MOST_STEPS);
            let mean = step.iter().map(|s| s.length()).sum::<f64>() / step.len() as f64;
            if k == self.settings.iterations || mean < STILL * pixel {
                return (pass, k + 1);
            }
            kept = Some((pass, self.positions.clone()));
            self.positions.iter_mut().zip(&step).for_each(|(x, s)| *x += s.clamp_length_max(LONGEST * pixel));
        }
        unreachable!("the iterations end")
    }

    fn strain(&self) -> f64 {
        let rest = &self.surface.rest;
        let of = |x: &[DVec3], [a, b]: [u32; 2]| x[a as usize].distance(x[b as usize]);
        let squares = self.surface.edges.iter().map(|e| (of(&self.positions, *e) / of(rest, *e) - 1.0).powi(2));
        (squares.sum::<f64>() / self.surface.edges.len() as f64).sqrt()
    }
}
