//! Plots: a chart is described once, laid out as marks, and drawn as SVG text or as pixels; and the page that shows it.

pub mod axis;
pub mod chart;
pub mod page;
pub mod raster;
pub mod svg;

/// An sRGB colour.
pub type Colour = [u8; 3];

/// Colour of text and axes.
pub const BLACK: Colour = [34, 34, 34];

/// Lines of the grid.
pub const PALE: Colour = [225, 225, 225];

/// Rules across a chart.
pub const RULE: Colour = [190, 40, 40];

/// Inks of series, apart for most colour-blind eyes (Okabe & Ito 2008).
pub const SERIES_COLOURS: [Colour; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0]];

/// The end of a text that lies at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Left end of the text.
    Left,
    /// Middle of the text.
    Middle,
    /// Right end of the text.
    Right,
}

/// One thing that is drawn, in pixels from the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A line from point to point.
    Line {
        /// Its corners, in order (pixels).
        points: Vec<[f64; 2]>,
        /// Colour of the line.
        colour: Colour,
        /// Width of the line (pixels).
        width: f64,
        /// Whether it is dashed.
        dashed: bool,
    },
    /// A disc, or a ring.
    Dot {
        /// Its middle (pixels).
        at: [f64; 2],
        /// Its radius (pixels).
        radius: f64,
        /// Colour of the dot.
        colour: Colour,
        /// Whether it is a ring.
        ring: bool,
    },
    /// One line of text, centred on a height.
    Text {
        /// The end that the anchor names.
        at: [f64; 2],
        /// End of the text that lies at `at`.
        anchor: Anchor,
        /// The line of text.
        words: String,
        /// Whether they are a title.
        large: bool,
    },
}

impl Mark {
    /// A line of text in normal size.
    pub fn text(at: [f64; 2], anchor: Anchor, words: impl Into<String>) -> Self {
        Self::Text { at, anchor, words: words.into(), large: false }
    }

    /// A straight line.
    pub fn line(from: [f64; 2], to: [f64; 2], colour: Colour) -> Self {
        Self::Line { points: vec![from, to], colour, width: 1.0, dashed: false }
    }
}

/// A picture as marks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// The marks, drawn in this order.
    pub marks: Vec<Mark>,
}

impl Drawing {
    /// Drawings one below the other.
    pub fn stacked(all: impl IntoIterator<Item = Self>) -> Self {
        let mut whole = Self::default();
        for drawing in all {
            let below = f64::from(whole.size[1]);
            let down = |at: &mut [f64; 2]| at[1] += below;
            let moved = drawing.marks.into_iter().map(|mut mark| {
                match &mut mark {
                    Mark::Line { points, .. } => points.iter_mut().for_each(down),
                    Mark::Dot { at, .. } | Mark::Text { at, .. } => down(at),
                }
                mark
            });
            whole.marks.extend(moved);
            whole.size = [whole.size[0].max(drawing.size[0]), whole.size[1] + drawing.size[1]];
        }
        whole
    }
}
