//! One run of the benchmark: time and error of the same steps.

use std::time::Instant;

use toile_base::numeric::statistics::{median, quantile};
use toile_fitting::heap::HeapProbe;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::reference_time::ReferenceTimer;
use toile_gpu::backend::Backends;

use super::error::SkirtError;
use super::gauge::{FrameErrors, Gauge};
use super::options::{SkirtOptions, WARM_UP};
use super::report::{self, SkirtReport};
use super::scene::{MeteredStages, SkirtScene};
use crate::backend::SteppedBy;
use toile_fitting::crossings::CrossingWatch;

/// Steps at the end over which the greatest energy of motion is looked for: a second.
const RESTING_STEPS: usize = 120;

/// Steps after the last that counts in which the engine times its stages, which costs some time of its own.
const METERED_STEPS: usize = 240;

/// Runs the scene as asked, and reports time and error of the same steps.
///
/// # Errors
/// Where the options cannot be met.
pub fn measure(options: &SkirtOptions, heap: &HeapProbe) -> Result<SkirtReport, SkirtError> {
    let backends = Backends::open(options.backend);
    let reference = ReferenceTimer::new()?;
    let mut scene = SkirtScene::by(&backends, options, heap, |_| {})?;
    let mut run = SkirtRun::new(options, &scene, *heap);
    for _ in 0..WARM_UP {
        scene.prepare();
        scene.step();
    }
    let before = scene.events();
    let mut readings = Vec::new();
    for _ in 0..options.runs.max(1) {
        readings.push(reference.read_us());
        (0..options.steps.max(1)).for_each(|_| run.step(&mut scene));
        run.end_run();
    }
    readings.push(reference.read_us());
    let mut report = run.report(&scene, median(&mut readings).unwrap_or(0.0));
    report.events = scene.events().since(before);
    let metered = METERED_STEPS.min(options.steps.max(1));
    let MeteredStages { stages_us, greater_share_us, device_us } = scene.metered_stages(metered);
    (report.stages_us, report.greater_share_us, report.device_us) = (stages_us, greater_share_us, device_us);
    report.stepped_by = SteppedBy::of(&backends);
    report.decided_by = scene.stepper().measured().map(Into::into);
    Ok(report)
}

/// What is gathered while the steps go by.
struct SkirtRun {
    options: SkirtOptions,
    heap: HeapProbe,
    gauge: Gauge,
    /// Time of each step, run after run (us).
    times: Vec<f64>,
    /// Where the present run starts in `times`.
    first: usize,
    medians: Vec<f64>,
    /// Sum of the frames' mean strains and their count at the end of each run.
    marks: Vec<[f64; 2]>,
    allocations: u64,
    frames: u64,
    sums: [f64; 4],
    last_inside: u64,
    left_inside: u64,
    worst: FrameErrors,
    wrong_frames: u64,
    nonfinite: u64,
    energies: Vec<f64>,
    /// Of each skirt, where they keep from passing through themselves.
    crossings: Vec<CrossingWatch>,
}

/// Looks at one of the skirts.
fn watch(scene: &SkirtScene) -> CrossingWatch {
    CrossingWatch::new(&[&scene.garment.triangles], f64::from(scene.options.step_s))
}

impl SkirtRun {
    fn new(options: &SkirtOptions, scene: &SkirtScene, heap: HeapProbe) -> Self {
        let steps = options.runs.max(1) * options.steps.max(1);
        Self {
            options: *options,
            heap,
            gauge: Gauge::new(scene),
            times: Vec::with_capacity(steps),
            first: 0,
            medians: Vec::new(),
            marks: vec![[0.0; 2]],
            allocations: 0,
            frames: 0,
            sums: [0.0; 4],
            last_inside: 0,
            left_inside: 0,
            worst: FrameErrors::default(),
            wrong_frames: 0,
            nonfinite: 0,
            energies: Vec::with_capacity(RESTING_STEPS),
            crossings: if options.folds { scene.cloths.iter().map(|_| watch(scene)).collect() } else { Vec::new() },
        }
    }

