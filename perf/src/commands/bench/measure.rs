//! `toile bench measure`: synthetic people are measured, and compared with their true measures.

use std::fmt::Write;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use serde::Serialize;
use toile_base::body::Sex;
use toile_cli::arguments::{Printing, count};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Paint, Tone};
use toile_perf::ansur::Survey;
use toile_perf::measuring::{
    self, CrossedMeasure, Family, MeasuredPerson, MeasuringAgreement, MeasuringOptions, MeasuringStudy, Sensor,
    StatedDecile, crossed, reliability,
};
use toile_view::contact_sheet::contact_sheet;
use toile_view::image::Image;
use toile_view::plot::axis::Axis;
use toile_view::plot::chart::{Chart, Series, SeriesStyle};
use toile_view::plot::svg;
use toile_view::plot::{BLACK, SERIES_COLOURS};

/// Most people of a file that are measured: more than any survey has.
const MAX_PEOPLE: u64 = 100_000;

/// Most frames of one person: ten seconds.
const MAX_FRAMES: u64 = 300;

/// The word for every camera.
const BOTH: &str = "both";

/// Measure synthetic people before synthetic cameras, and report the errors.
///
/// Draws random people of ANSUR II, gives each a shape of their own, renders a second of them swaying before a Kinect v1 at 2
/// to 3 m and before a camera like the Azure Kinect at 2 to 2.5 m, and measures them by the body fit.
/// Limits are those of ISO 20685 for the mean error; it is synthetic agreement, not accuracy on people. An
/// interval beyond its limit makes the exit code 3.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: ten women before the better camera\n  toile bench measure --ansur ANSUR_II_FEMALE.csv \
                        --people 10 --sensor azure"
)]
pub struct MeasureBenchArgs {
    /// A file of ANSUR II, such as ANSUR_II_FEMALE.csv; repeat it for the other sex
    #[arg(long = "ansur", value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// A folder of MakeHuman's base mesh hm08: people of that family are measured too
    #[arg(long, value_name = "FOLDER")]
    makehuman: Option<PathBuf>,
    /// People drawn from each file, and of each family
    #[arg(long, value_name = "N", value_parser = count(2..=MAX_PEOPLE), default_value = "100")]
    people: usize,
    /// Frames that each is measured from, at 30 Hz
    #[arg(long, value_name = "F", value_parser = count(1..=MAX_FRAMES), default_value = "30")]
    frames: usize,
    /// Camera
    #[arg(long, value_name = "S", value_parser = PossibleValuesParser::new(cameras()), default_value = BOTH)]
    sensor: String,
    /// They turn all round after that, and are measured once more: three seconds a person
    #[arg(long)]
    turn: bool,
    /// Folder for reliability.svg (how often a girth lay within half a size, against how probable that was stated) and
    /// surfaces.png: two women and two men of the other family, true and as they were measured
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Which people are drawn, and how they stand
    #[arg(long, value_name = "S", default_value = "1")]
    seed: u64,
    #[command(flatten)]
    printing: Printing,
}

/// The cameras that there are.
const SENSORS: [Sensor; 2] = [Sensor::Kinect, Sensor::Azure];

fn cameras() -> Vec<&'static str> {
    SENSORS.map(Sensor::name).into_iter().chain([BOTH]).collect()
}

impl MeasureBenchArgs {
    /// The cameras that people are measured by.
    fn sensors(&self) -> impl Iterator<Item = Sensor> {
        SENSORS.into_iter().filter(|s| self.sensor == BOTH || self.sensor == s.name())
    }
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct MeasureBenchReport {
    /// The seed by which people were drawn.
    seed: u64,
    /// One study a family and camera.
    studies: Vec<MeasuringStudy>,
    /// How the stated errors of each family hold, calibrated by the other; empty with one family.
    crossed: Vec<CrossedFamily>,
    /// How often a girth lay within half a size of the truth, against how probable that was stated.
    reliability: Vec<StatedDecile>,
}

/// How one family's stated errors hold.
#[derive(Debug, Serialize)]
struct CrossedFamily {
    /// The family that is judged.
    family: &'static str,
    /// Measure by measure.
    measures: Vec<CrossedMeasure>,
}

/// People of each sex whose surfaces are drawn.
const DRAWN: usize = 2;

/// Pictures of the first people's surfaces.
#[derive(Default)]
struct SurfacePictures {
    drawn: Vec<Image>,
    /// How many of them are of each sex, women first.
    count: [usize; 2],
}

impl SurfacePictures {
    fn add(&mut self, person: &MeasuredPerson) {
        let count = &mut self.count[usize::from(person.sex == Sex::Male)];
        if let Some(surfaces) = person.surfaces.as_ref().filter(|_| *count < DRAWN) {
            *count += 1;
            self.drawn.push(surfaces.picture());
        }
    }

