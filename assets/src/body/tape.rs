//! Measuring on a mesh as a tape would: slices by a plane, and the tight loop around them.

use glam::{Vec2, Vec3};

use toile_base::body::{Body, Region};
use toile_base::mesh::Mesh;

/// The segments in which a plane cuts the triangles that `keep` admits (by index), one a triangle, unordered.
/// A vertex that lies exactly on the plane counts as above it, so that no segment comes out twice.
pub fn slice(mesh: &Mesh, keep: impl Fn(usize) -> bool, origin: Vec3, normal: Vec3) -> Vec<[Vec3; 2]> {
    let mut segments = Vec::new();
    for (i, t) in mesh.triangles.iter().enumerate() {
        let corners = t.map(|v| mesh.positions[v as usize]);
        let heights = corners.map(|p| (p - origin).dot(normal));
        let above = heights.map(|h| h >= 0.0);
        if (above[0] == above[1] && above[1] == above[2]) || !keep(i) {
            continue;
        }
        let mut ends = [Vec3::ZERO; 2];
        let mut found = 0;
        for k in 0..3 {
            let j = (k + 1) % 3;
            if above[k] != above[j] {
                ends[found] = corners[k].lerp(corners[j], heights[k] / (heights[k] - heights[j]));
                found += 1;
            }
        }
        segments.push(ends);
    }
    segments
}

/// The convex hull of points in the plane, counter-clockwise, without collinear points (Andrew's monotone chain).
/// Points that are not finite are left out.
pub fn hull(points: &[Vec2]) -> Vec<Vec2> {
    hull_corners(points).into_iter().map(|i| points[i]).collect()
}

/// Which points are corners of the [`hull`], in its order.
pub(super) fn hull_corners(points: &[Vec2]) -> Vec<usize> {
    let mut sorted: Vec<usize> = (0..points.len()).filter(|&i| points[i].is_finite()).collect();
    let (x, y) = (|i: &usize| points[*i].x, |i: &usize| points[*i].y);
    sorted.sort_unstable_by(|a, b| x(a).total_cmp(&x(b)).then(y(a).total_cmp(&y(b))).then(a.cmp(b)));
    sorted.dedup_by(|a, b| points[*a] == points[*b]);
    if sorted.len() < 3 {
        return sorted;
    }
    let mut chain: Vec<usize> = Vec::with_capacity(sorted.len() + 1);
    let half = |chain: &mut Vec<usize>, i: usize, floor: usize| {
        let left = |c: &[usize]| turn(points[c[c.len() - 2]], points[c[c.len() - 1]], points[i]) > 0.0;
        while chain.len() > floor && !left(chain) {
            chain.pop();
        }
        chain.push(i);
    };
    for &i in &sorted {
        half(&mut chain, i, 1);
    }
    let floor = chain.len();
    for &i in sorted.iter().rev().skip(1) {
        half(&mut chain, i, floor);
    }
    chain.pop();
    chain
}

/// Twice the signed area of a triangle, in f64: positive when it turns left.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let (a, b, c) = (a.as_dvec2(), b.as_dvec2(), c.as_dvec2());
    (b - a).perp_dot(c - a)
}

/// Length of a closed loop of points (m for points in m).
pub fn perimeter(hull: &[Vec2]) -> f32 {
    perimeter_f64(hull) as f32
}

/// [`perimeter`] before it is rounded.
pub(super) fn perimeter_f64(hull: &[Vec2]) -> f64 {
    let next = hull.iter().skip(1).chain(hull.first());
    hull.iter().zip(next).map(|(&a, &b)| f64::from(a.distance(b))).sum()
}

/// Girth of the body without arms at a height above the floor (m): the perimeter of the convex hull of its horizontal
/// slice, as EN 13402-1 and ISO 8559-1 lay the tape. Below the crotch it goes round both legs. 0 above the head.
pub fn girth(body: &Body, height: f32) -> f32 {
    girth_of(&body.mesh, &body.regions, height)
}

/// [`girth`] on the parts of a body that is still being made.
pub(crate) fn girth_of(mesh: &Mesh, regions: &[Region], height: f32) -> f32 {
    let keep = |t: usize| {
        mesh.triangles[t].iter().all(|&v| !matches!(regions[v as usize], Region::LeftArm | Region::RightArm))
    };
    let segments = slice(mesh, keep, Vec3::new(0.0, height, 0.0), Vec3::Y);
    let points: Vec<Vec2> = segments.iter().flatten().map(|p| Vec2::new(p.x, p.z)).collect();
    perimeter(&hull(&points))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::TAU;

    /// An open tube of elliptic section between y = -1 and 1.
    fn tube(a: f32, b: f32, columns: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for k in 0..columns {
            let (s, c) = (k as f32 / columns as f32 * TAU).sin_cos();
            mesh.positions.push(Vec3::new(a * c, -1.0, b * s));
            mesh.positions.push(Vec3::new(a * c, 1.0, b * s));
            let (i, j) = (2 * k, 2 * ((k + 1) % columns));
            mesh.triangles.extend([[i, i + 1, j + 1], [i, j + 1, j]]);
        }
        mesh
    }

    fn around(mesh: &Mesh, normal: Vec3) -> f32 {
        let (u, v) = normal.any_orthonormal_pair();
        let points: Vec<Vec2> =
            slice(mesh, |_| true, Vec3::ZERO, normal).iter().flatten().map(|p| Vec2::new(p.dot(u), p.dot(v))).collect();
        perimeter(&hull(&points))
    }

    #[test]
    fn tape_reads_a_cylinder() {
        let read = around(&tube(0.15, 0.15, 720), Vec3::Y);
        assert!((read - TAU * 0.15).abs() < 1e-5, "{read}");
    }

    #[test]
    fn tape_reads_an_ellipse() {
        // Ramanujan's second formula, exact to 1e-9 at this eccentricity.
        let (a, b) = (0.18f32, 0.11f32);
        let h = ((a - b) / (a + b)).powi(2);
        let expected = TAU / 2.0 * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        let read = around(&tube(a, b, 1440), Vec3::Y);
        assert!((read - expected).abs() < 1e-5, "{read} {expected}");
    }

    #[test]
    fn oblique_slice_of_a_cylinder_is_an_ellipse() {
        let normal = Vec3::new(0.0, 1.0, 1.0).normalize();
        let (a, b) = (0.1f32 * 2f32.sqrt(), 0.1f32);
        let h = ((a - b) / (a + b)).powi(2);
        let expected = TAU / 2.0 * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        assert!((around(&tube(0.1, 0.1, 1440), normal) - expected).abs() < 2e-5);
    }

    #[test]
    fn tape_bridges_hollows() {
        let dented = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.2), (2.0, 1.0), (0.0, 1.0), (1.0, 0.0), (f32::NAN, 3.0)];
        let hull = hull(&dented.map(|(x, y)| Vec2::new(x, y)));
        assert_eq!(hull.len(), 4);
        assert!((perimeter(&hull) - 6.0).abs() < 1e-6);
        let area: f32 = (0..4).map(|i| hull[i].perp_dot(hull[(i + 1) % 4])).sum();
        assert!(area > 0.0, "counter-clockwise");
    }

    #[test]
    fn small_hulls_stand() {
        assert!(hull(&[]).is_empty());
        assert_eq!(perimeter(&[]), 0.0);
        assert_eq!(hull(&[Vec2::ONE, Vec2::ONE]).len(), 1);
        assert!((perimeter(&hull(&[Vec2::ZERO, Vec2::X])) - 2.0).abs() < 1e-6);
    }
}
