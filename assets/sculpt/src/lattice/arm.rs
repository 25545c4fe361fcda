//! The grid over an arm, a hand and its fingers.

use glam::Vec3;

use super::cage::{ABOVE_HOLE, ARM, HALF, HOLE, HOLE_ROWS, Lattice, cast};
use super::chart::Chart;
use super::digit::Digit;
use crate::form::Form;
use toile_base::body::Region;

impl Lattice {
    pub(super) fn lay_arm(&mut self, form: &Form, trunk: &[[u32; HALF]]) {
        let grid = &form.drawing.grid;
        let low = trunk.len() - 1 - ABOVE_HOLE - HOLE_ROWS;
        let high = low + HOLE_ROWS;
        let (front, rear) = (HOLE, HOLE + HOLE_ROWS);
        // From the top's front half over the front, below and behind.
        let rim = [
            (high, front + 1),
            (high, front),
            (high - 1, front),
            (high - 2, front),
            (low, front),
            (low, front + 1),
            (low, front + 2),
            (low, rear),
            (high - 2, rear),
            (high - 1, rear),
            (high, rear),
            (high, front + 2),
        ];
        let mut ring: Vec<u32> = rim.map(|(r, c)| trunk[r][c]).to_vec();
        for &way in &grid.arm {
            // The ring starts half a column in front of the top and has none left at the wrist.
            let twist = (15.0 * (1.0 - way / 500.0)).clamp(0.0, 15.0);
            let to: Vec<u32> = (0..ARM)
                .map(|k| {
                    let (sin, cos) = (k as f32 * 30.0 + twist).to_radians().sin_cos();
                    let q = cast(Vec3::X * way, Vec3::new(0.0, cos, sin), |q| form.arm(q));
                    form.bent(q)
                })
                .map(|p| self.push(p, Region::LeftArm, 0.5))
                .collect();
            self.band(&ring, &to, arm_chart);
            ring = to;
        }
        self.lay_hand(form, ring);
    }

    fn lay_hand(&mut self, form: &Form, mut ring: Vec<u32>) {
        let grid = &form.drawing.grid;
        let mut rings = vec![];
        for (r, &way) in grid.palm.iter().enumerate() {
            let to: Vec<u32> = (0..ARM)
                .map(|k| {
                    // Four columns over the back of the hand and four over the palm, evenly across.
                    let across = [2.0f32, 1.0, 0.0, -1.0, -2.0];
                    let (f, u) = match k {
                        10 | 11 => (across[14 - k], 1.0),
                        0..3 => (across[2 - k], 1.0),
                        3 => (2.35, 0.0),
                        4..=8 => (across[k - 4], -1.0),
                        _ => (-2.35, 0.0),
                    };
                    let way = if r == 4 { way - 2.2 * f.abs() * f.abs() } else { way };
                    let q = Vec3::new(way, u * 11.0, f * 15.5);
                    form.hand_frame.out(q)
                })
                .enumerate()
                .map(|(k, p)| if r == 2 && k == 3 { u32::MAX } else { self.push(p, Region::LeftArm, 0.35) })
                .collect();
            for k in 0..ARM {
                let n = (k + 1) % ARM;
                if (r == 2 || r == 3) && (k == 2 || k == 3) {
                    continue;
                }
                self.quad([ring[k], ring[n], to[n], to[k]], arm_chart(k));
            }
            rings.push(to.clone());
            ring = to;
        }
        self.grow_thumb(form, &rings);
        self.lay_fingers(form, &ring);
    }

    /// Draws the thumb out of two rows and two columns of the palm's edge.
    fn grow_thumb(&mut self, form: &Form, rings: &[Vec<u32>]) {
        let [near, middle, far] = [&rings[1], &rings[2], &rings[3]];
        // From the back of the hand over its far side to the palm: upper side first, lower side last.
        let rim = vec![near[2], middle[2], far[2], far[3], far[4], middle[4], near[4], near[3]];
        let balls: Vec<(Vec3, f32)> = form.finger(4).into_iter().map(|(p, r)| (form.hand_frame.out(p), r)).collect();
        let grid = form.drawing.grid.thumb.clone();
        // The thumb's nail looks up and forwards; its side looks to the fingers.
        let frame = form.hand_frame.axes;
        let nail = (frame.y_axis * 0.75 + frame.z_axis * 0.65).normalize();
        let charts = [Chart::ArmUpper(false), Chart::ArmLower(false)];
        let digit = Digit { balls: &balls, ways: &grid, nail, side: frame.x_axis, region: Region::LeftArm, charts };
        self.lay_digit(&rim, &digit);
    }

    fn lay_fingers(&mut self, form: &Form, ring: &[u32]) {
        let at = |k: usize| ring[k % ARM];
        let webs: Vec<u32> = (0..3)
            .map(|k| {
                let (up, down) = (self.points[at(13 - k) as usize], self.points[at(5 + k) as usize]);
                self.push((up + down) * 0.5, Region::LeftArm, 0.2)
            })
            .collect();
        let grid = form.drawing.grid.finger.clone();
        for finger in 0..4 {
            // Upper side from the thumb's to the little finger's, then that side, the palm, and the thumb's side.
            let rim = match finger {
                0 => vec![at(2), at(1), webs[0], at(5), at(4), at(3)],
                3 => vec![at(11), at(10), at(9), at(8), at(7), webs[2]],
                k => vec![at(14 - k), at(13 - k), webs[k], at(5 + k), at(4 + k), webs[k - 1]],
            };
            let balls: Vec<(Vec3, f32)> =
                form.finger(finger).into_iter().map(|(p, r)| (form.hand_frame.out(p), r)).collect();
            let frame = form.hand_frame.axes;
            let digit = Digit {
                balls: &balls,
                ways: &grid,
                nail: frame.y_axis,
                side: -frame.z_axis,
                region: Region::LeftArm,
                charts: [Chart::ArmUpper(false), Chart::ArmLower(false)],
            };
            self.lay_digit(&rim, &digit);
        }
    }
}

fn arm_chart(column: usize) -> Chart {
    if (3..9).contains(&column) { Chart::ArmLower(false) } else { Chart::ArmUpper(false) }
}
