//! The shadow of cloth under parallel light from above: its area, by pixels.

use glam::{DVec2, DVec3};

/// Side of a pixel (m).
const PIXEL_M: f64 = 0.000_25;

/// Area that some triangles cover, seen from above (m2).
pub fn area(places: &[DVec3], triangles: impl Iterator<Item = [usize; 3]>) -> f64 {
    let flat: Vec<DVec2> = places.iter().map(|p| DVec2::new(p.x, p.z) / PIXEL_M).collect();
    let (low, high) =
        flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    if !(high - low).is_finite() || flat.is_empty() {
        return 0.0;
    }
    let (low, size) = (low.floor(), (high - low.floor()).ceil() + 1.0);
    let (width, height) = (size.x as usize, size.y as usize);
    let mut covered = vec![false; width * height];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| flat[i] - low);
        let turn = (b - a).perp_dot(c - a);
        let top = a.y.min(b.y).min(c.y).floor().max(0.0) as usize;
        let bottom = (a.y.max(b.y).max(c.y).ceil() as usize).min(height - 1);
        for row in top..=bottom {
            // The middle of a pixel is within where it is on the same side of all three edges.
            let y = row as f64 + 0.5;
            let (left, right) = (a.x.min(b.x).min(c.x).floor().max(0.0), a.x.max(b.x).max(c.x).ceil());
            for column in left as usize..=(right as usize).min(width - 1) {
                let p = DVec2::new(column as f64 + 0.5, y);
                let side = |from: DVec2, to: DVec2| (to - from).perp_dot(p - from) * turn >= 0.0;
                covered[row * width + column] |= side(a, b) && side(b, c) && side(c, a);
            }
        }
    }
    covered.iter().filter(|c| **c).count() as f64 * PIXEL_M * PIXEL_M
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_that_lies_twice_is_counted_once_and_a_leaning_one_by_its_shadow() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let square = [at(0.0, 0.0, 0.0), at(0.1, 0.0, 0.0), at(0.1, 0.0, 0.1), at(0.0, 0.0, 0.1)];
        let faces = [[0, 1, 2], [0, 2, 3], [1, 3, 2]];
        assert!((area(&square, faces.into_iter()) - 0.01).abs() < 2e-5);
        let leaning = square.map(|p| at(0.5 * p.x, -p.x, p.z));
        assert!((area(&leaning, faces.into_iter()) - 0.005).abs() < 2e-5);
        assert_eq!(area(&[], [].into_iter()), 0.0);
    }
}
