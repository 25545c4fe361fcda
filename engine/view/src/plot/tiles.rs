//! A grid of coloured cells with words in them.

use super::{Anchor, Colour, Drawing, Mark};

/// A coloured cell with words in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Colour of the cell.
    pub colour: Colour,
    /// Its text.
    pub words: String,
}

/// A grid of cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tiles {
    /// Title above the grid.
    pub title: String,
    /// Labels of columns and rows.
    pub labels: [String; 2],
    /// Value of each column `[columns]`.
    pub columns: Vec<String>,
    /// Value of each row `[rows]`.
    pub rows: Vec<String>,
    /// The cells `[rows][columns]`.
    pub cells: Vec<Vec<Cell>>,
    /// Meaning of each colour.
    pub legend: Vec<(Colour, String)>,
}

/// Width and height of a cell (pixels).
const CELL: [f64; 2] = [110.0, 52.0];

/// Upper left corner of the grid (pixels).
const CORNER: [f64; 2] = [120.0, 120.0];

impl Tiles {
    /// The grid laid out, the legend below it.
    pub fn draw(&self) -> Drawing {
        let [left, top] = CORNER;
        let text = |x: f64, y: f64, anchor, words: &str| Mark::text([x, y], anchor, words);
        let mut marks =
            vec![Mark::Text { at: [16.0, 26.0], anchor: Anchor::Left, words: self.title.clone(), large: true }];
        marks.push(text(left, top - 52.0, Anchor::Left, &self.labels[0]));
        marks.push(text(16.0, top - 20.0, Anchor::Left, &self.labels[1]));
        for (c, words) in self.columns.iter().enumerate() {
            marks.push(text(left + CELL[0] * (c as f64 + 0.5), top - 20.0, Anchor::Middle, words));
        }
        for (r, words) in self.rows.iter().enumerate() {
            marks.push(text(left - 12.0, top + CELL[1] * (r as f64 + 0.5), Anchor::Right, words));
        }
        for (r, row) in self.cells.iter().enumerate() {
            for (c, cell) in row.iter().enumerate() {
                let at = [left + CELL[0] * c as f64, top + CELL[1] * r as f64];
                marks.push(Mark::Box { at, size: CELL.map(|s| s - 2.0), colour: cell.colour, hint: None });
                marks.push(text(at[0] + 0.5 * CELL[0], at[1] + 0.5 * CELL[1], Anchor::Middle, &cell.words));
            }
        }
        let below = top + CELL[1] * self.rows.len() as f64 + 24.0;
        for (k, (colour, words)) in self.legend.iter().enumerate() {
            let y = below + 26.0 * k as f64;
            marks.push(Mark::Box { at: [left, y - 8.0], size: [24.0, 16.0], colour: *colour, hint: None });
            marks.push(text(left + 34.0, y, Anchor::Left, words));
        }
        let width = left + CELL[0] * self.columns.len() as f64 + 60.0;
        let height = below + 26.0 * self.legend.len() as f64 + 12.0;
        Drawing { size: [width.max(860.0) as u32, height as u32], marks }
    }
}
