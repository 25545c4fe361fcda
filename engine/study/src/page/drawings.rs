//! Drawings of a study as SVG: shares by size, the map of people, the way to an answer.

use toile_assets::put_line;

use crate::shares::{GarmentSummary, Share};

/// Colours of sizes, from the smallest up, which colour-blind readers tell from their neighbours.
const COLOURS: [&str; 8] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#806000", "#444444"];

/// Of people whom no size fits.
const UNFITTED: &str = "#c9c9c9";

/// Text as it stands between elements.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

pub(super) fn percent(share: &Share) -> String {
    format!("{:.1} % ({:.1} to {:.1})", share.share * 100.0, share.low * 100.0, share.high * 100.0)
}

fn svg(width: f64, height: f64, inside: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" role=\"img\" \
         font-family=\"system-ui, sans-serif\" font-size=\"13\" fill=\"#222\">\n{inside}</svg>\n"
    )
}

/// Bars of the share of people of each size: those whom it fits in colour, the others grey, with the interval of the former.
pub(super) fn shares(garment: &GarmentSummary) -> String {
    let most = garment.sizes.iter().map(|s| s.recommended.high).fold(0.01, f64::max);
    let (left, width, row) = (70.0, 620.0, 26.0);
    let x = |share: f64| left + share / most * width;
    let mut inside = String::new();
    for (i, size) in garment.sizes.iter().enumerate() {
        let y = 8.0 + row * i as f64;
        let (name, colour) = (escaped(&size.size), COLOURS[i % COLOURS.len()]);
        put_line!(inside, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{name}</text>", left - 8.0, y + 14.0);
        let bar = |share: f64, colour: &str| {
            format!(
                "<rect x=\"{left}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"18\" fill=\"{colour}\"/>",
                x(share) - left
            )
        };
        put_line!(inside, "{}{}", bar(size.recommended.share, UNFITTED), bar(size.fitted.share, colour));
        let (low, high, middle) = (x(size.fitted.low), x(size.fitted.high), y + 9.0);
        put_line!(
            inside,
            "<path d=\"M{low:.1} {middle}H{high:.1}M{low:.1} {}v8M{high:.1} {}v8\" stroke=\"#222\" fill=\"none\"/>",
            y + 5.0,
            y + 5.0
        );
        let figure = format!("{:.1} % fitted of {:.1} %", size.fitted.share * 100.0, size.recommended.share * 100.0);
        put_line!(
            inside,
            "<text x=\"{:.1}\" y=\"{}\">{figure}</text>",
            x(size.recommended.share.max(size.fitted.high)) + 10.0,
            y + 14.0
        );
    }
    svg(920.0, 16.0 + row * garment.sizes.len() as f64, &inside)
}

/// Stature against the girth that designates sizes: every person by the size recommended, filled where it fits.
pub(super) fn map(garment: &GarmentSummary) -> String {
    let girth = |w: &crate::shares::SummaryWearer| match garment.primary.as_str() {
        "waist" => w.girths_mm[1],
        "hip" => w.girths_mm[2],
        _ => w.girths_mm[0],
    };
    let range = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::MAX, f64::min);
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        ((low / 50.0).floor() * 50.0, ((high / 50.0).ceil() * 50.0).max((low / 50.0).floor() * 50.0 + 50.0))
    };
    if garment.map.is_empty() {
        return String::new();
    }
    let (x0, x1) = range(garment.map.iter().map(girth).collect());
    let (y0, y1) = range(garment.map.iter().map(|w| w.stature_mm).collect());
    let (left, top, width, height) = (64.0, 34.0, 760.0, 400.0);
    let x = |mm: f64| left + (mm - x0) / (x1 - x0) * width;
    let y = |mm: f64| top + (y1 - mm) / (y1 - y0) * height;
    let mut inside = String::new();
    // The region of a size: where four of five of those are to whom it is recommended.
    for (i, size) in garment.sizes.iter().enumerate() {
        let mut at: Vec<f64> = garment.map.iter().filter(|w| w.size == size.size).map(girth).collect();
        at.sort_by(f64::total_cmp);
        if at.len() < 5 {
            continue;
        }
        let (low, high) = (x(at[at.len() / 10]), x(at[at.len() * 9 / 10]));
        let (colour, name) = (COLOURS[i % COLOURS.len()], escaped(&size.size));
        put_line!(
            inside,
            "<rect x=\"{low:.1}\" y=\"{top}\" width=\"{:.1}\" height=\"{height}\" fill=\"{colour}\" opacity=\"0.12\"/>\
             <text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\" fill=\"{colour}\" font-weight=\"bold\">{name}</text>",
            high - low,
            0.5 * (low + high),
            top - 8.0 - 12.0 * (i % 2) as f64
        );
    }
    let step = |from: f64, to: f64| if to - from > 500.0 { 100.0 } else { 50.0 };
    let ticks =
        |from: f64, to: f64| (0u32..).map(move |i| from + step(from, to) * f64::from(i)).take_while(move |v| *v <= to);
    for mm in ticks(x0, x1) {
        put_line!(
            inside,
            "<path d=\"M{:.1} {top}v{height}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{mm}</text>",
            x(mm),
            x(mm),
            top + height + 18.0
        );
    }
    for mm in ticks(y0, y1) {
        put_line!(
            inside,
            "<path d=\"M{left} {:.1}h{width}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{mm}</text>",
            y(mm),
            left - 6.0,
            y(mm) + 4.0
        );
    }
    for w in &garment.map {
        let place = garment.sizes.iter().position(|s| s.size == w.size).unwrap_or(0);
        let colour = COLOURS[place % COLOURS.len()];
        let paint = if w.fits { format!("fill=\"{colour}\"") } else { format!("fill=\"#fff\" stroke=\"{colour}\"") };
        put_line!(inside, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.6\" {paint}/>", x(girth(w)), y(w.stature_mm));
    }
    put_line!(
        inside,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{} girth (mm)</text>",
        left + 0.5 * width,
        top + height + 38.0,
        garment.primary
    );
    put_line!(
        inside,
        "<text x=\"14\" y=\"{}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {})\">stature (mm)</text>",
        top + 0.5 * height,
        top + 0.5 * height
    );
    svg(860.0, top + height + 48.0, &inside)
}

