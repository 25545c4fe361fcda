//! The arguments of `toile plan`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use toile_assets::scene_file::examples;

use super::RunScene;
use super::values::{WorkersArg, WornArgs};
use toile_fitting::dress::wish::Wish;

/// What is planned.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanScene {
    /// A scene of `toile run`.
    Run(RunScene),
    /// A shopper of a session, or of the embedded one, dressed.
    Worn(Option<PathBuf>, Wish),
}

/// What a shopper's scene is made of; a scene file has none of it.
const WORN: [&str; 4] = ["session", "garments", "size", "quality"];

/// Say what a scene needs, whether it fits into its time, and what each model is worth, before it runs.
///
/// Counts the work of a scene and learns what this machine takes for it: which colliders each part of a garment can ever
/// touch, memory by part, the predicted time of each stage against its budget. Then plays ten seconds of it: how the
/// prediction held, and for each model the error of leaving it out and the time that it takes. A scene that cannot fit is
/// refused with exit code 3 and the cure, before anything is played.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: see whether a shirt and trousers fit at the finest quality\n  toile plan --garment \
                        t-shirt --garment wide-trousers --quality fine")]
pub struct PlanArgs {
    /// Scene file of `toile run` (default: the shopper of the embedded session, dressed)
    #[arg(value_name = "SCENE.toml", conflicts_with_all = WORN)]
    scene: Option<PathBuf>,
    /// A scene file that comes with the program
    #[arg(
        long,
        value_name = "NAME",
        value_parser = PossibleValuesParser::new(examples::names()),
        conflicts_with = "scene",
        conflicts_with_all = WORN
    )]
    example: Option<String>,
    /// Recording that the shopper comes from (default: the embedded session)
    #[arg(long, value_name = "F")]
    session: Option<PathBuf>,
    #[command(flatten)]
    worn: WornArgs,
    /// Workers of a step.
    #[command(flatten)]
    pub workers: WorkersArg,
    /// Play nothing: no measured error, no models weighed
    #[arg(long)]
    pub quick: bool,
    /// List what this machine takes for each unit of work
    #[arg(long)]
    pub costs: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl PlanArgs {
    /// The scene.
    pub fn scene(&self) -> PlanScene {
        match RunScene::of(self.scene.as_ref(), self.example.as_ref()) {
            Some(scene) => PlanScene::Run(scene),
            None => PlanScene::Worn(self.session.clone(), self.worn.wish()),
        }
    }
}
