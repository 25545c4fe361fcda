//! The command line's grammar, its help, and what it is parsed into.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use clap_complete::Shell;

use crate::exit::AppError;

mod backend;
mod bake;
mod bodies;
mod body;
mod colliders;
mod convert;
mod depth;
mod doctor;
mod filters;
mod gestures;
mod kiosk;
mod latency;
mod measuring;
mod pareto;
mod plan;
mod run;
mod skinning;
mod skirt;
mod soak;
mod torture;
mod try_on;
mod validate;

pub use bake::BakeArgs;
pub use bodies::BodiesArgs;
pub use body::{BodyArgs, Wearer};
pub use colliders::CollidersArgs;
pub use convert::{ConvertArgs, KeptDepth};
pub use depth::DepthArgs;
pub use doctor::DoctorArgs;
pub use filters::FiltersArgs;
pub use gestures::GesturesArgs;
pub use kiosk::KioskArgs;
pub use latency::{LatencyArgs, ReplayArgs};
pub use measuring::MeasuringArgs;
pub use pareto::ParetoArgs;
pub use plan::{PlanArgs, PlanScene};
pub use run::{RunArgs, RunScene};
pub use skinning::SkinningArgs;
pub use skirt::SkirtArgs;
pub use soak::SoakArgs;
pub use torture::TortureArgs;
pub use try_on::TryOnArgs;
pub use validate::ValidateArgs;

/// What the user asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// `toile try-on`, and plain `toile`.
    TryOn(TryOnArgs),
    /// `toile measure`.
    Measure(MeasureArgs),
    /// `toile record`.
    Record(RecordArgs),
    /// `toile convert`.
    Convert(ConvertArgs),
    /// `toile run`.
    Run(RunArgs),
    /// `toile doctor`.
    Doctor(DoctorArgs),
    /// `toile bake`.
    Bake(BakeArgs),
    /// `toile body`.
    Body(BodyArgs),
    /// `toile body --colliders`.
    Colliders(CollidersArgs),
    /// `toile bench body`.
    BenchBody(BodiesArgs),
    /// `toile bench measure`.
    BenchMeasure(MeasuringArgs),
    /// `toile bench filters`.
    BenchFilters(FiltersArgs),
    /// `toile bench gestures`.
    BenchGestures(GesturesArgs),
    /// `toile bench depth`.
    BenchDepth(DepthArgs),
    /// `toile bench skinning`.
    BenchSkinning(SkinningArgs),
    /// `toile bench skirt`.
    BenchSkirt(SkirtArgs),
    /// `toile torture`.
    Torture(TortureArgs),
    /// `toile validate`.
    Validate(ValidateArgs),
    /// `toile pareto`.
    Pareto(ParetoArgs),
    /// `toile latency`.
    Latency(LatencyArgs),
    /// `toile replay`.
    Replay(ReplayArgs),
    /// `toile kiosk`.
    Kiosk(KioskArgs),
    /// `toile plan`.
    Plan(PlanArgs),
    /// `toile soak`.
    Soak(SoakArgs),
    /// `toile completions`.
    Completions(Shell),
    /// Help or version: text to print.
    Print(String),
}

