//! `toile convert`: any supported recording as a session, without pictures of people unless they are asked for.

use std::path::PathBuf;

use toile_cli::arguments::{Printing, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal;
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_sensors::segment::Segmenter;
use toile_sensors::session::Session;
use toile_sensors::source::{self, OpenOptions};

use crate::report::{self, ConvertReport};

/// Turn any supported recording into a Toile session.
///
/// Reads a recording of joints or depth, moves it into Toile's world (metres, y up, floor at y = 0), and writes it as a
/// session (MCAP). Joints alone are kept unless --depth asks for more: depth images show a person.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: keep the joints of a recording, and no picture of people\n  toile convert shopper.csv \
                        --out shopper.mcap\nExample: the same of depth images alone\n  toile convert frames --fit --out \
                        shopper.mcap"
)]
pub struct ConvertArgs {
    /// Recording, or folder of depth images
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// Session file to write
    #[arg(long, value_name = "F.mcap")]
    pub out: PathBuf,
    /// Camera of depth images, as JSON (default: the recording's own)
    #[arg(long, value_name = "J")]
    pub camera: Option<PathBuf>,
    /// Depth to keep: none, the shopper's alone, or all
    #[arg(
        long,
        value_name = "D",
        value_parser = one_of([KeptDepth::None, KeptDepth::Shopper, KeptDepth::All], KeptDepth::name),
        default_value = KeptDepth::None.name()
    )]
    pub depth: KeptDepth,
    /// Where there are no joints, fit the body to the depth and keep its joints
    #[arg(long)]
    pub fit: bool,
    #[command(flatten)]
    printing: Printing,
}

toile_base::named! {
    /// Which depth a converted session keeps.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    pub enum KeptDepth {
        /// None: nothing that shows a person is written.
        #[default]
        None = "none",
        /// The shopper's pixels alone; frames without one are empty.
        Shopper = "shopper",
        /// The whole image of every frame.
        All = "all",
    }
}

/// Runs `toile convert`.
///
/// # Errors
/// A recording that cannot be read or of which nothing would be left, a file that cannot be written, a closed stdout.
pub fn run(args: &ConvertArgs) -> Result<(), AppError> {
    let inputs = Inputs::new(args.camera.iter().chain([&args.input]));
    let out = OutputFile::prepare(&args.out, inputs)?;
    let mut session =
        source::open(&args.input, &OpenOptions { camera: args.camera.clone() }).map_err(AppError::input)?;
    let dropped = session.depth.len();
    if args.fit && session.joints.is_empty() && !session.depth.is_empty() {
        let measured = measured::measure(&session, ShopperFacts::default())?;
        measured::add_joints(&mut session, &measured)?;
    }
    keep(&mut session, args.depth);
    if session.joints.is_empty() && session.depth.is_empty() {
        return Err(AppError::input(format!(
            "{}: holds depth images alone, which show a person; give --fit to keep the joints that they show, or --depth \
             shopper or --depth all to keep the images",
            args.input.display()
        )));
    }
    let bytes = session.to_bytes().map_err(AppError::input)?;
    let report = ConvertReport {
        session: report::measures::session(&session, &[]),
        joint_frames: session.joints.len() as u64,
        depth_frames: session.depth.len() as u64,
        depth_frames_left_out: (dropped - session.depth.len()) as u64,
        files: out.write(&bytes)?,
    };
    if args.printing.json {
        return terminal::print_json(&Document::new("convert", report));
    }
    terminal::print(&summary(&report, bytes.len()))
}

/// Leaves of a session's depth what is asked for.
fn keep(session: &mut Session, depth: KeptDepth) {
    match depth {
        KeptDepth::All => {}
        KeptDepth::None => session.depth.clear(),
        KeptDepth::Shopper => {
            let mut segmenter = Segmenter::default();
            for frame in &mut session.depth {
                let mask = segmenter.push(frame).mask.to_vec();
                frame.depth_mm.iter_mut().zip(mask).for_each(|(d, m)| *d *= u16::from(m));
            }
            session.notes.push("only the shopper's depth was kept".to_owned());
        }
    }
}

fn summary(report: &ConvertReport, bytes: usize) -> String {
    let mut text = format!(
        "{}: {} joint frames, {} depth frames, {} KiB\n",
        report.files[0].display(),
        report.joint_frames,
        report.depth_frames,
        bytes / 1024
    );
    if report.depth_frames_left_out > 0 {
        text += &format!("  {} depth frames were left out; --depth keeps them\n", report.depth_frames_left_out);
    }
    for note in &report.session.notes {
        text += &format!("  {note}\n");
    }
    text
}
