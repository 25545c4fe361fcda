//! `toile bench`: what one part of the frame costs, with the error at that speed.

use toile_perf::{skinning, yardstick};

use crate::cli::SkinningArgs;
use crate::exit::AppError;
use crate::report::{Document, SkinningReport};
use crate::summary;
use crate::terminal::{self, Paint};

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