/// Arguments of `toile measure`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureArgs {
    /// The recording or depth frame.
    pub file: PathBuf,
    /// Camera description for a raw depth frame.
    pub camera: Option<PathBuf>,
    /// Whether the shopper wears nothing that stands off the skin.
    pub tight: bool,
    /// Folder for a picture of the fitted body over the depth.
    pub out: Option<PathBuf>,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Arguments of `toile record`.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordArgs {
    /// The session file to write.
    pub out: PathBuf,
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// Length (s).
    pub seconds: u32,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Longest session that `record` makes (s); at 30 frames a second this is some hundred megabytes.
const MAX_RECORD_SECONDS: i64 = 600;

/// Length of the embedded session (s), [`toile_assets::scene::LENGTH_S`] as the grammar wants it.
const DEFAULT_RECORD_SECONDS: &str = "10";
const _: () = assert!(toile_assets::scene::LENGTH_S == 10.0);

/// The whole grammar, for parsing, help and completions.
pub fn command() -> clap::Command {
    clap::Command::new("toile")
        .version(env!("CARGO_PKG_VERSION"))
        .about("A real-time virtual fitting room: measures a shopper and dresses a body of their size")
        .long_about(
            "A real-time virtual fitting room: measures a shopper before a depth camera and dresses a body of their \
             size in garments that move as cloth, 120 steps a second.\n\nWithout a command, `toile` runs `toile \
             try-on`, and takes its options.",
        )
        .override_usage("toile [OPTIONS OF TRY-ON]\n       toile <COMMAND>")
        .subcommand_required(true)
        .subcommands([
            try_on::grammar(),
            measure(),
            record(),
            convert::grammar(),
            bake::grammar(),
            body::grammar(),
            run::grammar(),
            doctor::grammar(),
            bench(),
            validate::grammar(),
            pareto::grammar(),
            torture::grammar(),
            latency::grammar(),
            plan::grammar(),
            latency::replay_grammar(),
            soak::grammar(),
            kiosk::grammar(),
            completions(),
        ])
        .after_help("Example: dress the shopper of the embedded session, and look at out/\n  toile")
}

fn measure() -> clap::Command {
    clap::Command::new("measure")
        .about("Measure the person in a recording or a depth frame")
        .args([
            Arg::new("file")
                .value_name("F")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("Recording or depth frame"),
            path("camera", "J", "Camera of a raw depth frame, as JSON [default: the recording's own]"),
            flag("tight", "The shopper wears nothing that stands off the skin: the body fit is not one-sided"),
            path("out", "DIR", "Folder for a picture of the fitted body over the depth"),
            json(),
            quiet(),
        ])
        .after_help("Example: get the measures as JSON\n  toile measure shopper.mcap --json")
}

fn record() -> clap::Command {
    clap::Command::new("record")
        .about("Make a synthetic session, such as the embedded one")
        .long_about(
            "Renders what a depth camera would see of a moving body, with the camera's noise, and writes it as a \
             session. Without --seed and --seconds it makes the session that is embedded in the program.",
        )
        .args([
            path("out", "F.mcap", "Session file to write").required(true),
            text("seed", "N", "Seed of the noise; the same seed gives the same bits")
                .value_parser(value_parser!(u64))
                .default_value("1"),
            text("seconds", "S", "Length in seconds")
                .value_parser(value_parser!(u32).range(1..=MAX_RECORD_SECONDS))
                .default_value(DEFAULT_RECORD_SECONDS),
            json(),
            quiet(),
        ])
        .after_help("Example: make another session and watch it\n  toile record --out other.mcap --seed 7 && toile try-on --session other.mcap")
}

fn bench() -> clap::Command {
    clap::Command::new("bench")
        .about("Time one part of the frame, with the error at that speed")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            skinning::grammar(),
            skirt::grammar(),
            bodies::grammar(),
            measuring::grammar(),
            filters::grammar(),
            gestures::grammar(),
            depth::grammar(),
        ])
        .after_help("Example: the cost of a step of cloth, with its strain\n  toile bench skirt --motion walk")
}

fn completions() -> clap::Command {
    let shells = ["bash", "elvish", "fish", "powershell", "zsh"];
    let parser = PossibleValuesParser::new(shells).try_map(|name| name.parse::<Shell>());
    clap::Command::new("completions")
        .about("Print the completions of a shell")
        .arg(Arg::new("shell").value_name("SHELL").required(true).value_parser(parser).help("The shell"))
        .after_help("Example: complete Toile's options in bash\n  toile completions bash > ~/.local/share/bash-completion/completions/toile")
}

fn path(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf)).help(help)
}

fn text(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).value_name(value).help(help)
}

fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
}

fn json() -> Arg {
    flag("json", "Print one JSON object, and nothing else, on stdout")
}

fn quiet() -> Arg {
    flag("quiet", "Say nothing on stderr but errors").short('q')
}

/// Parses a command line, the program's name first.
///
/// # Errors
/// [`AppError::Usage`] with one sentence.
pub fn parse(args: Vec<OsString>) -> Result<Command, AppError> {
    let args = with_default_command(args);
    let matches = match command().try_get_matches_from(&args) {
        Ok(matches) => matches,
        Err(error) => return told(&error, &args),
    };
    let Some((name, matches)) = matches.subcommand() else {
        return Err(AppError::internal("a command line without a command was let through"));
    };
    Ok(match name {
        "try-on" => Command::TryOn(try_on::args(matches)?),
        "measure" => Command::Measure(MeasureArgs {
            file: required(matches, "file")?,
            camera: matches.get_one("camera").cloned(),
            tight: matches.get_flag("tight"),
            out: matches.get_one("out").cloned(),
            json: matches.get_flag("json"),
            quiet: matches.get_flag("quiet"),
        }),
        "record" => Command::Record(RecordArgs {
            out: required(matches, "out")?,
            seed: required(matches, "seed")?,
            seconds: required(matches, "seconds")?,
            json: matches.get_flag("json"),
            quiet: matches.get_flag("quiet"),
        }),
        "convert" => Command::Convert(convert::args(matches)?),
        "run" => Command::Run(run::args(matches)?),
        "doctor" => Command::Doctor(doctor::args(matches)?),
        "bake" => Command::Bake(bake::args(matches)?),
        "body" if matches.get_flag("colliders") => Command::Colliders(colliders::args(matches)?),
        "body" => Command::Body(body::args(matches)?),
        "bench" => bench_command(matches)?,
        "torture" => Command::Torture(torture::args(matches)?),
        "validate" => Command::Validate(validate::args(matches)?),
        "pareto" => Command::Pareto(pareto::args(matches)?),
        "latency" => Command::Latency(latency::args(matches)?),
        "plan" => Command::Plan(plan::args(matches)?),
        "replay" => Command::Replay(latency::replay_args(matches)?),
        "soak" => Command::Soak(soak::args(matches)?),
        "kiosk" => Command::Kiosk(kiosk::args(matches)?),
        "completions" => Command::Completions(required(matches, "shell")?),
        other => return Err(AppError::Internal(format!("command `{other}` is in the grammar but leads nowhere"))),
    })
}

