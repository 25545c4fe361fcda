//! Tethers: no particle gets farther from where the garment hangs than the cloth between them is long.
//!
//! Long-range attachments (Kim, Chentanez, Mueller-Fischer 2012), with the length measured along the cloth. They only
//! draw in, so they add no stiffness to what hangs as it should.

use toile_assets::garment::layout::Tethers;

use super::state::Columns;
use crate::lanes::{Column, Kernel, Lanes, Mask, V3, reciprocal_root};

/// Slack of a tether, as a share of its length: cloth that stretches as fabrics do never meets it.
const SLACK: f32 = 1.02;

/// One owner's particles.
pub struct Hold<'a> {
    /// The garment's particles.
    pub columns: Columns<'a>,
    /// The tethers.
    pub tethers: &'a Tethers,
    /// Ranges of particles, `(first, len)`.
    pub spans: &'a [(u32, u32)],
}

impl Kernel for Hold<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let c = self.columns;
        let lengths = Column::read_only(&self.tethers.length);
        for &(first, len) in self.spans {
            let (mut at, end) = (first as usize, (first + len) as usize);
            while at < end {
                let n = (end - at).min(L::N);
                let anchor = V3::<L>::gather(c.x, &self.tethers.anchor[at..at + n], n);
                let x = V3::<L>::load(c.x, at, n);
                let part = |c| if n == L::N { L::load(c, at) } else { L::load_part(c, at, n) };
                let length = part(lengths) * L::splat(SLACK);
                let d = x - anchor;
                let size2 = d.dot(d);
                let free = L::splat(0.0).lt(part(c.w)).and(L::splat(0.0).lt(length));
                let taut = (length * length).lt(size2).and(free);
                if taut.any() {
                    let held = anchor + d * (length * reciprocal_root(size2));
                    held.select(taut, x).store(c.x, at, n);
                }
                at += n;
            }
        }
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
            width.run(Hold { columns: state.columns(), tethers: &tethers, spans: &[(0, 4)] });
            let x = state.positions()[0];
            assert!((x[1] - SLACK).abs() < 1e-5 && x[2] == 0.5, "{x:?}");
            assert_eq!(state.positions()[1], [0.0, 0.0, 0.0, 9.0], "what hangs nowhere is left alone");
        }
    }
}
