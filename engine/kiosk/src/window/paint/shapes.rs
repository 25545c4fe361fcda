//! Shapes: turns a screen that was laid out into shapes.

use egui::epaint::{CornerRadiusF32, RectShape};
use egui::{Color32, Painter, Pos2, Rect, Rgba, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};

use super::blocks::{PlacedBlock, gauge_width};
use super::controls::{ButtonBox, aside, disc, pad, picture_height, picture_width};
use super::layout::ScreenLayout;
use super::pictures::PictureTextures;
use super::text::SetText;
use super::theme::{self, ScreenStyle};
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
pub fn paint(
    laid: &ScreenLayout,
    screen: &Screen,
    feedback: TouchFeedback,
    (painter, textures): (&Painter, &PictureTextures),
) {
    let look = laid.look;
    panel(laid, painter);
    if let (Some(place), Some(logo)) = (laid.logo, &screen.logo) {
        textures.paint(painter, place, logo, 0.0);
    }
    painter.galley(laid.heading.0, laid.heading.1.clone(), look.palette.ink);
    for placed in &laid.blocks {
        if let Some(block) = screen.blocks.get(placed.index) {
            paint_block(block, placed, laid.look, painter);
        }
    }
    // The focus ring stands outside of its button.
    let inside = painter.with_clip_rect(laid.window.expand(laid.look.gap()));
    for button in &laid.buttons {
        if let Some(control) = screen.controls.get(button.index) {
            let rect = button.rect.translate(vec2(0.0, -feedback.scrolled));
            let state =
                ButtonState { pressed: feedback.pressed == Some(button.index), focus: screen.focus == button.index };
            paint_button(control, button, rect, state, look, (&inside, textures));
        }
    }
    scroll_bar(laid, feedback.scrolled, painter);
}

/// Draws the panel that the controls lie on.
fn panel(laid: &ScreenLayout, painter: &Painter) {
    let look = laid.look;
    let round = laid.look.body * 1.1;
    painter.rect_filled(laid.panel, round, look.palette.panel);
    painter.rect_stroke(laid.panel, round, Stroke::new(laid.look.line(), look.palette.plain), StrokeKind::Inside);
}

/// Where the buttons that are seen stand among all.
fn scroll_bar(laid: &ScreenLayout, scrolled: f32, painter: &Painter) {
    if laid.scrolls <= 0.0 {
        return;
    }
    let look = laid.look;
    let (window, wide) = (laid.window, (laid.look.body * 0.25).round());
    let whole = window.height() + laid.scrolls;
    let x = window.right() + laid.look.margin() * 0.4;
    let bar = |from: f32, to: f32| {
        let y = |share: f32| window.top() + window.height() * share / whole;
        Rect::from_min_max(pos2(x, y(from)), pos2(x + wide, y(to)))
    };
    painter.rect_filled(bar(0.0, whole), wide * 0.5, look.palette.plain);
    painter.rect_filled(bar(scrolled, scrolled + window.height()), wide * 0.5, look.palette.soft);
}

fn paint_block(block: &Block, placed: &PlacedBlock, look: ScreenStyle, painter: &Painter) {
    let (rect, words) = (placed.rect, &placed.words);
    match block {
        Block::Text(_) => words.iter().for_each(|w| put(painter, rect.min, w)),
        Block::PoseGuide { phase, seated } => figure::paint(painter, rect, *phase, *seated, &look.palette),
        Block::TurnGuide { seen, turned, arrow } => {
            turn_guide::paint((painter, &look.palette), rect, seen, *turned, *arrow);
        }
        Block::Entry { .. } => entry(rect, words, look, painter),
        Block::Progress { share, .. } => progress(*share, rect, words, look, painter),
        Block::Fit { tightness, .. } => fit(*tightness, rect, words, look, painter),
        Block::Legend { .. } => legend(rect, words, look, painter),
        Block::Code { side, dark } => qr_code::paint(painter, rect, *side, dark),
        Block::Countdown { .. } => countdown(rect, words, look, painter),
    }
}

fn put(painter: &Painter, at: Pos2, words: &SetText) {
    // The words have their colour since they were set.
    painter.galley(at.round(), words.clone(), theme::LIGHT);
}

fn progress(share: f32, rect: Rect, words: &[SetText], look: ScreenStyle, painter: &Painter) {
    let tall = (look.body * 0.6).round();
    let bar = Rect::from_min_max(pos2(rect.left(), rect.bottom() - tall), rect.max);
    if let [label, percent] = words {
        put(painter, rect.min, label);
        put(painter, pos2(rect.right() - percent.size().x, rect.top()), percent);
    }
    painter.rect_filled(bar, tall * 0.5, look.palette.plain);
    let full = Rect::from_min_size(bar.min, vec2((bar.width() * share.clamp(0.0, 1.0)).max(tall), tall));
    painter.rect_filled(full, tall * 0.5, look.palette.mark);
}

