//! The service: polls everything fifty times a second and has a controller decide; it steps nothing and draws nothing itself.

use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use toile_base::frame::Joints;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::queue::Capacity;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::triple_buffer::Writer;
use toile_fitting::dress::try_on::TryOn;
use toile_fitting::live::background::BackgroundJob;
use toile_fitting::live::depth_camera::CameraHandle;
use toile_fitting::live::live_loop::{EndedLive, LiveLoop};
use toile_fitting::live::report::{Attributed, ThreadPlacement};
use toile_fitting::live::scene_changer::SceneChanger;
use toile_fitting::live::shopper_source::ShopperSource;
use toile_fitting::live::source::Feed;
use toile_fitting::live::watchdog::Watchdog;

use super::controller::{ControllerContext, SessionController, ToScene};
use super::health::{HealthCounter, HealthFigures};
use super::report::RunRecord;
use super::service_manager::{ServiceManager, ServiceStatus, StopSignal};
use super::session::SessionState;
use crate::error::KioskError;

/// Time between two rounds: the queues hold seconds, and a signal to end waits for no longer.
const POLL: Duration = Duration::from_millis(20);

/// Most states that are listed one by one.
const MOST_STATES: usize = 1000;

/// Settings of the service.
pub struct ServiceOptions {
    /// When the program was started.
    pub begun: Instant,
    /// When it ends by itself.
    pub length: Option<Duration>,
    /// When it panics, to see what a crash leaves.
    pub crash_after: Option<Duration>,
    /// Time between two health lines (ns); 0 is never.
    pub health_ns: u64,
    /// The recording that shoppers are measured from, where one is played.
    pub played: Option<ShopperSource>,
    /// Whether all memory is kept resident.
    pub memory_locked: bool,
    /// What did not go as it should before the loop began.
    pub warnings: Vec<String>,
}

/// What the service talks to beside the loop.
pub struct ServiceEnvironment<'a, S, O> {
    /// The service manager.
    pub manager: &'a dyn ServiceManager,
    /// Whether it is to end.
    pub stop: &'a StopSignal,
    /// Prints a health line.
    pub print_line: &'a dyn Fn(&str),
    /// Receives the figures, where metrics are served.
    pub figures: Option<Writer<HealthFigures>>,
    /// The request that every visitor begins with.
    pub first: Arc<TryOn>,
    /// Turns a dressed world into a scene of the loop, and into the data that the renderer needs.
    pub to_scene: ToScene<S, O>,
    /// How the mannequin stands.
    pub pose: Joints,
    /// What is kept for a crash, where the configuration asks for it.
    pub flight_recorder: Option<Arc<FlightRecorder>>,
}

/// What is left of a run: the loops, how full their queues were, and the record.
pub type ServiceEnd<S, E> = (EndedLive<S, E, Feed>, [Capacity; 3], RunRecord);

/// The service while it runs.
pub struct Service<'a, S: LoopScene, E: Renderer> {
    live: LiveLoop<S, E, Feed>,
    context: ControllerContext<S, E::Outfit>,
    controller: Box<dyn SessionController<S, E::Outfit> + 'a>,
    length: Option<Duration>,
    crash_after: Option<Duration>,
    begun: Instant,
    every_ns: u64,
    manager: &'a dyn ServiceManager,
    stop: &'a StopSignal,
    print_line: &'a dyn Fn(&str),
    figures: Option<Writer<HealthFigures>>,
    flight_recorder: Option<Arc<FlightRecorder>>,
    counter: HealthCounter,
    camera: Option<CameraHandle>,
    dog: Option<Watchdog>,
    /// The loop's time when it began, and when the next health line is due (ns).
    began_ns: u64,
    health_ns: u64,
    record: RunRecord,
}

impl<'a, S: LoopScene + Send + 'static, E: Renderer + 'static> Service<'a, S, E> {
    /// Over threads that have been started, with the controller that decides.
    pub fn new(
        live: LiveLoop<S, E, Feed>,
        changer: SceneChanger<S, E::Outfit>,
        controller: Box<dyn SessionController<S, E::Outfit> + 'a>,
        options: &ServiceOptions,
        environment: ServiceEnvironment<'a, S, E::Outfit>,
    ) -> Self {
        let now = live.now_ns();
        let threads = live.threads.placements().iter().cloned().map(ThreadPlacement::from).collect();
        let record = RunRecord {
            figures: HealthFigures::default(),
            ready_ms: None,
            states: vec![SessionState::Attract],
            attributed: Attributed::default(),
            revived: 0,
            threads,
            memory_locked: options.memory_locked,
            warnings: options.warnings.clone(),
        };
        let ServiceEnvironment { manager, stop, print_line, figures, first, to_scene, pose, flight_recorder } =
            environment;
        let camera = options.played.as_ref().and_then(ShopperSource::camera).cloned();
        Self {
            live,
            context: ControllerContext { changer, first, dressing: BackgroundJob::default(), to_scene, pose },
            controller,
            length: options.length,
            crash_after: options.crash_after,
            begun: options.begun,
            every_ns: options.health_ns,
            dog: Watchdog::new(manager.watchdog_timeout(), now),
            manager,
            stop,
            print_line,
            figures,
            flight_recorder,
            counter: HealthCounter::default(),
            camera,
            began_ns: now,
            health_ns: now + options.health_ns,
            record,
        }
    }

