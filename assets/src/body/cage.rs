//! The cage: rings of surface points joined into quads, stretched to a size.
//!
//! Torso rings of 12 climb from the crotch to the crown. Between the legs one vertex bridges the front and the back of
//! the lowest ring, so that each leg starts from a ring of 8. The two columns and two bands that an arm needs are left
//! open on each side: their rim is a ring of 8, too.

use glam::Vec3;

use super::Region;
use super::table::{ArmRow, LegRow, Table, TorsoRow};
use crate::skeleton::{JOINTS, Joint, Skeleton};

/// Rows of the torso table that the code names.
pub(super) mod row {
    pub const CROTCH: usize = 0;
    pub const HIP: usize = 1;
    pub const ARMPIT: usize = 6;
    pub const SCYE: usize = 7;
    pub const SHOULDER: usize = 8;
    pub const TRAPEZIUS: usize = 9;
    pub const JAW: usize = 12;
}

/// The knee's row of the leg table.
pub(super) const KNEE: usize = 2;

/// Columns of a torso ring, and of a limb's.
pub(super) const AROUND: usize = 12;
pub(super) const LIMB: usize = 8;
/// Column of the one vertex that bridges the legs, in the lowest row.
pub(super) const BRIDGE: usize = AROUND;
const NONE: u32 = u32::MAX;

/// How far a body departs from its sex's drawing: factors, all 1 for the drawing itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Of everything.
    pub scale: f32,
    /// Of breadths and depths besides.
    pub chest: f32,
    pub waist: f32,
    pub hip: f32,
    pub shoulder: f32,
}

/// Where a cage vertex belongs: its part of the body and its place there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub region: Region,
    /// Row of the torso table, or ring of the limb.
    pub row: usize,
    /// Column 0..12 of the torso, 0..8 of a limb; the crotch's point is [`BRIDGE`].
    pub column: usize,
}

/// The cage of one body.
#[derive(Debug, Default)]
pub(super) struct Cage {
    /// Points that the surface passes through (m).
    pub points: Vec<Vec3>,
    pub places: Vec<Place>,
    pub faces: Vec<[u32; 4]>,
    /// Torso vertices `[rows][12]`; `u32::MAX` where an arm grows.
    pub torso: Vec<[u32; AROUND]>,
}

/// A side of the body: the drawing is its left.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

impl Side {
    fn column(self, left: usize) -> usize {
        if self == Self::Left { left } else { (AROUND - left) % AROUND }
    }

    fn point(self, p: Vec3) -> Vec3 {
        if self == Self::Left { p } else { Vec3::new(-p.x, p.y, p.z) }
    }

    fn region(self, left: Region) -> Region {
        match (self, left) {
            (Self::Right, Region::LeftArm) => Region::RightArm,
            (Self::Right, Region::LeftLeg) => Region::RightLeg,
            _ => left,
        }
    }

    /// A quad of the left side as it winds here, from the same first corner.
    fn quad(self, [a, b, c, d]: [u32; 4]) -> [u32; 4] {
        if self == Self::Left { [a, b, c, d] } else { [a, d, c, b] }
    }
}

impl Cage {
    /// Lays out a body: the same vertices and faces whatever the shape.
    pub(super) fn new(table: &Table, shape: &Shape) -> Self {
        let mut cage = Self::default();
        cage.lay_torso(table, shape);
        let bridge = cage.push(shape.crotch(table), Region::Torso, row::CROTCH, BRIDGE);
        for side in [Side::Left, Side::Right] {
            cage.lay_leg(table, shape, side, bridge);
            cage.lay_arm(table, shape, side);
        }
        cage
    }

    fn push(&mut self, point: Vec3, region: Region, row: usize, column: usize) -> u32 {
        self.points.push(point);
        self.places.push(Place { region, row, column });
        self.points.len() as u32 - 1
    }

    fn lay_torso(&mut self, table: &Table, shape: &Shape) {
        for (r, line) in table.torso.iter().enumerate() {
            let region = if r < row::JAW { Region::Torso } else { Region::Head };
            let ring = std::array::from_fn(|c| {
                let (side, left) = if c <= 6 { (Side::Left, c) } else { (Side::Right, AROUND - c) };
                let index = match (r, left) {
                    (row::SCYE, 3) => return NONE,
                    (row::SCYE, 4..) => left - 1,
                    _ => left,
                };
                self.push(side.point(shape.torso(line, line.points[index])), region, r, c)
            });
            self.torso.push(ring);
        }
        for pair in 0..self.torso.len() - 1 {
            let (low, high) = (self.torso[pair], self.torso[pair + 1]);
            for side in [Side::Left, Side::Right] {
                for c in 0..6 {
                    let (a, b) = (side.column(c), side.column(c + 1));
                    if [low[a], low[b], high[a], high[b]].contains(&NONE) {
                        continue;
                    }
                    self.faces.push(side.quad([low[a], low[b], high[b], high[a]]));
                }
            }
        }
        self.close_head(table, shape);
    }

