//! The hashes as functions of a module of WebAssembly.

use toile_engine::lanes::Width;

/// [`crate::skirt_hash`] on so many lanes, at most as many as there are.
#[unsafe(no_mangle)]
pub extern "C" fn skirt_hash(lanes: u32) -> u64 {
    crate::skirt_hash(Width::of(lanes as usize).unwrap_or(Width::One))
}
