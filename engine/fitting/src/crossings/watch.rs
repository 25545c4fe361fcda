//! Crossings over time: the number of moments with any, the most of one moment, and their duration.

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::search::CrossingTest;

/// Every so many steps is looked: 83 ms.
pub const LOOKED_STEPS: u64 = 10;

/// What was seen of crossings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct CrossingFigures {
    /// Moments that were looked at.
    pub frames: u64,
    /// Moments with any crossing.
    pub frames_with: u64,
    /// Most edges that passed through faces at one moment: of garments through each other and through themselves.
    pub max: u64,
    /// Of these between garments.
    pub max_between: u64,
    /// The longest time without a moment free of them (s).
    pub longest_s: f64,
    /// Moments with any crossing between garments.
    pub frames_between: u64,
    /// The longest time without a moment free of crossings between garments (s).
    pub longest_between_s: f64,
}

/// Looks at garments from time to time.
#[derive(Debug)]
pub struct CrossingWatch {
    test: CrossingTest,
    figures: CrossingFigures,
    /// Moments with crossings up to now without one free of them, and of these with crossings between garments.
    lasting: [u64; 2],
    step_seconds: f64,
}

impl CrossingWatch {
    /// Of garments with these triangles, in steps of so many seconds. At load.
    pub fn new(triangles: &[&[[u32; 3]]], step_seconds: f64) -> Self {
        Self { test: CrossingTest::new(triangles), figures: CrossingFigures::default(), lasting: [0; 2], step_seconds }
    }

    /// Whether the moment after a step is looked at.
    pub fn wants(step: u64) -> bool {
        step.is_multiple_of(LOOKED_STEPS)
    }

    /// Looks at a moment; gives its crossings, within garments and between them.
    ///
    /// # Panics
    /// Where there are not as many lists of positions as garments, or fewer positions than the triangles name.
    pub fn look(&mut self, positions: &[Vec<Vec3>]) -> [u64; 2] {
        let exact: Vec<Vec<DVec3>> = positions.iter().map(|g| g.iter().map(|p| p.as_dvec3()).collect()).collect();
        let all: Vec<&[DVec3]> = exact.iter().map(|g| &g[..]).collect();
        let within: usize = (0..all.len()).map(|g| self.test.within(g, all[g]).len()).sum();
        let between = self.test.between(&all).len() as u64;
        let count = within as u64 + between;
        self.figures.frames += 1;
        self.figures.frames_with += u64::from(count > 0);
        self.figures.max = self.figures.max.max(count);
        self.figures.max_between = self.figures.max_between.max(between);
        self.figures.frames_between += u64::from(between > 0);
        let longest = [&mut self.figures.longest_s, &mut self.figures.longest_between_s];
        for ((lasting, count), longest) in self.lasting.iter_mut().zip([count, between]).zip(longest) {
            *lasting = if count > 0 { *lasting + 1 } else { 0 };
            *longest = longest.max(*lasting as f64 * LOOKED_STEPS as f64 * self.step_seconds);
        }
        [within as u64, between]
    }

    /// What was seen so far.
    pub fn figures(&self) -> CrossingFigures {
        self.figures
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_counted_and_how_long_they_last() {
        let sheet = |y: f32| vec![Vec3::new(-1.0, y, -1.0), Vec3::new(1.0, y, -1.0), Vec3::new(0.1, y, 1.0)];
        let upright = vec![Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.02), Vec3::new(5.0, 0.0, 0.03)];
        let mut watch = CrossingWatch::new(&[&[[0, 1, 2]], &[[0, 1, 2]]], 1.0 / 120.0);
        for y in [0.5, 0.4, 2.0, 0.3, 2.0] {
            watch.look(&[sheet(y), upright.clone()]);
        }
        let found = watch.figures();
        let CrossingFigures { longest_s, longest_between_s, .. } = found;
        assert_eq!((found.frames, found.frames_with, found.frames_between), (5, 3, 3));
        assert_eq!((found.max, found.max_between), (2, 2));
        assert!((longest_s - 2.0 / 12.0).abs() < 1e-9 && longest_between_s == longest_s, "{found:?}");
    }

    #[test]
    fn crossings_within_a_garment_are_none_between_garments() {
        let folded = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.3, -0.5, 0.3], [0.3, 0.5, 0.3]];
        let folded: Vec<Vec3> = folded.into_iter().map(Vec3::from).collect();
        let mut watch = CrossingWatch::new(&[&[[0, 1, 2], [0, 3, 4]]], 1.0 / 120.0);
        watch.look(&[folded]);
        let found = watch.figures();
        assert_eq!((found.frames_with, found.frames_between, found.longest_between_s), (1, 0, 0.0));
    }
}
