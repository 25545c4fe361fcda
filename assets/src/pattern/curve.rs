//! One edge of an outline: a straight line, a cubic Bezier curve, a circle arc or a digitised curve, and what is asked of it.

use glam::{DMat2, DVec2};

/// Chords that stand for a curve where its length is taken: of a half circle 1e-5 of it are lost.
const LENGTH_CHORDS: usize = 128;

/// Chords by which crossings of a smooth curve are looked for.
const CROSSING_CHORDS: usize = 16;

/// A curve in the plane (m). A quadratic Bezier curve is kept as the cubic that it equals.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// A straight line from the first point to the second (m).
    Line([DVec2; 2]),
    /// A cubic Bezier curve: start, two control points, end.
    Cubic([DVec2; 4]),
    /// A circle arc.
    Arc {
        /// Start and end.
        ends: [DVec2; 2],
        /// Centre of the circle.
        centre: DVec2,
        /// Angle from the start to the end, counter-clockwise (rad).
        sweep: f64,
    },
    /// A digitised curve: two points or more, straight from each to the next.
    Polyline(Vec<DVec2>),
}

impl Curve {
    /// A quadratic Bezier curve.
    pub fn quadratic(start: DVec2, control: DVec2, end: DVec2) -> Self {
        let third = |p: DVec2| p + (control - p) * (2.0 / 3.0);
        Self::Cubic([start, third(start), third(end), end])
    }

    /// A circle arc by its radius, as SVG has it: the `large` one of more than half a circle, and the one that runs
    /// counter-clockwise (in a drawing with y up), which lies to the right of its chord. `None` where the radius is less
    /// than half of the chord or nothing.
    pub fn arc(ends: [DVec2; 2], radius: f64, large: bool, counter_clockwise: bool) -> Option<Self> {
        let chord = ends[1] - ends[0];
        let half = 0.5 * chord.length();
        // Half circles are written with a radius that rounding has made too short.
        let radius = if (radius - half).abs() <= 1e-6 * half { half } else { radius };
        if half <= 0.0 || !radius.is_finite() || radius < half {
            return None;
        }
        let away = (radius * radius - half * half).sqrt() * if large == counter_clockwise { -1.0 } else { 1.0 };
        let centre = 0.5 * (ends[0] + ends[1]) + chord.perp().normalize() * away;
        let short = 2.0 * (half / radius).min(1.0).asin();
        let angle = if large { std::f64::consts::TAU - short } else { short };
        Some(Self::Arc { ends, centre, sweep: if counter_clockwise { angle } else { -angle } })
    }

    /// Its start (m).
    pub fn start(&self) -> DVec2 {
        match self {
            Self::Line(p) => p[0],
            Self::Cubic(p) => p[0],
            Self::Arc { ends, .. } => ends[0],
            Self::Polyline(p) => p.first().copied().unwrap_or(DVec2::NAN),
        }
    }

    /// Its end (m).
    pub fn end(&self) -> DVec2 {
        match self {
            Self::Line(p) => p[1],
            Self::Cubic(p) => p[3],
            Self::Arc { ends, .. } => ends[1],
            Self::Polyline(p) => p.last().copied().unwrap_or(DVec2::NAN),
        }
    }

    /// The point at a parameter from 0 to 1 (m).
    pub fn point(&self, t: f64) -> DVec2 {
        match self {
            Self::Line([a, b]) => a.lerp(*b, t),
            Self::Cubic(p) => casteljau(p, t).0[3],
            Self::Arc { ends, .. } if t <= 0.0 => ends[0],
            Self::Arc { ends, .. } if t >= 1.0 => ends[1],
            Self::Arc { ends, centre, sweep } => *centre + DVec2::from_angle(sweep * t).rotate(ends[0] - *centre),
            Self::Polyline(p) => along(p, t),
        }
    }

    /// Whether it is straight.
    pub fn is_straight(&self) -> bool {
        matches!(self, Self::Line(_))
    }

    /// The same curve from its end to its start.
    pub fn reversed(&self) -> Self {
        match self.clone() {
            Self::Line([a, b]) => Self::Line([b, a]),
            Self::Cubic([a, b, c, d]) => Self::Cubic([d, c, b, a]),
            Self::Arc { ends: [a, b], centre, sweep } => Self::Arc { ends: [b, a], centre, sweep: -sweep },
            Self::Polyline(p) => Self::Polyline(p.into_iter().rev().collect()),
        }
    }

    /// The curve moved: every point `p` becomes `turn p + shift`, where `turn` keeps lengths up to one scale.
    pub fn moved(&self, turn: DMat2, shift: DVec2) -> Self {
        let place = |p: DVec2| turn * p + shift;
        match self.clone() {
            Self::Line(p) => Self::Line(p.map(place)),
            Self::Cubic(p) => Self::Cubic(p.map(place)),
            Self::Arc { ends, centre, sweep } => {
                Self::Arc { ends: ends.map(place), centre: place(centre), sweep: sweep * turn.determinant().signum() }
            }
            Self::Polyline(p) => Self::Polyline(p.into_iter().map(place).collect()),
        }
    }

