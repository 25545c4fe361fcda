//! Options of the body fit.

use toile_base::skeleton::Joint;

/// How a shopper is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitOptions {
    /// Height of the floor (m), where the camera's pose is known.
    pub ground: Option<f32>,
    /// Whether cloth covers the skin: the fit is then one-sided, because cloth lies outside.
    pub clothed: bool,
    /// Least distance between the surface samples (m): finer is more accurate and slower; 0 takes every face.
    pub spacing: f32,
    /// Gauss-Newton steps a frame.
    pub steps: usize,
    /// What the shopper does meanwhile.
    pub stance: Stance,
}

/// What a shopper does while a body is fitted to them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stance {
    /// Moves as they like: every joint may turn, and the outline only keeps the body inside.
    Moving,
    /// Stands still to be measured, or turns as a whole: joints keep their angles, and where no clothes stand off, the rim of the body is
    /// drawn to the outline from both sides, below the size of a pixel.
    Held,
}

impl FitOptions {
    /// For every frame at 30 Hz.
    pub const LIVE: Self = Self { ground: Some(0.0), clothed: true, spacing: 0.030, steps: 3, stance: Stance::Moving };

    /// For the seconds in which a shopper is measured.
    pub const MEASURING: Self = Self { ground: Some(0.0), clothed: true, spacing: 0.0, steps: 2, stance: Stance::Held };
}

/// Standard deviation of a cell's distance from the model's surface (m). Errors are correlated over a hand's breadth, so
/// that the thirty cells there count as one: 4 mm times the root of 30.
const CELL_SIGMA: f32 = 0.022;

/// The same where a person is measured: errors of a body that the model cannot have are correlated over more than a hand's
/// breadth, and then a front that fits a little better does not outweigh the breadth that is seen.
const CORRELATED_CELL_SIGMA: f32 = 0.040;

/// Share of the usual spreads of joint angles that a person has who stands upright to be measured.
const UPRIGHT: f32 = 0.5;

/// Standard deviation of a joint angle's change from one frame to the next (rad): of a person who moves; of a person who stands, and
/// their arms, which a turn hides for some frames.
const MOTION: f32 = 0.25;
const STILL: f32 = 0.03;
const STILL_ARM: f32 = 0.10;

impl FitOptions {
    /// Whether the outline shows the body from both sides: of a person who is measured, and whose clothes do not stand off.
    pub(super) const fn has_rim(&self) -> bool {
        matches!(self.stance, Stance::Held) && !self.clothed
    }

    /// Standard deviation of a cell's distance from the model's surface (m).
    pub(super) const fn cell_sigma(&self) -> f32 {
        if self.has_rim() { CORRELATED_CELL_SIGMA } else { CELL_SIGMA }
    }
}

impl Stance {
    /// What the usual spreads of joint angles are multiplied with.
    pub(super) const fn pose_spread(self) -> f32 {
        match self {
            Self::Moving => 1.0,
            Self::Held => UPRIGHT,
        }
    }

    /// Standard deviation of a joint angle's change from one frame to the next (rad).
    pub(super) fn motion(self, joint: Joint) -> f32 {
        match self {
            Self::Held if is_arm(joint) => STILL_ARM,
            Self::Held if joint != Joint::Pelvis => STILL,
            _ => MOTION,
        }
    }
}

/// Whether a joint carries an arm.
pub(super) fn is_arm(joint: Joint) -> bool {
    use Joint::*;
    matches!(
        joint,
        LeftClavicle | LeftShoulder | LeftElbow | LeftWrist | RightClavicle | RightShoulder | RightElbow | RightWrist
    )
}
