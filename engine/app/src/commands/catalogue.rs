//! `toile catalogue`: a shop's garments are packed, checked, and shown on one sheet.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use toile_assets::adapt::dress as own;
use toile_assets::catalogue::{
    Catalogue, CatalogueItem, GarmentManifest, GarmentPackage, ShopTheme, ThemeColours, contrast, package, word,
};
use toile_base::body::{Measures, Sex};
use toile_base::frame::Joints;
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal::{self, Paint, Tone, Words};
use toile_fitting::dress::garment_source::GarmentSource;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::{RequestedGarment, TryOn};
use toile_view::contact_sheet;
use toile_view::drawn_frame::{self, DrawnFrame};
use toile_view::figure::Appearance;
use toile_view::image::{Image, Size, linear};

use crate::arguments::AppearanceArgs;

/// A shop's catalogue of garment packages.
///
/// `check` reads every package, `sheet` draws all garments on one picture, `pack` makes a package of a folder. docs/catalogue.md says what is
/// in one.
// The help of a command is the doc of its arguments, which a doc of the variant would replace.
#[derive(Debug, Clone, PartialEq, clap::Subcommand)]
#[command(after_help = "Example: before the shop opens\n  toile catalogue check /etc/toile/catalogue")]
pub(crate) enum CatalogueCommand {
    Check(CheckArgs),
    Sheet(SheetArgs),
    Pack(PackArgs),
}

/// Read a catalogue with its theme and every package of it, and say which cannot be used and why.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: before the shop opens\n  toile catalogue check /etc/toile/catalogue")]
pub(crate) struct CheckArgs {
    /// Folder that holds catalogue.toml and garment packages
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// Draw all garments of a catalogue on one sheet, each on a body of its middle size.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: a sheet for the wall\n  toile catalogue sheet /etc/toile/catalogue --out sheet.png")]
pub(crate) struct SheetArgs {
    /// Folder that holds catalogue.toml and garment packages
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Picture to write
    #[arg(long, value_name = "FILE", default_value = "catalogue.png")]
    pub out: PathBuf,
    #[command(flatten)]
    look: AppearanceArgs,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// Pack a folder that holds garment.toml and the files that it names into one garment package.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: a garment for the catalogue\n  toile catalogue pack skirt/ --out shop/skirt.toile")]
pub(crate) struct PackArgs {
    /// Folder that holds garment.toml
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Package to write, ending in .toile
    #[arg(long, value_name = "PACKAGE")]
    pub out: PathBuf,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// A garment of a catalogue, as it is reported.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct GarmentReport {
    package: String,
    article: String,
    name: String,
    languages: Vec<String>,
    sizes: Vec<String>,
    price: Option<String>,
}

/// A package that is left out.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct RefusedReport {
    package: String,
    why: String,
}

/// How the screens of a catalogue look.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ThemeReport {
    /// Pixels of the logo as it is shown.
    logo: Option<[u32; 2]>,
    /// Bytes of the font.
    font_bytes: Option<usize>,
    /// Of text on ground.
    contrast: f32,
}

impl ThemeReport {
    fn of(theme: &ShopTheme) -> Self {
        let ThemeColours { text, ground, .. } = theme.colours;
        Self {
            logo: theme.logo.as_ref().map(|logo| [logo.width, logo.height]),
            font_bytes: theme.font.as_ref().map(|font| font.len()),
            contrast: (contrast(text, ground) * 10.0).round() / 10.0,
        }
    }

    fn line(&self) -> String {
        let logo = self.logo.map_or_else(String::new, |[w, h]| format!(", logo of {w} x {h} pixels"));
        let font = self.font_bytes.map_or_else(String::new, |bytes| format!(", font of {bytes} bytes"));
        format!("theme: contrast {:.1}:1{logo}{font}", self.contrast)
    }
}

/// The body of the three.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct CatalogueReport {
    shop: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    theme: Option<ThemeReport>,
    garments: Vec<GarmentReport>,
    refused: Vec<RefusedReport>,
    memory_bytes: usize,
    files: Vec<PathBuf>,
}

