//! The loop on its threads, by the system's clock, as the kiosk and the latency benchmark run it.

use std::io;

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::queue::Capacity;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::frame_loop::sensor_thread::FrameSource;
use toile_engine::meter::PERIOD_NS;

use super::assembly::{self, LoopOptions, LoopParts, LoopQueues, PhysicsLoop, RenderLoop, SensorLoop};
use super::lateness::ThreadAccount;
use super::live_scene::SceneHandover;
use super::running::{EndedLoops, RunningLoop};

/// Periods between the start of the threads and the first step, so that none of them is late for it.
const START_PERIODS: u64 = 2;

/// The threads, on the system's clock.
pub type LiveThreads<S, E, F> = RunningLoop<
    SensorLoop<F, RealClock>,
    PhysicsLoop<S, RealClock, ThreadAccount>,
    RenderLoop<E, RealClock>,
    RealClock,
>;

/// What they left when they ended.
pub type EndedLive<S, E, F> =
    EndedLoops<SensorLoop<F, RealClock>, PhysicsLoop<S, RealClock, ThreadAccount>, RenderLoop<E, RealClock>>;

/// The loop while it runs.
pub struct LiveLoop<S: LoopScene, E: Renderer, F: FrameSource> {
    /// The threads of sensor, physics and renderer.
    pub threads: LiveThreads<S, E, F>,
    /// Queues of what the threads report.
    pub queues: LoopQueues,
}

impl<S, E, F> LiveLoop<S, E, F>
where
    S: LoopScene + Send + 'static,
    E: Renderer + 'static,
    F: FrameSource + 'static,
{
    /// Joins the parts and starts the threads. Also gives the ends by which scenes are handed over.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(
        parts: LoopParts<S, E, F, ThreadAccount>,
        clock: RealClock,
        options: LoopOptions,
    ) -> io::Result<(Self, SceneHandover<S, E::Outfit>)> {
        let begin_ns = options.begin_ns.max(clock.now_ns() + START_PERIODS * PERIOD_NS);
        let assembly = assembly::assemble(parts, &clock, LoopOptions { begin_ns, ..options });
        let threads = RunningLoop::start(assembly.loops, clock)?;
        Ok((Self { threads, queues: assembly.queues }, assembly.handover))
    }

    /// The time on the loop's clock (ns).
    pub fn now_ns(&self) -> u64 {
        self.threads.clock().now_ns()
    }

    /// Ends the threads. Also gives how full the queues were.
    pub fn end(self) -> (EndedLive<S, E, F>, [Capacity; 3]) {
        let capacities = self.queues.capacities();
        (self.threads.end(), capacities)
    }
}
