//! BVH motion capture: forward kinematics, which way is up, how long a unit is, where the person looks.

use glam::{DMat3, DQuat, DVec3};
use toile_base::skeleton::{JOINTS, Joint};

use super::align;
use super::bvh_file::{Bvh, Channel};
use super::bvh_names::Names;
use crate::error::{FilePlace, ReaderFault};
use crate::session::Session;
use toile_base::clock::SECOND_NS;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::limits::MAX_COORDINATE;

/// Units that a file may be in, and their length (m).
const UNITS: [(&str, f64); 4] = [("metres", 1.0), ("centimetres", 0.01), ("inches", 0.0254), ("millimetres", 0.001)];

/// Statures by which a unit is recognised (m): ANSUR II spans 1.41 .. 1.99, and children and dancers come besides.
const PLAUSIBLE_STATURE: std::ops::Range<f64> = 1.2..2.2;

/// Stature given to a person whose unit is unknown (m).
const ASSUMED_STATURE: f64 = 1.70;

/// Hip to ankle over stature: thigh 0.245 and shank 0.246 (Drillis and Contini 1966).
const LEG_OF_STATURE: f64 = 0.491;

/// Nearer than this to its parent in every frame (m), a joint carries no information and counts as absent.
const COINCIDENT: f64 = 1e-3;

type Positions = [DVec3; JOINTS];

pub(super) fn session(bvh: &Bvh, names: &Names) -> Result<Session, ReaderFault> {
    let mut notes = Vec::new();
    let mut positions: Vec<Positions> = bvh.values.chunks_exact(bvh.channels).map(|v| frame(bvh, names, v)).collect();
    let up = to_y_up(&mut positions);
    if up != DVec3::Y {
        notes.push(format!("the file's up axis is {} (found from the skeleton): turned to y", axis_name(up)));
    }
    let (metres, known) = unit(bvh, names, &mut notes)?;
    face_forward(&mut positions, &mut notes);
    let present = present(&positions, names, metres, &mut notes);
    let mut joints = Vec::with_capacity(positions.len());
    for (i, p) in positions.iter().enumerate() {
        joints.push(tracked(p, &present, metres, time_ns(i, bvh.frame_time)).ok_or_else(|| {
            ReaderFault::new(FilePlace::Frame(i), "a joint is flung out of the room", "export the motion again as BVH")
        })?);
    }
    align::stand(&mut joints, &mut notes);
    Ok(Session { joints, notes, raw_scale_known: known, ..Session::default() })
}

/// Time of a frame, rounded from the file's own frame time each time, so that nothing accumulates.
fn time_ns(frame: usize, frame_time: f64) -> u64 {
    (frame as f64 * frame_time * SECOND_NS as f64).round() as u64
}

/// Forward kinematics of one frame, file axes and units.
fn frame(bvh: &Bvh, names: &Names, values: &[f32]) -> Positions {
    let mut world: Vec<(DVec3, DMat3)> = Vec::with_capacity(bvh.nodes.len());
    let mut next = 0;
    for node in &bvh.nodes {
        let (mut offset, mut turn) = (node.offset, DMat3::IDENTITY);
        for channel in &node.channels {
            let value = f64::from(values[next]);
            next += 1;
            match *channel {
                Channel::Position(axis) => offset[axis] = value,
                Channel::Rotation(0) => turn *= DMat3::from_rotation_x(value.to_radians()),
                Channel::Rotation(1) => turn *= DMat3::from_rotation_y(value.to_radians()),
                Channel::Rotation(_) => turn *= DMat3::from_rotation_z(value.to_radians()),
            }
        }
        let (at, frame) = node.parent.map_or((DVec3::ZERO, DMat3::IDENTITY), |p| world[p]);
        world.push((at + frame * offset, frame * turn));
    }
    names.map(|node| node.map_or(DVec3::ZERO, |i| world[i].0))
}

/// Turns the axis along which heads are above ankles to y; returns which it was.
fn to_y_up(frames: &mut [Positions]) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for f in frames.iter() {
        let ankles = (f[Joint::LeftAnkle.index()] + f[Joint::RightAnkle.index()]) * 0.5;
        sum += f[Joint::Head.index()] - ankles;
    }
    let axes = [DVec3::Y, DVec3::Z, DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::NEG_X];
    // The first of equals wins, so that y is taken where no axis stands out.
    let up = axes.into_iter().rev().max_by(|a, b| a.dot(sum).total_cmp(&b.dot(sum))).unwrap_or(DVec3::Y);
    let turn = if up == DVec3::NEG_Y {
        DQuat::from_rotation_x(std::f64::consts::PI)
    } else {
        DQuat::from_rotation_arc(up, DVec3::Y)
    };
    frames.iter_mut().flatten().for_each(|p| *p = turn * *p);
    up
}

