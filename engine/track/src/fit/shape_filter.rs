//! The shape from all frames so far: an information filter whose prior is the population (ANSUR II).

use toile_assets::body::shape::{BodyShape, SHAPES, Shapes};

use super::normal_equations::{ShapeQuadratic, invert};

/// Number of independent frames that many frames count as. Most of a frame's error (a body that the model cannot
/// represent, a wrong lens calibration) is the same in the next frame; only the sensor's noise averages out.
const WORTH: f64 = 4.0;

/// Length of the filter's memory: three seconds of frames at 30 Hz.
const LONGEST: f64 = 90.0;

/// Accumulated information about the shape.
#[derive(Clone)]
pub struct ShapeFilter {
    shapes: &'static Shapes,
    hessian: [[f64; SHAPES]; SHAPES],
    rhs: BodyShape,
    frames: f64,
}

impl ShapeFilter {
    /// The prior alone.
    pub fn new(shapes: &'static Shapes) -> Self {
        Self { shapes, hessian: [[0.0; SHAPES]; SHAPES], rhs: [0.0; SHAPES], frames: 0.0 }
    }

    /// Adds a frame's information, a quadratic about a shape.
    pub fn add(&mut self, frame: &ShapeQuadratic, about: &BodyShape) {
        if self.frames >= LONGEST {
            let keep = (LONGEST - 1.0) / LONGEST;
            self.hessian.iter_mut().flatten().for_each(|c| *c *= keep);
            self.rhs.iter_mut().for_each(|v| *v *= keep);
            self.frames *= keep;
        }
        for i in 0..SHAPES {
            for j in 0..SHAPES {
                self.hessian[i][j] += frame.hessian[i][j];
                self.rhs[i] += frame.hessian[i][j] * about[j];
            }
            self.rhs[i] -= frame.gradient[i];
        }
        self.frames += 1.0;
    }

    /// Frames added so far.
    pub fn frames(&self) -> usize {
        self.frames.round() as usize
    }

    /// Prior and frames together, as a quadratic about a shape.
    pub fn about(&self, shape: &BodyShape) -> ShapeQuadratic {
        let (precision, mean) = (self.shapes.precision(), self.shapes.mean());
        let share = WORTH.min(self.frames) / self.frames.max(1.0);
        let mut known = ShapeQuadratic { hessian: [[0.0; SHAPES]; SHAPES], gradient: [0.0; SHAPES] };
        for i in 0..SHAPES {
            for j in 0..SHAPES {
                let (prior, seen) = (precision[i][j], share * self.hessian[i][j]);
                known.hessian[i][j] = prior + seen;
                known.gradient[i] += prior * (shape[j] - mean[j]) + seen * shape[j];
            }
            known.gradient[i] -= share * self.rhs[i];
        }
        known
    }

    /// The maximum a posteriori shape and the covariance of its parameters.
    pub fn estimate(&self) -> (BodyShape, [[f64; SHAPES]; SHAPES]) {
        let mean = self.shapes.mean();
        let known = self.about(mean);
        let (covariance, _) = invert(&known.hessian);
        let shape = std::array::from_fn(|i| {
            let step: f64 = (0..SHAPES).map(|j| covariance[i][j] * known.gradient[j]).sum();
            let [least, most] = self.shapes.bounds(i);
            (mean[i] - step).clamp(least, most)
        });
        (shape, covariance)
    }

    /// The shape's part of the deviance (twice the negative logarithm of the model evidence): Mahalanobis distance of
    /// the shape from the population, and the change of the log determinants.
    pub fn deviance(&self) -> f64 {
        let (shape, _) = self.estimate();
        let (precision, mean) = (self.shapes.precision(), self.shapes.mean());
        let off: BodyShape = std::array::from_fn(|i| shape[i] - mean[i]);
        let unlike: f64 =
            (0..SHAPES).map(|i| (0..SHAPES).map(|j| off[i] * precision[i][j] * off[j]).sum::<f64>()).sum();
        let (_, prior) = invert(precision);
        let (_, known) = invert(&self.about(mean).hessian);
        unlike + known - prior
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::body::Sex;

    #[test]
    fn nothing_seen_is_the_mean_person_and_frames_make_surer() {
        let shapes = Shapes::of(Sex::Female);
        let mut memory = ShapeFilter::new(shapes);
        let (shape, wide) = memory.estimate();
        assert!(shape.iter().zip(shapes.mean()).all(|(a, b)| (a - b).abs() < 1e-6));
        let mut about = *shapes.mean();
        about[3] += 0.02;
        let mut frame = ShapeQuadratic { hessian: [[0.0; SHAPES]; SHAPES], gradient: [0.0; SHAPES] };
        frame.hessian[3][3] = 1e6;
        for _ in 0..30 {
            memory.add(&frame, &about);
        }
        let (shape, narrow) = memory.estimate();
        assert!((shape[3] - about[3]).abs() < 1e-3, "{} {}", shape[3], about[3]);
        assert!(narrow[3][3] < 0.3 * wide[3][3]);
        assert!((0..SHAPES).all(|i| narrow[i][i] <= wide[i][i] * 1.000_001));
        assert_eq!(memory.frames(), 30);
    }
}
