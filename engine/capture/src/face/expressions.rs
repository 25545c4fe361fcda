//! A few expressions of a face: fields of displacements on the mannequin's head, each with an amplitude from 0, at rest, to 1.
//!
//! An expression says where some of the 68 points are displaced to, and which of them hold still; between them a compact radial function
//! (Wendland 1995) carries it over the surface.

use glam::DVec3;
use toile_assets::body::Sex;
use toile_sensors::face_points::FACE_POINTS;

use super::head_mesh::HeadMesh;
use super::landmarks::{FaceLandmarks, mirrored};
use super::prior::{solve, wendland};

/// Number of expressions.
pub const EXPRESSIONS: usize = 4;

/// Their names, in the order of all amplitudes.
pub const EXPRESSION_NAMES: [&str; EXPRESSIONS] = ["jaw_open", "smile", "brows_up", "lids_closed"];

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
    /// Through the displacements of points that are drawn here (m) `[68]`.
    fn through((reach_mm, displaced): (f64, &[Displaced]), points: &[DVec3]) -> Self {
        let reach = reach_mm * 1e-3;
        let mut wanted: Vec<(DVec3, DVec3)> = Vec::new();
        for (own, by) in displaced {
            let by = DVec3::from_array(*by) * 1e-3;
            wanted.push((points[*own], by));
            let other = mirrored(*own);
            if other != *own {
                wanted.push((points[other], by * DVec3::new(-1.0, 1.0, 1.0)));
            }
        }
        let kernel = || {
            let row = |a: &(DVec3, DVec3)| wanted.iter().map(|b| wendland(a.0.distance(b.0) / reach)).collect();
            wanted.iter().map(row).collect::<Vec<Vec<f64>>>()
        };
        let axes = [0, 1, 2].map(|axis| {
            let mut weights: Vec<f64> = wanted.iter().map(|w| w.1[axis]).collect();
            solve(&mut kernel(), &mut weights);
            weights
        });
        let part = |(i, w): (usize, &(DVec3, DVec3))| (w.0, DVec3::new(axes[0][i], axes[1][i], axes[2][i]));
        let parts = wanted.iter().enumerate().map(part).collect();
        Self { reach, parts }
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
        let points = FaceLandmarks::new().on(&HeadMesh::of(sex).positions);
        Self { all: DRAWN.map(|drawn| Expression::through(drawn, &points)) }
    }

    /// The displacement (m) of a place of the mannequin's head (m, from its middle) in each expression at amplitude 1.
    pub fn at(&self, place: DVec3) -> [DVec3; EXPRESSIONS] {
        std::array::from_fn(|k| self.all[k].at(place))
    }

    /// The same of the 68 points `[68]`.
    pub(super) fn of_points(&self, drawn: &[DVec3]) -> [[DVec3; EXPRESSIONS]; FACE_POINTS] {
        std::array::from_fn(|i| self.at(drawn[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expression_displaces_its_points_on_both_sides_and_nothing_far_off() {
        for sex in Sex::ALL {
            let fields = ExpressionFields::of(sex);
            let points = FaceLandmarks::new().on(&HeadMesh::of(sex).positions);
            let all = fields.of_points(&points);
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
