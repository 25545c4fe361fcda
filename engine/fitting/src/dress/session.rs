//! Sessions: opened, their joints filtered, and the moment from which the shopper stands.

use std::path::Path;

use toile_assets::scene::SESSION;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Joints};
use toile_base::skeleton::Joint;
use toile_sensors::filter::JointFilter;
use toile_sensors::source::{self, OpenOptions, Session};

use crate::FittingError;

/// Name of the embedded session in reports.
const EMBEDDED_NAME: &str = "shopper (embedded)";

/// Time that a sensor which begins without seeing the hips is given to settle, once it sees them (ns): until then
/// the person is walking in, and legs are guesses.
const WALK_IN_NS: u64 = SECOND_NS / 2;

/// Opens a session, or the embedded one; `camera` describes raw depth.
///
/// # Errors
/// A file that cannot be read as a session.
pub fn open(path: Option<&Path>, camera: Option<&Path>) -> Result<Session, FittingError> {
    let options = OpenOptions { camera: camera.map(Path::to_path_buf) };
    match path {
        Some(path) => source::open(path, &options).map_err(FittingError::input),
        None => source::read_bytes(EMBEDDED_NAME, EMBEDDED_NAME, SESSION, None).map_err(FittingError::internal),
    }
}

/// A session of joints alone, in metres, as a live sender gives them.
pub fn of_joints(joints: Vec<Joints>) -> Session {
    Session { name: "live".into(), joints, raw_scale_known: true, ..Session::default() }
}

/// A session of directions, as a colour camera alone gives them: the size of the body is unknown.
pub fn of_directions(joints: Vec<Joints>) -> Session {
    Session { name: "live".into(), joints, raw_scale_known: false, ..Session::default() }
}

/// A session of depth alone, as a live camera gives it.
pub fn of_depth(depth: Vec<DepthFrame>) -> Session {
    Session { name: "live".into(), depth, raw_scale_known: true, ..Session::default() }
}

/// The joints of a session after the filter, at the same times: as the sensor thread filters them in the loop.
pub fn filtered(session: &Session) -> Vec<Joints> {
    let mut filter = JointFilter::default();
    session.joints.iter().map(|joints| filter.push(joints)).collect()
}

/// Whether a person is in view: both hips and the pelvis are believed, which dressing needs.
pub fn is_present(frame: &Joints) -> bool {
    const HIPS: [Joint; 3] = [Joint::Pelvis, Joint::LeftHip, Joint::RightHip];
    HIPS.iter().all(|&j| frame.at(j).is_believed())
}

/// The frame at which a shopper can be dressed: the first, unless the hips are not seen in it.
pub fn first_standing(track: &[Joints]) -> usize {
    match track.iter().position(is_present) {
        None | Some(0) => 0,
        Some(first) => {
            let settled = track[first].time_ns + WALK_IN_NS;
            track.iter().position(|frame| frame.time_ns >= settled && is_present(frame)).unwrap_or(first)
        }
    }
}

/// The filtered joints from the moment on at which the shopper can be dressed.
///
/// # Errors
/// A session without joints.
pub fn standing(session: &Session) -> Result<Vec<Joints>, FittingError> {
    let mut track = filtered(session);
    let from = first_standing(&track);
    track.drain(..from);
    if track.is_empty() {
        return Err(no_joints(session));
    }
    Ok(track)
}

/// That a session has no joints, which a moving body needs.
pub fn no_joints(session: &Session) -> FittingError {
    FittingError::Input(format!(
        "session {} has no joints, so that no pose can be shown; record joints too, or depth of a person who stands alone",
        session.name
    ))
}
