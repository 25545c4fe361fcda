//! Checks a font: reads it as the painter does and draws every letter once.

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};

/// Farthest that a letter may reach from its origin (em): what reaches farther would take memory without end to draw.
const REACH_EM: f32 = 8.0;

/// Units per em that fonts have (OpenType, table `head`).
const UNITS: std::ops::RangeInclusive<u16> = 16..=16_384;

/// What a font must have to be worth its name: the letters and figures of all prices and sizes.
const NEEDED: std::ops::RangeInclusive<char> = '0'..='9';

/// Most curves of a letter.
const MAX_CURVES: usize = 20_000;

/// Follows an outline.
#[derive(Default)]
struct Reach {
    /// Farthest coordinate (em).
    far: f32,
    curves: usize,
}

impl Reach {
    fn point(&mut self, points: [f32; 2]) {
        self.curves += 1;
        for p in points {
            self.far = if p.is_finite() { self.far.max(p.abs()) } else { f32::INFINITY };
        }
    }
}

impl OutlinePen for Reach {
    fn move_to(&mut self, x: f32, y: f32) {
        self.point([x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.point([x, y]);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.point([cx, cy]);
        self.point([x, y]);
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.point([ax, ay]);
        self.point([bx, by]);
        self.point([x, y]);
    }

    fn close(&mut self) {}
}

/// Whether a TrueType or OpenType font can be shown.
///
/// # Errors
/// The fault and its cure, to follow the file's name.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    let none = "it is no font in TrueType or OpenType (.ttf, .otf); convert it";
    // The painter takes the first font of a file, and collections are not asked which one is meant.
    if bytes.starts_with(b"ttcf") {
        return Err("it is a collection of fonts; save the one that is meant as .ttf or .otf".into());
    }
    let font = FontRef::from_index(bytes, 0).map_err(|_| none.to_owned())?;
    let metrics = font.metrics(Size::unscaled(), LocationRef::default());
    let line = metrics.ascent - metrics.descent;
    let em = f32::from(metrics.units_per_em);
    if !UNITS.contains(&metrics.units_per_em) || !(0.2 * em..=REACH_EM * em).contains(&line) {
        return Err("its measures are none that a font has; take another one".into());
    }
    let charmap = font.charmap();
    if let Some(missing) = NEEDED.into_iter().find(|c| charmap.map(*c).is_none()) {
        return Err(format!("it has no {missing:?}, and prices need figures; take another one"));
    }
    let outlines = font.outline_glyphs();
    for (code, glyph) in charmap.mappings() {
        let Some(outline) = outlines.get(glyph) else { continue };
        let mut reach = Reach::default();
        // A letter that cannot be drawn is left out by the painter too.
        let drawn = outline.draw(DrawSettings::unhinted(Size::new(1.0), LocationRef::default()), &mut reach);
        if drawn.is_ok() && (reach.far > REACH_EM || reach.curves > MAX_CURVES) {
            return Err(format!("its character U+{code:04X} is drawn beyond all bounds; take another font"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: [&[u8]; 2] = [
        include_bytes!("../../../engine/kiosk/fonts/NotoSans-Regular.ttf"),
        include_bytes!("../../../engine/kiosk/fonts/NotoSansJP-Regular.otf"),
    ];

    #[test]
    fn fonts_pass_and_what_is_none_is_refused() {
        check(OURS[0]).unwrap();
        // Kana alone, without figures of its own.
        assert!(check(OURS[1]).map_or_else(|why| why.contains("figures"), |()| true));
        for bytes in [&b"OTTO"[..], b"", b"ttcf\0\0\0\0", b"not a font at all, but long enough", &OURS[0][..200]] {
            let refused = check(bytes).unwrap_err();
            assert!(refused.contains("; ") && !refused.contains('\n'), "{refused}");
        }
    }

    #[test]
    fn fonts_cut_short_and_garbled_are_refused_or_read_but_never_more() {
        let font = OURS[0];
        for part in 1..64 {
            let _ = check(&font[..font.len() * part / 64]);
        }
        for at in (0..font.len()).step_by(font.len() / 60) {
            let mut bytes = font.to_vec();
            bytes[at] ^= 0xff;
            let _ = check(&bytes);
        }
    }
}
