//! One run of a scene under one setting.

use std::time::Instant;

use glam::{Affine3A, DVec3, Vec3A};
use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;
use toile_base::limits::STEP_SECONDS;
use toile_base::numeric::statistics::median;
use toile_base::skeleton::BONES;
use toile_engine::cloth::step::program::{self, Stage};
use toile_engine::cloth::{Cloth, Quality, Settings, Step, step::measure};
use toile_engine::colliders::Colliders;
use toile_engine::workers::WorkerPool;
use toile_fitting::timing;

use super::error::ParetoError;
use super::meshed_scene::MeshedScene;
use crate::oracle::measure::energies;
use crate::oracle::{Problem, State};

/// How a scene is stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setting {
    /// What is solved in a substep.
    pub quality: Quality,
    /// Substeps of a step; as garment and quality ask if not given.
    pub substeps: Option<u32>,
    /// Workers of a step.
    pub threads: usize,
}

/// What a run showed.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Positions by vertex (m) `[frames][vertices]`.
    pub frames: Vec<Vec<DVec3>>,
    /// Time (s) and energy (J) of each frame.
    pub energy: Vec<[f64; 2]>,
    /// Median time of a step (us).
    pub step_us: f64,
    /// Mean over the frames of mean strain and of its 99th percentile (1).
    pub strain: [f64; 2],
    /// Steps that were rolled back.
    pub rolled_back: u64,
    /// Substeps of a step.
    pub substeps: u32,
}

/// A moment of a run, from which windows start.
#[derive(Debug, Clone)]
pub struct WindowStart {
    /// Steps from the scene's start.
    tick: u64,
    /// Position (m) and velocity (m/s) by vertex.
    state: Vec<[Vec3A; 2]>,
    /// What friction remembers; none where nothing rubs.
    memory: Option<Box<Cloth>>,
}

/// Steps of a window: three pictures of a screen at 60 Hz. What one state becomes in it is one answer; a second later the
/// folds of any two runs differ.
pub const WINDOW: u64 = 6;

/// Steps from the start of a window to that of the next.
const APART: u64 = 15;

/// One cloth in its surroundings.
struct SteppedCloth<'a> {
    subject: &'a MeshedScene,
    garment: &'a Garment,
    cloth: Cloth,
    settings: Settings,
    colliders: Colliders,
    bones: [Affine3A; BONES],
    problem: Problem,
}

impl<'a> SteppedCloth<'a> {
    /// At its start, or at a tick.
    fn new(subject: &'a MeshedScene, garment: &'a Garment, setting: Setting, tick: u64) -> Self {
        let settings = Settings {
            quality: setting.quality,
            substeps: setting.substeps,
            workers: setting.threads,
            ..Settings::default()
        };
        let (mut bones, mut colliders) = ([Affine3A::IDENTITY; BONES], subject.colliders.clone());
        subject.place(seconds(tick), &mut bones, &mut colliders);
        let (cloth, problem) = (Cloth::new(garment, &colliders), Problem::of(garment));
        Self { subject, garment, cloth, settings, colliders, bones, problem }
    }

    /// The step that ends at a tick; its time (ns).
    fn step(&mut self, tick: u64, pool: &mut WorkerPool) -> u64 {
        self.subject.place(seconds(tick), &mut self.bones, &mut self.colliders);
        timing::wake(pool);
        let begun = Instant::now();
        let step = Step { palette: &self.bones, colliders: &self.colliders, settings: &self.settings };
        self.cloth.step_with(pool, self.garment, &step);
        begun.elapsed().as_nanos() as u64
    }

    /// Puts the cloth into a moment's state: a step with the body at rest there, which places pins and colliders, and
    /// then every particle where it was.
    fn enter(&mut self, moment: &WindowStart, pool: &mut WorkerPool) {
        self.step(moment.tick, pool);
        for (particle, &vertex) in self.garment.source.iter().enumerate() {
            let [at, velocity] = moment.state[vertex as usize];
            self.cloth.disturb(particle, at, velocity);
        }
        if let Some(memory) = &moment.memory {
            self.cloth.remember(memory);
        }
    }

    fn moment(&self, tick: u64) -> WindowStart {
        let mut state = vec![[Vec3A::ZERO; 2]; self.garment.source.len()];
        for (particle, &vertex) in self.garment.source.iter().enumerate() {
            state[vertex as usize] = [self.cloth.positions[particle], self.cloth.velocity(particle)];
        }
        let rubs = !self.cloth.sticks().is_empty() || self.cloth.link_sticks().next().is_some();
        WindowStart { tick, state, memory: rubs.then(|| Box::new(self.cloth.clone())) }
    }
}

