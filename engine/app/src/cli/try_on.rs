//! The arguments of `toile try-on`.

use std::path::{Path, PathBuf};

use clap::ArgAction;
use toile_assets::body::Sex;
use toile_engine::cloth::Quality;
use toile_engine::lines::Kind;

use super::values::one_of;
use crate::output::Inputs;
use crate::renderer::RendererChoice;

/// Measure a shopper, dress them, and write pictures and a report.
///
/// Watches a session, measures the shopper, recommends a size zone by zone, lets the garment move on a body of that size
/// for the whole session, and writes pictures and a report.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see how a recorded shopper moves in wide trousers\n  toile try-on --session shopper.csv \
                        --garment wide-trousers --out fitting"
)]
pub struct TryOnArgs {
    /// Recording to watch: .mcap, Kinect CSV, Kinectron JSON or BVH (default: the embedded session)
    #[arg(long, value_name = "F")]
    pub session: Option<PathBuf>,
    /// Garment of the wardrobe, or an OBJ file; repeat it to dress in layers, inner first
    #[arg(long = "garment", value_name = "G")]
    pub garments: Vec<String>,
    /// Size to wear, as the garment's table names it (default: the one that fits)
    #[arg(long, value_name = "S")]
    pub size: Option<String>,
    /// Body to show: female, male, or a file (.glb, .gltf, .vrm) (default: by the garment)
    #[arg(long, value_name = "B", value_parser = Wearer::parse)]
    pub body: Option<Wearer>,
    /// Tested settings of the cloth: draft, shop or fine
    #[arg(
        long,
        value_name = "Q",
        value_parser = one_of(Quality::ALL, Quality::name),
        default_value = Quality::default().name()
    )]
    pub quality: Quality,
    /// Folder for the files; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Write the dressed body at the session's end as dressed.glb too
    #[arg(long)]
    pub glb: bool,
    /// Make no pictures: only the report and the physics
    #[arg(long = "no-pictures", action = ArgAction::SetFalse)]
    pub pictures: bool,
    /// What draws: cpu, or gpu in a build with the feature `view`
    #[arg(
        long,
        value_name = "R",
        value_parser = one_of(RendererChoice::ALL, RendererChoice::name),
        default_value = RendererChoice::default().name()
    )]
    pub renderer: RendererChoice,
    /// Film of the session: .mp4 or .webm by ffmpeg, or .png, which every build makes itself
    #[arg(long, value_name = "FILE")]
    pub video: Option<PathBuf>,
    /// Lines over the gpu's pictures: fibers, colliders, contacts, tethers or velocity; repeat it
    #[arg(long, value_name = "KIND", value_parser = one_of(Kind::ALL, Kind::name))]
    pub lines: Vec<Kind>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl TryOnArgs {
    /// Files that are read, and so must not be overwritten.
    pub fn inputs(&self) -> Inputs {
        let body = if let Some(Wearer::File(file)) = &self.body { Some(file.as_path()) } else { None };
        let garments = self.garments.iter().map(Path::new);
        Inputs::new(self.session.as_deref().into_iter().chain(body).chain(garments))
    }
}

/// Whose body is shown.
#[derive(Debug, Clone, PartialEq)]
pub enum Wearer {
    /// One of ours, of the measured size.
    Ours(Sex),
    /// One that others made.
    File(PathBuf),
}

impl Wearer {
    /// What `--body` means: a word, or a file that is there or has an extension.
    fn parse(word: &str) -> Result<Self, String> {
        let path = Path::new(word);
        match word {
            "female" => Ok(Self::Ours(Sex::Female)),
            "male" => Ok(Self::Ours(Sex::Male)),
            _ if path.extension().is_some() || path.exists() => Ok(Self::File(path.into())),
            _ => Err("it is neither female nor male nor a file".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_a_word_or_a_file() {
        assert_eq!(Wearer::parse("male").unwrap(), Wearer::Ours(Sex::Male));
        assert_eq!(Wearer::parse("a.vrm").unwrap(), Wearer::File("a.vrm".into()));
        assert!(Wearer::parse("tall").is_err());
    }
}
