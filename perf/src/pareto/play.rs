//! One run of a scene under one setting.

use std::time::{Duration, Instant};

use glam::{Affine3A, DVec3, Vec3A};
use toile_assets::garment::Garment;
use toile_assets::garment::layout::OWNERS;
use toile_assets::limits::STEP_SECONDS;
use toile_assets::skeleton::BONES;
use toile_engine::cloth::program::{self, Op};
use toile_engine::cloth::{Cloth, Quality, Settings, Step, measure};
use toile_engine::crew::Crew;

use super::ParetoError;
use super::subject::Subject;
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

/// Steps from one compared frame to the next: a twentieth of a second.
const EVERY: u64 = 6;

/// What the helper gets to wake in, as in a frame that poses and skins before the cloth.
const BEFORE_CLOTH: Duration = Duration::from_micros(80);

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
    /// Speed of the fastest particle at the end (m/s).
    pub fastest_m_s: f64,
}

/// Runs a scene from its start to its end; `told` hears of each frame.
pub fn play(subject: &Subject, garment: &Garment, setting: Setting) -> Result<Trace, ParetoError> {
    let settings = Settings {
        quality: setting.quality,
        substeps: setting.substeps,
        workers: setting.threads,
        ..Settings::default()
    };
    let mut crew = Crew::new(setting.threads.clamp(1, OWNERS))?;
    let (mut bones, mut colliders) = ([Affine3A::IDENTITY; BONES], subject.colliders.clone());
    subject.place(0.0, &mut bones, &mut colliders);
    let mut cloth = Cloth::new(garment, &colliders);
    let problem = Problem::of(garment);
    let mut trace = Trace::default();
    let mut times_ns = Vec::new();
    for tick in 1..=subject.steps() {
        subject.place(tick as f64 * f64::from(STEP_SECONDS), &mut bones, &mut colliders);
        wake(&mut crew);
        let begun = Instant::now();
        cloth.step_with(&mut crew, garment, &Step { palette: &bones, colliders: &colliders, settings: &settings });
        times_ns.push(begun.elapsed().as_nanos() as u64);
        if tick % EVERY == 0 || tick == subject.steps() {
            trace.add(tick, &mut cloth, garment, &problem);
        }
    }
    times_ns.sort_unstable();
    trace.step_us = times_ns.get(times_ns.len() / 2).map_or(0.0, |ns| *ns as f64 * 1e-3);
    trace.strain = trace.strain.map(|sum| sum / trace.frames.len().max(1) as f64);
    trace.rolled_back = cloth.events.rolled_back;
    trace.substeps = cloth.substeps();
    let speed = |i: usize| cloth.velocity(i).length();
    trace.fastest_m_s = f64::from((0..garment.particles()).map(speed).fold(0.0, f32::max));
    Ok(trace)
}

impl Trace {
    fn add(&mut self, tick: u64, cloth: &mut Cloth, garment: &Garment, problem: &Problem) {
        let place = |p: Vec3A| p.as_dvec3();
        let state = State {
            x: cloth.positions.iter().map(|p| place(*p)).collect(),
            v: (0..garment.particles()).map(|i| place(cloth.velocity(i))).collect(),
        };
        let strain = measure::strain(cloth, garment);
        self.strain[0] += f64::from(strain.mean);
        self.strain[1] += f64::from(strain.p99);
        self.energy.push([tick as f64 * f64::from(STEP_SECONDS), energies(problem, &state).total_j()]);
        self.frames.push(Subject::by_vertex(garment, |p| state.x[p]));
    }
}

/// Wakes the helper of two workers, and waits as long as the frame's other work would.
fn wake(crew: &mut Crew) {
    if crew.wake() {
        let woken = Instant::now();
        while woken.elapsed() < BEFORE_CLOTH {
            std::hint::spin_loop();
        }
    }
}

/// Passes a substep over the weft, hoops solved whole counted; over crossing fibers where the weft is all solved with
/// them.
pub fn iterations(garment: &Garment, quality: Quality) -> usize {
    let ops = program::substep(&garment.layout, quality);
    let count = |of: &[Op]| ops.iter().filter(|op| of.contains(op)).count();
    match count(&[Op::Weft(0), Op::Hoops(0)]) {
        0 => count(&[Op::Crossing(0)]).max(count(&[Op::Fibers])),
        passes => passes,
    }
}