    /// All of them under each other.
    fn sheet(&self) -> Image {
        contact_sheet(&self.drawn.iter().collect::<Vec<_>>(), 1, &[])
    }
}

/// Each family judged by the other.
fn cross(studies: &[MeasuringStudy]) -> Vec<CrossedFamily> {
    let of = |family: &str| -> Vec<&MeasuringStudy> { studies.iter().filter(|s| s.family == family).collect() };
    let names: Vec<&'static str> = studies.iter().map(|s| s.family).collect();
    let (Some(&first), Some(&second)) = (names.first(), names.iter().find(|n| **n != names[0])) else {
        return Vec::new();
    };
    let pairs = [(first, second), (second, first)];
    pairs.map(|(by, family)| CrossedFamily { family, measures: crossed(&of(by), &of(family)) }).into()
}

/// Runs `toile bench measure`.
///
/// # Errors
/// [`AppError::Input`] for a file that is no survey; [`AppError::Threshold`] where the body fit misses a limit, after
/// the tables.
pub fn run(args: &MeasureBenchArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let surveys: Vec<Survey> =
        args.files.iter().map(|f| Survey::read(f)).collect::<Result<_, _>>().map_err(AppError::input)?;
    let mut studies = Vec::new();
    let mut pictures = SurfacePictures::default();
    let families = [Family::Survey].into_iter().chain(args.makehuman.clone().map(Family::Makehuman));
    for (family, sensor) in families.flat_map(|family| args.sensors().map(move |sensor| (family.clone(), sensor))) {
        let all: usize = surveys.iter().map(|s| args.people.min(s.people())).sum();
        let bar = words.bar(all as u64, "measuring people");
        let MeasureBenchArgs { people, frames, seed, turn, .. } = *args;
        let surfaces = args.out.is_some();
        let options = MeasuringOptions { family, people, frames, seed, sensor, turn, surfaces };
        let study = measuring::study(&surveys, &options, &mut |person| {
            bar.inc(1);
            pictures.add(person);
        });
        studies.push(study.map_err(AppError::input)?);
        bar.finish_and_clear();
    }
    let missed: Vec<String> = studies.iter().flat_map(missed).collect();
    let paint = Paint::for_stdout();
    let mut text: Vec<String> = studies.iter().map(|s| table(s, paint)).collect();
    let crossed = cross(&studies);
    text.extend(crossed.iter().map(|c| crossed_table(c, paint)));
    let all: Vec<&MeasuringStudy> = studies.iter().collect();
    let reliability = reliability(&all, args.turn);
    if let Some(dir) = &args.out {
        let mut out = OutputFolder::prepare(dir).map_err(AppError::input)?;
        out.write("reliability.svg", diagram(&reliability).as_bytes()).map_err(AppError::input)?;
        if !pictures.drawn.is_empty() {
            write_png(&mut out, "surfaces.png", &pictures.sheet())?;
        }
        out.commit().map_err(AppError::input)?;
    }
    if args.printing.json {
        let report = MeasureBenchReport { seed: args.seed, studies, crossed, reliability };
        terminal::print_json(&Document::new("bench-measure", report))?;
    } else {
        terminal::print(&text.join("\n"))?;
    }
    match missed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!("the body fit misses the limit of ISO 20685: {}", missed.join(", ")))),
    }
}

/// Measures whose interval is not inside the limit.
fn missed(study: &MeasuringStudy) -> Vec<String> {
    study
        .fit
        .iter()
        .filter(|a| !a.pass)
        .map(|a| format!("{} ({}, {})", a.measure, study.family, study.sensor))
        .collect()
}

