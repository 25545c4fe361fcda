//! Anthropometry: proportions and regressions of ANSUR II, and girths from the camera's view of a torso.
//!
//! ANSUR II (US Army Natick TR-15/007, 2014; public domain) holds 93 measures of 1,986 women and 4,082 men. "Mixed" is
//! as many women as men. All regressions are ordinary least squares in metres, with the standard deviation of the
//! residual as the model's sigma.

use toile_assets::sizes::Population;

use crate::estimate::Estimate;

/// Heights as fractions of stature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelFractions {
    /// Greatest protrusion of the buttocks.
    pub hip: f32,
    /// Natural waistline, midway between the lowest rib and the hip bone.
    pub waist: f32,
    /// Most forward points of the breasts.
    pub chest: f32,
    /// Acromion (tip of the shoulder blade).
    pub acromion: f32,
}

/// Where the levels lie, for every person: a camera does not know whom it sees, and two people of one sex differ more
/// (+- .011 to .016) than the means of the sexes. ANSUR II has the chest (chestheight) at .719 of women's and .735 of
/// men's stature; the natural waistline of EN 13402-1, midway between tenthribheight and iliocristaleheight, at .630
/// and .621; the hip (buttockheight) at .512 and .505; the acromion (acromialheight) at .820 of both.
pub const LEVELS: LevelFractions = LevelFractions { hip: 0.513, waist: 0.628, chest: 0.722, acromion: 0.820 };

/// Stature where nothing was measured: mean and standard deviation of ANSUR II.
pub const fn stature(population: Population) -> Estimate {
    match population {
        Population::Women => Estimate::new(1.628, 0.064),
        Population::Men => Estimate::new(1.756, 0.069),
        Population::Mixed => Estimate::new(1.692, 0.092),
    }
}

/// A length as an affine function of two others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regression {
    /// Value where both are 0 (m).
    pub offset: f32,
    /// Change with the first length.
    pub first: f32,
    /// Change with the second length.
    pub second: f32,
    /// Standard deviation of what it leaves unexplained (m).
    pub residual: f32,
}

impl Regression {
    const fn new(offset: f32, first: f32, second: f32, residual: f32) -> Self {
        Self { offset, first, second, residual }
    }

    /// The length, with the errors of both inputs carried through as independent.
    pub fn at(&self, first: Estimate, second: Estimate) -> Estimate {
        Estimate {
            value: self.offset + self.first * first.value + self.second * second.value,
            sigma: self.residual.hypot(self.first * first.sigma).hypot(self.second * second.sigma),
        }
    }
}

/// Regressions of measures on stature and shoulder breadth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasureRegressions {
    /// Shoulder breadth (biacromialbreadth) from stature alone.
    pub shoulder: Regression,
    /// Chest girth (chestcircumference) from stature and shoulder breadth.
    pub chest: Regression,
    /// Waist girth from stature and shoulder breadth: waistcircumference, less what lies between the navel, where
    /// ANSUR II measures, and the natural waist (74 mm for women, 2 mm for men, so that the mean is what EN 13402-3
    /// pairs with the mean chest; 20 mm of uncertainty for that).
    pub waist: Regression,
    /// Hip girth (buttockcircumference) from stature and shoulder breadth.
    pub hip: Regression,
    /// Inseam (crotchheight) from stature.
    pub inseam: Regression,
    /// Arm (sleeveoutseam) from stature.
    pub arm: Regression,
}

/// The regressions for a population.
pub const fn regressions(population: Population) -> MeasureRegressions {
    match population {
        Population::Women => MeasureRegressions {
            shoulder: Regression::new(0.1028, 0.1612, 0.0, 0.0151),
            chest: Regression::new(0.3052, 0.1820, 0.9452, 0.0786),
            waist: Regression::new(0.1051, 0.1985, 0.9814, 0.0982),
            hip: Regression::new(0.2194, 0.3341, 0.7057, 0.0695),
            inseam: Regression::new(-0.1791, 0.5904, 0.0, 0.0236),
            arm: Regression::new(-0.0495, 0.3642, 0.0, 0.0179),
        },
        Population::Men => MeasureRegressions {
            shoulder: Regression::new(0.1546, 0.1486, 0.0, 0.0162),
            chest: Regression::new(0.1244, -0.0498, 2.4581, 0.0748),
            waist: Regression::new(-0.0019, 0.0066, 2.2349, 0.1050),
            hip: Regression::new(0.0856, 0.1235, 1.7248, 0.0665),
            inseam: Regression::new(-0.1763, 0.5821, 0.0, 0.0239),
            arm: Regression::new(-0.0411, 0.3611, 0.0, 0.0184),
        },
        Population::Mixed => MeasureRegressions {
            shoulder: Regression::new(-0.0659, 0.2696, 0.0, 0.0193),
            chest: Regression::new(0.1315, 0.0569, 1.9853, 0.0776),
            waist: Regression::new(0.1546, 0.0565, 1.5697, 0.1023),
            hip: Regression::new(0.6941, 0.1192, 0.3184, 0.0739),
            inseam: Regression::new(-0.1029, 0.5417, 0.0, 0.0241),
            arm: Regression::new(-0.0615, 0.3720, 0.0, 0.0183),
        },
    }
}

