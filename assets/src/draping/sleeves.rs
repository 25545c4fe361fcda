//! Sleeves: panels around an arm, by how far along it and where around it.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::outlines::outline;
use super::panels::{Around, ArrangedPanel, Unrolled};
use crate::pattern::Pattern;
use crate::tailor::SewnMesh;

/// Whether a panel goes around an arm.
pub fn is_sleeve(panel: &ArrangedPanel) -> bool {
    matches!(panel.around, Around::LeftArm | Around::RightArm)
}

/// Gives sleeves coordinates of their arm: `x` around it, from the panel's angle (0 in front, a quarter turn on top) over the top
/// to the back, and `y` up along it, 0 at the top of the sleeve.
pub fn unroll(pattern: &Pattern, sewn: &SewnMesh, all: &mut [ArrangedPanel]) {
    for i in (0..all.len()).filter(|&i| is_sleeve(&all[i])).collect::<Vec<_>>() {
        let panel = &pattern.panels()[i];
        let towards = towards_shoulder(pattern, sewn, all, i);
        let rotation = panel.placement.map_or(glam::DQuat::IDENTITY, |p| p.rotation);
        // Outwards, the panel lies in front of the arm, behind it, or over it.
        let out = DVec2::new(all[i].angle.sin(), all[i].angle.cos());
        let (angle, tangent) = if out.y.abs() < out.x.abs() {
            (FRAC_PI_2, DVec3::NEG_Z)
        } else if out.y > 0.0 {
            (0.0, DVec3::Y)
        } else {
            (PI, DVec3::NEG_Y)
        };
        let across = towards.perp();
        let along = if (rotation * across.extend(0.0)).dot(tangent) < 0.0 { -across } else { across };
        let mut sleeve =
            ArrangedPanel { angle, unrolled: Unrolled::Straight { along, up: towards }, shift: DVec2::ZERO, ..all[i] };
        let own: Vec<DVec2> = outline(sewn, i).map(|p| sleeve.at(p)).collect();
        let (low, high) = own.iter().fold((DVec2::MAX, DVec2::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        sleeve.shift = DVec2::new(-0.5 * (low.x + high.x), -high.y);
        all[i] = sleeve;
    }
}

/// Direction in a sleeve's drawing from its hem to its armhole, along or across its grain.
fn towards_shoulder(pattern: &Pattern, sewn: &SewnMesh, all: &[ArrangedPanel], panel: usize) -> DVec2 {
    let trunk = |m: &[u32; 2]| all[m[0] as usize].around == Around::Trunk;
    let points = &sewn.panels[panel].points;
    let own = |members: &Vec<[u32; 2]>| members.iter().find(|m| m[0] as usize == panel).map(|m| points[m[1] as usize]);
    let hole: Vec<DVec2> = sewn.members.iter().filter(|m| m.iter().any(trunk)).filter_map(own).collect();
    let middle = outline(sewn, panel).sum::<DVec2>() / sewn.panels[panel].boundary.points.len() as f64;
    let hole = if hole.is_empty() { middle } else { hole.iter().sum::<DVec2>() / hole.len() as f64 };
    let grain = pattern.panels()[panel].grain;
    let ways = [grain, -grain, grain.perp(), -grain.perp()];
    let best = ways.into_iter().max_by(|a, b| a.dot(hole - middle).total_cmp(&b.dot(hole - middle)));
    best.unwrap_or(grain)
}
