//! The body fit of one shopper, frame after frame: found from nothing, then followed.

use std::time::Instant;

use glam::{Quat, Vec3};
use toile_assets::body::shape::{BodyShape, Shapes};
use toile_base::body::Sex;
use toile_base::frame::{DepthFrame, Joints, TrackedJoint};
use toile_base::skeleton::{JOINTS, Joint, Pose};

use super::correspondence::Correspondences;
use super::depth_cells::DepthCells;
use super::initial_pose;
use super::normal_equations::{NormalEquations, ShapeQuadratic};
use super::options::{FitOptions, Stance};
use super::path::{PathState, facing};
use super::posed_body::{BodyModel, FitState, PosedBody};
use super::residuals::{self, PosePrior, ResidualOptions};
use super::shape_filter::ShapeFilter;

/// Largest distance of a correspondence while tracking (m).
const GATE: f32 = 0.09;

/// Residual at which a correspondence has a quarter of its weight while tracking (m).
pub(super) const ROBUST: f32 = 0.035;

/// Stages of the first fit, coarse to fine: gate (m), robust residual (m), steps.
const FIRST: [(f32, f32, usize); 3] = [(0.22, 0.15, 6), (0.15, 0.08, 6), (0.10, 0.05, 8)];

/// The same stages for one candidate arm pose.
const TRIED: [(f32, f32, usize); 2] = [(0.15, 0.10, 3), (0.10, 0.05, 3)];

/// Least fraction of explained cells while tracking, and for a first fit.
const EXPLAINED: [f32; 2] = [0.60, 0.70];

/// Consecutive badly explained frames after which the shopper is lost.
const PATIENCE: usize = 5;

/// The first fit uses one cell in this many.
const SPARSE: usize = 4;

/// A candidate arm pose replaces the best one when its mean square distance is below this fraction of it.
const BETTER: f32 = 0.93;

/// Levenberg-Marquardt damping, a fraction of each diagonal: keeps steps in poorly observed directions short.
const DAMPING: f64 = 1e-3;

/// Frames after which the pose of a person who is measured is kept, and the standard deviation of every angle about it (rad).
const SETTLED: usize = 3;
const HOLDING: f32 = 0.3;

/// Frames over which the rate of a turn is taken: a fifth of a second, because one frame from the side may be some degrees off.
const RATE_OVER: usize = 3;

/// Change of any shape parameter at which the rest normals are computed again.
const RESHAPED: f64 = 0.01;

/// Cells around a joint that give it full confidence: a hand at 3 m has thirty.
const BELIEVED_CELLS: f32 = 16.0;

/// The fit of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedFrame {
    /// Joints of the fitted body, with confidence by how much of the surface around them is visible; absent when lost.
    pub joints: Joints,
    /// Whether a body was fitted.
    pub found: bool,
    /// Whether this frame was a first fit, without a frame before it.
    pub started: bool,
    /// Fraction of the shopper's visible surface that the body explains, 0 to 1.
    pub explained: f32,
    /// Root mean square distance of the surface from the body's (m).
    pub off: f32,
}

/// Time of one frame by stage (s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FitTimes {
    /// Averaging the depth image into cells.
    pub cells: f32,
    /// Posing the body and finding the correspondences.
    pub correspond: f32,
    /// Summing the normal equations.
    pub equations: f32,
    /// Solving them, and updating the shape.
    pub solve: f32,
}

/// What a fit knew at some frame.
pub(super) struct FitMark {
    path: usize,
    last: Option<FitState>,
    shape_filter: ShapeFilter,
}

/// The body fit of one shopper, frame after frame.
pub struct BodyFit {
    pub(super) options: FitOptions,
    pub(super) model: BodyModel,
    pub(super) posed: PosedBody,
    pub(super) matches: Correspondences,
    pub(super) equations: NormalEquations,
    pub(super) view: DepthCells,
    pub(super) shape_filter: ShapeFilter,
    /// The same with fewer samples, for the first fit; `None` if this one's are few already.
    coarse: Option<Box<BodyFit>>,
    state: Option<FitState>,
    /// Every state of a person who is measured; empty while they only move.
    pub(super) path: Vec<PathState>,
    /// Frames pushed.
    pushed: usize,
    /// The last state that was believed.
    pub(super) last: Option<FitState>,
    pub(super) rest_normals: Vec<Vec3>,
    pub(super) shaped: Option<BodyShape>,
    failures: usize,
    pub(super) cost: (f64, usize),
    times: FitTimes,
}

impl BodyFit {
    /// A fit that has seen no person yet; the body model is that of a sex.
    pub fn new(sex: Sex, options: FitOptions) -> Self {
        let shapes = Shapes::of(sex);
        let model = BodyModel::new(shapes, options.spacing);
        Self {
            posed: PosedBody::new(&model),
            matches: Correspondences::new(model.samples.len()),
            equations: NormalEquations::new(),
            view: DepthCells::new(),
            shape_filter: ShapeFilter::new(shapes),
            coarse: (options.spacing < FitOptions::LIVE.spacing)
                .then(|| Box::new(Self::new(sex, FitOptions { spacing: FitOptions::LIVE.spacing, ..options }))),
            state: None,
            path: Vec::new(),
            pushed: 0,
            last: None,
            rest_normals: vec![Vec3::ZERO; model.samples.len()],
            shaped: None,
            failures: 0,
            cost: (0.0, 0),
            times: FitTimes::default(),
            options,
            model,
        }
    }

