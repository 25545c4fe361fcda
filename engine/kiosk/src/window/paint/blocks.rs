//! Blocks: the size of each text and picture, before it has its place.

use egui::{FontId, Painter, Pos2, Rect, Vec2, vec2};

use super::qr_code;
use super::text::{SetText, left_aligned};
use super::theme::ScreenStyle;
use crate::visitor::screen::{Block, ScreenPicture};

/// Most of the display's height that a code takes.
const MOST_CODE: f32 = 0.5;

/// Most of the panel's width that a logo takes.
const LOGO_WIDTH: f32 = 0.4;

/// A block with its place.
#[derive(Debug, Clone)]
pub struct PlacedBlock {
    /// Index on the screen.
    pub index: usize,
    /// Rectangle on the display (pixels).
    pub rect: Rect,
    /// Its words, where it has some.
    pub words: Vec<SetText>,
}

/// Width and height of a logo: two lines of the heading high, and no wider than part of the panel.
pub fn logo_size(logo: &ScreenPicture, width: f32, look: ScreenStyle) -> Vec2 {
    let [w, h] = [logo.0.width.max(1) as f32, logo.0.height.max(1) as f32];
    let share = (look.body * 3.4 * look.squeeze / h).min(width * LOGO_WIDTH / w);
    vec2(w * share, h * share).round()
}

/// The heading, a little smaller where that saves it a second line.
pub fn head(painter: &Painter, text: &str, look: ScreenStyle, width: f32) -> SetText {
    let set = |share: f32| {
        let font = look.heading();
        left_aligned(painter, text, FontId { size: (font.size * share).round(), ..font }, look.palette.ink, width)
    };
    let large = set(1.0);
    if large.rows.len() == 1 {
        return large;
    }
    [0.93, 0.86, 0.8].into_iter().map(set).find(|smaller| smaller.rows.len() < large.rows.len()).unwrap_or(large)
}

/// A block at the origin.
pub fn block(index: usize, block: &Block, width: f32, look: ScreenStyle, painter: &Painter) -> PlacedBlock {
    let text = |text: &str, room: f32| left_aligned(painter, text, look.text(), look.palette.ink, room);
    let (height, set) = match block {
        Block::Text(paragraph) => {
            let paragraph = text(paragraph, width);
            (paragraph.size().y, vec![paragraph])
        }
        Block::PoseGuide { .. } => ((look.body * 13.0 * look.squeeze * look.squeeze).round(), vec![]),
        Block::TurnGuide { .. } => ((look.body * 9.0 * look.squeeze * look.squeeze).round(), vec![]),
        Block::Entry { text } => {
            let length = left_aligned(painter, text, big(look), look.palette.ink, width);
            ((length.size().y * 1.3).round(), vec![length])
        }
        Block::Progress { share, label } => {
            let percent = text(&format!("{:.0} %", share.clamp(0.0, 1.0) * 100.0), width);
            let label = text(label, width - percent.size().x - look.gap());
            (label.size().y + look.body * 1.1, vec![label, percent])
        }
        Block::Fit { text: paragraph, .. } => {
            let paragraph = text(paragraph, width - gauge_width(look) - look.gap());
            (paragraph.size().y.max(look.body * 1.1), vec![paragraph])
        }
        Block::Legend { ends } => {
            let ends: Vec<SetText> =
                ends.iter().map(|e| left_aligned(painter, e, look.small(), look.palette.soft, width * 0.48)).collect();
            (look.body * 0.9 + ends.iter().map(|e| e.size().y).fold(0.0, f32::max), ends)
        }
        Block::Code { side, .. } => {
            (qr_code::side(*side, width.min(look.display[1] * MOST_CODE * look.squeeze)), vec![])
        }
        Block::Countdown { seconds } => {
            let number = left_aligned(painter, &clock(*seconds), big(look), look.palette.ink, width);
            ((number.size().y * 1.3).round(), vec![number])
        }
    };
    PlacedBlock { index, rect: Rect::from_min_size(Pos2::ZERO, vec2(width, height)), words: set }
}

/// Seconds as they are read: minutes where there are any.
fn clock(seconds: u32) -> String {
    if seconds < 60 { seconds.to_string() } else { format!("{}:{:02}", seconds / 60, seconds % 60) }
}

/// Width of the scale before a zone's fit.
pub fn gauge_width(look: ScreenStyle) -> f32 {
    (look.body * 4.0).round()
}

/// Type of the seconds that are left.
fn big(look: ScreenStyle) -> FontId {
    FontId { size: (look.body * 2.4).round(), ..look.heading() }
}
