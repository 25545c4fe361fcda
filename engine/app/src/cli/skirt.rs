//! The grammar of `toile bench skirt`.

use std::path::PathBuf;

use clap::{ArgMatches, value_parser};
use toile_assets::scene::skirt::{Motion, Stretch};
use toile_engine::cloth::Quality;
use toile_engine::lanes::Width;
use toile_gpu::stepper::Backend;
use toile_perf::skirt::options::{MAX_GARMENTS, Mesh, Options};

use super::backend::{asked_backend, backend};
use super::{flag, json, required, text};
use crate::exit::AppError;

/// Arguments of `toile bench skirt`.
#[derive(Debug, Clone, PartialEq)]
pub struct SkirtArgs {
    /// The run.
    pub options: Options,
    /// All rows of the table in place of one run.
    pub table: bool,
    /// Folder for a chart of the table of sizes.
    pub picture: Option<PathBuf>,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
}

/// Most vertices: 512 a side.
const MAX_VERTS: u64 = 1 << 18;

/// Most steps a run, an hour of the scene.
const MAX_STEPS: u64 = 432_000;

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("skirt")
        .about("Time the cloth in the scene that Toile and its peers share, with strain and penetration")
        .long_about(
            "Steps the benchmark's skirt on a moving body: 240 steps to warm up, then runs of which the median is \
             told. Time, strain, penetration and all else come from the same steps; only the step itself is timed.",
        )
        .args([
            text("verts", "N", "Vertices, a square: 1024, 4096, 16384")
                .value_parser(value_parser!(u64).range(64..=MAX_VERTS))
                .default_value("4096"),
            text("motion", "M", "What the body does").value_parser(["walk", "fast", "settled"]).default_value("walk"),
            text("mesh", "M", "How the skirt is meshed").value_parser(["grid", "irregular"]).default_value("grid"),
            text("stretch", "S", "How its threads stretch: not at all, or 2000 N/m")
                .value_parser(["inextensible", "physical"])
                .default_value("inextensible"),
            flag("wind", "Wind of (1, 0, 0.5) m/s with drag 0.1 and lift 0.05"),
            text("threads", "T", "Threads that step").value_parser(["1", "2"]).default_value("1"),
            text("garments", "K", "Skirts to step, equal ones")
                .value_parser(value_parser!(u64).range(1..=MAX_GARMENTS as u64))
                .default_value("1"),
            text("lanes", "L", "Lanes of the kernels [default: the widest of this processor]")
                .value_parser(["1", "4", "8", "16"]),
            text("quality", "Q", "Tested settings: draft, shop or fine [default: the engine's own]")
                .value_parser(["draft", "shop", "fine"]),
            text("substeps", "S", "Substeps of a step [default: the engine's own]")
                .value_parser(value_parser!(u32).range(1..=1_000)),
            text("runs", "R", "Runs of which the median is told")
                .value_parser(value_parser!(u64).range(1..=1_000))
                .default_value("5"),
            text("steps", "S", "Steps of a run")
                .value_parser(value_parser!(u64).range(1..=MAX_STEPS))
                .default_value("600"),
            backend(),
            flag(
                "table",
                "Run every row of the table of targets, in place of one run; with --backend gpu or auto, sizes and numbers of \
                 skirts on the processor and on the device, and where they cross, with threads, sizes and steps of its own; \
                 takes some minutes",
            ),
            text("picture", "FOLDER", "With --table of a device: put the chart crossover.png there").requires("table"),
            json(),
        ])
        .after_help("Example: the cost and the error of a walk in a skirt of 16,384 vertices\n  toile bench skirt --verts 16384 --motion walk")
}

pub(super) fn parse(matches: &ArgMatches) -> Result<SkirtArgs, AppError> {
    let word = |name: &str| required::<String>(matches, name);
    let count = |name: &str| usize::try_from(required::<u64>(matches, name)?).map_err(AppError::internal);
    let lanes = matches.get_one::<String>("lanes").and_then(|l| l.parse().ok()).and_then(Width::of);
    let quality = matches.get_one::<String>("quality").and_then(|q| q.parse::<Quality>().ok());
    let options = Options {
        verts: count("verts")?,
        motion: match word("motion")?.as_str() {
            "walk" => Motion::Walk,
            "fast" => Motion::Fast,
            _ => Motion::Settled,
        },
        mesh: if word("mesh")? == "grid" { Mesh::Grid } else { Mesh::Irregular },
        stretch: if word("stretch")? == "physical" { Stretch::Physical } else { Stretch::Inextensible },
        wind: matches.get_flag("wind"),
        threads: word("threads")?.parse().map_err(AppError::internal)?,
        garments: count("garments")?,
        lanes,
        quality,
        substeps: matches.get_one("substeps").copied(),
        runs: count("runs")?,
        steps: count("steps")?,
        backend: asked_backend(matches)?,
        ..Options::default()
    };
    let picture = matches.get_one::<String>("picture").map(PathBuf::from);
    if picture.is_some() && options.backend == Backend::Cpu {
        let words = "`--picture` draws the table of a device; add `--backend gpu` or leave it out";
        return Err(AppError::Usage(words.to_owned()));
    }
    Ok(SkirtArgs { options, table: matches.get_flag("table"), picture, json: matches.get_flag("json") })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> SkirtArgs {
        parse(&grammar().try_get_matches_from(line.split_whitespace()).unwrap()).unwrap()
    }

    #[test]
    fn the_defaults_are_the_scenes_protocol() {
        let args = parsed("skirt");
        assert_eq!(args.options, Options::default());
        assert!(!args.table && !args.json);
    }

    #[test]
    fn every_option_arrives() {
        let args = parsed(
            "skirt --verts 1024 --motion fast --mesh irregular --stretch physical --wind --threads 2 --garments 3 \
             --lanes 8 --quality fine --substeps 6 --runs 2 --steps 60 --backend gpu --table --picture out --json",
        );
        let expected = Options {
            verts: 1_024,
            motion: Motion::Fast,
            mesh: Mesh::Irregular,
            stretch: Stretch::Physical,
            wind: true,
            threads: 2,
            garments: 3,
            lanes: Some(Width::Eight),
            quality: Some(Quality::Fine),
            substeps: Some(6),
            runs: 2,
            steps: 60,
            backend: Backend::Gpu,
            ..Options::default()
        };
        assert_eq!(args, SkirtArgs { options: expected, table: true, picture: Some("out".into()), json: true });
        let line = "skirt --table --picture out".split_whitespace();
        assert!(parse(&grammar().try_get_matches_from(line).unwrap()).is_err(), "there is no chart of the targets");
    }
}
