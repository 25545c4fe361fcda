//! How the cloth is stepped.

use std::fmt;
use std::str::FromStr;

use glam::Vec3A;
use toile_assets::limits::STEP_SECONDS;

use super::root::RootSettings;
use super::wind::Wind;
use crate::crew::SHARES;
use crate::lanes::Width;

/// Tested combinations of substeps and of what is solved in each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Quality {
    /// Every set once a substep, and tethers.
    Draft,
    /// Hoops and fibers twice a substep: what a shop shows.
    #[default]
    Shop,
    /// Closed hoops solved whole, and half as many substeps again.
    Fine,
}

impl Quality {
    /// All of them, cheapest first.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Shop, Self::Fine];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Shop => "shop",
            Self::Fine => "fine",
        }
    }

    /// Substeps for a garment that asks for so many at `Shop`.
    pub fn substeps(self, shop: u32) -> u32 {
        match self {
            Self::Draft | Self::Shop => shop,
            Self::Fine => shop + shop.div_ceil(2),
        }
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Quality {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|q| q.name() == name);
        found.ok_or_else(|| format!("there is no quality named {name}; give draft, shop or fine"))
    }
}

/// How the cloth is stepped; the same for every garment of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What is solved in a substep, and how many there are.
    pub quality: Quality,
    /// Substeps of a step, if not as many as garment and quality ask for. Small substeps beat many iterations (Macklin
    /// et al. 2019, "Small steps in physics simulation").
    pub substeps: Option<u32>,
    /// Length of a step (s).
    pub step_seconds: f32,
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3A,
    /// Speed limit of a particle (m/s): three times a fast arm; what is faster is an error, not cloth.
    pub max_speed: f32,
    /// Damping time of stretch (s): how long a fiber's own motion along itself takes to fade, 0 for none of its own.
    pub stretch_damping_s: f32,
    /// The wind, if any; garments have to be made ready for it by [`Cloth::in_wind`](super::Cloth::in_wind).
    pub wind: Option<Wind>,
    /// How the root's motion is passed on, and what happens when it jumps.
    pub root: RootSettings,
    /// Whether each particle is held within its length along the cloth from where the garment hangs. `draft` always does
    /// it, to stay in shape; the others only when asked, so that no measured strain hides behind it.
    pub tethers: bool,
    /// Friction coefficient of what sticks, over that of what slides, which is the fabric's (1).
    pub static_friction: f32,
    /// Workers of a step, 1 or 2.
    pub workers: usize,
    /// Lanes that kernels run on.
    pub width: Width,
    /// Whether stages are timed: some microseconds a step.
    pub timed: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            quality: Quality::default(),
            substeps: None,
            step_seconds: STEP_SECONDS,
            gravity: Vec3A::new(0.0, -9.81, 0.0),
            max_speed: 15.0,
            stretch_damping_s: 0.0,
            wind: None,
            root: RootSettings::default(),
            tethers: false,
            static_friction: 1.0,
            workers: std::thread::available_parallelism().map_or(1, |n| n.get().min(SHARES)),
            width: Width::widest(),
            timed: false,
        }
    }
}
