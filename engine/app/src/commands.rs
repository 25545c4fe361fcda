//! The commands, one file each: its arguments and what it does with them.
//!
//! Reads: parsed arguments. Writes: a report on stdout, words on stderr, files in the output folder.
//! Budget: that of the rooms it calls.
//! Thread: the main thread.

pub mod bake;
pub(crate) mod bench;
pub mod body;
pub(crate) mod capture;
pub(crate) mod catalogue;
pub mod collage;
pub mod colliders;
pub mod completions;
pub mod convert;
mod crossings;
pub mod doctor;
pub(crate) mod fabric;
pub mod kiosk;
pub mod latency;
pub mod live;
pub mod measure;
pub mod pareto;
pub mod plan;
pub mod record;
mod record_camera;
pub mod replay;
pub mod run;
pub mod soak;
pub mod study;
pub mod tailor;
pub mod torture;
pub mod try_on;
pub mod validate;
