//! Layout: where everything of a screen stands, before anything is painted: what a finger hits is what a test measures.

use egui::{FontId, Painter, Pos2, Rect, Vec2, pos2, vec2};

use super::controls::{self, ButtonBox};
use super::qr_code;
use super::text::{SetText, left_aligned};
use super::theme::Look;
use crate::visitor::screen::{Block, BodyView, Screen, ScreenPicture};

/// How tight the panel may get, in the order of trying.
const SQUEEZES: [f32; 6] = [1.0, 0.92, 0.84, 0.76, 0.68, 0.6];

/// Most of a standing display's height that the panel covers.
const MOST_PANEL: f32 = 0.72;

/// The same where it stands before somebody who looks at themselves, if it can.
const BESIDE_BODY: f32 = 0.48;

/// Most of the display's height that a code takes.
const MOST_CODE: f32 = 0.5;

/// Tighter than this only what has no place otherwise.
const READ_WITH_EASE: f32 = 0.8;

/// Share of a lying display's width that the panel takes.
const SIDE: f32 = 0.42;

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

/// A screen that has been laid out.
#[derive(Debug, Clone)]
pub struct ScreenLayout {
    /// The sizes that it came to, and its colours.
    pub look: Look,
    /// Rectangle of the panel (pixels).
    pub panel: Rect,
    /// What the panel leaves of the display.
    pub free: Rect,
    /// Rectangle of the shop's logo, where it is shown.
    pub logo: Option<Rect>,
    /// The heading and its upper left corner.
    pub heading: (Pos2, SetText),
    /// Blocks below the heading.
    pub blocks: Vec<PlacedBlock>,
    /// What can be pressed; its rectangles are those at a scroll of 0.
    pub buttons: Vec<ButtonBox>,
    /// Where buttons are seen.
    pub window: Rect,
    /// How far they can be scrolled (pixels): 0 where all are seen.
    pub scrolls: f32,
    /// Whether everything has its place: false where the display is too small for what it is to show.
    pub fits: bool,
}

/// Lays a screen out on a display.
pub fn lay(screen: &Screen, look: Look, painter: &Painter) -> ScreenLayout {
    let mut last = None;
    // A code is scanned from where one stands: it has all the room there is.
    let code = screen.blocks.iter().any(|block| matches!(block, Block::Code { .. }));
    let beside = !code && !matches!(screen.body_view, BodyView::Mannequin);
    let most = look.display[1] * if beside { BESIDE_BODY } else { MOST_PANEL };
    for squeeze in SQUEEZES {
        let laid = lay_at(screen, look.squeezed(squeeze), painter);
        let whole = laid.fits && laid.scrolls == 0.0;
        let small = look.landscape || laid.panel.height() <= most;
        // Type is made smaller for the sake of the body only as long as it is read with ease.
        if whole && (small || squeeze <= READ_WITH_EASE) {
            return laid;
        }
        // Where nothing fits, buttons that scroll are better than words that are cut off.
        let better = last
            .as_ref()
            .is_none_or(|before: &ScreenLayout| !before.fits || laid.fits && laid.scrolls < before.scrolls);
        if better {
            last = Some(laid);
        }
    }
    last.unwrap_or_else(|| lay_at(screen, look, painter))
}

