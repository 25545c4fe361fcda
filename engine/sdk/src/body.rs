//! Bodies: of given measures, of a measured person, of a file.

use std::path::Path;

use glam::Vec3;
use toile_assets::body::{BodyError, En, Readings, Wanted};
use toile_assets::import::avatar::{self, ImportOptions};
use toile_assets::sizes::Population;
use toile_base::body::{Body as BodyShape, Sex};
use toile_fitting::dress::measured;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::{FittedMeasure, MEASURES};
use toile_track::measure::{Measurements, Source};
use toile_track::measures::Measures;
use toile_track::tape_readings::TapeReadings;

use crate::error::{Error, Result};
use crate::measures::{all, name_of, named};

/// A body in its rest pose, arms half raised, feet on the floor at y = 0, facing +z; and how well its measures are known.
#[derive(Debug, Clone)]
pub struct Body {
    shape: BodyShape,
    /// What sizes are chosen by.
    known: Measurements,
    measures_mm: Vec<(&'static str, f64)>,
    notes: Vec<String>,
}

impl Body {
    /// The body of a sex that has these measures (mm), each within 2 mm; all others are what people with these are expected to
    /// have. Names are those of [`measure_names`](crate::measure_names), and the words for them: `chest`, `bust`, `height`.
    /// What was given counts as taken by tape (sigma 5 mm) where a size is chosen.
    ///
    /// # Errors
    /// An unknown measure, one that no body has, or measures that none has together; the sentence names the one to
    /// correct, and the unit that was probably meant.
    pub fn from_measures_mm(sex: Sex, measures: &[(&str, f64)]) -> Result<Self> {
        let mut wanted: Wanted<En> = Wanted::new();
        for (word, mm) in measures {
            let (name, measure) = named(word)?;
            if wanted.given().iter().any(|(given, _)| *given == measure) {
                return Err(Error::input(format!("the {name} is given twice; give each measure once")));
            }
            wanted = wanted.with(measure, (mm * 1e-3) as f32);
        }
        let fitted = toile_assets::body::fitted(sex, &wanted).map_err(|error| in_millimetres(&error))?;
        let mut known = by_tape(sex, &wanted)?;
        let m = &fitted.body.measures;
        let five = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
        let Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth, .. } = &mut known.measures;
        let estimates = [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth];
        // The sigma of each, around what the body that is dressed has.
        estimates.into_iter().flatten().zip(five).for_each(|(estimate, value)| estimate.value = value);
        let measures_mm = readings(&fitted.readings);
        Ok(Self { shape: fitted.body, known, measures_mm, notes: Vec::new() })
    }

    /// The average body of a sex (ANSUR II).
    ///
    /// # Errors
    /// None that a sound build has.
    pub fn average(sex: Sex) -> Result<Self> {
        let m = toile_base::body::Measures::average(sex);
        let five = [
            ("stature", m.stature),
            ("shoulder_breadth", m.shoulder_breadth),
            ("chest_girth", m.chest_girth),
            ("waist_girth", m.waist_girth),
            ("hip_girth", m.hip_girth),
        ];
        Self::from_measures_mm(sex, &five.map(|(name, metres)| (name, f64::from(metres) * 1e3)))
    }

    /// A body that others made: a skinned glTF 2.0 mesh (`.glb`, `.gltf`) or a VRM avatar. Its measures are read off it, and
    /// believed to 10 mm. `sex` says whose garments it wears.
    ///
    /// # Errors
    /// A file that does not become a body, with what is wrong in it and the cure.
    pub fn open(path: impl AsRef<Path>, sex: Sex) -> Result<Self> {
        let options = ImportOptions { sex, ..ImportOptions::default() };
        let imported = avatar::read(path.as_ref(), &options).map_err(Error::input)?;
        let known = measured::read_off(nothing_known(), &imported.body);
        Ok(Self::of_shape(imported.body, known, imported.report.notes))
    }

    /// A body that was fitted, and what is known of its person.
    pub(crate) fn of_shape(shape: BodyShape, known: Measurements, notes: Vec<String>) -> Self {
        let m = shape.measures;
        let five = [
            ("stature", m.stature),
            ("shoulder_breadth", m.shoulder_breadth),
            ("chest_girth", m.chest_girth),
            ("waist_girth", m.waist_girth),
            ("hip_girth", m.hip_girth),
        ];
        let measures_mm = five.map(|(name, metres)| (name, f64::from(metres) * 1e3)).to_vec();
        Self { shape, known, measures_mm, notes }
    }

