//! A drawing as SVG text, to be put into a page as it is.

use super::{Anchor, Colour, Drawing, Mark};
use toile_assets::put_line;

/// The drawing as an SVG element.
pub fn text(drawing: &Drawing) -> String {
    let [width, height] = drawing.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\" \
         font-family=\"ui-monospace, monospace\" fill=\"#222\">\n<rect width=\"{width}\" height=\"{height}\" \
         fill=\"#fff\"/>\n"
    );
    for mark in &drawing.marks {
        put_line!(svg, "{}", element(mark));
    }
    svg.push_str("</svg>\n");
    svg
}

fn element(mark: &Mark) -> String {
    match mark {
        Mark::Line { points, colour, width, dashed } => {
            let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            let dash = if *dashed { " stroke-dasharray=\"7 5\"" } else { "" };
            let (points, colour) = (points.join(" "), hex(*colour));
            format!("<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash}/>")
        }
        Mark::Dot { at: [x, y], radius, colour, ring } => {
            let colour = hex(*colour);
            let paint = if *ring {
                format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"")
            } else {
                format!("fill=\"{colour}\"")
            };
            format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" {paint}/>")
        }
        Mark::Text { at: [x, y], anchor, words, large } => {
            let anchor = match anchor {
                Anchor::Left => "start",
                Anchor::Middle => "middle",
                Anchor::Right => "end",
            };
            let size = if *large { 20 } else { 14 };
            format!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" dominant-baseline=\"central\" \
                 font-size=\"{size}\">{}</text>",
                escaped(words)
            )
        }
    }
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Text with what a page would read as its own signs written out.
pub fn escaped(words: &str) -> String {
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
