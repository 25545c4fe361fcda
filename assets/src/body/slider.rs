//! The sliders by which a body is changed.

toile_base::named! {
    /// What can be changed on a body; lengths in metres a unit, the others as a fraction of the base's size.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[repr(u8)]
    pub(super) enum Slider {
        LowerLeg,
        UpperLeg,
        LowerTrunk,
        UpperTrunk,
        NeckLength,
        ArmLength,
        Shoulders,
        Neck,
        ChestBreadth,
        ChestDepth,
        Underbust,
        Waist,
        AbdomenBreadth,
        AbdomenDepth,
        HipBreadth,
        HipDepth,
        Thigh,
        Knee,
        Calf,
        UpperArm,
        Forearm,
        Wrist,
    }
}

/// Number of sliders besides the scale of the whole.
pub(super) const SLIDERS: usize = 22;

/// Number of what a calibration may choose: the sliders, then the logarithm of the scale.
pub(super) const PARAMETERS: usize = SLIDERS + 1;

impl Slider {
    pub(super) const fn index(self) -> usize {
        self as usize
    }

    /// Whether its unit is the metre.
    pub(super) const fn is_length(self) -> bool {
        self.index() <= Self::ArmLength.index()
    }
}
