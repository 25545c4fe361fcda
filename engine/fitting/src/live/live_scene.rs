//! The scene as the physics thread steps it, with a report of each step for its watchers. Another one takes its place by
//! the loop's own handover ([`toile_engine::frame_loop::handover`]); the replaced scene is dropped elsewhere.

use std::sync::Arc;

use toile_base::frame::Joints;
use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::handover::HandoverSender;
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::quality_control::{QUALITY_LEVELS, QualityLevel};
use toile_engine::frame_loop::queue::Sender;
use toile_engine::frame_loop::render_thread::{RenderThread, Renderer, SceneView};
use toile_engine::meter::PERIOD_NS;
use toile_engine::world::SnapshotTimes;

use super::running::Restart;
use super::watchdog::Progress;

/// Step reports that wait to be counted: eight seconds.
pub const STEP_REPORTS: usize = 1024;

/// Name of this capacity in reports and warnings.
pub const STEP_REPORTS_NAME: &str = "STEP_REPORTS (queue of step reports)";

/// Report of one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StepReport {
    /// From its begin to its publication (ns).
    pub step_ns: u64,
    /// Whether it was published after its period.
    pub late: bool,
    /// The quality level: 0 is whole quality.
    pub level: u8,
    /// Steps so far that were rolled back, because of a NaN or an infinity.
    pub nonfinite: u64,
}

/// What stays where scenes come and go.
#[derive(Debug)]
struct StepReporting {
    /// Queue of the step reports.
    reports: Sender<StepReport>,
    /// Counts of steps and pictures, for the watchdog.
    progress: Arc<Progress>,
    /// Steps that were rolled back by those who have left: their own counts begin at 0.
    past: u64,
}

/// A scene as physics steps it.
#[derive(Debug)]
pub struct LiveScene<S> {
    scene: S,
    /// Where it stands still, whatever the sensor sees; none follows the sensor.
    still: Option<Joints>,
    place: u8,
    /// Of the scene that is stepped; the others have none.
    reporting: Option<Box<StepReporting>>,
}

impl<S: LoopScene> LiveScene<S> {
    /// A scene that waits for its turn, or that a replay steps. At load.
    pub fn new(scene: S, still: Option<Joints>) -> Self {
        Self { scene, still, place: 0, reporting: None }
    }

    /// The same as the first that is stepped.
    #[must_use]
    pub fn reporting(self, reports: Sender<StepReport>, progress: Arc<Progress>) -> Self {
        Self { reporting: Some(Box::new(StepReporting { reports, progress, past: 0 })), ..self }
    }

    /// The scene that is stepped.
    pub fn scene(&self) -> &S {
        &self.scene
    }

    /// The scene itself, when it is stepped no more.
    pub fn into_scene(self) -> S {
        self.scene
    }
}

impl<S: LoopScene> LoopScene for LiveScene<S> {
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock) {
        let joints = self.still.as_ref().unwrap_or(joints);
        self.scene.step(joints, times, clock);
        let Some(reporting) = &mut self.reporting else { return };
        let ended = clock.now_ns();
        reporting.progress.step();
        let [_, nonfinite] = self.scene.fault_counts();
        let step_ns = ended.saturating_sub(times.begun_ns);
        let late = ended.saturating_sub(times.scheduled_ns) > PERIOD_NS;
        reporting.reports.push(StepReport { step_ns, late, level: self.place, nonfinite: reporting.past + nonfinite });
    }

    fn set_level(&mut self, level: &QualityLevel) {
        self.place = QUALITY_LEVELS.iter().position(|r| r == level).unwrap_or_default() as u8;
        self.scene.set_level(level);
    }

    fn measure(&mut self) {
        self.scene.measure();
    }

    fn clear_meters(&mut self) {
        self.scene.clear_meters();
    }

    fn fingerprint(&self) -> u64 {
        self.scene.fingerprint()
    }

    fn inject_fault(&mut self, seed: u64) {
        self.scene.inject_fault(seed);
    }

    fn take_workers_from(&mut self, before: &mut Self) {
        self.scene.take_workers_from(&mut before.scene);
        std::mem::swap(&mut self.reporting, &mut before.reporting);
        let ([_, left], [_, came_with]) = (before.scene.fault_counts(), self.scene.fault_counts());
        if let Some(reporting) = &mut self.reporting {
            reporting.past = (reporting.past + left).saturating_sub(came_with);
        }
    }

    fn fault_counts(&self) -> [u64; 2] {
        self.scene.fault_counts()
    }
}

