//! All integration tests of the crate, linked once.

#![expect(unsafe_code, reason = "a counting allocator has to implement an unsafe trait")]

mod examples;
mod memory;
