//! Quality control: gives up quality in a stated order when steps grow long, and gives it back when there is time again.
//!
//! It looks at nothing but the time that steps took, so the same times give the same decisions. A deadline is never missed
//! to keep quality: one step beyond its period, or two of the last eight beyond [`LONG`] of it, give up a level at once. Quality comes
//! back a level at a time, and only where the longest step of a whole while would still be short at the next level; where
//! that proves wrong soon after, the while doubles, up to [`LONGEST_WHILE`].

use crate::cloth::{ContactRates, Settings};
use crate::meter::PERIOD_NS;

/// What a level leaves of the whole quality.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualityLevel {
    /// What is given up on this level.
    pub gives_up: &'static str,
    /// Share of the substeps that is made.
    pub substep_share: f32,
    /// Share of the whole quality's time that a step is reckoned with, before any has been made on it. From one level to the next it
    /// grows by as much as it does where that is most: substeps where there is no contact, contact in a T-shirt over trousers.
    pub time_share: f32,
    /// How often each kind of contact is looked for.
    pub contact: ContactRates,
    /// Whether there is wind.
    pub wind: bool,
}

impl QualityLevel {
    /// Settings as this level leaves them of those of whole quality.
    pub fn of(&self, whole: &Settings) -> Settings {
        Settings {
            substep_share: self.substep_share,
            wind: whole.wind.filter(|_| self.wind),
            contact: whole.contact.and(self.contact),
            ..*whole
        }
    }
}

/// Rates of the three kinds of contact: of a garment with itself, between garments, with the skin.
const fn rates([folds, layers, skin]: [u8; 3]) -> ContactRates {
    ContactRates { folds, layers, skin }
}

/// Whole quality.
const WHOLE: QualityLevel = QualityLevel {
    gives_up: "nothing",
    substep_share: 1.0,
    time_share: 1.0,
    contact: ContactRates::EVERY_STEP,
    wind: true,
};
const QUARTER: QualityLevel =
    QualityLevel { gives_up: "a quarter of the substeps", substep_share: 0.75, time_share: 0.75, ..WHOLE };
const HALF: QualityLevel =
    QualityLevel { gives_up: "half of the substeps", substep_share: 0.5, time_share: 0.5, ..QUARTER };
// Not in rate first: folds that are searched less often are looked at as far as cloth moves until the next search, and the more
// pairs, solved in every substep, take what the searches save: with every fourth search a step took half as long again.
const NO_FOLDS: QualityLevel =
    QualityLevel { gives_up: "contact of a garment with itself", time_share: 0.31, contact: rates([0, 1, 1]), ..HALF };
const LAYERS_HALF: QualityLevel = QualityLevel {
    gives_up: "every second search between garments",
    time_share: 0.3,
    contact: rates([0, 2, 1]),
    ..NO_FOLDS
};
const NO_LAYERS: QualityLevel =
    QualityLevel { gives_up: "contact between garments", time_share: 0.245, contact: rates([0, 0, 1]), ..LAYERS_HALF };
const SKIN_HALF: QualityLevel = QualityLevel {
    gives_up: "every second walk on the skin",
    time_share: 0.22,
    contact: rates([0, 0, 2]),
    ..NO_LAYERS
};
const NO_SKIN: QualityLevel =
    QualityLevel { gives_up: "the skin, for cones", time_share: 0.15, contact: rates([0, 0, 0]), ..SKIN_HALF };
const NO_WIND: QualityLevel = QualityLevel { gives_up: "the wind", time_share: 0.14, wind: false, ..NO_SKIN };

/// The quality levels, whole quality first: substeps go first, then contact of a garment with itself, then between
/// garments and with the skin, both in rate before they go altogether, then the wind. `toile latency --level L` measures the error of
/// each.
pub const QUALITY_LEVELS: [QualityLevel; 9] =
    [WHOLE, QUARTER, HALF, NO_FOLDS, LAYERS_HALF, NO_LAYERS, SKIN_HALF, NO_SKIN, NO_WIND];

/// Share of the period from which on a step is long.
pub const LONG: f32 = 0.7;

/// Share of the period below which a step, as it is expected on the next level, leaves time for that level.
pub const SHORT: f32 = 0.5;

/// Steps over which two long ones count: 67 ms.
const WINDOW: u32 = 8;

/// Steps for which there must be time before quality comes back: 1 s at first.
pub const FIRST_WHILE: u64 = 120;

/// The longest such while: 64 s.
pub const LONGEST_WHILE: u64 = 64 * FIRST_WHILE;

