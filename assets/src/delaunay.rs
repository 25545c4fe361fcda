//! Delaunay triangulation of points in the plane.

use glam::DVec2;
use spade::{DelaunayTriangulation, Point2, Triangulation};

/// The triangles between the points (numbers of points), counter-clockwise, in an order that depends on the points alone: each from
/// its least corner, sorted.
///
/// # Panics
/// A coordinate that is not finite.
pub fn delaunay(points: &[DVec2]) -> Vec<[u32; 3]> {
    let points = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let mesh = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(points).expect("finite points");
    let mut triangles: Vec<[u32; 3]> = mesh
        .inner_faces()
        .map(|face| {
            let mut corners = face.vertices().map(|v| v.index() as u32);
            let least = (0..3).min_by_key(|k| corners[*k]).unwrap_or(0);
            corners.rotate_left(least);
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

#[cfg(test)]
mod tests {
    use super::delaunay;
    use glam::DVec2;

    #[test]
    fn no_circle_around_a_triangle_holds_another_point() {
        let points: Vec<DVec2> = (0..60u32)
            .map(|i| DVec2::new(f64::from(i * 37 % 61), f64::from(i * i * 11 % 67) + 0.01 * f64::from(i)))
            .collect();
        let found = delaunay(&points);
        assert!(found.len() > points.len() && found.is_sorted());
        for t in &found {
            let [a, b, c] = t.map(|v| points[v as usize]);
            assert!((b - a).perp_dot(c - a) > 0.0 && t[0] < t[1].min(t[2]), "{t:?}");
            for (i, p) in points.iter().enumerate().filter(|(i, _)| !t.contains(&(*i as u32))) {
                let [u, v, w] = [a, b, c].map(|q| q - *p);
                let inside = u.length_squared() * v.perp_dot(w)
                    + v.length_squared() * w.perp_dot(u)
                    + w.length_squared() * u.perp_dot(v);
                assert!(inside < 1e-6, "{t:?} and {i}");
            }
        }
    }
}
