//! Joints and shape from depth alone: the parametric body fitted to the shopper's surface, frame after frame.
//!
//! Reads: depth frames that hold nothing but the shopper. Writes: [`Joints`], a shape with its covariance.
//! Budget: 12 ms a frame on one core; the first frame of a shopper a few tenths of a second.
//! Thread: the sensor thread.
//!
//! Analysis by synthesis with point-to-surface residuals and a Gauss-Newton step over pose and shape together; the
//! shape is accumulated over the frames, people (ANSUR II) being what is known before the first.

#[expect(clippy::needless_range_loop, reason = "matrices are read by row and column")]
mod equations;
mod figure;
pub mod follow;
mod matching;
pub mod measuring;
#[expect(clippy::needless_range_loop, reason = "matrices are read by row and column")]
mod memory;
mod start;
mod step;
mod turns;
mod view;

use std::time::Instant;

use glam::{Quat, Vec3};
use toile_assets::body::shape::{Shape, Shapes};
use toile_assets::body::{Body, Sex};
use toile_assets::skeleton::{JOINTS, Joint, Pose};
use toile_sensors::frame::{DepthFrame, Joints, TrackedJoint};

use equations::Equations;
use figure::{Cast, Figure, State};
use matching::Matching;
use memory::Memory;
use step::Known;
use view::View;

/// How a shopper is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Height of the floor (m), where the camera's pose is known.
    pub ground: Option<f32>,
    /// Whether cloth covers the skin: then the fit is one-sided, for cloth lies outside.
    pub clothed: bool,
    /// Least distance between the samples of the surface (m): finer is surer and slower; 0 takes every face.
    pub spacing: f32,
    /// Steps a frame.
    pub steps: usize,
}

impl Options {
    /// For every frame at 30 Hz.
    pub const LIVE: Self = Self { ground: Some(0.0), clothed: true, spacing: 0.030, steps: 3 };

    /// For the second in which a shopper is measured.
    pub const MEASURING: Self = Self { ground: Some(0.0), clothed: true, spacing: 0.0, steps: 2 };
}

/// Matches farther than this are none, in a frame that follows another (m).
const GATE: f32 = 0.09;

/// Residual at which a match has a quarter of its weight, in a frame that follows another (m).
const ROBUST: f32 = 0.035;

/// Gates, residuals and steps by which a shopper is found (m).
const FIRST: [(f32, f32, usize); 3] = [(0.22, 0.15, 6), (0.15, 0.08, 6), (0.10, 0.05, 8)];

/// The same while one way of holding an arm is tried.
const TRIED: [(f32, f32, usize); 2] = [(0.15, 0.10, 3), (0.10, 0.05, 3)];

/// Below this share of explained cells nobody is believed to be followed; above the second a shopper counts as found.
const EXPLAINED: [f32; 2] = [0.60, 0.70];

/// Frames in a row after which a shopper who is not explained is lost.
const PATIENCE: usize = 5;

/// One cell in so many is enough to find a shopper by.
const SPARSE: usize = 4;

/// Another way of holding an arm is believed when it leaves this share of the square distance, or less.
const BETTER: f32 = 0.93;

/// Share of each diagonal that is added: keeps steps in badly seen directions short.
const DAMPING: f64 = 1e-3;

/// Change of any shape parameter at which the normals at rest are worked out anew.
const RESHAPED: f64 = 0.01;

/// Cells that make a joint's surface fully believed: a hand at 3 m has thirty.
const BELIEVED_CELLS: f32 = 16.0;

/// What one frame gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Joints of the fitted body, their confidence by how much of the surface around them is seen; absent when lost.
    pub joints: Joints,
    /// Whether a body was fitted.
    pub found: bool,
    /// Whether it was sought from nothing in this frame.
    pub started: bool,
    /// Share of the shopper's surface that the body explains, 0 to 1.
    pub explained: f32,
    /// Root mean square distance of the surface from the body's (m).
    pub off: f32,
}

/// Where the time of one frame went (s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stages {
    /// Reading the picture into cells.
    pub look: f32,
    /// Posing the body and finding which sample each cell shows.
    pub match_up: f32,
    /// Adding up the equations.
    pub gather: f32,
    /// Solving them, and what the frame says of the shape.
    pub solve: f32,
}