/// Runs `toile catalogue`.
///
/// # Errors
/// A folder that is no catalogue, a garment that cannot be packed, a file that cannot be written.
pub(crate) fn run(command: &CatalogueCommand) -> Result<(), AppError> {
    match command {
        CatalogueCommand::Check(args) => check(args),
        CatalogueCommand::Sheet(args) => sheet(args),
        CatalogueCommand::Pack(args) => pack(args),
    }
}

fn check(args: &CheckArgs) -> Result<(), AppError> {
    let report = Checked::of(&args.folder)?.report;
    finish(report, args.printing)
}

/// A catalogue with the garments that can be worn.
struct Checked {
    report: CatalogueReport,
    items: Vec<(CatalogueItem, Arc<GarmentSource>)>,
}

impl Checked {
    fn of(folder: &Path) -> Result<Self, AppError> {
        let catalogue = Catalogue::read(folder).map_err(AppError::input)?;
        let memory_bytes = catalogue.bytes();
        let refused = catalogue.refused.into_iter().map(|r| RefusedReport { package: r.package, why: r.why });
        let mut report = CatalogueReport {
            theme: catalogue.theme.as_deref().map(ThemeReport::of),
            shop: catalogue.shop,
            garments: Vec::new(),
            refused: refused.collect(),
            memory_bytes,
            files: Vec::new(),
        };
        let mut items = Vec::new();
        for item in catalogue.items {
            let package = item.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            match opened(&item.path) {
                Ok((source, sizes)) => {
                    report.garments.push(garment(package, &item.manifest, sizes));
                    items.push((item, Arc::new(source)));
                }
                Err(why) => report.refused.push(RefusedReport { package, why: why.to_string() }),
            }
        }
        Ok(Self { report, items })
    }
}

/// The garment of a package and its sizes.
fn opened(path: &Path) -> Result<(GarmentSource, Vec<String>), AppError> {
    let source = GarmentSource::open(path)?;
    let sizes = sizes(&source)?;
    Ok((source, sizes))
}

fn sizes(source: &GarmentSource) -> Result<Vec<String>, AppError> {
    let average =
        toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).map_err(AppError::internal)?;
    source.fabric()?;
    let offer = source.offer(&average)?;
    let unsized_code = || vec![own::UNKNOWN.to_owned()];
    Ok(offer.map_or_else(unsized_code, |o| o.sizes.into_iter().map(|s| s.code).collect()))
}

fn garment(package: String, manifest: &GarmentManifest, sizes: Vec<String>) -> GarmentReport {
    GarmentReport {
        package,
        article: manifest.article.clone(),
        name: word(&manifest.names, "en").to_owned(),
        languages: manifest.names.keys().cloned().collect(),
        sizes,
        price: manifest.price.as_ref().map(ToString::to_string),
    }
}

/// A garment on the sheet.
const PICTURE: Size = Size::new(240, 400);

/// Garments beside each other on the sheet.
const COLUMNS: usize = 8;

/// Steps in which cloth comes to rest on the mannequin: two seconds.
const SETTLING: usize = 240;

