//! Time of a unit of work on this machine, and the time of a scene that follows.

use toile_engine::meter::{CLOTH, PUBLISH};
use toile_engine::workers::SHARES;

use super::work::{KINDS, STAGES, Work};

/// Stages of a step, as the engine's budgets name them.
const STEP_STAGES: usize = toile_engine::meter::STAGES.len();

/// Times of units of work on this machine.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Costs {
    /// Time of a unit (us), in the order of [`super::work::UNITS`].
    pub unit_us: [[f64; KINDS]; STAGES.len()],
    /// Time of a barrier of two workers (us).
    pub barrier_us: f64,
    /// Time of a particle's copy into the snapshot (us).
    pub copy_us: f64,
    /// The frame without garments: pose, skin and place on this body, the body's part of the publication (us).
    pub body_us: [f64; STEP_STAGES],
}

/// Time of a step of one garment (us).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GarmentTime {
    /// By stage, both shares on one core.
    pub stages_us: [f64; STAGES.len()],
    /// Sum of the stages, on one worker.
    pub one_us: f64,
    /// Shared by two workers.
    pub two_us: f64,
}

impl Costs {
    /// Time of one garment with this work.
    pub fn garment(&self, work: &Work) -> GarmentTime {
        let time = |(counts, unit): (&[f64; KINDS], &[f64; KINDS])| counts.iter().zip(unit).map(|(n, us)| n * us).sum();
        let mut stages_us = [0.0; STAGES.len()];
        stages_us.iter_mut().zip(work.counts.iter().zip(&self.unit_us)).for_each(|(to, pair)| *to = time(pair));
        let one_us: f64 = stages_us.iter().sum();
        // Work outside of the phases is done by one worker.
        let alone = stages_us[STAGES.len() - 1];
        let two_us = alone + (one_us - alone) * work.share + work.phases * self.barrier_us;
        GarmentTime { stages_us, one_us, two_us: two_us.min(one_us) }
    }

    /// The stages of a step (us) with these garments, in the order of [`toile_engine::meter::STAGES`].
    pub fn step(&self, garments: &[GarmentTime], particles: usize, workers: usize) -> [f64; STEP_STAGES] {
        let mut stages = self.body_us;
        stages[CLOTH] = cloth_us(garments, workers);
        stages[PUBLISH] += particles as f64 * self.copy_us;
        stages
    }
}

/// All garments: one is shared by the workers; of several each goes to whichever worker is free.
fn cloth_us(garments: &[GarmentTime], workers: usize) -> f64 {
    match garments {
        [one] if workers > 1 => one.two_us,
        several => {
            let mut busy = [0.0f64; SHARES];
            for garment in several {
                let free = usize::from(workers > 1 && busy[1] < busy[0]);
                busy[free] += garment.one_us;
            }
            busy.into_iter().fold(0.0, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(one_us: f64) -> GarmentTime {
        GarmentTime { one_us, two_us: 0.6 * one_us, ..GarmentTime::default() }
    }

    #[test]
    fn one_garment_is_shared_several_are_distributed() {
        assert_eq!(cloth_us(&[of(1000.0)], 1), 1000.0);
        assert_eq!(cloth_us(&[of(1000.0)], 2), 600.0);
        assert_eq!(cloth_us(&[of(1000.0), of(700.0)], 1), 1700.0);
        assert_eq!(cloth_us(&[of(1000.0), of(700.0)], 2), 1000.0);
        assert_eq!(cloth_us(&[of(1000.0), of(700.0), of(400.0)], 2), 1100.0);
        assert_eq!(cloth_us(&[], 2), 0.0);
    }

    #[test]
    fn twice_the_work_takes_twice_and_barriers_cost() {
        let costs = Costs { unit_us: [[0.01; KINDS]; STAGES.len()], barrier_us: 0.5, ..Costs::default() };
        let work = |n: f64| Work { counts: [[n; KINDS]; STAGES.len()], phases: 10.0, share: 0.5, substeps: 4 };
        let [once, twice] = [1000.0, 2000.0].map(|n| costs.garment(&work(n)));
        assert!((twice.one_us - 2.0 * once.one_us).abs() < 1e-9);
        let alone = once.stages_us[STAGES.len() - 1];
        assert!((once.two_us - (alone + 0.5 * (once.one_us - alone) + 5.0)).abs() < 1e-9);
        let small = costs.garment(&work(1.0));
        assert_eq!(small.two_us, small.one_us, "what is too little to be shared is not slower for it");
    }
}
