//! `toile soak`: the loop for hours, with faults, and whether it recovered.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::value_parser;
use serde::{Deserialize, Serialize};
use toile_cli::arguments::{Printing, WorkersArg, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::heap;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::terminal::{self, Paint, Tone, Words};
use toile_engine::clock::SimClock;
use toile_engine::frame_loop::physics_thread::{SceneStepper, WorldScene};
use toile_engine::frame_loop::recording::{self, Entry, LoopRecording};
use toile_engine::frame_loop::replay::{Replayed, replay_changing};
use toile_engine::workers::WorkerPool;
use toile_engine::world::World;
use toile_fitting::heap::HeapProbe;
use toile_fitting::live::crash;
use toile_perf::soak::scenario::Scenario;
use toile_perf::soak::{
    self, LEAST_APART_S, SceneMaker, SceneWeight, Soak, SoakCamera, SoakCheck, SoakError, SoakOptions, SoakOutfit,
    SoakPlan, SoakTools,
};

use crate::commands::arguments::CrashArg;

/// Longest run (h): five weeks.
const MOST_HOURS: f64 = 840.0;

/// Longest uptime (h): a hundred years.
const MOST_UPTIME: u64 = 876_000;

/// Time between two faults where their number is not given (s).
const USUALLY_APART_S: u64 = 30;

/// Run the whole loop for hours, with shoppers, garments and faults, and check it while it runs.
///
/// Runs the whole loop without a screen: shoppers of many sizes come and go, garments are changed, and with --faults
/// everything goes wrong that can: the camera, the threads, the clocks, the disk, memory. Checks while it runs that nothing
/// published is NaN or infinite, that the loop allocates nothing, that memory, files and threads stay as they are, that every
/// fault is recovered and how fast, and that a second run ends in the same bits. Writes a record as JSON.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: eight hours and a thousand faults in some minutes, then an hour in real time\n  toile soak \
                        --hours 8 --faults 1000 && toile soak --hours 1 --real-time --faults"
)]
pub struct SoakArgs {
    /// Length of the run on the loop's clock (default: 10)
    #[arg(long, value_name = "M")]
    pub minutes: Option<f64>,
    /// The same in hours
    #[arg(long, value_name = "H", conflicts_with = "minutes")]
    pub hours: Option<f64>,
    /// On threads and the system's clock (default: as fast as possible on a simulated one)
    #[arg(long)]
    pub real_time: bool,
    /// Everything that happens follows from it
    #[arg(long, value_name = "N", default_value = "1")]
    pub seed: u64,
    /// Inject so many faults, or one every half minute if N is left out
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "0")]
    pub faults: Option<u64>,
    /// What the clock shows at the start
    #[arg(long, value_name = "H", value_parser = value_parser!(u64).range(0..=MOST_UPTIME), default_value = "0")]
    pub uptime_hours: u64,
    /// light: coarse garments, hours in minutes; full: the wardrobe as it is worn (default: full in real time, else light)
    #[arg(long, value_name = "S", value_parser = one_of(SceneWeight::ALL, SceneWeight::name))]
    pub scene: Option<SceneWeight>,
    /// wardrobe: one garment after the other; dress: the default dress; layers: trousers, a shirt and a blazer over one another
    #[arg(long, value_name = "O", value_parser = one_of(SoakOutfit::ALL, SoakOutfit::name), default_value = "dress")]
    pub outfit: SoakOutfit,
    /// joints: a sensor that hands on joints; depth: a depth camera, with the faults that such cameras have
    #[arg(long, value_name = "C", value_parser = one_of(SoakCamera::ALL, SoakCamera::name), default_value = "joints")]
    pub camera: SoakCamera,
    #[command(flatten)]
    workers: WorkersArg,
    /// Make no second run to compare the bits with
    #[arg(long)]
    pub once: bool,
    /// Record the run, without images, for `toile replay`
    #[arg(long, value_name = "F")]
    pub record: Option<PathBuf>,
    #[command(flatten)]
    crash: CrashArg,
    /// Folder for the record; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out/soak")]
    pub out: PathBuf,
    #[command(flatten)]
    printing: Printing,
}

impl SoakArgs {
    /// What is soaked, and how.
    ///
    /// # Errors
    /// [`AppError::Usage`] for a run that is too long, and for more faults than fit into it.
    fn options(&self) -> Result<SoakOptions, AppError> {
        let hours = self.minutes.map(|minutes| minutes / 60.0).or(self.hours).unwrap_or(1.0 / 6.0);
        if !(hours > 0.0 && hours <= MOST_HOURS) {
            return Err(AppError::Usage(format!("a run lasts up to {MOST_HOURS} hours, not {hours}; choose less")));
        }
        let seconds = (hours * 3_600.0).ceil() as u64;
        let faults = match self.faults {
            None => 0,
            Some(0) => seconds / USUALLY_APART_S,
            Some(faults) => faults,
        };
        let most = seconds / LEAST_APART_S;
        if faults > most {
            return Err(AppError::Usage(format!(
                "{faults} faults do not fit into {seconds} s; ask for {most} at most"
            )));
        }
        let scene = self.scene.unwrap_or(if self.real_time { SceneWeight::Full } else { SceneWeight::Light });
        Ok(SoakOptions {
            plan: SoakPlan {
                seed: self.seed,
                seconds,
                faults: faults as usize,
                scene,
                outfit: self.outfit,
                camera: self.camera,
            },
            uptime_hours: self.uptime_hours,
            real_time: self.real_time,
            workers: if self.real_time { self.workers.count() } else { 1 },
        })
    }
}

