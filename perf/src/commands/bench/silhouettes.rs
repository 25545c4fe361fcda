//! `toile bench silhouettes`: people whose measures are known, measured by their silhouettes.

use std::path::PathBuf;

use serde::Serialize;
use toile_cli::arguments::{Printing, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::terminal;
use toile_perf::ansur::Survey;
use toile_perf::capture::followed::{FollowStudy, follow_study};
use toile_perf::capture::silhouettes::{
    GIRTH_MM, SilhouetteStudy, SilhouetteStudyError, SilhouetteStudyOptions, study,
};

/// Measure synthetic people by their silhouettes, and compare with their true measures.
///
/// People of ANSUR II, each with sections of their own, and people of MakeHuman's family, another mesh altogether, stand as they like
/// before cameras all round, no two of them opposite, whose calibration is a little off and whose masks are black and white. All eleven measures are taken with
/// their errors; the mean of the squared error over the stated variance (chi square) is 1 where these are honest. Girths that miss
/// their goal on the other family make the exit code 3.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: the table of docs/capture.md, some minutes\n  toile bench silhouettes --ansur ANSUR_II_FEMALE.csv --ansur \
                  ANSUR_II_MALE.csv --makehuman hm08 --people 4"
)]
pub struct SilhouettesArgs {
    /// A file of ANSUR II, such as ANSUR_II_FEMALE.csv; repeat it for the other sex
    #[arg(long = "ansur", value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// A folder of MakeHuman's base mesh hm08: people of that family are measured too
    #[arg(long, value_name = "FOLDER")]
    makehuman: Option<PathBuf>,
    /// People of each sex and family
    #[arg(long, value_name = "N", value_parser = count(1..=1_000), default_value = "8")]
    people: usize,
    /// Cameras around them, 2 to 8; repeat it for more than one number
    #[arg(long, value_name = "N", value_parser = count(2..=8), default_value = "4")]
    cameras: Vec<usize>,
    /// Cameras stand evenly all round, an even number of them in opposite pairs; else no two are opposite, since these see the same outline
    #[arg(long)]
    opposite: bool,
    /// Which people, and how they stand
    #[arg(long, value_name = "S", default_value = "4242")]
    seed: u64,
    /// People move, so many frames at 30 Hz: they are measured in the first and followed through the others
    #[arg(long, value_name = "N", value_parser = count(2..=1_000))]
    frames: Option<usize>,
    /// Folder for a picture of each person: the silhouettes, and the body that was found; with --frames of some frames
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct SilhouettesDocument {
    seed: u64,
    studies: Vec<SilhouetteStudy>,
}

/// Runs `toile bench silhouettes`.
///
/// # Errors
/// [`AppError::Input`] for a file that is no survey or a folder that is not MakeHuman's; [`AppError::Threshold`] where girths of the
/// other family miss their goal, after the tables.
pub fn run(args: &SilhouettesArgs) -> Result<(), AppError> {
    let surveys: Vec<Survey> =
        args.files.iter().map(|f| Survey::read(f)).collect::<Result<_, _>>().map_err(AppError::input)?;
    let families: Vec<Option<PathBuf>> =
        std::iter::once(None).chain(args.makehuman.iter().map(|f| Some(f.clone()))).collect();
    if let Some(frames) = args.frames {
        return follow(args, &surveys, &families, frames);
    }
    let people = |options: &SilhouetteStudyOptions, seen: &mut Seen<'_>| {
        study(&surveys, options, &mut |png| seen(png.map(|png| (String::new(), png)).into_iter().collect()))
    };
    let studies = of_families(args, &families, surveys.len(), "measuring people", people)?;
    let missed: Vec<String> = studies
        .iter()
        .filter(|s| s.family == "makehuman" && s.girths_mm > GIRTH_MM)
        .map(|s| format!("{:.1} mm by {}", s.girths_mm, named(s.cameras, s.opposite)))
        .collect();
    if args.printing.json {
        terminal::print_json(&Document::new("bench-silhouettes", SilhouettesDocument { seed: args.seed, studies }))?;
    } else {
        terminal::print(&table(&studies))?;
    }
    if missed.is_empty() {
        return Ok(());
    }
    Err(AppError::Threshold(format!(
        "girths of the other family miss {GIRTH_MM} mm: {}; docs/capture.md says why",
        missed.join(", ")
    )))
}

/// Called after each person with their pictures, each with the end of its file's name.
type Seen<'a> = dyn FnMut(Vec<(String, Vec<u8>)>) + 'a;

