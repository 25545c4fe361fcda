//! The grammar of `toile try-on`.

use std::path::PathBuf;

use clap::{ArgAction, ArgMatches};
use toile_engine::cloth::Quality;
use toile_engine::lines::Kind;

use super::{Wearer, flag, json, path, quiet, required, text};
use crate::artist::Renderer;
use crate::exit::AppError;

/// Arguments of `toile try-on`.
#[derive(Debug, Clone, PartialEq)]
pub struct TryOnArgs {
    /// A recording; `None` is the embedded session.
    pub session: Option<PathBuf>,
    /// Garments of the wardrobe or OBJ files, in dressing order; empty is the default garment.
    pub garments: Vec<String>,
    /// A size to wear in place of the recommended one.
    pub size: Option<String>,
    /// Whose body is shown; `None` is one of the measured size, of the sex that the garment is cut for.
    pub body: Option<Wearer>,
    /// Whether the dressed body is written as GLB.
    pub glb: bool,
    /// How the cloth is stepped.
    pub quality: Quality,
    /// Where the files go.
    pub out: PathBuf,
    /// Whether pictures are made.
    pub pictures: bool,
    /// What draws them.
    pub renderer: Renderer,
    /// A film of the session to make.
    pub video: Option<PathBuf>,
    /// What lines are drawn over the pictures.
    pub lines: Vec<Kind>,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("try-on")
        .about("Measure a shopper, dress them, and write pictures and a report")
        .long_about(
            "Watches a session, measures the shopper, recommends a size zone by zone, lets the garment move on a body \
             of that size for the whole session, and writes pictures and a report.",
        )
        .args([
            path("session", "F", "Recording to watch: .mcap, Kinect CSV, Kinectron JSON or BVH [default: embedded]"),
            text("garment", "G", "Garment of the wardrobe, or an OBJ file; repeat it to dress in layers, inner first")
                .action(ArgAction::Append),
            text("size", "S", "Size to wear, as the garment's table names it [default: the one that fits]"),
            text("body", "B", "Body to show: female, male, or a file (.glb, .gltf, .vrm) [default: by the garment]"),
            text("quality", "Q", "Tested settings of the cloth: draft, shop or fine")
                .value_parser(Quality::ALL.map(Quality::name))
                .default_value(Quality::default().name()),
            path("out", "DIR", "Folder for the files; it is made if missing").default_value("out"),
            flag("glb", "Write the dressed body at the session's end as dressed.glb too"),
            flag("no-pictures", "Make no pictures: only the report and the physics"),
            text("renderer", "R", "What draws: cpu, or gpu in a build with the feature `view`")
                .value_parser(Renderer::ALL.map(Renderer::name))
                .default_value(Renderer::default().name()),
            path("video", "FILE", "Film of the session: .mp4 or .webm by ffmpeg, or .png, which every build makes itself"),
            text("lines", "KIND", "Lines over the gpu's pictures: fibers, colliders, contacts, tethers or velocity; repeat it")
                .value_parser(Kind::ALL.map(Kind::name))
                .action(ArgAction::Append),
            json(),
            quiet(),
        ])
        .after_help("Example: see how a recorded shopper moves in wide trousers\n  toile try-on --session shopper.csv --garment wide-trousers --out fitting")
}

pub(super) fn args(matches: &ArgMatches) -> Result<TryOnArgs, AppError> {
    let lines = matches.get_many::<String>("lines").into_iter();
    Ok(TryOnArgs {
        session: matches.get_one("session").cloned(),
        garments: matches.get_many("garment").into_iter().flatten().cloned().collect(),
        size: matches.get_one("size").cloned(),
        body: matches.get_one::<String>("body").map(|b| Wearer::parse(b)).transpose()?,
        glb: matches.get_flag("glb"),
        quality: matches.get_one::<String>("quality").and_then(|q| q.parse().ok()).unwrap_or_default(),
        out: required(matches, "out")?,
        pictures: !matches.get_flag("no-pictures"),
        renderer: matches.get_one::<String>("renderer").and_then(|r| r.parse().ok()).unwrap_or_default(),
        video: matches.get_one("video").cloned(),
        lines: lines.flatten().filter_map(|k| k.parse().ok()).collect(),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}
