//! What stepped the cloth, where that is not what was asked for: one sentence on stderr, in JSON runs too.

use toile_perf::backend::SteppedBy;

use crate::terminal::Words;

/// Says why the processor stepped although a device was asked for, if it did.
pub fn say(by: &SteppedBy) {
    if let Some(reason) = &by.fallen {
        Words::new(false).say(&format!("the processor steps: {reason}"));
    }
}