/// Time at the end of a step (s).
fn seconds(tick: u64) -> f64 {
    tick as f64 * f64::from(STEP_SECONDS)
}

/// Runs a scene from its start to its end.
pub fn play(subject: &MeshedScene, garment: &Garment, setting: Setting) -> Result<Trace, ParetoError> {
    Ok(play_through(subject, garment, setting)?.0)
}

/// The same, with the moments from which windows are to start.
pub fn play_through(
    subject: &MeshedScene,
    garment: &Garment,
    setting: Setting,
) -> Result<(Trace, Vec<WindowStart>), ParetoError> {
    let mut pool = WorkerPool::new(setting.threads.clamp(1, OWNERS))?;
    let mut scene = SteppedCloth::new(subject, garment, setting, 0);
    let (mut trace, mut moments, mut times_ns) = (Trace::default(), Vec::new(), Vec::new());
    for tick in 1..=subject.steps() {
        times_ns.push(scene.step(tick, &mut pool));
        if tick % WINDOW == 0 || tick == subject.steps() {
            trace.add(tick, &mut scene);
        }
        if tick % APART == 0 && tick + WINDOW <= subject.steps() {
            moments.push(scene.moment(tick));
        }
    }
    trace.close(&scene.cloth, times_ns);
    Ok((trace, moments))
}

/// Runs a window from each of some moments; a frame is the end of one.
pub fn play_windows(
    subject: &MeshedScene,
    garment: &Garment,
    setting: Setting,
    moments: &[WindowStart],
) -> Result<Trace, ParetoError> {
    let mut pool = WorkerPool::new(setting.threads.clamp(1, OWNERS))?;
    let (mut trace, mut times_ns) = (Trace::default(), Vec::new());
    let mut rolled_back = 0;
    let mut last = None;
    for moment in moments {
        let mut scene = SteppedCloth::new(subject, garment, setting, moment.tick);
        scene.enter(moment, &mut pool);
        for tick in moment.tick + 1..=moment.tick + WINDOW {
            times_ns.push(scene.step(tick, &mut pool));
        }
        trace.add(moment.tick + WINDOW, &mut scene);
        rolled_back += scene.cloth.events.rolled_back;
        last = Some(scene.cloth);
    }
    if let Some(cloth) = last {
        trace.close(&cloth, times_ns);
    }
    trace.rolled_back = rolled_back;
    Ok(trace)
}

impl Trace {
    /// Adds the state of the cloth after step `tick`.
    fn add(&mut self, tick: u64, scene: &mut SteppedCloth<'_>) {
        let SteppedCloth { garment, cloth, problem, .. } = scene;
        let place = |p: Vec3A| p.as_dvec3();
        let state = State {
            x: cloth.positions.iter().map(|p| place(*p)).collect(),
            v: (0..garment.particles()).map(|i| place(cloth.velocity(i))).collect(),
        };
        let strain = measure::strain(cloth, garment);
        self.strain[0] += f64::from(strain.mean);
        self.strain[1] += f64::from(strain.p99);
        self.energy.push([seconds(tick), energies(problem, &state).total_j()]);
        self.frames.push(MeshedScene::by_vertex(garment, |p| state.x[p]));
    }

    /// What is known at the end.
    fn close(&mut self, cloth: &Cloth, mut times_ns: Vec<u64>) {
        self.step_us = median(&mut times_ns).map_or(0.0, |ns| ns as f64 * 1e-3);
        self.strain = self.strain.map(|sum| sum / self.frames.len().max(1) as f64);
        self.rolled_back = cloth.events.rolled_back;
        self.substeps = cloth.substeps();
    }
}

/// Passes a substep over the weft; over crossing fibers where the weft is all solved with
/// them.
pub fn iterations(garment: &Garment, quality: Quality) -> usize {
    let ops = program::constraints(garment.layout(), quality);
    let count = |of: &[Stage]| ops.iter().filter(|op| of.contains(op)).count();
    match count(&[Stage::Weft(0)]) {
        0 => count(&[Stage::Crossing(0)]).max(count(&[Stage::Fibers])),
        passes => passes,
    }
}
