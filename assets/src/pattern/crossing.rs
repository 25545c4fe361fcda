//! Tests if a closed polygon crosses or touches itself.

use glam::DVec2;

/// Two sides of a closed polygon that cross or touch each other, by their first corners; `None` for a simple polygon.
/// Sides that share a corner may meet there and nowhere else. Sides are swept in the order of their least x, so that a
/// usual outline takes little more than its number of sides.
pub fn crossing(points: &[DVec2]) -> Option<(usize, usize)> {
    let n = points.len();
    let side = |i: usize| [points[i], points[(i + 1) % n]];
    let span = |i: usize| {
        let [a, b] = side(i);
        (a.min(b), a.max(b))
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| span(i).0.x.total_cmp(&span(j).0.x).then(i.cmp(&j)));
    let mut open: Vec<usize> = Vec::new();
    for &i in &order {
        let (low, high) = span(i);
        open.retain(|&j| span(j).1.x >= low.x);
        let beside = |j: &usize| span(*j).0.y <= high.y && span(*j).1.y >= low.y;
        if let Some(&j) = open.iter().filter(|j| beside(j)).find(|&&j| meet(i, j, n, side(i), side(j))) {
            return Some((i.min(j), i.max(j)));
        }
        open.push(i);
    }
    None
}

/// Whether two sides meet anywhere but at the corner that they share.
fn meet(i: usize, j: usize, n: usize, [a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    if (i + 1) % n == j {
        return folds_back(a, b, d);
    }
    if (j + 1) % n == i {
        return folds_back(c, d, b);
    }
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (of_c, of_d, of_a, of_b) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    // On one line, sides whose boxes overlap touch; the boxes were looked at before.
    of_c * of_d <= 0.0 && of_a * of_b <= 0.0
}

/// Whether a polygon turns back on itself at its corner `b`.
fn folds_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let (to, on) = (b - a, c - b);
    to.dot(on) < 0.0 && to.perp_dot(on).abs() <= 1e-9 * to.length() * on.length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|p| DVec2::from(*p)).collect()
    }

    #[test]
    fn simple_polygons_pass() {
        assert_eq!(crossing(&polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])), None);
        // A dart: two legs that meet at its tip.
        assert_eq!(
            crossing(&polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.1, 4.0], [2.0, 1.0], [1.9, 4.0], [0.0, 4.0]])),
            None
        );
        assert_eq!(crossing(&polygon(&[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]])), None);
    }

    #[test]
    fn crossings_touches_and_spikes_are_found() {
        assert_eq!(crossing(&polygon(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])), Some((0, 2)));
        // A corner on another side.
        let touch = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]]);
        assert!(crossing(&touch).is_some());
        // Out along a line and back.
        let spike = polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 3.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!(crossing(&spike).is_some());
        // The same triangle around twice.
        let twice = polygon(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!(crossing(&twice).is_some());
    }
}
