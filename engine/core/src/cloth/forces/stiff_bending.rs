//! Stiff bending, in stages: bending that is stiffer than a substep can carry as a force.
//!
//! Implicit Euler asks for the change of velocity u with (I + Z) u = r, where Z = dt^2 W K, r = dt (g - W K (x + dt v)).
//! One step of the stabilised Runge-Kutta-Chebyshev method for u' = r - Z u (van der Houwen, Sommeijer 1980; Verwer
//! 1996, "Explicit Runge-Kutta methods for parabolic partial differential equations", eq. 2.4-2.7) comes close to it on
//! any mesh with nothing but the forces themselves: m stages are stable up to Z = .96 m^2. It gives u = p(Z) r with
//! p(0) = 1, so that what does not bend falls freely, and u = 0 where the forces are even, so that statics are those of
//! the whole stiffness. Between, Z p(Z) stays within 1 +- .29: stiff motion is damped as implicit Euler damps it.

use glam::Vec3A;

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, Store, V3, WriteColumn};

/// Damping of the stages: inside of the stable range what is left of a motion is at most 1 / cosh(2) = .27 of it. Below
/// a third, semi-implicit Euler stays stable with it.
const DAMPING: f64 = 2.0;

/// Most stages: a stiffness 12,000 times what a force can be. What is stiffer is weakened.
pub const MAX_BENDING_STAGES: u32 = 160;

/// One stage: newest = ahead * newest + behind * the one before + forced * (r - Z newest).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ChebyshevStage {
    /// Coefficient mu of the recursion (1).
    pub ahead: f32,
    /// Coefficient nu of the recursion (1).
    pub behind: f32,
    /// mu with a tilde.
    pub forced: f32,
}

/// T_0..T_m at w0, and T_m' there.
fn chebyshev(m: u32) -> ([f64; MAX_BENDING_STAGES as usize + 1], f64, f64) {
    let w0 = 1.0 + DAMPING / f64::from(m * m);
    let (mut t, mut slope) = ([1.0; MAX_BENDING_STAGES as usize + 1], [0.0, 1.0]);
    t[1] = w0;
    for j in 2..=m as usize {
        t[j] = 2.0 * w0 * t[j - 1] - t[j - 2];
        slope = [slope[1], 2.0 * t[j - 1] + 2.0 * w0 * slope[1] - slope[0]];
    }
    (t, slope[1], w0)
}

/// The largest Z that `m` stages carry, 2 and more.
pub fn carried(m: u32) -> f32 {
    let (t, slope, w0) = chebyshev(m);
    ((w0 + 1.0) * slope / t[m as usize]) as f32
}

/// The fewest stages, 2 to [`MAX_BENDING_STAGES`], that are enough for a garment; `suffice` is given the largest Z that they carry.
pub fn needed(suffice: impl Fn(f32) -> bool) -> u32 {
    (2..MAX_BENDING_STAGES).find(|&m| suffice(carried(m))).unwrap_or(MAX_BENDING_STAGES)
}

/// The stages 1..=m, into the first `m` places.
pub fn coefficients(m: u32, to: &mut [ChebyshevStage]) {
    let (t, slope, w0) = chebyshev(m);
    let w1 = t[m as usize] / slope;
    for (j, stage) in (1..).zip(to.iter_mut().take(m as usize)) {
        *stage = if j == 1 {
            ChebyshevStage { ahead: 0.0, behind: 0.0, forced: (w1 / w0) as f32 }
        } else {
            let ratio = t[j - 1] / t[j];
            ChebyshevStage {
                ahead: (2.0 * w0 * ratio) as f32,
                behind: (-t[j - 2] / t[j]) as f32,
                forced: (2.0 * w1 * ratio) as f32,
            }
        };
    }
}

/// Room for the stages: r, and two changes of velocity.
#[derive(Debug, Clone)]
pub struct StiffBendingScratch([[Store; 3]; 3]);

impl StiffBendingScratch {
    /// For so many particles.
    pub fn new(particles: usize) -> Self {
        Self(std::array::from_fn(|_| std::array::from_fn(|_| Store::zeros(particles))))
    }