/// Largest recording of a run in real time that is replayed behind it (bytes): two hours and a half.
const MOST_REPLAYED: u64 = 128 << 20;

/// How the scenes of a soak's recording are made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoakRecipe {
    /// Version of the program that wrote it.
    pub version: String,
    /// Options of the run.
    pub soak: SoakPlan,
}

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct SoakDocument {
    /// The figures that were measured.
    #[serde(flatten)]
    found: Soak,
    /// The files written.
    files: Vec<PathBuf>,
}

/// Runs `toile soak`.
///
/// # Errors
/// Files that cannot be written, a scene that cannot be made, and [`AppError::Threshold`] where a check failed.
pub fn run(args: &SoakArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let options = args.options()?;
    let crash_file = args.out.join("crash.tape");
    args.record.iter().chain([&crash_file]).try_for_each(|file| Inputs::default().check(file))?;
    let mut out = OutputFolder::prepare(&args.out)?;
    let recipe = SoakRecipe { version: env!("CARGO_PKG_VERSION").to_owned(), soak: options.plan };
    let header = recording::header(&serde_json::to_string(&recipe).map_err(AppError::internal)?);
    // A run in real time is compared with its own replay, so it is recorded in any case.
    let kept = match &args.record {
        Some(path) => Some(path.clone()),
        None if options.real_time && !args.once => Some(out.stage("soak.tape")?),
        None => None,
    };
    let file = kept.as_deref().map(create).transpose()?;
    let tools = SoakTools {
        heap: HeapProbe::new(heap::counted),
        count: heap::probe(),
        file,
        header,
        keep: &|flight_recorder| crash::keep(flight_recorder, crash_file.clone()),
        progress: &|seconds| words.print_line(&format!("{} of {} minutes", seconds / 60, options.plan.seconds / 60)),
        crash_ns: args.crash.after_s.map(|s| s * 1_000_000_000),
    };
    let ran = soak::run(&options, &tools).map_err(refused)?;
    crash::forget();
    let second = if args.once { None } else { second(&options, ran.hash, kept.as_deref(), &words)? };
    let found = Soak::new(ran, &options, second);
    let record = serde_json::to_vec_pretty(&Document::new("soak", &found)).map_err(AppError::internal)?;
    out.write("soak.json", &record)?;
    let mut files = out.commit()?;
    files.extend(args.record.clone());
    report(&SoakDocument { found, files }, args.printing.json)
}

/// Prints what was found; an error where a check failed.
fn report(report: &SoakDocument, json: bool) -> Result<(), AppError> {
    if json {
        terminal::print_json(&Document::new("soak", report))?;
    } else {
        terminal::print(&table(report, Paint::for_stdout()))?;
    }
    let failed: Vec<&str> = report.found.failed().map(|c| c.name).collect();
    if failed.is_empty() {
        return Ok(());
    }
    let (failed, seed) = (failed.join("; "), report.found.seed);
    Err(AppError::Threshold(format!("not borne: {failed}; run it again with --seed {seed} --record F and replay F")))
}

fn refused(error: SoakError) -> AppError {
    match error {
        SoakError::Crowded { .. } => AppError::Usage(error.to_string()),
        SoakError::Start(_) => AppError::Device(error.to_string()),
        error => AppError::internal(error),
    }
}

fn create(path: &Path) -> Result<File, AppError> {
    let refused = |e| format!("recording {} cannot be written ({e}); name another file", path.display());
    File::create(path).map_err(|e| AppError::Input(refused(e)))
}

/// The hash of another run: of the same script, or, where the machine's own time decided, of the replay of the recording. None
/// where the recording is too long.
fn second(options: &SoakOptions, hash: u64, kept: Option<&Path>, words: &Words) -> Result<Option<u64>, AppError> {
    if !options.real_time {
        words.print_line("once more, to compare");
        let tools = SoakTools {
            heap: HeapProbe::none(),
            count: None,
            file: None,
            header: Vec::new(),
            keep: &|_| {},
            progress: &|_| {},
            crash_ns: None,
        };
        return soak::run(options, &tools).map(|ran| Some(ran.hash)).map_err(refused);
    }
    let Some(path) = kept else { return Ok(None) };
    let unread = |e: std::io::Error| AppError::Input(format!("{} cannot be read again ({e})", path.display()));
    if fs::metadata(path).map_err(unread)?.len() > MOST_REPLAYED {
        words.print_line("the recording is too long to be replayed at once; take it again with `toile replay`");
        return Ok(None);
    }
    words.print_line("the recording is taken again, with one worker");
    let LoopRecording { entries, .. } =
        recording::read(&fs::read(path).map_err(unread)?).map_err(AppError::internal)?;
    let (_, out) = again(options.plan, &entries, 1)?;
    let same = out.diverged_at.is_none() && out.gap_at.is_none();
    Ok(Some(if same { hash } else { !hash }))
}

