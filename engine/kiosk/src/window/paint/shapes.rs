//! Shapes: turns a screen that was laid out into shapes.

use egui::epaint::{CornerRadiusF32, RectShape};
use egui::{Color32, Painter, Pos2, Rect, Rgba, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};

use super::controls::{ButtonBox, aside, disc, pad};
use super::layout::{PlacedBlock, ScreenLayout, gauge_width};
use super::text::SetText;
use super::theme::{self, Sizes};
use super::{figure, qr_code, turn_guide};
use crate::visitor::screen::{Block, Control, ControlStyle, Screen};
use toile_view::fit_map;

/// How touch shows on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TouchFeedback {
    /// The control under it.
    pub pressed: Option<usize>,
    /// How far buttons are scrolled (pixels).
    pub scrolled: f32,
}

/// Paints everything but the picture behind.
pub fn paint(laid: &ScreenLayout, screen: &Screen, feedback: TouchFeedback, painter: &Painter) {
    panel(laid, painter);
    painter.galley(laid.heading.0, laid.heading.1.clone(), theme::INK);
    for placed in &laid.blocks {
        if let Some(block) = screen.blocks.get(placed.index) {
            paint_block(block, placed, laid.sizes, painter);
        }
    }
    // The focus ring stands outside of its button.
    let inside = painter.with_clip_rect(laid.window.expand(laid.sizes.gap()));
    for button in &laid.buttons {
        if let Some(control) = screen.controls.get(button.index) {
            let rect = button.rect.translate(vec2(0.0, -feedback.scrolled));
            let state =
                ButtonState { pressed: feedback.pressed == Some(button.index), focus: screen.focus == button.index };
            paint_button(control, button, rect, state, laid.sizes, &inside);
        }
    }
    scroll_bar(laid, feedback.scrolled, painter);
}

/// Draws the panel that the controls lie on.
fn panel(laid: &ScreenLayout, painter: &Painter) {
    let round = laid.sizes.body * 1.1;
    painter.rect_filled(laid.panel, round, theme::PANEL);
    painter.rect_stroke(laid.panel, round, Stroke::new(laid.sizes.line(), theme::PLAIN), StrokeKind::Inside);
}

/// Where the buttons that are seen stand among all.
fn scroll_bar(laid: &ScreenLayout, scrolled: f32, painter: &Painter) {
    if laid.scrolls <= 0.0 {
        return;
    }
    let (window, wide) = (laid.window, (laid.sizes.body * 0.25).round());
    let whole = window.height() + laid.scrolls;
    let x = window.right() + laid.sizes.margin() * 0.4;
    let bar = |from: f32, to: f32| {
        let y = |share: f32| window.top() + window.height() * share / whole;
        Rect::from_min_max(pos2(x, y(from)), pos2(x + wide, y(to)))
    };
    painter.rect_filled(bar(0.0, whole), wide * 0.5, theme::PLAIN);
    painter.rect_filled(bar(scrolled, scrolled + window.height()), wide * 0.5, theme::SOFT);
}

fn paint_block(block: &Block, placed: &PlacedBlock, sizes: Sizes, painter: &Painter) {
    let (rect, words) = (placed.rect, &placed.words);
    match block {
        Block::Text(_) => words.iter().for_each(|w| put(painter, rect.min, w)),
        Block::PoseGuide { phase, seated } => figure::paint(painter, rect, *phase, *seated),
        Block::TurnGuide { seen, turned, arrow } => turn_guide::paint(painter, rect, seen, *turned, *arrow),
        Block::Entry { .. } => entry(rect, words, sizes, painter),
        Block::Progress { share, .. } => progress(*share, rect, words, sizes, painter),
        Block::Fit { tightness, .. } => fit(*tightness, rect, words, sizes, painter),
        Block::Legend { .. } => legend(rect, words, sizes, painter),
        Block::Code { side, dark } => qr_code::paint(painter, rect, *side, dark),
        Block::Countdown { .. } => countdown(rect, words, sizes, painter),
    }
}

fn put(painter: &Painter, at: Pos2, words: &SetText) {
    painter.galley(at.round(), words.clone(), theme::INK);
}

