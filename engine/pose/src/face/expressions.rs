//! A few expressions of a face: fields of displacements on the mannequin's head, each with an amplitude from 0, at rest, to 1.
//!
//! An expression gives the displacements of some of the 68 points, and names those that hold still; between them a compact radial function
//! (Wendland 1995) carries it over the surface.

use glam::DVec3;
use toile_base::body::Sex;
use toile_sensors::face_points::FACE_POINTS;

use super::head_mesh::HeadMesh;
use super::landmarks::{FaceLandmarks, SurfacePoint, mirrored};
use super::prior::{solve, wendland};

/// Number of expressions. The order of all amplitudes: jaw open, smile, brows up, lids closed.
pub const EXPRESSIONS: usize = 4;

/// Rounds until points of the mesh move as they are meant to.
const CORRECTIONS: usize = 12;

/// What a point of the wearer's right half or the middle does (mm: to the left, up, ahead), by its number.
type Displaced = (usize, [f64; 3]);

/// The reach of each expression (mm), and its points.
const DRAWN: [(f64, &[Displaced]); EXPRESSIONS] = [
    (
        60.0,
        &[
            (2, [0.0, 0.0, 0.0]),
            (3, [0.0, -2.0, -1.0]),
            (4, [0.0, -5.0, -3.0]),
            (5, [0.0, -10.0, -5.0]),
            (6, [0.0, -14.0, -7.0]),
            (7, [0.0, -17.0, -8.0]),
            (8, [0.0, -18.0, -8.0]),
            (33, [0.0, 0.0, 0.0]),
            (31, [0.0, 0.0, 0.0]),
            (48, [3.0, -6.0, -3.0]),
            (50, [0.0, 0.0, 0.0]),
            (51, [0.0, 0.0, 0.0]),
            (57, [0.0, -16.0, -7.0]),
            (59, [0.5, -13.0, -6.0]),
            (62, [0.0, 0.0, 0.0]),
            (66, [0.0, -15.0, -7.0]),
        ],
    ),
    (
        40.0,
        &[
            (4, [-1.0, 1.0, 0.0]),
            (8, [0.0, 0.0, 0.0]),
            (30, [0.0, 0.0, 0.0]),
            (31, [-1.0, 0.5, 0.0]),
            (41, [0.0, 0.0, 0.0]),
            (48, [-7.0, 5.0, -4.0]),
            (49, [-3.0, 2.0, -1.5]),
            (51, [0.0, 0.0, -0.5]),
            (57, [0.0, 0.0, -0.5]),
            (59, [-4.0, 2.0, -2.0]),
        ],
    ),
    (
        35.0,
        &[
            (17, [0.0, 5.0, -1.0]),
            (19, [0.0, 8.0, -1.0]),
            (21, [0.0, 6.0, -1.0]),
            (27, [0.0, 1.0, 0.0]),
            (36, [0.0, 0.0, 0.0]),
            (37, [0.0, 0.5, 0.0]),
            (38, [0.0, 0.5, 0.0]),
            (39, [0.0, 0.0, 0.0]),
        ],
    ),
    (
        16.0,
        &[
            (19, [0.0, 0.0, 0.0]),
            (36, [0.0, 0.0, 0.0]),
            (37, [0.0, -10.0, 0.5]),
            (38, [0.0, -10.0, 0.5]),
            (39, [0.0, 0.0, 0.0]),
            (40, [0.0, 1.5, 0.0]),
            (41, [0.0, 1.5, 0.0]),
        ],
    ),
];

/// One expression: radial functions of one reach (m) around places of the mannequin's head, from its middle (m).
#[derive(Debug, Clone, PartialEq)]
struct Expression {
    reach: f64,
    parts: Vec<(DVec3, DVec3)>,
}

