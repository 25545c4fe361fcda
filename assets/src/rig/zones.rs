//! How closely the union of the capsules follows the skin, zone by zone.

use glam::Vec3;

use super::{Placed, nearest, vertex_areas};
use crate::body::{Body, Region};
use crate::skeleton::Joint;

/// Mean distance that the trunk and the thighs are held to (mm).
pub const MEAN_GOAL_MM: f32 = 5.0;
/// 95th percentile of the distance that they are held to (mm).
pub const P95_GOAL_MM: f32 = 12.0;

/// Steps of the way out; each leaves the capsule that is deepest.
const WAY_OUT: usize = 64;

/// A part of the skin that the fit is judged on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Zone {
    /// Trunk from midway between waist and underbust to midway between bust points and acromions.
    Chest,
    /// Trunk between chest and hips.
    Waist,
    /// Trunk from midway between buttocks and waist down.
    Hips,
    /// Trunk above the chest, up to the base of the neck; and the arm where it begins.
    Shoulder,
    /// Arm from a fifth of its upper length down to the elbow.
    UpperArm,
    /// Elbow to wrist.
    Forearm,
    /// Leg down to the middle of the kneecap.
    Thigh,
    /// From there to the ankle.
    Shin,
    /// Base of the neck to the skull.
    Neck,
    /// The head above.
    Head,
    /// Wrist and beyond.
    Hand,
    /// Ankle and below.
    Foot,
}

impl Zone {
    /// All zones, trunk first.
    pub const ALL: [Self; 12] = {
        use Zone::*;
        [Chest, Waist, Hips, Shoulder, Thigh, Shin, UpperArm, Forearm, Neck, Head, Hand, Foot]
    };

    /// Zones that the fit is held to: mean at most [`MEAN_GOAL_MM`], 95th percentile at most
    /// [`P95_GOAL_MM`].
    pub const HELD: [Self; 4] = [Self::Chest, Self::Waist, Self::Hips, Self::Thigh];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Chest => "chest",
            Self::Waist => "waist",
            Self::Hips => "hips",
            Self::Shoulder => "shoulder",
            Self::UpperArm => "upper arm",
            Self::Forearm => "forearm",
            Self::Thigh => "thigh",
            Self::Shin => "shin",
            Self::Neck => "neck",
            Self::Head => "head",
            Self::Hand => "hand",
            Self::Foot => "foot",
        }
    }

    /// Where a vertex lies.
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

fn is_trunk(zone: Zone) -> bool {
    matches!(zone, Zone::Chest | Zone::Waist | Zone::Hips | Zone::Shoulder)
}

/// Whether a section of the trunk counts a vertex of this zone.
pub(super) fn is_trunk_or_thigh(zone: Zone) -> bool {
    is_trunk(zone) || matches!(zone, Zone::Thigh | Zone::Neck)
}

/// Distances between the skin and the surface of the union, at every vertex, weighted by its area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ZoneReport {
    /// Mean distance, absolute (mm).
    pub mean_mm: f32,
    /// 95th percentile of the distance, absolute (mm).
    pub p95_mm: f32,
    /// The furthest that the union stands out of the skin (mm).
    pub max_outside_mm: f32,
    /// The furthest that the union stays below the skin (mm).
    pub max_inside_mm: f32,
}

impl ZoneReport {
    /// The greatest distance either way (mm).
    pub const fn max_mm(&self) -> f32 {
        self.max_outside_mm.max(self.max_inside_mm)
    }

    /// Whether it keeps to [`MEAN_GOAL_MM`] and [`P95_GOAL_MM`].
    pub const fn meets(&self) -> bool {
        self.mean_mm <= MEAN_GOAL_MM && self.p95_mm <= P95_GOAL_MM
    }

    /// Of distances (mm, positive where the skin is outside the union) and areas.
    fn of(mut found: Vec<(f32, f32)>) -> Self {
        found.sort_unstable_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let total: f32 = found.iter().map(|f| f.1).sum();
        let mut passed = 0.0;
        let p95 = found.iter().find(|f| {
            passed += f.1;
            passed >= 0.95 * total
        });
        Self {
            mean_mm: found.iter().map(|f| f.0.abs() * f.1).sum::<f32>() / total.max(f32::MIN_POSITIVE),
            p95_mm: p95.map_or(0.0, |f| f.0.abs()),
            max_outside_mm: found.iter().map(|f| -f.0).fold(0.0, f32::max),
            max_inside_mm: found.iter().map(|f| f.0).fold(0.0, f32::max),
        }
    }
}

/// Signed distance from a point of the skin to the surface of the union (m), negative inside. Inside it is the shorter of
/// two ways that do lead out: along the skin's normal, and always away from the capsule that is deepest; the union's
/// surface is no farther than that.
pub(super) fn from_skin(placed: &Placed, p: Vec3, normal: Vec3) -> f32 {
    let (distance, ..) = nearest(placed, p);
    if distance >= 0.0 {
        return distance;
    }
    let along = (0..WAY_OUT).fold(0.0, |way, _| way - nearest(placed, p + normal * way).0.min(0.0));
    let mut at = p;
    for _ in 0..WAY_OUT {
        let (depth, capsule, t) = nearest(placed, at);
        if depth >= 0.0 {
            break;
        }
        let [a, b] = super::CAPSULES[capsule].map(|s| placed[usize::from(s)].0);
        at += (at - a.lerp(b, t)).normalize_or(normal) * (1e-6 - depth);
    }
    -at.distance(p).min(along)
}

/// Distance (mm) and area of every vertex that is asked for.
fn distances(body: &Body, placed: &Placed, asked: impl Fn(Zone) -> bool) -> Vec<(f32, f32)> {
    let areas = vertex_areas(body);
    let within = (0..areas.len()).filter(|&v| asked(Zone::of(body, v)));
    within.map(|v| (from_skin(placed, body.mesh.positions[v], body.normals[v]) * 1e3, areas[v])).collect()
}

pub(super) fn reports(body: &Body, placed: &Placed) -> [ZoneReport; 12] {
    Zone::ALL.map(|zone| ZoneReport::of(distances(body, placed, |z| z == zone)))
}

pub(super) fn trunk_report(body: &Body, placed: &Placed) -> ZoneReport {
    ZoneReport::of(distances(body, placed, is_trunk))
}
