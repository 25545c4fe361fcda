//! Diagonals: the bake's rows, followed fiber by fiber.

use toile_base::garment::layout::{DiagonalShare, Diagonals};

use super::{GarmentSpan, WIDTH, Workgroups};

/// Fibers along the bias, of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatDiagonals {
    /// First particle of each fiber, its first slot, its links, how far apart its slots are `[fibers]`.
    pub heads: Vec<[u32; 4]>,
    /// The particle that each link leads to `[slots]`.
    pub leads: Vec<u32>,
    /// Rest length (m), compliance (m/N), weights of both ends (1/kg) `[slots]`.
    pub measures: Vec<[f32; 4]>,
    /// Families in the order of solving.
    pub families: Vec<Workgroups>,
}

/// A link of a fiber: where it leads, and its measures.
type Link = (u32, [f32; 4]);

impl FlatDiagonals {
    /// Appends the fibers along the bias of one garment.
    pub fn add(&mut self, diagonals: &Diagonals, weights: &[f32], span: GarmentSpan) {
        for (f, strands) in diagonals.families.iter().enumerate() {
            let mut fibers = followed(diagonals, strands, weights);
            // Fibers of one workgroup are about as long.
            fibers.sort_by_key(|(_, links)| std::cmp::Reverse(links.len()));
            if self.families.len() <= f {
                self.families.push(Workgroups::default());
            }
            self.families[f].begin(span.garment);
            for some in fibers.chunks(WIDTH as usize) {
                self.interleave(some, f, span);
            }
        }
    }

    fn interleave(&mut self, fibers: &[(u32, Vec<Link>)], family: usize, span: GarmentSpan) {
        let (head, slot, apart) = (self.heads.len() as u32, self.leads.len(), fibers.len());
        let longest = fibers.iter().map(|(_, links)| links.len()).max().unwrap_or(0);
        self.leads.resize(slot + longest * apart, 0);
        self.measures.resize(slot + longest * apart, [0.0; 4]);
        for (lane, (start, links)) in fibers.iter().enumerate() {
            self.heads.push([span.first + start, (slot + lane) as u32, links.len() as u32, apart as u32]);
            for (k, (to, measure)) in links.iter().enumerate() {
                self.leads[slot + lane + k * apart] = span.first + to;
                self.measures[slot + lane + k * apart] = *measure;
            }
        }
        self.families[family].push([span.garment, head, apart as u32, 0]);
    }
}

/// A family's fibers: where each begins, and its links.
fn followed(diagonals: &Diagonals, strands: &[DiagonalShare], weights: &[f32]) -> Vec<(u32, Vec<Link>)> {
    let mut next: Vec<Option<Link>> = vec![None; weights.len()];
    for strand in strands {
        for run in &diagonals.runs[strand.runs.start as usize..strand.runs.end as usize] {
            for t in 0..run.len {
                let [a, b] = run.first.map(|f| f + t);
                let [wa, wb] = (if run.alike { run.first } else { [a, b] }).map(|p| weights[p as usize]);
                let place = run.place(t);
                next[a as usize] = Some((b, [diagonals.rest[place], diagonals.compliance[place], wa, wb]));
            }
        }
    }
    let starts = strands.iter().flat_map(|s| &diagonals.starts[s.starts.start as usize..s.starts.end as usize]);
    let mut fibers = Vec::new();
    for &start in starts {
        let (mut at, mut links) = (start, Vec::new());
        while let Some(link) = next[at as usize].take() {
            at = link.0;
            links.push(link);
        }
        if !links.is_empty() {
            fibers.push((start, links));
        }
    }
    fibers
}
