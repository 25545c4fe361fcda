//! Pelvis, spine, chest, neck, head and collar bones: two frames, and the bend between them.
//!
//! Hips and waist span the pelvis' frame, shoulders and neck the chest's; what lies between is shared by spine and
//! chest. The line from hips to neck is taken as it is; how the trunk is bowed along it, how the neck leans and how the
//! shoulders hang depends more on the sensor than on the person, and is compared with what was [learned](Neutral).

use glam::{Mat3, Quat, Vec3};
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

use super::body_input::BodyInput;
use super::kinematics::swing_twist;
use super::limits::{self, Side};
use super::neutral::Neutral;
use super::reliable_joints::{ReliableJoints, unit};
use super::smooth::{rotation_vector, wrap};

/// Time constant with which the head follows the chest's turn (s): eyes stay on the mirror a moment longer.
const HEAD_TAU: f32 = 0.25;

/// Furthest the head lags behind the chest (rad).
const HEAD_LAG: f32 = 0.5;

/// Level part of the chest's forward (unit vector) below which a bow leaves no heading.
const MIN_HEADING: f32 = 0.3;

/// Lift of the collar bone when the arm is straight up (rad), used where no sensor joint shows it: of the arm's last
/// 90 degrees a third is the shoulder blade's (Inman, Saunders and Abbott 1944), and most of that the collar bone's.
const CLAVICLE_LIFT: f32 = 0.4;

/// Where a joint must lie between hips and neck, as a share of their distance, to tell lower from upper trunk.
const WAIST: [f32; 2] = [0.2, 0.8];

/// Splits the turn of the trunk between its lower and its upper part.
#[derive(Debug, Clone)]
pub struct Trunk {
    rest: ReliableJoints,
    /// How much more the chest must turn than the line from waist to neck, as only its upper part turns fully.
    gain: f32,
    bow: Neutral,
    neck: Neutral,
    shoulders: Neutral,
    head_yaw: f32,
}

/// Pelvis and chest as shown, and the length (m) of lower and upper trunk.
struct Frames {
    pelvis: Quat,
    chest: Quat,
    lower: f32,
    upper: f32,
}

impl Trunk {
    /// A trunk at rest.
    pub fn new(skeleton: &Skeleton) -> Self {
        let length = |joint| skeleton.offset(joint).length();
        let (low, high) = (length(Joint::Chest), length(Joint::Neck));
        Self {
            rest: ReliableJoints::rest(skeleton),
            gain: ((low + high) / (0.5 * low + high).max(1e-3)).clamp(1.0, 2.0),
            bow: Neutral::default(),
            neck: Neutral::default(),
            shoulders: Neutral::default(),
            head_yaw: 0.0,
        }
    }

    /// Aims pelvis, spine, chest, neck and head; returns the rotations of pelvis and chest in the world.
    pub fn update(&mut self, now: BodyInput, local: &mut [Quat; JOINTS]) -> (Quat, Quat) {
        let (seen, dt) = (now.seen, now.dt);
        let [pelvis, spine, chest] = [Joint::Pelvis, Joint::Spine, Joint::Chest].map(Joint::index);
        if let Some(frames) = self.frames(seen) {
            let bend = self.straighten(&frames, dt, &mut local[pelvis]);
            let (swing, twist) = swing_twist(bend, Vec3::Y);
            let bend = Quat::from_scaled_axis(rotation_vector(swing) * self.gain) * twist;
            local[spine] = limits::TRUNK.clamp(Quat::IDENTITY.slerp(bend, 0.5), Side::Left);
            local[chest] = limits::TRUNK.clamp(local[spine].inverse() * bend, Side::Left);
        }
        let turn = (local[pelvis] * local[spine] * local[chest]).normalize();
        self.lean(seen, turn, dt, local);
        self.look(turn, now.share(HEAD_TAU), local);
        (local[pelvis], turn)
    }

    /// Takes the learned bow out of both frames so that the line from hips to neck stays; sets the pelvis and returns
    /// the bend that is left.
    fn straighten(&mut self, frames: &Frames, dt: f32, pelvis: &mut Quat) -> Quat {
        let bow = rotation_vector(frames.pelvis.inverse() * frames.chest).x;
        let habit = self.bow.learn(Vec3::X * bow, dt).x / (frames.lower + frames.upper);
        *pelvis = (frames.pelvis * Quat::from_rotation_x(habit * frames.upper)).normalize();
        let chest = frames.chest * Quat::from_rotation_x(-habit * frames.lower);
        (pelvis.inverse() * chest).normalize()
    }

