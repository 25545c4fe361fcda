//! The shopper's own picture with the garment drawn on it: a mirror of a camera's picture, by the processor alone.
//!
//! Runs on the render thread: 15 ms a picture of 608 x 1080 on one core. After the first picture of a size it allocates nothing.
//!
//! The garment is drawn at the picture's own moment: `repose` brings the newest snapshot's cloth to the joints that were seen in that
//! very picture, so that nothing has to be predicted where the two have to agree.

// Modules in the order of the data.
mod canvas;
mod framing;
mod model;
mod rays;

mod garment_colour;
mod repose;

mod light;
mod occlusion;
mod shadow;
mod support;

mod background;
mod paint;

mod mirror;
#[cfg(test)]
mod tests;

pub use framing::Framing;
pub use light::LightEstimate;
pub use mirror::{OwnPicture, OwnPictureInput, OwnPictureOptions};
pub use model::OwnPictureModel;
pub use support::Plain;
