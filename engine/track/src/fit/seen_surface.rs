//! The surface that was seen: its distance outside the fitted body, vertex by vertex.
//!
//! A parametric body has some twenty numbers, and no two people are the same in all others. What the camera saw beside the
//! fitted surface, over all views, is a field of displacements along the body's normals: smooth, near what was seen,
//! and fading to nothing where nothing was seen. The tape then lies on that surface.

use super::posed_body::BodyModel;
use super::residuals::Observation;

/// Farther than this from the body lies something that is not its skin (m).
const FARTHEST: f32 = 0.06;

/// Cells of one sample over all views with which it counts half of what it can.
const HALF_KNOWN: f32 = 3.0;

/// What a difference between two neighbouring vertices costs over a difference from what was seen: noise is smoothed over about
/// the root of this many edges.
const SMOOTH: f64 = 4.0;

/// What a displacement costs by itself: where nothing was seen it fades over about the root of [`SMOOTH`] over this many edges.
const FADE: f64 = 0.01;

/// Residual of the solution over that of the right-hand side at which it is good enough, and most rounds.
const EXACT: f64 = 1e-4;
const ROUNDS: usize = 200;

/// What was seen of a surface so far, sample by sample.
pub struct SeenSurface {
    /// Cells that showed each sample `[samples]`.
    cells: Vec<f32>,
    /// Sum of how far they lay outside of it (m) `[samples]`.
    sum: Vec<f32>,
    /// What a sample counts that is well known.
    most: f64,
}

/// What is known of one sample.
struct KnownSample {
    corners: [usize; 4],
    /// How much it counts.
    share: f64,
    /// Its displacement (m).
    out: f64,
}

impl SeenSurface {
    /// Nothing seen of so many samples.
    pub fn new(samples: usize) -> Self {
        Self::counting(samples, 1.0)
    }

    /// Nothing seen of so many samples, of which one that is well known counts `most` times, not once: where
    /// what is seen are lines, each stands for the surface as far as the next one.
    pub fn counting(samples: usize, most: f64) -> Self {
        Self { cells: vec![0.0; samples], sum: vec![0.0; samples], most }
    }

    /// Adds what one view shows.
    pub(super) fn add(&mut self, Observation { posed, matches, .. }: Observation) {
        for (i, found) in matches.of.iter().enumerate().filter(|(_, m)| m.count > 0.0) {
            let out = -found.outside(posed.points[i], posed.normals[i]);
            self.add_rim(i, out, found.count);
        }
    }

    /// Adds how far the surface at one sample lies outside the body (m), as so many cells.
    pub fn add_rim(&mut self, sample: usize, out: f32, cells: f32) {
        if out.abs() < FARTHEST {
            self.cells[sample] += cells;
            self.sum[sample] += cells * out;
        }
    }

    /// The displacement of each vertex along its normal (m), where the samples were displaced by `about` when they were seen:
    /// least squares of all that was seen, of the differences along the edges and of the displacements themselves.
    pub fn displacements(&self, model: &BodyModel, about: &[f32]) -> Vec<f32> {
        let known: Vec<KnownSample> = (model.samples.iter().zip(&self.cells).zip(&self.sum))
            .filter(|((_, cells), _)| **cells > 0.0)
            .map(|((sample, cells), sum)| {
                let corners = sample.corners.map(|c| c as usize);
                let before = corners.iter().map(|c| about[*c]).sum::<f32>() / 4.0;
                let share = self.most * f64::from(cells / (cells + HALF_KNOWN));
                KnownSample { corners, share, out: f64::from(before + sum / cells) }
            })
            .collect();
        let edges: Vec<[usize; 2]> = (model.samples.iter())
            .flat_map(|s| [0, 1, 2, 3].map(|k| [s.corners[k] as usize, s.corners[(k + 1) % 4] as usize]))
            .filter(|e| e[0] != e[1])
            .collect();
        let apply = |x: &[f64], y: &mut Vec<f64>| {
            y.clear();
            y.extend(x.iter().map(|v| FADE * v));
            for KnownSample { corners, share, .. } in &known {
                let mean = corners.iter().map(|c| x[*c]).sum::<f64>() * 0.25;
                corners.iter().for_each(|c| y[*c] += share * mean * 0.25);
            }
            // An edge between two faces is met from both.
            for &[a, b] in &edges {
                let by = 0.5 * SMOOTH * (x[a] - x[b]);
                y[a] += by;
                y[b] -= by;
            }
        };
        let mut right = vec![0.0; about.len()];
        for KnownSample { corners, share, out } in &known {
            corners.iter().for_each(|c| right[*c] += share * out * 0.25);
        }
        conjugate_gradients(apply, right).into_iter().map(|x| x as f32).collect()
    }
}

