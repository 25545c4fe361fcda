//! The cage's grid: rings of quads over trunk, head, limbs, fingers and toes, joined into one closed surface.
//!
//! The left half is laid out and mirrored. Rings of the trunk have 24 columns (13 in a half, both middles included).
//! Three rows and three columns are left open for an arm of 12; half the lowest ring and three vertices along the
//! crotch start a leg of 16. The hand's ring of 12 splits into four fingers of 6 (two between each pair), 8 around two
//! rows of the palm grow the thumb; the foot's 16 split into a big toe of 8 and four toes of 6. The head's 24 close in
//! a patch of 6 by 6. All faces are quads.

use std::collections::BTreeMap;
use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::Region;
use super::form::{Form, GridRow};

/// Columns of half a trunk ring, both middles included.
const HALF: usize = 13;
/// Columns of an arm's and a leg's ring.
const ARM: usize = 12;
const LEG: usize = 16;
/// The armhole's first column and its width; its first row is so many below the trunk's last.
const HOLE: usize = 5;
const HOLE_ROWS: usize = 3;
/// Rows of the trunk above the armhole's upper edge, the base of the neck included.
const ABOVE_HOLE: usize = 3;
/// The ear's column of quads and its rows, in the head's rings.
const EAR_COLUMN: usize = 8;
const EAR_ROWS: [usize; 2] = [6, 11];

/// A piece of the texture atlas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Chart {
    /// Trunk and neck, from side to side.
    Front,
    /// The same behind.
    Back,
    /// Face and forehead.
    Face,
    /// Back and crown of the head.
    Nape,
    /// An ear.
    Ear(bool),
    /// Upper side of an arm, with the hand's back.
    ArmUpper(bool),
    /// Lower side of an arm, with the palm.
    ArmLower(bool),
    /// Front of a leg, with the instep.
    LegFront(bool),
    /// Back of a leg.
    LegBack(bool),
    /// Sole of a foot.
    Sole(bool),
}

/// Number of pieces of the atlas.
pub const CHARTS: usize = 16;

impl Chart {
    /// Its number, below [`CHARTS`].
    pub fn number(self) -> u8 {
        match self {
            Self::Front => 0,
            Self::Back => 1,
            Self::Face => 2,
            Self::Nape => 3,
            Self::Ear(right) => 4 + u8::from(right),
            Self::ArmUpper(right) => 6 + u8::from(right),
            Self::ArmLower(right) => 8 + u8::from(right),
            Self::LegFront(right) => 10 + u8::from(right),
            Self::LegBack(right) => 12 + u8::from(right),
            Self::Sole(right) => 14 + u8::from(right),
        }
    }

    /// The same piece of the other side; each variant's flag says whether it is the right one.
    fn mirror(self) -> Self {
        match self {
            Self::Ear(_) => Self::Ear(true),
            Self::ArmUpper(_) => Self::ArmUpper(true),
            Self::ArmLower(_) => Self::ArmLower(true),
            Self::LegFront(_) => Self::LegFront(true),
            Self::LegBack(_) => Self::LegBack(true),
            Self::Sole(_) => Self::Sole(true),
            both => both,
        }
    }
}

/// What a vertex of the cage belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tag {
    pub region: Region,
    /// How far the vertex may slide along the surface while the mesh is evened out, 0 to 1.
    pub slide: f32,
    /// Ring of the arm or the leg (0 = its rim on the trunk), or row of the trunk from the groin.
    pub ring: usize,
}

/// The cage with its starting points (mm).
#[derive(Debug, Default)]
pub(super) struct Lattice {
    pub points: Vec<Vec3>,
    pub tags: Vec<Tag>,
    pub faces: Vec<[u32; 4]>,
    pub charts: Vec<Chart>,
    /// Each vertex's mirror image; its own in the middle.
    pub twins: Vec<u32>,
}

impl Lattice {
    /// The whole cage over a form.
    pub(super) fn new(form: &Form) -> Self {
        let mut half = Self::default();
        let trunk = half.lay_trunk(form);
        half.lay_leg(form, &trunk[0]);
        half.lay_arm(form, &trunk);
        half.orient();
        half.mirrored()
    }

    fn push(&mut self, point: Vec3, region: Region, slide: f32, ring: usize) -> u32 {
        self.points.push(point);
        self.tags.push(Tag { region, slide, ring });
        self.points.len() as u32 - 1
    }

