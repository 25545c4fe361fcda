//! Pictures: a CPU ray tracer for stills, animations and videos, the fit map's colours and the contact sheet; behind the
//! feature `view` the rasteriser, which draws on a GPU for the display.
//!
//! The ray tracer uses every core for the length of a picture: on two cores three stills of 480 x 800 within 6 s, a picture of
//! 220 x 360 within 120 ms. No step of the loop calls it.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod sampling;
mod tone_mapping;

pub mod image;

pub mod text;
pub mod video;

pub mod contact_sheet;
pub mod fit_map;
pub mod plot;

pub mod trim_look;

pub mod cloth_look;

pub mod base_layer;
pub mod scene;

pub mod bvh;

pub mod figure;
mod shading;

pub mod hidden_skin;

pub mod own_picture;

mod lighting;
mod traced_scene;

mod ray_tracer;

#[cfg(feature = "view")]
pub mod raster;
mod shadow_filter;

pub mod trace;

pub mod collage;
pub mod drawn_frame;