/// The colour of a step of the fit map.
fn step(i: usize) -> Color32 {
    let [r, g, b] = fit_map::STEPS[i.min(fit_map::STEPS.len() - 1)];
    Color32::from_rgb(r, g, b)
}

/// Eight cells from loose to tight; all of one grey where the fit is not known.
fn cells(rect: Rect, known: bool, look: ScreenStyle, painter: &Painter) -> impl Fn(usize) -> Rect + use<> {
    let count = fit_map::STEPS.len();
    let cell = move |i: usize| {
        let x = |i: usize| rect.left() + rect.width() * i as f32 / count as f32;
        Rect::from_min_max(pos2(x(i), rect.top()), pos2(x(i + 1) - 2.0, rect.bottom()))
    };
    (0..count).for_each(|i| _ = painter.rect_filled(cell(i), 2.0, if known { step(i) } else { look.palette.plain }));
    cell
}

/// A scale with a mark at the step, so that place and form say what the colour says; then the words.
fn fit(tightness: Option<f32>, rect: Rect, words: &[SetText], look: ScreenStyle, painter: &Painter) {
    let line = words.first().map_or(look.body, |w| w.rows.first().map_or(look.body, |r| r.height()));
    let tall = (look.body * 0.42).round();
    let scale = Rect::from_min_size(
        pos2(rect.left(), rect.top() + ((line - tall) * 0.5).round()),
        vec2(gauge_width(look), tall),
    );
    let cell = cells(scale, tightness.is_some(), look, painter);
    if let Some(i) = tightness.and_then(fit_map::step) {
        let mark = cell(i).expand2(vec2(2.0, look.body * 0.26));
        painter.rect_filled(mark, 4.0, step(i));
        painter.rect_stroke(mark, 4.0, Stroke::new(look.line() * 2.0, look.palette.ink), StrokeKind::Outside);
    }
    if let Some(first_text) = words.first() {
        put(
            painter,
            pos2(rect.right() - first_text.rect.width().max(rect.width() - scale.width() - look.gap()), rect.top()),
            first_text,
        );
    }
}

fn legend(rect: Rect, words: &[SetText], look: ScreenStyle, painter: &Painter) {
    let tall = (look.body * 0.7).round();
    _ = cells(Rect::from_min_size(rect.min, vec2(rect.width(), tall)), true, look, painter);
    if let [loose, tight] = words {
        let y = rect.top() + tall + look.body * 0.2;
        put(painter, pos2(rect.left(), y), loose);
        put(painter, pos2(rect.right() - tight.size().x, y), tight);
    }
}

/// What is typed, as a display of its own.
fn entry(rect: Rect, words: &[SetText], look: ScreenStyle, painter: &Painter) {
    let Some(length) = words.first() else { return };
    painter.rect_filled(rect, look.round(), look.palette.plain);
    painter.rect_stroke(rect, look.round(), Stroke::new(look.line() * 2.0, look.palette.ink), StrokeKind::Inside);
    put(painter, rect.center() - length.size() * 0.5, length);
}

fn countdown(rect: Rect, words: &[SetText], look: ScreenStyle, painter: &Painter) {
    let Some(number) = words.first() else { return };
    let tall = rect.height();
    let pill = Rect::from_center_size(rect.center(), vec2((number.size().x + tall * 0.6).max(tall), tall));
    painter.rect_filled(pill, tall * 0.5, look.palette.plain);
    painter.rect_stroke(pill, tall * 0.5, Stroke::new(look.line() * 2.0, look.palette.ink), StrokeKind::Inside);
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
    look: ScreenStyle,
    (painter, textures): (&Painter, &PictureTextures),
) {
    let round = look.round();
    let (fill, edge) = match control.style {
        ControlStyle::Primary if state.pressed => (look.palette.accent_pressed, look.palette.accent_pressed),
        ControlStyle::Primary => (look.palette.accent, look.palette.mark),
        _ if state.pressed => (look.palette.pressed, look.palette.ink),
        _ if control.chosen => (look.palette.chosen, look.palette.ink),
        ControlStyle::Plain | ControlStyle::Key | ControlStyle::Tile(_) => (look.palette.plain, look.palette.edge),
        ControlStyle::Quiet | ControlStyle::Swatch(_) => (Color32::TRANSPARENT, look.palette.plain),
    };
    let thick = if control.chosen { 2.0 * look.line() } else { look.line() };
    painter.add(RectShape::new(rect, CornerRadiusF32::same(round), fill, Stroke::new(thick, edge), StrokeKind::Inside));
    if state.focus {
        let ring = (look.body / 9.0).round().max(2.0);
        let far = rect.expand(ring * 1.4);
        painter.rect_stroke(far, round + ring * 1.4, Stroke::new(ring, look.palette.focus), StrokeKind::Middle);
    }
    match control.style {
        ControlStyle::Tile(colour) => tile((control, colour), button, rect, look, (painter, textures)),
        _ => face(control, button, rect, look, painter),
    }
}

