//! Calibration: the sliders at which a body has the given measures, all at once.
//!
//! Given measures are met; the others take the values that people have. The readings of a body are held against a normal
//! distribution of people ([`People`]), so that unmeasured values follow from measured ones by regression, and a
//! short term keeps neighbouring segments together. The sum of squares is brought down by Gauss-Newton steps with
//! the exact gradients of the tape, within bounds of each slider.

use glam::Vec3;

use super::base::BaseBody;
use super::gauge::{Gauge, Gradient};
use super::morph::{Morphs, Setting};
use super::people::{People, allowance};
use super::reading::{MeshMeasure, READINGS};
use super::slider::{PARAMETERS, SLIDERS, Slider};
use toile_base::numeric::linear;
use toile_base::numeric::linear::Pivot;

/// Error at which a given measure pulls as hard as one standard deviation of people (m): conflicts with what is
/// expected move a given measure by micrometres.
const TIGHT: f64 = 0.1e-3;

/// Steps at most; people take three to six.
const STEPS: usize = 25;

/// Error of every given measure at which the fitting may stop (m).
const CLOSE_ENOUGH: f64 = 0.02e-3;

/// Change of every slider below which it has settled: a few hundredths of a millimetre on any girth.
const SETTLED: f64 = 2e-4;

/// Spread of a slider about what its neighbours would give it.
const TOGETHER: f64 = 0.08;

/// Spread of a slider on its own, as a fraction or in metres: wide, only there to hold what no measure holds.
const ALONE: [f64; 2] = [0.4, 0.08];

/// Share of a stature's departure from the mean that head, hands and feet take part in, as a power, and how far they
/// stray from it: so short and tall, slight and stout people have heads of about one size (their deviation in ANSUR II
/// is 3.5 %, most of it not stature's).
const HEADS: [f64; 2] = [0.5, 0.015];

/// How far a segment may grow or shrink, as a fraction of the base.
const GIRTHS: [f64; 2] = [-0.45, 1.1];

/// How far each length may be stretched either way (m), in the order of the sliders: about a third of it.
const LENGTHS: [f64; 6] = [0.12, 0.12, 0.085, 0.075, 0.04, 0.18];

/// How far the whole may be scaled either way, as a logarithm.
const SCALE: f64 = 0.25;

/// Sliders that follow the mean of two others where nothing else holds them.
const FOLLOW: [(Slider, Slider, Slider); 6] = [
    (Slider::Knee, Slider::Thigh, Slider::Calf),
    (Slider::Forearm, Slider::UpperArm, Slider::Wrist),
    (Slider::Waist, Slider::AbdomenBreadth, Slider::AbdomenDepth),
    (Slider::Underbust, Slider::ChestBreadth, Slider::ChestBreadth),
    (Slider::LowerTrunk, Slider::UpperTrunk, Slider::UpperTrunk),
    (Slider::Thigh, Slider::HipBreadth, Slider::HipDepth),
];

/// A sex's base, its fields, its gauge and its people.
pub(super) struct BodyModel {
    pub morphs: Morphs,
    pub gauge: Gauge,
    people: People,
    drawn_stature: f64,
}

/// Result of a calibration.
pub(super) struct Calibrated {
    pub at: ParameterVector,
    pub setting: Setting,
    pub readings: [f32; READINGS],
    pub steps: usize,
}

pub(super) type ParameterVector = [f64; PARAMETERS];

/// The sum of squares around one setting: its value, half its gradient and half its curvature.
pub(super) struct SumOfSquares {
    cost: f64,
    slope: ParameterVector,
    pub curve: [ParameterVector; PARAMETERS],
}

impl SumOfSquares {
    fn none() -> Self {
        Self { cost: 0.0, slope: [0.0; PARAMETERS], curve: [[0.0; PARAMETERS]; PARAMETERS] }
    }

    /// Adds a residual with its gradient.
    fn add(&mut self, residual: f64, gradient: &ParameterVector) {
        self.cost += residual * residual;
        for i in 0..PARAMETERS {
            if gradient[i] != 0.0 {
                self.slope[i] += gradient[i] * residual;
                for j in 0..=i {
                    self.curve[i][j] += gradient[i] * gradient[j];
                }
            }
        }
    }
}

