//! Bending: the rows of the garments' matrices, a particle's entries in the order in which the CPU adds them up.

use std::ops::Range;

use toile_engine::cloth::forces::bending_matrix::BendingMatrix;

use super::GarmentSpan;

/// Matrices of all garments.
#[derive(Debug, Clone, Default)]
pub struct FlatBending {
    /// Where each particle's entries begin `[particles + 1]`.
    pub starts: Vec<u32>,
    /// A neighbour, and the bits of its value (1/s2).
    pub entries: Vec<[u32; 2]>,
    /// Each garment's particles, and its entries `[garments]`.
    ranges: Vec<[Range<usize>; 2]>,
}

impl FlatBending {
    /// Appends a garment's.
    pub fn add(&mut self, matrix: &BendingMatrix, span: GarmentSpan) {
        let mut rows = vec![Vec::new(); span.len as usize];
        matrix.for_each_row(|i, entries| {
            rows[i as usize] = entries.map(|(j, value)| [span.first + j, value.to_bits()]).collect();
        });
        let begun = self.entries.len();
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        for row in rows {
            self.entries.extend(row);
            self.starts.push(self.entries.len() as u32);
        }
        let particles = span.first as usize..(span.first + span.len) as usize;
        self.ranges.push([particles, begun..self.entries.len()]);
    }

    /// Writes a garment's values, which its settings have made; gives the range of entries.
    pub fn prepare(&mut self, garment: usize, matrix: &BendingMatrix) -> Range<usize> {
        let [particles, entries] = self.ranges[garment].clone();
        let (starts, all) = (&self.starts[particles], &mut self.entries);
        matrix.for_each_row(|i, row| {
            let first = starts[i as usize] as usize;
            all[first..].iter_mut().zip(row).for_each(|(entry, (_, value))| entry[1] = value.to_bits());
        });
        entries
    }
}