    fn close_head(&mut self, table: &Table, shape: &Shape) {
        let rim = self.torso[self.torso.len() - 1];
        let rows = self.torso.len();
        let top = [0, 1, 2].map(|k| self.push(shape.fixed(table.head.top[k]), Region::Head, rows, k));
        let middle = [rim[0], top[0], top[1], top[2], rim[6]];
        for side in [Side::Left, Side::Right] {
            for k in 0..4 {
                let (a, b) = (rim[side.column(k + 1)], rim[side.column(k + 2)]);
                self.faces.push(side.quad([middle[k], a, b, middle[k + 1]]));
            }
        }
    }

    /// One limb ring, with the band that joins it to the ring before.
    fn lay_ring(
        &mut self,
        side: Side,
        from: &[u32; LIMB],
        ring: &[Vec3; LIMB],
        region: Region,
        row: usize,
    ) -> [u32; LIMB] {
        let to = std::array::from_fn(|k| self.push(side.point(ring[k]), side.region(region), row, k));
        for k in 0..LIMB {
            let n = (k + 1) % LIMB;
            // An arm's rim winds against its own end, a leg's with it.
            let quad = match region {
                Region::LeftArm => [from[k], from[n], to[n], to[k]],
                _ => [from[n], from[k], to[k], to[n]],
            };
            self.faces.push(side.quad(quad));
        }
        to
    }

    fn lay_leg(&mut self, table: &Table, shape: &Shape, side: Side, bridge: u32) {
        let low = self.torso[row::CROTCH];
        let mut ring: [u32; LIMB] = std::array::from_fn(|k| if k < 7 { low[side.column(k)] } else { bridge });
        let rings =
            table.leg.iter().map(|r| shape.leg(table, r)).chain(table.foot.rings.iter().map(|r| shape.foot(table, r)));
        for (k, points) in rings.enumerate() {
            ring = self.lay_ring(side, &ring, &points, Region::LeftLeg, k);
        }
        let last = table.leg.len() + table.foot.rings.len();
        let tip = self.push(side.point(shape.foot_point(table, table.foot.tip)), side.region(Region::LeftLeg), last, 0);
        for k in [0, 2, 4, 6] {
            self.faces.push(side.quad([tip, ring[(k + 2) % LIMB], ring[k + 1], ring[k]]));
        }
    }

    fn lay_arm(&mut self, table: &Table, shape: &Shape, side: Side) {
        let rim = [(3, row::SHOULDER), (2, row::SHOULDER), (2, row::SCYE), (2, row::ARMPIT)];
        let back = [(3, row::ARMPIT), (4, row::ARMPIT), (4, row::SCYE), (4, row::SHOULDER)];
        let rim: Vec<u32> = rim.iter().chain(&back).map(|&(c, r)| self.torso[r][side.column(c)]).collect();
        let mut ring: [u32; LIMB] = std::array::from_fn(|k| rim[k]);
        let arm = ArmAxes::new(table, shape);
        let palm = table.arm.ring.len() - 3;
        for (k, line) in table.arm.ring.iter().enumerate() {
            let from = ring;
            ring = self.lay_ring(side, &from, &arm.ring(line, shape), Region::LeftArm, k);
            if k == palm + 1 {
                self.grow_thumb(table, &arm, side, [from[2], from[3], ring[3], ring[2]]);
            }
        }
        let end = arm.point(table.arm.tip.along, 0.0, 0.0);
        let tip = self.push(side.point(end), side.region(Region::LeftArm), table.arm.ring.len(), 0);
        for k in [0, 2, 4, 6] {
            self.faces.push(side.quad([tip, ring[k], ring[k + 1], ring[(k + 2) % LIMB]]));
        }
    }

