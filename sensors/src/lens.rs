//! A lens that bends straight lines (Brown 1971, with the rational radial part of Claus and Fitzgibbon 2005).
//!
//! With x, y the normalised image coordinates less the centre of distortion and r2 = x x + y y:
//!
//! ```text
//! d  = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)
//! x' = x d + 2 p1 x y + p2 (r2 + 2 x x)
//! y' = y d + 2 p2 x y + p1 (r2 + 2 y y)
//! ```

/// Largest radius of the normalised image that is looked at: a view of 143 degrees.
const WIDEST: f32 = 3.0;

/// Steps in which the radius is followed.
const STEPS: usize = 600;

/// Brown and Conrady's distortion in normalised image coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrownConrady {
    /// Radial: k1 .. k3 above, k4 .. k6 below the fraction.
    pub k: [f32; 6],
    /// Tangential: p1, p2.
    pub p: [f32; 2],
    /// Centre of distortion.
    pub centre: [f32; 2],
    /// Radius beyond which the model was never fitted; infinite where that is not known.
    pub widest: f32,
}

impl BrownConrady {
    fn scale(&self, r2: f32) -> f32 {
        let [k1, k2, k3, k4, k5, k6] = self.k;
        let poly = |a: f32, b: f32, c: f32| 1.0 + r2 * (a + r2 * (b + r2 * c));
        poly(k1, k2, k3) / poly(k4, k5, k6)
    }

    /// Distorted image of a straight ray.
    pub fn bend(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let (x, y) = (x - self.centre[0], y - self.centre[1]);
        let [p1, p2] = self.p;
        let r2 = x * x + y * y;
        let d = self.scale(r2);
        let bent =
            [x * d + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), y * d + 2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y)];
        [bent[0] + self.centre[0], bent[1] + self.centre[1]]
    }

    /// Radius up to which a longer ray still lands farther out: beyond it the model folds the image over.
    pub fn sound_radius(&self) -> f32 {
        let mut last = 0.0;
        let limit = self.widest.min(WIDEST);
        for i in 1..=STEPS {
            let r = limit * i as f32 / STEPS as f32;
            let bent = r * self.scale(r * r);
            // Not a number counts as folded too.
            if !matches!(bent.partial_cmp(&last), Some(std::cmp::Ordering::Greater)) {
                return limit * (i - 1) as f32 / STEPS as f32;
            }
            last = bent;
        }
        limit
    }
}