/// The sum of products of two rows.
fn along(a: &[f64; READINGS], b: &[f64; READINGS]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl BodyModel {
    pub(super) fn new(base: BaseBody) -> Self {
        let sex = base.sex;
        let morphs = Morphs::new(base);
        let gauge = Gauge::new(&morphs.base, allowance(sex));
        let drawn = gauge.read(&morphs.base.positions, None);
        let drawn_stature = f64::from(drawn[MeshMeasure::Stature.index()]);
        Self { morphs, gauge, people: People::new(sex, &drawn), drawn_stature }
    }

    /// A person's readings (m), by independent standard normal numbers.
    pub(super) fn person(&self, normal: &[f64; READINGS]) -> [f32; READINGS] {
        let People { mean, factor } = &self.people;
        std::array::from_fn(|i| (mean[i] + along(&factor[i], normal)) as f32)
    }

    /// The same for a person with a known reading (m): drawn like any person, then moved by the regression of the others on that reading.
    pub(super) fn person_with(&self, normal: &[f64; READINGS], known: (MeshMeasure, f32)) -> [f32; READINGS] {
        let People { factor, .. } = &self.people;
        let drawn = self.person(normal);
        let k = known.0.index();
        let off = f64::from(known.1 - drawn[k]) / along(&factor[k], &factor[k]);
        std::array::from_fn(|i| {
            if i == k { known.1 } else { (f64::from(drawn[i]) + along(&factor[i], &factor[k]) * off) as f32 }
        })
    }

    /// The base as it is.
    #[cfg(test)]
    pub(super) fn as_drawn(&self) -> Calibrated {
        let setting = Setting { sliders: [0.0; SLIDERS], scale: 1.0 };
        Calibrated {
            at: [0.0; PARAMETERS],
            setting,
            readings: self.gauge.read(&self.morphs.base.positions, None),
            steps: 0,
        }
    }

    /// Finds the body that has the readings given and is like people in all others.
    pub(super) fn calibrate(&self, given: &[(MeshMeasure, f32)]) -> Calibrated {
        let mut work = CalibrationBuffers::new(self);
        let mut at: ParameterVector = [0.0; PARAMETERS];
        if let Some((_, stature)) = given.iter().find(|g| g.0 == MeshMeasure::Stature) {
            at[SLIDERS] = (f64::from(*stature) / self.drawn_stature).ln().clamp(-SCALE, SCALE);
        }
        let mut squares = work.squares(&at, given);
        let mut steps = 0;
        while steps < STEPS {
            steps += 1;
            let step = bounded_step(&squares, &at);
            // A full step is nearly always the best; where the hull changes under it, a shorter one is.
            let mut share = 1.0;
            let (next, then) = loop {
                let next: ParameterVector = std::array::from_fn(|i| at[i] + share * step[i]);
                let then = work.squares(&next, given);
                if then.cost <= squares.cost || share < 0.1 {
                    break (next, then);
                }
                share *= 0.5;
            };
            let still = (0..PARAMETERS).all(|i| (next[i] - at[i]).abs() < SETTLED);
            let no_better = then.cost >= squares.cost * (1.0 - 1e-4);
            if then.cost <= squares.cost {
                (at, squares) = (next, then);
            }
            if still || (no_better && share < 1.0) || (no_better && work.furthest(given) < CLOSE_ENOUGH) {
                break;
            }
        }
        let setting = setting(&at);
        let readings = self.gauge.read(work.place(&setting), None);
        Calibrated { at, setting, readings, steps }
    }
}

pub(super) fn setting(at: &ParameterVector) -> Setting {
    Setting { sliders: std::array::from_fn(|k| at[k] as f32), scale: at[SLIDERS].exp() as f32 }
}

/// Buffers of one calibration.
pub(super) struct CalibrationBuffers<'a> {
    model: &'a BodyModel,
    positions: Vec<Vec3>,
    gradients: [Gradient; READINGS],
    pub readings: [f32; READINGS],
}

impl<'a> CalibrationBuffers<'a> {
    pub(super) fn new(model: &'a BodyModel) -> Self {
        let gradients = std::array::from_fn(|_| Vec::new());
        Self { model, positions: model.morphs.base.positions.clone(), gradients, readings: [0.0; READINGS] }
    }

    /// Puts the vertices that the gauge needs where a setting has them.
    fn place(&mut self, setting: &Setting) -> &[Vec3] {
        for &v in &self.model.gauge.needed {
            self.positions[v as usize] = self.model.morphs.place(v as usize, setting);
        }
        &self.positions
    }

    /// The greatest error of what is given, at the last reading (m).
    fn furthest(&self, given: &[(MeshMeasure, f32)]) -> f64 {
        given.iter().map(|(r, wanted)| f64::from((self.readings[r.index()] - wanted).abs())).fold(0.0, f64::max)
    }

    pub(super) fn squares(&mut self, at: &ParameterVector, given: &[(MeshMeasure, f32)]) -> SumOfSquares {
        let setting = setting(at);
        let jacobian = self.read(&setting);
        let mut squares = SumOfSquares::none();
        for &(reading, wanted) in given {
            let r = reading.index();
            let row = jacobian[r].map(|g| g / TIGHT);
            squares.add(f64::from(self.readings[r] - wanted) / TIGHT, &row);
        }
        self.like_people(&jacobian, &mut squares);
        self.head(at, &jacobian[MeshMeasure::Stature.index()], &mut squares);
        kept_together(at, &mut squares);
        squares
    }

    /// Reads the body of a setting, and how each reading changes with each parameter.
    pub(super) fn read(&mut self, setting: &Setting) -> [ParameterVector; READINGS] {
        self.place(setting);
        self.readings = self.model.gauge.read(&self.positions, Some(&mut self.gradients));
        std::array::from_fn(|r| self.row(r, setting))
    }

