//! Standard deviation of a depth sensor's readings.

/// Standard deviation of a reading at depth z (m) of a surface that faces the camera: `least + growth (z - from)^2` (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// The deviation at the distance where it is least (m).
    pub least: f32,
    /// Its growth with the square of the distance beyond (1/m).
    pub growth: f32,
    /// That distance (m).
    pub from: f32,
}

impl SensorNoise {
    /// The Kinect v1 (Nguyen, Izadi and Lovell 2012).
    pub const KINECT_V1: Self = Self { least: 0.0012, growth: 0.0019, from: 0.4 };

    /// The deviation at a depth, both in mm.
    pub fn sigma_mm(&self, z_mm: f32) -> f32 {
        let beyond = z_mm - self.from * 1e3;
        self.least * 1e3 + self.growth * 1e-3 * (beyond * beyond)
    }
}
