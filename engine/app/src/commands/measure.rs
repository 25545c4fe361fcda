//! `toile measure`: the measures of the person in a recording or a depth frame.

use std::path::PathBuf;

use toile_fitting::dress::measured::{self, MeasuredSubject, ShopperFacts};
use toile_fitting::dress::session;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::{FittedMeasures, MEASURES};
use toile_track::measures;

use toile_base::body::Sex;
use toile_cli::arguments::{Printing, TapeArgs, one_of};
use toile_cli::document::{DefinedMeasure, Document, MeasuredLength, in_mm};
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Paint};

use crate::overlay::{Fit, overlay};
use crate::report::{self, FittedBody, MeasureReport, MethodMeasures};
use crate::summary;

/// Measure the person in a recording or a depth frame.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: get the measures as JSON\n  toile measure shopper.mcap --json")]
pub struct MeasureArgs {
    /// Recording or depth frame
    #[arg(value_name = "F")]
    pub file: PathBuf,
    /// Camera of a raw depth frame, as JSON (default: the recording's own)
    #[arg(long, value_name = "J")]
    pub camera: Option<PathBuf>,
    /// The shopper wears nothing that stands off the skin: the body fit is not one-sided
    #[arg(long)]
    pub tight: bool,
    /// Measures taken by tape
    #[command(flatten)]
    pub tape: TapeArgs,
    /// The shopper's sex, if it is known: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name))]
    pub sex: Option<Sex>,
    /// Whether the shopper is an adult or a child, if it is known
    #[arg(long, value_name = "A", value_parser = ["adult", "child"])]
    pub age: Option<String>,
    /// Folder for a picture of the fitted body over the depth
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

/// Runs `toile measure`.
///
/// # Errors
/// A file that cannot be read or shows no person, a folder that cannot be written, or a closed stdout.
pub fn run(args: &MeasureArgs) -> Result<(), AppError> {
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose().map_err(AppError::input)?;
    let mut out = out.map(|out| out.sparing(Inputs::new(args.camera.iter().chain([&args.file]))));
    let child = args.age.as_ref().map(|age| age == "child");
    let facts = ShopperFacts {
        clothed: !args.tight,
        sex: args.sex,
        child,
        tape: args.tape.readings()?,
        ..ShopperFacts::default()
    };
    let session = session::open(Some(&args.file), args.camera.as_deref())?;
    let measured = measured::measure(&session, facts)?;
    let mut files: Vec<PathBuf> = Vec::new();
    if let (Some(out), Some(fitted)) = (&mut out, &measured.fitted) {
        draw(out, &measured, fitted)?;
    }
    if let Some(out) = out {
        files = out.commit().map_err(AppError::input)?;
    }
    let mut notes = measured.best.notes.clone();
    if !measured.surface.frames.is_empty() && measured.fitted.is_none() {
        notes.push("No body fits what is seen: stand alone, facing the camera, arms slightly out.".to_owned());
    }
    let report = MeasureReport {
        session: report::measures::session(&session, &notes),
        measurements: report::measures::measurements(&measured.best, measured.population),
        methods: methods(&measured),
        body: measured.fitted.as_ref().map(|f| body(f, measured.child, facts.clothed)),
        valid_pixels: measured.best.valid_pixels as u64,
        people: measured.best.people as u32,
        files,
    };
    if args.printing.json {
        return terminal::print_json(&Document::new("measure", report));
    }
    terminal::print(&summary::measure(&report, Paint::for_stdout()))
}

fn draw(out: &mut OutputFolder, measured: &MeasuredSubject, fitted: &FittedMeasures) -> Result<(), AppError> {
    let Some((frame, only)) = measured.surface.frames.last() else { return Ok(()) };
    let image = overlay(&Fit { frame, alone: only, body: &fitted.body.body, pose: &fitted.pose });
    write_png(out, "fitted.png", &image)
}

fn methods(measured: &MeasuredSubject) -> Vec<MethodMeasures> {
    if let Some(fitted) = &measured.fitted {
        let measures = MEASURES.iter().zip(&fitted.measures).map(|(t, e)| defined(t.0, *e)).collect();
        return vec![MethodMeasures { method: "the body fit", measures }];
    }
    let measures = measured.best.measures.named().into_iter().filter_map(|(name, e)| Some(defined(name, e?))).collect();
    vec![MethodMeasures { method: "proportions", measures }]
}

fn defined(name: &'static str, estimate: Estimate) -> DefinedMeasure {
    let MeasuredLength { value, sigma } = in_mm(estimate);
    DefinedMeasure { name, definition: measures::definition(name), value, sigma }
}

fn body(fitted: &FittedMeasures, child: Option<f32>, clothed: bool) -> FittedBody {
    let thousandths = |x: f32| (f64::from(x) * 1e3).round() / 1e3;
    FittedBody {
        woman: thousandths(fitted.woman),
        child: thousandths(child.unwrap_or(0.0)),
        clothed,
        frames: fitted.frames as u64,
        turned: fitted.turned,
        explained: thousandths(fitted.explained),
        off_mm: in_mm(Estimate::new(fitted.off, 0.0)).value,
    }
}
