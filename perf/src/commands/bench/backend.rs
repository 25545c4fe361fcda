//! What stepped the cloth, where that is not what was asked for: one sentence on stderr, in JSON runs too.

use toile_cli::terminal::Words;
use toile_perf::backend::SteppedBy;

/// Prints why the processor stepped although a device was asked for, if it did.
pub fn print_fallback(by: &SteppedBy) {
    if let Some(reason) = &by.fallen {
        Words::new(false).print_line(&format!("the processor steps: {reason}"));
    }
}
