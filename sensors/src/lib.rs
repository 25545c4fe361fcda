//! What is seen: depth frames and joints, recordings of them, and the filters that make them believable.
//!
//! Reads: session files, recordings of real sensors, a posed mesh (synthetic). Writes: `Joints` and `DepthFrame`.
//! Budget: 33 ms a frame at 30 Hz; joints are filtered in under 50 us.
//! Thread: the sensor thread.

pub mod clock;
pub mod depth;
pub mod error;
pub mod filter;
pub mod frame;
pub mod limits;
pub mod sample;
pub mod segment;
pub mod session;
pub mod source;
