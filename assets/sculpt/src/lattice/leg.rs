//! The grid over a leg, a foot and its toes.

use std::f32::consts::PI;

use glam::Vec3;

use super::cage::{HALF, LEG, Lattice, cast};
use super::chart::Chart;
use super::digit::Digit;
use crate::form::Form;
use toile_base::body::Region;

impl Lattice {
    pub(super) fn lay_leg(&mut self, form: &Form, low: &[u32; HALF]) {
        let grid = &form.drawing.grid;
        let front = self.points[low[0] as usize];
        let back = self.points[low[HALF - 1] as usize];
        let strip: Vec<u32> = [0.75, 0.5, 0.25]
            .map(|t| {
                let hang = 1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0);
                let p = front.lerp(back, t) - Vec3::Y * 14.0 * hang;
                self.push(Vec3::new(0.0, p.y, p.z), Region::Torso, 0.5)
            })
            .to_vec();
        let mut ring: Vec<u32> = low.iter().copied().chain(strip).collect();
        let joint = |p: [f32; 3]| Vec3::from(p);
        let j = &form.drawing.joints;
        let (hip, knee, ankle) = (joint(j.hip), joint(j.knee), joint(j.ankle));
        for &y in &grid.leg {
            let axis = if y > knee.y {
                hip.lerp(knee, (hip.y - y) / (hip.y - knee.y))
            } else {
                knee.lerp(ankle, (knee.y - y) / (knee.y - ankle.y))
            };
            let from = Vec3::new(axis.x, y, axis.z);
            let to: Vec<u32> = (0..LEG)
                .map(|k| {
                    let (sin, cos) = leg_angle(k).sin_cos();
                    cast(from, Vec3::new(sin, 0.0, cos), |p| form.leg(p))
                })
                .map(|p| self.push(p, Region::LeftLeg, 0.5))
                .collect();
            self.band(&ring, &to, leg_chart);
            ring = to;
        }
        self.lay_foot(form, ring);
    }

    fn lay_foot(&mut self, form: &Form, mut ring: Vec<u32>) {
        let rings = form.drawing.grid.foot.clone();
        for (r, &[top_y, top_z, bottom_y, bottom_z, breadth, slant]) in rings.iter().enumerate() {
            let to: Vec<u32> = (0..LEG)
                .map(|k| {
                    let (sin, cos) = leg_angle(k).sin_cos();
                    // Fuller than an ellipse, so that the columns that split into toes lie evenly.
                    let (s, c) = (sin.signum() * sin.abs().powf(0.7), cos.signum() * cos.abs().powf(0.7));
                    let t = 0.5 - 0.5 * c;
                    let p = Vec3::new(s * breadth, top_y + (bottom_y - top_y) * t, top_z + (bottom_z - top_z) * t);
                    let p = p - Vec3::Z * (slant * (0.5 + 0.5 * s));
                    form.foot_frame.out(p)
                })
                .map(|p| self.push(p, Region::LeftLeg, 0.35))
                .collect();
            self.band(&ring, &to, |k| if r > 1 && (6..14).contains(&k) { Chart::Sole(false) } else { leg_chart(k) });
            ring = to;
        }
        self.lay_toes(form, &ring);
    }

    /// The last ring of the foot splits into five toes.
    fn lay_toes(&mut self, form: &Form, ring: &[u32]) {
        let grid = &form.drawing.grid;
        let at = |k: usize| ring[k % LEG];
        // Between toes, one vertex half way from the upper to the lower side.
        let webs: Vec<u32> = (0..4)
            .map(|k| {
                let (up, down) = (self.points[at(17 + k) as usize], self.points[at(11 - k) as usize]);
                self.push((up + down) * 0.5, Region::LeftLeg, 0.2)
            })
            .collect();
        for toe in 0..5 {
            // Round the toe from its upper inner corner outwards: upper side, outer side, lower side, inner side.
            let rim: Vec<u32> = match toe {
                0 => vec![at(15), at(16), at(17), webs[0], at(11), at(12), at(13), at(14)],
                4 => vec![at(20), at(21), at(6), at(7), at(8), webs[3]],
                k => vec![at(16 + k), at(17 + k), webs[k], at(11 - k), at(12 - k), webs[k - 1]],
            };
            let balls: Vec<(Vec3, f32)> = form.toe(toe).into_iter().map(|(p, r)| (form.foot_frame.out(p), r)).collect();
            let side = form.foot_frame.axes.x_axis;
            let digit = Digit {
                balls: &balls,
                ways: &grid.toe,
                nail: Vec3::Y,
                side,
                region: Region::LeftLeg,
                charts: [Chart::LegFront(false), Chart::Sole(false)],
            };
            self.lay_digit(&rim, &digit);
        }
    }
}

/// Angle of a leg's column from the front, outwards: columns 0 to 12 are the trunk's, 2 looks ahead.
fn leg_angle(column: usize) -> f32 {
    (column as f32 - 2.0) * PI / 8.0
}

fn leg_chart(column: usize) -> Chart {
    if (6..14).contains(&column) { Chart::LegBack(false) } else { Chart::LegFront(false) }
}
