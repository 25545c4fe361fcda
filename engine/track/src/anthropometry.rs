//! Anthropometry: regressions of measures on stature and shoulder breadth, from ANSUR II.
//!
//! ANSUR II (US Army Natick TR-15/007, 2014; public domain) holds 93 measures of 1,986 women and 4,082 men. "Mixed" is
//! as many women as men. All regressions are ordinary least squares in metres, with the standard deviation of the
//! residual as the model's sigma.

use toile_assets::sizes::Population;

use crate::estimate::Estimate;

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
