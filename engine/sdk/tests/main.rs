//! All integration tests of the crate, linked once.

use std::path::Path;
use std::sync::OnceLock;

use toile_base::clock::SECOND_NS;
use toile_sdk::{Garment, Recording};

mod bodies;
#[path = "../../../tests/src/coarse.rs"]
mod coarse;
mod own_order;
mod public_api;
mod refusals;
mod same_bits;

/// A T-shirt with a coarse mesh.
fn coarse_tee() -> Garment {
    static TEE: OnceLock<Garment> = OnceLock::new();
    let open = || {
        let file = coarse::write(Path::new(env!("CARGO_TARGET_TMPDIR")), "tee");
        Garment::open(file.to_str().expect("a path of UTF-8")).expect("a garment")
    };
    TEE.get_or_init(open).clone()
}

/// The first second of the embedded recording, in which the shopper stands. It is read once.
fn first_second() -> Recording {
    static RECORDING: OnceLock<Recording> = OnceLock::new();
    let cut = || {
        let embedded = Recording::embedded().expect("it is embedded");
        let joints = embedded.joints().iter().filter(|frame| frame.time_ns < SECOND_NS).copied().collect();
        let depth = embedded.depth().iter().filter(|frame| frame.time_ns < SECOND_NS).cloned().collect();
        Recording::from_frames("the first second", joints, depth).expect("frames of a recording")
    };
    RECORDING.get_or_init(cut).clone()
}
