//! The arguments of `toile run`.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use clap::value_parser;
use toile_assets::scene_file::examples;

use super::values::one_of;
use crate::dump::Format;
use crate::exit::AppError;
use crate::output::Inputs;

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

impl RunScene {
    /// The scene that these arguments name, if they name one.
    pub(super) fn of(file: Option<&PathBuf>, example: Option<&String>) -> Option<Self> {
        file.cloned().map(Self::File).or_else(|| example.cloned().map(Self::Example))
    }
}

/// Run any scene of your own: meshes, pins, fabric, colliders and their motion.
///
/// Runs a scene file without pictures: garments from OBJ, glTF or built-in meshes, pins, fabrics, spheres, capsules and
/// planes with their motion from CSV, gravity, wind and settings. It reports time and strain together, and writes positions
/// for your own tools. docs/scene.md describes the file.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: let a cloth fall on a ball, and write where it is 30 times a second\n  toile run --example \
                        cloth-on-sphere --dump positions --every 4"
)]
pub struct RunArgs {
    /// Scene file
    #[arg(value_name = "SCENE.toml", required_unless_present = "example", conflicts_with = "example")]
    scene: Option<PathBuf>,
    /// Run a scene that comes with the program
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(examples::names()))]
    example: Option<String>,
    /// Steps to run (default: the scene's duration)
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..=MAX_RUN_STEPS))]
    pub frames: Option<u64>,
    /// Folder for the positions of every vertex; it is made if missing
    #[arg(long, value_name = "DIR")]
    pub dump: Option<PathBuf>,
    /// How positions are written: csv or ply
    #[arg(
        long = "dump-format",
        value_name = "F",
        value_parser = one_of([Format::Csv, Format::Ply], Format::ending),
        default_value = Format::Csv.ending()
    )]
    pub format: Format,
    /// Write positions every K steps
    #[arg(long, value_name = "K", value_parser = value_parser!(u64).range(1..=MAX_RUN_STEPS), default_value = "1")]
    pub every: u64,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl RunArgs {
    /// The scene.
    ///
    /// # Errors
    /// None that the command line lets through.
    pub fn scene(&self) -> Result<RunScene, AppError> {
        let scene = RunScene::of(self.scene.as_ref(), self.example.as_ref());
        scene.ok_or_else(|| AppError::Usage("no scene is given; see `toile run --help`".to_owned()))
    }

    /// The scene's file and all files that it names, which must not be overwritten.
    pub fn inputs(&self) -> Inputs {
        let Some(scene) = &self.scene else { return Inputs::default() };
        let folder = scene.parent().unwrap_or(Path::new(""));
        let text = std::fs::read_to_string(scene).unwrap_or_default();
        let mut files = vec![scene.clone()];
        if let Ok(table) = text.parse::<toml::Table>() {
            strings(&toml::Value::Table(table), &mut |text| files.push(folder.join(text)));
        }
        Inputs::new(files)
    }
}

/// Visits every string of a TOML value.
fn strings(value: &toml::Value, visit: &mut impl FnMut(&str)) {
    match value {
        toml::Value::String(text) => visit(text),
        toml::Value::Array(values) => values.iter().for_each(|value| strings(value, visit)),
        toml::Value::Table(table) => table.values().for_each(|value| strings(value, visit)),
        _ => {}
    }
}
