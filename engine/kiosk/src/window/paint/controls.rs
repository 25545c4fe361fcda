//! Controls: rows of buttons. Neighbours that look alike stand in one grid, so that the order on the screen is that of the Tab key.

use std::ops::Range;

use egui::{FontId, Painter, Pos2, Rect, Vec2, pos2, vec2};

use super::text::{SetText, centred, is_ideograph, left_aligned};
use super::theme::ScreenStyle;
use crate::visitor::screen::{Control, ControlStyle};

/// Most columns of a grid.
const MOST_COLUMNS: usize = 6;

/// Columns of a keypad, as those of a telephone.
const KEY_COLUMNS: usize = 3;

/// Height of the photograph on a tile, in lines of the body's type.
const TILE_LINES: f32 = 5.6;

/// The same in a column, where the words stand beside it.
const NARROW_TILE_LINES: f32 = 3.2;

/// Tighter than this, second lines that may be left out are.
const SPARE: f32 = 0.8;

/// Width of a photograph in a column, as a share of its height.
const NARROW_TILE: f32 = 0.75;

/// A button with its place.
#[derive(Debug, Clone)]
pub struct ButtonBox {
    /// Index on the screen.
    pub index: usize,
    /// Rectangle on the display (pixels).
    pub rect: Rect,
    /// Its words, and its second line.
    pub label: SetText,
    /// Second line of the button.
    pub detail: Option<SetText>,
}

impl ButtonBox {
    /// Moves it by a vector (pixels).
    pub fn shift(&mut self, by: Vec2) {
        self.rect = self.rect.translate(by);
    }
}

/// The column that buttons stand in.
struct Column<'a> {
    controls: &'a [Control],
    width: f32,
    look: ScreenStyle,
    painter: &'a Painter,
}

