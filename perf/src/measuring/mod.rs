//! Measuring compared with known bodies: people of ANSUR II, each with a shape of their own, seen by a depth camera.
//!
//! What the study renders is not what the fit assumes: the bodies have sections that the parametric body cannot have,
//! stand in poses of their own, are skinned with twist, and are seen by a camera that is not quite as it says.

mod standing;

mod makehuman;
mod person;
mod second_noise;

mod sensor;

mod surfaces;

mod study;

mod sizing;

mod crossing;

pub use crossing::{CrossedMeasure, StatedDecile, crossed, reliability};
pub use makehuman::{FamilyError, SurveyRanges, makehuman_person};
pub use sensor::{NoiseModel, Sensor, StudyCamera};
pub use sizing::SizeAgreement;
pub use standing::{JointPositions, Moment, StudyPerson, TapeMeasures};
pub use study::{
    Estimates, Family, Following, MeasuredPerson, MeasuringAgreement, MeasuringError, MeasuringOptions, MeasuringStudy,
    study,
};
pub use surfaces::PersonSurfaces;
