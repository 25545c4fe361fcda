//! Soak: the loop for hours, with shoppers who come and go, garments that are changed, and everything that can go wrong.
//!
//! Reads: a seed, from which all of it follows. Writes: what was checked while it ran, a page, a recording.
//! Budget: about 100 us a step of the light scene, everything included; wall time where it runs in real time.
//! Thread: the caller's, all lives one after the other against a simulated clock; or the loop's own threads.
//!
//! Scenes are made outside of the physics' turn and handed over whole. What a fault does and when it counts as recovered
//! stands with [`script::Kind`].

mod camera;
mod company;
mod front;
mod html;
mod lives;
mod memory;
mod recorder;
mod report;
mod run;
pub mod script;
mod watch;

pub use company::Company;
pub use html::page;
pub use memory::Sample;
pub use report::{Check, FaultKind, Faults, Memory, Recovery, Soak};
pub use run::{Ran, Tools, run};

use serde::{Deserialize, Serialize};
use thiserror::Error;
use toile_engine::frame::FrameError;

/// What is soaked: all that decides on the bits of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plan {
    /// Everything follows from it.
    pub seed: u64,
    /// Length on the loop's clock (s).
    pub seconds: u64,
    /// Faults that are injected.
    pub faults: usize,
    /// How heavy the scenes are.
    pub scene: Weight,
}

/// How it is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// What is soaked.
    pub plan: Plan,
    /// What the clock shows at the begin (h).
    pub uptime_hours: u64,
    /// On threads and the system's clock, in place of one after the other on a simulated one.
    pub real_time: bool,
    /// Workers of a step; 1 where the clock is simulated.
    pub workers: usize,
}

/// How heavy the scenes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weight {
    /// Threads so far apart that a step costs some 50 us, and one in sixteen of the body's vertices: for hours in minutes.
    Light,
    /// The wardrobe as shoppers wear it.
    Full,
}

impl Weight {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Light, Self::Full];

    /// Its name in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Full => "full",
        }
    }
}

/// Shortest time between two faults (s): the longest of three seconds, one to recover in, and some to see that it lasts.
pub const LEAST_APART_S: u64 = 6;

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
        /// Its number.
        number: u64,
        /// Why.
        reason: String,
    },
    /// A frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The system gave no thread, or no file.
    #[error("the run could not be started ({0}); raise the limits of threads and files")]
    Start(#[from] std::io::Error),
    /// A thread of the loop ended before its time.
    #[error("the {0} thread panicked; its message tells the cause")]
    Died(&'static str),
}