    fn quad(&mut self, corners: [u32; 4], chart: Chart) {
        self.faces.push(corners);
        self.charts.push(chart);
    }

    /// A band between two closed rings; the chart of each column's quad is asked for.
    fn band(&mut self, from: &[u32], to: &[u32], chart: impl Fn(usize) -> Chart) {
        for k in 0..from.len() {
            let n = (k + 1) % from.len();
            self.quad([from[k], from[n], to[n], to[k]], chart(k));
        }
    }

    // --- trunk and head

    /// Trunk, neck and head; the trunk's rows from the groin up.
    fn lay_trunk(&mut self, form: &Form) -> Vec<[u32; HALF]> {
        let grid = &form.drawing.grid;
        let even: [f32; HALF] = std::array::from_fn(|c| c as f32 * PI / 12.0);
        let face = grid.face.map(f32::to_radians);
        let last = grid.trunk.len() - 1;
        let hole = last - ABOVE_HOLE - HOLE_ROWS;
        let mut rows = Vec::new();
        for (r, row) in grid.trunk.iter().enumerate() {
            let inside = r > hole && r < hole + HOLE_ROWS;
            let lay = |c: usize| !(inside && (HOLE + 1..HOLE + HOLE_ROWS).contains(&c));
            rows.push(self.ring(form, row, &even, Region::Torso, 0.5, r, lay));
        }
        let trunk = rows.clone();
        let base = rows.len();
        for (r, row) in grid.head.iter().enumerate() {
            // The columns gather in front of the face by and by.
            let t = ((r + 1) as f32 / 4.0).min(1.0);
            let angles: [f32; HALF] = std::array::from_fn(|c| even[c] + (face[c] - even[c]) * t);
            let region = if r < 2 { Region::Torso } else { Region::Head };
            rows.push(self.ring(form, row, &angles, region, if r < 3 { 0.4 } else { 0.06 }, base + r, |_| true));
        }
        for pair in 0..rows.len() - 1 {
            for c in 0..HALF - 1 {
                let corners = [rows[pair][c], rows[pair][c + 1], rows[pair + 1][c + 1], rows[pair + 1][c]];
                let head = pair.checked_sub(base);
                let ear = c == EAR_COLUMN && head.is_some_and(|h| (EAR_ROWS[0]..EAR_ROWS[1]).contains(&h));
                let armhole = (hole..hole + HOLE_ROWS).contains(&pair) && (HOLE..HOLE + HOLE_ROWS).contains(&c);
                if ear || armhole {
                    continue;
                }
                let chart = match (head.is_some_and(|h| h >= 2), c) {
                    (true, 0..8) => Chart::Face,
                    (true, _) => Chart::Nape,
                    (false, 0..6) => Chart::Front,
                    (false, _) => Chart::Back,
                };
                self.quad(corners, chart);
            }
        }
        self.grow_ear(form, &rows[base..]);
        self.close_crown(form, &rows[rows.len() - 1]);
        trunk
    }

    #[expect(clippy::too_many_arguments, reason = "one ring's whole description, said once")]
    fn ring(
        &mut self,
        form: &Form,
        row: &GridRow,
        angles: &[f32; HALF],
        region: Region,
        slide: f32,
        index: usize,
        lay: impl Fn(usize) -> bool,
    ) -> [u32; HALF] {
        std::array::from_fn(|c| {
            if !lay(c) {
                return u32::MAX;
            }
            let (sin, cos) = angles[c].sin_cos();
            let [front, side, back] = row.y;
            let y = side + (front - side) * cos.max(0.0).powi(2) + (back - side) * cos.min(0.0).powi(2);
            let from = Vec3::new(0.0, y, row.z);
            let way = if c == 0 || c == HALF - 1 { Vec3::Z * cos.signum() } else { Vec3::new(sin, 0.0, cos) };
            let p = cast(from, way, |p| form.trunk(p));
            self.push(p, region, slide, index)
        })
    }

