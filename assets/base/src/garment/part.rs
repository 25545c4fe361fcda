//! The part of the body that a particle lies on.

/// The part of the body that a particle lies on: what it can touch. Between an arm and the trunk, or between two legs,
/// cloth that met both would be pinched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Part {
    /// Any part of the body.
    #[default]
    All,
    /// Everything but the arms.
    Trunk,
    /// The left arm.
    LeftArm,
    /// The right arm.
    RightArm,
    /// Nothing: in the hollow of an armpit cloth is held by what surrounds it.
    Hollow,
    /// The left leg and the trunk.
    LeftLeg,
    /// The right leg and the trunk.
    RightLeg,
}