/// Solves `A x = b` for a symmetric positive operator, from 0 (Hestenes and Stiefel 1952).
fn conjugate_gradients(apply: impl Fn(&[f64], &mut Vec<f64>), b: Vec<f64>) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut x, mut rest) = (vec![0.0; b.len()], b);
    let mut along = rest.clone();
    let mut image = Vec::new();
    let mut squares = dot(&rest, &rest);
    let enough = squares * EXACT * EXACT;
    for _ in 0..ROUNDS {
        if squares <= enough {
            break;
        }
        apply(&along, &mut image);
        let by = squares / dot(&along, &image).max(f64::MIN_POSITIVE);
        x.iter_mut().zip(&along).for_each(|(x, a)| *x += by * a);
        rest.iter_mut().zip(&image).for_each(|(r, i)| *r -= by * i);
        let next = dot(&rest, &rest);
        let keep = next / squares;
        along.iter_mut().zip(&rest).for_each(|(a, r)| *a = r + keep * *a);
        squares = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::body::shape::Shapes;
    use toile_base::body::Sex;

    #[test]
    fn a_surface_that_was_seen_all_over_is_found_and_one_that_was_not_stays() {
        let shapes = Shapes::of(Sex::Female);
        let model = BodyModel::new(shapes, 0.0);
        let vertices = shapes.base().positions.len();
        let mut seen = SeenSurface::new(model.samples.len());
        let nothing = seen.displacements(&model, &vec![0.0; vertices]);
        assert!(nothing.iter().all(|d| *d == 0.0));
        // Everything 5 mm out, but for the head, which was not seen.
        let neck = shapes.body(shapes.mean()).body.levels.neck;
        let place = |v: u32| shapes.base().positions[v as usize];
        for (i, sample) in model.samples.iter().enumerate() {
            if place(sample.corners[0]).y < neck {
                seen.add_rim(i, 0.005, 30.0);
                // What lies a hand's breadth off is not skin.
                seen.add_rim(i, 0.10, 30.0);
            }
        }
        let found = seen.displacements(&model, &vec![0.0; vertices]);
        let below = |v: usize| place(v as u32).y < neck - 0.10;
        let body: Vec<f32> = (0..vertices).filter(|v| below(*v)).map(|v| found[v]).collect();
        let mean = body.iter().sum::<f32>() / body.len() as f32;
        assert!((mean - 0.005).abs() < 3e-4, "{mean}");
        let crown = (0..vertices).max_by(|a, b| place(*a as u32).y.total_cmp(&place(*b as u32).y)).unwrap();
        assert!((0.0..0.003).contains(&found[crown]), "{}", found[crown]);
        // Seen from there, nothing is left to add.
        let mut again = SeenSurface::new(model.samples.len());
        (0..model.samples.len()).for_each(|i| again.add_rim(i, 0.0, 1e6));
        let kept = again.displacements(&model, &vec![0.005; vertices]);
        let mean = kept.iter().sum::<f32>() / vertices as f32;
        assert!((mean - 0.005).abs() < 3e-4, "{mean}");
    }
}
