//! A whole try-on with its pictures: the embedded recording, an outfit, and front, side and back as cloth and as fit map.
//!
//! `cargo run --release -p toile-sdk --example fit_pictures -- [FOLDER]`

use std::path::PathBuf;

use toile_sdk::{Error, Garment, Recording, TryOnOptions, try_on};

fn main() -> Result<(), Error> {
    let folder = std::env::args_os().nth(1).map_or_else(std::env::temp_dir, PathBuf::from);
    let garments = [Garment::open("wide-leg-trousers")?, Garment::open("tee")?];
    let options = TryOnOptions { picture: Some([300, 500]), ..TryOnOptions::default() };
    let tried = try_on(&Recording::embedded()?, &garments, &options)?;
    for fit in tried.fits.iter().flatten() {
        println!("{} in {}: {}", fit.garment, fit.size, fit.verdict);
    }
    for (side, (cloth, map)) in ["front", "side", "back"].into_iter().zip(tried.pictures.iter().zip(&tried.fit_maps)) {
        assert_eq!(cloth.rgba().len(), (cloth.width() * cloth.height() * 4) as usize);
        assert_ne!(cloth.rgba(), map.rgba(), "a fit map has other colours");
        for (name, picture) in [("cloth", cloth), ("fit", map)] {
            let path = folder.join(format!("toile-sdk-{name}-{side}.png"));
            picture.write_png(&path)?;
            println!("{}", path.display());
        }
    }
    println!("{} steps, state {:016x}", tried.scene.steps(), tried.scene.state_hash());
    Ok(())
}
