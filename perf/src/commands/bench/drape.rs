//! `toile bench drape`: fabrics on Cusick's disc.

use std::path::PathBuf;

use serde::Serialize;
use toile_assets::put_line;
use toile_base::fabric::Fabric;
use toile_cli::arguments::quality;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Words};
use toile_engine::cloth::Quality;
use toile_perf::drape::{CusickRow, SPACINGS_MM, cusick};
use toile_view::contact_sheet::contact_sheet;

/// Drape fabrics over Cusick's disc, at 20, 10 and 5 mm.
///
/// A round specimen of 30 cm lies on a disc of 18 cm; the drape coefficient is the part of the ring that its shadow covers. Read after
/// five seconds, with what it changed by in the last two. Reported beside what was measured; nothing is fitted to it.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: three fabrics, with pictures\n  toile bench drape --fabric cotton-broad --fabric wool-tropical --fabric polyester-faille --pictures drape"
)]
pub(crate) struct DrapeArgs {
    /// Built-in fabric to drape; may be given again (default: all that do not hang as another)
    #[arg(long, value_name = "NAME")]
    fabric: Vec<String>,
    /// How much of the cloth is solved in a substep
    #[arg(long, value_name = "Q", value_parser = quality(), default_value = "shop")]
    quality: Quality,
    /// Folder for a picture of each fabric at 5 mm
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// The body of the report.
#[derive(Debug, Serialize)]
struct Draped {
    rows: Vec<CusickRow>,
    files: Vec<PathBuf>,
}

/// Columns of the sheet of pictures.
const COLUMNS: usize = 4;

/// Runs `toile bench drape`.
///
/// # Errors
/// A fabric that is not built in, a folder that cannot be written.
pub(crate) fn run(args: &DrapeArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let mut rows = Vec::new();
    for fabric in fabrics(&args.fabric)? {
        for spacing in SPACINGS_MM {
            let drawn = args.pictures.is_some() && spacing == SPACINGS_MM[SPACINGS_MM.len() - 1];
            rows.push(cusick(&fabric, spacing, args.quality, drawn).map_err(AppError::internal)?);
        }
        words.print_line(&fabric.name);
    }
    let files = match &args.pictures {
        Some(folder) => draw(folder, &rows)?,
        None => Vec::new(),
    };
    if args.json {
        return terminal::print_json(&Document::new("bench-drape", Draped { rows, files }));
    }
    terminal::print(&table(&rows))
}

/// Those asked for; else the built-in ones, of each that hangs otherwise than those before it.
fn fabrics(names: &[String]) -> Result<Vec<Fabric>, AppError> {
    if !names.is_empty() {
        return names.iter().map(|name| toile_assets::fabric::built_in(name).map_err(AppError::input)).collect();
    }
    let mut kept: Vec<Fabric> = Vec::new();
    for fabric in toile_assets::fabric::all().map_err(AppError::internal)? {
        if kept.iter().all(|other| !hangs_alike(other, &fabric)) {
            kept.push(fabric);
        }
    }
    Ok(kept)
}

/// Whether two fabrics differ in their looks alone.
fn hangs_alike(a: &Fabric, b: &Fabric) -> bool {
    let figures = |f: &Fabric| {
        let bending = [f.bend_warp_un_m, f.bend_weft_un_m, f.bend_bias_un_m.unwrap_or(-1.0)];
        ([f.density_kg_m2, f.stretch_warp_n_m, f.stretch_weft_n_m, f.shear_n_m], bending, f.hysteresis, f.stretch)
    };
    figures(a) == figures(b)
}

fn draw(folder: &std::path::Path, rows: &[CusickRow]) -> Result<Vec<PathBuf>, AppError> {
    let mut out = OutputFolder::prepare(folder)?;
    let drawn: Vec<_> = rows.iter().filter_map(|row| Some((row, row.picture.as_ref()?))).collect();
    let captions: Vec<String> =
        drawn.iter().map(|(row, _)| format!("{}: {:.0} %", row.fabric, row.drape_percent)).collect();
    let (images, captions): (Vec<_>, Vec<&str>) =
        drawn.iter().map(|(_, image)| *image).zip(captions.iter().map(String::as_str)).unzip();
    write_png(&mut out, "drape.png", &contact_sheet(&images, COLUMNS.min(images.len()), &captions))?;
    Ok(out.commit()?)
}

/// A line a fabric: the coefficient at each spacing, and what it is held against.
fn table(rows: &[CusickRow]) -> String {
    let mut text = String::new();
    put_line!(
        text,
        "{:<20} {:>6} {:>6} {:>6}  {:>9} {:>9} {:>9} {:>10}",
        "DC %",
        "20 mm",
        "10 mm",
        "5 mm",
        "10 to 5",
        "3 to 5 s",
        "measured",
        "band"
    );
    for of_one in rows.chunk_by(|a, b| a.fabric == b.fabric) {
        let dc: Vec<f64> = of_one.iter().map(|row| row.drape_percent).collect();
        let (Some(last), [.., before, after]) = (of_one.last(), &dc[..]) else { continue };
        let each: Vec<String> = dc.iter().map(|dc| format!("{dc:>6.1}")).collect();
        let measured = last.measured.map_or_else(|| "-".into(), |dc| format!("{dc:.1}"));
        let band = last.band.map_or_else(|| "-".into(), |[low, high]| format!("{low:.0} to {high:.0}"));
        put_line!(
            text,
            "{:<20} {}  {:>+9.1} {:>+9.2} {measured:>9} {band:>10}",
            last.fabric,
            each.join(" "),
            after - before,
            last.crept
        );
    }
    text
}