    /// Forgets the shopper.
    pub fn reset(&mut self) {
        self.shape_filter = ShapeFilter::new(self.model.shapes);
        (self.state, self.last, self.failures, self.cost) = (None, None, 0, (0.0, 0));
        (self.path, self.pushed) = (Vec::new(), 0);
    }

    /// Fits the body to the next frame, which holds nothing but the shopper (all other pixels 0).
    pub fn push(&mut self, frame: &DepthFrame) -> FittedFrame {
        self.times = FitTimes::default();
        self.pushed += 1;
        let begun = Instant::now();
        let enough = self.view.read(frame);
        if enough && self.options.has_rim() {
            self.view.read_rim(frame);
        }
        self.times.cells = begun.elapsed().as_secs_f32();
        if !enough {
            self.fail();
            return self.report(frame.time_ns, false);
        }
        let started = self.state.is_none();
        let next = match self.state {
            None => match self.find_coarsely(frame) {
                Some(found) => self.refine(found),
                None => self.fit_first(),
            },
            Some(state) => {
                self.update_rest_normals(&state.shape);
                let ahead = self.ahead(&state);
                self.steps(&ahead, Some(&ahead), (GATE, ROBUST, self.options.steps))
            }
        };
        let enough = EXPLAINED[usize::from(started)];
        if self.matches.explained >= enough && next.root.is_finite() {
            self.failures = 0;
            self.state = Some(next);
            self.last = Some(next);
            if self.options.stance == Stance::Held {
                let facing = facing(&next, self.view.camera_position());
                self.path.push(PathState { frame: self.pushed - 1, state: next, facing });
            }
            let begun = Instant::now();
            self.shape_filter.add(&self.equations.shape(), &next.shape);
            self.times.solve += begun.elapsed().as_secs_f32();
            self.cost = (self.cost.0 + self.equations.cost, self.cost.1 + 1);
        } else if !started {
            self.fail();
        }
        self.report(frame.time_ns, started)
    }

    fn fail(&mut self) {
        self.failures += 1;
        // A person who turns is lost from the side for a moment; who begins anew there is taken to face the camera.
        let turns = self.path.len() > SETTLED;
        if self.failures >= PATIENCE && !turns {
            self.state = None;
        }
    }

    /// The first fit with fewer samples.
    fn find_coarsely(&mut self, frame: &DepthFrame) -> Option<FitState> {
        let coarse = self.coarse.as_mut()?;
        coarse.reset();
        coarse.push(frame);
        coarse.state
    }

