//! The curve of a link in f64: up to three slopes and friction, over the deformation of the cloth.
//!
//! Between two knees the force is slope * d; behind a knee it goes on from there with a slope of its own: stretch that becomes
//! stiff (upper), shear that locks (both), a thread that is pushed together and gives way as an arc (lower, [`ARC_FORCE`]). In parallel a
//! slider in series with a spring, as [`FrictionElement`] has it.

use super::friction_element::{FrictionElement, STICKING};

/// Force over deformation; the deformation is a strain (1) or an angle of shear (rad), the force is per width (N/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkCurve {
    /// Slope between the knees (N/m).
    pub slope: f64,
    /// Deformations at the lower and the upper knee; infinite where there is none.
    pub knees: [f64; 2],
    /// Slopes behind them, over [`Self::slope`] (1).
    pub behind: [f64; 2],
    /// Most that friction holds (N/m): half of the loop's width.
    pub half_width: f64,
    /// Where it sticks.
    pub stuck: f64,
}

impl LinkCurve {
    /// One slope and no friction.
    pub fn plain(slope: f64) -> Self {
        Self { slope, knees: [f64::NEG_INFINITY, f64::INFINITY], behind: [1.0; 2], half_width: 0.0, stuck: 0.0 }
    }

    /// The part without friction.
    pub fn elastic(&self, d: f64) -> f64 {
        let ([lower, upper], [below, above]) = (self.knees, self.behind);
        self.slope
            * if d > upper {
                upper + above * (d - upper)
            } else if d < lower {
                lower + below * (d - lower)
            } else {
                d
            }
    }

    /// The force after it was deformed to `d`. What has given way below its lower knee does not rub: friction was measured of
    /// threads that are drawn.
    pub fn force(&mut self, d: f64) -> f64 {
        if d < self.knees[0] && self.behind[0] < 1.0 {
            self.stuck = d;
            return self.elastic(d);
        }
        let mut element = FrictionElement {
            stiffness: self.slope,
            sticking: STICKING * self.slope,
            half_width: self.half_width,
            stuck: self.stuck,
        };
        let rubs = if self.half_width > 0.0 { element.friction(d) } else { 0.0 };
        self.stuck = element.stuck;
        self.elastic(d) + rubs
    }

    /// The deformation at a force, without friction.
    pub fn deformation(&self, force: f64) -> f64 {
        let (t, [lower, upper], [below, above]) = (force / self.slope, self.knees, self.behind);
        if t > upper {
            upper + (t - upper) / above
        } else if t < lower {
            lower + (t - lower) / below
        } else {
            t
        }
    }
}

/// Force at which a straight thread of length 1 and rigidity 1 gives way. Its ends are pushed to a distance `part`, and it bows as an arc
/// of its length (Choi and Ko 2002, "Stable but responsive cloth", eq. 9): f = k^2 / (cos(k/2) - sinc(k/2)) with sinc(k/2) = `part`.
/// That is 12 where Euler's column has pi^2, because an arc is not quite the form that a column takes.
pub const ARC_FORCE: f64 = 12.0;

/// By how much that force grows when the ends have come together: a line that is within 2 % of the arc until they are at .6 of
/// their length.
pub const ARC_SLOPE: f64 = 9.5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::friction_element::read_loop;

    #[test]
    fn a_curve_is_continuous_and_can_be_inverted() {
        let link_curve = LinkCurve { knees: [-0.02, 0.03], behind: [0.01, 12.0], ..LinkCurve::plain(300.0) };
        for knee in link_curve.knees {
            assert!((link_curve.elastic(knee - 1e-9) - link_curve.elastic(knee + 1e-9)).abs() < 1e-4);
        }
        for d in [-0.5, -0.02, -0.01, 0.0, 0.02, 0.03, 0.2] {
            assert!((link_curve.deformation(link_curve.elastic(d)) - d).abs() < 1e-12);
        }
    }

    #[test]
    fn a_loop_of_shear_gives_back_its_stiffness_and_its_width() {
        // Denim of table 5, sample A: G 2.18 gf/(cm deg), 2HG 5.012 gf/cm; locked beyond 12 degrees.
        let (slope, width) = (122.5, 4.915);
        let lock = 12f64.to_radians();
        let mut link_curve =
            LinkCurve { knees: [-lock, lock], behind: [20.0; 2], half_width: 0.5 * width, ..LinkCurve::plain(slope) };
        let read = read_loop(8f64.to_radians(), [0.5, 2.5].map(f64::to_radians), |d| link_curve.force(d));
        assert!((read.slope / slope - 1.0).abs() < 1e-9 && (read.width / width - 1.0).abs() < 1e-9);
    }

    /// Force of a thread of length 1 and rigidity 1 whose ends are pushed to the distance `part`, as an arc of its length. Negative: it
    /// pushes.
    fn arc_force(part: f64) -> f64 {
        let part = part.clamp(1e-9, 1.0);
        let (mut low, mut high) = (0.0, std::f64::consts::PI);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if f64::sin(middle) / middle > part { low = middle } else { high = middle }
        }
        // cos u - sinc u is -u^2 / 3 where the arc is flat.
        let u = 0.5 * (low + high);
        if u < 1e-3 { -ARC_FORCE } else { 4.0 * u * u / (u.cos() - part) }
    }

    #[test]
    fn a_pushed_thread_gives_way_as_the_arc_does() {
        assert!((arc_force(1.0 - 1e-7) + 12.0).abs() < 1e-3);
        for part in [0.99, 0.9, 0.8, 0.7, 0.6] {
            let line = -(ARC_FORCE + ARC_SLOPE * (1.0 - part));
            assert!((line / arc_force(part) - 1.0).abs() < 0.02, "{part}: {line} of {}", arc_force(part));
        }
    }
}
