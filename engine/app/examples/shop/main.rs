//! A made-up shop: six garments of the built-in drafts in prints, with photographs, prices and names in two languages, and a theme.
//!
//! `cargo run --release -p toile --example shop -- DIR` writes `catalogue.toml`, a logo and six packages into DIR, which is made where
//! it is missing, and the packages' sources into DIR/source. The photographs are the mirror's own pictures, the logo is drawn
//! here: nothing of it is under another owner's rights.

mod garments;
mod logo;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

pub use garments::GARMENTS;
use garments::ShopGarment;
use toile_assets::catalogue::package;
use toile_base::frame::Joints;
use toile_fitting::dress::measured::ShopperFacts;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::TryOn;
use toile_view::drawn_frame::{self, DrawnFrame};
use toile_view::figure::Appearance;
use toile_view::image::{Size, linear};

/// Pixels of a photograph.
const PHOTOGRAPH: Size = Size::new(420, 560);

/// Steps in which cloth comes to rest: two seconds.
const SETTLING: usize = 240;

/// What the shop says of itself.
const CATALOGUE: &str = r#"# A made-up shop, as `cargo run --release -p toile --example shop` writes it.
shop = "Hem"

[theme]
logo = "logo.png"
ground = [0.965, 0.945, 0.910]
text = [0.13, 0.16, 0.19]
accent = [0.58, 0.20, 0.17]
"#;

/// A garment on a body of its middle size, from the front, as PNG.
fn photograph(garment: &ShopGarment, pose: &Joints) -> Result<Vec<u8>, String> {
    let name = format!("{}:{}", garment.draft, garment.fabric);
    let request = TryOn::of_shopper(&[name], None, ShopperFacts::default());
    let mut dressed = request.on_mannequin(pose).map_err(|e| e.to_string())?;
    for _ in 0..SETTLING {
        dressed.world.step(pose);
    }
    let snapshot = dressed.reader.latest().clone();
    let colours = vec![garment.colours[0].2.map(linear); dressed.world.garments().len()];
    let drawn = DrawnFrame::new(&dressed.world, Appearance::default()).coloured(&colours);
    let image = drawn_frame::still(drawn, &snapshot, 0.35, PHOTOGRAPH);
    let mut png = Vec::new();
    image.write_png(&mut png).map_err(|e| e.to_string())?;
    Ok(png)
}

/// Writes a catalogue of these garments.
pub fn write(folder: &Path, garments: &[ShopGarment]) -> Result<(), String> {
    let told = |e: std::io::Error| e.to_string();
    let embedded = session::open(None, None).map_err(|e| e.to_string())?;
    let pose = session::standing(&embedded).map_err(|e| e.to_string())?[0];
    fs::create_dir_all(folder).map_err(told)?;
    let mut order = Vec::new();
    for garment in garments {
        let source = folder.join("source").join(garment.file);
        fs::create_dir_all(&source).map_err(told)?;
        fs::write(source.join("garment.toml"), garment.manifest()).map_err(told)?;
        fs::write(source.join("front.png"), photograph(garment, &pose)?).map_err(told)?;
        let (bytes, _) = package::pack(&source).map_err(|e| e.to_string())?;
        let file = format!("{}{}", garment.file, package::ENDING);
        fs::write(folder.join(&file), bytes).map_err(told)?;
        println!("{file}");
        order.push(format!("{file:?}"));
    }
    fs::write(folder.join("logo.png"), logo::png()?).map_err(told)?;
    let text = CATALOGUE.replace("\n\n[theme]", &format!("\ngarments = [{}]\n\n[theme]", order.join(", ")));
    fs::write(folder.join("catalogue.toml"), text).map_err(told)
}

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("shop: no folder is given; name one for the catalogue, as in `shop target/shop`");
        return ExitCode::from(2);
    };
    match write(&folder, &GARMENTS) {
        Ok(()) => {
            println!("{} garments in {}; `toile catalogue check` reads them", GARMENTS.len(), folder.display());
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("shop: the catalogue cannot be written to {} ({why}); name another folder", folder.display());
            ExitCode::from(4)
        }
    }
}
