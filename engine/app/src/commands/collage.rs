//! `toile collage`: garments that a shop has only as photographs, laid on the picture of a body.

use std::path::{Path, PathBuf};

use serde::Serialize;
use toile_assets::catalogue::{CollageGarment, CollagePictures, limits};
use toile_assets::file::{self, FileKind};
use toile_assets::sizes::SizeTable;
use toile_base::body::{Body, Measures, Sex};
use toile_cli::arguments::{Printing, count, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::picture::write_png;
use toile_cli::terminal;
use toile_view::collage::{BodyLayers, CollageError, CollageSide, WornPhotographs, collage};
use toile_view::contact_sheet::contact_sheet;
use toile_view::image::Image;

use super::tailor::wearer;
use crate::arguments::AppearanceArgs;

/// Most garments on one body: two a layer.
const MOST: usize = 16;

/// What is read as a garment's file, and as a picture beside it.
const GARMENT: FileKind =
    FileKind { name: "a garment's file", max_bytes: limits::MAX_TOML_BYTES, cure: "see docs/collage.md" };
const PICTURE: FileKind =
    FileKind { name: "a picture", max_bytes: limits::MAX_PACKAGE_BYTES, cure: "make its photograph smaller" };

/// Sizes that are shown where none is asked for: women's and men's.
const USUAL: [&str; 2] = ["38", "50"];

/// Lay photographs of garments on the picture of a body.
///
/// For garments that a shop has only as pictures: each is a TOML file that names its photographs from the front, the side and behind,
/// its layer of wearing, its level, and the girths that it stretches to. Writes a picture a side: the body, the garments in wearing
/// order, the body's arms over them, and the sleeves over these. docs/collage.md describes the files.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a skirt and a jacket on a body of size 40, from all sides\n  toile collage skirt.toml jacket.toml --size 40"
)]
pub struct CollageArgs {
    /// Files of garments; within one layer they are worn in this order
    #[arg(value_name = "F.toml", required = true)]
    pub garments: Vec<PathBuf>,
    /// Whose body it is: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name), default_value = "female")]
    pub sex: Sex,
    /// Size of the body, of women's or men's sizes (default: 38 or 50)
    #[arg(long, value_name = "SIZE", conflicts_with = "measures")]
    pub size: Option<String>,
    /// JSON file of a body's measures in mm, in place of a size
    #[arg(long, value_name = "F.json")]
    pub measures: Option<PathBuf>,
    /// Side that is shown: front, side or back; repeat it for more (default: those of which there are pictures)
    #[arg(long = "side", value_name = "SIDE", value_parser = one_of(CollageSide::ALL, CollageSide::name))]
    pub sides: Vec<CollageSide>,
    /// Rows of a picture
    #[arg(long, value_name = "N", value_parser = count(200..=2160), default_value = "800")]
    pub rows: usize,
    #[command(flatten)]
    look: AppearanceArgs,
    /// Folder for the pictures; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct CollageDocument {
    /// The body that wears them.
    body: String,
    /// Garments in painting order.
    garments: Vec<PaintedGarment>,
    files: Vec<PathBuf>,
}

/// One garment of the report.
#[derive(Debug, Serialize)]
struct PaintedGarment {
    name: String,
    layer: &'static str,
    /// Sides of which it has pictures.
    sides: Vec<&'static str>,
}

