//! The program `toile-study`: counts the people whom each size of a garment fits.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};

use clap::{ArgAction, Parser};
use serde::Serialize;
use toile_cli::arguments::{Printing, cores, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::program;
use toile_cli::terminal::{self, Words};
use toile_study::{Merged, RunReport, Shard, Study, StudyError, StudyFolder, Summary, TypicalPicture};

/// Most threads: more than any machine has.
const MOST_WORKERS: u64 = 1024;

/// Find out how many people each size of a garment fits, where it fails, and which step between sizes would help most.
///
/// A study file names garments, a population, a sensor and how much is simulated (docs/study.md). Every try-on is a row of DIR/rows.parquet, the
/// same bytes however many workers or machines there are; a run that was stopped goes on where it was. DIR/report.html is the page.
#[derive(Debug, Clone, PartialEq, Parser)]
#[command(
    name = "toile-study",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Example: a study, then the second of eight parts of it on another machine\n  toile study study.toml --out tee\n  toile study \
                  study.toml --out tee --shard 2/8"
)]
struct StudyArgs {
    /// What is done with a folder that a study has been computed in; none computes.
    #[command(subcommand)]
    command: Option<StudyCommand>,
    /// Study file
    #[arg(value_name = "STUDY.toml", required = true)]
    file: Option<PathBuf>,
    /// Folder for the rows; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Part of the study to compute, such as 2/8; then merge
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Threads, each with people of its own (default: as many as there are cores)
    #[arg(long, value_name = "N", value_parser = count(1..=MOST_WORKERS))]
    workers: Option<usize>,
    /// Draw no typical people: they are simulated
    #[arg(long = "no-pictures", action = ArgAction::SetFalse)]
    pictures: bool,
    /// What is printed.
    #[command(flatten)]
    printing: Printing,
}

// The help of a command is the doc of its arguments, which a doc of the variant would replace.
/// What is done with a study's folder.
#[derive(Debug, Clone, PartialEq, clap::Subcommand)]
enum StudyCommand {
    Merge(MergeArgs),
    Report(ReportArgs),
}

/// Merge the parts of a study to one file of rows.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: once all parts are done\n  toile study merge tee && toile study report tee")]
struct MergeArgs {
    /// The study's folder
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// What is printed.
    #[command(flatten)]
    printing: Printing,
}

/// Make the page of a study's rows again.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: without pictures, which are simulated\n  toile study report tee --no-pictures")]
struct ReportArgs {
    /// The study's folder
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Draw no typical people: they are simulated
    #[arg(long = "no-pictures", action = ArgAction::SetFalse)]
    pictures: bool,
    /// What is printed.
    #[command(flatten)]
    printing: Printing,
}

/// What `--json` prints.
#[derive(Debug, Clone, Serialize)]
struct StudyReport {
    /// What this run did.
    #[serde(skip_serializing_if = "Option::is_none")]
    run: Option<RunReport>,
    /// The file of all rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    merged: Option<Merged>,
    /// What the rows come to.
    #[serde(skip_serializing_if = "Option::is_none")]
    summary: Option<Summary>,
    /// The page.
    #[serde(skip_serializing_if = "Option::is_none")]
    page: Option<PathBuf>,
}

/// A study's error with its exit code.
fn refused(error: StudyError) -> AppError {
    match error {
        // A folder that is full or in use is one that cannot be used.
        StudyError::Input(text) | StudyError::Device(text) => AppError::Input(text),
        StudyError::Internal(text) => AppError::Internal(text),
    }
}

fn main() -> ExitCode {
    program::run::<StudyArgs>(std::env::args_os(), run)
}

/// Runs `toile study`.
///
/// # Errors
/// A study that cannot be used, a folder that is in use or full, a part that is missing.
fn run(args: &StudyArgs) -> Result<(), AppError> {
    match &args.command {
        Some(StudyCommand::Merge(args)) => merge(args),
        Some(StudyCommand::Report(args)) => report(args),
        None => compute(args),
    }
}

fn compute(args: &StudyArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let file = args
        .file
        .as_deref()
        .ok_or_else(|| AppError::Usage("no study file is given; see `toile study --help`".to_owned()))?;
    let study = Study::open(file).map_err(refused)?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let folder = StudyFolder::take(&args.out, &study, shard).map_err(refused)?;
    let bar = words.bar(study.rows() / shard.of, "trying on");
    let rows = AtomicU64::new(0);
    // Relaxed: a count for people to look at.
    let progress = |more: u64| bar.set_position(rows.fetch_add(more, Ordering::Relaxed) + more);
    let run = folder.run(&study, shard, args.workers.unwrap_or_else(cores), &progress);
    bar.finish_and_clear();
    let run = run.map_err(refused)?;
    let mut found = StudyReport { run: Some(run), merged: None, summary: None, page: None };
    if args.shard.is_none() {
        found.merged = Some(folder.merge().map_err(refused)?);
        made(&mut found, &folder, &args.out, Some(study).filter(|_| args.pictures).as_ref(), words)?;
    }
    printed(&found, args.printing, &args.out)
}

