//! Controls: rows of buttons. Neighbours that look alike stand in one grid, so that what is seen has the order of the Tab key.

use std::ops::Range;

use egui::{Painter, Pos2, Rect, Vec2, pos2, vec2};

use super::layout::{Words, centred, words};
use super::theme::{self, Sizes};
use crate::guest::screen::{Control, Look};

/// Most columns of a grid.
const MOST_COLUMNS: usize = 6;

/// A button with its place.
#[derive(Debug, Clone)]
pub struct Button {
    /// Its number on the screen.
    pub index: usize,
    /// Its place.
    pub rect: Rect,
    /// Its words, and its second line.
    pub label: Words,
    /// Its second line.
    pub detail: Option<Words>,
}

impl Button {
    /// Moves it.
    pub fn shift(&mut self, by: Vec2) {
        self.rect = self.rect.translate(by);
    }
}

/// The column that buttons stand in.
struct Column<'a> {
    controls: &'a [Control],
    width: f32,
    sizes: Sizes,
    painter: &'a Painter,
}

/// Buttons in a column of this width, from the origin down, and how high they are together.
pub fn lay(controls: &[Control], width: f32, sizes: Sizes, painter: &Painter) -> (Vec<Button>, f32) {
    let column = Column { controls, width, sizes, painter };
    let (mut buttons, mut y) = (Vec::with_capacity(controls.len()), 0.0);
    for run in runs(controls) {
        if y > 0.0 {
            y += sizes.gap();
        }
        y = column.grid(run, y, &mut buttons);
    }
    (buttons, y)
}

/// Neighbours that look alike.
fn runs(controls: &[Control]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, control) in controls.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if alike(&controls[run.start].look, &control.look) => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

fn alike(a: &Look, b: &Look) -> bool {
    !matches!(a, Look::Primary) && std::mem::discriminant(a) == std::mem::discriminant(b)
}

impl Column<'_> {
    /// Places a run of neighbours below `y`; gives where it ends.
    fn grid(&self, run: Range<usize>, mut y: f32, buttons: &mut Vec<Button>) -> f32 {
        let Self { controls, width, sizes, painter } = *self;
        let gap = sizes.gap();
        let wide = run.clone().map(|i| natural(&controls[i], sizes, painter)).fold(sizes.target, f32::max).min(width);
        let room = (((width + gap) / (wide + gap)) as usize).clamp(1, MOST_COLUMNS);
        let rows = run.len().div_ceil(room).max(1);
        let columns = run.len().div_ceil(rows).max(1);
        let cell = ((width + gap) / columns as f32 - gap).floor();
        for row in 0..rows {
            let first = run.start + row * columns;
            let of_row = first.min(run.end)..(first + columns).min(run.end);
            let begun = buttons.len();
            buttons.extend(of_row.map(|i| button(&controls[i], i, cell, sizes, painter)));
            let of_row = &mut buttons[begun..];
            let tall = of_row.iter().map(|b| b.rect.height()).fold(0.0, f32::max);
            for (column, button) in of_row.iter_mut().enumerate() {
                button.rect = Rect::from_min_size(pos2(column as f32 * (cell + gap), y), vec2(cell, tall));
            }
            y += tall + if row + 1 < rows { gap } else { 0.0 };
        }
        y
    }
}

/// Width at which a control's words stand in one line, or as wide as three words of a long one.
fn natural(control: &Control, sizes: Sizes, painter: &Painter) -> f32 {
    let label = words(painter, &control.label, sizes.label(), theme::INK, f32::INFINITY).size().x;
    let detail = control.detail.as_ref();
    let detail = detail.map_or(0.0, |d| words(painter, d, sizes.small(), theme::INK, f32::INFINITY).size().x);
    // A second line may break.
    (label.max(detail * 0.6) + aside(control, sizes) + 2.0 * pad(sizes)).ceil()
}

/// What the mark of a choice takes beside the words.
pub fn aside(control: &Control, sizes: Sizes) -> f32 {
    if matches!(control.look, Look::Swatch(_)) || !control.chosen { 0.0 } else { (sizes.body * 1.5).round() }
}

/// Diameter of the disc that shows a colour.
pub fn disc(sizes: Sizes) -> f32 {
    (sizes.body * 1.7 * sizes.squeeze).max(sizes.target * 0.6).round()
}

/// Air within a button, left and right.
pub fn pad(sizes: Sizes) -> f32 {
    (sizes.body * 0.7 * sizes.squeeze).round()
}

fn button(control: &Control, index: usize, width: f32, sizes: Sizes, painter: &Painter) -> Button {
    let room = width - aside(control, sizes) - 2.0 * pad(sizes);
    let dark = matches!(control.look, Look::Primary);
    let (ink, soft) = if dark { (theme::DARK, theme::DARK) } else { (theme::INK, theme::SOFT) };
    let font = match control.look {
        Look::Swatch(_) => sizes.small(),
        Look::Quiet => sizes.text(),
        _ => sizes.label(),
    };
    let label = centred(painter, &control.label, font, ink, room);
    let detail = control.detail.as_ref().map(|d| centred(painter, d, sizes.small(), soft, room));
    let words = label.size().y + detail.as_ref().map_or(0.0, |d| d.size().y);
    let disc = if matches!(control.look, Look::Swatch(_)) { disc(sizes) + sizes.gap() * 0.4 } else { 0.0 };
    let air = match control.look {
        Look::Primary => 1.9,
        Look::Plain => 1.35,
        Look::Quiet | Look::Swatch(_) => 0.9,
    };
    let tall = (words + disc + sizes.body * air * sizes.squeeze).max(sizes.target).round();
    Button { index, rect: Rect::from_min_size(Pos2::ZERO, vec2(width, tall)), label, detail }
}
