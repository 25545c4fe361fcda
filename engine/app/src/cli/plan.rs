//! The grammar of `toile plan`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use toile_assets::scene_file::examples;
use toile_engine::cloth::Quality;

use super::latency::{chosen_workers, wish, workers};
use super::{RunScene, flag, json, path, quiet, text};
use crate::exit::AppError;
use crate::outfit::Wish;

/// What is planned.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanScene {
    /// A scene of `toile run`.
    Run(RunScene),
    /// A shopper of a session, or of the embedded one, dressed.
    Worn(Option<PathBuf>, Wish),
}

/// Arguments of `toile plan`.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanArgs {
    /// The scene.
    pub scene: PlanScene,
    /// Workers of a step.
    pub workers: usize,
    /// Whether nothing is played: no measured error, no models weighed.
    pub quick: bool,
    /// Whether the costs of the units of work are told.
    pub costs: bool,
    /// One JSON object on stdout in place of the tables.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    const WORN: [&str; 4] = ["session", "garment", "size", "quality"];
    clap::Command::new("plan")
        .about("Say what a scene needs, whether it fits into its time, and what each model is worth, before it runs")
        .long_about(
            "Counts the work of a scene and learns what this machine takes for it: which colliders each part of a garment \
             can ever touch, memory by part, the predicted time of each stage against its budget. Then plays ten seconds of it: \
             how the prediction held, and for each model the error of leaving it out and the time that it takes. A scene \
             that cannot fit is refused with exit code 3 and the cure, before anything is played.",
        )
        .args([
            Arg::new("scene")
                .value_name("SCENE.toml")
                .value_parser(value_parser!(PathBuf))
                .conflicts_with_all(WORN)
                .help("Scene file of `toile run` [default: the shopper of the embedded session, dressed]"),
            text("example", "NAME", "A scene file that comes with the program")
                .value_parser(PossibleValuesParser::new(examples::names()))
                .conflicts_with("scene")
                .conflicts_with_all(WORN),
            path("session", "F", "Recording that the shopper comes from [default: embedded]"),
            text("garment", "G", "Garment of the wardrobe; repeat it to dress in layers, inner first")
                .action(ArgAction::Append),
            text("size", "S", "Size to wear [default: the one that fits]"),
            text("quality", "Q", "Tested settings of the cloth: draft, shop or fine [default: shop]")
                .value_parser(Quality::ALL.map(Quality::name)),
            workers(),
            flag("quick", "Play nothing: no measured error, no models weighed"),
            flag("costs", "Tell what this machine takes for each unit of work"),
            json(),
            quiet(),
        ])
        .after_help("Example: see whether a shirt and trousers fit at the finest quality\n  toile plan --garment t-shirt --garment wide-trousers --quality fine")
}

/// What a matched line asks for.
pub(super) fn args(matches: &ArgMatches) -> Result<PlanArgs, AppError> {
    let file = matches.get_one("scene").cloned().map(RunScene::File);
    let example = matches.get_one("example").cloned().map(RunScene::Example);
    let scene = match file.or(example) {
        Some(scene) => PlanScene::Run(scene),
        None => PlanScene::Worn(matches.get_one("session").cloned(), wish(matches)),
    };
    Ok(PlanArgs {
        scene,
        workers: chosen_workers(matches),
        quick: matches.get_flag("quick"),
        costs: matches.get_flag("costs"),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