    /// A patch of 6 by 6 on the crown, its left half.
    fn close_crown(&mut self, form: &Form, rim: &[u32; HALF]) {
        // Rows of the patch run from front to back, columns from the middle out: the rim is its front, side and back.
        let mut patch = [[0u32; 4]; 7];
        for k in 0..4 {
            patch[0][k] = rim[k];
            patch[6][k] = rim[12 - k];
        }
        for r in 1..6 {
            patch[r][3] = rim[3 + r];
        }
        let at = |v: u32, points: &[Vec3]| points[v as usize];
        for r in 1..6 {
            for c in 0..3 {
                let t = r as f32 / 6.0;
                let along = at(patch[0][c], &self.points).lerp(at(patch[6][c], &self.points), t);
                let edge = at(patch[r][3], &self.points);
                let mut p = Vec3::new(edge.x * c as f32 / 3.0, edge.y, along.z + (edge.z - along.z) * c as f32 / 3.0);
                p = cast(Vec3::new(p.x, edge.y - 20.0, p.z), Vec3::Y, |p| form.trunk(p));
                patch[r][c] = self.push(p, Region::Head, 0.4, 99);
            }
        }
        for r in 0..6 {
            for c in 0..3 {
                self.quad([patch[r][c], patch[r][c + 1], patch[r + 1][c + 1], patch[r + 1][c]], Chart::Nape);
            }
        }
    }

    /// Draws the ear out of one column of the head.
    fn grow_ear(&mut self, form: &Form, head: &[[u32; HALF]]) {
        let (front, back) = (EAR_COLUMN, EAR_COLUMN + 1);
        let up = EAR_ROWS[0]..=EAR_ROWS[1];
        let rim: Vec<u32> = up.clone().map(|r| head[r][front]).chain(up.rev().map(|r| head[r][back])).collect();
        let middle = rim.iter().map(|&v| self.points[v as usize]).sum::<Vec3>() / rim.len() as f32;
        let [y, z, out] = form.drawing.grid.ear;
        let mut ring = rim;
        for (grow, away) in [(0.95, 0.35), (1.3, 0.85)] {
            let to = ring
                .iter()
                .map(|&v| {
                    let p = self.points[v as usize];
                    let spread = if grow > 1.0 { 1.37 } else { 0.95 };
                    let flat = Vec2::new(p.y - middle.y, p.z - middle.z) * spread;
                    // It leans back, and its rear stands further out.
                    let centre = Vec3::new(middle.x + out * away, y, z - 6.0 * away);
                    centre + Vec3::new(-0.45 * flat.y, flat.x, flat.y * 0.9)
                })
                .collect::<Vec<_>>();
            let to: Vec<u32> = to.into_iter().map(|p| self.push(p, Region::Head, 0.08, 99)).collect();
            self.band(&ring, &to, |_| Chart::Ear(false));
            ring = to;
        }
        let rows = EAR_ROWS[1] - EAR_ROWS[0];
        for r in 0..rows {
            let opposite = |r: usize| ring[2 * rows + 1 - r];
            self.quad([ring[r], ring[r + 1], opposite(r + 1), opposite(r)], Chart::Ear(false));
        }
    }

    // --- leg and foot

