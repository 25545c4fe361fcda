//! Shares of an arm, a leg and a clavicle in each vertex: the parts of the body, softened across their borders.

use glam::Vec3;

use toile_base::body::Region;
use toile_base::skeleton::{Joint, Skeleton};

/// Rounds of averaging over neighbours: the border of an arm spreads over about 90 mm.
const ROUNDS: usize = 14;

/// Shares of the left arm, the left leg and the left clavicle (x, y, z) of each vertex.
pub(super) fn left(positions: &[Vec3], quads: &[[u32; 4]], regions: &[Region], skeleton: &Skeleton) -> Vec<Vec3> {
    let part = |r: &Region| Vec3::new(f32::from(*r == Region::LeftArm), f32::from(*r == Region::LeftLeg), 0.0);
    let mut shares: Vec<Vec3> = regions.iter().map(part).collect();
    for _ in 0..ROUNDS {
        shares = softened(&shares, quads);
    }
    let at = |j: Joint| skeleton.at(j);
    let (inner, tip, chest) = (at(Joint::LeftClavicle), at(Joint::LeftShoulder), at(Joint::Chest));
    for (s, p) in shares.iter_mut().zip(positions) {
        // The clavicle carries the shoulder from the breastbone out and from the armpit up.
        let out = step((p.x - 0.5 * inner.x) / (0.8 * tip.x));
        let up = step((p.y - chest.y - 0.45 * (tip.y - chest.y)) / (0.75 * (tip.y - chest.y)));
        let above_neck = step((p.y - at(Joint::Neck).y) / (0.4 * (tip.x - inner.x)));
        s.z = 0.62 * out * up * (1.0 - above_neck) * (1.0 - s.x);
    }
    shares
}

/// The same for the right side: the left one's mirror image.
pub(super) fn right(left: &[Vec3], mirrors: &[u32]) -> Vec<Vec3> {
    mirrors.iter().map(|&t| left[t as usize]).collect()
}

/// Each value half way to the mean of its face neighbours.
fn softened(values: &[Vec3], quads: &[[u32; 4]]) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0f32); values.len()];
    for q in quads {
        for k in 0..4 {
            let (sum, count) = &mut sums[q[k] as usize];
            *sum += values[q[(k + 1) % 4] as usize] + values[q[(k + 3) % 4] as usize];
            *count += 2.0;
        }
    }
    values.iter().zip(&sums).map(|(&v, &(sum, count))| v.lerp(sum / count, 0.5)).collect()
}

/// From 0 to 1 with level ends.
fn step(x: f32) -> f32 {
    let t = x.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
