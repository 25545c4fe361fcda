//! The hand-offs between threads, in every order in which they can run: the engine's own files, over atomics and threads
//! that a model checker (loom) plays.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
#[expect(unsafe_code, reason = "the protocol of the queue, whose own atomics cannot be replaced")]
pub mod ring;
#[expect(unsafe_code, reason = "the same contract over the model's cell")]
pub mod sync;
#[expect(unsafe_code, reason = "the protocol of the triple buffer, whose own atomics cannot be replaced")]
pub mod triple;
#[path = "../../../engine/core/src/workers/mod.rs"]
#[expect(unsafe_code, reason = "the engine's own file")]
pub mod workers;
