//! `toile soak`: the loop for hours, and what it bore.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use toile_engine::clock::SimClock;
use toile_engine::crew::Crew;
use toile_engine::frame::Frame;
use toile_engine::pace::physics::{Staged, Stepper};
use toile_engine::pace::replay::{Replayed, replay_changing};
use toile_engine::pace::tape::{self, Entry, Tape};
use toile_perf::skirt::heap::HeapProbe;
use toile_perf::soak::script::Script;
use toile_perf::soak::{self, Check, Company, Options, Plan, Soak, SoakError, Tools};

use crate::cli::SoakArgs;
use crate::exit::AppError;
use crate::machine::Machine;
use crate::output::OutputFolder;
use crate::report::Document;
use crate::terminal::{self, Paint, Tone, Words};
use crate::{bench, crash, heap};

/// Largest recording of a run in real time that is replayed behind it (bytes): two hours and a half.
const MOST_REPLAYED: u64 = 128 << 20;

/// How the scenes of a soak's recording are made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SoakRecipe {
    /// Version of the program that wrote it.
    pub version: String,
    /// What was soaked.
    pub soak: Plan,
}

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Body {
    /// What was found.
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
    let words = Words::new(args.quiet || args.json);
    let mut out = OutputFolder::prepare(&args.out)?;
    let recipe = SoakRecipe { version: env!("CARGO_PKG_VERSION").to_owned(), soak: args.options.plan };
    let header = tape::header(&serde_json::to_string(&recipe).map_err(AppError::internal)?);
    // A run in real time is compared with its own replay, so it is recorded in any case.
    let kept = match &args.record {
        Some(path) => Some(path.clone()),
        None if args.options.real_time && !args.once => Some(out.stage("soak.tape")?),
        None => None,
    };
    let file = kept.as_deref().map(create).transpose()?;
    let crash_file = args.out.join("crash.tape");
    let tools = Tools {
        heap: HeapProbe::new(bench::heap),
        count: heap::probe(),
        file,
        header,
        keep: &|black_box| crash::keep(black_box, crash_file.clone()),
        progress: &|seconds| words.say(&format!("{} of {} minutes", seconds / 60, args.options.plan.seconds / 60)),
        crash_ns: args.crash_after.map(|s| s * 1_000_000_000),
    };
    let ran = soak::run(&args.options, &tools).map_err(refused)?;
    crash::forget();
    let second = if args.once { None } else { second(&args.options, ran.hash, kept.as_deref(), &words)? };
    let found = Soak::new(ran, &args.options, second);
    let machine = Machine::here();
    let machine = format!("{}, {} cores, {}", machine.cpu, machine.cores, machine.lanes);
    out.write("soak.html", soak::page(&found, &machine, &typed(args)).as_bytes())?;
    let record = serde_json::to_vec_pretty(&Document::new("soak", &found)).map_err(AppError::internal)?;
    out.write("soak.json", &record)?;
    let mut files = out.commit()?;
    files.extend(args.record.clone());
    tell(&Body { found, files }, args.json)
}

/// Prints what was found; an error where a check failed.
fn tell(body: &Body, json: bool) -> Result<(), AppError> {
    if json {
        terminal::print_json(&Document::new("soak", body))?;
    } else {
        terminal::print(&table(body, Paint::for_stdout()))?;
    }
    let failed: Vec<&str> = body.found.failed().map(|c| c.name).collect();
    if failed.is_empty() {
        return Ok(());
    }
    let (failed, seed) = (failed.join("; "), body.found.seed);
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
fn second(options: &Options, hash: u64, kept: Option<&Path>, words: &Words) -> Result<Option<u64>, AppError> {
    if !options.real_time {
        words.say("once more, to compare");
        let tools = Tools {
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
        words.say("the recording is too long to be replayed at once; take it again with `toile replay`");
        return Ok(None);
    }
    words.say("the recording is taken again, with one worker");
    let Tape { entries, .. } = tape::read(&fs::read(path).map_err(unread)?).map_err(AppError::internal)?;
    let (_, out) = again(options.plan, &entries, 1)?;
    let same = out.diverged_at.is_none() && out.gap_at.is_none();
    Ok(Some(if same { hash } else { !hash }))
}

/// Takes a soak's recording again: the last scene, and what came out.
///
/// # Errors
/// A recording that does not begin where somebody was dressed, and a scene that cannot be made.
pub fn again(plan: Plan, entries: &[Entry], workers: usize) -> Result<(Frame, Replayed), AppError> {
    let Some((Entry::Changed { number, .. }, entries)) = entries.split_first() else {
        return Err(AppError::Input("the recording does not begin where somebody was dressed; record it again".into()));
    };
    let mut company = Company::new(Arc::new(Script::write(plan).map_err(refused)?));
    let (frame, _reader) = company.make(*number).map_err(refused)?;
    let crew = Crew::new(workers).map_err(AppError::input)?;
    let mut stepper = Stepper::new(Staged::new(frame.with_crew(crew)));
    let out = replay_changing(&mut stepper, entries, &SimClock::default(), |number| {
        company.make(number).ok().map(|(frame, _reader)| Staged::new(frame))
    });
    Ok((stepper.scene.frame, out))
}

/// What was typed, for the record.
fn typed(args: &SoakArgs) -> String {
    let Options { plan, uptime_hours, real_time, workers } = args.options;
    let mut line = format!("toile soak --minutes {} --seed {}", plan.seconds as f64 / 60.0, plan.seed);
    if plan.faults > 0 {
        line += &format!(" --faults {}", plan.faults);
    }
    if uptime_hours > 0 {
        line += &format!(" --uptime-hours {uptime_hours}");
    }
    if real_time {
        line += &format!(" --real-time --workers {workers}");
    }
    line += &format!(" --scene {}", plan.scene.name());
    if args.once { line + " --once" } else { line }
}

/// The figures as people read them.
fn table(body: &Body, paint: Paint) -> String {
    let found = &body.found;
    let title = format!(
        "Soak: {:.2} h, {} steps in {:.0} s ({:.0} us a step), {} scene, seed {}",
        found.hours,
        found.ticks,
        found.wall_s,
        found.us_per_step,
        found.scene.name(),
        found.seed
    );
    let mut lines = vec![paint.tone(&title, Tone::Strong).into_owned()];
    lines.push(format!(
        "  {} shoppers, {} changes of scene, {} of {} garments and sizes worn, {} steps late or dropped",
        found.visits, found.changes, found.sizes[0], found.sizes[1], found.deadline_misses
    ));
    for Check { name, limit, found, pass } in &found.checks {
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
            "\n  {:<22} {:>9} {:>10} {:>9} {:>9}",
            "fault", "injected", "recovered", "mean ms", "max ms"
        ));
    }
    for k in &found.faults.kinds {
        lines.push(format!(
            "  {:<22} {:>9} {:>10} {:>9.0} {:>9.0}",
            k.name, k.injected, k.recovered, k.mean_ms, k.max_ms
        ));
    }
    lines.push(format!("\n  state {}", found.state_hash));
    lines.extend(found.warnings.iter().map(|w| paint.tone(&format!("  {w}"), Tone::Warn).into_owned()));
    lines.extend(body.files.iter().map(|f| format!("  {}", f.display())));
    lines.join("\n") + "\n"
}