/// Steps within which giving up again proves that quality came back too early: 5 s.
const TOO_EARLY: u64 = 600;

/// A change of level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QualityChange {
    /// Place in [`QUALITY_LEVELS`] before.
    pub from: u8,
    /// Place in [`QUALITY_LEVELS`] from now on.
    pub to: u8,
}

/// Decides on the level.
#[derive(Debug, Clone, PartialEq)]
pub struct QualityControl {
    level: u8,
    /// Whether each of the last steps was long, the newest in the lowest bit.
    long: u32,
    /// Longest step since the level was taken or the while began (ns).
    longest_ns: u64,
    /// Steps since then.
    steps: u64,
    /// Steps since quality last came back.
    since_up: u64,
    /// The while, as it is now (steps).
    patience: u64,
    /// Whether it stays where it is, whatever happens.
    held: bool,
}

impl Default for QualityControl {
    fn default() -> Self {
        Self { level: 0, long: 0, longest_ns: 0, steps: 0, since_up: u64::MAX, patience: FIRST_WHILE, held: false }
    }
}

impl QualityControl {
    /// One that stays on a level (the last, where there is no such), to see what it costs and which error it has.
    pub fn held_on(level: u8) -> Self {
        Self { level: level.min(QUALITY_LEVELS.len() as u8 - 1), held: true, ..Self::default() }
    }

