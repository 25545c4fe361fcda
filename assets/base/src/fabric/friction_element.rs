//! The force of a fabric with friction, in f64: a stiffness beside a slider in series with a spring.

/// Stiffness while it sticks over the elastic one, where nothing else is known (1): it sticks over a tenth of the deformation at
/// which the cloth stays.
pub const STICKING: f64 = 20.0;

/// One element: force = stiffness * d + clamp(sticking * (d - stuck), -half, half), where `stuck` follows d while the clamp
/// holds (Prandtl 1928, Jenkin 1922). Of bending the deformation is a curvature (1/m) and the force a moment for a width (N m/m), of
/// shear an angle (rad) and a force for a width (N/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionElement {
    /// Slope of both branches of the loop.
    pub stiffness: f64,
    /// Slope while it sticks, less [`Self::stiffness`].
    pub sticking: f64,
    /// Half of the width of the loop.
    pub half_width: f64,
    /// Where it sticks.
    pub stuck: f64,
}

impl FrictionElement {
    /// Of a stiffness and the width of its loop (2HB, 2HG); never deformed.
    pub fn new(stiffness: f64, width: f64) -> Self {
        Self { stiffness, sticking: STICKING * stiffness, half_width: 0.5 * width, stuck: 0.0 }
    }

    /// The force after it was deformed to `d`.
    pub fn force(&mut self, d: f64) -> f64 {
        self.stiffness * d + self.friction(d)
    }

    /// The part of friction in it.
    pub fn friction(&mut self, d: f64) -> f64 {
        let tried = self.sticking * (d - self.stuck);
        let held = tried.clamp(-self.half_width, self.half_width);
        if self.sticking > 0.0 && held != tried {
            self.stuck = d - held / self.sticking;
        }
        held
    }
}

/// What is read off a loop, as the Kawabata system does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopReading {
    /// Mean slope of both branches between the two deformations.
    pub slope: f64,
    /// Mean distance between the branches at these.
    pub width: f64,
}

/// Deforms to `most`, to `-most` and back, and reads slope and width between `from` and `to`: of bending between 0.5 and
/// 1.5 1/cm in a loop to 2.5, of shear between 0.5 and 2.5 degrees in a loop to 8.
pub fn read_loop(most: f64, [from, to]: [f64; 2], mut force: impl FnMut(f64) -> f64) -> LoopReading {
    const STEPS: i32 = 1_000;
    let at = |k: i32| most * f64::from(k) / f64::from(STEPS);
    let near = |d: f64| (d / most * f64::from(STEPS)).round() as i32;
    let (mut loading, mut unloading) = ([0.0; 2], [0.0; 2]);
    (0..=STEPS).for_each(|k| _ = force(at(k)));
    for k in (-STEPS..STEPS).rev() {
        let found = force(at(k));
        (0..2).filter(|&i| near([from, to][i]) == k).for_each(|i| unloading[i] = found);
    }
    for k in -STEPS + 1..=STEPS {
        let found = force(at(k));
        (0..2).filter(|&i| near([from, to][i]) == k).for_each(|i| loading[i] = found);
    }
    let span = at(near(to)) - at(near(from));
    let slopes = [loading, unloading].map(|[a, b]| (b - a) / span);
    LoopReading {
        slope: 0.5 * (slopes[0] + slopes[1]),
        width: 0.5 * (loading[0] - unloading[0] + loading[1] - unloading[1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matsudaira et al. 2015: B (N m), 2HB (N), residual curvature (1/m).
    const PUBLISHED: [[f64; 3]; 3] = [[0.118, 0.124, 52.54], [0.067, 0.033, 24.63], [0.019, 0.007, 18.42]];

    fn elements() -> impl Iterator<Item = (FrictionElement, f64)> {
        PUBLISHED.into_iter().map(|[b, width, rests]| (FrictionElement::new(b * 9.80665e-5, width * 9.80665e-3), rests))
    }

    /// Where an element comes to rest when it is let go from `d`, slowly.
    fn released(mut element: FrictionElement, d: f64) -> f64 {
        element.force(d);
        // The force rises with the deformation, whatever the state: halve.
        let (mut low, mut high) = (d.min(0.0), d.max(0.0));
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            let force = { element }.force(middle);
            if force > 0.0 { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    #[test]
    fn a_loop_gives_back_its_stiffness_and_its_width() {
        for (element, _) in elements() {
            let mut bent = element;
            let read = read_loop(250.0, [50.0, 150.0], |k| bent.force(k));
            assert!((read.slope / element.stiffness - 1.0).abs() < 1e-9);
            assert!((read.width / (2.0 * element.half_width) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn what_is_bent_far_and_let_go_stays_at_half_of_the_width_over_the_stiffness() {
        for (element, rests) in elements() {
            let found = released(element, 100.0);
            assert!((found / rests - 1.0).abs() < 1e-3, "{found} of {rests}");
            assert!((released(element, -100.0) + found).abs() < 1e-9);
        }
        assert!(released(FrictionElement::new(1.0, 0.0), 100.0).abs() < 1e-9);
    }

    #[test]
    fn what_sticks_does_not_move_where_it_sticks() {
        let mut element = FrictionElement::new(1.0, 2.0);
        element.force(0.04);
        assert_eq!(element.stuck, 0.0);
        element.force(1.0);
        let stuck = element.stuck;
        (0..100).for_each(|k| _ = element.force(1.0 - 1e-3 * f64::from(k)));
        assert_eq!(element.stuck, stuck);
    }
}
