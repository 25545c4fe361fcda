//! Text: words set in a column, for layout and buttons alike.

use std::sync::Arc;

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align, Color32, FontId, Galley, Painter, TextFormat};

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
