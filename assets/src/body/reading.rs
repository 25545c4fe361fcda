//! What can be read off a body, and the two vocabularies that name it: [`En`] (EN 13402-1, ISO 8559-1) and [`Ansur`].
//!
//! The standards and the survey lay the tape at other places (neck, waist) or on another pose (sleeve), which moves a
//! girth by more than its limit. So a set of wanted measures speaks one language or the other, and cannot mix them.

/// Something that is read off the mesh; the two vocabularies below map onto these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(super) enum Reading {
    Stature,
    CervicaleHeight,
    OmphalionHeight,
    CrotchHeight,
    KneeHeight,
    NeckGirth,
    NeckBaseGirth,
    ChestGirth,
    UnderbustGirth,
    WaistGirth,
    OmphalionGirth,
    HipGirth,
    ThighGirth,
    CalfGirth,
    UpperArmGirth,
    WristGirth,
    ShoulderBreadth,
    ChestBreadth,
    ChestDepth,
    OmphalionBreadth,
    OmphalionDepth,
    HipBreadth,
    HipDepth,
    ArmLength,
    SleeveLength,
    BackLength,
    WaistBackLength,
}

/// Number of readings.
pub(super) const READINGS: usize = 27;

impl Reading {
    pub(super) const fn index(self) -> usize {
        self as usize
    }

    /// The least and the most that a body is built for (m).
    pub(super) const fn range(self) -> [f32; 2] {
        use Reading::*;
        match self {
            Stature => [1.2, 2.2],
            CervicaleHeight => [1.0, 1.95],
            OmphalionHeight => [0.7, 1.4],
            CrotchHeight => [0.5, 1.15],
            KneeHeight => [0.3, 0.7],
            NeckGirth | NeckBaseGirth => [0.22, 0.65],
            ChestGirth | UnderbustGirth | WaistGirth | OmphalionGirth | HipGirth => [0.5, 1.8],
            ThighGirth => [0.3, 1.1],
            CalfGirth => [0.2, 0.65],
            UpperArmGirth => [0.16, 0.6],
            WristGirth => [0.1, 0.25],
            ShoulderBreadth => [0.25, 0.55],
            ChestBreadth | OmphalionBreadth | HipBreadth => [0.15, 0.7],
            ChestDepth | OmphalionDepth | HipDepth => [0.1, 0.6],
            ArmLength => [0.4, 0.85],
            SleeveLength => [0.55, 1.15],
            BackLength => [0.25, 0.65],
            WaistBackLength => [0.28, 0.7],
        }
    }
}

/// Measures of EN 13402-1 and ISO 8559-1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum En {
    /// Height without hair and shoes.
    Stature,
    /// Height of the 7th cervical vertebra.
    CervicalHeight,
    /// Inside leg: from the crotch to the floor.
    InsideLegHeight,
    /// Middle of the kneecap to the floor.
    KneeHeight,
    /// Round the neck 2 cm below the Adam's apple and over the 7th cervical vertebra.
    NeckGirth,
    /// Bust or chest: horizontal, over the bust points, under the armpits.
    BustGirth,
    /// Horizontal, just below the breasts.
    UnderbustGirth,
    /// At the natural waistline, midway between the lowest rib and the top of the hip bone.
    WaistGirth,
    /// At the greatest protrusion of the buttocks.
    HipGirth,
    /// Horizontal, greatest girth of one thigh below the crotch.
    ThighGirth,
    /// Horizontal, greatest girth of one calf.
    CalfGirth,
    /// Square to the relaxed upper arm at its greatest.
    UpperArmGirth,
    /// Square to the forearm at the wrist bone.
    WristGirth,
    /// Between the tips of the shoulder blades (biacromial).
    ShoulderBreadth,
    /// From the acromion over the bent elbow to the wrist bone. The body's arm is straight: what bending adds to it is
    /// the mean of ANSUR II.
    ArmLength,
    /// From the 7th cervical vertebra down the spine to the natural waistline.
    BackLength,
}

/// Measures of ANSUR II (US Army Natick TR-15/007, 2014), at its own levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ansur {
    /// `stature`
    Stature,
    /// `cervicaleheight`
    CervicaleHeight,
    /// `waistheightomphalion`: of the navel.
    WaistHeightOmphalion,
    /// `crotchheight`
    CrotchHeight,
    /// `kneeheightmidpatella`
    KneeHeightMidpatella,
    /// `neckcircumference`: at the Adam's apple, square to the neck.
    NeckCircumference,
    /// `chestcircumference`: over the bust points.
    ChestCircumference,
    /// `waistcircumference`: at the navel.
    WaistCircumferenceOmphalion,
    /// `buttockcircumference`: at the greatest protrusion of the buttocks.
    ButtockCircumference,
    /// `thighcircumference`: where the thigh meets the buttock.
    ThighCircumference,
    /// `calfcircumference`
    CalfCircumference,
    /// `wristcircumference`
    WristCircumference,
    /// `biacromialbreadth`
    BiacromialBreadth,
    /// `chestbreadth`
    ChestBreadth,
    /// `chestdepth`
    ChestDepth,
    /// `waistbreadth`: at the navel.
    WaistBreadthOmphalion,
    /// `waistdepth`: at the navel.
    WaistDepthOmphalion,
    /// `hipbreadth`
    HipBreadth,
    /// `buttockdepth`
    ButtockDepth,
    /// `sleevelengthspinewrist`: from the spine over the shoulder and the bent elbow to the wrist, the arm raised. The
    /// body's arm is straight: what the survey's pose adds to it is the survey's mean.
    SleeveLengthSpineWrist,
    /// `waistbacklength`: from the 7th cervical vertebra down the spine to the navel's level.
    WaistBackLengthOmphalion,
}

