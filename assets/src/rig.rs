//! The collision body: 16 spheres and the 28 tapered capsules between them, fitted to one body's surface.
//!
//! Reads: a body in its rest pose. Writes: one immutable [`Rig`].
//! Budget: at load only, under 100 ms a body.
//! Thread: the loading thread.
//!
//! A tapered capsule (round cone) is the convex hull of two spheres. The fit minimises the squared distance between the
//! body's surface and the union of the capsules by Levenberg-Marquardt, left and right mirrored. Large distances cost
//! more than their square, and skin outside the union more than union outside the skin: cloth rests on the union while
//! the picture shows the body, and the worst place is what is seen.

mod fit;

use glam::Vec3;

use crate::body::{Body, Region};
use crate::limits::{MAX_CAPSULES, MAX_SPHERES};
use crate::skeleton::Joint;

/// A collision sphere that a bone carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// The bone, an index below [`crate::skeleton::BONES`].
    pub bone: u8,
    /// Centre, from the bone's rest origin, in the rest frame (m).
    pub offset: Vec3,
    /// Radius (m).
    pub radius: f32,
}

/// How closely the union of the capsules follows the surface that garments cover: the torso below the neck, the arms
/// down to the wrists, the legs down to the ankles. Taken at every vertex there, weighted by its area.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigReport {
    /// Mean distance, absolute (mm).
    pub mean_mm: f32,
    /// 95th percentile of the distance, absolute (mm).
    pub p95_mm: f32,
    /// The furthest that the union stands out of the body (mm).
    pub max_outside_mm: f32,
    /// The furthest that the union stays below the body's surface (mm).
    pub max_inside_mm: f32,
}

/// The collision body of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The spheres: each left one is followed by its mirror image.
    pub spheres: [Sphere; MAX_SPHERES],
    /// The pairs of spheres that span a capsule.
    pub capsules: [[u8; 2]; MAX_CAPSULES],
    /// How well the union fits.
    pub report: RigReport,
}

/// Places of the left spheres; the right one is the next index.
mod at {
    pub const PELVIS: u8 = 0;
    pub const WAIST: u8 = 2;
    pub const CHEST: u8 = 4;
    pub const SHOULDER: u8 = 6;
    pub const ELBOW: u8 = 8;
    pub const WRIST: u8 = 10;
    pub const KNEE: u8 = 12;
    pub const ANKLE: u8 = 14;
}

/// The capsules: limbs, the pairs across the trunk, its uprights, the diagonals that fill it, and two long ones a side
/// that span the shoulder blades and the fold of the hip.
const CAPSULES: [[u8; 2]; MAX_CAPSULES] = {
    use at::*;
    [
        [SHOULDER, ELBOW],
        [SHOULDER + 1, ELBOW + 1],
        [ELBOW, WRIST],
        [ELBOW + 1, WRIST + 1],
        [PELVIS, KNEE],
        [PELVIS + 1, KNEE + 1],
        [KNEE, ANKLE],
        [KNEE + 1, ANKLE + 1],
        [PELVIS, PELVIS + 1],
        [WAIST, WAIST + 1],
        [CHEST, CHEST + 1],
        [SHOULDER, SHOULDER + 1],
        [PELVIS, WAIST],
        [PELVIS + 1, WAIST + 1],
        [WAIST, CHEST],
        [WAIST + 1, CHEST + 1],
        [CHEST, SHOULDER],
        [CHEST + 1, SHOULDER + 1],
        [PELVIS, WAIST + 1],
        [PELVIS + 1, WAIST],
        [WAIST, CHEST + 1],
        [WAIST + 1, CHEST],
        [CHEST, SHOULDER + 1],
        [CHEST + 1, SHOULDER],
        [WAIST, SHOULDER],
        [WAIST + 1, SHOULDER + 1],
        [WAIST, KNEE],
        [WAIST + 1, KNEE + 1],
    ]
};

/// The joint that carries each left sphere.
const CARRIERS: [Joint; MAX_SPHERES / 2] = {
    use Joint::*;
    [Pelvis, Spine, Chest, LeftClavicle, LeftElbow, LeftWrist, LeftKnee, LeftAnkle]
};

impl Rig {
    /// Fits the spheres to a body in its rest pose. The same body gives the same bits.
    pub fn fit(body: &Body) -> Self {
        let placed = fit::spheres(body);
        let mut spheres = [Sphere { bone: 0, offset: Vec3::ZERO, radius: 0.0 }; MAX_SPHERES];
        for (i, sphere) in spheres.iter_mut().enumerate() {
            let joint = if i % 2 == 0 { CARRIERS[i / 2] } else { CARRIERS[i / 2].mirror() };
            let (centre, radius) = placed[i];
            *sphere = Sphere { bone: joint.index() as u8, offset: centre - body.skeleton.at(joint), radius };
        }
        Self { spheres, capsules: CAPSULES, report: report(body, &placed) }
    }

