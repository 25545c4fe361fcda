//! One person: true measures, and the body that has them.

use toile_assets::body::shape::{BodyShape, Shapes};
use toile_assets::body::{En, Wanted};
use toile_base::body::{Body, Measures, Sex};

use crate::error::{Result, StudyError};

/// What a body is made from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Origin {
    /// A shape that was drawn: its measures are read off it.
    Shape(Box<BodyShape>),
    /// Measures (m); all others are what people with these are expected to have.
    Given(Vec<(En, f32)>),
}

/// A person of a population.
#[derive(Debug, Clone, PartialEq)]
pub struct Person {
    /// Number in the population, from 0.
    pub number: u64,
    /// How many people they stand for.
    pub weight: f64,
    /// Whose garments they wear.
    pub sex: Sex,
    /// Their true measures (m).
    pub measures: Measures,
    pub(super) origin: Origin,
}

impl Person {
    /// Their body; where no body has the measures together, the nearest one.
    ///
    /// # Errors
    /// A measure that no body is built for.
    pub fn body(&self) -> Result<Body> {
        let shapes = Shapes::of(self.sex);
        let shape = match &self.origin {
            Origin::Shape(shape) => **shape,
            Origin::Given(given) => {
                let wanted = given.iter().fold(Wanted::<En>::new(), |all, (measure, m)| all.with(*measure, *m));
                shapes.wanted(&wanted).map_err(StudyError::input)?
            }
        };
        Ok(shapes.body(&shape).body)
    }
}
