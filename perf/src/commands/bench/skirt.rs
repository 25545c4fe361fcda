//! `toile bench skirt`: the cloth in the scene that Toile and its peers share.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::value_parser;
use toile_assets::drafting;
use toile_assets::scene::skirt::{SkirtMotion, Stretch};
use toile_cli::arguments::{count, one_of, quality};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::heap;
use toile_cli::output::OutputFolder;
use toile_cli::terminal::{self, Paint, Words};
use toile_engine::cloth::Quality;
use toile_engine::lanes::Width;
use toile_fitting::heap::HeapProbe;
use toile_gpu::backend::Backend;
use toile_perf::crossover;
use toile_perf::skirt::options::{MAX_GARMENTS, SkirtMesh, SkirtOptions};
use toile_perf::skirt::{self, SkirtError};
use toile_perf::turns::{self, TurnCase, TurnsError};
use toile_perf::worn::{self, WornError, WornOptions};
use toile_view::plot::raster;

use super::{backend, skirt_summary, worn_summary};
use crate::commands::arguments::{BackendArg, lanes};

/// Most vertices: 512 a side.
const MAX_VERTS: u64 = 1 << 18;

/// Turns of a comparison with another build, of which the median is reported.
const TURNS: usize = 7;

/// Most steps a run, an hour of the scene.
const MAX_STEPS: u64 = 432_000;

/// Time the cloth in the scene that Toile and its peers share, with strain and penetration.
///
/// Steps the benchmark's skirt on a moving body: 240 steps to warm up, then runs of which the median is reported. Time,
/// strain, penetration and all else come from the same steps; only the step itself is timed.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: the cost and the error of a walk in a skirt of 16,384 vertices\n  toile bench skirt \
                        --verts 16384 --motion walk")]
