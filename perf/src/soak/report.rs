//! What was found, as the JSON has it.

use std::collections::BTreeMap;
use std::collections::BTreeSet;

use serde::Serialize;
use toile_engine::meter::PERIOD_NS;
use toile_fitting::live::report::QueueUse;
use toile_sensors::source::live::fault_injection::CameraFault;

use super::fault_kind::FaultKind;
use super::fault_monitor::FaultOutcome;
use super::memory::{MemorySample, growth};
use super::options::{SceneWeight, SoakCamera, SoakOptions, SoakOutfit};
use super::run::SoakRun;

/// Longest that the pipeline may take to recover (ticks): 1 s.
const PIPELINE_TICKS: f64 = 120.0;

/// Longest until a camera that sees nothing is known to (ms).
const NOTICED_MS: f64 = 200.0;

/// Longest that the solver may take to recover (ticks).
const SOLVER_TICKS: f64 = 2.0;

/// What resident memory may grow by (KiB/h); of a run that is shorter than an hour behind its warm-up, all in all.
const GROWTH_KIB: f64 = 64.0;

/// Shortest time behind the warm-up over which memory is judged (h): garments differ in size by more than what an hour may bring,
/// and the system gives pages in larger pieces still. Of a shorter run the figures are only reported.
const LEAST_JUDGED_H: f64 = 0.5;

/// Share of the run after which memory is to be flat.
const WARM_UP: f64 = 0.25;

/// What was checked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SoakCheck {
    /// What is checked.
    pub name: &'static str,
    /// The most that passes.
    pub limit: f64,
    /// What was found; none where this machine or this run does not say.
    pub found: Option<f64>,
    /// Whether it passed; what was not found did not fail either, and is named as not checked.
    pub pass: bool,
}

impl SoakCheck {
    fn new(name: &'static str, limit: f64, found: Option<f64>) -> Self {
        Self { name, limit, found, pass: found.is_none_or(|found| found <= limit) }
    }
}

/// The faults of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaultKindFigures {
    /// Name of the kind.
    pub name: &'static str,
    /// What shows that one is over.
    pub recovered_when: &'static str,
    /// How many there were.
    pub injected: u64,
    /// How many of them were recovered.
    pub recovered: u64,
    /// Mean time from the end of a fault until it was recovered (ms).
    pub mean_ms: f64,
    /// The longest such time (ms).
    pub max_ms: f64,
    /// The longest from the begin of one until the camera was known to see nothing (ms); none of what blinds no camera.
    pub noticed_max_ms: Option<f64>,
    /// How many of those that blind the camera were never noticed.
    pub unnoticed: u64,
}

/// The faults of the run, in all and by kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaultFigures {
    /// How many there were.
    pub injected: u64,
    /// How many of them were recovered.
    pub recovered: u64,
    /// Figures of each kind of fault.
    pub kinds: Vec<FaultKindFigures>,
}

/// Ticks of 1/120 s until all was well.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RecoveryTicks {
    /// From the end of a fault until the pipeline had recovered, at most.
    pub max: u64,
    /// Steps in a row that the solver gave nothing sound, at most.
    pub solver: u64,
}

/// Memory over the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MemoryFigures {
    /// `simulated` or `wall`: which hours these are.
    pub hours_are: &'static str,
    /// From when on it is to be flat (h).
    pub from_h: f64,
    /// Until when (h).
    pub until_h: f64,
    /// Growth of what the allocator hands out (KiB/h).
    pub heap_growth_kib_h: Option<f64>,
    /// Growth of resident memory (KiB/h).
    pub rss_growth_kib_h: Option<f64>,
    /// Most that was resident (KiB).
    pub rss_max_kib: Option<u64>,
    /// All samples, in time.
    pub samples: Vec<MemorySample>,
}

