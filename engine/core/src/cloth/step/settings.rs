//! How the cloth is stepped.

use std::str::FromStr;

use glam::Vec3A;
use toile_base::limits::STEP_SECONDS;

use crate::cloth::forces::root::RootSettings;
use crate::cloth::forces::wind::Wind;
use crate::lanes::Width;
use crate::workers::SHARES;

toile_base::named! {
    /// Tested combinations of substeps and of what is solved in each, cheapest first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum Quality {
        /// Every set once a substep, and tethers.
        Draft = "draft",
        /// Hoops and fibers twice a substep: what a shop shows.
        #[default]
        Shop = "shop",
        /// The same in three times as many substeps, shear in each of them: on the garments that Toile has, nearer to the truth
        /// for its time than whole hoops in fewer (`toile pareto`).
        Fine = "fine",
    }
}

impl Quality {
    /// Substeps for a garment that asks for so many at `Shop`.
    pub fn substeps(self, shop: u32) -> u32 {
        match self {
            Self::Draft | Self::Shop => shop,
            Self::Fine => 3 * shop,
        }
    }
}

impl FromStr for Quality {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|q| q.name() == name);
        found.ok_or_else(|| format!("there is no quality named {name}; give draft, shop or fine"))
    }
}

/// Every how many steps each kind of contact is looked for: 1 is in each, 0 is never. In the steps between, what was found is
/// solved as it was, and was looked for as far ahead as that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactRates {
    /// Contact of a garment with itself. Without it the garment passes through itself.
    pub folds: u8,
    /// Contact between garments that are worn together. Without it they pass through each other.
    pub layers: u8,
    /// The nearest points of the skin, where the colliders have one. Without them cloth lies on the cones.
    pub skin: u8,
}

impl ContactRates {
    /// All of it in every step.
    pub const EVERY_STEP: Self = Self { folds: 1, layers: 1, skin: 1 };

    /// Each kind in every step or never.
    pub const fn on(folds: bool, layers: bool, skin: bool) -> Self {
        Self { folds: folds as u8, layers: layers as u8, skin: skin as u8 }
    }

    /// The rarer of both, kind by kind; what one of them never looks for is never looked for.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let rarer = |a: u8, b: u8| if a == 0 || b == 0 { 0 } else { a.max(b) };
        let (folds, layers) = (rarer(self.folds, other.folds), rarer(self.layers, other.layers));
        Self { folds, layers, skin: rarer(self.skin, other.skin) }
    }
}

/// Most steps from one search to the next: what is farther ahead is no longer where it was expected.
const MOST_APART: u8 = 8;

/// How the cloth is stepped; the same for every garment of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What is solved in a substep, and how many there are.
    pub quality: Quality,
    /// Substeps of a step, if not as many as garment and quality ask for. Small substeps beat many iterations (Macklin
    /// et al. 2019, "Small steps in physics simulation").
    pub substeps: Option<u32>,
    /// Share of these substeps that are made, above 0 to 1: what quality control of the loop gives up first.
    pub substep_share: f32,
    /// Length of a step (s).
    pub step_seconds: f32,
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3A,
    /// Speed limit of a particle (m/s): three times a fast arm; what is faster is an error, not cloth.
    pub max_speed: f32,
    /// Damping time of stretch (s): how long a fiber's own motion along itself takes to fade, 0 for none of its own.
    pub stretch_damping_s: f32,
    /// The wind, if any; garments have to be made ready for it by [`Cloth::in_wind`](crate::cloth::Cloth::in_wind).
    pub wind: Option<Wind>,
    /// How the root's motion is passed on, and what happens when it jumps.
    pub root: RootSettings,
    /// Whether each particle is held within its length along the cloth from where the garment hangs. `draft` always does
    /// it, to stay in shape; the others only when asked, so that no measured strain hides behind it.
    pub tethers: bool,
    /// Friction coefficient of what sticks, over that of what slides, which is the fabric's (1).
    pub static_friction: f32,
    /// Whether contact follows particles along their ways; without it, what is thin and fast passes through them. For
    /// telling what it is worth (`toile plan`).
    pub continuous: bool,
    /// Rate of each kind of contact, which quality control lowers.
    pub contact: ContactRates,
    /// Workers of a step, 1 or 2. A world takes the nearest of them that it can have, which its own settings then name.
    pub workers: usize,
    /// Lanes that kernels run on.
    pub width: Width,
    /// Whether stages are timed: some microseconds a step.
    pub timed: bool,
}

/// Most substeps of a step. In shorter ones the last bit of a position of f32 a metre from the origin is a speed of several
/// mm/s: with 4,096 a cloth at rest was thrown about by its own rounding. What asks for more is no number of substeps.
pub const MAX_SUBSTEPS: u32 = 512;

/// Least share of the substeps: below a tenth no garment keeps its shape.
const LEAST_SHARE: f32 = 0.1;

/// Shortest and longest step (s); in shorter ones no f32 a metre from the origin moves, longer ones are no steps.
const STEPS_S: [f32; 2] = [1e-6, 1.0];

/// Greatest acceleration of gravity, along each axis (m/s2).
const MOST_GRAVITY: f32 = 1e4;

/// Greatest speed limit, and fastest air along each axis (m/s).
const MOST_SPEED: f32 = 1e3;

/// Greatest of all that is a ratio, a coefficient or a damping time: ten times and more what means anything.
const MOST: f32 = 100.0;