pub struct SkirtArgs {
    /// Vertices, a square: 1024, 4096, 16384
    #[arg(long, value_name = "N", value_parser = count(64..=MAX_VERTS), default_value = "4096")]
    verts: usize,
    /// What the body does
    #[arg(
        long,
        value_name = "M",
        value_parser = one_of(SkirtMotion::ALL, SkirtMotion::name),
        default_value = "walk"
    )]
    motion: SkirtMotion,
    /// How the skirt is meshed
    #[arg(long, value_name = "M", value_parser = one_of(SkirtMesh::ALL, SkirtMesh::name), default_value = "grid")]
    mesh: SkirtMesh,
    /// How its threads stretch: not at all, or 2000 N/m
    #[arg(
        long,
        value_name = "S",
        value_parser = one_of(Stretch::ALL, Stretch::name),
        default_value = "inextensible"
    )]
    stretch: Stretch,
    /// With friction in bending: the loops of a wool tropical
    #[arg(long)]
    hysteresis: bool,
    /// With stretch of two slopes and shear that rubs and locks
    #[arg(long)]
    curves: bool,
    /// With threads that give way where they are pushed together; of `--stretch physical` or `--curves`, for what does not stretch
    /// cannot
    #[arg(long)]
    buckling: bool,
    /// Wind of (1, 0, 0.5) m/s with drag 0.1 and lift 0.05
    #[arg(long)]
    wind: bool,
    /// Keep the skirt from passing through itself, and count the edges that do all the same; the processor's
    #[arg(long = "self", conflicts_with_all = ["garment", "table", "backend"])]
    folds: bool,
    /// Threads that step, 1 or 2
    #[arg(long, value_name = "T", value_parser = count(1..=2), default_value = "1")]
    threads: usize,
    /// Step this garment of the wardrobe on a performing mannequin in place of the skirt; again for an outfit
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(drafting::names()),
          conflicts_with_all = ["verts", "motion", "mesh", "stretch", "hysteresis", "curves", "buckling", "wind", "garments",
                                 "table"])]
    garment: Vec<String>,
    /// With several garments: let them pass through each other
    #[arg(long, requires = "garment")]
    no_layers: bool,
    /// With a garment: let it pass through itself
    #[arg(long, requires = "garment")]
    no_folds: bool,
    /// With a garment: let it lie on the body's cones, not on the skin that is seen. A device steps a garment only without all three
    #[arg(long, requires = "garment")]
    no_skin: bool,
    /// Skirts to step, equal ones
    #[arg(long, value_name = "K", value_parser = count(1..=MAX_GARMENTS as u64), default_value = "1")]
    garments: usize,
    /// Lanes of the kernels (default: the widest of this processor)
    #[arg(long, value_name = "L", value_parser = lanes())]
    lanes: Option<Width>,
    /// Tested settings: draft, shop or fine (default: the engine's own)
    #[arg(long, value_name = "Q", value_parser = quality())]
    quality: Option<Quality>,
    /// Substeps of a step (default: the engine's own)
    #[arg(long, value_name = "S", value_parser = value_parser!(u32).range(1..=1_000))]
    substeps: Option<u32>,
    /// Runs of which the median is reported
    #[arg(long, value_name = "R", value_parser = count(1..=1_000), default_value = "5")]
    runs: usize,
    /// Steps of a run
    #[arg(long, value_name = "S", value_parser = count(1..=MAX_STEPS), default_value = "600")]
    steps: usize,
    #[command(flatten)]
    backend: BackendArg,
    /// With --backend gpu or auto: sizes and numbers of skirts on the processor and on the device, and where they cross, with
    /// threads, sizes and steps of its own; takes some minutes. With --stages: sixteen cases
    #[arg(long)]
    table: bool,
    /// With --table of a device: write the chart crossover.png there
    #[arg(long, value_name = "FOLDER", requires = "table")]
    picture: Option<PathBuf>,
    /// The time of each stage of what is asked for; with --table, of sixteen cases of the skirt and the wardrobe: some minutes
    #[arg(long, conflicts_with = "backend")]
    stages: bool,
    /// With --stages: another build of this program, to be run in turn with this one
    #[arg(long, value_name = "BINARY", requires = "stages")]
    against: Option<PathBuf>,
    /// With --stages: how often each program runs, of which the median is reported (default: 1, with --against 7)
    #[arg(long, value_name = "N", value_parser = count(1..=100), requires = "stages")]
    turns: Option<usize>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    json: bool,
}

impl SkirtArgs {
    /// The run.
    ///
    /// # Errors
    /// [`AppError::Usage`] for a picture of a table that has none.
    fn options(&self) -> Result<SkirtOptions, AppError> {
        if self.picture.is_some() && self.backend.choice == Backend::Cpu {
            let words = "`--picture` draws the table of a device; add `--backend gpu` or leave it out";
            return Err(AppError::Usage(words.to_owned()));
        }
        Ok(SkirtOptions {
            verts: self.verts,
            motion: self.motion,
            mesh: self.mesh,
            stretch: self.stretch,
            hysteresis: self.hysteresis,
            curves: self.curves,
            buckling: self.buckling,
            wind: self.wind,
            folds: self.folds,
            threads: self.threads,
            garments: self.garments,
            lanes: self.lanes,
            quality: self.quality,
            substeps: self.substeps,
            runs: self.runs,
            steps: self.steps,
            backend: self.backend.choice,
            ..SkirtOptions::default()
        })
    }

