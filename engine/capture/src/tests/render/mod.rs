//! Pictures of a surface with a print on it: the truth that captures are held against.

mod print;
mod scene;
mod sensor;
pub mod tests;

pub use print::Print;
pub use scene::{Bar, Lighting, PrintedSurface, look_at};
pub use sensor::{Sensor, take};