    /// The parts before and after a parameter.
    pub fn split(&self, t: f64) -> [Self; 2] {
        let middle = self.point(t);
        match self.clone() {
            Self::Line([a, b]) => [Self::Line([a, middle]), Self::Line([middle, b])],
            Self::Cubic(p) => {
                let (first, second) = casteljau(&p, t);
                [Self::Cubic(first), Self::Cubic(second)]
            }
            Self::Arc { ends: [a, b], centre, sweep } => [
                Self::Arc { ends: [a, middle], centre, sweep: sweep * t },
                Self::Arc { ends: [middle, b], centre, sweep: sweep * (1.0 - t) },
            ],
            Self::Polyline(p) => {
                let at = ((t * (p.len() - 1) as f64) as usize + 1).min(p.len() - 1);
                let before = p[..at].iter().copied().filter(|q| *q != middle).chain([middle]);
                let after = p[at..].iter().copied().filter(|q| *q != middle);
                [Self::Polyline(before.collect()), Self::Polyline([middle].into_iter().chain(after).collect())]
            }
        }
    }

    /// Twice the area between the curve and the origin (m2), by Green's theorem: summed around a closed outline it is twice
    /// what the outline encloses, positive where it runs counter-clockwise.
    pub fn twice_area(&self) -> f64 {
        match self {
            Self::Line([a, b]) => a.perp_dot(*b),
            Self::Cubic([a, b, c, d]) => {
                let near = 6.0 * a.perp_dot(*b) + 3.0 * a.perp_dot(*c) + a.perp_dot(*d);
                let far = 3.0 * b.perp_dot(*c) + 3.0 * b.perp_dot(*d) + 6.0 * c.perp_dot(*d);
                (near + far) / 10.0
            }
            Self::Arc { ends: [a, b], centre, sweep } => {
                let segment = sweep - sweep.sin();
                a.perp_dot(*b) + (*a - *centre).length_squared() * segment
            }
            Self::Polyline(p) => p.windows(2).map(|p| p[0].perp_dot(p[1])).sum(),
        }
    }

    /// The angle through which its direction turns, without sign (rad).
    pub fn turn(&self) -> f64 {
        match self {
            Self::Line(_) => 0.0,
            Self::Arc { sweep, .. } => sweep.abs(),
            Self::Cubic(_) | Self::Polyline(_) => {
                let chords = self.chords(self.chord_count()).filter(|c| c.length_squared() > 0.0).collect::<Vec<_>>();
                chords.windows(2).map(|c| c[0].angle_to(c[1]).abs()).sum()
            }
        }
    }

    /// By how many chords crossings of the curve are looked for.
    pub fn chord_count(&self) -> usize {
        match self {
            Self::Line(_) => 1,
            Self::Cubic(_) | Self::Arc { .. } => CROSSING_CHORDS,
            Self::Polyline(p) => p.len().saturating_sub(1),
        }
    }

    /// The vectors of a number of chords, equal in parameter (m).
    fn chords(&self, count: usize) -> impl Iterator<Item = DVec2> + '_ {
        let at = move |i: usize| self.point(i as f64 / count as f64);
        (0..count).map(move |i| at(i + 1) - at(i))
    }

    /// Whether all of its numbers are finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Line(p) => p.iter().all(|p| p.is_finite()),
            Self::Cubic(p) => p.iter().all(|p| p.is_finite()),
            Self::Arc { ends, centre, sweep } => {
                ends.iter().all(|p| p.is_finite()) && centre.is_finite() && sweep.is_finite()
            }
            Self::Polyline(p) => p.len() > 1 && p.iter().all(|p| p.is_finite()),
        }
    }
}

/// The point at a parameter of a polyline, each of whose sides takes as much of it.
fn along(points: &[DVec2], t: f64) -> DVec2 {
    let sides = points.len().saturating_sub(1).max(1);
    let at = t.clamp(0.0, 1.0) * sides as f64;
    let i = (at as usize).min(sides - 1);
    match points.get(i..i + 2) {
        Some([a, b]) => a.lerp(*b, at - i as f64),
        _ => DVec2::NAN,
    }
}

/// De Casteljau's division of a cubic Bezier curve: the control points of both parts.
fn casteljau([a, b, c, d]: &[DVec2; 4], t: f64) -> ([DVec2; 4], [DVec2; 4]) {
    let (ab, bc, cd) = (a.lerp(*b, t), b.lerp(*c, t), c.lerp(*d, t));
    let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
    let middle = abc.lerp(bcd, t);
    ([*a, ab, abc, middle], [middle, bcd, cd, *d])
}