fn lay_at(screen: &Screen, look: Look, painter: &Painter) -> ScreenLayout {
    let [w, h] = look.display;
    let (margin, gap, air) = (look.margin(), look.gap(), look.air());
    let column = if look.landscape { (w * SIDE).round() } else { w - 2.0 * air };
    let inner = column - 2.0 * margin;
    let left = w - air - column + margin;
    // What can be pressed: from the lower edge of what is reached up, and never above the reach.
    let (mut buttons, wanted) = controls::lay(&screen.controls, inner, look, painter);
    let high = h * screen.reach.clamp(0.2, 1.0);
    let low = (h * screen.reach_low).clamp(air + margin, (high - look.target).max(air + margin)).ceil();
    let tall = wanted.min((high - low).max(look.target).floor());
    let window = Rect::from_min_size(pos2(left, h - low - tall), vec2(inner, tall));
    buttons.iter_mut().for_each(|b| b.shift(window.min.to_vec2()));
    // What is read stands above it.
    let heading = head(painter, &screen.heading, look, inner);
    let mut blocks: Vec<PlacedBlock> =
        screen.blocks.iter().enumerate().map(|(i, b)| block(i, b, inner, look, painter)).collect();
    let logo = screen.logo.as_ref().map(|logo| logo_size(logo, inner, look));
    let above = logo.map_or(0.0, |size| size.y + gap);
    let read = above + heading.size().y + blocks.iter().map(|b| b.rect.height() + gap).sum::<f32>();
    let space = if buttons.is_empty() { 0.0 } else { gap * 1.6 };
    let top = (window.top() - space - read).round();
    let ceiling = if look.landscape { air + margin } else { h * (1.0 - MOST_PANEL) };
    let panel = Rect::from_min_max(pos2(left - margin, (top - margin).max(0.0)), pos2(w - air, h - low + margin));
    let logo = logo.map(|size| Rect::from_min_size(pos2(left, top), size));
    let top = top + above;
    let mut y = top + heading.size().y;
    for placed in &mut blocks {
        y += gap;
        placed.rect = placed.rect.translate(vec2(left, y));
        y += placed.rect.height();
    }
    let fits = top - above >= ceiling - 0.5 && y + space <= window.top() + 0.5;
    let free = if look.landscape {
        Rect::from_min_max(Pos2::ZERO, pos2(panel.left(), h))
    } else {
        Rect::from_min_max(Pos2::ZERO, pos2(w, panel.top()))
    };
    let scrolls = (wanted - tall).max(0.0);
    let heading = (pos2(left, top), heading);
    ScreenLayout { look, panel, free, logo, heading, blocks, buttons, window, scrolls, fits }
}

/// Width and height of a logo: two lines of the heading high, and no wider than part of the panel.
fn logo_size(logo: &ScreenPicture, width: f32, look: Look) -> Vec2 {
    let [w, h] = [logo.0.width.max(1) as f32, logo.0.height.max(1) as f32];
    let share = (look.body * 3.4 * look.squeeze / h).min(width * LOGO_WIDTH / w);
    vec2(w * share, h * share).round()
}

/// The heading, a little smaller where that saves it a second line.
fn head(painter: &Painter, text: &str, look: Look, width: f32) -> SetText {
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
fn block(index: usize, block: &Block, width: f32, look: Look, painter: &Painter) -> PlacedBlock {
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
pub fn gauge_width(look: Look) -> f32 {
    (look.body * 4.0).round()
}

/// Type of the seconds that are left.
fn big(look: Look) -> FontId {
    FontId { size: (look.body * 2.4).round(), ..look.heading() }
}

impl ScreenLayout {
    /// The control at a point, with buttons scrolled so far.
    pub fn hit(&self, at: Pos2, scrolled: f32) -> Option<usize> {
        let inside = |b: &&ButtonBox| b.rect.translate(Vec2::new(0.0, -scrolled)).contains(at);
        self.window
            .expand(self.look.gap() * 0.5)
            .contains(at)
            .then(|| self.buttons.iter().find(inside))?
            .map(|b| b.index)
    }

    /// The scroll nearest to this one at which a control is whole.
    pub fn scroll_to(&self, index: usize, scrolled: f32) -> f32 {
        let Some(button) = self.buttons.iter().find(|b| b.index == index) else { return 0.0 };
        let air = self.look.gap();
        let most = button.rect.top() - air - self.window.top();
        let least = button.rect.bottom() + air - self.window.bottom();
        scrolled.max(least).min(most).clamp(0.0, self.scrolls)
    }
}