    /// Runs until it is asked to end or its time is over. Returns a record of the run, and of the loop's threads.
    ///
    /// # Errors
    /// Where a thread has ended that must not: the supervisor starts the service again.
    pub fn run(mut self) -> Result<ServiceEnd<S, E>, KioskError> {
        while !self.stop.is_requested() && !self.is_time_over() {
            self.poll()?;
            thread::sleep(POLL);
        }
        self.notify(ServiceStatus::Stopping);
        self.count();
        let (ended, capacities) = self.live.end();
        Ok((ended, capacities, self.record))
    }

    fn is_time_over(&self) -> bool {
        let uptime = Duration::from_nanos(self.live.now_ns() - self.began_ns);
        let crashes = self.crash_after.is_some_and(|after| uptime >= after);
        assert!(!crashes, "the crash that --crash-after asked for");
        self.length.is_some_and(|length| uptime >= length)
    }

    /// One round: looks after the threads, reads what they report, moves the session on.
    fn poll(&mut self) -> Result<(), KioskError> {
        if let Some(role) = self.live.threads.look().map_err(KioskError::internal)? {
            return Err(KioskError::Internal(format!(
                "the {} thread has ended while the kiosk ran; start the kiosk again",
                role.name()
            )));
        }
        self.watch();
        let now = self.live.now_ns();
        self.poll_controller(now)?;
        self.count();
        self.health(now);
        Ok(())
    }

    /// Feeds the watchdog, if physics and render got on; the first time that both have, the service is ready.
    fn watch(&mut self) {
        let count = self.live.queues.progress.count();
        if self.record.ready_ms.is_none() && count.iter().all(|n| *n > 0) {
            self.record.ready_ms = Some((self.begun.elapsed().as_secs_f64() * 1e4).round() / 10.0);
            self.notify(ServiceStatus::Ready);
        }
        let now = self.live.now_ns();
        if self.dog.as_mut().is_some_and(|dog| dog.look(now, count)) {
            self.notify(ServiceStatus::Alive);
        }
    }

    fn notify(&mut self, status: ServiceStatus) {
        if let Err(e) = self.manager.notify(status)
            && !self.record.warnings.iter().any(|w| w.starts_with("the service manager"))
        {
            self.record.warnings.push(format!("the service manager cannot be reached ({e}); check NOTIFY_SOCKET"));
        }
    }

    /// Has the controller decide, and does what is the service's to do.
    fn poll_controller(&mut self, now: u64) -> Result<(), KioskError> {
        while let Some(frame) = self.live.queues.frames.pop() {
            self.controller.frame(frame);
        }
        self.context.take_mannequin()?;
        if let Some(change) = self.controller.poll(now, &mut self.context)? {
            if self.record.states.len() < MOST_STATES {
                self.record.states.push(change.to);
            }
            if change.to == SessionState::Measuring {
                self.counter.stepped_in(change.from == SessionState::Attract);
            }
        }
        self.controller.lines().iter().for_each(|line| (self.print_line)(line));
        self.context.dress_mannequin()?;
        self.context.changer.update();
        Ok(())
    }

    fn count(&mut self) {
        if let Some(flight_recorder) = &self.flight_recorder {
            flight_recorder.drain(|_| {});
        }
        while let Some(step) = self.live.queues.step_reports.pop() {
            self.counter.step(&step);
        }
        while let Some(event) = self.live.queues.events.pop() {
            self.counter.event(&event);
        }
        self.counter.camera(self.camera.as_ref().map(CameraHandle::figures));
        let [_, pictures] = self.live.queues.progress.count();
        let uptime = self.live.now_ns() - self.began_ns;
        self.record.revived = self.live.threads.revived();
        self.record.attributed = self.counter.attributed();
        self.record.figures = self.counter.figures(uptime, self.controller.state(), pictures);
        if let Some(figures) = &mut self.figures {
            figures.publish(self.record.figures);
        }
    }

    fn health(&mut self, now: u64) {
        if self.every_ns > 0 && now >= self.health_ns {
            self.health_ns += self.every_ns;
            let stock = self.controller.stock().map_or_else(String::new, |stock| format!("; {stock}"));
            (self.print_line)(&format!("{}{stock}", self.record.figures));
            self.counter.reported();
        }
    }
}
