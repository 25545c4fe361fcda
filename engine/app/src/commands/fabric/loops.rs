//! The loops of a fabric: made by its law, read as the Kawabata system reads them, drawn beside what was measured.

use serde::Serialize;
use toile_assets::fabric::Fabric;
use toile_assets::fabric::friction_element::{FrictionElement, read_loop};
use toile_perf::plot::axis::Axis;
use toile_perf::plot::chart::{Chart, Series, SeriesStyle};
use toile_perf::plot::raster;
use toile_perf::plot::{BLACK, Drawing, SERIES_COLOURS};

use crate::exit::AppError;

/// A loop: how far it is made, between which deformations it is read, its words.
struct LoopKind {
    name: &'static str,
    /// Deformation to which the Kawabata system goes (1/m, rad).
    most: f64,
    read: [f64; 2],
    /// What the Kawabata system calls stiffness and width.
    symbols: [&'static str; 2],
    unit: [&'static str; 2],
    /// SI units in those two (1).
    of_si: [f64; 2],
    /// What units of the axes are of these (1).
    scale: [f64; 2],
}

/// KES-FB2: to 2.5 1/cm, read at .5 and 1.5.
const BENDING: [LoopKind; 2] = [bending("bending, warp"), bending("bending, weft")];

/// Both ways where they are alike.
const BOTH: LoopKind = bending("warp and weft");

const fn bending(name: &'static str) -> LoopKind {
    LoopKind {
        name,
        most: 250.0,
        read: [50.0, 150.0],
        symbols: ["B", "2HB"],
        unit: ["uN m", "mN"],
        of_si: [1e6, 1e3],
        scale: [1.0, 1e3],
    }
}

/// KES-FB1: to 8 degrees, read at .5 and 2.5.
const SHEAR: LoopKind = LoopKind {
    name: "shear",
    most: 8.0 * DEGREE,
    read: [0.5 * DEGREE, 2.5 * DEGREE],
    symbols: ["G", "2HG"],
    unit: ["N/m", "N/m"],
    of_si: [1.0, 1.0],
    scale: [1.0 / DEGREE, 1.0],
};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// One loop as measured and as the law gives it back.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopReport {
    /// Which it is.
    pub name: &'static str,
    /// Measured stiffness and width, in `unit`.
    pub measured: [f64; 2],
    /// Both as read off the law's loop.
    pub read: [f64; 2],
    /// Units of the two.
    pub unit: [&'static str; 2],
}

impl LoopReport {
    /// In a line.
    pub fn line(&self) -> String {
        let [stiffness, width] = self.unit;
        let of = |k: usize| format!("{:.3} of {:.3}", self.read[k], self.measured[k]);
        format!("{}: stiffness {} {stiffness}, width {} {width}", self.name, of(0), of(1))
    }
}

/// A loop with its element in SI units, its stiffness as measured and its width.
type MeasuredLoop = (&'static LoopKind, FrictionElement, [f64; 2]);

/// The loops that a fabric has, of bending and of shear.
fn elements(fabric: &Fabric) -> [Vec<MeasuredLoop>; 2] {
    let widths = fabric.hysteresis;
    let of = |kind: &'static LoopKind, stiffness: f32, width: f32| {
        let measured = [f64::from(stiffness), f64::from(width)];
        let [stiffness, width] = [0, 1].map(|k| measured[k] / kind.of_si[k]);
        (measured[0] > 0.0 && measured[1] > 0.0).then(|| (kind, FrictionElement::new(stiffness, width), measured))
    };
    let [warp, weft] = &BENDING;
    let bending =
        [of(warp, fabric.bend_warp_un_m, widths.bend_warp_mn), of(weft, fabric.bend_weft_un_m, widths.bend_weft_mn)];
    let shear = of(&SHEAR, fabric.shear_n_m, widths.shear_n_m);
    [bending.into_iter().flatten().collect(), shear.into_iter().collect()]
}

/// The loops of a fabric's law, read.
pub fn readings(fabric: &Fabric) -> Vec<LoopReport> {
    let of = |(kind, mut element, measured): MeasuredLoop| {
        let read = read_loop(kind.most, kind.read, |d| element.force(d));
        let [slope, width] = kind.of_si;
        LoopReport { name: kind.name, measured, read: [read.slope * slope, read.width * width], unit: kind.unit }
    };
    elements(fabric).into_iter().flatten().map(of).collect()
}

/// Points of a branch.
const POINTS: i32 = 250;

/// A loop from the virgin state to both ends and back, in the units of the axes.
fn curve(kind: &LoopKind, element: &mut FrictionElement) -> Vec<[f64; 2]> {
    let up = 0..=POINTS;
    let down = (-POINTS..POINTS).rev();
    let again = -POINTS + 1..=POINTS;
    let at = |k: i32| kind.most * f64::from(k) / f64::from(POINTS);
    up.chain(down).chain(again).map(|k| [at(k) * kind.scale[0], element.force(at(k)) * kind.scale[1]]).collect()
}

/// Where the measured lines pass: stiffness and half of the width on both sides, at the two deformations at which they are read.
fn measured(kind: &LoopKind, element: &FrictionElement) -> Vec<[f64; 2]> {
    let at =
        |d: f64, side: f64| [d * kind.scale[0], (element.stiffness * d + side * element.half_width) * kind.scale[1]];
    kind.read.into_iter().flat_map(|d| [at(d, 1.0), at(d, -1.0), at(-d, 1.0), at(-d, -1.0)]).collect()
}

/// The loops as a picture, PNG.
///
/// # Errors
/// A picture that cannot be encoded.
pub fn png(fabric: &Fabric) -> Result<Vec<u8>, AppError> {
    let mut png = Vec::new();
    raster::image(&drawing(fabric)).write_png(&mut png).map_err(AppError::internal)?;
    Ok(png)
}

/// The loops as a drawing: bending above, shear below where it was measured.
fn drawing(fabric: &Fabric) -> Drawing {
    let [mut bending, shear] = elements(fabric);
    if let [(_, _, warp), (_, _, weft)] = &bending[..]
        && warp == weft
    {
        let (_, element, measured) = bending[0];
        bending = vec![(&BOTH, element, measured)];
    }
    let mut charts = Vec::new();
    let title = |what: &str| format!("{}: {what}", fabric.title);
    if !bending.is_empty() {
        charts.push(chart(title("bending"), ["curvature (1/m)", "moment for a width (mN)"], bending));
    }
    if !shear.is_empty() {
        charts.push(chart(
            title("shear, as measured; the cloth steps without it"),
            ["angle (degrees)", "force for a width (N/m)"],
            shear,
        ));
    }
    Drawing::stacked(charts.iter().map(Chart::draw))
}

fn chart(title: String, labels: [&'static str; 2], loops: Vec<MeasuredLoop>) -> Chart {
    let mut series = Vec::new();
    for ((kind, mut element, figures), colour) in loops.into_iter().zip(SERIES_COLOURS) {
        let rings = measured(kind, &element);
        let points = curve(kind, &mut element);
        series.push(Series { name: kind.name.into(), points, style: SeriesStyle::line(colour, 2.0) });
        let [stiffness, width] = kind.symbols;
        let name =
            format!("{stiffness} {:.2} {}, {width} {:.3} {}", figures[0], kind.unit[0], figures[1], kind.unit[1]);
        series.push(Series { name, points: rings, style: SeriesStyle::rings(BLACK) });
    }
    let values = |k: usize| series.iter().flat_map(move |s: &Series| s.points.iter().map(move |p| p[k]));
    let (x, y) = (Axis::around(labels[0], false, values(0)), Axis::around(labels[1], false, values(1)));
    Chart { title, x, y, series, rules: Vec::new() }
}