/// Length along a curve, so that points can be spaced evenly on it.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcLength {
    /// Length from the start to each of the chords' ends (m) `[chords + 1]`.
    upto: Vec<f64>,
}

impl ArcLength {
    /// Measures a curve.
    pub fn of(curve: &Curve) -> Self {
        let chords = match curve {
            Curve::Cubic(_) | Curve::Arc { .. } => LENGTH_CHORDS,
            Curve::Line(_) | Curve::Polyline(_) => curve.chord_count(),
        };
        let mut upto = vec![0.0];
        let mut sum = 0.0;
        for chord in curve.chords(chords) {
            sum += chord.length();
            upto.push(sum);
        }
        Self { upto }
    }

    /// Length of the whole curve (m).
    pub fn whole(&self) -> f64 {
        self.upto.last().copied().unwrap_or_default()
    }

    /// The parameter at a fraction of the length.
    pub fn parameter(&self, fraction: f64) -> f64 {
        let length = fraction.clamp(0.0, 1.0) * self.whole();
        let chords = self.upto.len() - 1;
        if chords == 0 {
            return 0.0;
        }
        let i = self.upto.partition_point(|l| *l <= length).clamp(1, chords);
        let (before, after) = (self.upto[i - 1], self.upto[i]);
        let within = if after > before { (length - before) / (after - before) } else { 0.0 };
        ((i - 1) as f64 + within.clamp(0.0, 1.0)) / chords as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: DVec2 = DVec2::new(1.0, 0.0);
    const B: DVec2 = DVec2::new(0.0, 1.0);

    /// Twice the area by many chords.
    fn by_chords(curve: &Curve) -> f64 {
        (0..4000).map(|i| curve.point(i as f64 / 4e3).perp_dot(curve.point((i + 1) as f64 / 4e3))).sum()
    }

    fn samples() -> [Curve; 5] {
        [
            Curve::Line([A, B]),
            Curve::quadratic(A, DVec2::new(2.0, 2.0), B),
            Curve::Cubic([A, DVec2::new(1.5, 1.0), DVec2::new(-0.5, 0.3), B]),
            Curve::arc([A, B], 1.2, true, true).unwrap(),
            Curve::Polyline((0..40).map(|i| DVec2::from_angle(f64::from(i * i) * 1e-3)).collect()),
        ]
    }

    #[test]
    fn areas_are_those_of_many_chords() {
        for curve in samples() {
            assert!((curve.twice_area() - by_chords(&curve)).abs() < 1e-5, "{curve:?}");
        }
    }

    #[test]
    fn a_quarter_circle_has_its_length_centre_and_side() {
        let quarter = Curve::arc([A, B], 1.0, false, true).unwrap();
        let Curve::Arc { centre, sweep, .. } = quarter else { panic!("an arc") };
        assert!(centre.length() < 1e-12 && (sweep - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!((ArcLength::of(&quarter).whole() - std::f64::consts::FRAC_PI_2).abs() < 1e-5);
        let other = Curve::arc([A, B], 1.0, false, false).unwrap();
        assert!((other.point(0.5) - (DVec2::ONE - DVec2::ONE.normalize())).length() < 1e-12);
        assert!(Curve::arc([A, B], 0.5, false, true).is_none() && Curve::arc([A, A], 1.0, false, true).is_none());
    }

    #[test]
    fn parts_reversals_and_reflections_are_the_same_curve() {
        let mirror = DMat2::from_diagonal(DVec2::new(-1.0, 1.0));
        for curve in samples() {
            let parts = curve.split(0.3);
            assert!((parts[0].end() - curve.point(0.3)).length() < 1e-12 && parts[0].end() == parts[1].start());
            let area: f64 = parts.iter().map(Curve::twice_area).sum();
            assert!((area - curve.twice_area()).abs() < 1e-12, "{curve:?}");
            assert!((curve.reversed().point(0.2) - curve.point(0.8)).length() < 1e-12, "{curve:?}");
            let reflected = curve.moved(mirror, A);
            assert!((reflected.point(0.4) - (mirror * curve.point(0.4) + A)).length() < 1e-12, "{curve:?}");
        }
    }

    #[test]
    fn fractions_of_the_length_are_evenly_spaced() {
        for curve in samples().into_iter().take(4) {
            let length = ArcLength::of(&curve);
            let points: Vec<DVec2> = (0..=20).map(|i| curve.point(length.parameter(i as f64 / 20.0))).collect();
            let chords: Vec<f64> = points.windows(2).map(|p| p[0].distance(p[1])).collect();
            let mean = chords.iter().sum::<f64>() / 20.0;
            assert!(chords.iter().all(|c| (c / mean - 1.0).abs() < 0.03), "{curve:?}: {chords:?}");
        }
    }
}
