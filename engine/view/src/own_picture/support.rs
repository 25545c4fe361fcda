//! Checks the fitted body against the picture. If the picture does not confirm the body, no garment is drawn.

use glam::Vec2;

use super::occlusion::DepthInPicture;
use toile_sensors::person_mask::PersonMask;

/// Why the picture is shown plain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Plain {
    /// There is no picture: nothing has come yet, or it cannot be looked at.
    NoPicture,
    /// How the camera sees is not known, so that nothing can be drawn in register.
    UnknownCamera,
    /// No person is seen, or too little of one.
    Nobody,
    /// They stand where the picture does not show enough of what they would wear.
    OutOfPicture,
    /// A person is seen, but the picture does not confirm the fitted body.
    Unsure,
    /// The scene that is dressed is another: it comes with the next picture.
    Changing,
}

impl Plain {
    /// All of them, in their order.
    pub const ALL: [Self; 6] =
        [Self::NoPicture, Self::UnknownCamera, Self::Nobody, Self::OutOfPicture, Self::Unsure, Self::Changing];
}

/// Places that are looked at, at least.
const FEWEST: u32 = 60;

/// A body is where it was fitted if so much is measured there, or nearer.
const LEAST_DEPTH: f32 = 0.6;

/// Farthest that depth may be from the fitted body (m).
const OFF_M: f32 = 0.15;

/// Odds of a person, and the share of places that have them.
const ODDS: f32 = 0.5;
const LEAST_MASK: f32 = 0.6;

/// Counts what bears the body out.
#[derive(Debug, Clone, Copy, Default)]
pub struct Support {
    measured: [u32; 2],
    odds: [u32; 2],
}

impl Support {
    /// A pixel of the picture at which the body stands at a distance (m).
    pub fn look(&mut self, pixel: Vec2, body: f32, depth: &DepthInPicture, mask: Option<&PersonMask>) {
        if let Some(z) = depth.at(pixel) {
            self.measured[0] += 1;
            self.measured[1] += u32::from(z < body + OFF_M);
        }
        if let Some(odds) = mask.and_then(|mask| mask.at(pixel)) {
            self.odds[0] += 1;
            self.odds[1] += u32::from(odds >= ODDS);
        }
    }

    /// Whether it is borne out by all that is known.
    pub fn is_enough(&self) -> bool {
        let holds = |[of, found]: [u32; 2], least: f32| of < FEWEST || found as f32 >= least * of as f32;
        holds(self.measured, LEAST_DEPTH) && holds(self.odds, LEAST_MASK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_where_the_picture_shows_a_wall_is_not_borne_out() {
        let depth = DepthInPicture::default();
        for (odds, enough) in [(0.9, true), (0.2, false)] {
            let mask =
                PersonMask { side: 1, odds: vec![odds], from_picture: glam::Affine2::from_scale(Vec2::splat(1e-3)) };
            let mut support = Support::default();
            (0..FEWEST).for_each(|i| support.look(Vec2::splat(i as f32), 2.0, &depth, Some(&mask)));
            assert_eq!(support.is_enough(), enough);
        }
        assert!(Support::default().is_enough(), "what nothing is known of is not denied");
    }
}
