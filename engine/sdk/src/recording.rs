//! Recordings: a sensor's data of a person, and their measures.

use std::path::Path;

use toile_base::body::Sex;
use toile_base::frame::{DepthFrame, Joints};
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_fitting::dress::{garment_source, session};
use toile_sensors::source::Session;
use toile_track::fit::measuring::FittedMeasures;
use toile_track::measures::definition;
use toile_track::tape_readings::TapeReadings;

use crate::body::Body;
use crate::error::{Error, Result};
use crate::garment::Garment;
use crate::measures::{Measure, named};

/// Measures that the body fit alone takes.
const OF_THE_FIT: [&str; 4] = ["torso_length", "neck_girth", "underbust_girth", "thigh_girth"];

/// What a sensor saw of one person: frames of joints, depth images, or both.
#[derive(Debug, Clone)]
pub struct Recording {
    session: Session,
}

/// What is known of a person before they are measured. Build it with `..Default::default()`: fields may be added.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shopper {
    /// Whose proportions apply, if it is known; otherwise depth decides where it can.
    pub sex: Option<Sex>,
    /// Whether it is a child, if that is known.
    pub child: Option<bool>,
    /// Whether they wear nothing that stands off the skin; otherwise everyday clothes, which the body lies beneath.
    pub tight_clothes: bool,
    /// Whether they sit: nothing is taken from legs and hips, which a chair hides.
    pub seated: bool,
    /// Measures that were taken by tape, by name (mm); all others follow them.
    pub by_tape_mm: Vec<(String, f64)>,
}

/// A measured person.
#[derive(Debug, Clone)]
pub struct Measured {
    pub(crate) inner: measured::MeasuredSubject,
    has_tape: bool,
}

impl Recording {
    /// Opens a recording: MCAP, Kinect CSV, Kinectron JSON, BVH, Azure Kinect, OpenNI, OpenPose, depth images and others
    /// (docs/depth.md).
    ///
    /// # Errors
    /// A file that is no recording, with the place in it and the cure.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Ok(Self { session: session::open(Some(path.as_ref()), None)? })
    }

    /// The same of depth images without a camera of their own, which a JSON file describes.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_with_camera(path: impl AsRef<Path>, camera: impl AsRef<Path>) -> Result<Self> {
        Ok(Self { session: session::open(Some(path.as_ref()), Some(camera.as_ref()))? })
    }

    /// The recording that comes with Toile.
    ///
    /// # Errors
    /// None that a sound build has.
    pub fn embedded() -> Result<Self> {
        Ok(Self { session: session::open(None, None)? })
    }

    /// Frames that a sensor of the caller's own saw, in metres, y up, the floor at y = 0, the person facing +z; times rise from
    /// frame to frame. One of the two may be empty.
    ///
    /// # Errors
    /// No frame at all, times that do not rise, numbers that are not finite, images of another size than their camera.
    pub fn from_frames(name: &str, joints: Vec<Joints>, depth: Vec<DepthFrame>) -> Result<Self> {
        let session = Session { name: name.to_owned(), joints, depth, notes: Vec::new(), raw_scale_known: true };
        Ok(Self { session: session.checked().map_err(Error::input)? })
    }

    /// Its name, for reports.
    pub fn name(&self) -> &str {
        &self.session.name
    }

    /// Time of the last frame (s); the first is at 0.
    pub fn seconds(&self) -> f64 {
        self.session.duration_ns() as f64 * 1e-9
    }

    /// Frames of joints, as the sensor has them.
    pub fn joints(&self) -> &[Joints] {
        &self.session.joints
    }

    /// Depth images.
    pub fn depth(&self) -> &[DepthFrame] {
        &self.session.depth
    }

    /// Measures the person in it: by a body fitted to depth where there is any, by the joints otherwise.
    ///
    /// # Errors
    /// A recording that shows no person who can be measured; a measure by tape outside of people's range.
    pub fn measure(&self, shopper: &Shopper) -> Result<Measured> {
        let inner = measured::measure(&self.session, shopper.facts()?)?;
        Ok(Measured { inner, has_tape: !shopper.by_tape_mm.is_empty() })
    }

    /// The filtered joints from the moment on at which the person can be dressed; of depth alone, the body is followed through it.
    ///
    /// # Errors
    /// A recording in which no person can be followed.
    pub fn track(&self, measured: &Measured) -> Result<Vec<Joints>> {
        Ok(measured::track(&self.session, &measured.inner)?)
    }
}

impl Shopper {
    fn facts(&self) -> Result<ShopperFacts> {
        let mut words = Vec::new();
        for (name, mm) in &self.by_tape_mm {
            let (name, _) = named(name)?;
            let known = if name == "inside_leg_height" { "leg_length" } else { name };
            words.push(format!("{known}={mm}"));
        }
        let tape = TapeReadings::of(&words).map_err(Error::input)?;
        let clothed = !self.tight_clothes;
        Ok(ShopperFacts {
            sex: self.sex,
            child: self.child,
            clothed,
            seated: self.seated,
            tape,
            ..ShopperFacts::default()
        })
    }
}

impl Measured {
    /// The measures, each with its sigma: stature, shoulder breadth, girths of chest, waist and hip always, others where they
    /// were taken.
    pub fn measures(&self) -> Vec<Measure> {
        let best = &self.inner.best;
        let completed = best.completed(self.inner.population);
        let mut all: Vec<Measure> = Vec::new();
        for (i, (name, taken)) in best.measures.named().into_iter().enumerate() {
            if let Some(estimate) = completed.get(i).copied().or(taken) {
                all.push(measure(name, estimate, taken.is_some()));
            }
        }
        // What was taken by tape changes all others, of which the fit's own are none.
        let fitted: Option<&FittedMeasures> = self.inner.fitted.as_ref().filter(|_| !self.has_tape);
        let more = OF_THE_FIT.iter().filter_map(|name| Some(measure(name, fitted?.named(name)?, true)));
        all.extend(more);
        all
    }

    /// Odds that it is a child, 0 to 1; none without a stature. Bodies and sizes here are adults'.
    pub fn child(&self) -> Option<f32> {
        self.inner.child
    }

    /// Notes on the measures, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.inner.best.notes
    }

    /// The body of these measures; a woman's where the sex is neither known nor seen.
    ///
    /// # Errors
    /// Measures that not even an average body of that stature has.
    pub fn body(&self) -> Result<Body> {
        self.body_for(&[])
    }

    /// The same, of whom the garments are made for where the sex is neither known nor seen.
    ///
    /// # Errors
    /// As [`Self::body`].
    pub fn body_for(&self, garments: &[Garment]) -> Result<Body> {
        let (shape, note) = self.inner.wearer(garment_source::population(garments.iter().map(Garment::source))?)?;
        Ok(Body::of_shape(shape, self.inner.best.clone(), note.into_iter().collect()))
    }
}

fn measure(name: &'static str, estimate: toile_track::estimate::Estimate, seen: bool) -> Measure {
    let (mm, sigma_mm) = (f64::from(estimate.value) * 1e3, f64::from(estimate.sigma) * 1e3);
    let own = if name == "inseam" { "inside_leg_height" } else { name };
    Measure { name: own, mm, sigma_mm, seen, definition: definition(name) }
}
