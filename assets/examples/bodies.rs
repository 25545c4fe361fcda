//! Draws both base bodies, lays out their atlas and stores them.
//!
//! `cargo run --release -p toile-assets --example bodies [FOLDER]` reads `female.toml` and `male.toml` there (here
//! `assets/data/body`) and writes `base.bin` beside them.

use std::{error::Error, path::PathBuf};

use toile_assets::body::{draw::draw, stored::Stored, unwrap::unwrap};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "assets/data/body".to_owned()));
    let read = |sex: &str| std::fs::read_to_string(folder.join(sex).with_extension("toml"));
    let bodies = [draw(&read("female")?)?, draw(&read("male")?)?];
    let (uvs, corners) = unwrap(&bodies);
    let stored = Stored::new(bodies, uvs, corners);
    let bytes = stored.encode();
    eprintln!("{} vertices, {} quads, {} bytes", stored.regions.len(), stored.quads.len(), bytes.len());
    Ok(std::fs::write(folder.join("base.bin"), bytes)?)
}
