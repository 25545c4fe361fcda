//! Links as a list: every dispatch's side by side.

use std::ops::Range;

use toile_base::garment::layout::{ConstraintRun, Links, Zigzag};
use toile_engine::cloth::links::LinkGains;

use super::{GarmentSpan, Workgroups};

/// Links of one kind, of all garments, garment after garment.
#[derive(Debug, Clone, Default)]
pub struct FlatLinks {
    /// Both ends, and the bits of the weights (1/kg) that they count with `[links]`.
    pub ends: Vec<[u32; 4]>,
    /// Rest length (m), compliance (m/N), gain (see [`FlatLinks::prepare`]), 1 over the square of the rest length (1/m2)
    /// `[links]`.
    pub measures: Vec<[f32; 4]>,
    /// Where each link's gain is among those of its garment `[links]`.
    places: Vec<u32>,
    /// Each garment's links `[garments]`.
    ranges: Vec<Range<usize>>,
    /// Halves of sets, in the order of solving: straights, runs and loose links; then slants.
    pub halves: Vec<Workgroups>,
}

impl FlatLinks {
    /// Appends a garment's; `bit` is what the kernel asks the garment's bits for before it remembers tensions.
    pub fn add(&mut self, links: &Links, weights: &[f32], span: GarmentSpan, bit: u32) {
        let begun = self.ends.len();
        for (s, set) in links.tuples.sets.iter().enumerate() {
            for half in 0..2 {
                let first = self.ends.len();
                for share in &set.shares {
                    let zigzags = &links.tuples.zigzags[share.zigzags.start as usize..share.zigzags.end as usize];
                    for zigzag in zigzags {
                        if half == 0 {
                            self.row(links, &zigzag.straights, zigzag.straights.len, weights, span);
                        } else {
                            self.slants(links, zigzag, weights, span);
                        }
                    }
                    if half == 0 {
                        for run in &links.tuples.runs[share.runs.start as usize..share.runs.end as usize] {
                            self.row(links, run, run.len, weights, span);
                        }
                        for (k, i) in share.loose.clone().enumerate() {
                            let [a, b] = links.tuples.loose[i as usize];
                            let own = [a, b].map(|p| weights[p as usize]);
                            self.push(links, share.loose_at as usize + k, [a, b], own, span);
                        }
                    }
                }
                self.group(2 * s + half, first, span.garment, bit);
            }
        }
        self.ranges.push(begun..self.ends.len());
    }

    fn group(&mut self, half: usize, first: usize, garment: u32, bit: u32) {
        while self.halves.len() <= half {
            self.halves.push(Workgroups::default());
        }
        self.halves[half].add(garment, first as u32, (self.ends.len() - first) as u32, bit);
    }

    fn row(&mut self, links: &Links, run: &ConstraintRun<2>, len: u32, weights: &[f32], span: GarmentSpan) {
        for t in 0..len.min(run.len) {
            let ends = run.first.map(|f| f + t);
            // What is alike counts with the masses of the first.
            let counted = if run.alike { run.first } else { ends };
            self.push(links, run.place(t), ends, counted.map(|p| weights[p as usize]), span);
        }
    }

    fn slants(&mut self, links: &Links, zigzag: &Zigzag, weights: &[f32], span: GarmentSpan) {
        let slants = &zigzag.slants;
        let open = if zigzag.closed() { slants.len - 1 } else { slants.len };
        self.row(links, slants, open, weights, span);
        if zigzag.closed() {
            let t = slants.len - 1;
            let ends = zigzag.slant(t);
            let counted = if slants.alike { slants.first } else { ends };
            self.push(links, slants.place(t), ends, counted.map(|p| weights[p as usize]), span);
        }
    }

    fn push(&mut self, links: &Links, place: usize, [a, b]: [u32; 2], [wa, wb]: [f32; 2], span: GarmentSpan) {
        self.ends.push([span.first + a, span.first + b, wa.to_bits(), wb.to_bits()]);
        self.measures.push([links.rest[place], links.compliance[place], 0.0, 0.0]);
        self.places.push(place as u32);
    }

    /// Writes a garment's gains, which its settings have made; gives the range of links.
    pub fn prepare(&mut self, garment: usize, gains: &LinkGains) -> Range<usize> {
        let range = self.ranges[garment].clone();
        for (measure, place) in self.measures[range.clone()].iter_mut().zip(&self.places[range.clone()]) {
            (measure[2], measure[3]) = (gains.gain[*place as usize], gains.per_rest2[*place as usize]);
        }
        range
    }
}
