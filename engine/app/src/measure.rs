//! `toile measure`: the measures of the person in a recording or a depth frame.

use std::path::PathBuf;

use toile_assets::sizes::Population;
use toile_perf::measuring::{Fit, overlay};
use toile_track::estimate::Estimate;
use toile_track::fit::FitOptions;
use toile_track::fit::measuring::{FittedMeasures, MEASURES};
use toile_track::measure::Measurements;
use toile_track::measures;

use crate::cli::MeasureArgs;
use crate::exit::AppError;
use crate::output::{Inputs, OutputFolder};
use crate::pictures::write_png;
use crate::report::{self, DefinedMeasure, Document, FittedBody, MeasureReport, Method};
use crate::shopper;
use crate::summary;
use crate::terminal::{self, Paint};
use crate::tracking::{self, Alone};

/// Runs `toile measure`.
///
/// # Errors
/// A file that cannot be read or shows nobody, a folder that cannot be written, or a closed stdout.
pub fn run(args: &MeasureArgs) -> Result<(), AppError> {
    let session = shopper::open(Some(&args.file), args.camera.as_deref())?;
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose().map_err(AppError::input)?;
    let mut out = out.map(|out| out.sparing(Inputs::new(args.camera.iter().chain([&args.file]))));
    let population = Population::Mixed;
    let measured = shopper::measure(&session, population)?;
    let alone = Alone::of(&session);
    let options = FitOptions { ground: alone.ground, clothed: !args.tight, ..FitOptions::MEASURING };
    let fitted = alone.measure(population, options);
    let mut files: Vec<PathBuf> = Vec::new();
    if let (Some(out), Some(fitted)) = (&mut out, &fitted) {
        draw(out, &alone, fitted)?;
    }
    if let Some(out) = out {
        files = out.commit().map_err(AppError::input)?;
    }
    let mut notes = measured.notes.clone();
    if !alone.frames.is_empty() && fitted.is_none() {
        notes.push("No body fits what is seen: stand alone, facing the camera, arms slightly out.".to_owned());
    }
    let report = MeasureReport {
        session: shopper::session_report(&session, &notes),
        measurements: measurements(&measured, fitted.as_ref(), population),
        methods: methods(&measured, fitted.as_ref()),
        body: fitted.as_ref().map(|f| body(f, options)),
        valid_pixels: measured.valid_pixels as u64,
        people: measured.people as u32,
        files,
    };
    if args.json {
        return terminal::print_json(&Document::new("measure", report));
    }
    terminal::print(&summary::measure(&report, Paint::for_stdout()))
}

fn draw(out: &mut OutputFolder, alone: &Alone, fitted: &FittedMeasures) -> Result<(), AppError> {
    let Some((frame, only)) = alone.frames.last() else { return Ok(()) };
    let image = overlay(&Fit { frame, alone: only, body: &fitted.body.body, pose: &fitted.pose });
    write_png(out, "fitted.png", &image)
}

/// The five measures of the contract: by the body fit, which docs/measuring.md shows to be the better way; without a
/// fit by sections and proportions.
fn measurements(
    measured: &Measurements,
    fitted: Option<&FittedMeasures>,
    population: Population,
) -> report::Measurements {
    let best = match fitted {
        Some(fitted) => tracking::preferred(measured.clone(), fitted),
        None => measured.clone(),
    };
    shopper::measures_report(&best, population)
}

fn methods(measured: &Measurements, fitted: Option<&FittedMeasures>) -> Vec<Method> {
    let sections = measured.measures.named().into_iter().filter_map(|(name, e)| Some(defined(name, e?))).collect();
    let mut all = vec![Method { method: "sections and proportions", measures: sections }];
    if let Some(fitted) = fitted {
        let measures = MEASURES.iter().zip(&fitted.measures).map(|(t, e)| defined(t.0, *e)).collect();
        all.push(Method { method: "the body fit", measures });
    }
    all
}

fn defined(name: &'static str, estimate: Estimate) -> DefinedMeasure {
    let report::Measure { value, sigma } = in_mm(estimate);
    DefinedMeasure { name, definition: measures::definition(name), value, sigma }
}

fn body(fitted: &FittedMeasures, options: FitOptions) -> FittedBody {
    let thousandths = |x: f32| (f64::from(x) * 1e3).round() / 1e3;
    FittedBody {
        woman: thousandths(fitted.woman),
        clothed: options.clothed,
        frames: fitted.frames as u64,
        explained: thousandths(fitted.explained),
        off_mm: in_mm(Estimate::new(fitted.off, 0.0)).value,
    }
}

fn in_mm(estimate: Estimate) -> report::Measure {
    let mm = |x: f32| (f64::from(x) * 1e4).round() / 10.0;
    report::Measure { value: mm(estimate.value), sigma: mm(estimate.sigma) }
}