    /// Both frames against their like in the rest pose; nothing unless hips and neck are seen.
    fn frames(&self, seen: &ReliableJoints) -> Option<Frames> {
        use Joint::*;
        let neck = if seen.at(Neck).is_some() { Neck } else { Head };
        let has = |a, b| seen.direction(a, b).is_some();
        let [left, right] = if has(RightClavicle, LeftClavicle) {
            [LeftClavicle, RightClavicle]
        } else {
            [LeftShoulder, RightShoulder]
        };
        let waist = waist(seen, neck);
        let build = |seen: &ReliableJoints| {
            let (hips, neck) = (seen.hips()?, seen.at(neck)?);
            let (lower, upper) = match waist {
                Some(joint) => (seen.at(joint)? - hips, neck - seen.at(joint)?),
                None => (neck - hips, neck - hips),
            };
            let across = seen.direction(RightHip, LeftHip)?;
            let pelvis = frame(unit(lower)?, across)?;
            let chest = frame(unit(upper)?, seen.direction(right, left).unwrap_or(across))?;
            Some(Frames { pelvis, chest, lower: lower.length(), upper: upper.length() })
        };
        let (now, rest) = (build(seen)?, build(&self.rest)?);
        Some(Frames { pelvis: now.pelvis * rest.pelvis.inverse(), chest: now.chest * rest.chest.inverse(), ..now })
    }

    /// Rotation of the neck: as it leans, but for the habit to lean forwards or back.
    fn lean(&mut self, seen: &ReliableJoints, chest: Quat, dt: f32, local: &mut [Quat; JOINTS]) {
        let (neck, head) = (Joint::Neck, Joint::Head);
        if let (Some(now), Some(rest)) = (seen.direction(neck, head), self.rest.direction(neck, head)) {
            let lean = rotation_vector(Quat::from_rotation_arc(rest, chest.inverse() * now));
            let habit = self.neck.learn(Vec3::X * lean.x, dt);
            local[neck.index()] = limits::NECK.clamp(Quat::from_scaled_axis(lean - habit), Side::Left);
        }
    }

    /// Rotation of the head: its turn follows the chest's softly.
    fn look(&mut self, chest: Quat, follow: f32, local: &mut [Quat; JOINTS]) {
        let forward = chest * Vec3::Z;
        if forward.x.hypot(forward.z) > MIN_HEADING {
            let yaw = forward.x.atan2(forward.z);
            let lag = (wrap(yaw - self.head_yaw) * (1.0 - follow)).clamp(-HEAD_LAG, HEAD_LAG);
            self.head_yaw = wrap(yaw - lag);
            local[Joint::Head.index()] = Quat::from_rotation_y(-lag);
        }
    }

    /// Rotation of a collar bone: as its two ends show, but for the habit of both; else lifted with the arm.
    pub fn clavicle(&mut self, now: BodyInput, chest: Quat, side: Side, local: &mut [Quat; JOINTS]) -> Quat {
        let (seen, dt) = (now.seen, now.dt);
        let (clavicle, shoulder, elbow) = match side {
            Side::Left => (Joint::LeftClavicle, Joint::LeftShoulder, Joint::LeftElbow),
            Side::Right => (Joint::RightClavicle, Joint::RightShoulder, Joint::RightElbow),
        };
        let inward = chest.inverse();
        let shown = seen.direction(clavicle, shoulder).zip(self.rest.direction(clavicle, shoulder));
        let local = &mut local[clavicle.index()];
        let target = if let Some((shown, rest)) = shown {
            let mirror = Vec3::new(1.0, side.sign(), side.sign());
            let turn = rotation_vector(Quat::from_rotation_arc(rest, inward * shown)) * mirror;
            Quat::from_scaled_axis((turn - self.shoulders.learn(turn, 0.5 * dt)) * mirror)
        } else if let Some(arm) = seen.direction(shoulder, elbow) {
            // Nothing up to the horizontal, all of it straight up.
            let raised = (inward * arm).y.clamp(0.0, 1.0);
            Quat::from_rotation_z(side.sign() * CLAVICLE_LIFT * raised * raised)
        } else {
            return *local;
        };
        *local = limits::CLAVICLE.clamp(target, side);
        *local
    }
}

/// The joint that parts lower from upper trunk, if one lies well between hips and neck.
fn waist(seen: &ReliableJoints, neck: Joint) -> Option<Joint> {
    let (hips, neck) = (seen.hips()?, seen.at(neck)?);
    let whole = hips.distance(neck);
    [Joint::Spine, Joint::Chest]
        .into_iter()
        .find(|joint| seen.at(*joint).is_some_and(|p| (WAIST[0] * whole..WAIST[1] * whole).contains(&p.distance(hips))))
}

/// The rotation whose y axis is `up` (unit) and whose x axis is as near to `left` as that allows.
fn frame(up: Vec3, left: Vec3) -> Option<Quat> {
    let across = left - up * left.dot(up);
    if across.length() < 0.2 {
        return None;
    }
    let x = across.normalize();
    Some(Quat::from_mat3(&Mat3::from_cols(x, up, x.cross(up))).normalize())
}