fn merge(args: &MergeArgs) -> Result<(), AppError> {
    let merged = StudyFolder::open(&args.folder).map_err(refused)?.merge().map_err(refused)?;
    let found = StudyReport { run: None, merged: Some(merged), summary: None, page: None };
    printed(&found, args.printing, &args.folder)
}

fn report(args: &ReportArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let folder = StudyFolder::open(&args.folder).map_err(refused)?;
    if !folder.rows_file().exists() {
        let shown = args.folder.display();
        return Err(AppError::Input(format!(
            "{shown} has no rows.parquet; merge its parts first: `toile study merge {shown}`"
        )));
    }
    let study = if args.pictures { same_study(&folder, words) } else { None };
    let mut found = StudyReport { run: None, merged: None, summary: None, page: None };
    made(&mut found, &folder, &args.folder, study.as_ref(), words)?;
    printed(&found, args.printing, &args.folder)
}

/// The study whose rows a folder holds, if its file is still there and the same.
fn same_study(folder: &StudyFolder, words: Words) -> Option<Study> {
    let study = Study::open(folder.study_path()).ok().filter(|study| study.digest() == folder.digest());
    if study.is_none() {
        let place = folder.study_path().display();
        words.print_line(&format!("{place} is gone or was changed, so that no typical people are drawn"));
    }
    study
}

/// Makes the page, with pictures where the study is given.
fn made(
    found: &mut StudyReport,
    folder: &StudyFolder,
    place: &Path,
    study: Option<&Study>,
    words: Words,
) -> Result<(), AppError> {
    let summary = Summary::read(&folder.rows_file()).map_err(refused)?;
    let mut pictures = Vec::new();
    if let Some(study) = study {
        let people = summary.garments.iter().map(|g| g.typical.len()).sum::<usize>() as u64;
        let bar = words.bar(people, "drawing");
        for garment in &summary.garments {
            for wearer in &garment.typical {
                let image = toile_study::picture(study, wearer.person as u64, &garment.name, &wearer.size);
                let image = image.map_err(|why| why.to_string());
                pictures.push(TypicalPicture { garment: garment.name.clone(), person: wearer.person, image });
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
    }
    let page = toile_study::page(&summary, &folder.runs().map_err(refused)?, &pictures);
    let mut out = OutputFolder::prepare(place)?;
    out.write("report.html", page.as_bytes())?;
    found.page = out.commit()?.pop();
    found.summary = Some(summary);
    Ok(())
}

fn printed(found: &StudyReport, printing: Printing, place: &Path) -> Result<(), AppError> {
    if printing.json {
        return terminal::print_json(&Document::new("study", found.clone()));
    }
    let mut text = String::new();
    if let Some(run) = &found.run {
        let minutes = (run.seconds / 60.0).max(1e-9);
        let speed = match run.draped {
            0 => format!("{:.0} rows a minute", (run.rows - run.kept) as f64 / minutes),
            draped => format!("{draped} try-ons simulated, {:.1} a minute", draped as f64 / minutes),
        };
        text += &format!("{} rows in {:.1} s ({} were there), {speed}\n", run.rows, run.seconds, run.kept);
        if run.of > 1 {
            text += &format!(
                "part {}/{} is done; once all are: toile study merge {}\n",
                run.shard,
                run.of,
                place.display()
            );
        }
    }
    if let Some(merged) = &found.merged {
        text += &format!("{}: {} rows, SHA-256 {}\n", merged.file.display(), merged.rows, merged.sha256);
    }
    for garment in found.summary.iter().flat_map(|summary| &summary.garments) {
        let fitted = garment.fitted;
        let [share, low, high] = [fitted.share, fitted.low, fitted.high].map(|s| s * 100.0);
        text +=
            &format!("{}: {share:.1} % of {} people fitted ({low:.1} to {high:.1})\n", garment.name, garment.people);
        if let Some(step) = garment.steps.first().filter(|step| step.gain.share > 0.0) {
            let from = step
                .from
                .as_ref()
                .map_or_else(|| "all sizes".to_owned(), |from| format!("the step from {from} to {}", step.to));
            let (by, gain) = (step.change_mm, step.gain.share * 100.0);
            text += &format!("  most help: {} of {from} {by:+.0} mm, {gain:+.1} points\n", step.zone);
        }
    }
    if let Some(page) = &found.page {
        text += &format!("{}\n", page.display());
    }
    terminal::print(&text)
}
