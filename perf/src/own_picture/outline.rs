//! Outlines and how far they are from each other.

/// Size of the mirror in which outlines are compared: 1080 rows.
pub const SIZE: [u32; 2] = [1440, 1080];

/// Distances that are farther count as this (px).
const FARTHEST: f32 = 200.0;

/// A region and its border.
pub struct Outline {
    mask: Vec<bool>,
    /// Pixels of the region beside one that is not.
    border: Vec<u32>,
    /// Distance of each pixel from the border (px), made when it is first asked for.
    far: std::cell::OnceCell<Vec<f32>>,
}

impl Outline {
    /// Of a mask of [`SIZE`].
    pub fn of(mask: &[bool]) -> Self {
        let width = SIZE[0] as usize;
        let is = |at: usize| mask.get(at).copied().unwrap_or(false);
        let border = (0..mask.len()).filter(|at| {
            let x = at % width;
            mask[*at]
                && !((x == 0 || is(at - 1))
                    && (x + 1 == width || is(at + 1))
                    && is(at.wrapping_sub(width))
                    && is(at + width))
        });
        Self { border: border.map(|at| at as u32).collect(), mask: mask.to_vec(), far: std::cell::OnceCell::new() }
    }

    /// The region.
    pub fn mask(&self) -> &[bool] {
        &self.mask
    }

    fn far(&self) -> &[f32] {
        self.far.get_or_init(|| distances(&self.border))
    }

    /// Adds the distance of every fifth border pixel from the other's border, and of the other's from this one's (px).
    pub fn errors(&self, truth: &Self, out: &mut Vec<f32>) {
        out.extend(self.border.iter().step_by(5).map(|at| truth.far()[*at as usize]));
        out.extend(truth.border.iter().step_by(5).map(|at| self.far()[*at as usize]));
    }

    /// Pixels that are too much, too little, and those of the truth.
    pub fn area(&self, truth: &Self) -> [f64; 3] {
        let count = |holds: fn(bool, bool) -> bool| {
            self.mask.iter().zip(&truth.mask).filter(|(a, b)| holds(**a, **b)).count() as f64
        };
        [count(|own, real| own && !real), count(|own, real| !own && real), count(|_, real| real)]
    }
}

/// Distance of every pixel from the nearest of some (px): exact, by lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012).
fn distances(from: &[u32]) -> Vec<f32> {
    let [width, height] = SIZE.map(|n| n as usize);
    let most = FARTHEST * FARTHEST;
    let mut squares = vec![most; width * height];
    from.iter().for_each(|at| squares[*at as usize] = 0.0);
    let (mut line, mut out) = (vec![0.0; width.max(height)], vec![0.0; width.max(height)]);
    for x in 0..width {
        (0..height).for_each(|y| line[y] = squares[y * width + x]);
        envelope(&line[..height], &mut out[..height]);
        (0..height).for_each(|y| squares[y * width + x] = out[y]);
    }
    for row in squares.chunks_mut(width) {
        line[..width].copy_from_slice(row);
        envelope(&line[..width], row);
    }
    squares.iter().map(|s| s.min(most).sqrt()).collect()
}

/// The least of f(q) + (p - q)^2 over all q.
fn envelope(f: &[f32], out: &mut [f32]) {
    let mut parabolas: Vec<(usize, f32)> = vec![(0, f32::NEG_INFINITY)];
    for q in 1..f.len() {
        loop {
            let (p, begin) = parabolas[parabolas.len() - 1];
            let (a, b) = (p as f32, q as f32);
            let meet = ((f[q] + b * b) - (f[p] + a * a)) / (2.0 * (b - a));
            if meet > begin || parabolas.len() == 1 {
                parabolas.push((q, meet));
                break;
            }
            parabolas.pop();
        }
    }
    let mut k = 0;
    for (p, out) in out.iter_mut().enumerate() {
        while k + 1 < parabolas.len() && parabolas[k + 1].1 < p as f32 {
            k += 1;
        }
        let q = parabolas[k].0;
        *out = f[q] + (p as f32 - q as f32).powi(2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(left: usize, top: usize) -> Vec<bool> {
        let [width, height] = SIZE.map(|n| n as usize);
        let mut mask = vec![false; width * height];
        for y in top..top + 300 {
            mask[y * width + left..y * width + left + 300].fill(true);
        }
        mask
    }

    #[test]
    fn a_square_moved_by_seven_pixels_is_off_by_no_more_and_the_same_one_by_nothing() {
        let (here, there) = (Outline::of(&square(500, 300)), Outline::of(&square(507, 300)));
        let mut same = Vec::new();
        here.errors(&here, &mut same);
        assert!(!same.is_empty() && same.iter().all(|e| *e == 0.0));
        let mut off = Vec::new();
        here.errors(&there, &mut off);
        let most = off.iter().copied().fold(0.0, f32::max);
        assert!((most - 7.0).abs() < 1e-3, "{most}");
        assert_eq!(here.area(&there), [2100.0, 2100.0, 90_000.0]);
    }
}