fn sheet(args: &SheetArgs) -> Result<(), AppError> {
    let out = OutputFile::prepare(&args.out, Inputs::new([&args.folder])).map_err(AppError::input)?;
    let Checked { mut report, items } = Checked::of(&args.folder)?;
    let words = Words::new(args.printing.quiet);
    let bar = words.bar(items.len() as u64, "drawing");
    let embedded = session::open(None, None)?;
    let pose = session::standing(&embedded)?[0];
    let mut pictures = Vec::with_capacity(items.len());
    let mut captions = Vec::with_capacity(items.len());
    for (item, source) in &items {
        match draw(&item.manifest, source, &pose, args.look.appearance()) {
            Ok(image) => {
                let price = item.manifest.price.as_ref().map_or_else(String::new, |p| format!(", {p}"));
                captions.push(format!("{}{price}", word(&item.manifest.names, "en")));
                pictures.push(image);
            }
            Err(why) => report.refused.push(RefusedReport { package: source.name.clone(), why: why.to_string() }),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    if pictures.is_empty() {
        return Err(AppError::input(format!(
            "{}: no garment in it can be drawn; see toile catalogue check",
            args.folder.display()
        )));
    }
    let pictures: Vec<&Image> = pictures.iter().collect();
    let captions: Vec<&str> = captions.iter().map(String::as_str).collect();
    let sheet = contact_sheet::contact_sheet(&pictures, COLUMNS, &captions);
    let mut png = Vec::new();
    sheet.write_png(&mut png).map_err(AppError::internal)?;
    report.files = out.write(&png).map_err(AppError::input)?;
    finish(report, args.printing)
}

/// A garment on a body of its middle size, from the front.
fn draw(
    manifest: &GarmentManifest,
    source: &Arc<GarmentSource>,
    pose: &Joints,
    appearance: Appearance,
) -> Result<Image, AppError> {
    let request = TryOn { garments: vec![RequestedGarment::of(source.clone(), None)], ..TryOn::default() };
    let mut dressed = request.on_mannequin(pose)?;
    for _ in 0..SETTLING {
        dressed.world.step(pose);
    }
    let snapshot = dressed.reader.latest().clone();
    let colour = manifest.colours.first().map_or(source.fabric()?.colour, |c| c.srgb).map(linear);
    let colours = vec![colour; dressed.world.garments().len()];
    let drawn = DrawnFrame::new(&dressed.world, appearance).coloured(&colours);
    Ok(drawn_frame::still(drawn, &snapshot, 0.0, PICTURE))
}

fn pack(args: &PackArgs) -> Result<(), AppError> {
    if args.out.extension().is_none_or(|end| format!(".{}", end.to_string_lossy()) != package::ENDING) {
        return Err(AppError::input(format!(
            "{}: a package ends in {}; name it so",
            args.out.display(),
            package::ENDING
        )));
    }
    let out = OutputFile::prepare(&args.out, Inputs::new([&args.folder])).map_err(AppError::input)?;
    let (bytes, manifest) = package::pack(&args.folder).map_err(AppError::input)?;
    let shown = args.folder.display().to_string();
    let package = GarmentPackage::of_bytes(&shown, bytes.clone()).map_err(AppError::input)?;
    let sizes = sizes(&GarmentSource::of_package(package, &shown)?)?;
    let files = out.write(&bytes).map_err(AppError::input)?;
    let name = args.out.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let report = CatalogueReport {
        shop: String::new(),
        theme: None,
        garments: vec![garment(name, &manifest, sizes)],
        refused: Vec::new(),
        memory_bytes: bytes.len(),
        files,
    };
    finish(report, args.printing)
}

fn finish(report: CatalogueReport, printing: Printing) -> Result<(), AppError> {
    if printing.json {
        return terminal::print_json(&Document::new("catalogue", report));
    }
    terminal::print(&summary(&report, Paint::for_stdout()))
}

/// The report for a person.
fn summary(report: &CatalogueReport, paint: Paint) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: String| _ = writeln!(text, "{words}");
    if !report.shop.is_empty() {
        line(paint.tone(&report.shop, Tone::Strong).into_owned());
    }
    report.theme.iter().for_each(|theme| line(format!("  {}", theme.line())));
    for g in &report.garments {
        let price = g.price.as_ref().map_or_else(String::new, |p| format!(", {p}"));
        line(format!("  {} {}: sizes {}{price} ({})", g.article, g.name, g.sizes.join(", "), g.languages.join(", ")));
    }
    report.refused.iter().for_each(|r| line(format!("  left out: {}", r.why)));
    let count = report.garments.len();
    line(format!("{count} garments, {} left out, {} bytes in memory", report.refused.len(), report.memory_bytes));
    report.files.iter().for_each(|file| line(format!("  wrote {}", file.display())));
    text
}
