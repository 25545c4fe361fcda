//! A sex's drawing as its file has it, and the form made from it.

use glam::{Mat3, Vec3};
use serde::Deserialize;

use super::group::{Frame, Group, GroupRow};
use super::parts::{smooth_max, smooth_min};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

/// One sex's drawing; lengths in millimetres, x left, y up, z forwards.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drawing {
    /// Height that it is drawn at.
    #[serde(rename = "stature")]
    _stature: f32,
    pub(crate) joints: Joints,
    pub(crate) arm_line: ArmLine,
    pub(crate) foot_line: FootLine,
    pub(crate) grid: Grid,
    trunk: GroupRow,
    leg: GroupRow,
    foot: GroupRow,
    arm: GroupRow,
    hand: GroupRow,
    /// Radii of the fillets where leg, foot, arm and hand join on.
    fillets: [f32; 4],
}

/// Joint centres; the arm's follow from its lengths and angles.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Joints {
    pub pelvis: [f32; 3],
    pub spine: [f32; 3],
    pub chest: [f32; 3],
    pub neck: [f32; 3],
    pub head: [f32; 3],
    pub clavicle: [f32; 3],
    pub shoulder: [f32; 3],
    pub hip: [f32; 3],
    pub knee: [f32; 3],
    pub ankle: [f32; 3],
    pub toe: [f32; 3],
}

/// The arm: shoulder to elbow, elbow to wrist, wrist to knuckles; angles below the horizontal, then forwards, of upper
/// arm and forearm (degrees).
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ArmLine {
    pub upper: f32,
    pub fore: f32,
    pub hand: f32,
    pub degrees_down: [f32; 2],
    pub degrees_forward: [f32; 2],
}

/// Where the foot's frame stands on the floor (x, z) and how far it turns outwards (degrees).
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FootLine {
    at: [f32; 2],
    outwards: f32,
}

/// A ring of the trunk's or the head's grid.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridRow {
    /// Heights in front, at the side and behind.
    pub y: [f32; 3],
    /// Start of its rays (z).
    pub z: f32,
}

/// Where the quads' rings lie.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Grid {
    /// From the groin up to the base of the neck.
    pub trunk: Vec<GridRow>,
    /// From above the base of the neck up to the rim of the crown.
    pub head: Vec<GridRow>,
    /// Angles of the columns of the head, from the front's middle to the back's (degrees).
    pub face: [f32; 13],
    /// Heights of the leg's rings.
    pub leg: Vec<f32>,
    /// Rings of the foot: top (y, z), bottom (y, z), half breadth, and how far the outer edge lies behind the inner
    /// one, in the foot's frame.
    pub foot: Vec<[f32; 6]>,
    /// Ways down the arm of its rings, from the shoulder.
    pub arm: Vec<f32>,
    /// Ways down the palm of its rings, from the wrist; the last is the web.
    pub palm: [f32; 5],
    /// Ways along a finger (share of its length) of its rings.
    pub finger: Vec<f32>,
    pub thumb: Vec<f32>,
    pub toe: Vec<f32>,
    /// Centre of the ear, and how far it stands out.
    pub ear: [f32; 3],
}

/// A body's form: every part in its place.
#[derive(Debug)]
pub struct Form {
    pub(crate) drawing: Drawing,
    trunk: Group,
    leg: Group,
    foot: Group,
    arm: Group,
    hand: Group,
    pub(crate) foot_frame: Frame,
    pub(crate) arm_frame: Frame,
    pub(crate) hand_frame: Frame,
    /// Elbow in the arm's frame, and the whole length.
    elbow: Vec3,
    reach: f32,
}

/// Beyond this a group is not asked (mm).
const FAR: f32 = 120.0;

impl Form {
    /// Puts a drawing's parts together.
    pub fn new(drawing: Drawing) -> Self {
        let line = &drawing.arm_line;
        let along = [0, 1].map(|k| {
            let (down, forward) = (line.degrees_down[k].to_radians(), line.degrees_forward[k].to_radians());
            Vec3::new(down.cos() * forward.cos(), -down.sin() * forward.cos(), forward.sin())
        });
        let shoulder = Vec3::from(drawing.joints.shoulder);
        let bend = shoulder + along[0] * line.upper;
        let wrist = bend + along[1] * line.fore;
        let arm_frame = Frame { origin: shoulder, axes: limb_axes((wrist - shoulder).normalize()) };
        let hand_frame = Frame { origin: wrist, axes: limb_axes(along[1]) };
        let (sin, cos) = drawing.foot_line.outwards.to_radians().sin_cos();
        let [x, z] = drawing.foot_line.at;
        let foot_axes = Mat3::from_cols(Vec3::new(cos, 0.0, -sin), Vec3::Y, Vec3::new(sin, 0.0, cos));
        Self {
            trunk: Group::new(&drawing.trunk, true),
            leg: Group::new(&drawing.leg, false),
            foot: Group::new(&drawing.foot, false),
            arm: Group::new(&drawing.arm, false),
            hand: Group::new(&drawing.hand, false),
            foot_frame: Frame { origin: Vec3::new(x, 0.0, z), axes: foot_axes },
            arm_frame,
            hand_frame,
            elbow: arm_frame.inward(bend),
            reach: wrist.distance(shoulder),
            drawing,
        }
    }