fn progress(share: f32, rect: Rect, words: &[SetText], sizes: Sizes, painter: &Painter) {
    let tall = (sizes.body * 0.6).round();
    let bar = Rect::from_min_max(pos2(rect.left(), rect.bottom() - tall), rect.max);
    if let [label, percent] = words {
        put(painter, rect.min, label);
        put(painter, pos2(rect.right() - percent.size().x, rect.top()), percent);
    }
    painter.rect_filled(bar, tall * 0.5, theme::PLAIN);
    let full = Rect::from_min_size(bar.min, vec2((bar.width() * share.clamp(0.0, 1.0)).max(tall), tall));
    painter.rect_filled(full, tall * 0.5, theme::PRIMARY);
}

/// The colour of a step of the fit map.
fn step(i: usize) -> Color32 {
    let [r, g, b] = fit_map::STEPS[i.min(fit_map::STEPS.len() - 1)];
    Color32::from_rgb(r, g, b)
}

/// Eight cells from loose to tight; all of one grey where the fit is not known.
fn cells(rect: Rect, known: bool, painter: &Painter) -> impl Fn(usize) -> Rect + use<> {
    let count = fit_map::STEPS.len();
    let cell = move |i: usize| {
        let x = |i: usize| rect.left() + rect.width() * i as f32 / count as f32;
        Rect::from_min_max(pos2(x(i), rect.top()), pos2(x(i + 1) - 2.0, rect.bottom()))
    };
    (0..count).for_each(|i| _ = painter.rect_filled(cell(i), 2.0, if known { step(i) } else { theme::PLAIN }));
    cell
}

/// A scale with a mark at the step, so that place and form say what the colour says; then the words.
fn fit(tightness: Option<f32>, rect: Rect, words: &[SetText], sizes: Sizes, painter: &Painter) {
    let line = words.first().map_or(sizes.body, |w| w.rows.first().map_or(sizes.body, |r| r.height()));
    let tall = (sizes.body * 0.42).round();
    let scale = Rect::from_min_size(
        pos2(rect.left(), rect.top() + ((line - tall) * 0.5).round()),
        vec2(gauge_width(sizes), tall),
    );
    let cell = cells(scale, tightness.is_some(), painter);
    if let Some(i) = tightness.and_then(fit_map::step) {
        let mark = cell(i).expand2(vec2(2.0, sizes.body * 0.26));
        painter.rect_filled(mark, 4.0, step(i));
        painter.rect_stroke(mark, 4.0, Stroke::new(sizes.line() * 2.0, theme::INK), StrokeKind::Outside);
    }
    if let Some(first_text) = words.first() {
        put(
            painter,
            pos2(rect.right() - first_text.rect.width().max(rect.width() - scale.width() - sizes.gap()), rect.top()),
            first_text,
        );
    }
}

fn legend(rect: Rect, words: &[SetText], sizes: Sizes, painter: &Painter) {
    let tall = (sizes.body * 0.7).round();
    _ = cells(Rect::from_min_size(rect.min, vec2(rect.width(), tall)), true, painter);
    if let [loose, tight] = words {
        let y = rect.top() + tall + sizes.body * 0.2;
        put(painter, pos2(rect.left(), y), loose);
        put(painter, pos2(rect.right() - tight.size().x, y), tight);
    }
}

/// What is typed, as a display of its own.
fn entry(rect: Rect, words: &[SetText], sizes: Sizes, painter: &Painter) {
    let Some(length) = words.first() else { return };
    painter.rect_filled(rect, sizes.round(), theme::PLAIN);
    painter.rect_stroke(rect, sizes.round(), Stroke::new(sizes.line() * 2.0, theme::INK), StrokeKind::Inside);
    put(painter, rect.center() - length.size() * 0.5, length);
}

fn countdown(rect: Rect, words: &[SetText], sizes: Sizes, painter: &Painter) {
    let Some(number) = words.first() else { return };
    let tall = rect.height();
    let pill = Rect::from_center_size(rect.center(), vec2((number.size().x + tall * 0.6).max(tall), tall));
    painter.rect_filled(pill, tall * 0.5, theme::PLAIN);
    painter.rect_stroke(pill, tall * 0.5, Stroke::new(sizes.line() * 2.0, theme::INK), StrokeKind::Inside);
    put(painter, pill.center() - number.size() * 0.5, number);
}

