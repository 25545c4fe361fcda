//! A collage: photographs of garments laid on the picture of a body, from the front, the side and behind.
//!
//! A side of 800 rows takes half a second, nearly all of it for the body's picture, which uses every core. No step of the loop
//! makes a collage.
//!
//! After Ugur (2008, sections 6.1.2 and 6.2). In painting order: the body, the garments in wearing order, the body's arms once more, the
//! garments' sleeves with what lies around them. A garment hangs at its level, is as large as two points of known distance say, and its
//! rows are stretched to the body within limits.

mod body_layers;
mod paint;
mod scaling;

pub use body_layers::{BodyLayers, CollageSide};
pub use paint::{CollageError, WornPhotographs, collage};
pub use scaling::{Layer, RowSpan, scaled};

#[cfg(test)]
mod tests;