/// One shopper, followed.
pub struct BodyFit {
    options: Options,
    cast: Cast,
    figure: Figure,
    matching: Matching,
    equations: Equations,
    view: View,
    memory: Memory,
    /// The same with fewer samples, to find a shopper by; none if this one's are few.
    scout: Option<Box<BodyFit>>,
    state: Option<State>,
    /// The last state that was believed.
    last: Option<State>,
    still_normals: Vec<Vec3>,
    shaped: Option<Shape>,
    doubts: usize,
    cost: (f64, usize),
    stages: Stages,
}

impl BodyFit {
    /// Nobody yet; the body is of the family of a sex.
    pub fn new(sex: Sex, options: Options) -> Self {
        let shapes = Shapes::of(sex);
        let cast = Cast::new(shapes, options.spacing);
        Self {
            figure: Figure::new(&cast),
            matching: Matching::new(cast.samples.len()),
            equations: Equations::new(),
            view: View::new(),
            memory: Memory::new(shapes),
            scout: (options.spacing < Options::LIVE.spacing)
                .then(|| Box::new(Self::new(sex, Options { spacing: Options::LIVE.spacing, ..options }))),
            state: None,
            last: None,
            still_normals: vec![Vec3::ZERO; cast.samples.len()],
            shaped: None,
            doubts: 0,
            cost: (0.0, 0),
            stages: Stages::default(),
            options,
            cast,
        }
    }

    /// Forgets the shopper.
    pub fn reset(&mut self) {
        self.memory = Memory::new(self.cast.shapes);
        (self.state, self.last, self.doubts, self.cost) = (None, None, 0, (0.0, 0));
    }

    /// Fits the body to the next frame, which holds nothing but the shopper (all other pixels 0).
    pub fn push(&mut self, frame: &DepthFrame) -> Seen {
        self.stages = Stages::default();
        let begun = Instant::now();
        let enough = self.view.look(frame);
        self.stages.look = begun.elapsed().as_secs_f32();
        if !enough {
            self.doubt();
            return self.seen(frame.time_ns, false);
        }
        let started = self.state.is_none();
        let next = match self.state {
            None => match self.scouted(frame) {
                Some(found) => self.settled(found),
                None => self.find(),
            },
            Some(state) => {
                self.reshape(&state.shape);
                self.steps(&state, Some(&state), (GATE, ROBUST, self.options.steps))
            }
        };
        let enough = EXPLAINED[usize::from(started)];
        if self.matching.explained >= enough && next.root.is_finite() {
            self.doubts = 0;
            self.state = Some(next);
            self.last = Some(next);
            let begun = Instant::now();
            self.memory.add(&self.equations.shape(), &next.shape);
            self.stages.solve += begun.elapsed().as_secs_f32();
            self.cost = (self.cost.0 + self.equations.cost, self.cost.1 + 1);
        } else if !started {
            self.doubt();
        }
        self.seen(frame.time_ns, started)
    }

    fn doubt(&mut self) {
        self.doubts += 1;
        if self.doubts >= PATIENCE {
            self.state = None;
        }
    }

    /// What fewer samples find.
    fn scouted(&mut self, frame: &DepthFrame) -> Option<State> {
        let scout = self.scout.as_mut()?;
        scout.reset();
        scout.push(frame);
        scout.state
    }

