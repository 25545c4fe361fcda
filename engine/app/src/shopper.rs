//! The shopper: a session opened, its joints made believable, the body measured and built.

use std::path::Path;

use toile_assets::body::{Body, BodyError, Measures, Sex};
use toile_assets::sizes::Population;
use toile_assets::skeleton::Joint;
use toile_sensors::clock::SECOND_NS;
use toile_sensors::filter::{FilterSettings, JointFilter};
use toile_sensors::frame::Joints;
use toile_sensors::source::{self, OpenOptions, Session};
use toile_track::estimate::Estimate;
use toile_track::measure::{self, Measurements};
use toile_track::measures::Hint;

use crate::exit::AppError;
use crate::report;

/// The session that is embedded: `toile record` makes it.
const EMBEDDED: &[u8] = include_bytes!("../../../assets/data/sessions/shopper.mcap");

/// Name of the embedded session in reports.
const EMBEDDED_NAME: &str = "shopper (embedded)";

/// Opens a session, or the embedded one.
pub fn open(path: Option<&Path>, camera: Option<&Path>) -> Result<Session, AppError> {
    let options = OpenOptions { camera: camera.map(Path::to_path_buf) };
    match path {
        Some(path) => source::open(path, &options).map_err(AppError::input),
        None => source::read_bytes(EMBEDDED_NAME, EMBEDDED_NAME, EMBEDDED, None).map_err(AppError::internal),
    }
}

/// Measures whoever stands in a session.
pub fn measure(session: &Session, population: Population) -> Result<Measurements, AppError> {
    let hint = Hint { population, scale_known: session.raw_scale_known };
    measure::measure(&session.joints, &session.depth, &hint).map_err(AppError::input)
}

/// The joints of a session after the filter, at the same times.
pub fn believable(session: &Session) -> Vec<Joints> {
    let mut filter = JointFilter::new(FilterSettings::default());
    session.joints.iter().map(|joints| filter.push(joints)).collect()
}

/// Time that a sensor which begins without seeing the hips is given to settle, once it sees them (ns): until then
/// somebody is walking in, and legs are guesses.
const WALK_IN_NS: u64 = SECOND_NS / 2;

/// Whether somebody is seen: the hips are, without which nobody can be dressed.
pub fn is_seen(frame: &Joints) -> bool {
    const HIPS: [Joint; 3] = [Joint::Pelvis, Joint::LeftHip, Joint::RightHip];
    HIPS.iter().all(|&j| frame.at(j).is_believed())
}

/// The frame at which a shopper can be dressed: the first, unless the hips are not seen in it.
pub fn stands_from(track: &[Joints]) -> usize {
    let seen = is_seen;
    match track.iter().position(seen) {
        None | Some(0) => 0,
        Some(first) => {
            let settled = track[first].time_ns + WALK_IN_NS;
            track.iter().position(|frame| frame.time_ns >= settled && seen(frame)).unwrap_or(first)
        }
    }
}

/// Shares of the way from the measured body to an average one of the same stature that are tried in turn.
const TOWARDS_AVERAGE: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

/// A body of the measured size. Where no body has the measures together (a sensor may err in one of them), the nearest
/// one on the way to the average body of that stature is built, and a sentence says so.
pub fn build(sex: Sex, measured: &Measurements, population: Population) -> Result<(Body, Option<String>), AppError> {
    let wanted = Measures::from(measured.body(population));
    let average = scaled(&Measures::average(sex), wanted.stature);
    let mut refused = None;
    for share in TOWARDS_AVERAGE {
        match Body::build(sex, &towards(&wanted, &average, share)) {
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
        Some(error) => AppError::input(error),
        None => AppError::internal("no body was tried"),
    })
}

/// How far a measure that is read off an imported mesh is believed (m): its levels are found, not felt.
const READ_OFF: f32 = 0.01;

/// The measures of an imported body in place of the measured shopper's.
pub fn of_body(measured: Measurements, body: &Body) -> Measurements {
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

/// The session as reports show it.
pub fn session_report(session: &Session, more: &[String]) -> report::Session {
    report::Session {
        name: session.name.clone(),
        frames: session.joints.len().max(session.depth.len()) as u64,
        seconds: session.duration_ns() as f64 * 1e-9,
        notes: session.notes.iter().chain(more).cloned().collect(),
    }
}

/// The measures as reports show them; what could not be seen is what such a body has on average, with that sigma.
pub fn measures_report(measured: &Measurements, population: Population) -> report::Measurements {
    let mm = |e: Estimate| report::Measure {
        value: round(f64::from(e.value) * 1e3),
        sigma: round(f64::from(e.sigma) * 1e3),
    };
    let [stature, shoulder, chest, waist, hip] = measured.completed(population).map(mm);
    report::Measurements {
        stature_mm: stature,
        shoulder_breadth_mm: shoulder,
        chest_girth_mm: chest,
        waist_girth_mm: waist,
        hip_girth_mm: hip,
    }
}

/// Tenths of a millimetre are all that a measure deserves.
fn round(mm: f64) -> f64 {
    (mm * 10.0).round() / 10.0
}