    fn step(&mut self, scene: &mut SkirtScene) {
        scene.prepare();
        let before = self.heap.read();
        let start = Instant::now();
        scene.step();
        let elapsed = start.elapsed();
        if let Some((before, after)) = before.zip(self.heap.read()) {
            self.allocations += after.allocations - before.allocations;
        }
        self.times.push(elapsed.as_secs_f64() * 1e6);
        self.last_inside = 0;
        for cloth in &scene.cloths {
            let frame = self.gauge.read(&cloth.positions, &scene.spheres);
            self.add(&frame);
        }
        if CrossingWatch::wants(self.times.len() as u64) {
            for (watch, cloth) in self.crossings.iter_mut().zip(&scene.cloths) {
                watch.look(&[cloth.positions.iter().map(|p| (*p).into()).collect()]);
            }
        }
        if self.times.len() + RESTING_STEPS > self.options.runs.max(1) * self.options.steps.max(1) {
            self.energies.push(scene.kinetic_energy() * 1e3);
        }
    }

    fn add(&mut self, frame: &FrameErrors) {
        let worst = &mut self.worst;
        worst.stretch_max = worst.stretch_max.max(frame.stretch_max);
        worst.compression_max = worst.compression_max.max(frame.compression_max);
        worst.beyond_max = worst.beyond_max.max(frame.beyond_max);
        worst.deepest = worst.deepest.max(frame.deepest);
        let values = [frame.strain_mean, frame.strain_p99, frame.inside as f64, frame.beyond_mean];
        self.sums.iter_mut().zip(values).for_each(|(sum, x)| *sum += x);
        self.wrong_frames += u64::from(frame.wrong_legs > 0);
        self.nonfinite += frame.nonfinite as u64;
        self.last_inside += frame.inside as u64;
        self.frames += 1;
    }

    fn end_run(&mut self) {
        let mut run = self.times[self.first..].to_vec();
        self.medians.push(median(&mut run).unwrap_or(0.0));
        self.first = self.times.len();
        self.left_inside += self.last_inside;
        self.marks.push([self.sums[0], self.frames as f64]);
    }

    fn report(mut self, scene: &SkirtScene, yardstick_us: f64) -> SkirtReport {
        let [mean, p99, inside, beyond] = self.sums.map(|sum| sum / self.frames as f64);
        let p50 = median(&mut self.medians.clone()).unwrap_or(0.0);
        let mut time = |part| quantile(&mut self.times, part).unwrap_or(0.0);
        SkirtReport {
            quality: scene.settings().quality.name(),
            lanes: scene.settings().width.lanes(),
            substeps: scene.substeps(),
            warm_up: WARM_UP,
            step_us: StepTimes { p50, p99: time(0.99), p999: time(0.999), max: time(1.0) },
            run_p50_us: self.medians,
            yardstick_us,
            y_ratio: p50 / yardstick_us,
            ns_per_vertex: p50 * 1e3 / (self.options.verts * scene.cloths.len()) as f64,
            strain: report::SkirtStrain {
                mean,
                p99,
                run_mean: self.marks.windows(2).map(|m| (m[1][0] - m[0][0]) / (m[1][1] - m[0][1])).collect(),
                max: self.worst.stretch_max,
                compression_max: self.worst.compression_max,
                beyond_elastic_max: self.worst.beyond_max,
                beyond_elastic_mean: beyond,
                edges: self.gauge.edges(),
            },
            penetration_mm: report::Penetration {
                max: f64::from(self.worst.deepest) * 1e3,
                fraction: inside / self.options.verts as f64,
                left_inside: self.left_inside,
            },
            hem_winding_wrong: self.wrong_frames,
            nonfinite: self.nonfinite,
            crossings: self.crossings.iter().map(CrossingWatch::figures).max_by_key(|c| c.frames_with),
            allocations_per_step: self.heap.read().map(|_| self.allocations as f64 / self.times.len() as f64),
            memory_bytes: scene.memory_bytes.map(|[garment, states]| garment + states),
            memory_garment_bytes: scene.memory_bytes.map(|[garment, _]| garment),
            kinetic_energy_mj: scene.kinetic_energy() * 1e3,
            kinetic_energy_max_mj: self.energies.iter().copied().fold(0.0, f64::max),
            state_hash: format!("{:016x}", scene.state_hash()),
            ..SkirtReport::of(&self.options)
        }
    }
}
