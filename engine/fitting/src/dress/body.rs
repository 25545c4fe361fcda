//! A body of the measured size.

use toile_assets::body::BodyError;
use toile_assets::sizes::Population;
use toile_base::body::{Body, Measures, Sex};
use toile_track::estimate::Estimate;
use toile_track::measure::Measurements;

use crate::FittingError;

/// Shares of the way from the measured body to an average one of the same stature that are tried in turn.
const TOWARDS_AVERAGE: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// How far a measure that is read off an imported mesh is believed (m): its levels are found, not felt.
const READ_OFF: f32 = 0.01;

/// A body of the measured size. Where no body has the measures together (a sensor may err in one of them), the nearest
/// one on the way to the average body of that stature is built, and a sentence says so. Measures that are missing are
/// those of the average of `population`.
///
/// # Errors
/// Measures that not even an average body of that stature has.
pub fn build(
    sex: Sex,
    measured: &Measurements,
    population: Population,
) -> Result<(Body, Option<String>), FittingError> {
    let wanted = Measures::from(measured.body(population));
    let average = scaled(&Measures::average(sex), wanted.stature);
    let mut refused = None;
    for share in TOWARDS_AVERAGE {
        match toile_assets::body::build(sex, &towards(&wanted, &average, share)) {
            Ok(body) => {
                let note = refused.map(|e: BodyError| {
                    format!("the body shown is {:.0} % of the way to an average one, because {e}", share * 100.0)
                });
                return Ok((body, note));
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    Err(match refused {
        Some(error) => FittingError::input(error),
        None => FittingError::internal("no body was tried"),
    })
}

/// The measures of an imported body in place of the measured shopper's.
pub fn read_off(measured: Measurements, body: &Body) -> Measurements {
    let read = |value: f32| Some(Estimate::new(value, READ_OFF));
    let m = &body.measures;
    let measures = toile_track::measures::Measures {
        stature: read(m.stature),
        shoulder_breadth: read(m.shoulder_breadth),
        chest_girth: read(m.chest_girth),
        waist_girth: read(m.waist_girth),
        hip_girth: read(m.hip_girth),
        ..measured.measures
    };
    Measurements { measures, ..measured }
}

fn scaled(m: &Measures, stature: f32) -> Measures {
    let k = stature / m.stature;
    Measures {
        stature,
        shoulder_breadth: m.shoulder_breadth * k,
        chest_girth: m.chest_girth * k,
        waist_girth: m.waist_girth * k,
        hip_girth: m.hip_girth * k,
    }
}

fn towards(from: &Measures, to: &Measures, share: f32) -> Measures {
    let mix = |a: f32, b: f32| a + (b - a) * share;
    Measures {
        stature: from.stature,
        shoulder_breadth: mix(from.shoulder_breadth, to.shoulder_breadth),
        chest_girth: mix(from.chest_girth, to.chest_girth),
        waist_girth: mix(from.waist_girth, to.waist_girth),
        hip_girth: mix(from.hip_girth, to.hip_girth),
    }
}
