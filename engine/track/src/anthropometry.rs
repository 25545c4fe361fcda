//! What bodies are like: proportions and regressions of ANSUR II, and what the camera's view of a torso says of it.
//!
//! ANSUR II (US Army Natick TR-15/007, 2014; public domain) holds 93 measures of 1,986 women and 4,082 men. "Mixed" is
//! as many women as men. All regressions are ordinary least squares in metres, with the standard deviation of the
//! residual as the model's sigma.

use toile_assets::sizes::Population;

use crate::estimate::Estimate;

/// Heights as fractions of stature.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "named by the measure")]
pub struct Levels {
    pub hip: f32,
    pub waist: f32,
    pub chest: f32,
    pub acromion: f32,
}

/// Where the levels lie, for everybody: a camera does not know whom it sees, and two people of one sex differ more
/// (+- .011 to .016) than the means of the sexes. ANSUR II has the chest (chestheight) at .719 of women's and .735 of
/// men's stature; the natural waistline of EN 13402-1, midway between tenthribheight and iliocristaleheight, at .630
/// and .621; the hip (buttockheight) at .512 and .505; the acromion (acromialheight) at .820 of both.
pub const LEVELS: Levels = Levels { hip: 0.513, waist: 0.628, chest: 0.722, acromion: 0.820 };

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

/// Girths and breadth as a shopper's stature and shoulders let one guess them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guesses {
    /// Shoulder breadth (biacromialbreadth) from stature alone.
    pub shoulder: Regression,
    /// Chest girth (chestcircumference) from stature and shoulder breadth.
    pub chest: Regression,
    /// Waist girth (waistcircumference) from stature and shoulder breadth.
    pub waist: Regression,
    /// Hip girth (buttockcircumference) from stature and shoulder breadth.
    pub hip: Regression,
    /// Inseam (crotchheight) from stature.
    pub inseam: Regression,
    /// Arm (sleeveoutseam) from stature.
    pub arm: Regression,
}

/// The guesses for a population.
pub const fn guesses(population: Population) -> Guesses {
    match population {
        Population::Women => Guesses {
            shoulder: Regression::new(0.1028, 0.1612, 0.0, 0.0151),
            chest: Regression::new(0.3052, 0.1820, 0.9452, 0.0786),
            waist: Regression::new(0.1791, 0.1985, 0.9814, 0.0962),
            hip: Regression::new(0.2194, 0.3341, 0.7057, 0.0695),
            inseam: Regression::new(-0.1791, 0.5904, 0.0, 0.0236),
            arm: Regression::new(-0.0495, 0.3642, 0.0, 0.0179),
        },
        Population::Men => Guesses {
            shoulder: Regression::new(0.1546, 0.1486, 0.0, 0.0162),
            chest: Regression::new(0.1244, -0.0498, 2.4581, 0.0748),
            waist: Regression::new(0.0000, 0.0066, 2.2349, 0.1031),
            hip: Regression::new(0.0856, 0.1235, 1.7248, 0.0665),
            inseam: Regression::new(-0.1763, 0.5821, 0.0, 0.0239),
            arm: Regression::new(-0.0411, 0.3611, 0.0, 0.0184),
        },
        Population::Mixed => Guesses {
            shoulder: Regression::new(-0.0659, 0.2696, 0.0, 0.0193),
            chest: Regression::new(0.1315, 0.0569, 1.9853, 0.0776),
            waist: Regression::new(0.1926, 0.0565, 1.5697, 0.1003),
            hip: Regression::new(0.6941, 0.1192, 0.3184, 0.0739),
            inseam: Regression::new(-0.1029, 0.5417, 0.0, 0.0241),
            arm: Regression::new(-0.0615, 0.3720, 0.0, 0.0183),
        },
    }
}

/// What the camera's view of a torso says of its girth: girth = offset + breadth * B + front * F + with
/// the residual that bodies of other shapes leave.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the formula names them")]
pub struct Girth {
    pub offset: f32,
    pub breadth: f32,
    pub front: f32,
    pub residual: f32,
}

impl Girth {
    /// The girth of a torso whose outline is `breadth` broad and whose front half is `front` deep.
    pub fn at(&self, breadth: Estimate, front: Estimate) -> Estimate {
        Regression::new(self.offset, self.breadth, self.front, self.residual).at(breadth, front)
    }
}

/// How a frame's readings become measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart {
    /// Added to the height of the top of the head (m), and its residual.
    pub stature: Estimate,
    /// Shoulder breadth from the outline's breadth.
    pub shoulder: Regression,
    /// Chest girth from its section.
    pub chest: Girth,
    /// Waist girth from its section.
    pub waist: Girth,
    /// Hip girth from its section.
    pub hip: Girth,
}

impl Chart {
    /// The chart of a population.
    pub const fn of(population: Population) -> Self {
        let _ = population;
        Self {
            stature: Estimate::new(0.0, 0.005),
            shoulder: Regression::new(0.0, 1.0, 0.0, 0.02),
            chest: Girth { offset: 0.0, breadth: 2.0, front: 3.0, residual: 0.04 },
            waist: Girth { offset: 0.0233, breadth: 1.71, front: 3.03, residual: 0.03 },
            hip: Girth { offset: 0.0638, breadth: 1.884, front: 2.4854, residual: 0.03 },
        }
    }
}

/// Error of the sensor's own scale and edges that averaging does not remove (m): half a pixel of a camera with 575
/// pixels a radian, at the distance of the person.
pub fn sensor_bias(distance: f32) -> f32 {
    0.5 * distance / 575.0
}
