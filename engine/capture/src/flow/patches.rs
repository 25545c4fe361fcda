//! Look of each triangle: samples spread over it, with the values that each camera saw there.
//!
//! A pixel of the current frame and its place in the next are joined by the triangle's homography `W = P V S^-1` (equation 5.7).
//! The same map is written here by the point of the triangle under the pixel: its shares b of the three corners do not change as
//! the mesh moves, and `W s` is the projection of `sum b_i V_i`. So a triangle has samples at fixed shares, about a pixel apart,
//! and a value seen there once can be compared with any later frame and with any other camera.

use glam::Vec3;

/// Least and most samples along a side of a triangle.
const ALONG: [usize; 2] = [2, 40];

/// The samples of one level.
#[derive(Debug, Clone)]
pub(super) struct LevelSamples {
    /// First sample of each triangle, and the end `[triangles + 1]`.
    pub starts: Vec<usize>,
    /// Shares of the corners `[samples]`.
    pub shares: Vec<Vec3>,
    /// What each camera saw `[cameras][samples x channels]`.
    pub seen: Vec<Vec<f32>>,
    /// Which samples a camera saw (1) or not (0) `[cameras][samples]`.
    pub known: Vec<Vec<f32>>,
}

impl LevelSamples {
    /// Samples for triangles whose longest side is so many pixels of the level, at a distance (px).
    pub fn new(sides: &[f64], spacing: f64, cameras: usize, channels: usize) -> Self {
        let mut starts = vec![0];
        let mut shares = Vec::new();
        for side in sides {
            let n = ((side / spacing).ceil() as usize).clamp(ALONG[0], ALONG[1]);
            spread(n, &mut shares);
            starts.push(shares.len());
        }
        let count = shares.len();
        Self {
            starts,
            shares,
            seen: vec![vec![0.0; count * channels]; cameras],
            known: vec![vec![0.0; count]; cameras],
        }
    }
}

/// The middles of the n x n equal triangles that a triangle is divided into.
fn spread(n: usize, shares: &mut Vec<Vec3>) {
    let step = 1.0 / n as f32;
    for i in 0..n {
        for j in 0..n - i {
            let (b, c) = (i as f32 * step, j as f32 * step);
            let mut push = |by: f32| {
                let (b, c) = (b + by * step, c + by * step);
                shares.push(Vec3::new(1.0 - b - c, b, c));
            };
            push(1.0 / 3.0);
            if j + 1 < n - i {
                push(2.0 / 3.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_spread_evenly_and_lie_inside() {
        for n in [2, 5, 9] {
            let mut shares = Vec::new();
            spread(n, &mut shares);
            assert_eq!(shares.len(), n * n);
            let mean = shares.iter().sum::<Vec3>() / shares.len() as f32;
            assert!(mean.distance(Vec3::splat(1.0 / 3.0)) < 1e-5);
            assert!(shares.iter().all(|s| s.min_element() > 0.0 && (s.element_sum() - 1.0).abs() < 1e-5));
        }
    }
}
