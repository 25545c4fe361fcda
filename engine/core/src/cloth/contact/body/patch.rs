//! Patches: which particles share a block. At load.

use glam::Vec3;

use super::near::ParticleBlock;
use crate::lanes::MOST;

/// Cuts spans of particles into blocks of four fours. Four particles that are neighbours in memory stay together, and
/// with them the three fours that lie nearest: a small block is near few capsules.
pub fn blocks(spans: &[(u32, u32)], start: &[Vec3]) -> Box<[ParticleBlock]> {
    let mut blocks = Vec::new();
    let mut fours = Vec::new();
    for &(first, len) in spans {
        let whole = len / 4;
        fours.extend((0..whole).map(|k| first + 4 * k));
        if len % 4 != 0 {
            blocks.push(ParticleBlock::new([first + 4 * whole; 4], len as usize % 4));
        }
    }
    let centre = |first: u32| {
        let first = first as usize;
        start.get(first..first + 4).map_or(Vec3::ZERO, |p| p.iter().sum::<Vec3>() * 0.25)
    };
    let mut left: Vec<(u32, Vec3)> = fours.into_iter().map(|first| (first, centre(first))).collect();
    while !left.is_empty() {
        let seed = left[0].1;
        let count = left.len().min(4);
        let mut quads = [left[0].0; 4];
        for quad in &mut quads[..count] {
            let far = |at: &Vec3| at.distance_squared(seed);
            let nearest = left.iter().enumerate().min_by(|(_, a), (_, b)| far(&a.1).total_cmp(&far(&b.1)));
            // The seed itself is the first.
            let k = nearest.map_or(0, |(k, _)| k);
            *quad = left.remove(k).0;
        }
        blocks.push(ParticleBlock::new(quads, (4 * count).min(MOST)));
    }
    blocks.into()
}