/// Girth of a torso from the camera's view of it: an affine function of the section's breadth, of the tape's
/// length over its front, and of the depth of the half ellipse that fits it (which says how square it is).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GirthModel {
    /// Girth where the others are 0 (m).
    pub offset: f32,
    /// Girth a metre of breadth (1).
    pub breadth: f32,
    /// Girth a metre of tape over the front (1).
    pub arc: f32,
    /// Girth a metre of the fitted half ellipse's depth (1).
    pub front: f32,
    /// Standard deviation over bodies of other shapes (m).
    pub residual: f32,
    /// The fronts that the model was made from (m): 19 of 20 mannequins.
    pub fronts: [f32; 2],
}

/// Fronts of 19 of 20 mannequins at chest, waist and hip (m).
const CHEST_FRONTS: [f32; 2] = [-0.044, 0.107];
const WAIST_FRONTS: [f32; 2] = [0.052, 0.125];
const HIP_FRONTS: [f32; 2] = [0.024, 0.116];

impl GirthModel {
    const fn new([offset, breadth, arc, front]: [f32; 4], residual: f32, fronts: [f32; 2]) -> Self {
        Self { offset, breadth, arc, front, residual, fronts }
    }

    /// The girth of a torso from the parameters of its section. The sensor's errors of breadth and arc go together, so
    /// their weights add up. A front beyond all mannequins' is hair, cloth or a hand: the nearest that a mannequin has
    /// stands for it, and what that changes is added to the error.
    pub fn at(&self, breadth: Estimate, arc: Estimate, front: Estimate) -> Estimate {
        let scatter = (self.breadth * breadth.sigma).abs() + (self.arc * arc.sigma).abs();
        let usual = front.value.clamp(self.fronts[0], self.fronts[1]);
        let strange = self.front * (front.value - usual);
        Estimate {
            value: self.offset + self.breadth * breadth.value + self.arc * arc.value + self.front * usual,
            sigma: self.residual.hypot(scatter).hypot(self.front * front.sigma).hypot(strange),
        }
    }
}

/// Models of all measures that are read from the silhouette.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SilhouetteModel {
    /// Error of the top of the head (m).
    pub stature: f32,
    /// Shoulder breadth from the outline's breadth.
    pub shoulder: Regression,
    /// Chest girth from its section.
    pub chest: GirthModel,
    /// Waist girth from its section.
    pub waist: GirthModel,
    /// Hip girth from its section.
    pub hip: GirthModel,
}

/// Half a pixel across of a camera with 575 pixels a radian, as a fraction of the distance: what the sensor's scale and
/// edges are off by however long one averages.
const HALF_PIXEL: f32 = 0.5 / 575.0;

/// That error for a person at a distance (m).
pub fn sensor_bias(distance: f32) -> f32 {
    HALF_PIXEL * distance
}

impl SilhouetteModel {
    /// The models of a population.
    pub const fn of(population: Population) -> Self {
        match population {
            Population::Women => WOMEN,
            Population::Men => MEN,
            Population::Mixed => MIXED,
        }
    }
}

// Least squares over 99 women and 100 men of `toile_perf::agreement` (seed 1,000,000, 10 frames each, 2.5 m off):
// `cargo run --release -p toile-perf --example calibrate -- 100 10 1000000` prints them again. Residuals are those
// printed, but for two that mannequins, being all alike there, make too small. Stature: 1 mm; a camera's tilt known to
// .1 degree makes it 4 mm and more. Shoulders: 8 to 9.6 mm; how much deltoid people wear over their acromions makes it
// 10 mm (ANSUR II leaves 14 mm between the breadth over the deltoids and that between the acromions).

const WOMEN: SilhouetteModel = SilhouetteModel {
    stature: 0.005,
    shoulder: Regression::new(0.1367, 0.5435, 0.0, 0.010),
    chest: GirthModel::new([0.0008, 2.2574, 0.5986, -2.4354], 0.0319, CHEST_FRONTS),
    waist: GirthModel::new([-0.0685, 0.3506, 2.4313, -0.8463], 0.0338, WAIST_FRONTS),
    hip: GirthModel::new([0.0126, 0.7452, 1.9164, -1.5445], 0.0298, HIP_FRONTS),
};

const MEN: SilhouetteModel = SilhouetteModel {
    stature: 0.005,
    shoulder: Regression::new(0.1543, 0.5352, 0.0, 0.010),
    chest: GirthModel::new([0.0299, 1.7057, 1.1023, -0.8837], 0.0387, CHEST_FRONTS),
    waist: GirthModel::new([-0.1066, 1.8127, 1.3966, -1.0344], 0.0370, WAIST_FRONTS),
    hip: GirthModel::new([0.0143, 1.0509, 1.6756, -0.9813], 0.0311, HIP_FRONTS),
};

const MIXED: SilhouetteModel = SilhouetteModel {
    stature: 0.005,
    shoulder: Regression::new(0.0914, 0.6581, 0.0, 0.010),
    chest: GirthModel::new([-0.0398, 2.7578, 0.4192, -0.8050], 0.0395, CHEST_FRONTS),
    waist: GirthModel::new([-0.0839, 1.2165, 1.8145, -0.9994], 0.0357, WAIST_FRONTS),
    hip: GirthModel::new([0.0994, 0.9247, 1.4834, -0.6243], 0.0351, HIP_FRONTS),
};
