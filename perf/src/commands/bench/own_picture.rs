//! `toile bench own-picture`: the garment on the shopper's own picture, against the truth.

use std::path::PathBuf;

use serde::Serialize;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Words};
use toile_perf::own_picture::{self, OwnPictureError, OwnPictureTable};
use toile_pose::files;
use toile_view::image::Image;

/// Measure how far the garment on a shopper's own picture is from where it would really be.
///
/// Draws a woman who stands, walks across, crosses her arms and puts her hands behind her back, in colour and in depth with a Kinect's noise,
/// with the garment and without. She is measured, dressed and followed as the mirror does it, by depth and, where the network that `toile
/// doctor` names is fetched, by a webcam; reported are pixels between the garment's outline and the true one, at 1080 rows, and the time of
/// a picture.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(
    after_help = "Example: the table of docs/own-picture.md, with pictures\n  toile bench own-picture --out look"
)]
pub struct OwnPictureArgs {
    /// Garment that is worn
    #[arg(long, value_name = "G", default_value = "strap-dress")]
    garment: String,
    /// Folder for pictures: the camera's, the mirror's and the truth, beside each other
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Exit with 3 where a target is missed
    #[arg(long)]
    check: bool,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// The body of the JSON.
#[derive(Debug, Serialize)]
struct OwnPictureReport {
    #[serde(flatten)]
    table: OwnPictureTable,
    files: Vec<PathBuf>,
}

/// Runs `toile bench own-picture`.
///
/// # Errors
/// A garment that does not exist, another network, a folder that cannot be written, a missed target with `--check`, a closed stdout.
pub fn run(args: &OwnPictureArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose()?;
    let folder = files::folder();
    let network = files::check(&folder).is_ok().then_some(&*folder);
    if network.is_none() {
        words.print_line("the pose network is not fetched (`toile doctor` says how): by depth alone");
    }
    let mut kept: Vec<(String, Image)> = Vec::new();
    let mut keep = |picture: own_picture::KeptPicture| kept.push((picture.name, picture.image));
    let table = own_picture::run(&args.garment, network, &mut |what| words.print_line(what), &mut keep);
    let table = table.map_err(|error| match error {
        OwnPictureError::Fitting(error) => error.into(),
        OwnPictureError::Pose(error) => AppError::Device(error.to_string()),
        OwnPictureError::Tape(error) => AppError::Input(error.to_string()),
    })?;
    let met = table.is_met();
    if !args.json {
        terminal::print(&table.markdown())?;
    }
    let files = match out {
        Some(mut out) => {
            for (name, image) in &kept {
                write_png(&mut out, &format!("{name}.png"), image)?;
            }
            out.commit()?
        }
        None => Vec::new(),
    };
    if args.json {
        terminal::print_json(&Document::new("bench-own-picture", OwnPictureReport { table, files }))?;
    }
    if args.check && !met {
        return Err(AppError::Threshold("the outline of the garment is farther from the truth than asked for".into()));
    }
    Ok(())
}
