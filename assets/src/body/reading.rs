//! Measures that can be read off a body, and the two vocabularies that name them: [`En`] (EN 13402-1, ISO 8559-1) and [`Ansur`].
//!
//! The standards and the survey lay the tape at other places (neck, waist) or on another pose (sleeve), which moves a
//! girth by more than its limit. So a set of wanted measures speaks one language or the other, and cannot mix them.

/// Something that is read off the mesh; the two vocabularies below map onto these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(super) enum MeshMeasure {
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

impl MeshMeasure {
    pub(super) const fn index(self) -> usize {
        self as usize
    }

    /// The least and the most that a body is built for (m).
    pub(super) const fn range(self) -> [f32; 2] {
        use super::reading::MeshMeasure::*;
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

/// A vocabulary, its reading and its name of each measure.
macro_rules! vocabulary {
    ($(#[$about:meta])* pub enum $kind:ident {
        $($(#[$of:meta])* $measure:ident: $reading:ident = $name:literal,)*
    }) => {
        $(#[$about])*
        pub enum $kind { $($(#[$of])* $measure,)* }

        impl Read for $kind {
            #[expect(private_interfaces, reason = "the trait is sealed: no code outside calls it")]
            fn reading(self) -> MeshMeasure {
                match self { $(Self::$measure => MeshMeasure::$reading),* }
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

vocabulary! {
    /// Measures of EN 13402-1 and ISO 8559-1.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum En {
        /// Height without hair and shoes.
        Stature: Stature = "stature",
        /// Height of the 7th cervical vertebra.
        CervicalHeight: CervicaleHeight = "height of the 7th cervical vertebra",
        /// Inside leg: from the crotch to the floor.
        InsideLegHeight: CrotchHeight = "inside leg height",
        /// Middle of the kneecap to the floor.
        KneeHeight: KneeHeight = "knee height",
        /// Round the neck 2 cm below the Adam's apple and over the 7th cervical vertebra.
        NeckGirth: NeckBaseGirth = "neck girth",
        /// Bust or chest: horizontal, over the bust points, under the armpits.
        BustGirth: ChestGirth = "chest girth",
        /// Horizontal, just below the breasts.
        UnderbustGirth: UnderbustGirth = "underbust girth",
        /// At the natural waistline, midway between the lowest rib and the top of the hip bone.
        WaistGirth: WaistGirth = "waist girth",
        /// At the greatest protrusion of the buttocks.
        HipGirth: HipGirth = "hip girth",
        /// Horizontal, greatest girth of one thigh below the crotch.
        ThighGirth: ThighGirth = "thigh girth",
        /// Horizontal, greatest girth of one calf.
        CalfGirth: CalfGirth = "calf girth",
        /// Square to the relaxed upper arm at its greatest.
        UpperArmGirth: UpperArmGirth = "upper arm girth",
        /// Square to the forearm at the wrist bone.
        WristGirth: WristGirth = "wrist girth",
        /// Between the tips of the shoulder blades (biacromial).
        ShoulderBreadth: ShoulderBreadth = "shoulder breadth",
        /// From the acromion over the bent elbow to the wrist bone. The body's arm is straight: what bending adds to it is
        /// the mean of ANSUR II.
        ArmLength: ArmLength = "arm length",
        /// From the 7th cervical vertebra down the spine to the natural waistline.
        BackLength: BackLength = "back length",
    }
}

vocabulary! {
    /// Measures of ANSUR II (US Army Natick TR-15/007, 2014), at its own levels.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Ansur {
        /// `stature`: height of the top of the head.
        Stature: Stature = "stature",
        /// `cervicaleheight`: of the 7th cervical vertebra.
        CervicaleHeight: CervicaleHeight = "cervicale height",
        /// `waistheightomphalion`: of the navel.
        WaistHeightOmphalion: OmphalionHeight = "waist height (omphalion)",
        /// `crotchheight`: of the lowest point between the legs.
        CrotchHeight: CrotchHeight = "crotch height",
        /// `kneeheightmidpatella`: of the middle of the kneecap.
        KneeHeightMidpatella: KneeHeight = "knee height (midpatella)",
        /// `neckcircumference`: at the Adam's apple, square to the neck.
        NeckCircumference: NeckGirth = "neck circumference",
        /// `chestcircumference`: over the bust points.
        ChestCircumference: ChestGirth = "chest circumference",
        /// `waistcircumference`: at the navel.
        WaistCircumferenceOmphalion: OmphalionGirth = "waist circumference (omphalion)",
        /// `buttockcircumference`: at the greatest protrusion of the buttocks.
        ButtockCircumference: HipGirth = "buttock circumference",
        /// `thighcircumference`: where the thigh meets the buttock.
        ThighCircumference: ThighGirth = "thigh circumference",
        /// `calfcircumference`: where the calf is widest.
        CalfCircumference: CalfGirth = "calf circumference",
        /// `wristcircumference`: around the wrist.
        WristCircumference: WristGirth = "wrist circumference",
        /// `biacromialbreadth`: between the tips of the shoulder blades.
        BiacromialBreadth: ShoulderBreadth = "biacromial breadth",
        /// `chestbreadth`: of the trunk, side to side, at the bust points.
        ChestBreadth: ChestBreadth = "chest breadth",
        /// `chestdepth`: of the trunk, back to front, at the bust points.
        ChestDepth: ChestDepth = "chest depth",
        /// `waistbreadth`: at the navel.
        WaistBreadthOmphalion: OmphalionBreadth = "waist breadth (omphalion)",
        /// `waistdepth`: at the navel.
        WaistDepthOmphalion: OmphalionDepth = "waist depth (omphalion)",
        /// `hipbreadth`: of the hips, side to side.
        HipBreadth: HipBreadth = "hip breadth",
        /// `buttockdepth`: back to front, where the buttocks protrude most.
        ButtockDepth: HipDepth = "buttock depth",
        /// `sleevelengthspinewrist`: from the spine over the shoulder and the bent elbow to the wrist, the arm raised. The
        /// body's arm is straight: what the survey's pose adds to it is the survey's mean.
        SleeveLengthSpineWrist: SleeveLength = "sleeve length (spine to wrist)",
        /// `waistbacklength`: from the 7th cervical vertebra down the spine to the navel's level.
        WaistBackLengthOmphalion: WaistBackLength = "waist back length (omphalion)",
    }
}

/// A vocabulary of measures. Sealed: [`En`] and [`Ansur`].
pub trait Vocabulary: Copy + Read + 'static {
    /// Every measure that it has.
    const ALL: &'static [Self];
    /// Common name of the measure, without its unit.
    fn name(self) -> &'static str;
}

use sealed::Read;

mod sealed {
    /// Which reading of the mesh a measure is.
    pub trait Read {
        #[expect(private_interfaces, reason = "the trait is sealed: no code outside calls it")]
        fn reading(self) -> super::MeshMeasure;
    }
}

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

    /// Requested values (m), in the order of the requests.
    pub fn given(&self) -> &[(V, f32)] {
        &self.given
    }
}

/// Everything that the tape reads on one body (m).
#[derive(Debug, Clone, PartialEq)]
pub struct Readings(pub(super) [f32; READINGS]);

impl Readings {
    /// Value of one measure (m).
    pub fn of<V: Vocabulary>(&self, measure: V) -> f32 {
        self.0[measure.reading().index()]
    }
}
