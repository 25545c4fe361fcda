//! Prints the state hashes, one a line: scene, lanes, hash.
//!
//! Usage: toile-platforms FILE   FILE is what `toile-platforms-record` wrote

use std::process::ExitCode;

use toile_engine::lanes::Width;
use toile_platforms::skirt_hash;
use toile_platforms::worn::Worn;

fn main() -> ExitCode {
    let widths = || Width::ALL.into_iter().filter(|width| width.available());
    for width in widths() {
        println!("skirt {width} {:016x}", skirt_hash(width));
    }
    let Some(path) = std::env::args().nth(1) else { return ExitCode::SUCCESS };
    let worn = std::fs::read(&path).ok().and_then(|bytes| Worn::from_bytes(&bytes));
    let Some(worn) = worn else {
        eprintln!("{path} is not a worn garment; write one with toile-platforms-record");
        return ExitCode::FAILURE;
    };
    for width in widths() {
        println!("dress {width} {:016x}", worn.hash(width));
    }
    ExitCode::SUCCESS
}
