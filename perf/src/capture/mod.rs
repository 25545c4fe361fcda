//! Capture from several cameras, against surfaces whose motion is known.
//!
//! Reads: the engine's own cloth and skirt, drawn with a print before virtual cameras. Writes: distances from the truth, times, a contact sheet.
//! Budget: a minute or two a row of 120 frames; never inside the frame.
//! Thread: the caller's, and one for each camera that is drawn.

pub mod cloth;
pub mod error;
pub mod flow;
pub mod sheet;
pub mod silhouettes;

pub mod followed;
