//! A shopper seen in depth alone: the body fitted to their surface gives measures, a body and joints.

use toile_assets::body::Sex;
use toile_assets::sizes::Population;
use toile_sensors::frame::{DepthFrame, Joints};
use toile_sensors::source::Session;
use toile_track::fit::measuring::{self, FittedMeasures};
use toile_track::fit::{FitOptions, tracker};
use toile_track::measure::{FRAMES, Measurements};
use toile_track::measures::Measures;
use toile_track::point_cloud;

use crate::exit::AppError;

/// The shopper's surface, and the floor below it.
pub struct Alone {
    /// The frames of the first second, and the same with nothing in them but the shopper.
    pub frames: Vec<(DepthFrame, DepthFrame)>,
    /// Height of the floor (m), unless the picture cuts the shopper off above it.
    pub ground: Option<f32>,
}

impl Alone {
    /// The nearest person of each frame of the first second.
    pub fn of(session: &Session) -> Self {
        let mut cut = 0;
        let mut frames = Vec::new();
        for frame in session.depth.iter().take(FRAMES) {
            if let Some(person) = point_cloud::find_people(frame).people.first() {
                cut += usize::from(person.cut_below);
                frames.push((frame.clone(), person.alone(frame)));
            }
        }
        let ground = (2 * cut < frames.len()).then_some(0.0);
        Self { frames, ground }
    }

    /// Measures them by the body fit; `None` if no body fits.
    pub fn measure(&self, population: Population, options: FitOptions) -> Option<FittedMeasures> {
        let only: Vec<DepthFrame> = self.frames.iter().map(|f| f.1.clone()).collect();
        measuring::measure(&only, population, options)
    }
}

/// Joints of a session that has none, from its depth: the body is fitted to the first second, and then followed.
///
/// # Errors
/// [`AppError::Input`] where no body fits what is seen.
pub fn joints(session: &Session, population: Population) -> Result<(FittedMeasures, Vec<Joints>), AppError> {
    let alone = Alone::of(session);
    let measured = alone.measure(population, FitOptions { ground: alone.ground, ..FitOptions::MEASURING });
    let fitted = measured.ok_or_else(|| {
        AppError::Input(format!(
            "session {} has no joints, and no body fits its depth; record somebody who stands alone, facing the camera, \
             arms slightly out",
            session.name
        ))
    })?;
    let sex = if fitted.woman > 0.5 { Sex::Female } else { Sex::Male };
    let joints = tracker::track(&session.depth, sex, FitOptions { ground: alone.ground, ..FitOptions::LIVE });
    Ok((fitted, joints))
}

/// What the body fit says in place of what sections and proportions say.
pub fn preferred(measured: Measurements, fitted: &FittedMeasures) -> Measurements {
    let of = |name| fitted.named(name);
    let measures = Measures {
        stature: of("stature"),
        shoulder_breadth: of("shoulder_breadth"),
        chest_girth: of("chest_girth"),
        waist_girth: of("waist_girth"),
        hip_girth: of("hip_girth"),
        inseam: of("leg_length"),
        arm_length: of("arm_length"),
    };
    Measurements { measures, ..measured }
}