/// A study of each family by each number of cameras, with its pictures in the folder that was asked for.
fn of_families<S>(
    args: &SilhouettesArgs,
    families: &[Option<PathBuf>],
    sexes: usize,
    words: &'static str,
    mut take: impl FnMut(&SilhouetteStudyOptions, &mut Seen<'_>) -> Result<S, SilhouetteStudyError>,
) -> Result<Vec<S>, AppError> {
    let bar = args.printing.words().bar((families.len() * args.cameras.len() * sexes * args.people) as u64, words);
    let folder = args.pictures.as_deref().map(OutputFolder::prepare).transpose()?;
    let (mut drawn, mut studies) = (Vec::new(), Vec::new());
    for makehuman in families {
        for &cameras in &args.cameras {
            let family = if makehuman.is_some() { "makehuman" } else { "survey" };
            let mut count = 0;
            let mut seen = |pictures: Vec<(String, Vec<u8>)>| {
                bar.inc(1);
                count += 1;
                let name = |end: String| format!("{family}-{cameras}-{count}{end}.png");
                drawn.extend(pictures.into_iter().map(|(end, png)| (name(end), png)));
            };
            studies.push(take(&options(args, makehuman, cameras), &mut seen).map_err(refused)?);
        }
    }
    bar.finish_and_clear();
    if let Some(mut folder) = folder {
        drawn.iter().try_for_each(|(name, png)| folder.write(name, png).map(drop))?;
        folder.commit()?;
    }
    Ok(studies)
}

/// What is studied of a family by so many cameras.
fn options(args: &SilhouettesArgs, makehuman: &Option<PathBuf>, cameras: usize) -> SilhouetteStudyOptions {
    SilhouetteStudyOptions {
        makehuman: makehuman.clone(),
        people: args.people,
        cameras,
        opposite: args.opposite,
        seed: args.seed,
        pictures: args.pictures.is_some(),
    }
}

fn refused(error: SilhouetteStudyError) -> AppError {
    match error {
        SilhouetteStudyError::Capture(_) => AppError::internal(error),
        _ => AppError::input(error),
    }
}

/// The report of people who move, as JSON has it.
#[derive(Debug, Serialize)]
struct FollowDocument {
    seed: u64,
    studies: Vec<FollowStudy>,
}

/// People who move.
fn follow(
    args: &SilhouettesArgs,
    surveys: &[Survey],
    families: &[Option<PathBuf>],
    frames: usize,
) -> Result<(), AppError> {
    let people = |options: &SilhouetteStudyOptions, seen: &mut Seen<'_>| {
        let numbered = |(frame, png): (usize, Vec<u8>)| (format!("-frame-{frame:03}"), png);
        follow_study(surveys, options, frames, &mut |pictures| seen(pictures.into_iter().map(numbered).collect()))
    };
    let studies = of_families(args, families, surveys.len(), "following people", people)?;
    if args.printing.json {
        let document = FollowDocument { seed: args.seed, studies };
        return terminal::print_json(&Document::new("bench-silhouettes-followed", document));
    }
    let mut text = String::from(
        "| followed | people, lost | frames, lost | joints off: first, others, 95 %, last (mm) | surface off: first, others, 95 % (mm) | \
         overlap | s a frame |\n|---|---|---|---|---|---|---|\n",
    );
    for s in &studies {
        let [first, others, most, last] = s.joints_mm;
        let [surface, surfaces, far] = s.surface_mm;
        text += &format!(
            "| {}, {} | {}, {} | {}, {} | {first:.1}, {others:.1}, {most:.1}, {last:.1} | {surface:.1}, {surfaces:.1}, {far:.1} | \
             {:.3} | {:.2} |\n",
            s.family,
            named(s.cameras, s.opposite),
            s.people,
            s.lost,
            s.frames,
            s.lost_frames,
            s.agreement,
            s.seconds
        );
    }
    terminal::print(&text)
}

/// Cameras by name.
fn named(cameras: usize, opposite: bool) -> String {
    format!("{cameras} cameras{}", if opposite { " evenly all round" } else { "" })
}

fn table(studies: &[SilhouetteStudy]) -> String {
    let mut text = String::new();
    for s in studies {
        text += &format!(
            "\n{}, {}: {} people, {} lost, sex right for {:.0} %, overlap {:.3}, {:.1} s a person; girths {:.1} mm, of the trunk at the same \
             heights {:.1} mm; chi square {:.2}\n\n| measure | bias | mean absolute | 95 % | stated sigma | chi square | within 1, 2 sigma | missing |\n\
             |---|---|---|---|---|---|---|---|\n",
            s.family,
            named(s.cameras, s.opposite),
            s.people,
            s.lost,
            100.0 * s.sex_right,
            s.agreement,
            s.seconds,
            s.girths_mm,
            s.same_height_mm,
            s.chi_square
        );
        for m in s.measures.iter().filter(|m| m.people > 0) {
            text += &format!(
                "| {} | {:+.1} | {:.1} | {:.1} | {:.1} | {:.2} | {:.0}, {:.0} % | {:.1} |\n",
                m.measure.replace('_', " "),
                m.bias_mm,
                m.mean_absolute_mm,
                m.p95_mm,
                m.sigma_mm,
                m.chi_square,
                100.0 * m.within[0],
                100.0 * m.within[1],
                m.missing_mm
            );
        }
    }
    text
}
