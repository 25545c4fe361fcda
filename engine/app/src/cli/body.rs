//! The grammar of `toile body`.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use toile_assets::body::Sex;

use super::{flag, json, path, quiet, required, text};
use crate::exit::AppError;

/// Whose body is shown.
#[derive(Debug, Clone, PartialEq)]
pub enum Wearer {
    /// One of ours, of the measured size.
    Ours(Sex),
    /// One that others made.
    File(PathBuf),
}

impl Wearer {
    /// What `--body` of `toile try-on` means: a word, or a file that is there or has an extension.
    pub(super) fn parse(word: &str) -> Result<Self, AppError> {
        let path = Path::new(word);
        match word {
            "female" => Ok(Self::Ours(Sex::Female)),
            "male" => Ok(Self::Ours(Sex::Male)),
            _ if path.extension().is_some() || path.exists() => Ok(Self::File(path.into())),
            _ => {
                let said = format!("`--body {word}` is neither female nor male nor a file");
                Err(AppError::Usage(format!("{said}; see `toile try-on --help`")))
            }
        }
    }
}

/// Arguments of `toile body`.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyArgs {
    /// A glTF file, or a folder of MakeHuman's.
    pub file: PathBuf,
    /// Whose garments it is given.
    pub sex: Sex,
    /// Meshes to take; empty takes all that are skinned.
    pub meshes: Vec<String>,
    /// MakeHuman targets and how much of each.
    pub targets: Vec<(String, f32)>,
    /// MakeHuman rig.
    pub rig: String,
    /// Whether the surface may be open outside of the head too.
    pub allow_holes: bool,
    /// Where the files go.
    pub out: PathBuf,
    /// Whether pictures are made.
    pub pictures: bool,
    /// One JSON object on stdout in place of the summary.
    pub json: bool,
    /// No words on stderr.
    pub quiet: bool,
}

/// Most random bodies: some minutes' worth.
const MAX_STRANGERS: u64 = 10_000;

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("body")
        .about("Import a body that others made, and see what became of it")
        .long_about(
            "Reads a skinned glTF 2.0 mesh (.glb, .gltf), a VRM avatar (.vrm) or a folder with MakeHuman's hm08 base, \
             makes a body of it, and writes pictures of it at rest and walking, body.glb for other tools and for \
             `toile try-on --body`, and a report of its measures, joints, weights, surface and collision body.",
        )
        .args([
            Arg::new("file")
                .value_name("FILE")
                .required_unless_present("colliders")
                .value_parser(value_parser!(PathBuf))
                .help("glTF, GLB or VRM file, or MakeHuman folder"),
            flag("colliders", "Tell how closely the collision body follows the skin; without FILE, for our own bodies"),
            text("strangers", "N", "Bodies of random measures that --colliders takes besides the sizes")
                .value_parser(value_parser!(u64).range(0..=MAX_STRANGERS))
                .default_value("20"),
            text("seed", "S", "Which random bodies are taken").value_parser(value_parser!(u64)).default_value("1"),
            text("sex", "S", "Whose garments it wears").value_parser(["female", "male"]).default_value("female"),
            text("mesh", "NAME", "Mesh to take; repeat it for more [default: all that are skinned]")
                .action(ArgAction::Append),
            text("target", "NAME[=SHARE]", "MakeHuman target to add; repeat it for more").action(ArgAction::Append),
            text("rig", "NAME", "MakeHuman rig: game_engine or cmu_mb").default_value("game_engine"),
            flag("allow-holes", "Accept a surface that is open outside of the head"),
            path("out", "DIR", "Folder for the files; it is made if missing").default_value("out"),
            flag("no-pictures", "Make no pictures: only body.glb and the report"),
            json(),
            quiet(),
        ])
        .after_help(
            "Example: make a body of MakeHuman's files, then dress it\n  toile body hm08 --target \
             caucasian-female-young --out ada && toile try-on --body ada/body.glb",
        )
}

/// The arguments as the grammar has admitted them.
pub(super) fn args(matches: &ArgMatches) -> Result<BodyArgs, AppError> {
    let all = |name: &str| matches.get_many::<String>(name).into_iter().flatten();
    Ok(BodyArgs {
        file: required(matches, "file")?,
        sex: if required::<String>(matches, "sex")? == "male" { Sex::Male } else { Sex::Female },
        meshes: all("mesh").cloned().collect(),
        targets: all("target").map(|t| target(t)).collect::<Result<_, _>>()?,
        rig: required(matches, "rig")?,
        allow_holes: matches.get_flag("allow-holes"),
        out: required(matches, "out")?,
        pictures: !matches.get_flag("no-pictures"),
        json: matches.get_flag("json"),
        quiet: matches.get_flag("quiet"),
    })
}

/// A target with its share, which is all of it where none is given.
fn target(text: &str) -> Result<(String, f32), AppError> {
    let Some((name, share)) = text.split_once('=') else { return Ok((text.to_owned(), 1.0)) };
    let number = share.parse::<f32>().ok().filter(|s| s.is_finite());
    let wrong = || format!("`--target {text}` has no number behind `=`; give one such as --target {name}=0.5");
    Ok((name.to_owned(), number.ok_or_else(|| AppError::Usage(wrong()))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_have_shares_and_words_are_bodies_or_files() {
        assert_eq!(target("a").unwrap(), ("a".to_owned(), 1.0));
        assert_eq!(target("a=-0.5").unwrap(), ("a".to_owned(), -0.5));
        assert!(target("a=b").unwrap_err().to_string().contains("--target a=0.5"));
        assert_eq!(Wearer::parse("male").unwrap(), Wearer::Ours(Sex::Male));
        assert_eq!(Wearer::parse("a.vrm").unwrap(), Wearer::File("a.vrm".into()));
        assert!(Wearer::parse("tall").unwrap_err().to_string().contains("--body tall"));
    }
}
