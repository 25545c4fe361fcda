//! Fonts: Noto Sans and the glyphs of Noto Sans CJK JP that the texts need, within the program, so that no shop has to install one.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

/// Each font's name and data; `engine/kiosk/fonts/README.md` says how they were made.
const FONTS: [(&str, &[u8]); 4] = [
    ("latin", include_bytes!("../../../fonts/NotoSans-Regular.ttf")),
    ("japanese", include_bytes!("../../../fonts/NotoSansJP-Regular.otf")),
    ("latin bold", include_bytes!("../../../fonts/NotoSans-Bold.ttf")),
    ("japanese bold", include_bytes!("../../../fonts/NotoSansJP-Bold.otf")),
];

/// The family of headings and buttons.
pub const BOLD: &str = "bold";

/// Name of a shop's own font.
const SHOP: &str = "shop";

/// The families, Latin letters first: Japanese text takes its Latin letters and figures from the same font as any other. A shop's own
/// font comes before them, in both weights; characters that it lacks are theirs.
pub fn definitions(shop: Option<&Arc<[u8]>>) -> FontDefinitions {
    let data = |(name, bytes): (&str, &'static [u8])| (name.to_owned(), Arc::new(FontData::from_static(bytes)));
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    let mut families = BTreeMap::from([
        (FontFamily::Proportional, names(["latin", "japanese"])),
        (FontFamily::Monospace, names(["latin", "japanese"])),
        (FontFamily::Name(BOLD.into()), names(["latin bold", "japanese bold"])),
    ]);
    let mut font_data: BTreeMap<String, Arc<FontData>> = FONTS.into_iter().map(data).collect();
    if let Some(bytes) = shop {
        font_data.insert(SHOP.to_owned(), Arc::new(FontData::from_owned(bytes.to_vec())));
        families.values_mut().for_each(|names| names.insert(0, SHOP.to_owned()));
    }
    FontDefinitions { font_data, families }
}
