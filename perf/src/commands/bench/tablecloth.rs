//! `toile bench tablecloth`: one tablecloth at several samplings, with and without friction and buckling.

use std::path::PathBuf;

use serde::Serialize;
use toile_assets::put_line;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Words};
use toile_perf::drape::{TableclothStudy, VARIANTS, tablecloth};
use toile_view::contact_sheet::contact_sheet;

/// Lay a tablecloth over a rectangular table at 5, 2, 1, .5 and .4 cm, each held against the finest.
///
/// As the MIRAGES report measures it: the mean distance of the particles to the same points of the cloth, after 1.92 s and at rest.
/// Theirs is to a real cloth, ours to the engine's own finest sampling. With friction and buckling, as far as the fabric has numbers.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: as far as 1 cm, with a picture\n  toile bench tablecloth --finest 1 --pictures tablecloth"
)]
pub(crate) struct TableclothArgs {
    /// Built-in fabric of the tablecloth
    #[arg(long, value_name = "NAME", default_value = "cotton-broad")]
    fabric: String,
    /// Finest sampling (cm), against which the others are held
    #[arg(long, value_name = "CM", default_value_t = 0.4)]
    finest: f64,
    /// One variant alone: plain, friction, buckling, both (default: all four)
    #[arg(long, value_name = "NAME", value_parser = clap::builder::PossibleValuesParser::new(VARIANTS))]
    variant: Option<String>,
    /// Folder for a sheet of pictures
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

/// The body of the report.
#[derive(Debug, Serialize)]
struct Laid {
    #[serde(flatten)]
    study: TableclothStudy,
    files: Vec<PathBuf>,
}

/// Runs `toile bench tablecloth`.
///
/// # Errors
/// A fabric that is not built in, an unknown sampling, a folder that cannot be written.
pub(crate) fn run(args: &TableclothArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let fabric = toile_assets::fabric::built_in(&args.fabric).map_err(AppError::input)?;
    let variants: Vec<&'static str> =
        VARIANTS.into_iter().filter(|v| args.variant.as_deref().is_none_or(|asked| asked == *v)).collect();
    let study =
        tablecloth(&fabric, &variants, args.finest, &mut |done| words.print_line(done)).map_err(AppError::internal)?;
    if study.rows.is_empty() {
        return Err(AppError::Usage("the coarsest sampling is 5 cm; give --finest 5 or less".into()));
    }
    let files = match &args.pictures {
        Some(folder) => draw(folder, &study)?,
        None => Vec::new(),
    };
    if args.json {
        return terminal::print_json(&Document::new("bench-tablecloth", Laid { study, files }));
    }
    terminal::print(&table(&study))
}

fn draw(folder: &std::path::Path, study: &TableclothStudy) -> Result<Vec<PathBuf>, AppError> {
    let mut out = OutputFolder::prepare(folder)?;
    let columns = study.rows.chunk_by(|a, b| a.variant == b.variant).map(<[_]>::len).max().unwrap_or(1);
    let captions: Vec<String> = study
        .rows
        .iter()
        .map(|row| format!("{}, {} cm: e {:.2} cm", row.variant, row.spacing_cm, row.error_cm[1]))
        .collect();
    let images: Vec<_> = study.rows.iter().filter_map(|row| row.picture.as_ref()).collect();
    let captions: Vec<&str> = captions.iter().map(String::as_str).collect();
    write_png(&mut out, "tablecloth.png", &contact_sheet(&images, columns, &captions))?;
    Ok(out.commit()?)
}

fn table(study: &TableclothStudy) -> String {
    let mut text = String::new();
    put_line!(text, "{}", study.setup);
    put_line!(
        text,
        "{:<9} {:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8}",
        "variant",
        "cm",
        "particles",
        "e 1.92 s",
        "e at rest",
        "hanging",
        "max cm",
        "MIRAGES",
        "mm/s",
        "step us",
        "run s"
    );
    for row in &study.rows {
        put_line!(
            text,
            "{:<9} {:>5} {:>9} {:>9.2} {:>9.2} {:>9.2} {:>9.1} {:>9.2} {:>9.1} {:>9.0} {:>8.1}",
            row.variant,
            row.spacing_cm,
            row.particles,
            row.error_cm[0],
            row.error_cm[1],
            row.hanging_cm[1],
            row.max_cm,
            row.published_cm,
            row.fastest_mm_s,
            row.step_us,
            row.seconds
        );
    }
    text
}