/// Everything that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Soak {
    /// Seed of the scenario.
    pub seed: u64,
    /// `light` or `full`.
    pub scene: SceneWeight,
    /// What the shoppers put on.
    pub outfit: SoakOutfit,
    /// `joints` or `depth`: what saw the shoppers.
    pub camera: SoakCamera,
    /// On threads and the system's clock.
    pub real_time: bool,
    /// Workers of a step.
    pub workers: usize,
    /// What the clock showed at the begin (h).
    pub uptime_hours: u64,
    /// Length on the loop's clock (h).
    pub hours: f64,
    /// Time that it took (s).
    pub wall_s: f64,
    /// Time of each step, everything included (us).
    pub us_per_step: f64,
    /// Steps that were taken.
    pub ticks: u64,
    /// Shoppers who came.
    pub visits: usize,
    /// Scenes that were handed over while the loop ran.
    pub changes: u64,
    /// Garments in a size that were worn, of so many.
    pub sizes: [usize; 2],
    /// Positions, bones and normals that were published and are not finite.
    pub nonfinite: u64,
    /// Allocations in the turns of sensor, physics and renderer; none where they are not counted.
    pub allocations: Option<u64>,
    /// Growth of resident memory behind the warm-up (KiB).
    pub rss_growth_kib: Option<f64>,
    /// Faults that were injected and how they ended.
    pub faults: FaultFigures,
    /// How long they took.
    pub recovery_ticks: RecoveryTicks,
    /// Steps that were published after their period, and those that were dropped; nearly all by stalls and jumps.
    pub deadline_misses: u64,
    /// Hash over the states of all steps.
    pub state_hash: String,
    /// The same of a second run, or of a replay of this one; none where there was none.
    pub second_state_hash: Option<String>,
    /// Furthest that joints were from the shopper's while nothing was wrong, on average over the joints (mm).
    pub off_mm: f64,
    /// Sensor frames: published, with a stamp that was not believed, no newer than the one before.
    pub frames: [u64; 3],
    /// Pictures, and times that the renderer was restarted.
    pub pictures: [u64; 2],
    /// Memory of the process.
    pub memory: MemoryFigures,
    /// What was checked, and whether it held.
    pub checks: Vec<SoakCheck>,
    /// How full every queue was.
    pub capacities: Vec<QueueUse>,
    /// What deserves attention, one sentence each.
    pub warnings: Vec<String>,
}

impl Soak {
    /// Of a run; `second` is the hash of another run of the same.
    pub fn new(ran: SoakRun, options: &SoakOptions, second: Option<u64>) -> Self {
        let hours = options.plan.seconds as f64 / 3_600.0;
        let faults = faults(&ran.monitor.outcomes);
        let memory = memory(&ran.monitor.samples, hours, options.real_time);
        let text = |hash: u64| format!("{hash:016x}");
        let longest = ran.monitor.outcomes.iter().filter_map(|o| o.recovered_ns).max().unwrap_or(0);
        let recovery_ticks = RecoveryTicks { max: longest.div_ceil(PERIOD_NS), solver: ran.monitor.steps.unsound };
        let mut soak = Self {
            seed: options.plan.seed,
            scene: options.plan.scene,
            outfit: options.plan.outfit,
            camera: options.plan.camera,
            real_time: options.real_time,
            workers: options.workers,
            uptime_hours: options.uptime_hours,
            hours,
            wall_s: ran.wall_s,
            us_per_step: ran.wall_s * 1e6 / ran.steps.max(1) as f64,
            ticks: ran.steps,
            visits: ran.scenario.visits.len(),
            changes: ran.changes,
            sizes: sizes(&ran),
            nonfinite: ran.nonfinite,
            allocations: ran.allocations.map(|a| a.iter().sum()),
            rss_growth_kib: memory.rss_growth_kib_h.map(|g| g * (memory.until_h - memory.from_h)),
            faults,
            recovery_ticks,
            deadline_misses: ran.missed,
            state_hash: text(ran.hash),
            second_state_hash: second.map(text),
            off_mm: f64::from(ran.monitor.steps.off_m) * 1e3,
            frames: ran.frames,
            pictures: ran.pictures,
            memory,
            checks: Vec::new(),
            capacities: ran.capacities.iter().map(|c| QueueUse::from(*c)).collect(),
            warnings: ran.warnings,
        };
        soak.checks = checks(&soak, ran.broken[1]);
        soak
    }

    /// What did not pass.
    pub fn failed(&self) -> impl Iterator<Item = &SoakCheck> {
        self.checks.iter().filter(|c| !c.pass)
    }
}

/// Outfits in a size that were worn, and how many there are.
fn sizes(ran: &SoakRun) -> [usize; 2] {
    let worn: BTreeSet<_> = ran.scenario.requests.iter().take(ran.changes as usize + 1).map(|d| &d.outfit).collect();
    [worn.len(), ran.scenario.outfits]
}

fn faults(outcomes: &[FaultOutcome]) -> FaultFigures {
    let mut by_kind: BTreeMap<FaultKind, Vec<&FaultOutcome>> = BTreeMap::new();
    outcomes.iter().for_each(|o| by_kind.entry(o.kind).or_default().push(o));
    let kinds: Vec<FaultKindFigures> = by_kind.into_iter().map(|(kind, all)| kind_figures(kind, &all)).collect();
    let sum = |of: fn(&FaultKindFigures) -> u64| kinds.iter().map(of).sum();
    FaultFigures { injected: sum(|k| k.injected), recovered: sum(|k| k.recovered), kinds }
}

