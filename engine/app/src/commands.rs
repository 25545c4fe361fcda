//! The commands, one file each: its arguments and its work.

pub mod bake;
pub mod body;
pub(crate) mod catalogue;
pub mod collage;
pub mod colliders;
pub mod completions;
pub mod convert;
mod crossings;
pub mod doctor;
pub(crate) mod fabric;
pub mod kiosk;
pub mod live;
pub mod measure;
pub mod plan;
pub mod programs;
pub mod record;
mod record_camera;
pub mod replay;
pub mod run;
pub mod tailor;
pub mod try_on;