    /// Draws the thumb out of one face of the palm.
    fn grow_thumb(&mut self, table: &Table, arm: &ArmAxes, side: Side, root: [u32; 4]) {
        let wanted = side.quad(root);
        let face = self.faces.iter().rposition(|f| *f == wanted).expect("the palm has just been laid");
        self.faces.remove(face);
        let wrist = table.arm.upper + table.arm.fore;
        let mut ring = root;
        for points in &table.arm.thumb.rings {
            let to = points
                .map(|[along, up, front]| arm.point(wrist + along, up, front))
                .map(|p| self.push(side.point(p), side.region(Region::LeftArm), table.arm.ring.len() - 1, 0));
            for k in 0..4 {
                let n = (k + 1) % 4;
                self.faces.push(side.quad([ring[k], ring[n], to[n], to[k]]));
            }
            ring = to;
        }
        self.faces.push(side.quad(ring));
    }
}

const MM: f32 = 1e-3;

impl Shape {
    /// The drawing as it is.
    pub(super) fn drawn() -> Self {
        Self { scale: 1.0, chest: 1.0, waist: 1.0, hip: 1.0, shoulder: 1.0 }
    }

    /// Breadth and depth factors of a torso row.
    fn factors(&self, line: &TorsoRow) -> (f32, f32) {
        let [chest, waist, hip, shoulder] = line.follow;
        let depth = chest * (self.chest - 1.0) + waist * (self.waist - 1.0) + hip * (self.hip - 1.0);
        (1.0 + depth + shoulder * (self.shoulder - 1.0), 1.0 + depth)
    }

    fn torso(&self, line: &TorsoRow, p: [f32; 3]) -> Vec3 {
        let (breadth, depth) = self.factors(line);
        // A belly grows forwards more than a back does backwards.
        let belly = line.follow[1] * (self.waist - 1.0).max(0.0) * 0.3;
        let depth = if p[2] > 0.0 { depth + belly } else { depth - 0.7 * belly };
        Vec3::new(p[0] * breadth, p[1], p[2] * depth) * (self.scale * MM)
    }

    /// A point that only stature moves.
    fn fixed(&self, p: [f32; 3]) -> Vec3 {
        Vec3::from(p) * (self.scale * MM)
    }

    fn crotch(&self, table: &Table) -> Vec3 {
        self.fixed(table.crotch.point)
    }

    /// Growth and outward shift (mm of the drawing) of a leg's ring: the gap between the thighs stays.
    fn leg_growth(&self, table: &Table, line: &LegRow) -> (f32, f32) {
        let grow = line.grow * (self.hip - 1.0);
        let own = line.radii[2] * grow;
        let thigh = table.leg[0].radii[2] * table.leg[0].grow * (self.hip - 1.0);
        (1.0 + grow, own + 0.35 * (thigh - own))
    }

    fn leg(&self, table: &Table, line: &LegRow) -> [Vec3; LIMB] {
        let (grow, shift) = self.leg_growth(table, line);
        let [out, front, inner, back] = line.radii.map(|r| r * grow);
        ellipse([inner, front, out, back]).map(|[x, z]| {
            // ellipse() starts at its first radius; the leg's columns start between inner and front.
            Vec3::new(line.centre[0] + shift - x, line.y, line.centre[1] + z) * (self.scale * MM)
        })
    }

    fn foot(&self, table: &Table, ring: &[[f32; 3]; LIMB]) -> [Vec3; LIMB] {
        ring.map(|p| self.foot_point(table, p))
    }

    fn foot_point(&self, table: &Table, p: [f32; 3]) -> Vec3 {
        let ankle = &table.leg[table.leg.len() - 1];
        let shift = self.leg_growth(table, ankle).1;
        Vec3::new(ankle.centre[0] + shift + p[0], p[1], ankle.centre[1] + p[2]) * (self.scale * MM)
    }

    /// How much further out the arms hang because the chest has outgrown the shoulders (mm of the drawing).
    fn arm_push(&self, table: &Table) -> f32 {
        let (armpit, tip) = (&table.torso[row::ARMPIT], &table.torso[row::SHOULDER]);
        let outgrown =
            armpit.points[3][0] * (self.factors(armpit).0 - 1.0) - tip.points[3][0] * (self.factors(tip).0 - 1.0);
        (0.8 * outgrown).max(0.0)
    }

