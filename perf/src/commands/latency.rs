//! `toile latency`: from what the sensor saw until a picture of it is taken, on this machine.

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::value_parser;
use serde::Serialize;
use toile_engine::clock::RealClock;
use toile_engine::frame_loop::quality_control::QUALITY_LEVELS;
use toile_engine::frame_loop::recording::{self, Entry};
use toile_engine::frame_loop::thread_roles::ThreadRole;
use toile_engine::frame_loop::threads;
use toile_fitting::dress::measured;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::{DressedWorld, TryOn};
use toile_fitting::live::report::Quantiles;
use toile_perf::latency::{self, Goal, Latency, LatencyInputs, LatencyOptions, LatencySource, OwnPictureParts};
use toile_sensors::source::live::CameraName;
use toile_view::own_picture::OwnPictureModel;

use crate::commands::arguments::CrashArg;
use toile_cli::arguments::{Printing, WorkersArg, WornArgs, cores};
use toile_cli::camera::{self, CameraUse, MountArgs};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::terminal::{self, Paint, Tone};
use toile_fitting::live::crash;

/// Longest run (s): a day.
const MOST_SECONDS: i64 = 86_400;

/// Most threads of load.
const MOST_LOAD: i64 = 256;

/// Time the way from the sensor to the picture on this machine, with the error at that speed.
///
/// Runs the whole loop in real time (sensor, physics with its worker, render) and reports how long each stage takes, from
/// what the sensor saw until a picture is taken, corrected for coordinated omission; what was late and why; the machine's own
/// jitter; the quality and the error that it ran at. Writes the figures as JSON too.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: see how late a kiosk may be while something else wants its cores\n  toile latency \
                        --seconds 60 --load")]
pub struct LatencyArgs {
    /// Recording to play, forwards and backwards (default: the embedded session)
    #[arg(long, value_name = "F")]
    pub session: Option<PathBuf>,
    /// Live camera that the joints come from, as `toile live` names them; the session decides who is dressed
    #[arg(long, value_name = "C", value_parser = camera::name)]
    pub camera: Option<CameraName>,
    /// How it is mounted
    #[command(flatten)]
    mount: MountArgs,
    /// Draw the garment on the camera's own picture too, at 1080 rows, and time it from the picture's stamp
    #[arg(long, requires = "camera")]
    pub own_picture: bool,
    #[command(flatten)]
    worn: WornArgs,
    /// Length of the run, after a first second that is not measured
    #[arg(long, value_name = "S", value_parser = value_parser!(u32).range(1..=MOST_SECONDS), default_value = "30")]
    pub seconds: u32,
    #[command(flatten)]
    workers: WorkersArg,
    /// Threads of load beside the loop; as many as there are cores if N is left out
    #[arg(
        long,
        value_name = "N",
        num_args = 0..=1,
        default_missing_value = "0",
        value_parser = value_parser!(u32).range(0..=MOST_LOAD)
    )]
    pub load: Option<u32>,
    /// Hold the quality on a level: 0 is all of it (default: set by quality control)
    #[arg(long, alias = "rung", value_name = "L", value_parser = value_parser!(u8).range(0..QUALITY_LEVELS.len() as i64))]
    pub level: Option<u8>,
    /// Record the run, without images, for `toile replay`
    #[arg(long, value_name = "F")]
    pub record: Option<PathBuf>,
    #[command(flatten)]
    crash: CrashArg,
    /// Exit with 3 where a goal is missed
    #[arg(long)]
    pub gate: bool,
    /// Folder for the figures; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out/latency")]
    pub out: PathBuf,
    #[command(flatten)]
    printing: Printing,
}

