//! The parts of the skin that the collision body is judged on.

use glam::Vec3;

use toile_base::body::{Body, Region};
use toile_base::skeleton::Joint;

toile_base::named! {
    /// A part of the skin that the fit is judged on, trunk first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Zone {
        /// Trunk from midway between waist and underbust to midway between bust points and acromions.
        Chest = "chest",
        /// Trunk between chest and hips.
        Waist = "waist",
        /// Trunk from midway between buttocks and waist down.
        Hips = "hips",
        /// Trunk above the chest, up to the base of the neck; and the arm where it begins.
        Shoulder = "shoulder",
        /// Leg down to the middle of the kneecap.
        Thigh = "thigh",
        /// From there to the ankle.
        Shin = "shin",
        /// Arm from a fifth of its upper length down to the elbow.
        UpperArm = "upper arm",
        /// Elbow to wrist.
        Forearm = "forearm",
        /// Base of the neck to the skull.
        Neck = "neck",
        /// The head above.
        Head = "head",
        /// Wrist and beyond.
        Hand = "hand",
        /// Ankle and below.
        Foot = "foot",
    }
}

impl Zone {
    /// Zones that the fit is held to: mean at most [`MEAN_GOAL_MM`](super::MEAN_GOAL_MM), 95th percentile at
    /// most [`P95_GOAL_MM`](super::P95_GOAL_MM).
    pub const HELD: [Self; 4] = [Self::Chest, Self::Waist, Self::Hips, Self::Thigh];

    /// Zone of a vertex.
    pub fn of(body: &Body, vertex: usize) -> Self {
        let p = body.mesh.positions[vertex];
        match body.regions[vertex] {
            Region::Torso | Region::Head => trunk(body, p),
            Region::LeftArm | Region::RightArm => arm(body, p),
            Region::LeftLeg | Region::RightLeg if p.y > body.levels.knee => Self::Thigh,
            Region::LeftLeg | Region::RightLeg if p.y > 1.3 * body.levels.ankle => Self::Shin,
            Region::LeftLeg | Region::RightLeg => Self::Foot,
        }
    }
}

fn trunk(body: &Body, p: Vec3) -> Zone {
    let (levels, skeleton) = (&body.levels, &body.skeleton);
    // The base of the neck leans forwards, that of the skull more.
    let above = |joint: Joint, up: Vec3| (p - skeleton.at(joint)).dot(up) > 0.0;
    if above(Joint::Head, Vec3::new(0.0, 0.77, 0.64)) {
        Zone::Head
    } else if above(Joint::Neck, Vec3::new(0.0, 0.93, 0.37)) {
        Zone::Neck
    } else if p.y > 0.5 * (levels.chest + levels.shoulder) {
        Zone::Shoulder
    } else if p.y > 0.5 * (levels.underbust + levels.waist) {
        Zone::Chest
    } else if p.y > 0.5 * (levels.waist + levels.hip) {
        Zone::Waist
    } else {
        Zone::Hips
    }
}

fn arm(body: &Body, p: Vec3) -> Zone {
    let p = p.with_x(p.x.abs());
    let at = |j: Joint| body.skeleton.at(j);
    let (shoulder, elbow, wrist) = (at(Joint::LeftShoulder), at(Joint::LeftElbow), at(Joint::LeftWrist));
    let (upper, fore) = ((elbow - shoulder).normalize(), (wrist - elbow).normalize());
    if (p - wrist).dot(fore) > 0.0 {
        Zone::Hand
    } else if (p - elbow).dot(upper + fore) > 0.0 {
        Zone::Forearm
    } else if (p - shoulder).dot(upper) > 0.2 * shoulder.distance(elbow) {
        Zone::UpperArm
    } else {
        Zone::Shoulder
    }
}

/// The zone's place in [`Zone::ALL`].
pub(super) fn place(zone: Zone) -> usize {
    Zone::ALL.iter().position(|z| *z == zone).unwrap_or(0)
}

pub(super) fn is_trunk(zone: Zone) -> bool {
    matches!(zone, Zone::Chest | Zone::Waist | Zone::Hips | Zone::Shoulder)
}

/// Whether a section of the trunk counts a vertex of this zone.
pub(super) fn is_trunk_or_thigh(zone: Zone) -> bool {
    is_trunk(zone) || matches!(zone, Zone::Thigh | Zone::Neck)
}