    /// The skeleton of this shape.
    pub(super) fn skeleton(&self, table: &Table) -> Skeleton {
        use Joint::*;
        let j = &table.joints;
        let mut rest = [Vec3::ZERO; JOINTS];
        let mut set = |joint: Joint, p: Vec3| {
            rest[joint.index()] = p;
            if joint.mirror() != joint {
                rest[joint.mirror().index()] = Side::Right.point(p);
            }
        };
        for (joint, p) in [(Pelvis, j.pelvis), (Spine, j.spine), (Chest, j.chest), (Neck, j.neck), (Head, j.head)] {
            set(joint, self.fixed(p));
        }
        let arm = ArmAxes::new(table, self);
        set(LeftClavicle, self.fixed(j.clavicle));
        set(LeftShoulder, arm.shoulder);
        set(LeftElbow, arm.elbow);
        set(LeftWrist, arm.wrist);
        set(LeftHand, arm.point(table.arm.upper + table.arm.fore + table.arm.hand, 0.0, 0.0));
        let growth = |k: usize| self.leg_growth(table, &table.leg[k]).1;
        let outwards = |p: [f32; 3], shift: f32| self.fixed([p[0] + shift, p[1], p[2]]);
        set(LeftHip, outwards(j.hip, growth(0)));
        set(LeftKnee, outwards(j.knee, growth(KNEE)));
        set(LeftAnkle, outwards(j.ankle, growth(table.leg.len() - 1)));
        set(LeftToe, outwards(j.toe, growth(table.leg.len() - 1)));
        Skeleton { rest }
    }
}

/// The left arm's frame: joints, and the directions along, up and front of each half.
struct ArmAxes {
    shoulder: Vec3,
    elbow: Vec3,
    wrist: Vec3,
    along: [Vec3; 2],
    up: [Vec3; 2],
    front: [Vec3; 2],
    unit: f32,
    upper: f32,
}

impl ArmAxes {
    fn new(table: &Table, shape: &Shape) -> Self {
        let unit = shape.scale * MM;
        let arm = &table.arm;
        let along = [0, 1].map(|k| {
            let (down, forward) = (arm.degrees_down[k].to_radians(), arm.degrees_forward[k].to_radians());
            Vec3::new(down.cos() * forward.cos(), -down.sin() * forward.cos(), forward.sin())
        });
        let up = along.map(|d| (Vec3::Z.cross(d)).normalize());
        let front = [0, 1].map(|k| along[k].cross(up[k]).normalize());
        let breadth = shape.factors(&table.torso[row::SHOULDER]).0;
        let j = table.joints.shoulder;
        let shoulder = Vec3::new(j[0] * breadth, j[1], j[2]) * unit;
        let push = Vec3::X * (shape.arm_push(table) * unit);
        let elbow = shoulder + push + along[0] * (arm.upper * unit);
        let wrist = elbow + along[1] * (arm.fore * unit);
        Self { shoulder, elbow, wrist, along, up, front, unit, upper: arm.upper }
    }

    /// A point beside the arm's line: `along` from the shoulder, then up and to the front (mm of the drawing).
    fn point(&self, along: f32, up: f32, front: f32) -> Vec3 {
        let way = along - self.upper;
        // At the elbow the ring stands on the plane that halves the bend.
        let half = usize::from(way > 0.0);
        let blend = if way == 0.0 { 0.5 } else { half as f32 };
        let (u, f) = (self.up[0].lerp(self.up[1], blend), self.front[0].lerp(self.front[1], blend));
        self.elbow + (self.along[half] * way + u * up + f * front) * self.unit
    }

    fn ring(&self, line: &ArmRow, shape: &Shape) -> [Vec3; LIMB] {
        let grow = 1.0 + line.grow * (0.7 * (shape.chest - 1.0) + 0.3 * (shape.waist - 1.0));
        let [up, front, down, back] = line.radii.map(|r| r * grow);
        let corners = ellipse([up, front, down, back]);
        // ellipse() starts on the diagonal; the arm's columns start on top.
        std::array::from_fn(|k| {
            let [u, f] = corners[(k + 7) % LIMB];
            self.point(line.along, u, f)
        })
    }
}

/// Eight points around a section of four quarter ellipses with radii +a, +b, -a, -b, from the diagonal between the
/// first two radii: (a b), b, (b -a), -a, (-a -b), -b, (-b a), a.
fn ellipse([a, b, c, d]: [f32; 4]) -> [[f32; 2]; LIMB] {
    // A little fuller than an ellipse (0.707), as limbs are.
    const DIAGONAL: f32 = 0.725;
    let q = DIAGONAL;
    [[q * a, q * b], [0.0, b], [-q * c, q * b], [-c, 0.0], [-q * c, -q * d], [0.0, -d], [q * a, -q * d], [a, 0.0]]
}
