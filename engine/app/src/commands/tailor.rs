//! `toile tailor`: a sewn pattern is laid around a body of a size, sewn up and let hang.

mod drafts;
mod pictures;
pub(super) mod wearer;

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use serde::Serialize;
use toile_assets::drafting;
use toile_assets::draping::{self, DrapedPattern, PatternPackage};
use toile_assets::sizes::GarmentKind;
use toile_assets::tailor::PanelQuality;
use toile_base::body::Sex;
use toile_cli::arguments::{Printing, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile, OutputFolder};
use toile_cli::terminal::{self, Paint, Tone};
use toile_view::figure::Figure;

use crate::arguments::AppearanceArgs;
use crate::report::StrainReport;

/// Sew a pattern up around a body and let it hang.
///
/// Reads GarmentCode and Garment-Pattern-Generator JSON, FreeSewing drafts and DXF with a seam file, lays the panels around a
/// body, closes the seams and lets the cloth hang, on meshes of 50, 25 mm and the spacing asked for; reports the time of each, how
/// the cloth is stretched and whether it crosses the skin.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: sew a T-shirt, look at it, and keep it for a try-on\n  toile tailor tee.json --pictures \
                        look --out tee.toile.json && toile try-on --garment tee.toile.json"
)]
pub struct TailorArgs {
    /// Pattern: .json, .jsonc or .dxf, a garment package, or the name of a garment that is drafted, such as straight-skirt
    #[arg(value_name = "PATTERN")]
    pub pattern: PathBuf,
    /// Seam file of a draft (default: the file beside it that ends in .toml)
    #[arg(long, value_name = "FILE")]
    pub seams: Option<PathBuf>,
    /// Body to drape on: female or male
    #[arg(long, value_name = "B", value_parser = one_of(Sex::ALL, Sex::name), default_value = "female")]
    pub body: Sex,
    /// Size of that body, and of the pattern if it has sizes (default: that of its draft, else the largest of the table that
    /// the pattern's own lengths leave ease)
    #[arg(long, value_name = "S", conflicts_with = "measures")]
    pub size: Option<String>,
    /// Table of sizes (default: that of the package, else women, or men)
    #[arg(long, value_name = "T")]
    pub table: Option<String>,
    /// Size that PATTERN is drafted for: its package has sizes then
    #[arg(long, value_name = "S")]
    pub drafted_for: Option<String>,
    /// Draft of the same pattern for another size, SIZE=FILE: sizes between two are graded; may be repeated
    #[arg(long, value_name = "SIZE=FILE", requires = "drafted_for")]
    pub draft: Vec<String>,
    /// What the garment is, which decides the girth that its sizes go by (default: what its panels show)
    #[arg(long, value_name = "K", value_parser = one_of(GarmentKind::ALL, GarmentKind::name), requires = "drafted_for")]
    pub kind: Option<GarmentKind>,
    /// Measures of that body (mm), as JSON: stature, shoulder_breadth, chest, waist, hip; or FreeSewing's; a pattern with sizes
    /// is graded to them
    #[arg(long, value_name = "FILE")]
    pub measures: Option<PathBuf>,
    /// Distance between particles (mm) (default: 15, or the package's own)
    #[arg(long, value_name = "MM")]
    pub spacing: Option<f64>,
    /// Fabric that is built in (default: cotton-lawn, or the package's own)
    #[arg(long, value_name = "F")]
    pub fabric: Option<String>,
    /// Garment package to write, for `toile try-on --garment`
    #[arg(long, value_name = "PACKAGE")]
    pub out: Option<PathBuf>,
    /// Folder for pictures: the panels flat, around the body, and draped, from front and back
    #[arg(long, value_name = "DIR")]
    pub pictures: Option<PathBuf>,
    #[command(flatten)]
    look: AppearanceArgs,
    #[command(flatten)]
    printing: Printing,
}

/// What a level took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct LevelReport {
    spacing_mm: f64,
    seconds: f64,
}

/// Ease at a zone (mm).
#[derive(Debug, Clone, PartialEq, Serialize)]
struct EaseReport {
    zone: &'static str,
    pattern_mm: f64,
    body_mm: f64,
    ease_mm: f64,
}

/// The body of `toile tailor`.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct TailorReport {
    garment: String,
    body: &'static str,
    size: String,
    fabric: String,
    panels: usize,
    seams: usize,
    ease: Vec<EaseReport>,
    levels: Vec<LevelReport>,
    seconds: f64,
    particles: usize,
    regular_fraction: f64,
    strain: StrainReport,
    seams_open_mm: f64,
    crossings: usize,
    penetration_mm: f64,
    files: Vec<PathBuf>,
}

