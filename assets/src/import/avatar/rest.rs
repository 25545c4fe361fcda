//! A raw body set upright in our axes and unit, and its joints turned into our skeleton.

use glam::{DMat4, DVec3, Mat3, Vec3};

use super::error::Flaw;
use super::names::{HANIM, NEEDED};
use super::raw::RawBody;
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

/// Units a file may be in: metres a unit, and what the unit is called.
const UNITS: [(f32, &str); 4] = [(1.0, "metres"), (0.1, "decimetres"), (0.01, "centimetres"), (0.001, "millimetres")];

/// Statures of people (m): each unit's range ends before the next one's begins.
const STATURES: [f32; 2] = [0.5, 2.6];

/// Least share of the line from the hips to the head that one axis must have: 37 degrees from upright.
const UPRIGHT: f32 = 0.8;

/// How far the furthest toe may stand behind its ankle (share of the stature) before it points backwards.
const TOE_BACK: f32 = 0.01;

/// How a file's space becomes ours: turned, moved, and then scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RestPlacement {
    turn: Mat3,
    /// What comes to the middle between the feet, after the turn, in the file's unit.
    origin: Vec3,
    /// Metres a unit.
    metres: f32,
}

impl RestPlacement {
    /// The same as a matrix from the file's space to ours.
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_scale(DVec3::splat(f64::from(self.metres)))
            * DMat4::from_translation(-self.origin.as_dvec3())
            * DMat4::from_mat3(self.turn.as_dmat3())
    }
}

/// Which of our joints each raw joint carries the skin of: its own, or that of the nearest joint above it.
pub(super) fn carriers(raw: &RawBody) -> Vec<Joint> {
    let above = |mut joint: usize| loop {
        if let Some(found) = raw.reading.joints[joint] {
            return found;
        }
        match raw.joints[joint].parent {
            Some(parent) => joint = parent,
            None => return Joint::Pelvis,
        }
    };
    (0..raw.joints.len()).map(above).collect()
}

/// Turns, scales and moves a raw body so that it stands on the floor in metres, facing +z; returns its skeleton,
/// which joints had to be placed between others, and how it was moved.
pub(super) fn stand(raw: &mut RawBody) -> Result<(Skeleton, Vec<Joint>, RestPlacement), Flaw> {
    check_joints(raw)?;
    let turn = upright(raw)?;
    let all = raw.positions.iter_mut().chain(&mut raw.normals).chain(raw.joints.iter_mut().map(|j| &mut j.at));
    all.for_each(|p| *p = turn * *p);
    let heights = |raw: &RawBody| {
        let range = |[low, high]: [f32; 2], p: &Vec3| [low.min(p.y), high.max(p.y)];
        raw.positions.iter().fold([f32::INFINITY, f32::NEG_INFINITY], range)
    };
    let [low, high] = heights(raw);
    let height = high - low;
    let fits = |(metres, _): &&(f32, &str)| (STATURES[0]..=STATURES[1]).contains(&(height * metres));
    let (metres, unit) = UNITS.iter().find(fits).ok_or(Flaw::Units { height })?;
    if *metres != 1.0 {
        raw.notes.push(format!("it is {height:.2} units tall, so its unit is taken to be {unit}"));
    }
    let middle = 0.5 * (place(raw, Joint::LeftHip) + place(raw, Joint::RightHip));
    let origin = Vec3::new(middle.x, low, middle.z);
    let points = raw.positions.iter_mut().chain(raw.joints.iter_mut().map(|j| &mut j.at));
    points.for_each(|p| *p = (*p - origin) * *metres);
    let (skeleton, placed) = skeleton(raw, height * metres)?;
    Ok((skeleton, placed, RestPlacement { turn, origin, metres: *metres }))
}

/// Where a joint that is known to be there stands.
fn place(raw: &RawBody, joint: Joint) -> Vec3 {
    raw.reading.places[joint.index()].map_or(Vec3::ZERO, |k| raw.joints[k].at)
}