    fn lay_leg(&mut self, form: &Form, low: &[u32; HALF]) {
        let grid = &form.drawing.grid;
        let front = self.points[low[0] as usize];
        let back = self.points[low[HALF - 1] as usize];
        let strip: Vec<u32> = [0.75, 0.5, 0.25]
            .map(|t| {
                let hang = 1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0);
                let p = front.lerp(back, t) - Vec3::Y * 14.0 * hang;
                self.push(Vec3::new(0.0, p.y, p.z), Region::Torso, 0.5, 0)
            })
            .to_vec();
        let mut ring: Vec<u32> = low.iter().copied().chain(strip).collect();
        let joint = |p: [f32; 3]| Vec3::from(p);
        let j = &form.drawing.joints;
        let (hip, knee, ankle) = (joint(j.hip), joint(j.knee), joint(j.ankle));
        for (r, &y) in grid.leg.iter().enumerate() {
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
                .map(|p| self.push(p, Region::LeftLeg, 0.5, r + 1))
                .collect();
            self.band(&ring, &to, leg_chart);
            ring = to;
        }
        self.lay_foot(form, ring);
    }

    fn lay_foot(&mut self, form: &Form, mut ring: Vec<u32>) {
        let rings = form.drawing.grid.foot.clone();
        for (r, &[top_y, top_z, bottom_y, bottom_z, breadth]) in rings.iter().enumerate() {
            let to: Vec<u32> = (0..LEG)
                .map(|k| {
                    let (sin, cos) = leg_angle(k).sin_cos();
                    // Fuller than an ellipse, so that the columns that split into toes lie evenly.
                    let (s, c) = (sin.signum() * sin.abs().powf(0.7), cos.signum() * cos.abs().powf(0.7));
                    let t = 0.5 - 0.5 * c;
                    let p = Vec3::new(s * breadth, top_y + (bottom_y - top_y) * t, top_z + (bottom_z - top_z) * t);
                    form.foot_frame.out(p)
                })
                .map(|p| self.push(p, Region::LeftLeg, 0.35, 40 + r))
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
                self.push((up + down) * 0.5, Region::LeftLeg, 0.2, 60)
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

    // --- arm and hand

    fn lay_arm(&mut self, form: &Form, trunk: &[[u32; HALF]]) {
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
        for (r, &way) in grid.arm.iter().enumerate() {
            // The ring starts half a column in front of the top and has none left at the wrist.
            let twist = (15.0 * (1.0 - way / 500.0)).clamp(0.0, 15.0);
            let to: Vec<u32> = (0..ARM)
                .map(|k| {
                    let (sin, cos) = (k as f32 * 30.0 + twist).to_radians().sin_cos();
                    let q = cast(Vec3::X * way, Vec3::new(0.0, cos, sin), |q| form.arm(q));
                    form.bent(q)
                })
                .map(|p| self.push(p, Region::LeftArm, 0.5, r + 1))
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
                        10 | 11 => (across[if k == 10 { 4 } else { 3 }], 1.0),
                        0..3 => (across[2 - k], 1.0),
                        3 => (2.35, 0.0),
                        4..9 => (across[k - 4], -1.0),
                        _ => (-2.35, 0.0),
                    };
                    let way = if r == 4 { way - 2.2 * f.abs() * f.abs() } else { way };
                    let q = Vec3::new(way, u * 11.0, f * 15.5);
                    form.hand_frame.out(q)
                })
                .enumerate()
                .map(|(k, p)| if r == 2 && k == 3 { u32::MAX } else { self.push(p, Region::LeftArm, 0.35, 40 + r) })
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
                self.push((up + down) * 0.5, Region::LeftArm, 0.2, 60)
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

    /// A finger or toe: rings along its balls, closed by quads across its tip. The rim has six vertices, of which the
    /// first two lie on the nail's side, or eight, of which the first three do.
    fn lay_digit(&mut self, rim: &[u32], digit: &Digit<'_>) {
        let n = rim.len();
        let chart = |k: usize| digit.charts[usize::from(k >= n / 3 + n / 8 && k < n - 1)];
        let mut ring = rim.to_vec();
        // The last ring stands round the tip's ball, beyond its middle, so that the quads across it close a dome.
        let last = on_chain(digit.balls, 1.0);
        let dome = (last.0 + last.2 * (0.6 * last.1), 0.75 * last.1, last.2);
        for (centre, radius, along) in digit.ways.iter().map(|&w| on_chain(digit.balls, w)).chain([dome]) {
            let nail = digit.nail.reject_from_normalized(along).normalize();
            let side = nail.cross(along).normalize();
            let side = if side.dot(digit.side) < 0.0 { -side } else { side };
            // The middle of the nail's side stands at angle 0.
            let middle = if n == 6 { 0.5 } else { 1.0 };
            let angle = |k: usize| (k as f32 - middle) / n as f32 * 2.0 * PI;
            let to: Vec<u32> = (0..n)
                .map(|k| centre + (nail * angle(k).cos() + side * angle(k).sin()) * radius)
                .map(|p| self.push(p, digit.region, 0.06, 61))
                .collect();
            self.band(&ring, &to, chart);
            ring = to;
        }
        if n == 6 {
            self.quad([ring[0], ring[1], ring[2], ring[5]], digit.charts[0]);
            self.quad([ring[5], ring[2], ring[3], ring[4]], digit.charts[1]);
            return;
        }
        let [.., (before, _), (tip, radius)] = digit.balls else { return };
        let middle = self.push(*tip + (*tip - *before).normalize() * *radius, digit.region, 0.06, 61);
        for k in [0, 2, 4, 6] {
            self.quad([ring[k], ring[k + 1], middle, ring[(k + 7) % 8]], digit.charts[k / 4]);
        }
    }

    // --- the whole

    /// Turns faces so that neighbours run against each other along their common edge, and all look outwards.
    fn orient(&mut self) {
        let mut sides: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        for (f, q) in self.faces.iter().enumerate() {
            for k in 0..4 {
                let (a, b) = (q[k], q[(k + 1) % 4]);
                sides.entry((a.min(b), a.max(b))).or_default().push(f);
            }
        }
        // The first face lies in front of the groin: it must look forwards.
        let normal = |q: &[u32; 4], points: &[Vec3]| {
            let p = q.map(|v| points[v as usize]);
            (p[2] - p[0]).cross(p[3] - p[1])
        };
        let mut done = vec![false; self.faces.len()];
        let mut queue = vec![0usize];
        done[0] = true;
        if normal(&self.faces[0], &self.points).z < 0.0 {
            self.faces[0] = flipped(self.faces[0]);
        }
        while let Some(f) = queue.pop() {
            let q = self.faces[f];
            for k in 0..4 {
                let (a, b) = (q[k], q[(k + 1) % 4]);
                for &other in &sides[&(a.min(b), a.max(b))] {
                    if done[other] {
                        continue;
                    }
                    let o = self.faces[other];
                    if (0..4).any(|j| (o[j], o[(j + 1) % 4]) == (a, b)) {
                        self.faces[other] = flipped(o);
                    }
                    done[other] = true;
                    queue.push(other);
                }
            }
        }
        assert!(done.iter().all(|&d| d), "the half cage is one piece");
    }

    /// The left half with its mirror image.
    fn mirrored(mut self) -> Self {
        let left = self.points.len();
        let middle = |p: Vec3| p.x.abs() < 1e-6;
        let mut twins: Vec<u32> = (0..left as u32).collect();
        for v in 0..left {
            if middle(self.points[v]) {
                self.points[v].x = 0.0;
                continue;
            }
            let p = self.points[v];
            twins[v] = self.points.len() as u32;
            self.points.push(Vec3::new(-p.x, p.y, p.z));
            let region = match self.tags[v].region {
                Region::LeftArm => Region::RightArm,
                Region::LeftLeg => Region::RightLeg,
                both => both,
            };
            self.tags.push(Tag { region, ..self.tags[v] });
            twins.push(v as u32);
        }
        for f in 0..self.faces.len() {
            let q = flipped(self.faces[f]).map(|v| twins[v as usize]);
            self.faces.push(q);
            let chart = self.charts[f].mirror();
            self.charts.push(chart);
        }
        Self { twins, ..self }
    }
}

