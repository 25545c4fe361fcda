//! `toile bench`: what one part of the frame costs, with the error at that speed.

use std::collections::BTreeMap;
use std::path::Path;

use stats_alloc::INSTRUMENTED_SYSTEM;
use toile_gpu::stepper::Backend;
use toile_perf::crossover;
use toile_perf::depth;
use toile_perf::filters::{self, FiltersError};
use toile_perf::plot::raster;
use toile_perf::skinning::{self, BenchError};
use toile_perf::skirt::heap::{Heap, HeapProbe};
use toile_perf::skirt::{self, SkirtError, table};

use crate::backend;
use crate::cli::{DepthArgs, FiltersArgs, SkinningArgs, SkirtArgs};
use crate::exit::AppError;
use crate::output::OutputFolder;
use crate::pictures::write_png;
use crate::report::{Document, SkinningReport};
use crate::summary;
use crate::terminal::{self, Paint, Words};

/// Runs `toile bench depth`.
///
/// # Errors
/// Where the scene's people cannot be made, and where stdout cannot be written.
pub fn depth(args: &DepthArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let table = depth::run(&mut |case| words.say(case)).map_err(AppError::internal)?;
    if args.json {
        return terminal::print_json(&Document::new("bench-depth", table));
    }
    terminal::print(&table.markdown())
}

/// Runs `toile bench filters`.
///
/// # Errors
/// Where a recording cannot be read, and where stdout cannot be written.
pub fn filters(args: &FiltersArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let table = filters::table::run(args.data.as_deref(), args.table, &mut |case| words.say(case));
    let table = table.map_err(|error| match error {
        FiltersError::Source(error) => AppError::input(error),
        FiltersError::Body(error) => AppError::internal(error),
    })?;
    if args.json {
        return terminal::print_json(&Document::new("bench-filters", table));
    }
    terminal::print(&table.markdown())
}

/// Runs `toile bench skinning`.
///
/// # Errors
/// Where this machine cannot do what was asked for, and where stdout cannot be written.
pub fn skinning(args: &SkinningArgs) -> Result<(), AppError> {
    if let Some(folder) = &args.picture {
        return twist(folder, args.json);
    }
    if args.table {
        let words = Words::new(args.json);
        let table = skinning::table::run(&mut |case| words.say(case)).map_err(unskinned)?;
        if args.json {
            return terminal::print_json(&Document::new("bench-skinning-table", table));
        }
        return terminal::print(&table.markdown());
    }
    let report = SkinningReport::new(skinning::measure(&args.options).map_err(unskinned)?, args.blend);
    if args.json {
        return terminal::print_json(&Document::new("bench-skinning", report));
    }
    terminal::print(&summary::skinning(&report, Paint::for_stdout()))
}

/// Draws the twist test.
fn twist(folder: &Path, json: bool) -> Result<(), AppError> {
    let mut out = OutputFolder::prepare(folder)?;
    write_png(&mut out, "twist.png", &skinning::twist_picture().map_err(unskinned)?)?;
    let files = out.commit()?;
    if json {
        return terminal::print_json(&Document::new("bench-skinning-picture", BTreeMap::from([("files", files)])));
    }
    terminal::print(&format!("{}\n", files[0].display()))
}

fn unskinned(error: BenchError) -> AppError {
    match error {
        BenchError::NoSuchLanes(_) | BenchError::Crew(_) => AppError::Device(error.to_string()),
        BenchError::Body(_) | BenchError::Skin(_) => AppError::internal(error),
    }
}

/// Runs `toile bench skirt`.
///
/// # Errors
/// Where this machine or the engine cannot do what was asked for, and where stdout cannot be written.
pub fn skirt(args: &SkirtArgs) -> Result<(), AppError> {
    let heap = HeapProbe::new(heap);
    if args.table && args.options.backend != Backend::Cpu {
        return crossover(args);
    }
    if args.table {
        let words = Words::new(args.json);
        let table = table::run(&args.options, &heap, &mut |case| words.say(case));
        if args.json {
            return terminal::print_json(&Document::new("bench-skirt-table", table));
        }
        return terminal::print(&table.markdown());
    }
    let report = skirt::measure(&args.options, &heap).map_err(refused)?;
    backend::say(&report.stepped_by);
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt", report));
    }
    terminal::print(&summary::skirt(&report, Paint::for_stdout()))
}

/// Sizes and numbers of skirts on the processor and on a device.
fn crossover(args: &SkirtArgs) -> Result<(), AppError> {
    let words = Words::new(args.json);
    let mut out = args.picture.as_deref().map(OutputFolder::prepare).transpose()?;
    let study = crossover::run(&args.options, usize::MAX, &mut |case| words.say(case)).map_err(refused)?;
    backend::say(&study.stepped_by);
    if let Some(out) = &mut out {
        let mut png = Vec::new();
        raster::image(&crossover::chart(&study)).write_png(&mut png).map_err(AppError::internal)?;
        out.write("crossover.png", &png)?;
    }
    let files = out.map(OutputFolder::commit).transpose()?;
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt-crossover", study));
    }
    files.iter().flatten().for_each(|file| words.say(&file.display().to_string()));
    terminal::print(&study.markdown())
}

/// The heap as the program's allocator counts it.
pub(crate) fn heap() -> Heap {
    let s = INSTRUMENTED_SYSTEM.stats();
    Heap {
        allocations: (s.allocations + s.reallocations) as u64,
        live_bytes: s.bytes_allocated as i64 - s.bytes_deallocated as i64,
    }
}

fn refused(error: SkirtError) -> AppError {
    match error {
        SkirtError::NotSquare { .. } => AppError::Usage(format!("{error}; see `toile bench skirt --help`")),
        SkirtError::Unsupported { .. } | SkirtError::NoSuchLanes { .. } | SkirtError::Crew(_) => {
            AppError::Device(error.to_string())
        }
        SkirtError::Mesh(_) | SkirtError::Colliders(_) | SkirtError::Body(_) => AppError::internal(error),
    }
}