    /// Looks for the shopper from nothing.
    fn find(&mut self) -> State {
        let mut best = start::upright(&self.cast, &self.view, self.options.ground);
        self.reshape(&best.shape);
        self.matching.every = SPARSE;
        best = self.stage(best, &FIRST[..2]);
        let mut least = self.judged(&best);
        for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
            let from = best;
            for arm in &start::ARMS {
                let mut tried = from;
                start::hold(&self.cast, &mut tried, shoulder, *arm);
                tried = self.stage(tried, &TRIED);
                let off = self.judged(&tried);
                if off < least * BETTER {
                    (least, best) = (off, tried);
                }
            }
        }
        self.matching.every = 1;
        self.settled(best)
    }

    /// The last steps of looking for somebody, by all that is seen.
    fn settled(&mut self, found: State) -> State {
        self.reshape(&found.shape);
        let best = self.stage(found, &FIRST[2..]);
        self.reshape(&best.shape);
        self.steps(&best, None, (GATE, ROBUST, self.options.steps))
    }

    fn stage(&mut self, mut state: State, stages: &[(f32, f32, usize)]) -> State {
        for stage in stages {
            state = self.steps(&state, None, *stage);
        }
        state
    }

    /// How far the picture is off a state (m2).
    fn judged(&mut self, state: &State) -> f32 {
        self.figure.pose(&self.cast, state, &self.still_normals);
        self.matching.find(&self.view, &self.figure, FIRST[2].0);
        self.matching.off
    }

    fn steps(&mut self, from: &State, before: Option<&State>, (gate, robust, steps): (f32, f32, usize)) -> State {
        let mut state = *from;
        for _ in 0..steps {
            let begun = Instant::now();
            self.figure.pose(&self.cast, &state, &self.still_normals);
            self.matching.find(&self.view, &self.figure, gate);
            let matched = Instant::now();
            self.stages.match_up += (matched - begun).as_secs_f32();
            let shape = self.memory.about(&state.shape);
            let Options { ground, clothed, .. } = self.options;
            let known = Known { ground, clothed, robust };
            let Self { cast, figure, view, matching, equations, .. } = self;
            step::gather(equations, step::Scene { cast, figure, view, matching }, &known);
            step::habits(&mut self.equations, &self.cast, &state, before);
            let gathered = Instant::now();
            self.stages.gather += (gathered - matched).as_secs_f32();
            let by = step::bounded(self.equations.step(&shape, DAMPING));
            let next = state.stepped(&self.cast, &by);
            self.stages.solve += gathered.elapsed().as_secs_f32();
            if !next.root.is_finite() {
                break;
            }
            state = next;
        }
        state
    }

    /// Normals of the samples at rest, where the shape has changed enough.
    fn reshape(&mut self, shape: &Shape) {
        if self.shaped.is_some_and(|s| s.iter().zip(shape).all(|(a, b)| (a - b).abs() < RESHAPED)) {
            return;
        }
        for (still, sample) in self.still_normals.iter_mut().zip(&self.cast.samples) {
            let [a, b, c, d] = sample.corners.map(|v| self.cast.shapes.place(v as usize, shape));
            *still = (c - a).cross(d - b).normalize_or_zero();
        }
        self.shaped = Some(*shape);
    }

    fn seen(&self, time_ns: u64, started: bool) -> Seen {
        let mut joints = Joints::absent(time_ns);
        let found = self.state.is_some() && self.doubts == 0;
        if found {
            let cells = self.cells_of_joints();
            for joint in Joint::ALL {
                let i = joint.index();
                // A joint lies where the two bones that meet there say.
                let own = cells[i].max(joint.parent().map_or(0.0, |p| cells[p.index()]));
                let confidence = (own / BELIEVED_CELLS).min(1.0);
                joints.joints[i] = TrackedJoint { position: self.figure.place[i], confidence };
            }
        }
        let (explained, off) =
            if found { (self.matching.explained, step::rms(&self.figure, &self.matching)) } else { (0.0, 0.0) };
        Seen { joints, found, started, explained, off }
    }

    /// Cells on the surface that each joint's bone carries.
    fn cells_of_joints(&self) -> [f32; JOINTS] {
        let mut cells = [0.0; JOINTS];
        for (sample, found) in self.cast.samples.iter().zip(&self.matching.of) {
            for (joint, share) in sample.bones() {
                cells[joint] += share * found.count;
            }
        }
        cells
    }

    /// Where the time of the last frame went.
    pub fn stages(&self) -> Stages {
        self.stages
    }

    /// The shape as all frames so far have it; the mean person's before the first.
    pub fn shape(&self) -> Shape {
        self.memory.estimate().0
    }

    /// Frames that the shape comes from.
    pub fn frames(&self) -> usize {
        self.memory.frames()
    }

    /// The pose of the last frame in which somebody was found.
    pub fn last_pose(&self) -> Option<Pose> {
        self.last.map(|s| Pose { root: s.root, local: s.local.map(Quat::normalize) })
    }

    /// The fitted body at rest, and its pose in the last frame; `None` when nobody is followed.
    pub fn body(&self) -> Option<(Body, Pose)> {
        let state = self.state?;
        let body = self.cast.shapes.body(&state.shape).body;
        Some((body, Pose { root: state.root, local: state.local.map(Quat::normalize) }))
    }
}
