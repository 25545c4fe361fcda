//! Records: each particle's place and inverse mass side by side, for what meets particles in no order.
//!
//! A column is the better form where particles lie side by side; where they do not, three coordinates are three lines of
//! memory in columns and one in records. So what bends or links particles in no order works on records: they are filled
//! before and, where they were changed, read back after.

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, RECORD, RecordRun, Records, V3, WriteColumn};

/// Fills the records of one owner's particles from columns.
pub struct FillRecords<'a> {
    /// What is filled in: places, or what bends in their stead (m, or m/s).
    pub from: [WriteColumn<'a>; 3],
    /// Inverse masses (1/kg).
    pub w: WriteColumn<'a>,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
    /// The records, a particle each.
    pub records: WriteColumn<'a>,
}

impl Kernel for FillRecords<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let to = RecordRun(self.records);
        for &(first, len) in self.spans {
            let (mut at, end) = (first as usize, (first + len) as usize);
            while at + L::N <= end {
                let V3 { x, y, z } = V3::<L>::load(self.from, at, L::N);
                L::store_records([x, y, z, L::load(self.w, at)], to, at);
                at += L::N;
            }
            for at in at..end {
                (0..3).for_each(|axis| to.set(at, axis, self.from[axis].get(at)));
                to.set(at, RECORD - 1, self.w.get(at));
            }
        }
    }
}

/// Reads the places of one owner's particles back from their records.
pub struct ReadRecords<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
    /// The records, a particle each.
    pub records: WriteColumn<'a>,
}

impl Kernel for ReadRecords<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (from, to) = (RecordRun(self.records), self.columns.level().x);
        for &(first, len) in self.spans {
            let (mut at, end) = (first as usize, (first + len) as usize);
            while at + L::N <= end {
                let [x, y, z, _] = L::load_records(from, at);
                V3 { x, y, z }.store(to, at, L::N);
                at += L::N;
            }
            for at in at..end {
                (0..3).for_each(|axis| to[axis].set(at, from.get(at, axis)));
            }
        }
    }
}
