//! Places of the 68 points of a face on the mannequin's head: points of its triangles, which every shape of it carries along.

use glam::{DVec3, Vec3};
use toile_assets::body::shape::Shapes;
use toile_base::body::Region;
use toile_base::body::Sex;
use toile_sensors::face_points::FACE_POINTS;

/// A point of the surface: a triangle, and the shares of its corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Corners of the triangle.
    pub corners: [u32; 3],
    /// Their shares, which sum to 1.
    pub shares: [f64; 3],
}

impl SurfacePoint {
    /// Where it is on positions of the mesh (m).
    pub fn on(&self, positions: &[DVec3]) -> DVec3 {
        self.corners.iter().zip(self.shares).map(|(v, s)| positions[*v as usize] * s).sum()
    }
}

/// The points of a sex's head.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceLandmarks {
    /// In the order of the 68 points.
    pub points: Vec<SurfacePoint>,
}

/// The points of the wearer's right half and of the middle on the woman's drawing (mm: to the left, up from the floor, ahead), by their number
/// and that of their mirror image.
const DRAWN: [(usize, usize, [f32; 3]); 39] = [
    (0, 16, [-66.0, 1510.0, 16.0]),
    (1, 15, [-65.0, 1495.0, 20.0]),
    (2, 14, [-63.0, 1480.0, 26.0]),
    (3, 13, [-59.0, 1465.0, 33.0]),
    (4, 12, [-53.0, 1450.0, 42.0]),
    (5, 11, [-44.0, 1437.0, 53.0]),
    (6, 10, [-32.0, 1426.0, 66.0]),
    (7, 9, [-17.0, 1418.0, 80.0]),
    (8, 8, [0.0, 1415.0, 90.0]),
    (17, 26, [-50.0, 1529.0, 70.0]),
    (18, 25, [-42.0, 1534.0, 78.0]),
    (19, 24, [-33.0, 1536.0, 84.0]),
    (20, 23, [-23.0, 1535.0, 88.0]),
    (21, 22, [-13.0, 1531.0, 90.0]),
    (27, 27, [0.0, 1520.0, 95.0]),
    (28, 28, [0.0, 1508.0, 101.0]),
    (29, 29, [0.0, 1496.0, 107.0]),
    (30, 30, [0.0, 1484.0, 112.0]),
    (31, 35, [-13.0, 1475.0, 98.0]),
    (32, 34, [-7.0, 1472.0, 102.0]),
    (33, 33, [0.0, 1470.0, 103.0]),
    (36, 45, [-43.0, 1512.0, 72.0]),
    (37, 44, [-36.0, 1518.0, 80.0]),
    (38, 43, [-26.0, 1518.0, 83.0]),
    (39, 42, [-19.0, 1511.0, 80.0]),
    (40, 47, [-26.0, 1506.0, 82.0]),
    (41, 46, [-36.0, 1506.0, 80.0]),
    (48, 54, [-23.0, 1451.0, 84.0]),
    (49, 53, [-14.0, 1459.0, 92.0]),
    (50, 52, [-6.0, 1462.0, 96.0]),
    (51, 51, [0.0, 1461.0, 97.0]),
    (57, 57, [0.0, 1440.0, 95.0]),
    (58, 56, [-6.0, 1440.5, 95.0]),
    (59, 55, [-14.0, 1443.5, 91.0]),
    (60, 64, [-18.0, 1451.5, 88.0]),
    (61, 63, [-8.0, 1453.5, 95.0]),
    (62, 62, [0.0, 1453.8, 96.0]),
    (66, 66, [0.0, 1449.2, 95.0]),
    (67, 65, [-8.0, 1449.5, 94.0]),
];

impl FaceLandmarks {
    /// The points of the heads of both sexes, whose meshes are one.
    pub fn new() -> Self {
        let base = Shapes::of(Sex::Female).base();
        let head = |t: &&[u32; 3]| t.iter().all(|v| base.regions[*v as usize] == Region::Head);
        let triangles: Vec<[u32; 3]> = base.triangles.iter().filter(head).copied().collect();
        let mut points = vec![None; FACE_POINTS];
        for (own, mirror, place) in DRAWN {
            let place = Vec3::from(place) * 1e-3;
            points[own] = Some(nearest(&triangles, &base.positions, place));
            points[mirror] = Some(nearest(&triangles, &base.positions, place * Vec3::new(-1.0, 1.0, 1.0)));
        }
        Self { points: points.into_iter().flatten().collect() }
    }

    /// Where they are on positions of the mesh (m).
    pub fn on(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.points.iter().map(|p| p.on(positions)).collect()
    }
}

/// The number of a point's mirror image.
pub(super) fn mirrored(point: usize) -> usize {
    let of = |(own, other, _): &(usize, usize, _)| match point {
        p if p == *own => Some(*other),
        p if p == *other => Some(*own),
        _ => None,
    };
    DRAWN.iter().find_map(of).unwrap_or(point)
}

impl Default for FaceLandmarks {
    fn default() -> Self {
        Self::new()
    }
}

/// The point of these triangles that is nearest to a place.
fn nearest(triangles: &[[u32; 3]], positions: &[Vec3], place: Vec3) -> SurfacePoint {
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| positions[v as usize].as_dvec3());
        let shares = closest(place.as_dvec3(), a, b, c);
        let at = a * shares[0] + b * shares[1] + c * shares[2];
        (at.distance_squared(place.as_dvec3()), SurfacePoint { corners: *corners, shares })
    };
    let all = triangles.iter().map(of);
    all.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, p)| p).expect("a body has a head")
}

/// Shares of a triangle's corners in its point nearest to p (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
fn closest(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let whole = 1.0 / (va + vb + vc);
    [1.0 - (vb + vc) * whole, vb * whole, vc * whole]
}