/// One study as people read it.
fn table(study: &MeasuringStudy, paint: Paint) -> String {
    let mut text = String::new();
    let title = format!("{}, {}: {} people, {} frames each", study.family, study.sensor, study.people, study.frames);
    let _ = writeln!(text, "{}", paint.tone(&title, Tone::Strong));
    for (way, rows) in [("body fit", &study.fit), ("body fit, turned", &study.turned)] {
        if rows.is_empty() {
            continue;
        }
        let _ = writeln!(
            text,
            "{:<26} {:>6} {:>6} {:>7} {:>17} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6}",
            format!("{way} (mm)"),
            "taken",
            "limit",
            "bias",
            "95 % interval",
            "mean",
            "%",
            "95 %",
            "sigma",
            "in 1s",
            "in 2s"
        );
        for row in rows {
            let _ = writeln!(text, "{}", row_text(row, paint));
        }
    }
    let _ = writeln!(
        text,
        "no body was found in {} of {}; the sex taken for likelier was right in {:.1} %; no other person was seen in {:.1} % of the frames",
        study.lost,
        study.people,
        study.sex_right * 100.0,
        study.alone * 100.0
    );
    for (view, sizes) in ["from the front", "turned"].into_iter().zip(&study.sizes).filter(|(_, s)| s.people > 0) {
        let _ = writeln!(
            text,
            "sizes {view}: {:.0} % right where {:.0} % were stated; {:.0} % of the {} at least 10 mm from a border",
            sizes.right * 100.0,
            sizes.stated * 100.0,
            sizes.inside_right * 100.0,
            sizes.inside
        );
    }
    let f = &study.following;
    let _ = writeln!(
        text,
        "following: {:.1} ms a frame (median), {:.1} ms (95 %): picture {:.1}, matches {:.1}, equations {:.1}, solution {:.1} \
         ms; {:.0} ms to find a person; surface {:.1} mm and joints {:.0} mm off; measures from the front in {:.0} ms, and after a \
         turn in {:.0} ms",
        f.frame_ms[0],
        f.frame_ms[1],
        f.stages_ms[0],
        f.stages_ms[1],
        f.stages_ms[2],
        f.stages_ms[3],
        f.start_ms,
        f.off_mm,
        f.joints_mm,
        f.measure_ms[0],
        f.measure_ms[1]
    );
    text
}

fn row_text(a: &MeasuringAgreement, paint: Paint) -> String {
    let interval = format!("{:+.1} .. {:+.1}", a.interval_mm[0], a.interval_mm[1]);
    let line = format!(
        "  {:<24} {:>6} {:>6.0} {:>+7.1} {:>17} {:>7.1} {:>7.2} {:>7.1} {:>7.1} {:>5.0}% {:>5.0}%",
        a.measure,
        a.taken,
        a.limit_mm,
        a.bias_mm,
        interval,
        a.mean_absolute_mm,
        a.mean_absolute_percent,
        a.p95_mm,
        a.sigma_mm,
        a.within_one_sigma * 100.0,
        a.within_two_sigma * 100.0
    );
    paint.tone(&line, if a.pass { Tone::Good } else { Tone::Warn }).into_owned()
}

/// One family's stated errors, calibrated by the other, as people read them.
fn crossed_table(crossed: &CrossedFamily, paint: Paint) -> String {
    let title = format!("stated errors of {}: calibrated by the other family, and as they ship", crossed.family);
    let mut text = format!("{}\n", paint.tone(&title, Tone::Strong));
    let _ = writeln!(
        text,
        "  {:<18} {:<7} {:>9} {:>7} {:>7} {:>9} {:>7} {:>7}",
        "measure", "view", "other mm", "in 1s", "in 2s", "ships mm", "in 1s", "in 2s"
    );
    for m in &crossed.measures {
        let percent = |share: f64| format!("{:.0}%", share * 100.0);
        let _ = writeln!(
            text,
            "  {:<18} {:<7} {:>9.1} {:>7} {:>7} {:>9.1} {:>7} {:>7}",
            m.measure,
            if m.turned { "turned" } else { "front" },
            m.other_mm,
            percent(m.other_within[0]),
            percent(m.other_within[1]),
            m.ships_mm,
            percent(m.ships_within[0]),
            percent(m.ships_within[1])
        );
    }
    text
}

/// The reliability diagram: how often it held against how probable it was stated; the diagonal is honesty.
fn diagram(bins: &[StatedDecile]) -> String {
    let share = |label: &'static str| Axis { label, log: false, range: [0.0, 1.0] };
    let honest = Series {
        name: "honest".to_owned(),
        points: vec![[0.0, 0.0], [1.0, 1.0]],
        style: SeriesStyle { dashed: true, ..SeriesStyle::line(BLACK, 1.0) },
    };
    let found = Series {
        name: "found, by deciles".to_owned(),
        points: bins.iter().map(|b| [b.stated, b.held]).collect(),
        style: SeriesStyle::joined(SERIES_COLOURS[0]),
    };
    let chart = Chart {
        title: "girths within half a size (20 mm) of the truth".to_owned(),
        x: share("stated probability"),
        y: share("how often it held"),
        series: vec![honest, found],
        rules: Vec::new(),
    };
    svg::text(&chart.draw())
}
