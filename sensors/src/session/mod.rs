//! A session: what a sensor saw of one shopper, from the first frame to the last.
//!
//! # The recording
//!
//! An [MCAP](https://mcap.dev) file, profile `toile`, chunks uncompressed and with checksums, so that any MCAP tool lists
//! and recovers it; chunks that another tool has packed with zstd are read too. Up to three channels, messages in order of
//! time, message encoding `toile-le`; each channel's schema (encoding `text/plain`) describes its bytes in words:
//!
//! | topic | schema | a message |
//! |---|---|---|
//! | `/joints` | `toile.joints/1` | u64 time (ns), u32 count, then x, y, z (m), confidence as f32 for each joint |
//! | `/depth` | `toile.depth/1` | u64 time (ns), camera, pose, then a 16-bit grey PNG in millimetres |
//! | `/hands` | `toile.hands/1` | u64 time (ns) of a joints message, then left and right as u8: 0 unknown, 1 open, 2 closed |
//!
//! `/hands` is there only where the sensor reported hands, with a message for each frame in which it did.
//! Numbers are little endian. The metadata record `toile.session` holds `version` (1), `origin`, `name`, `scale` (`known`
//! or `assumed`) and the frame counts; `toile.notes` holds the notes.

mod layout;
mod read;
mod recording;
mod unpack;
mod write;

pub use read::read;
pub use recording::Session;
pub(crate) use recording::{DepthRoom, too_many};
pub use write::write;
