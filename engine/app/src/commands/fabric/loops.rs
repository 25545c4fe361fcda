//! Hysteresis loops of a fabric: computed from its curves, read as the Kawabata system reads them, drawn beside the measured values.

use serde::Serialize;
use toile_base::fabric::Fabric;
use toile_base::fabric::friction_element::read_loop;
use toile_base::fabric::link_curve::LinkCurve;
use toile_base::fabric::stretch_curve::StretchCurve;
use toile_cli::exit::AppError;
use toile_view::plot::axis::Axis;
use toile_view::plot::chart::{Chart, Series, SeriesStyle};
use toile_view::plot::raster;
use toile_view::plot::{BLACK, Drawing, SERIES_COLOURS};

/// Kind of a loop: its range of deformation, the range in which it is read, its names and units.
#[derive(Clone, Copy)]
struct LoopKind {
    name: &'static str,
    /// Deformations between which it goes to and fro (1/m, rad, 1): the Kawabata system's.
    most: [f64; 2],
    read: [f64; 2],
    /// Symbols of the Kawabata system for stiffness and width.
    symbols: [&'static str; 2],
    unit: [&'static str; 2],
    /// SI units in those two (1).
    of_si: [f64; 2],
    /// Units of the axes in these (1).
    scale: [f64; 2],
}

/// KES-FB2: to 2.5 1/cm, read at 0.5 and 1.5.
const fn bending(name: &'static str) -> LoopKind {
    LoopKind {
        name,
        most: [-250.0, 250.0],
        read: [50.0, 150.0],
        symbols: ["B", "2HB"],
        unit: ["uN m", "mN"],
        of_si: [1e6, 1e3],
        scale: [1.0, 1e3],
    }
}

/// KES-FB1: to 8 degrees, read at 0.5 and 2.5.
const SHEAR: LoopKind = LoopKind {
    name: "shear",
    most: [-8.0 * DEGREE, 8.0 * DEGREE],
    read: [0.5 * DEGREE, 2.5 * DEGREE],
    symbols: ["G", "2HG"],
    unit: ["N/m", "N/m"],
    of_si: [1.0, 1.0],
    scale: [1.0 / DEGREE, 1.0],
};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Behind the knee by a half, as drawn; read below it.
fn stretch(name: &'static str, curve: &StretchCurve) -> LoopKind {
    let knee = 0.01 * f64::from(curve.knee_percent);
    LoopKind {
        name,
        most: [0.0, 1.5 * knee],
        read: [0.4 * knee, 0.8 * knee],
        symbols: ["E", "width"],
        unit: ["N/m", "N/m"],
        of_si: [1.0, 1.0],
        scale: [100.0, 1.0],
    }
}

/// One loop as measured and as computed from the curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopReport {
    /// Name of the loop.
    pub name: &'static str,
    /// Measured stiffness and width, in `unit`.
    pub measured: [f64; 2],
    /// Both as read off the computed loop.
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

/// A loop with its curve in SI units, its measured stiffness and width.
type MeasuredLoop = (LoopKind, LinkCurve, [f64; 2]);

/// The loops that a fabric has, of bending, of shear and of stretch.
fn measured_loops(fabric: &Fabric) -> [Vec<MeasuredLoop>; 3] {
    let widths = fabric.hysteresis;
    let of = |kind: LoopKind, stiffness: f32, width: f32| {
        let measured = [f64::from(stiffness), f64::from(width)];
        let [stiffness, width] = [0, 1].map(|k| measured[k] / kind.of_si[k]);
        (kind, LinkCurve { half_width: 0.5 * width, ..LinkCurve::plain(stiffness) }, measured)
    };
    let warp = of(bending("bending, warp"), fabric.bend_warp_un_m, widths.bend_warp_mn);
    let weft = of(bending("bending, weft"), fabric.bend_weft_un_m, widths.bend_weft_mn);
    let rubs = |(_, _, [stiffness, width]): &MeasuredLoop| *stiffness > 0.0 && *width > 0.0;
    let mut shear = of(SHEAR, fabric.shear_n_m, widths.shear_n_m);
    if let Some(lock) = fabric.shear_lock {
        let knee = f64::from(lock.degrees) * DEGREE;
        (shear.1.knees, shear.1.behind) = ([-knee, knee], [f64::from(lock.beyond_n_m) / shear.1.slope; 2]);
    }
    let curves = [("stretch, warp", fabric.stretch.warp), ("stretch, weft", fabric.stretch.weft)];
    let curves = curves.into_iter().filter_map(|(name, curve)| {
        let curve = curve?;
        Some((stretch(name, &curve), curve.link_curve(), [curve.below_n_m(), curve.hysteresis_n_m].map(f64::from)))
    });
    [
        [warp, weft].into_iter().filter(rubs).collect(),
        Some(shear).filter(|s| rubs(s) || fabric.shear_lock.is_some()).into_iter().collect(),
        curves.collect(),
    ]
}

/// Whether the fabric has a loop to draw.
pub fn any(fabric: &Fabric) -> bool {
    measured_loops(fabric).iter().any(|loops| !loops.is_empty())
}

/// The loops of a fabric's curves, read.
pub fn readings(fabric: &Fabric) -> Vec<LoopReport> {
    let of = |(kind, mut link_curve, measured): MeasuredLoop| {
        let read = read_loop(kind.most[1], kind.read, |d| link_curve.force(d));
        let [slope, width] = kind.of_si;
        LoopReport { name: kind.name, measured, read: [read.slope * slope, read.width * width], unit: kind.unit }
    };
    measured_loops(fabric).into_iter().flatten().map(of).collect()
}

/// Points of a branch.
const POINTS: i32 = 250;

/// A loop from the virgin state to its far end, to the other and back, in the units of the axes. Stretch ends where nothing pulls any
/// more.
fn curve(kind: &LoopKind, link_curve: &mut LinkCurve) -> Vec<[f64; 2]> {
    let [low, high] = kind.most.map(|end| (end / kind.most[1] * f64::from(POINTS)) as i32);
    let at = |k: i32| kind.most[1] * f64::from(k) / f64::from(POINTS);
    let mut points = Vec::new();
    for k in (0..=high).chain((low..high).rev()).chain((low + 1..=high).filter(|_| low < 0)) {
        let force = link_curve.force(at(k));
        if low == 0 && force < 0.0 {
            break;
        }
        points.push([at(k) * kind.scale[0], force * kind.scale[1]]);
    }
    points
}

/// Where the measured lines pass: stiffness and half of the width on both sides, at the two deformations at which they are read.
fn measured(kind: &LoopKind, link_curve: &LinkCurve) -> Vec<[f64; 2]> {
    let at =
        |d: f64, side: f64| [d * kind.scale[0], (link_curve.slope * d + side * link_curve.half_width) * kind.scale[1]];
    let both = |d: f64| if kind.most[0] < 0.0 { vec![d, -d] } else { vec![d] };
    kind.read.into_iter().flat_map(both).flat_map(|d| [at(d, 1.0), at(d, -1.0)]).collect()
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

/// The loops as a drawing: bending above, shear and stretch below where they were measured.
fn drawing(fabric: &Fabric) -> Drawing {
    let [bent, shear, stretched] = measured_loops(fabric);
    let [bent, stretched] = [bent, stretched].map(|loops| match &loops[..] {
        [(kind, warp, measured), (_, weft, _)] if warp == weft => {
            vec![(LoopKind { name: "warp and weft", ..*kind }, *warp, *measured)]
        }
        _ => loops,
    });
    let title = |what: &str| format!("{}: {what}", fabric.title);
    let axes = [
        ("bending", ["curvature (1/m)", "moment for a width (mN)"]),
        ("shear", ["angle (degrees)", "force for a width (N/m)"]),
        ("stretch", ["strain (%)", "force for a width (N/m)"]),
    ];
    let loops = [bent, shear, stretched].into_iter().zip(axes).filter(|(loops, _)| !loops.is_empty());
    let charts: Vec<Chart> = loops.map(|(loops, (what, labels))| chart(title(what), labels, loops)).collect();
    Drawing::stacked(charts.iter().map(Chart::draw))
}

fn chart(title: String, labels: [&'static str; 2], loops: Vec<MeasuredLoop>) -> Chart {
    let mut series = Vec::new();
    for ((kind, mut link_curve, figures), colour) in loops.into_iter().zip(SERIES_COLOURS) {
        let rings = measured(&kind, &link_curve);
        let points = curve(&kind, &mut link_curve);
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