    /// Adds the departure of the whole's scale from what the stature lets expect.
    fn head(&self, at: &ParameterVector, stature: &ParameterVector, squares: &mut SumOfSquares) {
        let [share, spread] = HEADS;
        let (read, drawn) = (f64::from(self.readings[MeshMeasure::Stature.index()]), self.model.drawn_stature);
        let mut row = stature.map(|change| -share * change / (read * spread));
        row[SLIDERS] += 1.0 / spread;
        squares.add((at[SLIDERS] - share * (read / drawn).ln()) / spread, &row);
    }

    /// One reading's change with each parameter.
    fn row(&self, reading: usize, setting: &Setting) -> ParameterVector {
        let mut row: ParameterVector = [0.0; PARAMETERS];
        for &(v, g) in &self.gradients[reading] {
            for &(k, d) in self.model.morphs.moves(v as usize) {
                row[k as usize] += f64::from(g.dot(d) * setting.scale);
            }
            row[SLIDERS] += f64::from(g.dot(self.positions[v as usize]));
        }
        row
    }

    /// Adds the readings' distance from the mean of people, in deviations: `L^-1 (readings - mean)`.
    fn like_people(&self, jacobian: &[ParameterVector; READINGS], squares: &mut SumOfSquares) {
        let people = &self.model.people;
        let mut residuals = [0.0; READINGS];
        let mut rows = [[0.0; PARAMETERS]; READINGS];
        for i in 0..READINGS {
            let mut residual = f64::from(self.readings[i]) - people.mean[i];
            let mut row = jacobian[i];
            for j in 0..i {
                let l = people.factor[i][j];
                residual -= l * residuals[j];
                row.iter_mut().zip(&rows[j]).for_each(|(a, b)| *a -= l * b);
            }
            residuals[i] = residual / people.factor[i][i];
            rows[i] = row.map(|a| a / people.factor[i][i]);
            squares.add(residuals[i], &rows[i]);
        }
    }
}

/// Adds what keeps sliders near their neighbours, and near the base where nothing else does.
fn kept_together(at: &ParameterVector, squares: &mut SumOfSquares) {
    for (slider, one, other) in FOLLOW {
        let mut row: ParameterVector = [0.0; PARAMETERS];
        row[slider.index()] = 1.0 / TOGETHER;
        row[one.index()] -= 0.5 / TOGETHER;
        row[other.index()] -= 0.5 / TOGETHER;
        squares.add((0..PARAMETERS).map(|i| row[i] * at[i]).sum(), &row);
    }
    for slider in Slider::ALL {
        let mut row: ParameterVector = [0.0; PARAMETERS];
        row[slider.index()] = 1.0 / ALONE[usize::from(slider.is_length())];
        squares.add(row[slider.index()] * at[slider.index()], &row);
    }
}

pub(super) fn bounds(parameter: usize) -> [f64; 2] {
    match LENGTHS.get(parameter) {
        Some(most) => [-most, *most],
        None if parameter == SLIDERS => [-SCALE, SCALE],
        None => GIRTHS,
    }
}

/// The Gauss-Newton step; a slider that would leave its bounds stops there, and the others make up for it.
fn bounded_step(squares: &SumOfSquares, at: &ParameterVector) -> ParameterVector {
    let mut fixed: [Option<f64>; PARAMETERS] = [None; PARAMETERS];
    loop {
        let step = solve(squares, &fixed);
        let leaving = (0..PARAMETERS).filter(|&i| fixed[i].is_none()).find_map(|i| {
            let [least, most] = bounds(i);
            let to = (at[i] + step[i]).clamp(least, most) - at[i];
            ((to - step[i]).abs() > 1e-12).then_some((i, to))
        });
        let Some((i, to)) = leaving else { return step };
        fixed[i] = Some(to);
    }
}

/// Least squares with some steps fixed: the others by Cholesky's factors of the normal matrix.
fn solve(squares: &SumOfSquares, fixed: &[Option<f64>; PARAMETERS]) -> ParameterVector {
    let curve = |i: usize, j: usize| squares.curve[i.max(j)][i.min(j)];
    let mut matrix = [[0.0; PARAMETERS]; PARAMETERS];
    let mut x: ParameterVector = [0.0; PARAMETERS];
    for i in 0..PARAMETERS {
        // A fixed step has an equation of its own, which nothing else takes part in.
        if let Some(step) = fixed[i] {
            (matrix[i][i], x[i]) = (1.0, step);
            continue;
        }
        let from_fixed = (0..PARAMETERS).filter_map(|j| fixed[j].map(|step| curve(i, j) * step)).sum::<f64>();
        x[i] = -squares.slope[i] - from_fixed;
        (0..=i).filter(|&j| fixed[j].is_none()).for_each(|j| matrix[i][j] = curve(i, j));
    }
    linear::factor(&mut matrix, Pivot::AtLeast(1e-12));
    linear::solve(&matrix, &mut x);
    x
}