    /// The level as it is.
    pub fn level(&self) -> &'static QualityLevel {
        &QUALITY_LEVELS[usize::from(self.level)]
    }

    /// Index of the level in [`QUALITY_LEVELS`].
    pub fn place(&self) -> u8 {
        self.level
    }

    /// A step took so long (ns). Gives the change of level that the next step is to be taken with.
    pub fn after(&mut self, step_ns: u64) -> Option<QualityChange> {
        if self.held {
            return None;
        }
        let share = step_ns as f32 / PERIOD_NS as f32;
        self.long = (self.long << 1 | u32::from(share > LONG)) & ((1 << WINDOW) - 1);
        self.longest_ns = self.longest_ns.max(step_ns);
        self.steps += 1;
        self.since_up = self.since_up.saturating_add(1);
        if share > 1.0 || self.long.count_ones() >= 2 {
            return self.down();
        }
        if self.steps < self.patience {
            return None;
        }
        if self.since_up >= LONGEST_WHILE {
            // It has gone well for a long time: what made it wait is over.
            self.patience = (self.patience / 2).max(FIRST_WHILE);
        }
        let spare = self.has_spare_time();
        self.begin();
        if spare { self.up() } else { None }
    }

    /// Whether the longest step of the while would be short on the next better level.
    fn has_spare_time(&self) -> bool {
        let Some(better) = self.level.checked_sub(1) else { return false };
        let ratio = QUALITY_LEVELS[usize::from(better)].time_share / self.level().time_share;
        self.longest_ns as f32 * ratio < SHORT * PERIOD_NS as f32
    }

    fn begin(&mut self) {
        (self.long, self.longest_ns, self.steps) = (0, 0, 0);
    }

    fn down(&mut self) -> Option<QualityChange> {
        self.begin();
        let from = self.level;
        if usize::from(from) + 1 == QUALITY_LEVELS.len() {
            return None;
        }
        if self.since_up < TOO_EARLY {
            self.patience = (self.patience * 2).min(LONGEST_WHILE);
            // Counted once.
            self.since_up = TOO_EARLY;
        }
        self.level += 1;
        Some(QualityChange { from, to: self.level })
    }

    fn up(&mut self) -> Option<QualityChange> {
        let from = self.level;
        self.level -= 1;
        self.since_up = 0;
        Some(QualityChange { from, to: self.level })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// Plays steps whose whole quality takes `full` ms, and every level its share of it; gives the changes with their
    /// steps, and how many were beyond the period.
    fn play(quality_control: &mut QualityControl, steps: u64, full: impl Fn(u64) -> f64) -> (Vec<(u64, u8)>, u64) {
        let (mut changes, mut missed) = (Vec::new(), 0);
        for step in 0..steps {
            let ns = (full(step) * f64::from(quality_control.level().time_share) * MS as f64) as u64;
            missed += u64::from(ns > PERIOD_NS);
            changes.extend(quality_control.after(ns).map(|c| (step, c.to)));
        }
        (changes, missed)
    }

    #[test]
    fn short_steps_change_nothing_and_one_long_one_neither() {
        let mut quality_control = QualityControl::default();
        let (changes, missed) = play(&mut quality_control, 10_000, |step| if step % 100 == 7 { 6.5 } else { 3.0 });
        assert_eq!((changes, missed), (vec![], 0));
    }

    #[test]
    fn two_long_steps_give_up_a_level() {
        let (changes, missed) = play(&mut QualityControl::default(), 1_000, |step| if step < 100 { 3.0 } else { 6.5 });
        assert_eq!(changes, [(101, 1)], "and three quarters of 6.5 ms are not long");
        assert_eq!(missed, 0);
    }

    #[test]
    fn an_overlong_step_drops_a_level_at_once() {
        let (changes, missed) = play(&mut QualityControl::default(), 500, |_| 80.0);
        let last = QUALITY_LEVELS.len() as u8 - 1;
        assert_eq!(changes, (0..last).map(|k| (u64::from(k), k + 1)).collect::<Vec<_>>());
        assert_eq!(missed, 500, "nothing helps against that");
        let (changes, missed) = play(&mut QualityControl::default(), 500, |_| 10.0);
        assert_eq!((changes[0], missed), ((0, 1), 1));
    }

    #[test]
    fn quality_comes_back_one_level_at_a_time() {
        let mut quality_control = QualityControl::default();
        play(&mut quality_control, 100, |_| 11.0);
        assert_eq!(quality_control.place(), 2);
        let (changes, _) = play(&mut quality_control, 1_000, |_| 3.0);
        assert_eq!(changes.iter().map(|c| c.1).collect::<Vec<_>>(), [1, 0]);
        assert!(changes[0].0 >= FIRST_WHILE / 2 && changes[1].0 - changes[0].0 == FIRST_WHILE, "{changes:?}");
    }

    #[test]
    fn a_load_between_two_levels_causes_no_swings() {
        let mut quality_control = QualityControl::default();
        // Three quarters of it leave no time for the better level; at whole quality the step is long.
        let (changes, _) = play(&mut quality_control, 120 * 600, |_| 6.2);
        assert_eq!(changes, [(1, 1)]);
    }

    #[test]
    fn a_load_that_comes_and_goes_is_tried_less_and_less_often() {
        let mut quality_control = QualityControl::default();
        // Every two seconds, half a second of steps that are too long at whole quality.
        let (changes, missed) = play(&mut quality_control, 120 * 600, |step| if step % 240 < 60 { 9.0 } else { 2.0 });
        let late = changes.iter().filter(|c| c.0 > 120 * 300).count();
        assert!(changes.len() < 60 && late <= 6, "{} changes, {late} of them late: {changes:?}", changes.len());
        assert!(missed <= changes.len() as u64, "each rise is paid for once at most: {missed}");
    }

    #[test]
    fn one_that_is_held_stays_where_it_is() {
        let mut quality_control = QualityControl::held_on(2);
        let (changes, _) = play(&mut quality_control, 500, |step| if step < 250 { 1.0 } else { 40.0 });
        assert_eq!(
            (changes, quality_control.place(), QualityControl::held_on(99).place()),
            (vec![], 2, QUALITY_LEVELS.len() as u8 - 1)
        );
    }

    #[test]
    fn each_level_only_gives_up() {
        // How often in eight steps something is done.
        let often = |every: u8| 8u8.checked_div(every).unwrap_or(0);
        for pair in QUALITY_LEVELS.windows(2) {
            let amounts = |r: &QualityLevel| {
                [often(r.contact.folds), often(r.contact.layers), often(r.contact.skin), u8::from(r.wind)]
            };
            let back = amounts(&pair[0]).into_iter().zip(amounts(&pair[1])).any(|(before, after)| after > before);
            assert!(pair[1].substep_share <= pair[0].substep_share && pair[1].time_share < pair[0].time_share && !back);
            assert!(pair[1] != pair[0]);
        }
        let whole = Settings { substep_share: 1.0, ..Settings::default() };
        assert_eq!(QUALITY_LEVELS[0].of(&whole), whole);
        assert_eq!(QUALITY_LEVELS[QUALITY_LEVELS.len() - 1].contact, ContactRates { folds: 0, layers: 0, skin: 0 });
    }

    #[test]
    fn no_level_switches_anything_on() {
        let rarer = ContactRates { folds: 0, layers: 4, skin: 0 };
        let whole = Settings { contact: rarer, ..Settings::default() };
        for level in &QUALITY_LEVELS {
            let settings = level.of(&whole);
            let every = settings.contact;
            assert_eq!((every.folds, every.skin), (0, 0), "{}", level.gives_up);
            assert!(every.layers == 4 || every.layers == 0, "{}", level.gives_up);
        }
    }
}
