//! Text: words set in a column, for layout and buttons alike.

use std::sync::Arc;

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align, Color32, FontId, Galley, Painter, TextFormat};

/// Where the scripts begin whose lines may end anywhere.
const IDEOGRAPHS: u32 = 0x2e80;

/// Text that has been set.
pub type SetText = Arc<Galley>;

/// Sets words in a column, ragged right.
pub fn left_aligned(painter: &Painter, text: &str, font: FontId, colour: Color32, width: f32) -> SetText {
    set(painter, text, font, colour, width, Align::LEFT)
}

/// Sets words in a column, centred.
pub fn centred(painter: &Painter, text: &str, font: FontId, colour: Color32, width: f32) -> SetText {
    set(painter, text, font, colour, width, Align::Center)
}

fn set(painter: &Painter, text: &str, font: FontId, colour: Color32, width: f32, halign: Align) -> SetText {
    let line_height = Some((font.size * 1.28).round());
    let format = TextFormat { font_id: font, color: colour, line_height, ..TextFormat::default() };
    let wrap = TextWrapping { max_width: width.max(1.0), ..TextWrapping::default() };
    painter.layout_job(LayoutJob { wrap, halign, ..LayoutJob::single_section(text.to_owned(), format) })
}

/// Whether lines may end before and behind a letter.
pub fn is_ideograph(c: char) -> bool {
    u32::from(c) >= IDEOGRAPHS
}

/// Whether a word goes on in the next line: it was wider than its place. Between ideographs every line may end.
pub fn breaks_a_word(words: &SetText) -> bool {
    let letters = |row: usize| words.rows[row].glyphs.iter().map(|glyph| glyph.chr);
    let is_letter = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() && !is_ideograph(c));
    (1..words.rows.len()).any(|row| {
        !words.rows[row - 1].ends_with_newline && is_letter(letters(row - 1).last()) && is_letter(letters(row).next())
    })
}
