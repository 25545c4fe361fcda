//! Curves beyond one slope: stretch that is soft up to a knee and stiff behind it, shear that locks.

use super::link_curve::LinkCurve;

/// How a fabric stretches along its threads, where it was measured as a curve.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields, default))]
pub struct StretchCurves {
    /// Along the warp.
    pub warp: Option<StretchCurve>,
    /// Along the weft.
    pub weft: Option<StretchCurve>,
}

/// A curve of two slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(try_from = "CurveFile"))]
pub struct StretchCurve {
    /// Strain at the knee (%).
    pub knee_percent: f32,
    /// Load at the knee (N/m).
    pub knee_n_m: f32,
    /// Slope behind it (N/m).
    pub beyond_n_m: f32,
    /// Width of the loop (N/m): twice what friction holds.
    pub hysteresis_n_m: f32,
}

/// A curve as a file has it: its knee, or points of strain and load through which the two slopes are laid.
#[cfg(feature = "serde")]
#[derive(Debug, Clone, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveFile {
    knee_percent: Option<f32>,
    knee_n_m: Option<f32>,
    beyond_n_m: Option<f32>,
    #[serde(default)]
    hysteresis_n_m: f32,
    /// Strain (%), load (N/m).
    table: Option<Vec<[f32; 2]>>,
}

#[cfg(feature = "serde")]
impl TryFrom<CurveFile> for StretchCurve {
    type Error = String;

    fn try_from(file: CurveFile) -> Result<Self, String> {
        let CurveFile { knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m, table } = file;
        match (knee_percent, knee_n_m, beyond_n_m, table) {
            (Some(knee_percent), Some(knee_n_m), Some(beyond_n_m), None) => {
                Ok(Self { knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m })
            }
            (None, None, None, Some(points)) => {
                Self::through(&points).map(|curve| Self { hysteresis_n_m, ..curve }).ok_or_else(|| {
                    "a table of stretch needs four points or more, strain (%) and load (N/m), both rising".into()
                })
            }
            _ => Err("a curve of stretch has knee_percent, knee_n_m and beyond_n_m, or a table".into()),
        }
    }
}

/// Places that are tried for the knee of a table.
const KNEES: u32 = 400;

impl StretchCurve {
    /// Accepted figures, lowest and highest.
    pub const RANGES: [(&'static str, f32, f32); 4] = [
        ("stretch knee_percent", 0.01, 60.0),
        ("stretch knee_n_m", 0.01, 1e4),
        ("stretch beyond_n_m", 10.0, 1e6),
        ("stretch hysteresis_n_m", 0.0, 1e3),
    ];

    /// The figures of [`Self::RANGES`], in their order.
    pub fn figures(&self) -> [f32; 4] {
        [self.knee_percent, self.knee_n_m, self.beyond_n_m, self.hysteresis_n_m]
    }

    /// Slope below the knee (N/m).
    pub fn below_n_m(&self) -> f32 {
        100.0 * self.knee_n_m / self.knee_percent
    }

    /// The curve, in f64.
    pub fn link_curve(&self) -> LinkCurve {
        let slope = f64::from(self.below_n_m());
        LinkCurve {
            knees: [f64::NEG_INFINITY, f64::from(self.knee_percent) / 100.0],
            behind: [1.0, f64::from(self.beyond_n_m) / slope],
            half_width: 0.5 * f64::from(self.hysteresis_n_m),
            ..LinkCurve::plain(slope)
        }
    }

    /// The two slopes from the origin that lie nearest to some points (strain in %, load in N/m), by least squares of the load.
    /// None where there are fewer than four, or they do not rise.
    pub fn through(points: &[[f32; 2]]) -> Option<Self> {
        let points: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::from)).collect();
        let rises = points.windows(2).all(|p| p[1][0] > p[0][0] && p[1][1] > p[0][1]);
        let most = points.last().filter(|_| points.len() > 3 && rises && points[0][0] >= 0.0)?[0];
        let tried = (1..KNEES).filter_map(|k| fit(&points, most * f64::from(k) / f64::from(KNEES)));
        let [_, knee, below, beyond] = tried.min_by(|a, b| a[0].total_cmp(&b[0]))?;
        let [knee_percent, knee_n_m, beyond_n_m] = [knee, below * knee, 100.0 * beyond].map(|f| f as f32);
        Some(Self { knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m: 0.0 })
    }

    /// Of the Kawabata system's tensile test: work of the load WT (N/m, which is J/m2), linearity LT, resilience RT (1) and the extension EMT
    /// (1) at the force where it turns (N/m). The knee lies on the line between (EMT, 0) and (0, F), the width of the loop
    /// gives RT: both are found by bisection on the curve itself.
    pub fn of_kes(linearity: f64, resilience: f64, extension: f64, most: f64) -> Self {
        let mut width = 0.0;
        let mut curve = Self::linear(linearity, extension, most, width);
        let (mut low, mut high) = (0.0, 0.5 * most);
        for _ in 0..50 {
            width = 0.5 * (low + high);
            curve = Self::linear(linearity, extension, most, width);
            let [load, back] = curve.works(extension);
            if back > resilience * load { low = width } else { high = width }
        }
        if resilience >= 1.0 { Self::linear(linearity, extension, most, 0.0) } else { curve }
    }

    /// Of a linearity, with a loop of such a width: what the friction adds to the load is taken off the curve.
    fn linear(linearity: f64, extension: f64, most: f64, width: f64) -> Self {
        let of = |y: f64| {
            let [knee, load] = [extension * (1.0 - y), (most - 0.5 * width) * y];
            let beyond = (most - 0.5 * width - load) / (extension - knee);
            let [knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m] =
                [100.0 * knee, load, beyond, width].map(|f| f as f32);
            Self { knee_percent, knee_n_m, beyond_n_m, hysteresis_n_m }
        };
        let (mut low, mut high) = (0.02, 0.98);
        for _ in 0..50 {
            let y = 0.5 * (low + high);
            if of(y).works(extension)[0] < 0.5 * linearity * most * extension { low = y } else { high = y }
        }
        of(0.5 * (low + high))
    }

    /// Work of the load and of the way back, down to no force (N/m).
    pub fn works(&self, extension: f64) -> [f64; 2] {
        const STEPS: u32 = 500;
        let (mut link_curve, step) = (self.link_curve(), extension / f64::from(STEPS));
        let at = |k: u32| step * (f64::from(k) + 0.5);
        let load: f64 = (0..STEPS).map(|k| link_curve.force(at(k))).sum();
        link_curve.force(extension);
        let back: f64 = (0..STEPS).rev().map(|k| link_curve.force(at(k)).max(0.0)).sum();
        [load * step, back * step]
    }
}