/// Takes a soak's recording again: the last scene, and what came out.
///
/// # Errors
/// A recording that does not begin where a shopper was dressed, and a scene that cannot be made.
pub fn again(plan: SoakPlan, entries: &[Entry], workers: usize) -> Result<(World, Replayed), AppError> {
    let Some((Entry::Changed { number, .. }, entries)) = entries.split_first() else {
        return Err(AppError::Input(
            "the recording does not begin where a shopper was dressed; record it again".into(),
        ));
    };
    let mut scene_maker = SceneMaker::new(Arc::new(Scenario::write(plan).map_err(refused)?));
    let (world, _reader) = scene_maker.make(*number).map_err(refused)?;
    let crew = WorkerPool::new(workers).map_err(AppError::input)?;
    let mut stepper = SceneStepper::new(WorldScene::new(world.with_workers(crew)));
    let out = replay_changing(&mut stepper, entries, &SimClock::default(), |number| {
        scene_maker.make(number).ok().map(|(world, _reader)| WorldScene::new(world))
    });
    Ok((stepper.scene.world, out))
}

/// The figures as people read them.
fn table(report: &SoakDocument, paint: Paint) -> String {
    let found = &report.found;
    let title = format!(
        "Soak: {:.2} h, {} steps in {:.0} s ({:.0} us a step), {} scene, {} seen, seed {}",
        found.hours,
        found.ticks,
        found.wall_s,
        found.us_per_step,
        found.scene.name(),
        found.camera.name(),
        found.seed
    );
    let mut lines = vec![paint.tone(&title, Tone::Strong).into_owned()];
    lines.push(format!(
        "  {} shoppers, {} changes of scene, {} of {} garments and sizes worn, {} steps late or dropped",
        found.visits, found.changes, found.sizes[0], found.sizes[1], found.deadline_misses
    ));
    for SoakCheck { name, limit, found, pass } in &found.checks {
        let (word, tone) = match (found, pass) {
            (None, _) => ("not checked", Tone::Warn),
            (_, true) => ("passed", Tone::Good),
            (_, false) => ("failed", Tone::Warn),
        };
        let found = found.map_or_else(|| "-".to_owned(), |f| format!("{f:.0}"));
        lines.push(paint.tone(&format!("  {word:<12} {name}: {found} (at most {limit:.0})"), tone).into_owned());
    }
    if !found.faults.kinds.is_empty() {
        lines.push(format!(
            "\n  {:<30} {:>9} {:>10} {:>9} {:>9} {:>11}",
            "fault", "injected", "recovered", "mean ms", "max ms", "noticed ms"
        ));
    }
    for k in &found.faults.kinds {
        let noticed = k.noticed_max_ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.0}"));
        lines.push(format!(
            "  {:<30} {:>9} {:>10} {:>9.0} {:>9.0} {noticed:>11}",
            k.name, k.injected, k.recovered, k.mean_ms, k.max_ms
        ));
    }
    lines.push(format!("\n  state {}", found.state_hash));
    lines.extend(found.warnings.iter().map(|w| paint.tone(&format!("  {w}"), Tone::Warn).into_owned()));
    lines.extend(report.files.iter().map(|f| format!("  {}", f.display())));
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::arguments::parsed;

    fn options(line: &str) -> Result<SoakOptions, AppError> {
        parsed::<SoakArgs>(line).map_err(AppError::input)?.options()
    }

    #[test]
    fn ten_simulated_minutes_without_faults_are_the_default() {
        let SoakOptions { plan, uptime_hours, real_time, workers } = options("soak").unwrap();
        assert_eq!(
            plan,
            SoakPlan {
                seed: 1,
                seconds: 600,
                faults: 0,
                scene: SceneWeight::Light,
                outfit: SoakOutfit::Dress,
                camera: SoakCamera::Joints
            }
        );
        assert_eq!((uptime_hours, real_time, workers), (0, false, 1));
    }

    #[test]
    fn faults_have_a_number_or_come_every_half_minute() {
        assert_eq!(options("soak --hours 8 --faults 1000").unwrap().plan.faults, 1_000);
        assert_eq!(options("soak --minutes 5 --faults").unwrap().plan.faults, 10);
        let real = options("soak --hours 1 --real-time --uptime-hours 9936").unwrap();
        assert_eq!((real.plan.scene, real.uptime_hours), (SceneWeight::Full, 9_936));
        for wrong in
            ["soak --minutes 1 --faults 11", "soak --minutes 0", "soak --hours nan", "soak --minutes 1 --hours 1"]
        {
            assert!(options(wrong).is_err(), "{wrong}");
        }
    }
}