/// A vocabulary of measures. Sealed: [`En`] and [`Ansur`].
pub trait Vocabulary: Copy + Read + 'static {
    /// Every measure that it has.
    const ALL: &'static [Self];
    /// What a person would call the measure, without its unit.
    fn name(self) -> &'static str;
}

use sealed::Read;

mod sealed {
    /// Which reading of the mesh a measure is.
    pub trait Read {
        #[expect(private_interfaces, reason = "the trait is sealed: nobody outside calls it")]
        fn reading(self) -> super::Reading;
    }
}

/// Writes a vocabulary's table: measure, reading, name.
macro_rules! vocabulary {
    ($kind:ident: $($measure:ident $reading:ident $name:literal),* $(,)?) => {
        impl Read for $kind {
            #[expect(private_interfaces, reason = "the trait is sealed: nobody outside calls it")]
            fn reading(self) -> Reading {
                match self { $(Self::$measure => Reading::$reading),* }
            }
        }
        impl Vocabulary for $kind {
            const ALL: &'static [Self] = &[$(Self::$measure),*];
            fn name(self) -> &'static str {
                match self { $(Self::$measure => $name),* }
            }
        }
    };
}

vocabulary!(En:
    Stature Stature "stature",
    CervicalHeight CervicaleHeight "height of the 7th cervical vertebra",
    InsideLegHeight CrotchHeight "inside leg height",
    KneeHeight KneeHeight "knee height",
    NeckGirth NeckBaseGirth "neck girth",
    BustGirth ChestGirth "chest girth",
    UnderbustGirth UnderbustGirth "underbust girth",
    WaistGirth WaistGirth "waist girth",
    HipGirth HipGirth "hip girth",
    ThighGirth ThighGirth "thigh girth",
    CalfGirth CalfGirth "calf girth",
    UpperArmGirth UpperArmGirth "upper arm girth",
    WristGirth WristGirth "wrist girth",
    ShoulderBreadth ShoulderBreadth "shoulder breadth",
    ArmLength ArmLength "arm length",
    BackLength BackLength "back length",
);

vocabulary!(Ansur:
    Stature Stature "stature",
    CervicaleHeight CervicaleHeight "cervicale height",
    WaistHeightOmphalion OmphalionHeight "waist height (omphalion)",
    CrotchHeight CrotchHeight "crotch height",
    KneeHeightMidpatella KneeHeight "knee height (midpatella)",
    NeckCircumference NeckGirth "neck circumference",
    ChestCircumference ChestGirth "chest circumference",
    WaistCircumferenceOmphalion OmphalionGirth "waist circumference (omphalion)",
    ButtockCircumference HipGirth "buttock circumference",
    ThighCircumference ThighGirth "thigh circumference",
    CalfCircumference CalfGirth "calf circumference",
    WristCircumference WristGirth "wrist circumference",
    BiacromialBreadth ShoulderBreadth "biacromial breadth",
    ChestBreadth ChestBreadth "chest breadth",
    ChestDepth ChestDepth "chest depth",
    WaistBreadthOmphalion OmphalionBreadth "waist breadth (omphalion)",
    WaistDepthOmphalion OmphalionDepth "waist depth (omphalion)",
    HipBreadth HipBreadth "hip breadth",
    ButtockDepth HipDepth "buttock depth",
    SleeveLengthSpineWrist SleeveLength "sleeve length (spine to wrist)",
    WaistBackLengthOmphalion WaistBackLength "waist back length (omphalion)",
);

/// Measures that a body shall have, all of one vocabulary; what is not given follows from what is, as it does in people.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted<V: Vocabulary> {
    given: Vec<(V, f32)>,
}

impl<V: Vocabulary> Default for Wanted<V> {
    fn default() -> Self {
        Self { given: Vec::new() }
    }
}

impl<V: Vocabulary> Wanted<V> {
    /// Nothing yet: the mean body.
    pub fn new() -> Self {
        Self::default()
    }

    /// With one more measure (m); the last word about a measure counts.
    #[must_use]
    pub fn with(mut self, measure: V, metres: f32) -> Self {
        self.given.retain(|(m, _)| m.reading() != measure.reading());
        self.given.push((measure, metres));
        self
    }

    /// What has been asked for (m), in the order of asking.
    pub fn given(&self) -> &[(V, f32)] {
        &self.given
    }
}

/// Everything that the tape reads on one body (m).
#[derive(Debug, Clone, PartialEq)]
pub struct Readings(pub(super) [f32; READINGS]);

impl Readings {
    /// One measure (m).
    pub fn of<V: Vocabulary>(&self, measure: V) -> f32 {
        self.0[measure.reading().index()]
    }
}
