//! Why a soak run cannot start.

use thiserror::Error;
use toile_engine::world::WorldError;
use toile_sensors::source::live::CameraError;

use super::options::LEAST_APART_S;

/// Why nothing can be soaked.
#[derive(Debug, Error)]
pub enum SoakError {
    /// Too many faults.
    #[error("{faults} faults do not fit into {seconds} s; ask for {} at most, or for a longer run", .seconds / LEAST_APART_S)]
    Crowded {
        /// What was asked for.
        faults: usize,
        /// The length of the run (s).
        seconds: u64,
    },
    /// A shopper or a garment.
    #[error("scene {number} cannot be made: {reason}")]
    Scene {
        /// Number of the scene.
        number: u64,
        /// Why it cannot be made.
        reason: String,
    },
    /// A frame that cannot be set up.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A depth camera that cannot be opened.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The system gave no thread, or no file.
    #[error("the run could not be started ({0}); raise the limits of threads and files")]
    Start(#[from] std::io::Error),
    /// A thread of the loop ended before its time.
    #[error("the {0} thread panicked; its message says why")]
    Died(&'static str),
}
