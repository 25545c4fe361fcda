//! `toile bench`: what one part of the frame costs, with the error at that speed.

use stats_alloc::INSTRUMENTED_SYSTEM;
use toile_perf::skirt::heap::{Heap, HeapProbe};
use toile_perf::skirt::{self, SkirtError, table};
use toile_perf::{skinning, yardstick};

use crate::cli::{SkinningArgs, SkirtArgs};
use crate::exit::AppError;
use crate::report::{Document, SkinningReport};
use crate::summary;
use crate::terminal::{self, Paint, Words};

/// Runs `toile bench skinning`.
///
/// # Errors
/// Only where stdout cannot be written.
pub fn skinning(args: &SkinningArgs) -> Result<(), AppError> {
    let found = skinning::measure(args.verts).map_err(AppError::internal)?;
    let report = SkinningReport {
        verts: found.verts,
        us: found.us,
        ns_per_vertex: found.ns_per_vertex,
        yardstick_us: found.yardstick_us,
        yardstick_verts: yardstick::VERTICES,
        max_error_m: found.max_error_m,
    };
    if args.json {
        return terminal::print_json(&Document::new("bench-skinning", report));
    }
    terminal::print(&summary::skinning(&report, Paint::for_stdout()))
}

/// Runs `toile bench skirt`.
///
/// # Errors
/// Where this machine or the engine cannot do what was asked for, and where stdout cannot be written.
pub fn skirt(args: &SkirtArgs) -> Result<(), AppError> {
    let heap = HeapProbe::new(heap);
    if args.table {
        let words = Words::new(args.json);
        let table = table::run(&args.options, &heap, &mut |case| words.say(case));
        if args.json {
            return terminal::print_json(&Document::new("bench-skirt-table", table));
        }
        return terminal::print(&table.markdown());
    }
    let report = skirt::measure(&args.options, &heap).map_err(refused)?;
    if args.json {
        return terminal::print_json(&Document::new("bench-skirt", report));
    }
    terminal::print(&summary::skirt(&report, Paint::for_stdout()))
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