impl Settings {
    /// Substeps of a step of a garment for which its bake asks so many in 1/120 s at the quality `shop`.
    pub fn substeps_of(&self, garment: u32) -> u32 {
        // The bake counts substeps of steps of 1/120 s.
        let longer = (self.step_seconds / STEP_SECONDS).max(1.0);
        let chosen = (self.quality.substeps(garment) as f32 * longer).ceil() as u32;
        let whole = self.substeps.unwrap_or(chosen) as f32;
        ((whole * self.substep_share).ceil() as u32).clamp(1, MAX_SUBSTEPS)
    }

    /// The settings with every figure that no step can be made with replaced by its default, and without a wind whose
    /// figures cannot be used. Checked at the start of a step, so that a wrong figure costs a step its setting and not the
    /// garment. Settings with nothing wrong are returned unchanged.
    #[must_use]
    pub fn sound(&self) -> Self {
        let within = |value: f32, low: f32, high: f32, or: f32| if (low..=high).contains(&value) { value } else { or };
        let small = |v: Vec3A, most: f32| v.abs().cmple(Vec3A::splat(most)).all();
        let root = RootSettings::default();
        let wind = |w: &Wind| {
            small(w.velocity, MOST_SPEED) && (0.0..=MOST).contains(&w.drag) && (0.0..=MOST).contains(&w.lift)
        };
        Self {
            substeps: self.substeps.map(|n| n.min(MAX_SUBSTEPS)),
            substep_share: within(self.substep_share, LEAST_SHARE, 1.0, 1.0),
            step_seconds: within(self.step_seconds, STEPS_S[0], STEPS_S[1], STEP_SECONDS),
            gravity: if small(self.gravity, MOST_GRAVITY) { self.gravity } else { GRAVITY },
            max_speed: within(self.max_speed, 0.0, MOST_SPEED, MAX_SPEED),
            stretch_damping_s: within(self.stretch_damping_s, 0.0, MOST, 0.0),
            wind: self.wind.filter(wind),
            root: RootSettings {
                linear: within(self.root.linear, -MOST, MOST, root.linear),
                angular: within(self.root.angular, -MOST, MOST, root.angular),
                centrifugal: within(self.root.centrifugal, -MOST, MOST, root.centrifugal),
                // Infinity is a body that is never teleported.
                teleport_m: within(self.root.teleport_m, 0.0, f32::INFINITY, root.teleport_m),
                teleport_degrees: within(self.root.teleport_degrees, 0.0, f32::INFINITY, root.teleport_degrees),
                teleport: self.root.teleport,
            },
            static_friction: within(self.static_friction, 0.0, MOST, 1.0),
            contact: ContactRates {
                folds: self.contact.folds.min(MOST_APART),
                layers: self.contact.layers.min(MOST_APART),
                skin: self.contact.skin.min(MOST_APART),
            },
            ..*self
        }
    }
}

/// Acceleration of gravity (m/s2).
const GRAVITY: Vec3A = Vec3A::new(0.0, -9.81, 0.0);

/// Default of [`Settings::max_speed`] (m/s).
const MAX_SPEED: f32 = 15.0;

impl Default for Settings {
    fn default() -> Self {
        Self {
            quality: Quality::default(),
            substeps: None,
            substep_share: 1.0,
            step_seconds: STEP_SECONDS,
            gravity: GRAVITY,
            max_speed: MAX_SPEED,
            stretch_damping_s: 0.0,
            wind: None,
            root: RootSettings::default(),
            tethers: false,
            static_friction: 1.0,
            continuous: true,
            contact: ContactRates::EVERY_STEP,
            workers: std::thread::available_parallelism().map_or(1, |n| n.get().min(SHARES)),
            width: Width::widest(),
            timed: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sound_settings_are_left_alone() {
        let wind = Some(Wind { velocity: Vec3A::new(2.0, 0.0, -30.0), drag: 1.2, lift: 0.6 });
        let fast = RootSettings { linear: 0.0, teleport_m: f32::INFINITY, ..RootSettings::default() };
        let odd = Settings { wind, root: fast, substeps: Some(400), step_seconds: 1.0 / 30.0, ..Settings::default() };
        for settings in [Settings::default(), odd] {
            assert_eq!(settings.sound(), settings);
        }
    }

    #[test]
    fn the_rarer_rate_counts_and_off_stays_off() {
        let rates = |folds, layers, skin| ContactRates { folds, layers, skin };
        assert_eq!(rates(2, 4, 1).and(ContactRates::on(false, true, true)), rates(0, 4, 1));
        assert_eq!(rates(1, 2, 4).and(rates(2, 1, 0)), rates(2, 2, 0));
    }

    #[test]
    fn what_is_no_figure_is_as_it_is_by_default() {
        let default = Settings::default();
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1.0] {
            let root = RootSettings { linear: bad * 1e9, angular: bad * 1e9, centrifugal: f32::NAN, ..default.root };
            let wind = Some(Wind { velocity: Vec3A::ZERO, drag: bad, lift: 0.0 });
            let settings = Settings {
                step_seconds: bad,
                substep_share: bad,
                gravity: Vec3A::new(0.0, bad * 1e9, 0.0),
                max_speed: bad,
                stretch_damping_s: bad,
                static_friction: bad,
                root,
                wind,
                ..default
            };
            assert_eq!(settings.sound(), default, "{bad}");
        }
        let [never, rare, rarest] = [0, 2, u8::MAX].map(|n| ContactRates { folds: n, layers: n, skin: n });
        let sound = |contact| Settings { contact, ..default }.sound().contact;
        assert_eq!((sound(never), sound(rare), sound(rarest).folds), (never, rare, MOST_APART));
        let endless = Settings { substeps: Some(u32::MAX), ..default };
        assert_eq!(endless.sound().substeps, Some(MAX_SUBSTEPS));
    }
}