    /// Signed distance from a point to the union of the capsules in the body's rest pose (m), negative inside.
    pub fn distance(&self, body: &Body, p: Vec3) -> f32 {
        let origins = body.skeleton.bone_origins();
        let placed = self.spheres.map(|s| (origins[usize::from(s.bone)] + s.offset, s.radius));
        nearest(&placed, p).0
    }
}

/// Spheres in the rest pose: centre and radius (m).
type Placed = [(Vec3, f32); MAX_SPHERES];

/// Signed distance from `p` to a round cone (m), negative inside, and where along the axis (0 at `a`, 1 at `b`) the
/// sphere stands that the nearest surface point belongs to.
///
/// The cone is the union of spheres whose centres run from `a` to `b` while the radius r(s) = ra - k s shrinks with
/// slope k = (ra - rb) / |b - a|. With x along the axis and y across it, |p - c(s)| - r(s) is convex in s and least where
/// (x - s) / |p - c(s)| = k, that is at s = x - y k / sqrt(1 - k^2), held between the ends. (The same solid as in
/// I. Quilez, "Distance to a round cone"; the derivation is our own.) Where one sphere swallows the other, it is all.
pub fn round_cone(p: Vec3, (a, ra): (Vec3, f32), (b, rb): (Vec3, f32)) -> (f32, f32) {
    let axis = b - a;
    let length = axis.length();
    if length <= (ra - rb).abs() {
        return if ra >= rb { (p.distance(a) - ra, 0.0) } else { (p.distance(b) - rb, 1.0) };
    }
    let k = (ra - rb) / length;
    let x = (p - a).dot(axis) / length;
    let y = (p - a - axis * (x / length)).length();
    let s = (x - y * k / (1.0 - k * k).sqrt()).clamp(0.0, length);
    ((x - s).hypot(y) - (ra - k * s), s / length)
}

/// Distance to the union, and the capsule and place on it that are nearest.
fn nearest(placed: &Placed, p: Vec3) -> (f32, usize, f32) {
    let mut best = (f32::INFINITY, 0, 0.0);
    for (i, [a, b]) in CAPSULES.iter().enumerate() {
        let (distance, t) = round_cone(p, placed[usize::from(*a)], placed[usize::from(*b)]);
        if distance < best.0 {
            best = (distance, i, t);
        }
    }
    best
}

/// Whether garments cover a vertex, so that the union has to follow the body there.
fn clothed(body: &Body, vertex: usize) -> bool {
    let (p, skeleton) = (body.mesh.positions[vertex], &body.skeleton);
    let wrist = |j: Joint| (p - skeleton.at(j)).dot((skeleton.at(j) - skeleton.at(elbow_of(j))).normalize()) < 0.0;
    match body.regions[vertex] {
        // The base of the neck leans forwards.
        Region::Torso => (p - skeleton.at(Joint::Neck)).dot(Vec3::new(0.0, 0.93, 0.37)) < 0.0,
        Region::LeftArm => wrist(Joint::LeftWrist),
        Region::RightArm => wrist(Joint::RightWrist),
        Region::LeftLeg | Region::RightLeg => p.y > 1.3 * body.levels.ankle,
        Region::Head => false,
    }
}

fn elbow_of(wrist: Joint) -> Joint {
    wrist.parent().expect("a wrist hangs from an elbow")
}

/// A third of the area of the triangles around each vertex (m^2).
fn vertex_areas(body: &Body) -> Vec<f32> {
    let mut areas = vec![0.0; body.mesh.positions.len()];
    for t in &body.mesh.triangles {
        let [a, b, c] = t.map(|v| body.mesh.positions[v as usize]);
        let share = (b - a).cross(c - a).length() / 6.0;
        t.iter().for_each(|&v| areas[v as usize] += share);
    }
    areas
}

fn report(body: &Body, placed: &Placed) -> RigReport {
    let areas = vertex_areas(body);
    let covered = (0..areas.len()).filter(|&v| clothed(body, v));
    let mut found: Vec<(f32, f32)> =
        covered.map(|v| (nearest(placed, body.mesh.positions[v]).0 * 1e3, areas[v])).collect();
    found.sort_unstable_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let total: f32 = found.iter().map(|f| f.1).sum();
    let mut passed = 0.0;
    let p95 = found.iter().find(|f| {
        passed += f.1;
        passed >= 0.95 * total
    });
    RigReport {
        mean_mm: found.iter().map(|f| f.0.abs() * f.1).sum::<f32>() / total,
        p95_mm: p95.map_or(0.0, |f| f.0.abs()),
        max_outside_mm: found.iter().map(|f| -f.0).fold(0.0, f32::max),
        max_inside_mm: found.iter().map(|f| f.0).fold(0.0, f32::max),
    }
}

#[cfg(test)]
mod tests;