fn bench_command(matches: &ArgMatches) -> Result<Command, AppError> {
    match matches.subcommand() {
        Some(("filters", matches)) => Ok(Command::BenchFilters(filters::parse(matches))),
        Some(("gestures", matches)) => Ok(Command::BenchGestures(gestures::parse(matches)?)),
        Some(("depth", matches)) => Ok(Command::BenchDepth(depth::parse(matches))),
        Some(("skinning", matches)) => Ok(Command::BenchSkinning(skinning::parse(matches)?)),
        Some(("body", matches)) => Ok(Command::BenchBody(bodies::args(matches)?)),
        Some(("measure", matches)) => Ok(Command::BenchMeasure(measuring::args(matches)?)),
        Some(("skirt", matches)) => Ok(Command::BenchSkirt(skirt::parse(matches)?)),
        _ => Err(AppError::internal("a benchmark without a name was let through")),
    }
}

/// A value that the grammar guarantees, by being required or by having a default.
fn required<T: Clone + Send + Sync + 'static>(matches: &ArgMatches, name: &str) -> Result<T, AppError> {
    matches.get_one::<T>(name).cloned().ok_or_else(|| AppError::Internal(format!("no value for `{name}`")))
}

/// Puts `try-on` where no command is given, and moves flags given before a command behind it: `toile --json doctor`.
fn with_default_command(mut args: Vec<OsString>) -> Vec<OsString> {
    let is_flag = |arg: &OsString| ["--json", "--quiet", "-q"].iter().any(|flag| arg == flag);
    if args.is_empty() {
        args.push("toile".into());
    }
    let flags = args[1..].iter().take_while(|a| is_flag(a)).count();
    let first = args.get(1 + flags).map(|a| a.to_string_lossy().into_owned());
    match first.as_deref() {
        Some("-h" | "--help" | "-V" | "--version") => {}
        Some(word) if !word.starts_with('-') => args[1..=1 + flags].rotate_right(1),
        _ => args.insert(1, "try-on".into()),
    }
    args
}

/// Help and version become text to print; a real error becomes one sentence that ends with where help is.
fn told(error: &clap::Error, args: &[OsString]) -> Result<Command, AppError> {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        let colour = crate::terminal::Paint::for_stdout().is_on();
        let text = error.render();
        return Ok(Command::Print(if colour { text.ansi().to_string() } else { text.to_string() }));
    }
    let known = |arg: &&OsString| command().get_subcommands().any(|c| **arg == c.get_name());
    let place = args.get(1).filter(known).map_or_else(String::new, |name| format!(" {}", name.to_string_lossy()));
    Err(AppError::Usage(sentence(error, &place)))
}

fn sentence(error: &clap::Error, place: &str) -> String {
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return format!("`toile{place}` needs to be told what to do; see `toile{place} --help`");
    }
    let text = error.render().to_string();
    let parts = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let parts: Vec<&str> = parts.filter(|line| !line.is_empty() && !line.starts_with("For more information")).collect();
    let (what, tips) = parts.split_first().unwrap_or((&"the command line was not understood", &[]));
    let what = what.trim_start_matches("error: ");
    // A list of missing arguments ends its first line with a colon; any other lines are tips.
    let tips = match (tips, what.ends_with(':')) {
        ([], _) => String::new(),
        (tips, true) => format!(" {}", tips.join(", ")),
        (tips, false) => format!(" ({})", tips.join("; ").replace("tip: ", "")),
    };
    format!("{what}{tips}; see `toile{place} --help`")
}

#[cfg(test)]
mod tests;
