//! A sensor's readings of true measures: normal errors of known deviations, by seed and number.

use toile_base::body::Measures;
use toile_track::estimate::Estimate;
use toile_track::measure::{Measurements, Source};
use toile_track::measures::Measures as Estimates;

use crate::error::{Result, StudyError};
use crate::population::{Purpose, generator};
use crate::study_file::{WantedSensor, one_of};

/// The measures that a sensor sees here.
const NAMES: [&str; 4] = ["stature", "chest", "waist", "hip"];

/// Deviations that the body fit states of people of another family than its own, before a Kinect (mm; docs/measuring.md).
const FRONT: [f32; 4] = [6.0, 24.0, 29.0, 23.0];

/// The same once they have turned.
const TURNED: [f32; 4] = [5.0, 25.0, 20.0, 15.0];

/// Errors with which measures are seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Deviations of stature, chest, waist and hip (m).
    sigma: [f32; 4],
    seed: u64,
}

impl Sensor {
    /// The sensor that a study wants.
    ///
    /// # Errors
    /// An unknown view or measure.
    pub fn open(wanted: &WantedSensor, seed: u64) -> Result<Self> {
        let view = wanted.view.as_deref().unwrap_or("front");
        one_of("[sensor] view", view, &["front", "turned", "none"]).map_err(StudyError::Input)?;
        let mut mm = match view {
            "front" => FRONT,
            "turned" => TURNED,
            _ => [0.0; 4],
        };
        for (name, sigma) in &wanted.sigma_mm {
            one_of("[sensor] sigma_mm", name, &NAMES).map_err(StudyError::Input)?;
            if !(0.0..=200.0).contains(sigma) {
                return Err(StudyError::Input(format!(
                    "[sensor] sigma_mm: {name} = {sigma} is no deviation from 0 to 200 mm"
                )));
            }
            let at = NAMES.iter().position(|known| known == name).unwrap_or(0);
            mm[at] = *sigma as f32;
        }
        Ok(Self { sigma: mm.map(|mm| mm * 1e-3), seed })
    }

    /// The deviations with their names (mm).
    pub fn sigma_mm(&self) -> [(&'static str, f64); 4] {
        std::array::from_fn(|i| (NAMES[i], f64::from(self.sigma[i]) * 1e3))
    }

    /// What is seen of person number `number`.
    pub fn see(&self, number: u64, truth: &Measures) -> Measurements {
        let mut random = generator(self.seed, Purpose::Sensor, number);
        let truth = [truth.stature, truth.chest_girth, truth.waist_girth, truth.hip_girth];
        let seen: [Estimate; 4] =
            std::array::from_fn(|i| Estimate::new(truth[i] + self.sigma[i] * random.gaussian(), self.sigma[i]));
        measurements(seen)
    }
}

/// True measures as they are judged: without an error.
pub(crate) fn exact(truth: &Measures) -> Measurements {
    measurements([truth.stature, truth.chest_girth, truth.waist_girth, truth.hip_girth].map(|m| Estimate::new(m, 0.0)))
}

fn measurements([stature, chest, waist, hip]: [Estimate; 4]) -> Measurements {
    let measures = Estimates {
        stature: Some(stature),
        chest_girth: Some(chest),
        waist_girth: Some(waist),
        hip_girth: Some(hip),
        ..Estimates::default()
    };
    Measurements { measures, valid_pixels: 1, people: 1, frames: 1, source: Source::Depth, notes: Vec::new() }
}
