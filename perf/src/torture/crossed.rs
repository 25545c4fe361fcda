//! Edges that pass through faces in the course of a trial, counted in f64.

use glam::{DVec3, Vec3A};

use toile_fitting::crossings::{CrossingTest, LOOKED_STEPS};

/// What is known of the crossings of a trial's cloths.
#[derive(Debug)]
pub struct CrossedEdges {
    test: CrossingTest,
    /// Crossings when it was last looked.
    pub now: u64,
    /// Most at one moment.
    pub most: u64,
    /// Step of the last look that saw any.
    pub last_step: u64,
    step: u64,
}

impl CrossedEdges {
    /// Of cloths with these triangles.
    pub fn new(triangles: &[&[[u32; 3]]]) -> Self {
        Self { test: CrossingTest::new(triangles), now: 0, most: 0, last_step: 0, step: 0 }
    }

    /// Counts those of cloths where they are: within each and between them.
    pub fn look(&mut self, cloths: &[&[Vec3A]]) {
        let exact: Vec<Vec<DVec3>> = cloths.iter().map(|c| c.iter().map(|p| p.as_dvec3()).collect()).collect();
        let all: Vec<&[DVec3]> = exact.iter().map(|c| &c[..]).collect();
        let within: usize = (0..all.len()).map(|c| self.test.within(c, all[c]).len()).sum();
        self.now = (within + self.test.between(&all).len()) as u64;
        self.most = self.most.max(self.now);
        if self.now > 0 {
            self.last_step = self.step;
        }
    }

    /// Counts them after a step, if it is one of those that are looked at.
    pub fn after_step(&mut self, cloths: &[&[Vec3A]]) {
        self.step += 1;
        if self.step.is_multiple_of(LOOKED_STEPS) {
            self.look(cloths);
        }
    }

    /// Forgets when any were seen: what comes from here on counts.
    pub fn restart(&mut self) {
        (self.most, self.last_step, self.step) = (0, 0, 0);
    }

    /// Time after which none were seen any more, in steps of so many seconds (s); none where some still are.
    pub fn free_after_s(&self, step_seconds: f32) -> Option<f32> {
        (self.now == 0).then_some(self.last_step as f32 * step_seconds)
    }
}