/// The share fitted with more and more people, and its interval.
pub(super) fn convergence(garment: &GarmentSummary) -> String {
    let all = &garment.convergence;
    let (left, top, width, height) = (64.0, 10.0, 560.0, 160.0);
    let low = all.iter().map(|c| c.fitted.low).fold(1.0, f64::min);
    let high = all.iter().map(|c| c.fitted.high).fold(0.0, f64::max).max(low + 0.02);
    let x = |i: usize| left + width * (i as f64 + 0.5) / all.len() as f64;
    let y = |share: f64| top + height * (high - share) / (high - low);
    let mut inside = format!("<path d=\"M{left} {top}v{height}h{width}\" stroke=\"#888\" fill=\"none\"/>\n");
    for share in [low, high] {
        put_line!(
            inside,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{:.1} %</text>",
            left - 6.0,
            y(share) + 4.0,
            share * 100.0
        );
    }
    for (i, at) in all.iter().enumerate() {
        let (x, from, to) = (x(i), y(at.fitted.low), y(at.fitted.high));
        put_line!(
            inside,
            "<path d=\"M{x:.1} {from:.1}V{to:.1}\" stroke=\"#0072b2\" stroke-width=\"2\"/><circle cx=\"{x:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"#0072b2\"/>",
            y(at.fitted.share)
        );
        put_line!(
            inside,
            "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            top + height + 18.0,
            at.people
        );
    }
    put_line!(
        inside,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">people</text>",
        left + 0.5 * width,
        top + height + 36.0
    );
    svg(660.0, top + height + 44.0, &inside)
}
