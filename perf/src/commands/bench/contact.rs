//! `toile bench contact`: cloth against itself, other cloth and the skin, with its targets.

use std::error::Error;
use std::path::{Path, PathBuf};

use serde::Serialize;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Words};
use toile_perf::contact::{self, OutfitPicture};

/// Measure contact of cloth with itself, with other cloth and with the skin, against its targets.
///
/// Stacks sheets, drops ten over a cylinder, twists a square metre, lets one sheet slide on another, starts garments in the
/// wrong order, walks the skirt of `bench skirt` against itself, and dresses a mannequin in three layers. Crossings of edges
/// with faces are counted in f64 by a test that shares no code with the engine.
#[derive(Debug, Clone, PartialEq, Eq, clap::Args)]
#[command(after_help = "Example: the sheets alone\n  toile bench contact --case sheet")]
pub struct ContactArgs {
    /// Only the cases whose names contain this
    #[arg(long, value_name = "NAME", conflicts_with = "table")]
    case: Option<String>,
    /// Every case, which is also the default; takes some minutes
    #[arg(long)]
    table: bool,
    /// Draw the outfits into DIR instead: in four poses, each from four sides
    #[arg(long, value_name = "DIR", conflicts_with_all = ["table", "case"])]
    pictures: Option<PathBuf>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// Runs `toile bench contact`.
///
/// # Errors
/// A name that no case has, and where stdout cannot be written.
pub fn run(args: &ContactArgs) -> Result<(), AppError> {
    if let Some(folder) = &args.pictures {
        return draw(folder, args.json);
    }
    let words = Words::new(args.json);
    let table = contact::run(args.case.as_deref(), &mut |case| words.print_line(case)).map_err(AppError::internal)?;
    if table.rows.is_empty() {
        let name = args.case.as_deref().unwrap_or_default();
        return Err(AppError::Usage(format!("no case's name contains {name:?}; leave out --case to run them all")));
    }
    if args.json {
        return terminal::print_json(&Document::new("bench-contact", table));
    }
    terminal::print(&table.markdown())
}

/// The report on pictures.
#[derive(Debug, Serialize)]
struct DrawnOutfits {
    /// One each, in the order in which they were drawn.
    pictures: Vec<DrawnOutfit>,
}

/// A picture, and what was seen in it.
#[derive(Debug, Serialize)]
struct DrawnOutfit {
    file: String,
    #[serde(flatten)]
    picture: OutfitPicture,
}

/// Draws the outfits into a folder.
fn draw(folder: &Path, json: bool) -> Result<(), AppError> {
    let words = Words::new(json);
    let mut out = OutputFolder::prepare(folder)?;
    let mut pictures = Vec::new();
    let drawn = contact::pictures::<Box<dyn Error>>(&mut |picture| {
        let file = picture.file();
        words.print_line(&file);
        write_png(&mut out, &file, &picture.image)?;
        pictures.push(DrawnOutfit { file, picture });
        Ok(())
    });
    // An error of an output file keeps its exit code; any other is a fault.
    drawn.map_err(|e| e.downcast::<AppError>().map_or_else(AppError::internal, |own| *own))?;
    out.commit()?;
    if json {
        return terminal::print_json(&Document::new("bench-contact-pictures", DrawnOutfits { pictures }));
    }
    let row = |drawn: &DrawnOutfit| format!("{}: {}\n", folder.join(&drawn.file).display(), drawn.picture.words());
    terminal::print(&pictures.iter().map(row).collect::<String>())
}
