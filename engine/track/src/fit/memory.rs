//! What all frames so far say of the shape: an information filter with people as the prior.

use toile_assets::body::shape::{SHAPES, Shape, Shapes};

use super::equations::{ShapeCurve, invert};

/// Frames that many frames are worth. Most of what a frame is off by (a body that is not of the family, a lens that is
/// not as told) is the same in the next, so that only the sensor's noise averages out.
const WORTH: f64 = 4.0;

/// Frames that are remembered: three seconds.
const LONGEST: f64 = 90.0;

/// The frames' information about the shape.
pub(super) struct Memory {
    shapes: &'static Shapes,
    curve: [[f64; SHAPES]; SHAPES],
    vector: Shape,
    frames: f64,
}

impl Memory {
    pub(super) fn new(shapes: &'static Shapes) -> Self {
        Self { shapes, curve: [[0.0; SHAPES]; SHAPES], vector: [0.0; SHAPES], frames: 0.0 }
    }

    /// Takes in what a frame says, as a quadratic about a shape.
    pub(super) fn add(&mut self, frame: &ShapeCurve, about: &Shape) {
        if self.frames >= LONGEST {
            let keep = (LONGEST - 1.0) / LONGEST;
            self.curve.iter_mut().flatten().for_each(|c| *c *= keep);
            self.vector.iter_mut().for_each(|v| *v *= keep);
            self.frames *= keep;
        }
        for i in 0..SHAPES {
            for j in 0..SHAPES {
                self.curve[i][j] += frame.curve[i][j];
                self.vector[i] += frame.curve[i][j] * about[j];
            }
            self.vector[i] -= frame.slope[i];
        }
        self.frames += 1.0;
    }

    /// Frames taken in.
    pub(super) fn frames(&self) -> usize {
        self.frames.round() as usize
    }

    /// All that is known, as a quadratic about a shape.
    pub(super) fn about(&self, shape: &Shape) -> ShapeCurve {
        let (precision, mean) = (self.shapes.precision(), self.shapes.mean());
        let share = WORTH.min(self.frames) / self.frames.max(1.0);
        let mut known = ShapeCurve { curve: [[0.0; SHAPES]; SHAPES], slope: [0.0; SHAPES] };
        for i in 0..SHAPES {
            for j in 0..SHAPES {
                let (prior, seen) = (precision[i][j], share * self.curve[i][j]);
                known.curve[i][j] = prior + seen;
                known.slope[i] += prior * (shape[j] - mean[j]) + seen * shape[j];
            }
            known.slope[i] -= share * self.vector[i];
        }
        known
    }

    /// The likeliest shape and the covariance of its parameters.
    pub(super) fn estimate(&self) -> (Shape, [[f64; SHAPES]; SHAPES]) {
        let mean = self.shapes.mean();
        let known = self.about(mean);
        let (covariance, _) = invert(&known.curve);
        let shape = std::array::from_fn(|i| {
            let step: f64 = (0..SHAPES).map(|j| covariance[i][j] * known.slope[j]).sum();
            let [least, most] = self.shapes.bounds(i);
            (mean[i] - step).clamp(least, most)
        });
        (shape, covariance)
    }

    /// How unlike people the likeliest shape is, and how much of what could have been was ruled out: twice the negative
    /// logarithm of the evidence that the shape takes.
    pub(super) fn surprise(&self) -> f64 {
        let (shape, _) = self.estimate();
        let (precision, mean) = (self.shapes.precision(), self.shapes.mean());
        let off: Shape = std::array::from_fn(|i| shape[i] - mean[i]);
        let unlike: f64 =
            (0..SHAPES).map(|i| (0..SHAPES).map(|j| off[i] * precision[i][j] * off[j]).sum::<f64>()).sum();
        let (_, prior) = invert(precision);
        let (_, known) = invert(&self.about(mean).curve);
        unlike + known - prior
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::body::Sex;

    #[test]
    fn nothing_seen_is_the_mean_person_and_frames_make_surer() {
        let shapes = Shapes::of(Sex::Female);
        let mut memory = Memory::new(shapes);
        let (shape, wide) = memory.estimate();
        assert!(shape.iter().zip(shapes.mean()).all(|(a, b)| (a - b).abs() < 1e-6));
        let mut about = *shapes.mean();
        about[3] += 0.02;
        let mut frame = ShapeCurve { curve: [[0.0; SHAPES]; SHAPES], slope: [0.0; SHAPES] };
        frame.curve[3][3] = 1e6;
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
