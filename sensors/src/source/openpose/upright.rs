//! The cameras' world brought into ours: heads up, facing +z, on the floor.

use glam::{Quat, Vec3};
use toile_base::skeleton::Joint;

use crate::error::{FilePlace, ReaderFault};
use crate::source::align;
use toile_base::frame::Joints;

/// The axis of the cameras' world that is up: the one along which the head is above the feet.
pub fn to_world(frames: &mut [Joints], notes: &mut Vec<String>) -> Result<(), ReaderFault> {
    let mut sum = Vec3::ZERO;
    for f in frames.iter() {
        let feet = [Joint::LeftAnkle, Joint::RightAnkle, Joint::Pelvis];
        let low = feet.into_iter().find_map(|j| f.believed(j));
        let high = f.believed(Joint::Chest).or(f.believed(Joint::Head));
        sum += high.zip(low).map_or(Vec3::ZERO, |(high, low)| high - low);
    }
    let axes =
        [("y", Vec3::Y), ("z", Vec3::Z), ("x", Vec3::X), ("-y", Vec3::NEG_Y), ("-z", Vec3::NEG_Z), ("-x", Vec3::NEG_X)];
    // The first of equals wins, so that y is taken where no axis stands out.
    let (name, up) = axes.into_iter().rev().max_by(|a, b| a.1.dot(sum).total_cmp(&b.1.dot(sum))).unwrap_or(axes[0]);
    if sum == Vec3::ZERO {
        let cure = "record again with the shopper in full view of two cameras";
        return Err(ReaderFault::new(FilePlace::Whole, "no frame shows a person's head and feet to two cameras", cure));
    }
    if up != Vec3::Y {
        notes.push(format!("the cameras' up axis is {name} (found from the shopper): turned to y"));
    }
    turn(frames, Quat::from_rotation_arc(up, Vec3::Y));
    face_forward(frames, notes);
    align::stand(frames, notes);
    Ok(())
}

/// Turns about y so that the shopper of the first frame that shows both hips faces +z.
fn face_forward(frames: &mut [Joints], notes: &mut Vec<String>) {
    let across = |f: &Joints| Some(f.believed(Joint::LeftHip)? - f.believed(Joint::RightHip)?);
    let Some(across) = frames.iter().find_map(across) else { return };
    let facing = across.cross(Vec3::Y);
    let angle = facing.x.atan2(facing.z);
    notes.push(format!("the shopper faced {:.0} degrees away at the start: turned to face +z", angle.to_degrees()));
    turn(frames, Quat::from_rotation_y(-angle));
}

fn turn(frames: &mut [Joints], turn: Quat) {
    for joint in frames.iter_mut().flat_map(|f| f.joints.iter_mut()).filter(|j| j.confidence > 0.0) {
        joint.position = turn * joint.position;
    }
}