    /// The one case that is asked for, by its options.
    fn case(&self) -> TurnCase {
        let (mut name, mut options) = (self.garment.join(" over "), Vec::new());
        let mut give = |option: &str, value: String| options.extend([format!("--{option}"), value]);
        self.garment.iter().for_each(|g| give("garment", g.clone()));
        if self.garment.is_empty() {
            name = format!("{} vertices ({}), {}", self.verts, self.mesh.name(), self.motion.name());
            give("verts", self.verts.to_string());
            give("motion", self.motion.name().to_owned());
            give("mesh", self.mesh.name().to_owned());
            give("stretch", self.stretch.name().to_owned());
            give("garments", self.garments.to_string());
        }
        give("threads", self.threads.to_string());
        self.lanes.into_iter().for_each(|l| give("lanes", l.to_string()));
        self.quality.into_iter().for_each(|q| give("quality", q.name().to_owned()));
        self.substeps.into_iter().for_each(|s| give("substeps", s.to_string()));
        options.extend(self.hysteresis.then(|| "--hysteresis".to_owned()));
        options.extend(self.curves.then(|| "--curves".to_owned()));
        options.extend(self.buckling.then(|| "--buckling".to_owned()));
        options.extend(self.wind.then(|| "--wind".to_owned()));
        options.extend(self.folds.then(|| "--self".to_owned()));
        TurnCase { name, options }
    }

    /// The run of garments on a mannequin.
    fn worn(&self) -> WornOptions {
        WornOptions {
            garments: self.garment.clone(),
            threads: self.threads,
            lanes: self.lanes,
            quality: self.quality,
            substeps: self.substeps,
            runs: self.runs,
            layers: !self.no_layers,
            skin: !self.no_skin,
            folds: !self.no_folds,
            steps: self.steps,
            backend: self.backend.choice,
        }
    }
}

/// Runs `toile bench skirt`.
///
/// # Errors
/// Where this machine or the engine cannot do what was asked for, and where stdout cannot be written.
pub fn run(args: &SkirtArgs) -> Result<(), AppError> {
    let options = args.options()?;
    let heap = HeapProbe::new(heap::counted);
    if args.stages {
        return stages(args);
    }
    if !args.garment.is_empty() {
        let report = worn::measure(&args.worn(), &heap).map_err(not_worn)?;
        backend::print_fallback(&report.stepped_by);
        if args.json {
            return terminal::print_json(&Document::new("bench-worn", report));
        }
        return terminal::print(&worn_summary::summary(&report, Paint::for_stdout()));
    }
    if args.table && options.backend != Backend::Cpu {
        return crossover(args, &options);
    }
    if args.table {
        let words = "`--table` lists sizes on a device, or stages; add `--backend gpu` or `--stages`";
        return Err(AppError::Usage(words.to_owned()));
    }
    let report = skirt::measure(&options, &heap).map_err(refused)?;
    backend::print_fallback(&report.stepped_by);
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt", report));
    }
    terminal::print(&skirt_summary::summary(&report, Paint::for_stdout()))
}

/// Times of the stages, in turn with another build where one is given.
fn stages(args: &SkirtArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let cases = if args.table { TurnCase::all() } else { vec![args.case()] };
    let turns = args.turns.unwrap_or(if args.against.is_some() { TURNS } else { 1 });
    let against = args.against.as_deref();
    let table = turns::run(&cases, against, [turns, args.steps], &mut |case| words.print_line(case));
    let table = table.map_err(|error| match error {
        TurnsError::Own(_) => AppError::internal(error),
        TurnsError::Start { .. } => AppError::Usage(error.to_string()),
    })?;
    if args.json && args.table {
        return terminal::print_json(&Document::new("bench-skirt-stages", table));
    }
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt-stages", table.only().map_err(AppError::Usage)?));
    }
    terminal::print(&table.markdown())
}

/// Sizes and numbers of skirts on the processor and on a device.
fn crossover(args: &SkirtArgs, options: &SkirtOptions) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let mut out = args.picture.as_deref().map(OutputFolder::prepare).transpose()?;
    let study = crossover::run(options, usize::MAX, &mut |case| words.print_line(case)).map_err(refused)?;
    backend::print_fallback(&study.stepped_by);
    if let Some(out) = &mut out {
        let mut png = Vec::new();
        raster::image(&crossover::chart(&study)).write_png(&mut png).map_err(AppError::internal)?;
        out.write("crossover.png", &png)?;
    }
    let files = out.map(OutputFolder::commit).transpose()?;
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt-crossover", study));
    }
    files.iter().flatten().for_each(|file| words.print_line(&file.display().to_string()));
    terminal::print(&study.markdown())
}

