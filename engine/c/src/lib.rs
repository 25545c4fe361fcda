//! Toile for programs in C and in languages that call C: a thin layer over `toile-sdk`, which computes nothing of its own.
//!
//! Its API is `include/toile.h`, made of these sources; docs/c.md is the guide. Nothing here is for callers in Rust: they take
//! `toile-sdk`.
//!
//! A call takes less than 5 µs beside the time of `toile-sdk`. Scenes take one call at a time, all other handles any number.
#![expect(unsafe_code, reason = "functions that C calls by name, and memory that C hands over")]

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod failure;

mod border;

mod handle;
mod texts;

mod body;
mod garment;
mod joints;
mod version;

mod fit;

mod scene;

mod recording;

mod try_on;