/// The render loop, whose pictures the watchdog counts.
pub struct WatchedRenderer<E: Renderer, C> {
    /// The loop itself.
    pub render: RenderThread<E, C>,
    progress: Arc<Progress>,
}

impl<E: Renderer, C: Clock> WatchedRenderer<E, C> {
    /// The loop, with its progress watched.
    pub fn new(render: RenderThread<E, C>, progress: Arc<Progress>) -> Self {
        Self { render, progress }
    }
}

impl<E: Renderer, C: Clock> Restart for WatchedRenderer<E, C> {
    fn restarted(self) -> Self {
        Self { render: self.render.begun_again(), ..self }
    }
}

impl<E: Renderer, C: Clock> ThreadLoop for WatchedRenderer<E, C> {
    fn run_due(&mut self) -> Option<u64> {
        let next = self.render.run_due();
        self.progress.pictures(self.render.pictures);
        next
    }
}

/// The ends by which scenes are handed over.
pub struct SceneHandover<S, O> {
    /// Hands scenes to the physics thread.
    pub scenes: HandoverSender<LiveScene<S>>,
    /// Hands what is drawn to the render thread.
    pub views: HandoverSender<SceneView<O>>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_engine::clock::SimClock;
    use toile_engine::frame_loop::physics_thread::SceneStepper;
    use toile_engine::frame_loop::queue::bounded;

    /// A scene that says what it was asked.
    #[derive(Debug, Default)]
    struct Said {
        name: u8,
        crew: u8,
        rolled_back: u64,
        substeps: f32,
        seen_ns: Vec<u64>,
    }

    impl LoopScene for Said {
        fn step(&mut self, joints: &Joints, _times: SnapshotTimes, _clock: &impl Clock) {
            self.seen_ns.push(joints.time_ns);
            self.rolled_back += 1;
        }
        fn set_level(&mut self, level: &QualityLevel) {
            self.substeps = level.substep_share;
        }
        fn measure(&mut self) {}
        fn clear_meters(&mut self) {}
        fn fingerprint(&self) -> u64 {
            u64::from(self.name)
        }
        fn take_workers_from(&mut self, before: &mut Self) {
            std::mem::swap(&mut self.crew, &mut before.crew);
        }
        fn fault_counts(&self) -> [u64; 2] {
            [0, self.rolled_back]
        }
    }

    #[test]
    fn another_scene_takes_over_crew_quality_and_counts() {
        let (reports, mut reported) = bounded(STEP_REPORTS_NAME, STEP_REPORTS);
        let progress = Arc::new(Progress::default());
        let first = Said { name: 1, crew: 9, ..Said::default() };
        let stage = LiveScene::new(first, Some(Joints::absent(7))).reporting(reports, progress.clone());
        let (mut stepper, clock) = (SceneStepper::new(stage), SimClock::default());
        stepper.set_level(1);
        stepper.step(0, 0, &clock);
        let mut other = LiveScene::new(Said { name: 2, ..Said::default() }, None);
        stepper.change(&mut other, true);
        stepper.step(0, 0, &clock);
        let now = stepper.scene.scene();
        assert_eq!((now.name, now.crew, now.substeps), (2, 9, QUALITY_LEVELS[1].substep_share));
        assert_ne!(now.seen_ns, [7], "it follows the sensor");
        let before = other.scene();
        assert_eq!((before.name, before.crew, &before.seen_ns[..]), (1, 0, &[7][..]), "it stood still");
        // Back on, with the counts that it left with.
        stepper.change(&mut other, true);
        stepper.step(0, 0, &clock);
        let reports: Vec<(u8, u64)> = std::iter::from_fn(|| reported.pop()).map(|b| (b.level, b.nonfinite)).collect();
        assert_eq!(reports, [(1, 1), (1, 2), (1, 3)], "no count begins anew");
        assert_eq!(progress.count(), [3, 0]);
    }
}
