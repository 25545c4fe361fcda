//! `toile pareto`: speed against error.

use std::path::PathBuf;
use toile_assets::put_line;

use clap::builder::PossibleValuesParser;
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::terminal::{self, Paint, Tone};
use toile_perf::pareto::{self, ParetoOptions, ParetoReport, Point, SCENES, SceneReport};

/// Plot speed against error over the cloth's settings, and report which are best.
///
/// Runs scenes under many settings (solvers, substeps, qualities, meshes, one and two threads), times a step of each and
/// measures how far it ends from x*, the converged solution. Writes an HTML report, plots as PNG and a table of all points as
/// CSV. docs/pareto.md describes x*.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see which settings of the skirt are worth their time\n  toile pareto skirt --out plots"
)]
pub struct ParetoArgs {
    /// The one scene to measure (default: all)
    #[arg(value_name = "SCENE", value_parser = PossibleValuesParser::new(SCENES))]
    pub scene: Option<String>,
    /// Folder for the files; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out/pareto")]
    pub out: PathBuf,
    /// Few settings of small meshes: a look at whether it works
    #[arg(long)]
    pub quick: bool,
    #[command(flatten)]
    printing: Printing,
}

/// Units of the progress bar.
const UNITS: f64 = 1_000.0;

/// Runs `toile pareto`.
///
/// # Errors
/// An output folder that cannot be written, a closed stdout.
pub fn run(args: &ParetoArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let mut out = OutputFolder::prepare(&args.out)?;
    let bar = words.bar(UNITS as u64, "measuring");
    let progress = |part: f64| bar.set_position((UNITS * part) as u64);
    let options = ParetoOptions { scene: args.scene.clone(), quick: args.quick };
    let report = pareto::run(&options, &progress).map_err(AppError::internal)?;
    bar.finish_and_clear();
    for file in pareto::files(&report).map_err(AppError::internal)? {
        out.write(&file.name, &file.bytes)?;
    }
    let files = out.commit()?;
    if args.printing.json {
        return terminal::print_json(&Document::new("pareto", report));
    }
    words.print_line(&format!("{} files in {}", files.len(), args.out.display()));
    terminal::print(&table(&report, Paint::for_stdout()))
}

/// The fronts as people read them.
fn table(report: &ParetoReport, paint: Paint) -> String {
    let mut text = String::new();
    for scene in report.scenes.iter().filter(|s| s.main) {
        fronts(&mut text, report, scene, paint);
    }
    text
}

fn fronts(text: &mut String, report: &ParetoReport, scene: &SceneReport, paint: Paint) {
    let title = format!("{}, {}, {} particles, one thread", scene.scene, scene.mesh, scene.particles);
    put_line!(text, "{}", paint.tone(&title, Tone::Strong));
    put_line!(text, "  x*: {}; itself uncertain by about {:.3} mm", scene.reference, scene.reference_gap_mm);
    put_line!(text, "  {:>9} {:>9} {:>9} {:>9}  setting", "step us", "mean mm", "max mm", "strain %");
    let mine = |p: &&Point| p.scene == scene.scene && p.mesh == scene.mesh && p.threads == 1;
    let mut front: Vec<&Point> = report.points.iter().filter(mine).filter(|p| p.on_front).collect();
    front.sort_by(|a, b| a.step_us.total_cmp(&b.step_us));
    front.iter().for_each(|p| put_line!(text, "{}", row(p)));
    for own in report.points.iter().filter(mine).filter(|p| p.default && p.quality == "shop") {
        let (verdict, tone) =
            if own.on_front { ("on the front", Tone::Good) } else { ("not on the front", Tone::Warn) };
        let sentence = format!(
            "  the default, shop with {} substeps, is {verdict}: {:.0} us, {:.3} mm",
            own.substeps, own.step_us, own.error_mm
        );
        put_line!(text, "{}", paint.tone(&sentence, tone));
    }
    put_line!(text);
}

fn row(p: &Point) -> String {
    let own = if p.default { ", its own substeps" } else { "" };
    format!(
        "  {:>9.1} {:>9.3} {:>9.2} {:>9.3}  {}, {}, {} substeps of {} passes{own}",
        p.step_us,
        p.error_mm,
        p.max_mm,
        100.0 * p.strain_mean,
        p.solver,
        p.quality,
        p.substeps,
        p.iterations
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_tells_the_front_and_whether_the_default_lies_on_it() {
        let point = |quality, error_mm, on_front, default| Point {
            scene: "skirt".into(),
            mesh: "grid".into(),
            solver: "mixed",
            quality,
            substeps: 4,
            iterations: 3,
            threads: 1,
            step_us: 123.4,
            error_mm,
            on_front,
            default,
            ..Point::default()
        };
        let scene = SceneReport { scene: "skirt".into(), mesh: "grid".into(), main: true, ..SceneReport::default() };
        let points = vec![point("fine", 0.25, true, false), point("shop", 9.87, false, true)];
        let report = ParetoReport { points, scenes: vec![scene], ..ParetoReport::default() };
        let text = table(&report, Paint::none());
        assert!(text.contains("0.250") && text.contains("mixed, fine, 4 substeps of 3 passes"), "{text}");
        assert!(text.contains("shop with 4 substeps, is not on the front: 123 us, 9.870 mm"), "{text}");
    }
}
