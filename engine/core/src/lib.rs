//! The frame, 120 times a second: pose, skin, colliders, cloth.
//!
//! Reads: filtered joints and baked assets. Writes: the body's bones and skin, the colliders, the snapshot to show.
//! Budget: one step of 1/120 s within 8.3 ms, nothing allocated in it.
//! Thread: the physics thread; a triple buffer stands between it and the others.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
pub mod clock;
pub mod cone;
pub mod lanes;
pub mod meter;
#[expect(unsafe_code, reason = "a value that threads keep apart by other means")]
pub mod sync;
pub mod triple_buffer;

pub mod body;
pub mod jump_filter;
#[expect(unsafe_code, reason = "a job that borrows the caller's stack is handed to another thread")]
pub mod workers;

pub mod skin;
pub mod surface;

pub mod body_surface;

pub mod colliders;

pub mod cloth;

pub mod frame;
pub mod lines;

#[cfg(feature = "loop")]
pub mod frame_loop;
// Not within the room's own file, which the models of the hand-offs include (tests/models).
#[cfg(all(test, feature = "threads"))]
#[path = "workers/tests.rs"]
mod workers_tests;

#[cfg(test)]
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
