//! A shop of two garments that are soon draped: a dress, and a T-shirt that takes its place.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use toile_assets::catalogue::package;

use crate::coarse;

/// The shop's folder, written at the first look.
pub static SHOP: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("coarse-shop");
    let source = folder.join("source");
    fs::create_dir_all(&source).unwrap();
    for (file, name) in [("a", "strap-dress"), ("b", "tee")] {
        coarse::write(&source, name);
        let manifest = format!("article = \"{file}\"\ngarment = \"{name}.json\"\nname = {{ en = \"{name}\" }}\n");
        fs::write(source.join("garment.toml"), manifest).unwrap();
        fs::write(folder.join(format!("{file}.toile")), package::pack(&source).unwrap().0).unwrap();
    }
    fs::write(folder.join("catalogue.toml"), "shop = \"Corner shop\"\n").unwrap();
    folder
});
