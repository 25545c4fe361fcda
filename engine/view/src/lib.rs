//! Pictures: a CPU ray-traced still, a turning animation, a film, the fit map's colours and the contact sheet; behind the
//! feature `view` the mirror, which draws on a GPU.
//!
//! Reads: borrowed triangle surfaces (positions, normals, colours). Writes: sRGB images, PNG and animated PNG.
//! Budget: not in the frame; three stills of 480 x 800 within 6 s and a 220 x 360 frame within 120 ms on two cores.
//! Thread: the caller's, which lends every core for the length of one picture.

pub mod film;
pub mod fitmap;
pub mod image;
#[cfg(feature = "view")]
pub mod mirror;
pub mod scene;
pub mod sheet;
pub mod text;
pub mod trace;
pub mod tree;
pub mod tuck;

mod develop;
mod expose;
mod sample;
mod shade;
mod stage;
mod studio;
mod tone;
