//! Rigidities of the stencils around a vertex such that together they bend as the fabric does.

use glam::{DMat2, DMat3, DVec3};

use super::ring::{RingMeasure, Rings};
use crate::fibers::Direction;

/// A quadratic form on the curvature tensor (k11, k22, sqrt2 k12): the energy density of a plate, doubled.
#[derive(Debug, Clone, Copy)]
pub struct QuadraticForm(pub DMat3);

impl QuadraticForm {
    /// No energy whatever the curvature.
    const NONE: Self = Self(DMat3::ZERO);

    /// The square of one measure.
    fn square(tensor: DMat2) -> Self {
        let m = DVec3::new(
            tensor.x_axis.x,
            tensor.y_axis.y,
            std::f64::consts::FRAC_1_SQRT_2 * (tensor.x_axis.y + tensor.y_axis.x),
        );
        Self(DMat3::from_cols(m * m.x, m * m.y, m * m.z))
    }

    /// A plate of stencils along warp and weft and of the twist, with rigidities (N m).
    pub fn plate([warp, weft, twist]: [f64; 3]) -> Self {
        Self(Self::dyad(0.0) * warp + Self::dyad(2.0) * weft + DMat3::from_diagonal(DVec3::Z) * twist)
    }

    /// The square of the curvature along a direction, in eighths of a turn from the warp.
    fn dyad(eighths: f64) -> DMat3 {
        let d = glam::DVec2::from_angle(std::f64::consts::FRAC_PI_4 * eighths);
        Self::square(DMat2::from_cols(d * d.x, d * d.y)).0
    }

    /// Along both diagonals: what stands in the place of the twist where cloth has none, whose rigidities come out as they always did.
    fn diagonals() -> Self {
        Self(Self::dyad(1.0) + Self::dyad(3.0))
    }

    fn dot(&self, other: &Self) -> f64 {
        self.0.to_cols_array().iter().zip(other.0.to_cols_array()).map(|(a, b)| a * b).sum()
    }
}

/// Rounds of spreading: a checkerboard of vertices that can measure a direction and vertices that cannot is even after
/// eight to a thousandth.
const SPREADS: usize = 8;

/// What the stencils around a vertex can measure, by direction, each form times the area that measures it; and the area.
#[derive(Debug, Clone, Copy)]
struct Patch {
    forms: [QuadraticForm; 3],
    area: f64,
}

impl Patch {
    /// Moves a share of the difference to a neighbour over to this one.
    fn draw(&mut self, own: &Self, other: &Self, share: f64) {
        for ((form, own), other) in self.forms.iter_mut().zip(&own.forms).zip(&other.forms) {
            form.0 += (other.0 - own.0) * share;
        }
        self.area += (other.area - own.area) * share;
    }
}

/// Patches of cloth around each vertex, no sharper than what single vertices cannot measure is made up for by others.
pub struct Patches(Vec<Patch>);

impl Patches {
    /// Sums up what each vertex measures, all that there is where its `whole` ring does, and spreads it among neighbours so that nothing is lost. A vertex on the rim
    /// stands for itself: beyond it nothing bends.
    pub fn new(
        rings: &Rings,
        measures: &[Vec<(Direction, RingMeasure)>],
        wanted: [f64; 3],
        whole: impl Fn(usize) -> bool,
    ) -> Self {
        let of_one = QuadraticForm::plate;
        let third = if wanted[2] > 0.0 { of_one([0.0, 0.0, 1.0]) } else { QuadraticForm::diagonals() };
        let units = [of_one([1.0, 0.0, 0.0]), of_one([0.0, 1.0, 0.0]), third];
        let one = |(v, around): (usize, &Vec<(Direction, RingMeasure)>)| {
            let mut patch = Patch { forms: [QuadraticForm::NONE; 3], area: rings.area[v] };
            if whole(v) {
                patch.forms = units.map(|unit| QuadraticForm(unit.0 * patch.area));
                return patch;
            }
            for (direction, measure) in around {
                patch.forms[*direction as usize].0 += QuadraticForm::square(measure.tensor).0 * rings.area[v];
            }
            patch
        };
        let mut patches: Vec<Patch> = measures.iter().enumerate().map(one).collect();
        let inner = |v: usize| rings.beside[v].iter().map(|&u| u as usize).filter(|&u| !rings.rim[u]);
        for _ in 0..SPREADS {
            let before = patches.clone();
            for v in (0..patches.len()).filter(|&v| !rings.rim[v]) {
                for u in inner(v) {
                    // The same both ways, so that what one draws the other gives (Metropolis' weights).
                    let share = 1.0 / (1 + rings.beside[v].len().max(rings.beside[u].len())) as f64;
                    patches[v].draw(&before[v], &before[u], share);
                }
            }
        }
        Self(patches)
    }

    /// Rigidities (N m) by direction for the stencils of a vertex. What is next to nothing is left out.
    pub fn rigidities(&self, v: usize, plate: &QuadraticForm) -> [f64; 3] {
        let Patch { forms, area } = &self.0[v];
        let gram = forms.map(|row| forms.map(|column| row.dot(&column) / (area * area)));
        let wanted = forms.map(|row| row.dot(plate) / area);
        let found = least_squares_gram(&gram, &wanted);
        let most = found.iter().copied().fold(0.0, f64::max);
        found.map(|b| if b > LEAST_SHARE * most { b } else { 0.0 })
    }
}

/// A rigidity below this share of the largest comes from rounding.
const LEAST_SHARE: f64 = 1e-6;

/// Rounds of the projection below; three unknowns need some tens.
const ROUNDS: usize = 400;

/// The x >= 0 that comes nearest to A x = b.
pub fn least_squares(a: &[[f64; 3]; 3], b: &[f64; 3]) -> [f64; 3] {
    let column = |j: usize| [a[0][j], a[1][j], a[2][j]];
    let dot = |p: [f64; 3], q: [f64; 3]| p.iter().zip(q).map(|(p, q)| p * q).sum::<f64>();
    let gram = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(column(i), column(j))));
    least_squares_gram(&gram, &[0, 1, 2].map(|i| dot(column(i), *b)))
}

/// The same from A^T A and A^T b: projected Gauss-Seidel, which ends in the optimum of so small a convex problem.
fn least_squares_gram(gram: &[[f64; 3]; 3], wanted: &[f64; 3]) -> [f64; 3] {
    let mut x = [0.0; 3];
    for _ in 0..ROUNDS {
        let mut moved: f64 = 0.0;
        for i in 0..3 {
            if gram[i][i] > 0.0 {
                let rest = wanted[i] - gram[i].iter().zip(&x).map(|(g, x)| g * x).sum::<f64>();
                let next = (x[i] + rest / gram[i][i]).max(0.0);
                moved = moved.max((next - x[i]).abs() / next.max(1e-12));
                x[i] = next;
            }
        }
        if moved < 1e-12 {
            break;
        }
    }
    x
}