fn refused(error: SkirtError) -> AppError {
    match error {
        SkirtError::NotSquare { .. } => AppError::Usage(format!("{error}; see `toile bench skirt --help`")),
        SkirtError::Unsupported { .. } | SkirtError::NoSuchLanes { .. } | SkirtError::WorkerPool(_) => {
            AppError::Device(error.to_string())
        }
        SkirtError::Mesh(_) | SkirtError::Colliders(_) | SkirtError::Body(_) => AppError::internal(error),
    }
}

fn not_worn(error: WornError) -> AppError {
    match error {
        WornError::TooMany { .. } => AppError::Usage(format!("{error}; see `toile bench skirt --help`")),
        WornError::NoSuchLanes { .. } | WornError::WorkerPool(_) => AppError::Device(error.to_string()),
        _ => AppError::internal(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::arguments::parsed;

    fn options(line: &str) -> Result<SkirtOptions, AppError> {
        parsed::<SkirtArgs>(line).unwrap().options()
    }

    #[test]
    fn the_defaults_are_the_scenes_protocol() {
        assert_eq!(options("skirt").unwrap(), SkirtOptions::default());
    }

    #[test]
    fn a_skirt_against_itself_is_the_processors() {
        let expected = SkirtOptions { folds: true, ..SkirtOptions::default() };
        assert_eq!(options("skirt --self").unwrap(), expected);
        for wrong in ["--self --backend gpu", "--self --garment tee", "--self --table"] {
            assert!(parsed::<SkirtArgs>(&format!("skirt {wrong}")).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_option_arrives() {
        let found = options(
            "skirt --verts 1024 --motion fast --mesh irregular --stretch physical --wind --threads 2 --garments 3 \
             --lanes 8 --quality fine --substeps 6 --runs 2 --steps 60 --backend gpu --table --picture out --json",
        );
        let expected = SkirtOptions {
            verts: 1_024,
            motion: SkirtMotion::Fast,
            mesh: SkirtMesh::Irregular,
            stretch: Stretch::Physical,
            wind: true,
            threads: 2,
            garments: 3,
            lanes: Some(Width::Eight),
            quality: Some(Quality::Fine),
            substeps: Some(6),
            runs: 2,
            steps: 60,
            backend: Backend::Gpu,
            ..SkirtOptions::default()
        };
        assert_eq!(found.unwrap(), expected);
        assert!(options("skirt --table --picture out").is_err(), "there is no chart of the processor alone");
    }

    #[test]
    fn a_case_asks_another_build_for_the_same() {
        let line = "skirt --verts 1024 --motion fast --mesh irregular --stretch physical --wind --threads 2 --lanes 8 \
                    --quality fine --substeps 6";
        let case = parsed::<SkirtArgs>(line).unwrap().case();
        let again = format!("skirt {}", case.options.join(" "));
        assert_eq!(options(&again).unwrap(), options(line).unwrap());
        let worn = parsed::<SkirtArgs>("skirt --garment tee --garment wide-leg-trousers --threads 2").unwrap();
        let again = parsed::<SkirtArgs>(&format!("skirt {}", worn.case().options.join(" "))).unwrap();
        assert_eq!((again.worn(), again.case().name), (worn.worn(), "tee over wide-leg-trousers".to_owned()));
        for (_, options) in turns::CASES {
            assert!(parsed::<SkirtArgs>(&format!("skirt {}", options.join(" "))).is_ok(), "{options:?}");
        }
        assert!(parsed::<SkirtArgs>("skirt --against old").is_err(), "there is nothing to lay side by side");
    }
}