    /// The first fit: an upright body, then the best of the candidate poses of each arm.
    fn fit_first(&mut self) -> FitState {
        let mut best = initial_pose::upright(&self.model, &self.view, self.options.ground);
        self.update_rest_normals(&best.shape);
        self.matches.every = SPARSE;
        best = self.stage(best, &FIRST[..2]);
        let mut least = self.mean_square(&best);
        for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
            let from = best;
            for arm in &initial_pose::ARMS {
                let mut tried = from;
                initial_pose::set_arm(&self.model, &mut tried, shoulder, *arm);
                tried = self.stage(tried, &TRIED);
                let off = self.mean_square(&tried);
                if off < least * BETTER {
                    (least, best) = (off, tried);
                }
            }
        }
        self.matches.every = 1;
        self.refine(best)
    }

    /// The last steps of a first fit, with all cells.
    fn refine(&mut self, found: FitState) -> FitState {
        self.update_rest_normals(&found.shape);
        let best = self.stage(found, &FIRST[2..]);
        self.update_rest_normals(&best.shape);
        self.steps(&best, None, (GATE, ROBUST, self.options.steps))
    }

    fn stage(&mut self, mut state: FitState, stages: &[(f32, f32, usize)]) -> FitState {
        for stage in stages {
            state = self.steps(&state, None, *stage);
        }
        state
    }

    /// Mean square distance of the cells from a state (m2).
    fn mean_square(&mut self, state: &FitState) -> f32 {
        self.posed.pose(&self.model, state, &self.rest_normals);
        self.matches.find(&self.view, &self.posed, FIRST[2].0);
        self.matches.off
    }

    /// Where a person who is measured will be in this frame: they turn on as they turned, through frames in which they were lost, too.
    fn ahead(&self, state: &FitState) -> FitState {
        let Some(now) = self.path.last() else { return *state };
        let since = self.path.len().saturating_sub(1 + RATE_OVER);
        let Some(before) = self.path[since..].iter().find(|p| p.frame < now.frame) else { return *state };
        let share = (self.pushed - 1 - now.frame) as f32 / (now.frame - before.frame) as f32;
        let turned = (now.state.local[0] * before.state.local[0].inverse()).normalize();
        let turned = if turned.w < 0.0 { -turned } else { turned };
        let mut ahead = *state;
        ahead.local[0] = (Quat::from_scaled_axis(turned.to_scaled_axis() * share) * state.local[0]).normalize();
        ahead.root += (now.state.root - before.state.root) * share.min(1.0);
        ahead
    }

    fn steps(
        &mut self,
        from: &FitState,
        before: Option<&FitState>,
        (gate, robust, steps): (f32, f32, usize),
    ) -> FitState {
        let settled = self.path.get(SETTLED).map(|p| p.state);
        let held = settled.as_ref().map(|s| (s, [HOLDING; 2]));
        let mut state = *from;
        for _ in 0..steps {
            let shape = self.shape_filter.about(&state.shape);
            let Some(next) = self.step(&state, &shape, before, held, (gate, robust)) else { break };
            state = next;
        }
        state
    }

    /// One Gauss-Newton step; `None` where it leads nowhere.
    pub(super) fn step(
        &mut self,
        state: &FitState,
        shape: &ShapeQuadratic,
        before: Option<&FitState>,
        held: Option<(&FitState, [f32; 2])>,
        (gate, robust): (f32, f32),
    ) -> Option<FitState> {
        let begun = Instant::now();
        self.posed.pose(&self.model, state, &self.rest_normals);
        self.matches.find(&self.view, &self.posed, gate);
        let matched = Instant::now();
        self.times.correspond += (matched - begun).as_secs_f32();
        let FitOptions { stance, .. } = self.options;
        let options = ResidualOptions { fit: self.options, robust };
        let Self { model, posed, view, matches, equations, .. } = self;
        residuals::add_observations(equations, residuals::Observation { model, posed, view, matches }, &options);
        residuals::add_priors(equations, model, state, &PosePrior { stance, before, held });
        let gathered = Instant::now();
        self.times.equations += (gathered - matched).as_secs_f32();
        let by = residuals::limit_step(self.equations.step(shape, DAMPING));
        let next = state.stepped(&self.model, &by);
        self.times.solve += gathered.elapsed().as_secs_f32();
        next.root.is_finite().then_some(next)
    }

    /// Updates the rest normals of the samples where the shape has changed enough.
    pub(super) fn update_rest_normals(&mut self, shape: &BodyShape) {
        if self.shaped.is_some_and(|s| s.iter().zip(shape).all(|(a, b)| (a - b).abs() < RESHAPED)) {
            return;
        }
        for (normal, sample) in self.rest_normals.iter_mut().zip(&self.model.samples) {
            let [a, b, c, d] = sample.corners.map(|v| self.model.shapes.place(v as usize, shape));
            *normal = (c - a).cross(d - b).normalize_or_zero();
        }
        self.shaped = Some(*shape);
    }

    fn report(&self, time_ns: u64, started: bool) -> FittedFrame {
        let mut joints = Joints::absent(time_ns);
        let found = self.state.is_some() && self.failures == 0;
        if found {
            let cells = self.cells_of_joints();
            for joint in Joint::ALL {
                let i = joint.index();
                // A joint is located by both bones that meet there.
                let own = cells[i].max(joint.parent().map_or(0.0, |p| cells[p.index()]));
                let confidence = (own / BELIEVED_CELLS).min(1.0);
                joints.joints[i] = TrackedJoint { position: self.posed.place[i], confidence };
            }
        }
        let (explained, off) =
            if found { (self.matches.explained, residuals::rms(&self.posed, &self.matches)) } else { (0.0, 0.0) };
        FittedFrame { joints, found, started, explained, off }
    }

    /// Cells on the surface that is skinned to each joint's bone.
    fn cells_of_joints(&self) -> [f32; JOINTS] {
        let mut cells = [0.0; JOINTS];
        for (sample, found) in self.model.samples.iter().zip(&self.matches.of) {
            for (joint, share) in sample.bones() {
                cells[joint] += share * found.count;
            }
        }
        cells
    }

    /// What is known so far.
    pub(super) fn mark(&self) -> FitMark {
        FitMark { path: self.path.len(), last: self.last, shape_filter: self.shape_filter.clone() }
    }

    /// Forgets what was seen since.
    pub(super) fn go_back_to(&mut self, mark: FitMark) {
        self.path.truncate(mark.path);
        (self.last, self.shape_filter) = (mark.last, mark.shape_filter);
    }

    /// Time of the last frame by stage.
    pub fn times(&self) -> FitTimes {
        self.times
    }

    /// The shape estimated from all frames so far; the mean person's before the first.
    pub fn shape(&self) -> BodyShape {
        self.shape_filter.estimate().0
    }

    /// Frames that the shape is estimated from.
    pub fn frames(&self) -> usize {
        self.shape_filter.frames()
    }

    /// The pose of the last frame that was fitted.
    pub fn last_pose(&self) -> Option<Pose> {
        self.last.map(|s| Pose { root: s.root, local: s.local.map(Quat::normalize) })
    }
}