/// Checks that the needed joints are there and connected as in our skeleton.
fn check_joints(raw: &RawBody) -> Result<(), Flaw> {
    let places = &raw.reading.places;
    let missing: Vec<String> =
        NEEDED.iter().filter(|j| places[j.index()].is_none()).map(|j| HANIM.names(*j).remove(0)).collect();
    if !missing.is_empty() {
        return Err(Flaw::Missing { missing: missing.join(", "), dialect: raw.reading.dialect });
    }
    for joint in Joint::ALL {
        let Some(here) = places[joint.index()].filter(|_| joint != Joint::Pelvis) else { continue };
        let name = || raw.joints[here].name.clone();
        let mut next = raw.joints[here].parent;
        while let Some(parent) = next.filter(|p| raw.reading.joints[*p].is_none_or(|j| j == joint)) {
            next = raw.joints[parent].parent;
        }
        let above = next.ok_or_else(|| Flaw::Roots { joint: name() })?;
        let mut ours = joint.parent();
        while ours.is_some() && ours != raw.reading.joints[above] {
            ours = ours.and_then(Joint::parent);
        }
        if ours.is_none() {
            return Err(Flaw::Chain { joint: name(), parent: raw.joints[above].name.clone() });
        }
    }
    Ok(())
}

/// The turn by quarter turns after which the head is up and the left hip on the left.
fn upright(raw: &mut RawBody) -> Result<Mat3, Flaw> {
    let hips = [Joint::LeftHip, Joint::RightHip].map(|j| place(raw, j));
    let up = (place(raw, Joint::Head) - 0.5 * (hips[0] + hips[1])).normalize_or_zero();
    let axis = |v: Vec3| {
        let k = v.abs().max_position();
        Vec3::AXES[k] * v[k].signum()
    };
    let (y, left) = (axis(up), hips[0] - hips[1]);
    if up.dot(y) < UPRIGHT {
        return Err(Flaw::Leaning { x: up.x, y: up.y, z: up.z });
    }
    let x = axis(left - y * left.dot(y));
    let z = x.cross(y);
    if (x, y) != (Vec3::X, Vec3::Y) {
        let name = |v: Vec3| ["-z", "-y", "-x", "", "+x", "+y", "+z"][(3.0 + v.dot(Vec3::new(1.0, 2.0, 3.0))) as usize];
        raw.notes.push(format!("it stands along {} and faces {}, so it is turned", name(y), name(z)));
    }
    Ok(Mat3::from_cols(x, y, z).transpose())
}

/// Our joints at the raw ones' places; those that the file lacks stand between their neighbours.
fn skeleton(raw: &mut RawBody, stature: f32) -> Result<(Skeleton, Vec<Joint>), Flaw> {
    let found = raw.reading.places.map(|place| place.map(|k| raw.joints[k].at));
    let placed: Vec<Joint> = Joint::ALL.into_iter().filter(|j| found[j.index()].is_none()).collect();
    let mut rest = [Vec3::ZERO; JOINTS];
    for joint in Joint::ALL {
        rest[joint.index()] = found[joint.index()].unwrap_or_else(|| between(joint, &rest, &found, stature));
    }
    let skeleton = Skeleton { rest };
    let toes = [[Joint::LeftAnkle, Joint::LeftToe], [Joint::RightAnkle, Joint::RightToe]];
    let ahead = toes.iter().map(|[a, t]| skeleton.at(*t).z - skeleton.at(*a).z).fold(f32::NEG_INFINITY, f32::max);
    if ahead < -TOE_BACK * stature {
        return Err(Flaw::Swapped);
    }
    if !placed.is_empty() {
        let names: Vec<String> = placed.iter().map(|j| HANIM.names(*j).remove(0)).collect();
        raw.notes.push(format!("it has no {}, placed between its neighbours", names.join(", ")));
    }
    Ok((skeleton, placed))
}

/// Where a joint stands that a file lacks, by the shares of the mannequin's own skeleton.
fn between(joint: Joint, rest: &[Vec3; JOINTS], found: &[Option<Vec3>; JOINTS], stature: f32) -> Vec3 {
    use Joint::*;
    let at = |j: Joint| found[j.index()].unwrap_or(rest[j.index()]);
    match joint {
        Chest => at(Spine).lerp(at(Head), 0.3),
        Neck => at(Chest).lerp(at(Head), 0.7),
        LeftClavicle => at(Neck).lerp(at(LeftShoulder), 0.2),
        RightClavicle => at(Neck).lerp(at(RightShoulder), 0.2),
        LeftHand => at(LeftWrist) + (at(LeftWrist) - at(LeftElbow)).normalize_or_zero() * 0.055 * stature,
        RightHand => at(RightWrist) + (at(RightWrist) - at(RightElbow)).normalize_or_zero() * 0.055 * stature,
        LeftToe => (at(LeftAnkle) + Vec3::Z * 0.08 * stature).with_y(0.01 * stature),
        RightToe => (at(RightAnkle) + Vec3::Z * 0.08 * stature).with_y(0.01 * stature),
        _ => rest[joint.index()],
    }
}
