//! Distance of each place of a picture from the person, by the exact distance transform of Felzenszwalb and Huttenlocher (2012).

/// The distance of each pixel from the nearest one that the person covers (px).
#[derive(Debug, Clone)]
pub(super) struct DistanceField {
    width: usize,
    height: usize,
    distance: Vec<f32>,
}

impl DistanceField {
    /// The field of a mask `[height x width]`.
    pub(super) fn of(width: usize, height: usize, covered: &[bool]) -> Self {
        let far = ((width + height) * (width + height)) as f32;
        let mut squares: Vec<f32> = covered.iter().map(|c| if *c { 0.0 } else { far }).collect();
        let mut line = Vec::new();
        for x in 0..width {
            line.clear();
            line.extend((0..height).map(|y| squares[y * width + x]));
            let row = transformed(&line);
            (0..height).for_each(|y| squares[y * width + x] = row[y]);
        }
        for row in squares.chunks_mut(width.max(1)) {
            let done = transformed(row);
            row.copy_from_slice(&done);
        }
        Self { width, height, distance: squares.into_iter().map(f32::sqrt).collect() }
    }

    /// The distance at a place, that of the nearest pixel of the picture beyond its border, with the way there added (px).
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let (cx, cy) = (x.clamp(0.0, self.width as f64 - 1.0), y.clamp(0.0, self.height as f64 - 1.0));
        let inside = self.distance[cy.round() as usize * self.width + cx.round() as usize];
        f64::from(inside) + (x - cx).hypot(y - cy)
    }
}

/// The lower envelope of the parabolas `(x - i)^2 + f(i)`, sampled at every place.
fn transformed(f: &[f32]) -> Vec<f32> {
    let n = f.len();
    let (mut at, mut from) = (vec![0usize; n], vec![f32::NEG_INFINITY; n + 1]);
    let mut k = 0;
    let meet = |i: usize, j: usize| {
        let (x, y) = (i as f32, j as f32);
        ((f[i] + x * x) - (f[j] + y * y)) / (2.0 * (x - y))
    };
    for i in 1..n {
        let mut s = meet(i, at[k]);
        while s <= from[k] && k > 0 {
            k -= 1;
            s = meet(i, at[k]);
        }
        k += 1;
        (at[k], from[k]) = (i, s);
    }
    from[k + 1] = f32::INFINITY;
    let mut k = 0;
    let value = |i: usize, k: &mut usize| {
        while from[*k + 1] < i as f32 {
            *k += 1;
        }
        (i as f32 - at[*k] as f32).powi(2) + f[at[*k]]
    };
    (0..n).map(|i| value(i, &mut k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_that_a_search_finds() {
        let (w, h) = (23, 17);
        let covered: Vec<bool> = (0..w * h).map(|i| (i * 7919) % 61 == 0).collect();
        let field = DistanceField::of(w, h, &covered);
        for y in 0..h {
            for x in 0..w {
                let near = (0..w * h)
                    .filter(|i| covered[*i])
                    .map(|i| ((i % w) as f64 - x as f64).hypot((i / w) as f64 - y as f64));
                let least = near.fold(f64::MAX, f64::min);
                assert!((field.at(x as f64, y as f64) - least).abs() < 1e-3);
            }
        }
    }
}
