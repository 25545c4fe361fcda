//! Capture from several cameras, against surfaces whose motion is known.

pub mod cloth;
pub mod error;
pub mod flow;
pub mod sheet;
pub mod silhouettes;

pub mod followed;
