//! What is soaked, and how it is run.

use serde::{Deserialize, Serialize};
use toile_assets::drafting;
use toile_fitting::dress::try_on::shown_first;

/// What is soaked: all that decides on the bits of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SoakPlan {
    /// Everything follows from it.
    pub seed: u64,
    /// Length on the loop's clock (s).
    pub seconds: u64,
    /// Faults that are injected.
    pub faults: usize,
    /// How heavy the scenes are.
    pub scene: SceneWeight,
    /// What the shoppers put on.
    #[serde(default)]
    pub outfit: SoakOutfit,
    /// What sees the shoppers.
    #[serde(default)]
    pub camera: SoakCamera,
}

/// How it is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SoakOptions {
    /// Options of the run that a replay needs too.
    pub plan: SoakPlan,
    /// What the clock shows at the begin (h).
    pub uptime_hours: u64,
    /// On threads and the system's clock, in place of one after the other on a simulated one.
    pub real_time: bool,
    /// Workers of a step; 1 where the clock is simulated.
    pub workers: usize,
}

toile_base::named! {
    /// How heavy the scenes are.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum SceneWeight {
        /// Coarse garments in one substep, and one in sixteen of the body's vertices: for hours in minutes.
        Light = "light",
        /// The wardrobe as shoppers wear it.
        Full = "full",
    }
}

toile_base::named! {
    /// What the shoppers put on.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum SoakOutfit {
        /// One garment of the wardrobe after the other, in every size.
        Wardrobe = "wardrobe",
        /// The dress that the mirror shows first, in every size.
        #[default]
        Dress = "dress",
        /// Trousers, a shirt and a blazer over one another, women's and men's, in every size.
        Layers = "layers",
    }
}

impl SoakOutfit {
    /// The garments of each choice that a shopper has, inner first.
    pub fn choices(self) -> Vec<Vec<&'static str>> {
        match self {
            Self::Wardrobe => drafting::names().into_iter().map(|name| vec![name]).collect(),
            Self::Dress => vec![shown_first(None).to_vec()],
            Self::Layers => {
                vec![vec!["straight-trousers", "shirt", "blazer"], vec!["mens-trousers", "mens-shirt", "mens-blazer"]]
            }
        }
    }
}

toile_base::named! {
    /// What sees the shoppers, and so what can be wrong with it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum SoakCamera {
        /// A sensor that hands on joints.
        #[default]
        Joints = "joints",
        /// A depth camera with all that stands between it and the joints but the fit, which would take hours: the joints are the camera's
        /// own. On the system's clock the tracker's thread runs beside the others.
        Depth = "depth",
    }
}

/// Shortest time between two faults (s): the longest of three seconds, one to recover in, and some to see that it lasts.
pub const LEAST_APART_S: u64 = 6;
