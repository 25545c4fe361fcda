//! Measures of a garment's state: strain, penetration, how tight it sits. Read only; outside of the timed step.

use glam::Vec3;
use toile_base::garment::{Garment, Part};

use crate::cloth::{Cloth, contact};
use crate::colliders::Colliders;
use crate::lanes::Width;

/// Strain over warp and weft edges: |length / rest - 1|.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strain {
    /// Mean over the edges (1).
    pub mean: f32,
    /// 99th percentile (1).
    pub p99: f32,
    /// Largest over the edges (1).
    pub max: f32,
}

/// Strain of the edges that can move; allocates nothing.
pub fn strain(cloth: &mut Cloth, garment: &Garment) -> Strain {
    let Cloth { positions, strains: scratch, .. } = cloth;
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

/// Deepest point of a free particle inside the body (m), 0 if none is inside: behind the skin where it lies by that, else
/// inside the colliders that it can touch. Allocates nothing.
pub fn penetration(cloth: &mut Cloth, garment: &Garment, colliders: &Colliders) -> f32 {
    let cones = colliders.cones_at(1.0);
    let mut deepest = 0.0f32;
    let Cloth { state, contacts, positions, .. } = cloth;
    if let Some(skin) = colliders.skin() {
        let columns = state.columns();
        contacts.skin_depths(Width::widest(), columns, skin, |_, depth| deepest = deepest.max(depth));
    }
    let (mut part, mut reach) = (Part::Hollow, 0);
    for (i, ((p, &of), w)) in positions.iter().zip(&garment.parts).zip(&garment.inverse_mass).enumerate() {
        if of != part {
            (part, reach) = (of, contact::body::reach(of, colliders));
        }
        let mut bits = if *w > 0.0 && contacts.by_skin(i as u32).is_none() { reach } else { 0 };
        let p: Vec3 = (*p).into();
        while bits != 0 {
            let cone = &cones[bits.trailing_zeros() as usize];
            if cone.may_contain(p) {
                deepest = deepest.max(-cone.distance(p).0);
            }
            bits &= bits - 1;
        }
    }
    deepest
}

/// Distance from the body at which a garment counts as altogether loose (m).
const LOOSE_M: f32 = 0.08;

/// Passes of smoothing over neighbours: single edges are noisy, zones are what a wearer feels.
const SMOOTHING: usize = 6;

/// How tight the garment sits at each particle, -1 (loose) .. 1 (stretched to the fabric's comfortable limit): the mean
/// stretch of the hoops through it, less the gap to the body. Allocates; not for the frame.
pub fn tightness(cloth: &Cloth, garment: &Garment, colliders: &Colliders) -> Vec<f32> {
    let cones = colliders.cones_at(1.0);
    let offset = garment.fabric.contact_offset_mm * 1e-3;
    let mut stretch = vec![0.0f32; garment.particles()];
    let mut share = vec![0u32; garment.particles()];
    for ([a, b], rest) in &garment.hoop_edges {
        let s = cloth.positions[*a as usize].distance(cloth.positions[*b as usize]) / rest - 1.0;
        for &i in [a, b] {
            stretch[i as usize] += s;
            share[i as usize] += 1;
        }
    }
    let value = |i: usize| {
        let s = stretch[i] / share[i].max(1) as f32 / garment.fabric.comfortable_stretch;
        let p: Vec3 = cloth.positions[i].into();
        let gap = cones.iter().map(|c| c.distance(p).0).fold(f32::MAX, f32::min) - offset;
        s.max(0.0) - (gap / LOOSE_M).clamp(0.0, 1.0)
    };
    let mut values: Vec<f32> = (0..garment.particles()).map(value).collect();
    for _ in 0..SMOOTHING {
        values = smoothed(&values, garment);
    }
    values.iter().map(|v| v.clamp(-1.0, 1.0)).collect()
}

/// Each value halfway to the mean of its neighbours.
fn smoothed(values: &[f32], garment: &Garment) -> Vec<f32> {
    let mut sum = vec![(0.0f32, 0u32); values.len()];
    for ([a, b], _) in &garment.strain_edges {
        let (a, b) = (*a as usize, *b as usize);
        sum[a] = (sum[a].0 + values[b], sum[a].1 + 1);
        sum[b] = (sum[b].0 + values[a], sum[b].1 + 1);
    }
    values.iter().zip(sum).map(|(v, (s, n))| 0.5 * (v + if n > 0 { s / n as f32 } else { *v })).collect()
}