/// Squared error, knee, and the two slopes (N/m a percent) nearest to some points for a knee.
fn fit(points: &[[f64; 2]], knee: f64) -> Option<[f64; 4]> {
    // Load = below * min(e, knee) + beyond * max(e - knee, 0).
    let (mut m, mut r) = ([0.0; 3], [0.0; 2]);
    for &[e, load] in points {
        let [a, b] = [e.min(knee), (e - knee).max(0.0)];
        m = [m[0] + a * a, m[1] + a * b, m[2] + b * b];
        r = [r[0] + a * load, r[1] + b * load];
    }
    let det = m[0] * m[2] - m[1] * m[1];
    let [below, beyond] = [(r[0] * m[2] - r[1] * m[1]) / det, (r[1] * m[0] - r[0] * m[1]) / det];
    let error =
        points.iter().map(|&[e, load]| (below * e.min(knee) + beyond * (e - knee).max(0.0) - load).powi(2)).sum();
    (det > 1e-12 * m[0] * m[2] && below > 0.0 && beyond > 0.0).then_some([error, knee, below, beyond])
}

/// Where shear locks: threads touch, and it goes on stiffer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize), serde(deny_unknown_fields))]
pub struct ShearLock {
    /// Angle of shear at which threads touch (degrees).
    pub degrees: f32,
    /// Slope behind it (N/m per radian).
    pub beyond_n_m: f32,
}

impl ShearLock {
    /// Accepted figures, lowest and highest.
    pub const RANGES: [(&'static str, f32, f32); 2] =
        [("shear_lock degrees", 0.5, 80.0), ("shear_lock beyond_n_m", 1.0, 1e6)];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_gives_the_two_slopes_that_it_was_made_of() {
        let link_curve = |e: f32| if e <= 2.0 { 30.0 * e } else { 60.0 + 400.0 * (e - 2.0) };
        let points: Vec<[f32; 2]> = (1..=16).map(|k| 0.25 * k as f32).map(|e| [e, link_curve(e)]).collect();
        let curve = StretchCurve::through(&points).unwrap();
        assert!((curve.knee_percent - 2.0).abs() < 0.02 && (curve.below_n_m() - 3_000.0).abs() < 30.0, "{curve:?}");
        assert!((curve.beyond_n_m - 40_000.0).abs() < 400.0);
        assert!(StretchCurve::through(&points[..3]).is_none());
        assert!(StretchCurve::through(&[[1.0, 5.0], [2.0, 4.0], [3.0, 9.0], [4.0, 12.0]]).is_none());
    }

    #[test]
    fn a_kawabata_curve_gives_back_work_linearity_and_resilience() {
        for (linearity, resilience, extension) in [(0.712, 0.54, 0.05), (0.6, 0.7, 0.03), (0.95, 0.9, 0.1)] {
            let curve = StretchCurve::of_kes(linearity, resilience, extension, 490.3);
            let [load, back] = curve.works(extension);
            assert!((load / (0.5 * linearity * 490.3 * extension) - 1.0).abs() < 1e-3, "{curve:?}");
            assert!((back / load / resilience - 1.0).abs() < 2e-3, "{} of {resilience}", back / load);
            assert!((curve.link_curve().force(extension) / 490.3 - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn work_is_the_area_below_the_curve() {
        let curve = StretchCurve { knee_percent: 2.0, knee_n_m: 60.0, beyond_n_m: 40_000.0, hysteresis_n_m: 0.0 };
        // A triangle up to the knee, and a trapezium between 60 and 860 N/m beyond.
        let area = 0.5 * 0.02 * 60.0 + 0.02 * 0.5 * (60.0 + 860.0);
        for work in curve.works(0.04) {
            assert!((work / area - 1.0).abs() < 1e-6, "{work} of {area}");
        }
    }

    #[cfg(feature = "serde")]
    #[test]
    fn a_curve_in_a_file_has_a_knee_or_a_table() {
        let read = |text: &str| toml::from_str::<StretchCurves>(text);
        let both = read("[warp]\nknee_percent = 2.0\nknee_n_m = 60.0\nbeyond_n_m = 40000.0\n[weft]\ntable = [[1.0, 30.0], [2.0, 60.0], [3.0, 460.0], [4.0, 860.0]]").unwrap();
        assert_eq!(both.warp.unwrap().below_n_m(), 3_000.0);
        assert!((both.weft.unwrap().knee_percent - 2.0).abs() < 0.02);
        assert!(read("[warp]\nknee_percent = 2.0").unwrap_err().to_string().contains("beyond_n_m"));
    }
}
