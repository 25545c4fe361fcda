//! Pictures: a CPU ray tracer for stills, animations and videos, the fit map's colours and the contact sheet; behind the
//! feature `view` the rasteriser, which draws on a GPU for the display.
//!
//! Reads: borrowed triangle surfaces (positions, normals, colours). Writes: sRGB images, PNG and animated PNG.
//! Budget: not in the frame; three stills of 480 x 800 within 6 s and a 220 x 360 frame within 120 ms on two cores.
//! Thread: the caller's, which lends every core for the length of one picture.

pub mod bvh;
pub mod contact_sheet;
pub mod drawn_frame;
pub mod fit_map;
pub mod hidden_skin;
pub mod image;
#[cfg(feature = "view")]
pub mod raster;
pub mod scene;
pub mod text;
pub mod trace;
pub mod video;

mod lighting;
mod ray_tracer;
mod sampling;
mod shading;
mod shadow_filter;
mod tone_mapping;
mod traced_scene;
