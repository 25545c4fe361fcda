//! Measures of a garment's state: strain, penetration, how tight it sits. Read only; outside of the timed step.

use glam::Vec3A;
use toile_assets::garment::Garment;

use super::Cloth;
use crate::colliders::Colliders;

/// Strain over warp and weft edges: |length / rest - 1|.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strain {
    /// Mean (1).
    pub mean: f32,
    /// 99th percentile (1).
    pub p99: f32,
    /// Worst (1).
    pub max: f32,
}

/// Strain of the edges that can move; allocates nothing.
pub fn strain(cloth: &mut Cloth, garment: &Garment) -> Strain {
    let Cloth { positions, scratch, .. } = cloth;
    let mut count = 0;
    let mut sum = 0.0f64;
    for ([a, b], rest) in &garment.strain_edges {
        let (a, b) = (*a as usize, *b as usize);
        if garment.inverse_mass[a] + garment.inverse_mass[b] > 0.0 {
            let s = (positions[a].distance(positions[b]) / rest - 1.0).abs();
            scratch[count] = s;
            sum += f64::from(s);
            count += 1;
        }
    }
    if count == 0 {
        return Strain::default();
    }
    let used = &mut scratch[..count];
    let rank = (count - 1) * 99 / 100;
    let (_, p99, above) = used.select_nth_unstable_by(rank, f32::total_cmp);
    let p99 = *p99;
    let max = above.iter().copied().fold(p99, f32::max);
    Strain { mean: (sum / count as f64) as f32, p99, max }
}

/// Deepest point of a free particle inside the colliders (m), 0 if none is inside.
pub fn penetration(cloth: &Cloth, garment: &Garment, colliders: &Colliders) -> f32 {
    let cones = colliders.cones_at(1.0);
    let deepest = |p: Vec3A| cones.iter().map(|c| c.distance(p.into()).0).fold(f32::MAX, f32::min);
    let free = cloth.positions.iter().zip(&garment.inverse_mass).filter(|(_, w)| **w > 0.0);
    free.map(|(p, _)| -deepest(*p)).fold(0.0, f32::max)
}

/// Signed stretch of the weft at each particle (1): positive where the garment is pulled around the body. The mean of
/// the weft edges that meet at the particle; `out` has one entry a particle.
pub fn weft_stretch(cloth: &Cloth, garment: &Garment, out: &mut [f32]) {
    out.fill(0.0);
    let mut share = vec![0u32; out.len()];
    for ([a, b], rest) in &garment.weft_edges {
        let s = cloth.positions[*a as usize].distance(cloth.positions[*b as usize]) / rest - 1.0;
        for &i in [a, b] {
            out[i as usize] += s;
            share[i as usize] += 1;
        }
    }
    for (value, n) in out.iter_mut().zip(share) {
        *value /= n.max(1) as f32;
    }
}
