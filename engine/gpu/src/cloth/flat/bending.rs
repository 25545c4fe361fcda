//! Bending: curvatures as sums of terms, and for each particle the forces on it, in the order in which the CPU adds it up.

use toile_assets::garment::layout::{Bends, ConstraintRun, Hubs, OWNERS, OwnerShare};

use super::{GarmentSpan, Workgroups};

/// Stencils that the CPU takes together: within them it pushes first all the middles, then all the first ends, and so on.
const CHUNK: usize = toile_engine::cloth::bending::CHUNK;

/// Which of a garment's scales a curvature has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BendingScale {
    /// A stencil's, by its place.
    Bend(u32),
    /// A skewed stencil's, by its place.
    Skewed(u32),
    /// A hub's, by its number.
    Hub(u32),
}

/// Curvatures of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatBending {
    /// First term and number of terms of each curvature `[curvatures]`.
    pub items: Vec<[u32; 2]>,
    /// Particle, and bits of its coefficient (sqrt(N/m)).
    pub terms: Vec<[u32; 2]>,
    /// Share of the stiffness that the substep carries `[curvatures]`.
    pub scales: Vec<f32>,
    /// Source of the scale of each curvature `[curvatures]`.
    sources: Vec<BendingScale>,
    /// Each garment's curvatures `[garments]`.
    ranges: Vec<std::ops::Range<usize>>,
    /// Where each particle's entries begin `[particles + 1]`.
    pub starts: Vec<u32>,
    /// A curvature, in the upper two bits how many sums of a hub (0 for a stencil); the bits of coefficient times weight, or
    /// for a hub the particle's place among its terms.
    pub entries: Vec<[u32; 2]>,
    /// Workgroups over the curvatures.
    pub groups: Workgroups,
}

/// What pushes particles, in order: the particle within the garment, and the entry.
type Pushes = Vec<(u32, [u32; 2])>;

impl FlatBending {
    /// Appends a garment's: the sets in their order, in each the stencils, the skewed ones, the hubs.
    pub fn add(&mut self, layout: &toile_assets::garment::Layout, weights: &[f32], span: GarmentSpan) {
        let (begun, mut pushes) = (self.items.len(), Pushes::new());
        let sets = layout.bends.tuples.sets.len().max(layout.skewed.tuples.sets.len()).max(layout.hubs.sets());
        for set in 0..sets {
            self.stencils(&layout.bends, set, weights, span, BendingScale::Bend, &mut pushes);
            self.stencils(&layout.skewed, set, weights, span, BendingScale::Skewed, &mut pushes);
            self.hubs(&layout.hubs, set, span, &mut pushes);
        }
        // By particle, each one's in their order.
        pushes.sort_by_key(|(particle, _)| *particle);
        let mut pushes = pushes.into_iter().filter(|(p, _)| weights[*p as usize] > 0.0).peekable();
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        for particle in 0..weights.len() as u32 {
            while let Some((_, entry)) = pushes.next_if(|(p, _)| *p == particle) {
                self.entries.push(entry);
            }
            self.starts.push(self.entries.len() as u32);
        }
        self.ranges.push(begun..self.items.len());
        self.groups.add(span.garment, begun as u32, (self.items.len() - begun) as u32, 0);
    }

    fn stencils<const K: usize>(
        &mut self,
        bends: &Bends<K>,
        set: usize,
        weights: &[f32],
        span: GarmentSpan,
        scale: fn(u32) -> BendingScale,
        pushes: &mut Pushes,
    ) {
        let Some(set) = bends.tuples.sets.get(set) else { return };
        for share in &set.shares {
            let first = self.items.len() as u32;
            let laid = self.runs(bends, share, span, scale);
            for (c, chunk) in laid.chunks(CHUNK).enumerate() {
                for k in 0..K {
                    for (j, (run, t)) in chunk.iter().enumerate() {
                        let v = run.first[k] + t;
                        let heavy = if run.alike { run.first[k] } else { v };
                        let by = bends.coefficients[k][run.place(*t)] * weights[heavy as usize];
                        pushes.push((v, [first + (c * CHUNK + j) as u32, by.to_bits()]));
                    }
                }
            }
            for (k, i) in share.loose.clone().enumerate() {
                let (v, at) = (bends.tuples.loose[i as usize], share.loose_at as usize + k);
                let number = self.items.len() as u32;
                self.curvature(v, |k| bends.coefficients[k][at], scale(at as u32), span);
                for (k, &v) in v.iter().enumerate() {
                    pushes.push((v, [number, (bends.coefficients[k][at] * weights[v as usize]).to_bits()]));
                }
            }
        }
    }

    /// The curvatures of a share's runs; gives the stencils, a run and a place in it each.
    fn runs<const K: usize>(
        &mut self,
        bends: &Bends<K>,
        share: &OwnerShare,
        span: GarmentSpan,
        scale: fn(u32) -> BendingScale,
    ) -> Vec<(ConstraintRun<K>, u32)> {
        let mut laid = Vec::new();
        for run in &bends.tuples.runs[share.runs.start as usize..share.runs.end as usize] {
            for t in 0..run.len {
                let at = run.place(t);
                self.curvature(run.first.map(|f| f + t), |k| bends.coefficients[k][at], scale(at as u32), span);
                laid.push((*run, t));
            }
        }
        laid
    }

    fn curvature(
        &mut self,
        particles: impl IntoIterator<Item = u32>,
        coefficient: impl Fn(usize) -> f32,
        scale: BendingScale,
        span: GarmentSpan,
    ) {
        let first = self.terms.len();
        let terms = particles.into_iter().enumerate().map(|(k, v)| [span.first + v, coefficient(k).to_bits()]);
        self.terms.extend(terms);
        self.items.push([first as u32, (self.terms.len() - first) as u32]);
        self.scales.push(1.0);
        self.sources.push(scale);
    }

    fn hubs(&mut self, hubs: &Hubs, set: usize, span: GarmentSpan, pushes: &mut Pushes) {
        let Some(owners) = hubs.sets.get(set) else { return };
        for group in (0..OWNERS).flat_map(|o| &hubs.groups[owners[o].start as usize..owners[o].end as usize]) {
            let (points, sums) = (group.points as usize, group.sums as usize);
            for hub in 0..group.count as usize {
                let v = &hubs.particles[group.particles as usize + hub * points..][..points];
                let c = &hubs.coefficients[group.coefficients as usize + hub * points * sums..][..points * sums];
                let number = self.items.len() as u32;
                for sum in 0..sums {
                    let scale = BendingScale::Hub(group.number + hub as u32);
                    self.curvature(v.iter().copied(), |k| c[k * sums + sum], scale, span);
                }
                pushes.extend(v.iter().enumerate().map(|(k, &v)| (v, [number | group.sums << 30, k as u32])));
            }
        }
    }

    /// Writes a garment's scales, which its settings have made; gives the range of curvatures.
    pub fn prepare(&mut self, garment: usize, scale: impl Fn(BendingScale) -> f32) -> std::ops::Range<usize> {
        let range = self.ranges[garment].clone();
        for (to, source) in self.scales[range.clone()].iter_mut().zip(&self.sources[range.clone()]) {
            *to = scale(*source);
        }
        range
    }
}