/// Runs `toile tailor`.
///
/// # Errors
/// A pattern, size or measures that cannot be used, a seam that does not close, a folder that cannot be written.
pub fn run(args: &TailorArgs) -> Result<(), AppError> {
    let inputs = || Inputs::new([&args.pattern].into_iter().chain(&args.seams).chain(&args.measures));
    let keep =
        args.out.as_deref().map(|path| OutputFile::prepare(path, inputs())).transpose().map_err(AppError::input)?;
    let folder = args.pictures.as_deref().map(OutputFolder::prepare).transpose().map_err(AppError::input)?;
    let mut folder = folder.map(|folder| folder.sparing(inputs()));
    let mut package = read(args)?;
    package.spacing_mm = args.spacing.unwrap_or(package.spacing_mm);
    package.fabric = args.fabric.clone().unwrap_or(package.fabric);
    let fabric = toile_assets::fabric::built_in(&package.fabric).map_err(AppError::input)?;
    if let Some(size) = &args.drafted_for {
        let choice = drafts::DraftChoice {
            size,
            table: args.table.as_deref().unwrap_or_else(|| wearer::usual_table(args.body)),
            drafts: &args.draft,
            seams: args.seams.as_deref(),
            kind: args.kind,
            sex: args.body,
        };
        drafts::add(&choice, &mut package)?;
    }
    let choice = wearer::WearerChoice {
        sex: args.body,
        size: args.size.as_deref(),
        table: args.table.as_deref(),
        measures: args.measures.as_deref(),
    };
    let wearer::TailoredBody { body, size, pattern } = wearer::wearer(&choice, &package)?;
    let named = |e| AppError::input(format!("{}: {e}", args.pattern.display()));
    let ease = draping::ease(&pattern, &body).map_err(named)?;
    let start = Instant::now();
    let draped = draping::drape(&pattern, &body, &fabric, package.spacing_mm * 1e-3).map_err(named)?;
    let seconds = start.elapsed().as_secs_f64();
    let mut report = report(&package, &draped, seconds);
    report.size = size;
    report.body = body.sex.name();
    report.panels = pattern.panels().len();
    report.seams = pattern.seams().len();
    report.regular_fraction =
        regular(&draped.sewn.panels.iter().zip(pattern.panels()).map(|(m, p)| m.quality(p)).collect::<Vec<_>>());
    let mm = |m: f64| (m * 1e4).round() / 10.0;
    report.ease = ease
        .zones
        .iter()
        .map(|e| EaseReport {
            zone: e.zone.name(),
            pattern_mm: mm(e.pattern),
            body_mm: mm(e.body),
            ease_mm: mm(e.ease()),
        })
        .collect();
    if let Some(folder) = &mut folder {
        pictures::draw(folder, &draped, &Figure::of(&body, args.look.appearance()), &fabric)?;
    }
    if let Some(folder) = folder {
        report.files = folder.commit().map_err(AppError::input)?;
    }
    if let Some(keep) = keep {
        report.files.extend(keep.write(package.text().as_bytes()).map_err(AppError::input)?);
    }
    if args.printing.json {
        return terminal::print_json(&Document::new("tailor", report));
    }
    terminal::print(&summary(&report, Paint::for_stdout()))
}

/// The package of a garment that is drafted, by its name, or of a file.
fn read(args: &TailorArgs) -> Result<PatternPackage, AppError> {
    match args.pattern.to_str().and_then(drafting::style) {
        Some(style) => style.package().map_err(AppError::input),
        None => draping::read_package(&args.pattern, args.seams.as_deref()).map_err(AppError::input),
    }
}

fn regular(all: &[PanelQuality]) -> f64 {
    let sum = |of: fn(&PanelQuality) -> usize| all.iter().map(of).sum::<usize>() as f64;
    sum(|q| q.regular) / sum(|q| q.inner).max(1.0)
}

fn report(package: &PatternPackage, draped: &DrapedPattern, seconds: f64) -> TailorReport {
    let quality = &draped.quality;
    TailorReport {
        garment: package.name.clone(),
        body: "",
        size: String::new(),
        fabric: package.fabric.clone(),
        panels: 0,
        seams: 0,
        ease: Vec::new(),
        levels: draped.levels.iter().map(|l| LevelReport { spacing_mm: l.spacing * 1e3, seconds: l.seconds }).collect(),
        seconds,
        particles: draped.at.len(),
        regular_fraction: 0.0,
        strain: StrainReport { mean: quality.strain_mean, p99: quality.strain_p99, max: quality.strain_max },
        seams_open_mm: quality.seams_open * 1e3,
        crossings: quality.crossings,
        penetration_mm: quality.penetration * 1e3,
        files: Vec::new(),
    }
}

/// The report for a person.
fn summary(report: &TailorReport, paint: Paint) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: String| _ = writeln!(text, "{words}");
    let TailorReport { garment, size, fabric, body, panels, seams, .. } = report;
    line(paint.tone(&format!("{garment}, {fabric}, on a {body} body of size {size}"), Tone::Strong).into_owned());
    line(format!("  {panels} panels, {seams} seams, {} particles", report.particles));
    for ease in &report.ease {
        line(format!(
            "  {}: {:.0} mm around a body of {:.0}: {:+.0} mm",
            ease.zone, ease.pattern_mm, ease.body_mm, ease.ease_mm
        ));
    }
    let levels: Vec<String> =
        report.levels.iter().map(|l| format!("{:.0} mm in {:.1} s", l.spacing_mm, l.seconds)).collect();
    line(format!("  draped in {:.1} s: {}", report.seconds, levels.join(", ")));
    let strain = report.strain;
    line(format!(
        "  strain {:.1} % in the mean, {:.1} % at the 99th percentile, {:.0} % at worst",
        strain.mean * 100.0,
        strain.p99 * 100.0,
        strain.max * 100.0
    ));
    line(format!(
        "  seams at most {:.1} mm open, {} edges through the skin, {:.1} mm deep",
        report.seams_open_mm, report.crossings, report.penetration_mm
    ));
    report.files.iter().for_each(|file| line(format!("  wrote {}", file.display())));
    text
}
