//! One step of all garments of an outfit, substep by substep together.

use toile_base::garment::Garment;
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

    /// Forgets what was found, because no step will be made with it.
    pub fn forget(&mut self) {
        self.paces.iter_mut().for_each(PairPace::forget);
    }

    /// One step of the garments that these layers were made of, each worker its owner's particles of each: the same bits with one
    /// worker.
    /// All take as many substeps as the garment that asks for most.
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
        let phases = work.phases();
        let done = pool.run(phases.count(), |phase, share| {
            // SAFETY: `WorkerPool::run` does the phases of this work in their order, each share once, with a barrier after each phase.
            // `work` borrows the cloths and these layers alone. Nothing checks yet that they were made of these garments: the caller
            // of `step` answers for that.
            unsafe { work.run(phases.at(phase), share) };
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
