//! The parametric body as a family of shapes, for fitting it to what a sensor sees: where a point of the surface lies
//! and how it moves with each parameter, what to expect of people, and what the tape reads.

use std::sync::LazyLock;

use glam::Vec3;

use super::base::BaseBody;
use super::calibrate::{BodyModel, Calibrated, CalibrationBuffers, ParameterVector, bounds, setting};
use super::fitted::model;
use super::reading::{READINGS, Readings, Vocabulary};
use super::slider::{PARAMETERS, SLIDERS};
use super::{BodyError, Fitted};
use toile_base::body::Sex;
use toile_base::numeric::linear::{Pivot, factor as factor_in_place, inverse};
use toile_base::skeleton::{JOINTS, Skeleton};

/// Number of a shape's parameters.
pub const SHAPES: usize = PARAMETERS;

/// The parameter that scales the whole body: the logarithm of its size over the base's. All others are sliders, in
/// metres or as a fraction of the base.
pub const SCALE: usize = SLIDERS;

/// Pivots below this are raised to it: directions in which no person varies.
const LEAST_PIVOT: f64 = 1e-12;

/// Number of independent numbers that a person of the survey is drawn by.
pub const DRAWN: usize = READINGS;

/// A body's shape: all parameters at 0 are the body as it is drawn.
pub type BodyShape = ParameterVector;

/// The shapes of one sex.
pub struct Shapes {
    model: &'static BodyModel,
    mean: BodyShape,
    precision: [BodyShape; SHAPES],
}

/// What the tape reads on a shape, and how that changes with the parameters.
pub struct ShapeReadings {
    /// Every measure of the body (m).
    pub readings: Readings,
    rows: [BodyShape; READINGS],
}

impl ShapeReadings {
    /// How one measure changes with each parameter (m a unit).
    pub fn row<V: Vocabulary>(&self, measure: V) -> &BodyShape {
        &self.rows[measure.reading().index()]
    }
}

