//! Pictures of the bodies: of sizes, of the base bodies near to, of mannequins.
//!
//! `cargo run --release -p toile-view --example bodies sizes|near|mannequins FOLDER` writes PNG files into the folder. Behind the
//! folder, `near` takes `female`, `male` and names of views.

mod mannequins;
mod near;
mod sizes;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let (what, folder) = (words.next().unwrap_or_default(), words.next().unwrap_or_else(|| ".".to_owned()));
    match what.as_str() {
        "sizes" => sizes::write_all(&folder),
        "near" => near::write_all(&folder, &words.collect::<Vec<_>>()),
        "mannequins" => mannequins::write_all(&folder),
        _ => Err("say what to draw: sizes, near or mannequins, and the folder to write to".into()),
    }
}
