//! One step of all garments of an outfit, substep by substep together.

use std::sync::Arc;

use toile_base::garment::{Garment, Layout};
use toile_base::limits::MAX_GARMENTS;

use super::GarmentContact;
use super::pace::PairPace;
use super::work::{LayerParts, LayerWork};
use crate::cloth::{Cloth, Settings, Step};
use crate::workers::{SharePanicked, WorkerPool};

impl GarmentContact {
    /// Whether these settings ask for any of it.
    pub fn asked(&self, settings: &Settings) -> bool {
        let every = settings.contact;
        self.pairs.iter().any(|p| p.every(every) > 0)
    }

    /// Whether these are the garments that the layers were made of, each with a state of its own; counts what it refuses.
    fn accepts(&mut self, cloths: &[Cloth], garments: &[Garment]) -> bool {
        let same = |(layout, garment): (&Arc<Layout>, &Garment)| Arc::ptr_eq(layout, garment.shared_layout());
        let accepted = cloths.len() == garments.len()
            && self.layouts.len() == garments.len()
            && self.layouts.iter().zip(garments).all(same)
            && cloths.iter().zip(garments).all(|(cloth, garment)| cloth.is_of(garment));
        self.counts.refused += u64::from(!accepted);
        accepted
    }

    /// Forgets what was found, because no step will be made with it.
    pub fn forget(&mut self) {
        self.paces.iter_mut().for_each(PairPace::forget);
    }

    /// One step of the garments that these layers were made of, each worker its owner's particles of each: the same bits with one
    /// worker.
    /// All take as many substeps as the garment that asks for most. Other garments than the layers' own, and states of others, are
    /// refused and counted ([`super::GarmentContactCounts::refused`]).
    ///
    /// # Errors
    /// Where a worker panicked: the garments then keep what they had published.
    #[expect(unsafe_code, reason = "the phases of a step are done in their order")]
    pub fn step(
        &mut self,
        pool: &mut WorkerPool,
        cloths: &mut [Cloth],
        garments: &[Garment],
        step: &Step<'_>,
    ) -> Result<(), SharePanicked> {
        if !self.accepts(cloths, garments) {
            return Ok(());
        }
        let asked = garments.iter().map(|g| step.settings.substeps_of(g.substeps)).max().unwrap_or(1);
        let mut settings = Settings { substeps: Some(asked), substep_share: 1.0, ..*step.settings };
        cloths.iter_mut().for_each(|cloth| settings = cloth.sound(&settings));
        let step = &Step { settings: &settings, ..*step };
        let mut works = heapless::Vec::<_, MAX_GARMENTS>::new();
        for (cloth, garment) in cloths.iter_mut().zip(garments) {
            let carried = cloth.begin(garment, step);
            // As many as there is room for were taken at load.
            let _ = works.push(cloth.work(garment, step, carried));
        }
        let substeps = asked as usize;
        let Self { surfaces, motions, pairs, paces, shares, touching, bearing, worker, turns, tick, .. } = self;
        for (place, (pair, pace)) in pairs.iter().zip(paces.iter_mut()).enumerate() {
            pace.decide(pair.every(settings.contact), *tick, place);
        }
        let parts = LayerParts { surfaces, pairs, paces, worker, turns: *turns, motions, shares, touching, bearing };
        let work = LayerWork::new(&works, parts, substeps);
        let done = pool.run(work.phases(), |phase, share| {
            // SAFETY: these layers and the cloths were made of these garments, as was checked above. `WorkerPool::run` does the phases of
            // this work in their order, each share once, with a barrier after each phase. `work` borrows the cloths and these layers
            // alone.
            unsafe { work.run(phase, share) };
        });
        let limited: heapless::Vec<u64, MAX_GARMENTS> = works.iter().map(|w| w.limited()).collect();
        let times = work.times();
        drop(work);
        drop(works);
        if step.settings.timed {
            // Those of all garments are the first one's.
            cloths.iter_mut().for_each(|cloth| cloth.stage_ns = Default::default());
            cloths.iter_mut().take(1).for_each(|cloth| cloth.stage_ns = times);
        }
        for ((cloth, garment), limited) in cloths.iter_mut().zip(garments).zip(limited) {
            cloth.end(garment, step, limited, done.is_err());
        }
        self.tick += 1;
        self.counts.add(&self.shares);
        done
    }
}