/// Runs `toile collage`.
///
/// # Errors
/// A garment's file or picture that is wrong, a body that a garment does not stretch to, a folder that cannot be written.
pub fn run(args: &CollageArgs) -> Result<(), AppError> {
    if args.garments.len() > MOST {
        let count = args.garments.len();
        return Err(AppError::Usage(format!("{count} garments are given and at most {MOST} are worn; leave some out")));
    }
    let inputs = args.garments.iter().chain(&args.measures);
    let mut out = OutputFolder::prepare(&args.out)?.sparing(Inputs::new(inputs));
    let (body, called) = body(args)?;
    let mut read: Vec<(CollageGarment, [Option<CollagePictures>; 3])> = Vec::new();
    for path in &args.garments {
        read.push(garment(path)?);
    }
    let worn: Vec<WornPhotographs> =
        read.iter().map(|(garment, pictures)| WornPhotographs { garment, pictures }).collect();
    let there = |side: &CollageSide| worn.iter().any(|w| w.pictures[*side as usize].is_some());
    let sides: Vec<CollageSide> = match args.sides.is_empty() {
        true => CollageSide::ALL.into_iter().filter(there).collect(),
        false => args.sides.clone(),
    };
    let size = BodyLayers::size(&body, args.rows as u32);
    let mut images = Vec::new();
    for side in &sides {
        let layers = BodyLayers::new(&body, args.look.appearance(), *side, size);
        let image = collage(&body, &layers, *side, &worn).map_err(|e| refused(&e))?;
        write_png(&mut out, &format!("collage-{}.png", side.name()), &image)?;
        images.push(image);
    }
    if images.len() > 1 {
        let captions: Vec<&str> = sides.iter().map(|s| s.name()).collect();
        let sheet = contact_sheet(&images.iter().collect::<Vec<&Image>>(), images.len(), &captions);
        write_png(&mut out, "collage.png", &sheet)?;
    }
    let files = out.commit()?;
    let document = CollageDocument { body: called, garments: painted(&read), files };
    if args.printing.json {
        return terminal::print_json(&Document::new("collage", document));
    }
    terminal::print(&words(&document))
}

fn refused(error: &CollageError) -> AppError {
    AppError::input(error)
}

/// The body that is asked for, and what it is called.
fn body(args: &CollageArgs) -> Result<(Body, String), AppError> {
    let (measures, called) = match &args.measures {
        Some(path) => (wearer::read(path, args.sex)?, format!("measured by {}", path.display())),
        None => {
            let usual = USUAL[usize::from(args.sex == Sex::Male)];
            let size = args.size.as_deref().unwrap_or(usual);
            let table = SizeTable::embedded(wearer::usual_table(args.sex)).map_err(AppError::input)?;
            (Measures::from(table.size_body(size).map_err(AppError::input)?), format!("size {size}"))
        }
    };
    Ok((toile_assets::body::build(args.sex, &measures).map_err(AppError::input)?, called))
}

/// A garment's file, and the pictures beside it.
fn garment(path: &Path) -> Result<(CollageGarment, [Option<CollagePictures>; 3]), AppError> {
    let shown = path.display();
    let wrong = |reason: String| AppError::input(format!("{shown}: {reason}"));
    let text = file::read_text(path, &GARMENT).map_err(AppError::input)?;
    let garment = CollageGarment::parse(&text).map_err(wrong)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let pictures = garment
        .read(|name| file::read(&folder.join(name), &PICTURE).map_err(|e| format!("{name}: {}; add it", e.reason())))
        .map_err(wrong)?;
    Ok((garment, pictures))
}

fn painted(read: &[(CollageGarment, [Option<CollagePictures>; 3])]) -> Vec<PaintedGarment> {
    let mut order: Vec<_> = read.iter().collect();
    order.sort_by_key(|(garment, _)| garment.layer);
    let sides = |pictures: &[Option<CollagePictures>; 3]| {
        CollageSide::ALL.into_iter().filter(|s| pictures[*s as usize].is_some()).map(CollageSide::name).collect()
    };
    order
        .into_iter()
        .map(|(g, p)| PaintedGarment { name: g.name.clone(), layer: g.layer.name(), sides: sides(p) })
        .collect()
}

fn words(d: &CollageDocument) -> String {
    let mut text = format!("On a body of {}:\n", d.body);
    for g in &d.garments {
        text += &format!("  {:<24} {:<10} {}\n", g.name, g.layer, g.sides.join(", "));
    }
    for file in &d.files {
        text += &format!("  {}\n", file.display());
    }
    text
}
