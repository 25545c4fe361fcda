//! Pictures of a surface with a print on it: the truth that captures are held against.
//!
//! Reads: a surface, a camera, a print, a light. Writes: pictures as a camera would take them, with blur and noise.
//! Budget: offline; 0.1 s a picture of 800 x 800.
//! Thread: the caller's.

mod print;
mod scene;
mod sensor;
#[cfg(test)]
pub(crate) mod tests;

pub use print::Print;
pub use scene::{Bar, Lighting, PrintedSurface, look_at};
pub use sensor::{Sensor, take};