    /// The arm's frame with its bend taken out: x down the arm, y away from the body, z to the front.
    pub(crate) fn straightened(&self, p: Vec3) -> Vec3 {
        let q = self.arm_frame.inward(p);
        q - self.bow(q.x)
    }

    /// The inverse of [`Form::straightened`]: a point of the straight arm back on the bowed one (m).
    pub(crate) fn bent(&self, q: Vec3) -> Vec3 {
        self.arm_frame.out(q + self.bow(q.x))
    }

    /// How far the arm's line lies off the chord: a hat with its tip rounded.
    fn bow(&self, way: f32) -> Vec3 {
        const ROUNDED: f32 = 15.0;
        let off = way - self.elbow.x;
        let side = if off < 0.0 { self.elbow.x } else { self.reach - self.elbow.x };
        let hat = 1.0 - (off.hypot(ROUNDED) - ROUNDED) / side;
        Vec3::new(0.0, self.elbow.y, self.elbow.z) * hat.max(0.0)
    }

    /// Distance of the whole left half, asked on either side (mm).
    pub(crate) fn distance(&self, p: Vec3) -> f32 {
        let p = Vec3::new(p.x.abs(), p.y, p.z);
        let [leg, foot, arm, hand] = self.drawing.fillets;
        let mut d = self.trunk(p);
        let crotch = self.drawing.joints.hip[1];
        if p.y < crotch + FAR {
            let mut limb = self.leg.distance(p);
            if p.y < FAR {
                let foot_d = smooth_max(self.foot.distance(self.foot_frame.inward(p)), -p.y, 5.0);
                limb = smooth_min(limb, foot_d, foot);
                limb = limb.max(-p.y);
            }
            d = smooth_min(d, limb, leg);
        }
        if p.x > 0.6 * self.drawing.joints.shoulder[0] {
            let q = self.straightened(p);
            if q.x > -FAR {
                let mut limb = self.arm.distance(q);
                if q.x > self.reach - 0.7 * FAR {
                    limb = smooth_min(limb, self.hand.distance(self.hand_frame.inward(p)), hand);
                }
                d = smooth_min(d, limb, arm);
            }
        }
        d
    }

    /// Distance of the trunk with neck and head alone.
    pub(crate) fn trunk(&self, p: Vec3) -> f32 {
        self.trunk.distance(p)
    }

    /// Distance of the leg alone.
    pub(crate) fn leg(&self, p: Vec3) -> f32 {
        self.leg.distance(p)
    }

    /// Distance of the arm alone, at a place in its straightened frame.
    pub(crate) fn arm(&self, q: Vec3) -> f32 {
        self.arm.distance(q)
    }

    /// The balls of a finger: 0 the index finger .. 3 the little one, 4 the thumb; in the hand's frame.
    pub(crate) fn finger(&self, k: usize) -> Vec<(Vec3, f32)> {
        self.hand.digit(k)
    }

    /// The balls of a toe, 0 the big one; in the foot's frame.
    pub(crate) fn toe(&self, k: usize) -> Vec<(Vec3, f32)> {
        self.foot.digit(k)
    }

    /// The skeleton whose joints the drawing has (m).
    pub(crate) fn skeleton(&self) -> Skeleton {
        use Joint::*;
        let j = &self.drawing.joints;
        let mut rest = [Vec3::ZERO; JOINTS];
        let mut set = |joint: Joint, p: Vec3| {
            rest[joint.index()] = p * 1e-3;
            if joint.mirror() != joint {
                rest[joint.mirror().index()] = Vec3::new(-p.x, p.y, p.z) * 1e-3;
            }
        };
        for (joint, p) in [(Pelvis, j.pelvis), (Spine, j.spine), (Chest, j.chest), (Neck, j.neck), (Head, j.head)] {
            set(joint, p.into());
        }
        for (joint, p) in [(LeftClavicle, j.clavicle), (LeftShoulder, j.shoulder), (LeftHip, j.hip)] {
            set(joint, p.into());
        }
        for (joint, p) in [(LeftKnee, j.knee), (LeftAnkle, j.ankle), (LeftToe, j.toe)] {
            set(joint, p.into());
        }
        set(LeftElbow, self.arm_frame.out(self.elbow));
        set(LeftWrist, self.hand_frame.origin);
        set(LeftHand, self.hand_frame.out(Vec3::X * self.drawing.arm_line.hand));
        Skeleton { rest }
    }

    /// Direction of steepest growth, unit length, and its steepness.
    pub(crate) fn slope(&self, p: Vec3) -> (Vec3, f32) {
        const STEP: f32 = 0.25;
        let corners = [[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]].map(Vec3::from);
        let sum: Vec3 = corners.iter().map(|&c| c * self.distance(p + c * STEP)).sum();
        let slope = sum / (4.0 * STEP);
        let steep = slope.length();
        (slope / steep.max(1e-6), steep)
    }
}

/// Axes of a limb that points along `along`: x along, y away from the body, z to the front.
fn limb_axes(along: Vec3) -> Mat3 {
    let up = Vec3::Z.cross(along).normalize();
    Mat3::from_cols(along, up, along.cross(up).normalize())
}