impl LatencyArgs {
    /// Options of the run.
    fn options(&self) -> LatencyOptions {
        let load = match self.load {
            None => 0,
            Some(0) => cores(),
            Some(threads) => threads as usize,
        };
        LatencyOptions { seconds: self.seconds, load, level: self.level }
    }
}

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LatencyReport {
    /// The scene that was run.
    pub scene: TryOn,
    /// The figures that were measured.
    #[serde(flatten)]
    pub found: Latency,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// Runs `toile latency`.
///
/// # Errors
/// A session without joints, a garment that is not in the wardrobe, files that cannot be written, and with `--gate` a goal
/// that was missed.
pub fn run(args: &LatencyArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let inputs = Inputs::new(&args.session);
    let crash_file = args.out.join("crash.tape");
    args.record.iter().chain([&crash_file]).try_for_each(|file| inputs.check(file))?;
    let mut out = OutputFolder::prepare(&args.out)?.sparing(inputs);
    let session = session::open(args.session.as_deref(), None)?;
    let track = session::standing(&session)?;
    let first = &track[0];
    // The loop's sensor thread filters the raw frames itself.
    let from = session.joints.len() - track.len();
    let request = args.worn.request()?;
    let measured = measured::measure(&session, request.facts())?;
    let request = request.sized_for(&session.name, &measured)?;
    let DressedWorld { world, reader, request, .. } = request.build(first)?;
    // Only now: a helper with a real-time priority shares its core with no thread that waits for it.
    let clock = RealClock::default();
    let sex = world.body().sex;
    let mut own = None;
    let source = match &args.camera {
        Some(name) => {
            let watched = camera::watch(
                name,
                &args.mount,
                CameraUse { colour: false, own_picture: args.own_picture },
                sex,
                clock,
            )?;
            own = watched.pictures.map(|(pictures, switch)| {
                switch.set(true);
                OwnPictureParts { model: OwnPictureModel::of(world.body(), world.garments()), pictures }
            });
            LatencySource::Camera(watched.feed)
        }
        None => LatencySource::Played(&session.joints[from..]),
    };
    let (crew, worker) = threads::worker_pool(args.workers.count(), ThreadRole::Physics).map_err(AppError::input)?;
    let options = args.options();
    words.print_line(&format!("running for {} s, with {} threads of load", options.seconds, options.load));
    let mut bytes = recording::header(&serde_json::to_string(&request).map_err(AppError::internal)?);
    let (flight_recorder, recording) = crash::record(bytes.clone(), crash_file);
    let dressed = Entry::Dressed(*first);
    flight_recorder.keep(&dressed);
    recording::write(&dressed, &mut bytes);
    let (mut begun, recorded) = (None, args.record.is_some());
    let empty = || {
        flight_recorder.drain(|entry| {
            if recorded {
                recording::write(entry, &mut bytes);
            }
        });
        let begun: Instant = *begun.get_or_insert_with(Instant::now);
        let crashes = args.crash.after_s.is_some_and(|s| begun.elapsed() >= Duration::from_secs(s));
        assert!(!crashes, "the crash that --crash-after asked for");
        flight_recorder.capacity()
    };
    let loop_inputs = LatencyInputs { frame: world.with_workers(crew), reader, source, clock, worker, own, recording };
    let found = latency::run(loop_inputs, &options, empty).map_err(AppError::internal);
    crash::forget();
    let found = found?;
    if let Some(path) = &args.record {
        let refused =
            |e| format!("recording {} cannot be written ({e}); name another file with --record", path.display());
        fs::write(path, &bytes).map_err(|e| AppError::Input(refused(e)))?;
    }
    let mut report = LatencyReport { scene: request, found, files: Vec::new() };
    let record = serde_json::to_vec_pretty(&Document::new("latency", &report)).map_err(AppError::internal)?;
    out.write("latency.json", &record)?;
    report.files = out.commit()?;
    report.files.extend(args.record.clone());
    let missed: Vec<&Goal> = report.found.goals.iter().filter(|g| !g.pass).collect();
    let verdict = missed.first().filter(|_| args.gate).map(|g| {
        format!(
            "{} is {:.0} us, more than {:.0} us; run it on a quiet machine or choose less quality",
            g.name, g.us, g.limit_us
        )
    });
    if args.printing.json {
        terminal::print_json(&Document::new("latency", report))?;
    } else {
        terminal::print(&table(&report, Paint::for_stdout()))?;
    }
    verdict.map_or(Ok(()), |verdict| Err(AppError::Threshold(verdict)))
}

/// The figures as people read them.
fn table(report: &LatencyReport, paint: Paint) -> String {
    let found = &report.found;
    let mut lines = vec![paint.tone(&format!("Latency: {}", report.scene.words()), Tone::Strong).into_owned()];
    lines.push(format!("  {:<20} {:>9} {:>9} {:>9} {:>9} {:>9}", "us", "p50", "p99", "p99.9", "max", "budget"));
    for stage in &found.stages {
        let Quantiles { p50, p99, p999, max, .. } = stage.us;
        let budget = stage.budget_us.map_or_else(String::new, |us| us.to_string());
        lines.push(format!("  {:<20} {p50:>9.1} {p99:>9.1} {p999:>9.1} {max:>9.1} {budget:>9}", stage.name));
    }
    let (a, q) = (&found.attributed, &found.quality);
    lines.push(format!(
        "\n  {} of {} steps late ({} pre-empted, {} page faults, {} solver, {} other), {} of them dropped",
        found.deadline_misses,
        found.steps + found.dropped,
        a.preempted,
        a.page_fault,
        a.solver,
        a.other,
        found.dropped
    ));
    let [mean, p99, _] = q.strain.map(|s| 100.0 * s);
    lines.push(format!(
        "  at strain {mean:.2} % (99 % under {p99:.2} %), penetration {:.2} mm, {} particles, {} substeps",
        q.penetration_mm, q.particles, q.substeps
    ));
    lines.push(format!("  steps on each level of quality: {:?}", q.rungs));
    if let Some(own) = &found.own_picture {
        let [all, dressed] = own.pictures;
        let plain: String = own.plain.iter().map(|(why, count)| format!("; plain, {why}: {count}")).collect();
        lines.push(format!("  {all} own pictures, {dressed} of them with the garment{plain}"));
    }
    for goal in &found.goals {
        let (word, tone) = if goal.pass { ("kept", Tone::Good) } else { ("missed", Tone::Warn) };
        let sentence = format!("  {word:<7} {} <= {:.0} us: {:.0} us", goal.name, goal.limit_us, goal.us);
        lines.push(paint.tone(&sentence, tone).into_owned());
    }
    lines.extend(found.warnings.iter().map(|w| paint.tone(&format!("  {w}"), Tone::Warn).into_owned()));
    lines.extend(report.files.iter().map(|f| format!("  {}", f.display())));
    lines.join("\n") + "\n"
}