/// A finger or toe to be laid.
struct Digit<'a> {
    /// Its form: centres and radii.
    balls: &'a [(Vec3, f32)],
    /// Where its rings lie, shares of its length.
    ways: &'a [f32],
    /// Direction of its nail, and of the side that its rim reaches after the nail's.
    nail: Vec3,
    side: Vec3,
    region: Region,
    /// Of the nail's half and of the other.
    charts: [Chart; 2],
}

/// A quad run the other way, from the same first corner: its mirror image splits along the same diagonal.
fn flipped([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    [a, d, c, b]
}

/// Angle of a leg's column from the front, outwards: columns 0 to 12 are the trunk's, 2 looks ahead.
fn leg_angle(column: usize) -> f32 {
    (column as f32 - 2.0) * PI / 8.0
}

fn leg_chart(column: usize) -> Chart {
    if (6..14).contains(&column) { Chart::LegBack(false) } else { Chart::LegFront(false) }
}

fn arm_chart(column: usize) -> Chart {
    if (3..9).contains(&column) { Chart::ArmLower(false) } else { Chart::ArmUpper(false) }
}

/// Where a ray from inside leaves a form (mm): marched in steps, then halved.
fn cast(from: Vec3, way: Vec3, distance: impl Fn(Vec3) -> f32) -> Vec3 {
    const STEP: f32 = 2.0;
    let mut far = STEP;
    while far < 400.0 && distance(from + way * far) < 0.0 {
        far += STEP;
    }
    let mut near = far - STEP;
    for _ in 0..12 {
        let middle = 0.5 * (near + far);
        if distance(from + way * middle) < 0.0 { near = middle } else { far = middle }
    }
    from + way * near
}

/// Centre, radius and direction a share of the way along a chain of balls.
fn on_chain(balls: &[(Vec3, f32)], share: f32) -> (Vec3, f32, Vec3) {
    let lengths: Vec<f32> = balls.windows(2).map(|w| w[0].0.distance(w[1].0)).collect();
    let mut left = share * lengths.iter().sum::<f32>();
    let mut k = 0;
    while k + 1 < lengths.len() && left > lengths[k] {
        left -= lengths[k];
        k += 1;
    }
    let ([(a, ra), (b, rb)], t) = ([balls[k], balls[k + 1]], left / lengths[k]);
    (a.lerp(b, t), ra + (rb - ra) * t.min(1.0), (b - a) / lengths[k])
}
