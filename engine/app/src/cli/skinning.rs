//! The grammar of `toile bench skinning`.

use std::path::PathBuf;

use clap::{ArgMatches, value_parser};
use toile_engine::lanes::Width;
use toile_engine::skin::Blend;
use toile_perf::skinning::{Options, Subject};
use toile_perf::yardstick;

use super::{flag, json, required, text};
use crate::exit::AppError;

/// Arguments of `toile bench skinning`.
#[derive(Debug, Clone, PartialEq)]
pub struct SkinningArgs {
    /// What is measured.
    pub options: Options,
    /// The blend whose figures stand first.
    pub blend: Blend,
    /// All rows and the volumes of limbs in place of one measurement.
    pub table: bool,
    /// Folder that the picture of the twist test goes into, in place of a measurement.
    pub picture: Option<PathBuf>,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
}

/// Most vertices of the skinning benchmark: 4 million, about 1 GB of arrays.
const MAX_VERTS: u64 = 1 << 22;

pub(super) fn grammar() -> clap::Command {
    clap::Command::new("skinning")
        .about("Time the skinning of a body, linear and dual quaternions, against a plain loop and with its error")
        .long_about(
            "Skins a surface by linear blending and by dual quaternions, positions and unit normals, and tells the time \
             of each, the same over a plain scalar loop timed in turn with it, and its largest error against f64. \
             Without --body every vertex has four influences; with it they are those of the shopper's body.",
        )
        .args([
            text("verts", "N", "Vertices to skin [default: 15000, and with --body as many as the body has]")
                .value_parser(value_parser!(u64).range(1..=MAX_VERTS)),
            flag("dual", "Tell the figures of dual quaternions first"),
            flag("body", "Skin the shopper's body with its own weights"),
            text("threads", "T", "Threads that skin").value_parser(["1", "2"]).default_value("1"),
            text("lanes", "L", "Lanes of the kernels [default: the widest of this processor]")
                .value_parser(["1", "4", "8", "16"]),
            flag("table", "Run every row of the table, and the volumes of limbs; takes half a minute"),
            text("picture", "DIR", "Draw the twist test into DIR/twist.png instead: the forearm by each blend, split and not")
                .value_parser(value_parser!(PathBuf)),
            json(),
        ])
        .after_help("Example: the cost of dual quaternions on two threads\n  toile bench skinning --dual --threads 2")
}

pub(super) fn parse(matches: &ArgMatches) -> Result<SkinningArgs, AppError> {
    let body = matches.get_flag("body");
    let verts = matches.get_one::<u64>("verts").map(|v| usize::try_from(*v).map_err(AppError::internal)).transpose()?;
    let options = Options {
        subject: if body { Subject::Body } else { Subject::Four },
        verts: verts.or((!body).then_some(yardstick::VERTICES)),
        threads: required::<String>(matches, "threads")?.parse().map_err(AppError::internal)?,
        lanes: matches.get_one::<String>("lanes").and_then(|l| l.parse().ok()).and_then(Width::of),
    };
    Ok(SkinningArgs {
        options,
        blend: if matches.get_flag("dual") { Blend::Dual } else { Blend::Linear },
        table: matches.get_flag("table"),
        picture: matches.get_one::<PathBuf>("picture").cloned(),
        json: matches.get_flag("json"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> SkinningArgs {
        parse(&grammar().try_get_matches_from(line.split_whitespace()).unwrap()).unwrap()
    }

    #[test]
    fn the_defaults_are_those_of_the_benchmark() {
        let args = parsed("skinning");
        assert_eq!((args.options, args.blend), (Options::default(), Blend::Linear));
        assert_eq!(parsed("skinning --body").options.verts, None);
    }

    #[test]
    fn every_option_arrives() {
        let args = parsed("skinning --verts 77 --dual --body --threads 2 --lanes 4 --table --picture out --json");
        let options = Options { subject: Subject::Body, verts: Some(77), threads: 2, lanes: Some(Width::Four) };
        assert_eq!(
            args,
            SkinningArgs { options, blend: Blend::Dual, table: true, picture: Some("out".into()), json: true }
        );
    }
}
