//! `cargo run --release -p toile-sculpt [DRAWINGS [FILE]]` reads `female.toml` and `male.toml` in a folder (unless named,
//! `assets/sculpt/data`), draws both bodies, lays out their atlas and stores them (in `assets/data/body/base.bin`).

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let mut path = |default: &str| PathBuf::from(words.next().unwrap_or_else(|| default.to_owned()));
    let (drawings, file) = (path("assets/sculpt/data"), path("assets/data/body/base.bin"));
    let read = |sex: &str| std::fs::read_to_string(drawings.join(sex).with_extension("toml"));
    let stored = toile_sculpt::stored([&read("female")?, &read("male")?])?;
    let bytes = stored.encode();
    eprintln!("{} vertices, {} quads, {} bytes", stored.regions.len(), stored.quads.len(), bytes.len());
    Ok(std::fs::write(file, bytes)?)
}
