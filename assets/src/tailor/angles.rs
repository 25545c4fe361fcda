//! Angles of triangles and of outlines.

use glam::DVec2;

/// The three angles of a triangle (rad) at its corners.
pub fn angles(corners: [DVec2; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (p, q, r) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
        (q - p).angle_to(r - p).abs()
    })
}

/// The angle inside of an outline at each of its points (rad).
pub fn interior(points: &[DVec2], counter_clockwise: bool) -> Vec<f64> {
    let n = points.len();
    let at = |i: usize| {
        let (before, after) = (points[(i + n - 1) % n] - points[i], points[(i + 1) % n] - points[i]);
        let left = after.angle_to(before).rem_euclid(std::f64::consts::TAU);
        if counter_clockwise { left } else { std::f64::consts::TAU - left }
    };
    (0..n).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_a_square_with_a_notch() {
        let p = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]].map(DVec2::from);
        let found: Vec<f64> = interior(&p, true).iter().map(|a| a.to_degrees().round()).collect();
        assert_eq!(found, [90.0, 90.0, 45.0, 270.0, 45.0]);
        let reversed: Vec<DVec2> = p.iter().rev().copied().collect();
        assert_eq!(interior(&reversed, false)[1].to_degrees().round(), 270.0);
        assert!((angles([p[0], p[1], p[2]])[1] - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
