//! What a guest of the mirror meets.
//!
//! Reads: nothing. Writes: nothing.
//! Budget: none.
//! Thread: any.

pub mod screen;