fn axis_name(axis: DVec3) -> &'static str {
    [(DVec3::Z, "z"), (DVec3::X, "x"), (DVec3::NEG_Y, "-y"), (DVec3::NEG_Z, "-z"), (DVec3::NEG_X, "-x")]
        .into_iter()
        .find_map(|(a, name)| (a == axis).then_some(name))
        .unwrap_or("y")
}

/// Length of a file unit (m), and whether it is known rather than assumed.
fn unit(bvh: &Bvh, names: &Names, notes: &mut Vec<String>) -> Result<(f64, bool), ReaderFault> {
    let leg = (chain(bvh, names, Joint::LeftAnkle, Joint::LeftHip)
        + chain(bvh, names, Joint::RightAnkle, Joint::RightHip))
        * 0.5;
    if leg < 1e-6 {
        let cure = "export the motion with its skeleton";
        return Err(ReaderFault::new(FilePlace::Whole, "the skeleton's legs have no length", cure));
    }
    // Height of the ankles and of the skull above the head joint are a tenth of the stature together.
    let stature = (leg + chain(bvh, names, Joint::Head, Joint::Pelvis)) / 0.9;
    for (name, metres) in UNITS {
        if PLAUSIBLE_STATURE.contains(&(stature * metres)) {
            notes.push(format!("the file is taken to be in {name}: a person of {:.2} m", stature * metres));
            return Ok((metres, true));
        }
    }
    notes.push(format!(
        "the file's unit is unknown: scaled by leg length to a person of {ASSUMED_STATURE:.2} m, so sizes are assumed"
    ));
    Ok((ASSUMED_STATURE * LEG_OF_STATURE / leg, false))
}

/// Length of the chain of offsets from a joint up to an ancestor, or to the root (file units).
fn chain(bvh: &Bvh, names: &Names, from: Joint, to: Joint) -> f64 {
    let end = names[to.index()];
    let mut at = names[from.index()];
    let mut length = 0.0;
    while at != end
        && let Some(i) = at
    {
        length += bvh.nodes[i].offset.length();
        at = bvh.nodes[i].parent;
    }
    length
}

/// Turns about y so that the person of the first frame faces +z.
fn face_forward(frames: &mut [Positions], notes: &mut Vec<String>) {
    let Some(first) = frames.first() else { return };
    let across = first[Joint::LeftHip.index()] - first[Joint::RightHip.index()];
    // Left is +x and up is +y of a person who faces +z.
    let facing = across.cross(DVec3::Y);
    let angle = facing.x.atan2(facing.z);
    if angle.abs() > 0.02 {
        notes.push(format!("the person faced {:.0} degrees away at the start: turned to face +z", angle.to_degrees()));
    }
    let turn = DQuat::from_rotation_y(-angle);
    frames.iter_mut().flatten().for_each(|p| *p = turn * *p);
}

/// Joints that carry information: named in the file, and not always at their parent's place.
fn present(frames: &[Positions], names: &Names, metres: f64, notes: &mut Vec<String>) -> [bool; JOINTS] {
    let mut present = [false; JOINTS];
    let mut dropped = Vec::new();
    for joint in Joint::ALL {
        let Some(_) = names[joint.index()] else { continue };
        let parent = crate::filter::gate::anchor(joint, |j| present[j.index()]);
        let apart = |p: Joint| frames.iter().any(|f| f[joint.index()].distance(f[p.index()]) * metres > COINCIDENT);
        present[joint.index()] = parent.is_none_or(apart);
        if !present[joint.index()] {
            dropped.push(format!("{joint:?}"));
        }
    }
    if !dropped.is_empty() {
        notes.push(format!("{} always lie at their parents' place and count as absent", dropped.join(", ")));
    }
    present
}

fn tracked(p: &Positions, present: &[bool; JOINTS], metres: f64, time_ns: u64) -> Option<Joints> {
    let mut out = Joints::absent(time_ns);
    for i in (0..JOINTS).filter(|i| present[*i]) {
        let position = (p[i] * metres).as_vec3();
        if !position.is_finite() || position.abs().max_element() > MAX_COORDINATE {
            return None;
        }
        out.joints[i] = TrackedJoint { position, confidence: 1.0 };
    }
    Some(out)
}