    /// The scratch as columns that kernels write to.
    pub fn columns(&mut self) -> [[WriteColumn<'_>; 3]; 3] {
        self.0.each_mut().map(|three| three.each_mut().map(Store::column))
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.0.iter().flatten().map(Store::bytes).sum()
    }
}

/// What comes before the forces of a stage.
#[derive(Clone, Copy)]
pub enum StiffBendingUpdate<'a> {
    /// r = what else accelerates; the place ahead goes where the first change of velocity will be.
    Begin {
        /// Gravity over the substep (m/s).
        gravity_step: Vec3A,
        /// Accelerations besides gravity (m/s2).
        acceleration: Option<[WriteColumn<'a>; 3]>,
        /// Length of the substep (s).
        dt: f32,
    },
    /// The first two stages: nothing has changed before them.
    First([ChebyshevStage; 2]),
    /// A later one, from its number on; 3 and more.
    Next(u32, ChebyshevStage),
    /// The change of velocity after so many stages is added.
    End(u32),
}

/// One owner's particles take a turn.
pub struct ApplyStiffBending<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
    /// r, and two changes of velocity.
    pub scratch_columns: [[WriteColumn<'a>; 3]; 3],
    /// The stage of the recursion that is applied now.
    pub turn: StiffBendingUpdate<'a>,
}

/// Index of the scratch column that holds the change of velocity after stage `j`.
pub fn place(j: u32) -> usize {
    1 + (j as usize + 1) % 2
}

impl Kernel for ApplyStiffBending<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        self.columns = self.columns.level();
        for &(first, len) in self.spans {
            let (mut at, end) = (first as usize, (first + len) as usize);
            while at < end {
                let n = (end - at).min(L::N);
                self.some::<L>(at, n);
                at += n;
            }
        }
    }
}

impl ApplyStiffBending<'_> {
    #[inline(always)]
    fn some<L: Lanes>(&self, at: usize, n: usize) {
        let (c, [r, one, two]) = (&self.columns, self.scratch_columns);
        match self.turn {
            StiffBendingUpdate::Begin { gravity_step, acceleration, dt } => {
                let w = if n == L::N { L::load(c.w, at) } else { L::load_part(c.w, at, n) };
                let mut change = V3::<L>::splat(gravity_step);
                if let Some(acceleration) = acceleration {
                    change = change + V3::load(acceleration, at, n) * L::splat(dt);
                }
                let none = V3::splat(Vec3A::ZERO);
                change.select(L::splat(0.0).lt(w), none).store(r, at, n);
                (V3::<L>::load(c.x, at, n) + V3::load(c.v, at, n) * L::splat(dt)).store(one, at, n);
            }
            StiffBendingUpdate::First([first, second]) => {
                let r = V3::<L>::load(r, at, n);
                let begun = r * L::splat(first.forced);
                begun.store(one, at, n);
                (begun * L::splat(second.ahead) + r * L::splat(second.forced)).store(two, at, n);
            }
            StiffBendingUpdate::Next(j, stage) => {
                let [newest, to] = [self.scratch_columns[place(j - 1)], self.scratch_columns[place(j)]];
                let sum = V3::<L>::load(newest, at, n) * L::splat(stage.ahead)
                    + V3::load(to, at, n) * L::splat(stage.behind)
                    + V3::load(r, at, n) * L::splat(stage.forced);
                sum.store(to, at, n);
            }
            StiffBendingUpdate::End(m) => {
                let change = V3::<L>::load(self.scratch_columns[place(m)], at, n);
                (V3::<L>::load(c.v, at, n) + change).store(c.v, at, n);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u after the stages, for one Z and r = 1.
    fn solved(m: u32, z: f64) -> f64 {
        let mut stages = [ChebyshevStage::default(); MAX_BENDING_STAGES as usize];
        coefficients(m, &mut stages);
        let (mut before, mut newest) = (0.0, f64::from(stages[0].forced));
        for s in &stages[1..m as usize] {
            let next =
                f64::from(s.ahead) * newest + f64::from(s.behind) * before + f64::from(s.forced) * (1.0 - z * newest);
            (before, newest) = (newest, next);
        }
        newest
    }

    #[test]
    fn what_does_not_bend_falls_freely_and_stiff_motion_is_damped_like_implicit_euler() {
        for m in 2..=MAX_BENDING_STAGES {
            assert!((solved(m, 0.0) - 1.0).abs() < 2e-5, "{m} stages: {}", solved(m, 0.0));
            let most = f64::from(carried(m));
            for i in 1..=200 {
                let z = most * f64::from(i) / 200.0;
                let answer = z * solved(m, z);
                assert!((0.0..1.3).contains(&answer) && (z < 4.0 || answer > 0.7), "{m} stages, Z {z}: {answer}");
            }
        }
    }

    #[test]
    fn twice_the_stages_carry_four_times_the_stiffness() {
        assert!((carried(2) - 4.28).abs() < 0.02 && (carried(64) / carried(32) - 4.0).abs() < 0.05);
        let needed = |z: f32| needed(|most| most >= z);
        assert_eq!((needed(0.1), needed(4.2), needed(1e9)), (2, 2, MAX_BENDING_STAGES));
        assert!((2..MAX_BENDING_STAGES).all(|m| needed(carried(m)) <= m && needed(carried(m) * 1.001) == m + 1));
    }
}