/// Buttons in a column of this width, from the origin down, and how high they are together.
pub fn lay(controls: &[Control], width: f32, look: ScreenStyle, painter: &Painter) -> (Vec<ButtonBox>, f32) {
    let column = Column { controls, width, look, painter };
    let (mut buttons, mut y) = (Vec::with_capacity(controls.len()), 0.0);
    for run in runs(controls) {
        if y > 0.0 {
            y += look.gap();
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
            Some(run) if alike(&controls[run.start].style, &control.style) => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

fn alike(a: &ControlStyle, b: &ControlStyle) -> bool {
    !matches!(a, ControlStyle::Primary) && std::mem::discriminant(a) == std::mem::discriminant(b)
}

impl Column<'_> {
    /// Places a run of neighbours below `y`, in as many columns as make it lowest; gives where it ends.
    fn grid(&self, run: Range<usize>, y: f32, buttons: &mut Vec<ButtonBox>) -> f32 {
        let keys = matches!(self.controls[run.start].style, ControlStyle::Key);
        let most = self.most_columns(&run);
        let tries =
            (if keys { KEY_COLUMNS..=KEY_COLUMNS } else { 1..=most }).map(|columns| self.rows(&run, columns, y));
        let lowest = tries.min_by(|(_, a), (_, b)| a.total_cmp(b));
        let Some((rows, end)) = lowest else { return y };
        buttons.extend(rows);
        end
    }

    /// So many columns that every word still stands unbroken in its button.
    fn most_columns(&self, run: &Range<usize>) -> usize {
        let Self { controls, width, look, painter } = *self;
        let gap = look.gap();
        let wide = run.clone().map(|i| natural(&controls[i], look, painter)).fold(look.target, f32::max).min(width);
        (((width + gap) / (wide + gap)) as usize).clamp(1, MOST_COLUMNS.min(run.len().max(1)))
    }

    /// A run in so many columns, and where it ends.
    fn rows(&self, run: &Range<usize>, columns: usize, mut y: f32) -> (Vec<ButtonBox>, f32) {
        let Self { controls, width, look, painter } = *self;
        let gap = look.gap();
        // The same number of rows with fewer, wider columns looks calmer.
        let rows = run.len().div_ceil(columns).max(1);
        let columns = run.len().div_ceil(rows).max(1);
        let cell = ((width + gap) / columns as f32 - gap).floor();
        let mut placed = Vec::with_capacity(run.len());
        for row in 0..rows {
            let first = run.start + row * columns;
            let of_row = first.min(run.end)..(first + columns).min(run.end);
            let begun = placed.len();
            placed.extend(of_row.map(|i| button(&controls[i], i, cell, look, painter)));
            let of_row: &mut [ButtonBox] = &mut placed[begun..];
            let tall = of_row.iter().map(|b| b.rect.height()).fold(0.0, f32::max);
            for (column, button) in of_row.iter_mut().enumerate() {
                button.rect = Rect::from_min_size(pos2(column as f32 * (cell + gap), y), vec2(cell, tall));
            }
            y += tall + if row + 1 < rows { gap } else { 0.0 };
        }
        (placed, y)
    }
}

/// Least width at which a control looks well: its longest word in one piece, and its label in two lines.
fn natural(control: &Control, look: ScreenStyle, painter: &Painter) -> f32 {
    let font = font(control, look);
    let wide = |text: &str, font: FontId| left_aligned(painter, text, font, look.palette.ink, f32::INFINITY).size().x;
    // In a column, lines may end between any two ideographs, as they do in paragraphs.
    let ends = |c: char| c == ' ' || look.narrow && is_ideograph(c);
    let longest = |text: &str, font: &FontId| text.split(ends).map(|w| wide(w, font.clone())).fold(0.0, f32::max);
    let label = longest(&control.label, &font).max(wide(&control.label, font) * 0.62);
    let detail = detail(control, look).map_or(0.0, |d| longest(d, &look.small()).max(wide(d, look.small()) * 0.5));
    (label.max(detail) + aside(control, look) + 2.0 * pad(look)).ceil() + 1.0
}

/// The second line of a control, unless there is no room for it.
fn detail(control: &Control, look: ScreenStyle) -> Option<&String> {
    let is_left_out = control.is_detail_spare && look.narrow && look.squeeze < SPARE;
    control.detail.as_ref().filter(|_| !is_left_out)
}

/// Type of a control's words.
fn font(control: &Control, look: ScreenStyle) -> FontId {
    match control.style {
        ControlStyle::Swatch(_) | ControlStyle::Tile(_) => look.small(),
        ControlStyle::Quiet => look.text(),
        ControlStyle::Key => FontId { size: (look.body * 1.3).round(), ..look.label() },
        _ => look.label(),
    }
}

/// What the mark of a choice takes beside the words.
pub fn aside(control: &Control, look: ScreenStyle) -> f32 {
    if is_row(control, look) {
        picture_width(look) + pad(look)
    } else if matches!(control.style, ControlStyle::Swatch(_) | ControlStyle::Tile(_)) || !control.chosen {
        0.0
    } else {
        (look.body * 1.5).round()
    }
}

/// Diameter of the disc that shows a colour.
pub fn disc(look: ScreenStyle) -> f32 {
    (look.body * 1.7 * look.squeeze).max(look.target * 0.6).round()
}

/// Height of the photograph on a tile.
pub fn picture_height(look: ScreenStyle) -> f32 {
    let lines = if look.narrow { NARROW_TILE_LINES } else { TILE_LINES };
    (look.body * lines * look.squeeze).max(look.target).round()
}

/// Width of the photograph on a tile whose words stand beside it.
pub fn picture_width(look: ScreenStyle) -> f32 {
    (picture_height(look) * NARROW_TILE).round()
}

/// Whether a control has its words beside its photograph.
fn is_row(control: &Control, look: ScreenStyle) -> bool {
    look.narrow && matches!(control.style, ControlStyle::Tile(_))
}

/// Air within a button, left and right.
pub fn pad(look: ScreenStyle) -> f32 {
    (look.body * 0.7 * look.squeeze).round()
}

fn button(control: &Control, index: usize, width: f32, look: ScreenStyle, painter: &Painter) -> ButtonBox {
    let room = width - aside(control, look) - 2.0 * pad(look);
    let dark = matches!(control.style, ControlStyle::Primary);
    let (ink, soft) =
        if dark { (look.palette.on_accent, look.palette.on_accent) } else { (look.palette.ink, look.palette.soft) };
    let set = if is_row(control, look) { left_aligned } else { centred };
    let label = set(painter, &control.label, font(control, look), ink, room);
    let detail = detail(control, look).map(|d| set(painter, d, look.small(), soft, room));
    let words = label.size().y + detail.as_ref().map_or(0.0, |d| d.size().y);
    if is_row(control, look) {
        let tall = words.max(picture_height(look)) + 2.0 * pad(look);
        return ButtonBox { index, rect: Rect::from_min_size(Pos2::ZERO, vec2(width, tall.round())), label, detail };
    }
    let picture = if matches!(control.style, ControlStyle::Tile(_)) { picture_height(look) + pad(look) } else { 0.0 };
    let disc = if matches!(control.style, ControlStyle::Swatch(_)) { disc(look) + look.gap() * 0.4 } else { 0.0 };
    let air = match control.style {
        ControlStyle::Primary => 1.9,
        ControlStyle::Plain => 1.35,
        ControlStyle::Key => 1.1,
        ControlStyle::Quiet | ControlStyle::Swatch(_) | ControlStyle::Tile(_) => 0.9,
    };
    let tall = (words + disc + picture + look.body * air * look.squeeze).max(look.target).round();
    ButtonBox { index, rect: Rect::from_min_size(Pos2::ZERO, vec2(width, tall)), label, detail }
}
