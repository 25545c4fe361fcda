//! The normal equations of one iteration: the pictures' part, summed a triangle at a time by two threads, and the surface's own.
//!
//! The split is by triangles, whose sums are added in their order afterwards, so that one thread or two give the same bits.

use glam::DVec3;
use toile_engine::lanes::{Kernel, Lanes, Width};

use super::references::PRINTED;
use super::residual::{CLIPPED, LevelView, PatchSums, TriangleTerm, samples};
use super::state::{FlowState, SEEN};
use crate::plane::Pyramid;

/// Least and most standard deviation that residuals are taken to have (of 255).
const SCATTER: [f32; 2] = [1.5, 25.0];

/// Robust residual in standard deviations.
const ROBUST: f32 = 3.0;

/// Neighbouring samples share pixels, and their noise with them: so many count as one.
const SHARED: f64 = 4.0;

/// A triangle whose pictures correlate less than the first with what was seen shows something else; more than the second, itself.
/// At coarse levels a triangle may still lie beside its place.
const CORRELATED: [f32; 2] = [0.3, 0.7];
const COARSELY: [f32; 2] = [0.0, 0.5];

/// Levels from which on it counts as coarse.
const COARSE: usize = 2;

/// Correlation from which a triangle's brightness is adjusted: one beside its place says nothing of it.
const ADJUSTED: f32 = 0.8;

/// Standard deviation of a normal deviate over its mean size.
const NORMAL: f64 = 1.2533;

/// What the sums of one iteration came to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Pass {
    /// Mean size of the residuals of the triangles that cameras placed (of 255).
    pub cost: f64,
    /// Triangles that enough cameras placed.
    pub placed: usize,
    /// Standard deviation of the residuals (of 255).
    pub scatter: f32,
}

/// What the threads of one iteration share.
struct Work<'a> {
    views: &'a [LevelView<'a>],
    level: usize,
    masks: &'a [Vec<f32>],
    /// Standard deviation that residuals are taken to have (of 255).
    scatter: f32,
}

/// The triangles that one thread sums.
struct TriangleRange<'a, 'w> {
    state: &'a FlowState,
    work: &'a Work<'w>,
    /// Number of the first.
    first: usize,
    terms: &'a mut [TriangleTerm],
    sums: &'a mut [PatchSums],
}

impl Kernel for TriangleRange<'_, '_> {
    type Out = ();

    /// The same additions in the same order at every width: only how many of a row are made at once differs.
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.state.sum(self.work, self.first, self.terms, self.sums);
    }
}

impl FlowState {
    /// Sums the normal equations at the current positions.
    pub fn pass(
        &mut self,
        pyramids: &[Pyramid],
        level: usize,
        masks: &[Vec<f32>],
        carried: &[DVec3],
        scatter: f32,
    ) -> Pass {
        let views: Vec<LevelView> = pyramids.iter().enumerate().map(|(c, p)| self.view(c, p, level)).collect();
        let count = self.surface.triangles.len();
        let (mut terms, mut sums) = std::mem::take(&mut self.scratch);
        terms.clear();
        terms.resize(count, TriangleTerm::NONE);
        // What is in them is of the iteration before, and written over.
        sums.resize(count * views.len(), PatchSums::NONE);
        let half = count.div_ceil(2);
        let this = &*self;
        let work = Work { views: &views, level, masks, scatter };
        std::thread::scope(|scope| {
            let (left, right) = terms.split_at_mut(half);
            let (sums_left, sums_right) = sums.split_at_mut(half * views.len());
            let (work, width) = (&work, Width::widest());
            let later = TriangleRange { state: this, work, first: half, terms: right, sums: sums_right };
            scope.spawn(move || width.run(later));
            width.run(TriangleRange { state: this, work, first: 0, terms: left, sums: sums_left });
        });
        let pass = self.gather(&terms, &sums, carried);
        self.scratch = (terms, sums);
        pass
    }

    /// Sums of the triangles from `first` on.
    #[inline(always)]
    fn sum(&self, work: &Work, first: usize, terms: &mut [TriangleTerm], sums: &mut [PatchSums]) {
        let scatter = work.scatter;
        let c2 = (ROBUST * scatter).powi(2);
        let unit = 1.0 / (SHARED * f64::from(scatter).powi(2));
        let cameras = work.views.len();
        for (k, (term, sums)) in terms.iter_mut().zip(sums.chunks_exact_mut(cameras)).enumerate() {
            let t = first + k;
            let corners = self.surface.triangles[t].map(|v| self.positions[v as usize]);
            for (c, (view, sums)) in work.views.iter().zip(sums.iter_mut()).enumerate() {
                let level = &self.levels[work.level];
                let of = samples(level, &work.masks[c], c, t, self.settings.channels);
                let (axes, tone) = (corners.map(|p| view.axes(p)), self.tones[c][t]);
                *sums = match self.settings.channels {
                    1 => view.sums::<1>(axes, &of, tone, c2),
                    _ => view.sums::<3>(axes, &of, tone, c2),
                };
                let trust = self.trust(sums, of.shares.len(), work.level);
                if trust > 0.0 {
                    let weight = unit * f64::from(trust) * self.views[c].facing[t].abs();
                    term.add(sums, &view.rotation, weight);
                    term.cameras += 1;
                }
            }
            if (term.cameras as usize) < self.settings.cameras {
                *term = TriangleTerm { cameras: term.cameras, ..TriangleTerm::NONE };
            }
        }
    }

    /// How far a triangle's picture is taken to show the triangle, 0 to 1.
    fn trust(&self, sums: &PatchSums, samples: usize, level: usize) -> f32 {
        if sums.count < SEEN * samples as f32 {
            return 0.0;
        }
        let (correlation, print) = sums.agreement(self.settings.channels);
        if print < PRINTED {
            return 1.0;
        }
        let [none, whole] = if level >= COARSE { COARSELY } else { CORRELATED };
        ((correlation - none) / (whole - none)).clamp(0.0, 1.0)
    }

    fn gather(&mut self, terms: &[TriangleTerm], sums: &[PatchSums], carried: &[DVec3]) -> Pass {
        self.system.clear();
        let mut pass = Pass::default();
        let (mut absolute, mut counted) = (0.0, 0.0);
        for (term, (places, corners)) in terms.iter().zip(self.places.iter().zip(&self.surface.triangles)) {
            if term.cameras as usize >= self.settings.cameras {
                pass.placed += 1;
                absolute += term.absolute;
                counted += term.count;
                for (k, place) in places.iter().enumerate() {
                    let (i, j) = (k / 3, k % 3);
                    let of = [[0, 1, 2], [1, 3, 4], [2, 4, 5]][i][j];
                    // A block is symmetric, so that it stands on both sides as it is.
                    self.system.blocks[*place] += term.normal[of];
                }
                for (v, right) in corners.iter().zip(term.right) {
                    self.system.right[*v as usize] += right;
                }
            }
        }
        self.energy.add(&mut self.system, &self.positions, carried, &self.settings);
        let (cameras, channels) = (self.cameras.len(), self.settings.channels);
        if self.settings.brightness {
            for (k, sums) in sums.iter().enumerate().filter(|(_, s)| s.agreement(channels).0 > ADJUSTED) {
                self.tones[k % cameras][k / cameras] = sums.tone(channels);
            }
        }
        pass.cost = if counted > 0.0 { absolute / (counted * channels as f64) } else { f64::from(CLIPPED) };
        pass.scatter = ((NORMAL * pass.cost) as f32).clamp(SCATTER[0], SCATTER[1]);
        pass
    }
}
