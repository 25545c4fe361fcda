//! Layout: the places of all parts of a screen, before anything is painted. Touch and tests use the same places.

use egui::{Painter, Pos2, Rect, Vec2, pos2, vec2};

use super::arrangement::{Arrangement, MOST_PANEL};
use super::blocks::{self, PlacedBlock};
use super::controls::{self, ButtonBox};
use super::text::{SetText, breaks_a_word};
use super::theme::ScreenStyle;
use crate::visitor::screen::Screen;

/// How tight the panel may get, in the order of trying.
const SQUEEZES: [f32; 6] = [1.0, 0.92, 0.84, 0.76, 0.68, 0.6];

/// Tighter than this only what has no place otherwise.
const READ_WITH_EASE: f32 = 0.8;

/// A screen that has been laid out.
#[derive(Debug, Clone)]
pub struct ScreenLayout {
    /// The sizes that it came to, and its colours.
    pub look: ScreenStyle,
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

/// Lays a screen out on a display: the first arrangement in which everything has its place, and the last one at any rate.
pub fn lay(screen: &Screen, look: ScreenStyle, painter: &Painter) -> ScreenLayout {
    let (preferred, last) = Arrangement::of(screen, look);
    let tries = SQUEEZES.into_iter().map(|squeeze| look.squeezed(squeeze));
    let whole = preferred.and_then(|arrangement| {
        let mut laid = tries.map(|look| lay_at(screen, look, arrangement, painter));
        laid.find(|laid| laid.is_whole() && laid.panel.height() <= arrangement.most_panel(look) && !laid.breaks_words())
    });
    whole.unwrap_or_else(|| lay_as(screen, look, last, painter))
}

/// In one arrangement, as tight as it has to be.
fn lay_as(screen: &Screen, look: ScreenStyle, arrangement: Arrangement, painter: &Painter) -> ScreenLayout {
    let (mut last, most) = (None, arrangement.most_panel(look));
    for squeeze in SQUEEZES {
        let laid = lay_at(screen, look.squeezed(squeeze), arrangement, painter);
        // Type is made smaller for the sake of the body only as long as it is read with ease.
        if laid.is_whole() && (laid.panel.height() <= most || squeeze <= READ_WITH_EASE) {
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
    last.unwrap_or_else(|| lay_at(screen, look, arrangement, painter))
}

fn lay_at(screen: &Screen, look: ScreenStyle, arrangement: Arrangement, painter: &Painter) -> ScreenLayout {
    let [w, h] = look.display;
    let look = ScreenStyle { narrow: arrangement.is_narrow(look), ..look };
    let (margin, gap, air) = (look.margin(), look.gap(), look.air());
    let column = arrangement.column(look);
    let inner = column - 2.0 * margin;
    let left = w - air - column + margin;
    let [words, pressed] = arrangement.shares(inner, look);
    // What can be pressed: from the lower edge of what is reached up, and never above the reach.
    let (mut buttons, wanted) = controls::lay(&screen.controls, pressed, look, painter);
    let high = h * screen.reach.clamp(0.2, 1.0);
    let low = (h * screen.reach_low).clamp(air + margin, (high - look.target).max(air + margin)).ceil();
    let tall = wanted.min((high - low).max(look.target).floor());
    let window = Rect::from_min_size(pos2(left + inner - pressed, h - low - tall), vec2(pressed, tall));
    buttons.iter_mut().for_each(|b| b.shift(window.min.to_vec2()));
    // What is read stands above it, or beside it.
    let heading = blocks::head(painter, &screen.heading, look, words);
    let mut placed: Vec<PlacedBlock> =
        screen.blocks.iter().enumerate().map(|(i, b)| blocks::block(i, b, words, look, painter)).collect();
    let logo = screen.logo.as_ref().map(|logo| blocks::logo_size(logo, words, look));
    let above = logo.map_or(0.0, |size| size.y + gap);
    let read = above + heading.size().y + placed.iter().map(|b| b.rect.height() + gap).sum::<f32>();
    let space = if buttons.is_empty() { 0.0 } else { gap * 1.6 };
    let is_wide = arrangement == Arrangement::Wide;
    let top = (if is_wide { window.bottom() - read.max(tall) } else { window.top() - space - read }).round();
    let ceiling = if arrangement == Arrangement::Beside { air + margin } else { h * (1.0 - MOST_PANEL) };
    let panel = Rect::from_min_max(pos2(left - margin, (top - margin).max(0.0)), pos2(w - air, h - low + margin));
    let logo = logo.map(|size| Rect::from_min_size(pos2(left, top), size));
    let top = top + above;
    let mut y = top + heading.size().y;
    for block in &mut placed {
        y += gap;
        block.rect = block.rect.translate(vec2(left, y));
        y += block.rect.height();
    }
    let has_room = if is_wide { y <= window.bottom() + 0.5 } else { y + space <= window.top() + 0.5 };
    let fits = top - above >= ceiling - 0.5 && has_room;
    let free = arrangement.free(panel, look);
    let scrolls = (wanted - tall).max(0.0);
    let heading = (pos2(left, top), heading);
    ScreenLayout { look, panel, free, logo, heading, blocks: placed, buttons, window, scrolls, fits }
}

impl ScreenLayout {
    /// Whether everything is seen, whole.
    fn is_whole(&self) -> bool {
        self.fits && self.scrolls == 0.0
    }

    /// Whether a word is broken in two, or wider than its place.
    fn breaks_words(&self) -> bool {
        let buttons = self.buttons.iter().flat_map(|b| [Some(&b.label), b.detail.as_ref()].into_iter().flatten());
        let read = self.blocks.iter().flat_map(|b| &b.words).chain([&self.heading.1]);
        buttons.chain(read).any(breaks_a_word)
    }

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