impl Expression {
    /// Through the displacements of points of a mesh.
    fn through((reach_mm, displaced): (f64, &[Displaced]), landmarks: &FaceLandmarks, mesh: &HeadMesh) -> Self {
        let mut wanted: Vec<(usize, DVec3)> = Vec::new();
        for (own, by) in displaced {
            let by = DVec3::from_array(*by) * 1e-3;
            wanted.push((*own, by));
            let other = mirrored(*own);
            if other != *own {
                wanted.push((other, by * DVec3::new(-1.0, 1.0, 1.0)));
            }
        }
        let parts = wanted.iter().map(|(i, _)| (landmarks.points[*i].on(&mesh.positions), DVec3::ZERO)).collect();
        let mut found = Self { reach: reach_mm * 1e-3, parts };
        // The mesh is flat between its vertices, so that a point moves less than the function does there.
        for _ in 0..CORRECTIONS {
            let off: Vec<DVec3> =
                wanted.iter().map(|(i, by)| *by - found.of_point(&landmarks.points[*i], mesh)).collect();
            found.add(&off);
        }
        found
    }

    /// Adds displacements of its points.
    fn add(&mut self, wanted: &[DVec3]) {
        for axis in 0..3 {
            let row =
                |a: &(DVec3, DVec3)| self.parts.iter().map(|b| wendland(a.0.distance(b.0) / self.reach)).collect();
            let mut kernel: Vec<Vec<f64>> = self.parts.iter().map(row).collect();
            let mut weights: Vec<f64> = wanted.iter().map(|w| w[axis]).collect();
            solve(&mut kernel, &mut weights);
            self.parts.iter_mut().zip(weights).for_each(|(part, w)| part.1[axis] += w);
        }
    }

    /// The displacement of a point of a mesh (m).
    fn of_point(&self, point: &SurfacePoint, mesh: &HeadMesh) -> DVec3 {
        let one = |(v, share): (&u32, f64)| self.at(mesh.positions[*v as usize]) * share;
        point.corners.iter().zip(point.shares).map(one).sum()
    }

    fn at(&self, place: DVec3) -> DVec3 {
        self.parts.iter().map(|(from, by)| *by * wendland(place.distance(*from) / self.reach)).sum()
    }
}

/// The expressions of a sex's head.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionFields {
    all: [Expression; EXPRESSIONS],
}

impl ExpressionFields {
    /// On the head of a sex.
    pub fn of(sex: Sex) -> Self {
        let (landmarks, mesh) = (FaceLandmarks::new(), HeadMesh::of(sex));
        Self { all: DRAWN.map(|drawn| Expression::through(drawn, &landmarks, &mesh)) }
    }

    /// The displacement (m) of a place of the mannequin's head (m, from its middle) in each expression at amplitude 1.
    pub fn at(&self, place: DVec3) -> [DVec3; EXPRESSIONS] {
        std::array::from_fn(|k| self.all[k].at(place))
    }

    /// The same of the 68 points `[68]`.
    pub(super) fn of_points(&self, landmarks: &FaceLandmarks, mesh: &HeadMesh) -> [[DVec3; EXPRESSIONS]; FACE_POINTS] {
        std::array::from_fn(|i| std::array::from_fn(|k| self.all[k].of_point(&landmarks.points[i], mesh)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expression_displaces_its_points_on_both_sides_and_nothing_far_off() {
        for sex in Sex::ALL {
            let fields = ExpressionFields::of(sex);
            let all = fields.of_points(&FaceLandmarks::new(), &HeadMesh::of(sex));
            let near = |a: DVec3, x: f64, y: f64, z: f64| a.distance(DVec3::new(x, y, z) * 1e-3) < 1e-4;
            assert!(
                near(all[8][0], 0.0, -18.0, -8.0) && near(all[62][0], 0.0, 0.0, 0.0),
                "{} {}",
                all[8][0],
                all[62][0]
            );
            assert!(near(all[48][1], -7.0, 5.0, -4.0) && near(all[54][1], 7.0, 5.0, -4.0));
            assert!(near(all[24][2], 0.0, 8.0, -1.0) && near(all[43][3], 0.0, -10.0, 0.5));
            assert!(fields.at(DVec3::new(0.0, 0.1, -0.05)).iter().all(|d| d.length() < 1e-9), "the crown holds still");
            let most = all.iter().flatten().map(|d| d.length()).fold(0.0, f64::max);
            assert!(most < 0.025, "{most}");
        }
    }
}