/// How a button is drawn.
#[derive(Clone, Copy)]
struct ButtonState {
    pressed: bool,
    focus: bool,
}

fn paint_button(
    control: &Control,
    button: &ButtonBox,
    rect: Rect,
    state: ButtonState,
    sizes: Sizes,
    painter: &Painter,
) {
    let round = sizes.round();
    let (fill, edge) = match control.style {
        ControlStyle::Primary if state.pressed => (Color32::WHITE, Color32::WHITE),
        ControlStyle::Primary => (theme::PRIMARY, theme::PRIMARY),
        _ if state.pressed => (theme::PRESSED, theme::INK),
        _ if control.chosen => (theme::CHOSEN, theme::INK),
        ControlStyle::Plain | ControlStyle::Key => (theme::PLAIN, theme::EDGE),
        ControlStyle::Quiet | ControlStyle::Swatch(_) => (Color32::TRANSPARENT, theme::PLAIN),
    };
    let thick = if control.chosen { 2.0 * sizes.line() } else { sizes.line() };
    painter.add(RectShape::new(rect, CornerRadiusF32::same(round), fill, Stroke::new(thick, edge), StrokeKind::Inside));
    if state.focus {
        let ring = (sizes.body / 9.0).round().max(2.0);
        let far = rect.expand(ring * 1.4);
        painter.rect_stroke(far, round + ring * 1.4, Stroke::new(ring, theme::FOCUS), StrokeKind::Middle);
    }
    face(control, button, rect, sizes, painter);
}

/// What stands on a button: disc or mark, words, second line.
fn face(control: &Control, button: &ButtonBox, rect: Rect, sizes: Sizes, painter: &Painter) {
    let first_text = button.label.size().y + button.detail.as_ref().map_or(0.0, |d| d.size().y);
    let mut top = rect.center().y - first_text * 0.5;
    let mut middle = rect.center().x;
    if let ControlStyle::Swatch(colour) = control.style {
        let disc = disc(sizes);
        let whole = first_text + disc + sizes.gap() * 0.4;
        let centre = pos2(middle, rect.center().y - whole * 0.5 + disc * 0.5);
        swatch(painter, centre, disc * 0.5, colour, control.chosen, sizes);
        top = centre.y + disc * 0.5 + sizes.gap() * 0.4;
    } else if control.chosen {
        let room = aside(control, sizes);
        let radius = sizes.body * 0.55;
        let centre = pos2(rect.left() + pad(sizes) + radius, rect.center().y);
        painter.circle_filled(centre, radius, theme::INK);
        check(painter, centre, radius, theme::DARK);
        middle += room * 0.5;
    }
    // Centred words hang from the middle of their column.
    put(painter, pos2(middle, top), &button.label);
    if let Some(detail) = &button.detail {
        put(painter, pos2(middle, top + button.label.size().y), detail);
    }
}

/// A disc of a colour; its edge sets light and dark ones off from the panel.
fn swatch(painter: &Painter, centre: Pos2, radius: f32, colour: [f32; 3], chosen: bool, sizes: Sizes) {
    let [r, g, b] = colour.map(|c| c.clamp(0.0, 1.0));
    let fill = Color32::from(Rgba::from_rgb(r, g, b));
    painter.circle(centre, radius, fill, Stroke::new(sizes.line() * 1.5, theme::INK));
    if chosen {
        // Beyond this luminance dark has more contrast than white: (1.05 / (y + 0.05)) = ((y + 0.05) / 0.05).
        let light = 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18;
        check(painter, centre, radius * 0.8, if light { theme::DARK } else { theme::INK });
    }
}

/// A check mark within a circle.
fn check(painter: &Painter, centre: Pos2, radius: f32, colour: Color32) {
    let at = |x: f32, y: f32| centre + Vec2::new(x, y) * radius;
    let points = vec![at(-0.5, 0.05), at(-0.12, 0.42), at(0.52, -0.36)];
    painter.add(Shape::line(points, Stroke::new((radius * 0.24).max(2.0), colour)));
}
