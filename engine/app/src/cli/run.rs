//! The grammar of `toile run`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, value_parser};
use toile_assets::scene_file::examples;

use super::{json, path, quiet, required, text};
use crate::dump::Format;
use crate::exit::AppError;

/// Most steps that `run` takes: ten days at 120 Hz.
const MAX_RUN_STEPS: u64 = 100_000_000;

/// Where the scene of `toile run` comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum RunScene {
    /// A file.
    File(PathBuf),
    /// A scene inside the program.
    Example(String),
}

/// Arguments of `toile run`.
#[derive(Debug, Clone, PartialEq)]
pub struct RunArgs {
    /// The scene.
    pub scene: RunScene,
    /// Steps to run in place of the scene's duration.
    pub frames: Option<u64>,
    /// Folder for positions.
    pub dump: Option<PathBuf>,
    /// How positions are written.
    pub format: Format,
    /// Every how many steps positions are written.
    pub every: u64,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("run")
        .about("Run any scene of your own: meshes, pins, fabric, colliders and their motion")
        .long_about(
            "Runs a scene file without pictures: garments from OBJ, glTF or built-in meshes, pins, fabrics, spheres, \
             capsules and planes with their motion from CSV, gravity, wind and settings. It reports time and strain \
             together, and writes positions for your own tools. docs/scene.md describes the file.",
        )
        .args([
            Arg::new("scene")
                .value_name("SCENE.toml")
                .required_unless_present("example")
                .conflicts_with("example")
                .value_parser(value_parser!(PathBuf))
                .help("Scene file"),
            text("example", "NAME", "Run a scene that comes with the program")
                .value_parser(PossibleValuesParser::new(examples::names())),
            text("frames", "N", "Steps to run [default: the scene's duration]")
                .value_parser(value_parser!(u64).range(1..=MAX_RUN_STEPS)),
            path("dump", "DIR", "Folder for the positions of every vertex; it is made if missing"),
            text("dump-format", "F", "How positions are written: csv or ply").value_parser(["csv", "ply"]).default_value("csv"),
            text("every", "K", "Write positions every K steps")
                .value_parser(value_parser!(u64).range(1..=MAX_RUN_STEPS))
                .default_value("1"),
            json(),
            quiet(),
        ])
        .after_help("Example: let a cloth fall on a ball, and write where it is 30 times a second\n  toile run --example cloth-on-sphere --dump positions --every 4")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<RunArgs, AppError> {
    let scene = match matches.get_one::<String>("example") {
        Some(name) => RunScene::Example(name.clone()),
        None => RunScene::File(required(matches, "scene")?),
    };
    Ok(RunArgs {
        scene,
        frames: matches.get_one("frames").copied(),
        dump: matches.get_one("dump").cloned(),
        format: if required::<String>(matches, "dump-format")? == "ply" { Format::Ply } else { Format::Csv },
        every: required(matches, "every")?,
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
