//! Tethers: no particle gets farther from where the garment hangs than the cloth between them is long.
//!
//! Long-range attachments (Kim, Chentanez, Mueller-Fischer 2012), with the length measured along the cloth. They only
//! draw in, so they add no stiffness to what hangs as it should.

use toile_base::garment::layout::Tethers;

use crate::cloth::state::ParticleColumns;
use crate::lanes::{Kernel, Lanes, Mask, ReadColumn, Readable, V3, WriteColumn, reciprocal_root};

/// Slack of a tether, as a share of its length: cloth that stretches as fabrics do never meets it.
const SLACK: f32 = 1.02;

/// Limits the distance of one owner's particles from where the garment is held.
pub struct HoldTethers<'a> {
    /// The garment's particles.
    pub columns: ParticleColumns<'a>,
    /// All tethers of the garment.
    pub tethers: &'a Tethers,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
}

impl Kernel for HoldTethers<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let c = self.columns;
        let lengths = ReadColumn::new(&self.tethers.length);
        for &(first, len) in self.spans {
            let (mut at, end) = (first as usize, (first + len) as usize);
            while at < end {
                let n = (end - at).min(L::N);
                let anchor = V3::<L>::gather(c.x, &self.tethers.anchor[at..at + n], n);
                let x = V3::<L>::load(c.x, at, n);
                let length = part::<L>(lengths, at, n) * L::splat(SLACK);
                let moves = L::splat(0.0).lt(part(c.w, at, n));
                let d = x - anchor;
                let size2 = d.dot(d);
                let free = moves.and(L::splat(0.0).lt(length));
                let taut = (length * length).lt(size2).and(free);
                if taut.any() {
                    let held = anchor + d * (length * reciprocal_root(size2));
                    let held = held.select(taut, x);
                    // An anchor, which the other owner may be reading, is not written, not even its own value.
                    if moves.bits() == u32::MAX >> (u32::BITS as usize - n) {
                        held.store(c.x, at, n);
                    } else {
                        store_some(held, moves, c.x, at, n);
                    }
                }
                at += n;
            }
        }
    }
}

/// `n <= N` numbers side by side.
#[inline(always)]
fn part<L: Lanes>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

/// Writes those of `n` vectors that a mask names.
#[inline(always)]
fn store_some<L: Lanes>(v: V3<L>, mask: L::Mask, to: [WriteColumn<'_>; 3], at: usize, n: usize) {
    for (to, numbers) in to.into_iter().zip([v.x, v.y, v.z].map(L::to_array)) {
        (0..n).filter(|lane| mask.bits() >> lane & 1 != 0).for_each(|lane| to.set(at + lane, numbers[lane]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::state::State;
    use crate::lanes::Width;
    use glam::Vec3;

    #[test]
    fn what_strays_is_drawn_back_and_nothing_else_moves() {
        let positions = [Vec3::ZERO, Vec3::X * 3.0, Vec3::X * 0.5, Vec3::Y * 9.0];
        for width in Width::ALL {
            let mut state = State::new(&positions, &[0.0, 1.0, 1.0, 1.0]);
            let tethers = Tethers { anchor: [0, 0, 0, 3].into(), length: [0.0, 1.0, 1.0, 0.0].into() };
            width.run(HoldTethers { columns: state.columns(), tethers: &tethers, spans: &[(0, 4)] });
            let x = state.positions()[0];
            assert!((x[1] - SLACK).abs() < 1e-5 && x[2] == 0.5, "{x:?}");
            assert_eq!(state.positions()[1], [0.0, 0.0, 0.0, 9.0], "what is attached nowhere is left alone");
        }
    }
}