    /// Whose drawing it is stretched from.
    pub fn sex(&self) -> Sex {
        self.shape.sex
    }

    /// The measures that are read off the body as it is (mm): all of [`measure_names`](crate::measure_names) of a body of given
    /// measures, else stature, shoulder breadth and the girths of chest, waist and hip.
    pub fn measures_mm(&self) -> &[(&'static str, f64)] {
        &self.measures_mm
    }

    /// One of them by its name (mm).
    ///
    /// # Errors
    /// An unknown measure, or one that is not read off such a body.
    pub fn measure_mm(&self, name: &str) -> Result<f64> {
        let (name, _) = named(name)?;
        let found = self.measures_mm.iter().find(|(of, _)| *of == name);
        found.map(|(_, mm)| *mm).ok_or_else(|| {
            let known: Vec<&str> = self.measures_mm.iter().map(|(name, _)| *name).collect();
            Error::input(format!("the {name} of this body is not known; ask for one of {}", known.join(", ")))
        })
    }

    /// Vertices in the rest pose (m). They keep their numbers in every pose.
    pub fn positions(&self) -> &[Vec3] {
        &self.shape.mesh.positions
    }

    /// Triangles, counter-clockwise from outside, by the numbers of the vertices.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.shape.mesh.triangles
    }

    /// Notes on how it was made, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn shape(&self) -> &BodyShape {
        &self.shape
    }

    pub(crate) fn known(&self) -> &Measurements {
        &self.known
    }
}

/// Every measure of a body (mm).
fn readings(readings: &Readings) -> Vec<(&'static str, f64)> {
    all().into_iter().map(|(name, measure)| (name, f64::from(readings.of(measure)) * 1e3)).collect()
}

/// Measurements of a person of whom nothing was seen.
fn nothing_known() -> Measurements {
    Measurements {
        measures: Measures::default(),
        valid_pixels: 0,
        people: 1,
        frames: 0,
        source: Source::Joints,
        notes: Vec::new(),
    }
}

/// What is known of a person whose measures were taken by tape.
fn by_tape(sex: Sex, wanted: &Wanted<En>) -> Result<Measurements> {
    let mut taken = TapeReadings::default();
    for (measure, metres) in wanted.given() {
        // Wrists and calves decide on no size.
        if let Some(index) = MEASURES.iter().position(|row| row.1 == FittedMeasure::Standard(*measure)) {
            taken = taken.with(index, *metres).map_err(Error::input)?;
        }
    }
    taken.check().map_err(Error::input)?;
    let population = Population::from(Some(sex));
    let known = measured::with_tape(nothing_known(), None, population, &taken);
    let all: [Estimate; 5] = known.completed(population);
    let [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth] = all.map(Some);
    let measures = Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth, ..known.measures };
    // Sentences of what a camera saw otherwise: there was none.
    Ok(Measurements { measures, notes: Vec::new(), ..known })
}

/// Why there is no such body, in the unit of this crate.
fn in_millimetres(error: &BodyError) -> Error {
    let mm = |metres: f32| (f64::from(metres) * 1e4).round() / 10.0;
    match error {
        BodyError::OutOfRange { measure, value, least, most } => {
            let units = [("centimetres", 10.0), ("inches", 25.4), ("metres", 1e3)];
            let meant = units.into_iter().find(|(_, by)| (*least..=*most).contains(&(value * by)));
            let cure = match meant {
                Some((unit, by)) => format!("taken as {unit} it would be {} mm, so give millimetres", mm(value * by)),
                None => "check the measure and its unit".to_owned(),
            };
            let (name, value, least, most) = (name_of(measure), mm(*value), mm(*least), mm(*most));
            Error::input(format!("the {name} is {value} mm, but a body is built for {least} to {most} mm: {cure}"))
        }
        BodyError::Unreachable { measure, value, reached, against, .. } => {
            let other = against.map_or_else(
                || "the other measures".to_owned(),
                |(other, value)| format!("a {} of {} mm", name_of(other), mm(value)),
            );
            let (name, value, reached) = (name_of(measure), mm(*value), mm(*reached));
            Error::input(format!(
                "no body has a {name} of {value} mm together with {other}, the nearest has {reached} mm: check them against each \
                 other, or leave one out"
            ))
        }
    }
}
