//! A chart: series over two axes, rules, a legend at the right.

use super::axis::{Axis, figure};
use super::{Anchor, BLACK, Colour, Drawing, Mark, PALE, RULE};

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeriesStyle {
    /// Colour of line and dots.
    pub colour: Colour,
    /// Width of the line that joins its points (pixels), 0 for none.
    pub line: f64,
    /// Whether that is dashed.
    pub dashed: bool,
    /// Radius of its points (pixels), 0 for none.
    pub dot: f64,
    /// Whether they are rings.
    pub ring: bool,
}

impl SeriesStyle {
    /// Points joined by a thin line.
    pub fn joined(colour: Colour) -> Self {
        Self { colour, line: 1.5, dashed: false, dot: 3.5, ring: false }
    }

    /// A line without dots.
    pub fn line(colour: Colour, width: f64) -> Self {
        Self { colour, line: width, dashed: false, dot: 0.0, ring: false }
    }

    /// Dots without a line.
    pub fn dots(colour: Colour) -> Self {
        Self { colour, line: 0.0, dashed: false, dot: 3.5, ring: false }
    }

    /// Wide rings around points.
    pub fn rings(colour: Colour) -> Self {
        Self { colour, line: 0.0, dashed: false, dot: 8.0, ring: true }
    }
}

/// Points under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Text of the legend.
    pub name: String,
    /// Points in the units of the two axes.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub style: SeriesStyle,
}

/// Series over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title above the chart.
    pub title: String,
    /// The axis that goes to the right.
    pub x: Axis,
    /// The axis that goes upwards.
    pub y: Axis,
    /// The series, the last on top.
    pub series: Vec<Series>,
    /// Values of x with a rule across the chart, each with its words.
    pub rules: Vec<(f64, &'static str)>,
}

/// Width and height of a chart (pixels).
const SIZE: [f64; 2] = [1040.0, 560.0];

/// Room for title and label of the y axis, for the legend, for the x axis, for the y axis (pixels).
const MARGINS: [f64; 4] = [84.0, 290.0, 64.0, 80.0];

/// Height of a line of the legend (pixels).
const LEGEND_LINE: f64 = 24.0;

impl Chart {
    /// The chart laid out.
    pub fn draw(&self) -> Drawing {
        let mut marks =
            vec![Mark::Text { at: [16.0, 26.0], anchor: Anchor::Left, words: self.title.clone(), large: true }];
        self.axes(&mut marks);
        for (k, (value, words)) in self.rules.iter().enumerate() {
            self.rule(*value, words, k, &mut marks);
        }
        self.series.iter().for_each(|s| self.series(s, &mut marks));
        self.legend(&mut marks);
        Drawing { size: SIZE.map(|s| s as u32), marks }
    }

    fn axes(&self, marks: &mut Vec<Mark>) {
        let [left, right, top, bottom] = edges();
        for value in self.x.ticks() {
            let Some(x) = self.across(value) else { continue };
            marks.push(Mark::line([x, top], [x, bottom], PALE));
            marks.push(Mark::text([x, bottom + 16.0], Anchor::Middle, figure(value)));
        }
        for value in self.y.ticks() {
            let Some(y) = self.up(value) else { continue };
            marks.push(Mark::line([left, y], [right, y], PALE));
            marks.push(Mark::text([left - 8.0, y], Anchor::Right, figure(value)));
        }
        marks.push(Mark::line([left, bottom], [right, bottom], BLACK));
        marks.push(Mark::line([left, top], [left, bottom], BLACK));
        marks.push(Mark::text([0.5 * (left + right), bottom + 42.0], Anchor::Middle, self.x.label));
        marks.push(Mark::text([16.0, top - 22.0], Anchor::Left, self.y.label));
    }

    fn rule(&self, value: f64, words: &str, number: usize, marks: &mut Vec<Mark>) {
        let Some(x) = self.across(value) else { return };
        let [_, _, top, bottom] = edges();
        let points = vec![[x, top], [x, bottom]];
        marks.push(Mark::Line { points, colour: RULE, width: 1.5, dashed: true });
        let y = top + 12.0 + 20.0 * number as f64;
        marks.push(Mark::text([x - 6.0, y], Anchor::Right, words));
    }

    fn series(&self, series: &Series, marks: &mut Vec<Mark>) {
        let place = |p: &[f64; 2]| Some([self.across(p[0])?, self.up(p[1])?]);
        let points: Vec<[f64; 2]> = series.points.iter().filter_map(place).collect();
        let SeriesStyle { colour, line, dashed, dot, ring } = series.style;
        if line > 0.0 && points.len() > 1 {
            marks.push(Mark::Line { points: points.clone(), colour, width: line, dashed });
        }
        if dot > 0.0 {
            marks.extend(points.into_iter().map(|at| Mark::Dot { at, radius: dot, colour, ring }));
        }
    }

    fn legend(&self, marks: &mut Vec<Mark>) {
        let [_, right, top, _] = edges();
        for (k, series) in self.series.iter().enumerate() {
            let (x, y) = (right + 18.0, top + 12.0 + LEGEND_LINE * k as f64);
            let SeriesStyle { colour, line, dashed, dot, ring } = series.style;
            if line > 0.0 {
                marks.push(Mark::Line { points: vec![[x, y], [x + 26.0, y]], colour, width: line, dashed });
            }
            if dot > 0.0 {
                marks.push(Mark::Dot { at: [x + 13.0, y], radius: dot, colour, ring });
            }
            marks.push(Mark::text([x + 34.0, y], Anchor::Left, series.name.clone()));
        }
    }

    fn across(&self, value: f64) -> Option<f64> {
        let [left, right, ..] = edges();
        Some(left + (right - left) * self.x.place(value)?)
    }

    fn up(&self, value: f64) -> Option<f64> {
        let [_, _, top, bottom] = edges();
        Some(bottom + (top - bottom) * self.y.place(value)?)
    }
}

/// Left, right, upper and lower edge of the field (pixels).
fn edges() -> [f64; 4] {
    let [top, right, bottom, left] = MARGINS;
    [left, SIZE[0] - right, top, SIZE[1] - bottom]
}
