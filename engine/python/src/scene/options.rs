//! Options of dressing and motion.

use pyo3::prelude::*;
use toile_sdk::glam::Vec3;
use toile_sdk::{DressOptions, Motion, Wind};

use crate::failure::Failure;
use crate::track::{self, Track};
use crate::{numbers, words};

/// Air that moves, as the package's dataclass has it.
#[derive(FromPyObject)]
struct GivenWind<'py> {
    velocity: Bound<'py, PyAny>,
    drag: f32,
    lift: f32,
}

/// How a body moves: a word, a track, or the joints of one moment.
fn motion(given: &Bound<'_, PyAny>) -> PyResult<Motion> {
    if let Ok(track) = given.cast::<Track>() {
        return Ok(Motion::Track(track.get().frames.to_vec()));
    }
    if let Ok(word) = given.extract::<String>() {
        return match word.as_str() {
            "standing" => Ok(Motion::Standing),
            "sitting" => Ok(Motion::Sitting),
            _ => Err(Failure::usage(format!(
                "there is no motion {word:?}; give \"standing\", \"sitting\", a toile.Track, or the joints of one moment"
            ))
            .into()),
        };
    }
    Ok(Motion::Joints(Box::new(track::one(given)?)))
}

fn wind(given: &Bound<'_, PyAny>) -> PyResult<Wind> {
    let GivenWind { velocity, drag, lift } = given.extract().map_err(|_| {
        let given = given.repr().map_or_else(|_| "what is given".to_owned(), |repr| repr.to_string());
        Failure::usage(format!("{given} is no wind; give toile.Wind(velocity=(2, 0, 0))"))
    })?;
    let (velocity, _) = numbers::finite(&velocity, "wind's velocity", &[&[3]])?;
    Ok(Wind { velocity: Vec3::from_slice(&velocity), drag, lift })
}

/// Texts of a list, which a text alone is not.
pub fn strings(given: Option<&Bound<'_, PyAny>>, what: &str) -> PyResult<Vec<String>> {
    let Some(given) = given else { return Ok(Vec::new()) };
    let wrong = || Failure::usage(format!("the {what} are no list of str; give a list, of one name too"));
    Ok(given.extract::<Vec<String>>().map_err(|_| wrong())?)
}

/// Options as the SDK has them.
pub fn dressing(
    given_motion: Option<&Bound<'_, PyAny>>,
    quality: &str,
    workers: Option<i64>,
    given_wind: Option<&Bound<'_, PyAny>>,
    tuck: Option<&Bound<'_, PyAny>>,
) -> PyResult<DressOptions> {
    let defaults = DressOptions::default();
    let workers = workers.map(|workers| words::counted(workers, "number of workers")).transpose()?;
    Ok(DressOptions {
        motion: given_motion.map_or(Ok(Motion::Standing), motion)?,
        quality: words::quality(quality)?,
        workers: workers.unwrap_or(defaults.workers),
        wind: given_wind.map(wind).transpose()?,
        tuck: strings(tuck, "names of garments to tuck in")?,
    })
}