impl Shapes {
    /// The shapes of a sex, worked out on first use: some hundred milliseconds.
    pub fn of(sex: Sex) -> &'static Self {
        static WOMEN: LazyLock<Shapes> = LazyLock::new(|| Shapes::new(Sex::Female));
        static MEN: LazyLock<Shapes> = LazyLock::new(|| Shapes::new(Sex::Male));
        match sex {
            Sex::Female => &WOMEN,
            Sex::Male => &MEN,
        }
    }

    fn new(sex: Sex) -> Self {
        let model = model(sex);
        let mean = model.calibrate(&[]).at;
        let squares = CalibrationBuffers::new(model).squares(&mean, &[]);
        let curve = &squares.curve;
        let precision = std::array::from_fn(|i| std::array::from_fn(|j| curve[i.max(j)][i.min(j)]));
        Self { model, mean, precision }
    }

    /// The body that all shapes are made from: its triangles, skin weights, regions and landmarks are theirs, too.
    pub fn base(&self) -> &BaseBody {
        &self.model.morphs.base
    }

    /// The shape of the mean person of ANSUR II.
    pub fn mean(&self) -> &BodyShape {
        &self.mean
    }

    /// How surely people's shapes are known before any of them is seen: the inverse of the covariance of their
    /// parameters about the mean (symmetric), linearised there.
    pub fn precision(&self) -> &[BodyShape; SHAPES] {
        &self.precision
    }

    /// What the tape reads on a person of the survey (m), drawn by independent standard normal numbers: with the survey's own
    /// deviations and correlations. Bodies drawn by [`Shapes::covariance`] are more alike than people are: to that, what is
    /// expected of a shape as such counts beside the survey.
    pub fn person(&self, normal: &[f64; DRAWN]) -> Readings {
        Readings(self.model.person(normal))
    }

    /// The same of a person with one measure (m): the others as they go with it.
    pub fn person_with<V: Vocabulary>(&self, normal: &[f64; DRAWN], measure: V, value: f32) -> Readings {
        Readings(self.model.person_with(normal, (measure.reading(), value)))
    }

    /// The covariance of people's parameters about the mean: the inverse of [`Shapes::precision`].
    pub fn covariance(&self) -> [BodyShape; SHAPES] {
        let mut factor = self.precision;
        let done = factor_in_place(&mut factor, Pivot::AtLeast(LEAST_PIVOT));
        debug_assert!(done.is_some(), "raised pivots are never refused");
        inverse(&factor)
    }

    /// The least and the most of a parameter.
    pub fn bounds(&self, parameter: usize) -> [f64; 2] {
        bounds(parameter)
    }

    /// Position of a vertex on a shape in the rest pose (m).
    pub fn place(&self, vertex: usize, shape: &BodyShape) -> Vec3 {
        self.model.morphs.place(vertex, &setting(shape))
    }

    /// The sliders that move a vertex, and by how much a unit, before scaling (m).
    pub fn moves(&self, vertex: usize) -> &[(u32, Vec3)] {
        self.model.morphs.moves(vertex)
    }

    /// How the joints move with a slider, before scaling (m a unit).
    pub fn joint_moves(&self, slider: usize) -> &[Vec3; JOINTS] {
        self.model.morphs.joint_moves(slider)
    }

    /// The joints of a shape in the rest pose.
    pub fn skeleton(&self, shape: &BodyShape) -> Skeleton {
        self.model.morphs.skeleton(&setting(shape))
    }

    /// Lays the tape on a shape.
    pub fn read(&self, shape: &BodyShape) -> ShapeReadings {
        let mut work = CalibrationBuffers::new(self.model);
        let rows = work.read(&setting(shape));
        ShapeReadings { readings: Readings(work.readings), rows }
    }

    /// Lays the tape on any surface that has the base's vertices at rest, of the family or not (m) `[vertices]`.
    pub fn read_surface(&self, positions: &[Vec3]) -> Readings {
        Readings(self.model.gauge.read(positions, None))
    }

    /// The whole body of a shape.
    pub fn body(&self, shape: &BodyShape) -> Fitted {
        let at = *shape;
        let readings = self.read(shape).readings.0;
        self.model.fitted(&Calibrated { at, setting: setting(shape), readings, steps: 0 })
    }

    /// The shape of a body that has all measures wanted as nearly as any has.
    ///
    /// # Errors
    /// [`BodyError::OutOfRange`] for a measure that no body is built for.
    pub fn wanted<V: Vocabulary>(&self, wanted: &super::Wanted<V>) -> Result<BodyShape, BodyError> {
        wanted.check()?;
        let given: Vec<_> = wanted.given().iter().map(|(m, value)| (m.reading(), *value)).collect();
        Ok(self.model.calibrate(&given).at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{En, Wanted};

    #[test]
    fn the_mean_shape_is_the_body_built_to_nothing() {
        for sex in [Sex::Female, Sex::Male] {
            let shapes = Shapes::of(sex);
            let built = crate::body::fitted(sex, &Wanted::<En>::new()).unwrap();
            let shaped = shapes.body(shapes.mean());
            assert_eq!(built.body.mesh.positions, shaped.body.mesh.positions);
            assert_eq!(built.readings, shaped.readings);
        }
    }

    #[test]
    fn rows_are_the_readings_changes() {
        let shapes = Shapes::of(Sex::Female);
        let read = shapes.read(shapes.mean());
        for parameter in 0..SHAPES {
            for measure in [En::Stature, En::WaistGirth, En::HipGirth, En::ArmLength, En::InsideLegHeight] {
                let at = |by: f64| {
                    let mut shape = *shapes.mean();
                    shape[parameter] += by;
                    f64::from(shapes.read(&shape).readings.of(measure))
                };
                let change = (at(5e-3) - at(-5e-3)) / 1e-2;
                let off = (change - read.row(measure)[parameter]).abs();
                assert!(off < 0.02 + 0.02 * change.abs(), "{measure:?} {parameter}: {change} {off}");
            }
        }
    }

    #[test]
    fn the_mean_is_where_people_expect_it_and_every_parameter_is_held() {
        let shapes = Shapes::of(Sex::Male);
        let p = shapes.precision();
        for (i, row) in p.iter().enumerate() {
            assert!(row[i] > 0.0 && (0..SHAPES).all(|j| row[j] == p[j][i]));
        }
        assert!((shapes.read(shapes.mean()).readings.of(En::Stature) - 1.756).abs() < 0.01);
    }
}
