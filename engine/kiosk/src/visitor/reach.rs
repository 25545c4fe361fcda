//! Reach: the heights between which the controls stand, so that the visitor reaches them.
//!
//! The bounds are those of the 2010 ADA Standards for Accessible Design, 308.2.1 (unobstructed forward reach) and 308.3.1
//! (unobstructed side reach): at most 48 in (1,220 mm) and at least 15 in (380 mm) over the floor. This module keeps to
//! the heights, for a display that hangs as [`DisplayMount`] says. Nothing may stand before the display (308.2.2, 308.3.2 allow less then), and
//! there must be clear floor to come near. The installer sees to both, and to the stated height of the display.

/// Most over the floor that a control may be (mm): ADA 308.2.1 and 308.3.1.
pub const HIGHEST_MM: f32 = 1220.0;

/// Least over the floor that a control may be (mm): ADA 308.2.1 and 308.3.1.
pub const LOWEST_MM: f32 = 380.0;

/// Least height that the controls have (mm): ten rows of 40 mm, with their gaps, fit.
pub const LEAST_BAND_MM: f32 = 450.0;

/// Most height that the controls have (mm): more than an arm moves over without a step.
const MOST_BAND_MM: f32 = 700.0;

/// From the head's joint down to where a raised hand rests on a display (mm): the shoulder, about. A head's joint at 1,520 mm, of a
/// stature of 1,650 mm, gives the 1,220 mm of the standard.
const HEAD_TO_HAND_MM: f32 = 300.0;

/// How the display hangs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayMount {
    /// From the floor to the lower edge of the picture (mm).
    pub lower_edge_mm: f32,
    /// Height of the picture (mm).
    pub height_mm: f32,
}

impl Default for DisplayMount {
    /// A display of 55 inches, upright, whose picture begins 400 mm over the floor.
    fn default() -> Self {
        Self { lower_edge_mm: 400.0, height_mm: 1210.0 }
    }
}

/// Where the controls stand, as shares of the picture's height over its lower edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlBand {
    /// Lower edge, 0 .. 1.
    pub low: f32,
    /// Upper edge, 0 .. 1.
    pub high: f32,
}

impl DisplayMount {
    /// What is wrong with it, with the cure; none where controls of [`LEAST_BAND_MM`] fit between [`LOWEST_MM`] and [`HIGHEST_MM`].
    pub fn fault(&self) -> Option<String> {
        let Self { lower_edge_mm: low, height_mm: height } = *self;
        // Reversed, so that NaN is a fault too.
        if !((0.0..=2500.0).contains(&low) && (200.0..=4000.0).contains(&height)) {
            return Some(format!(
                "display.lower_edge_mm = {low} and height_mm = {height} are not within 0 .. 2500 and 200 .. 4000 mm; correct them"
            ));
        }
        let room = HIGHEST_MM.min(low + height) - LOWEST_MM.max(low);
        (room < LEAST_BAND_MM).then(|| {
            format!(
                "a display from {low} to {} mm over the floor leaves {:.0} mm for controls between {LOWEST_MM} and \
                 {HIGHEST_MM} mm, less than {LEAST_BAND_MM}; hang it so that the controls are within reach",
                low + height,
                room.max(0.0)
            )
        })
    }

    /// The controls' place for a person whose head's joint is so high (mm); as high as is allowed where that is not known.
    pub fn band(&self, head_mm: Option<f32>) -> ControlBand {
        let (bottom, top) = (LOWEST_MM.max(self.lower_edge_mm), HIGHEST_MM.min(self.lower_edge_mm + self.height_mm));
        let hand = head_mm.filter(|h| h.is_finite()).map_or(HIGHEST_MM, |h| h - HEAD_TO_HAND_MM);
        let high = hand.max(bottom + LEAST_BAND_MM).min(top);
        let low = bottom.max(high - MOST_BAND_MM);
        let share = |mm: f32| ((mm - self.lower_edge_mm) / self.height_mm).clamp(0.0, 1.0);
        ControlBand { low: share(low), high: share(high) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The band in millimetres over the floor.
    fn mm(mount: DisplayMount, head_mm: Option<f32>) -> [f32; 2] {
        let band = mount.band(head_mm);
        [band.low, band.high].map(|share| mount.lower_edge_mm + share * mount.height_mm)
    }

    #[test]
    fn every_control_of_valid_mounts_meets_the_standard() {
        let mut sound = 0;
        for lower_edge_mm in (0..2000).step_by(50).map(|v| v as f32) {
            for height_mm in (200..2600).step_by(100).map(|v| v as f32) {
                let mount = DisplayMount { lower_edge_mm, height_mm };
                if mount.fault().is_some() {
                    continue;
                }
                sound += 1;
                for head_mm in
                    [None, Some(f32::NAN), Some(400.0), Some(900.0), Some(1150.0), Some(1520.0), Some(2300.0)]
                {
                    let [low, high] = mm(mount, head_mm);
                    assert!(low >= LOWEST_MM - 0.1 && high <= HIGHEST_MM + 0.1, "{mount:?} {head_mm:?}: {low} {high}");
                    assert!(high - low >= LEAST_BAND_MM - 0.1, "{mount:?} {head_mm:?}: {low} {high}");
                    assert!(low >= lower_edge_mm - 0.1 && high <= lower_edge_mm + height_mm + 0.1);
                }
            }
        }
        assert!(sound > 100, "{sound} mounts");
    }

    #[test]
    fn controls_follow_the_height_of_who_is_there() {
        let of = |head| mm(DisplayMount::default(), Some(head))[1];
        assert!((of(1600.0) - HIGHEST_MM).abs() < 0.1, "tall");
        assert!((of(1200.0) - 900.0).abs() < 0.1, "seated: a hand's height");
        assert!(
            (of(800.0) - (400.0 + LEAST_BAND_MM)).abs() < 0.1,
            "a child: as low as the controls' own height allows"
        );
    }

    #[test]
    fn a_mount_that_leaves_no_room_is_a_fault_with_its_cure() {
        for (lower_edge_mm, height_mm, word) in [
            (1000.0, 900.0, "hang it"),
            (0.0, 500.0, "hang it"),
            (f32::NAN, 900.0, "correct"),
            (400.0, -3.0, "correct"),
        ] {
            let message = DisplayMount { lower_edge_mm, height_mm }.fault().unwrap();
            assert!(
                message.contains(word) && message.contains("lower_edge_mm") | message.contains("over the floor"),
                "{message}"
            );
        }
        assert_eq!(DisplayMount::default().fault(), None);
    }
}
