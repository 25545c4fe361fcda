//! Prints the state hashes, one a line: scene, lanes, hash.
//!
//! Usage: toile-platforms FILE [LANES]...   FILE is what `toile-platforms-record` wrote; without lanes, all that there are

use std::process::ExitCode;

use toile_engine::lanes::Width;
use toile_platforms::dress_recording::DressRecording;
use toile_platforms::skirt_hash;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_default();
    let asked: Vec<usize> = arguments.filter_map(|lanes| lanes.parse().ok()).collect();
    let widths = || {
        let available = Width::ALL.into_iter().filter(|width| width.available());
        available.filter(|width| asked.is_empty() || asked.contains(&width.lanes()))
    };
    let recording = std::fs::read(&path).ok().and_then(|bytes| DressRecording::from_bytes(&bytes));
    let Some(recording) = recording else {
        eprintln!("{path:?} is not a recording; write one with toile-platforms-record FILE");
        return ExitCode::FAILURE;
    };
    widths().for_each(|width| println!("skirt {width} {:016x}", skirt_hash(width)));
    widths().for_each(|width| println!("dress {width} {:016x}", recording.hash(width)));
    ExitCode::SUCCESS
}
