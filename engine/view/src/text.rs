//! Small antialiased text for labels and legends: Noto Sans Mono (SIL Open Font License), Latin-1.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use crate::image::Image;

/// How large text is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextSize {
    /// Lines of 16 pixels: captions, legends.
    Small,
    /// Lines of 24 pixels: titles.
    Large,
}

impl TextSize {
    /// Height of a line (pixels).
    pub fn height(self) -> u32 {
        self.raster().val() as u32
    }

    /// Width of one line of text (pixels).
    pub fn width(self, text: &str) -> u32 {
        (text.chars().count() * get_raster_width(FontWeight::Regular, self.raster())) as u32
    }

    /// The text if it fits into `width` pixels, else as much of it as fits, ending in two dots.
    pub fn fitted(self, text: &str, width: u32) -> String {
        if self.width(text) <= width {
            return text.to_owned();
        }
        let room = (width / self.width("m")) as usize;
        let mut cut: String = text.chars().take(room.saturating_sub(2)).collect();
        cut.push_str("..");
        cut
    }

    fn raster(self) -> RasterHeight {
        match self {
            Self::Small => RasterHeight::Size16,
            Self::Large => RasterHeight::Size24,
        }
    }
}

/// Draws one line with its upper left corner at (x, y) in an sRGB ink; what lies outside is cut off. Dashes and quotes
/// beyond Latin-1 are set as their plain forms, other such characters as a question mark.
pub fn draw(image: &mut Image, x: i32, y: i32, text: &str, size: TextSize, ink: [u8; 3]) {
    let mut left = i64::from(x);
    for character in text.chars() {
        let glyph = [plain(character), '?'].into_iter().find_map(|c| get_raster(c, FontWeight::Regular, size.raster()));
        let Some(glyph) = glyph else { continue };
        for (row, line) in (0..).zip(glyph.rows()) {
            for (column, &cover) in (0..).zip(line) {
                if cover > 0 {
                    image.mix(left + column, i64::from(y) + row, ink, cover);
                }
            }
        }
        left += glyph.width() as i64;
    }
}

/// The Latin-1 stand-in of common typographic characters.
fn plain(character: char) -> char {
    match character {
        '\u{2010}'..='\u{2015}' | '\u{2212}' => '-',
        '\u{2018}' | '\u{2019}' => '\'',
        '\u{201c}' | '\u{201d}' => '"',
        '\u{2022}' => '\u{b7}',
        '\t' | '\n' | '\r' => ' ',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Size;

    #[test]
    fn text_leaves_ink_inside_its_box_alone() {
        let paper = [250, 250, 250];
        let mut image = Image::filled(Size::new(200, 60), paper);
        draw(&mut image, 20, 20, "Gr\u{f6}\u{df}e M", TextSize::Small, [0, 0, 0]);
        let inked = |x: u32, y: u32| image.pixel(x, y) != Some(paper);
        let width = TextSize::Small.width("Gr\u{f6}\u{df}e M");
        let mut count = 0;
        for y in 0..60 {
            for x in 0..200 {
                let inside = (20..20 + width).contains(&x) && (20..36).contains(&y);
                assert!(inside || !inked(x, y), "ink at ({x}, {y})");
                count += usize::from(inked(x, y));
            }
        }
        assert!(count > 100, "{count} pixels of ink");
    }

    #[test]
    fn text_off_the_picture_is_cut_off() {
        let mut image = Image::filled(Size::new(10, 10), [9; 3]);
        draw(&mut image, -5, -5, "\u{6f22} wide text", TextSize::Large, [0; 3]);
        draw(&mut image, i32::MAX - 3, i32::MIN, "far away", TextSize::Large, [0; 3]);
        assert_eq!(image.size(), Size::new(10, 10));
    }

    #[test]
    fn long_text_is_cut_to_its_room() {
        let room = TextSize::Small.width("twelve lette");
        assert_eq!(TextSize::Small.fitted("twelve letters and more", room), "twelve let..");
        assert_eq!(TextSize::Small.fitted("short", room), "short");
    }
}