fn kind_figures(kind: FaultKind, all: &[&FaultOutcome]) -> FaultKindFigures {
    let ms = |of: fn(&FaultOutcome) -> Option<u64>| -> Vec<f64> {
        all.iter().filter_map(|o| of(o)).map(|ns| ns as f64 * 1e-6).collect()
    };
    let longest = |times: &[f64]| times.iter().copied().fold(0.0, f64::max);
    let (recovered, noticed) = (ms(|o| o.recovered_ns), ms(|o| o.noticed_ns));
    let is_blind = kind.camera_fault().is_some_and(CameraFault::is_blind);
    FaultKindFigures {
        name: kind.name(),
        recovered_when: kind.recovered_by().words(),
        injected: all.len() as u64,
        recovered: recovered.len() as u64,
        mean_ms: recovered.iter().sum::<f64>() / recovered.len().max(1) as f64,
        max_ms: longest(&recovered),
        noticed_max_ms: is_blind.then(|| longest(&noticed)),
        unnoticed: if is_blind { (all.len() - noticed.len()) as u64 } else { 0 },
    }
}

fn memory(samples: &[MemorySample], hours: f64, real_time: bool) -> MemoryFigures {
    let from_h = hours * WARM_UP;
    let settled: Vec<&MemorySample> = samples.iter().filter(|s| s.hours >= from_h).collect();
    let slope = |of: fn(&MemorySample) -> Option<u64>| {
        let points: Vec<(f64, u64)> = settled.iter().filter_map(|s| Some((s.hours, of(s)?))).collect();
        growth(&points)
    };
    MemoryFigures {
        hours_are: if real_time { "wall" } else { "simulated" },
        from_h: settled.first().map_or(0.0, |s| s.hours),
        until_h: settled.last().map_or(0.0, |s| s.hours),
        heap_growth_kib_h: slope(|s| s.heap_kib),
        rss_growth_kib_h: slope(|s| s.rss_kib),
        rss_max_kib: samples.iter().filter_map(|s| s.rss_kib).max(),
        samples: samples.to_vec(),
    }
}

/// How far a figure of the settled samples moves.
fn range(memory: &MemoryFigures, of: fn(&MemorySample) -> Option<u64>) -> Option<f64> {
    let settled = memory.samples.iter().filter(|s| s.hours >= memory.from_h).filter_map(of);
    let (least, most) = settled.fold((u64::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
    (most >= least).then(|| (most - least) as f64)
}

fn checks(soak: &Soak, accepted: u64) -> Vec<SoakCheck> {
    let (memory, faults) = (&soak.memory, &soak.faults);
    let behind = memory.until_h - memory.from_h;
    let most = GROWTH_KIB * behind.max(1.0);
    let judged = |growth: Option<f64>| growth.map(|g| g * behind).filter(|_| behind >= LEAST_JUDGED_H);
    let [heap, resident] = [memory.heap_growth_kib_h, memory.rss_growth_kib_h].map(judged);
    let differs = soak.second_state_hash.as_ref().map(|second| f64::from(u8::from(*second != soak.state_hash)));
    let unnoticed: u64 = faults.kinds.iter().map(|k| k.unnoticed).sum();
    let noticed = faults.kinds.iter().filter_map(|k| k.noticed_max_ms).reduce(f64::max);
    let has_camera = soak.camera == SoakCamera::Depth;
    let pipeline = (faults.injected > 0).then_some(soak.recovery_ticks.max as f64);
    let mut checks = vec![
        SoakCheck::new("values published that are not finite", 0.0, Some(soak.nonfinite as f64)),
        SoakCheck::new("allocations in the loop", 0.0, soak.allocations.map(|n| n as f64)),
        SoakCheck::new("memory handed out, growth behind the warm-up (KiB)", most, heap),
        SoakCheck::new("resident memory, growth behind the warm-up (KiB)", most, resident),
        SoakCheck::new("open files, change behind the warm-up", 0.0, range(memory, |s| s.files)),
        SoakCheck::new("threads, change behind the warm-up", 0.0, range(memory, |s| s.threads)),
        SoakCheck::new("faults that were not recovered", 0.0, Some((faults.injected - faults.recovered) as f64)),
        SoakCheck::new("longest recovery of the pipeline (ticks)", PIPELINE_TICKS, pipeline),
        SoakCheck::new("longest recovery of the solver (ticks)", SOLVER_TICKS, Some(soak.recovery_ticks.solver as f64)),
        SoakCheck::new("broken garments that were accepted", 0.0, Some(accepted as f64)),
        SoakCheck::new("entries lost by full queues", 0.0, Some(soak.capacities.iter().map(|c| c.lost as f64).sum())),
        SoakCheck::new("states of a second run that differ", 0.0, differs),
    ];
    if has_camera {
        let missed = noticed.map(|_| unnoticed as f64);
        checks.push(SoakCheck::new("times that a blind camera was not noticed", 0.0, missed));
        checks.push(SoakCheck::new("longest until a blind camera was noticed (ms)", NOTICED_MS, noticed));
    }
    checks
}