/// A garment's photograph, or while there is none its colour; words below it.
fn tile(
    (control, colour): (&Control, [f32; 3]),
    button: &ButtonBox,
    rect: Rect,
    look: ScreenStyle,
    (painter, textures): (&Painter, &PictureTextures),
) {
    let air = pad(look);
    let wide = if look.narrow { picture_width(look) } else { rect.width() - 2.0 * air };
    let place = Rect::from_min_size(rect.min + vec2(air, air), vec2(wide, picture_height(look)));
    let round = look.round() * 0.5;
    let shown =
        control.picture.as_ref().is_some_and(|picture| textures.paint(painter, place, picture, round).is_some());
    if !shown {
        let [r, g, b] = colour.map(|c| c.clamp(0.0, 1.0));
        let sheet = Rect::from_center_size(place.center(), vec2(place.height() * 0.72, place.height()));
        painter.rect_filled(sheet.intersect(place), round, Color32::from(Rgba::from_rgb(r, g, b)));
    }
    if control.chosen {
        let radius = look.body * 0.55;
        let centre = place.left_top() + vec2(radius, radius);
        painter.circle_filled(centre, radius, look.palette.ink);
        check(painter, centre, radius, look.palette.on_ink);
    }
    if look.narrow {
        return beside(button, rect, place.right() + air, painter);
    }
    let top = place.bottom() + air * 0.6;
    put(painter, pos2(rect.center().x, top), &button.label);
    if let Some(detail) = &button.detail {
        put(painter, pos2(rect.center().x, top + button.label.size().y), detail);
    }
}

/// The words of a tile, right of its photograph.
fn beside(button: &ButtonBox, rect: Rect, x: f32, painter: &Painter) {
    let tall = button.label.size().y + button.detail.as_ref().map_or(0.0, |d| d.size().y);
    let top = rect.center().y - tall * 0.5;
    put(painter, pos2(x, top), &button.label);
    if let Some(detail) = &button.detail {
        put(painter, pos2(x, top + button.label.size().y), detail);
    }
}

/// What stands on a button: disc or mark, words, second line.
fn face(control: &Control, button: &ButtonBox, rect: Rect, look: ScreenStyle, painter: &Painter) {
    let first_text = button.label.size().y + button.detail.as_ref().map_or(0.0, |d| d.size().y);
    let mut top = rect.center().y - first_text * 0.5;
    let mut middle = rect.center().x;
    if let ControlStyle::Swatch(colour) = control.style {
        let disc = disc(look);
        let whole = first_text + disc + look.gap() * 0.4;
        let centre = pos2(middle, rect.center().y - whole * 0.5 + disc * 0.5);
        swatch(painter, centre, disc * 0.5, colour, control.chosen, look);
        top = centre.y + disc * 0.5 + look.gap() * 0.4;
    } else if control.chosen {
        let room = aside(control, look);
        let radius = look.body * 0.55;
        let centre = pos2(rect.left() + pad(look) + radius, rect.center().y);
        painter.circle_filled(centre, radius, look.palette.ink);
        check(painter, centre, radius, look.palette.on_ink);
        middle += room * 0.5;
    }
    // Centred words hang from the middle of their column.
    put(painter, pos2(middle, top), &button.label);
    if let Some(detail) = &button.detail {
        put(painter, pos2(middle, top + button.label.size().y), detail);
    }
}

/// A disc of a colour; its edge sets light and dark ones off from the panel.
fn swatch(painter: &Painter, centre: Pos2, radius: f32, colour: [f32; 3], chosen: bool, look: ScreenStyle) {
    let [r, g, b] = colour.map(|c| c.clamp(0.0, 1.0));
    let fill = Color32::from(Rgba::from_rgb(r, g, b));
    painter.circle(centre, radius, fill, Stroke::new(look.line() * 1.5, look.palette.ink));
    if chosen {
        // Beyond this luminance dark has more contrast than white: (1.05 / (y + 0.05)) = ((y + 0.05) / 0.05).
        let light = 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18;
        check(painter, centre, radius * 0.8, if light { theme::DARK } else { theme::LIGHT });
    }
}

/// A check mark within a circle.
fn check(painter: &Painter, centre: Pos2, radius: f32, colour: Color32) {
    let at = |x: f32, y: f32| centre + Vec2::new(x, y) * radius;
    let points = vec![at(-0.5, 0.05), at(-0.12, 0.42), at(0.52, -0.36)];
    painter.add(Shape::line(points, Stroke::new((radius * 0.24).max(2.0), colour)));
}
