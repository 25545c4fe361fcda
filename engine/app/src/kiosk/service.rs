//! The service: polls everything fifty times a second and has a controller decide; it steps nothing and draws nothing itself.

use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::frame::Frame;
use toile_engine::frame_loop::flight_recorder::FlightRecorder;
use toile_engine::frame_loop::physics_thread::Scene;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::triple_buffer::Writer;
use toile_perf::latency::{Attributed, Placed};
use toile_sensors::frame::Joints;

use super::change::Changing;
use super::controller::{ControllerContext, HeadlessController, SessionController};
use super::health::{HealthCounter, HealthFigures};
use super::lives::{Ended, Lives};
use super::report::RunRecord;
use super::service_manager::{ServiceManager, ServiceStatus, StopSignal};
use super::session::{SessionState, SessionTimes};
use super::tailor::{Model, Tailor, Work};
use super::watchdog::Watchdog;
use crate::exit::AppError;

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
    /// The session's times.
    pub times: SessionTimes,
    /// Time over which a shopper is measured (ns).
    pub measure_ns: u64,
    /// Time between two health lines (ns); 0 is never.
    pub health_ns: u64,
    /// The recording that shoppers are measured from, where one is played.
    pub played: Option<Model>,
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
    pub say: &'a dyn Fn(&str),
    /// Receives the figures, where metrics are served.
    pub figures: Option<Writer<HealthFigures>>,
    /// Who dresses shoppers.
    pub tailor: Tailor,
    /// A dressed frame as a scene of the loop, and what the renderer has to know of it.
    pub stage: fn(Frame) -> (S, O),
    /// How the mannequin stands.
    pub pose: Joints,
    /// What is kept for a crash, where somebody asked for it.
    pub black_box: Option<Arc<FlightRecorder>>,
}

/// The service while it runs.
pub struct Service<'a, S: Scene, E: Renderer> {
    lives: Lives<S, E>,
    context: ControllerContext<S, E::Outfit>,
    controller: Box<dyn SessionController<S, E::Outfit> + 'a>,
    length: Option<Duration>,
    crash_after: Option<Duration>,
    begun: Instant,
    every_ns: u64,
    manager: &'a dyn ServiceManager,
    stop: &'a StopSignal,
    say: &'a dyn Fn(&str),
    figures: Option<Writer<HealthFigures>>,
    black_box: Option<Arc<FlightRecorder>>,
    counter: HealthCounter,
    dog: Option<Watchdog>,
    /// The loop's time when it began, and when the next health line is due (ns).
    began_ns: u64,
    health_ns: u64,
    record: RunRecord,
}

impl<'a, S: Scene + Send + 'static, E: Renderer + 'static> Service<'a, S, E> {
    /// Over threads that have been started.
    pub fn new(
        lives: Lives<S, E>,
        changing: Changing<S, E::Outfit>,
        options: ServiceOptions,
        environment: ServiceEnvironment<'a, S, E::Outfit>,
    ) -> Self {
        let now = lives.now_ns();
        let threads = lives.placements().into_iter().map(Placed::from).collect();
        let record = RunRecord {
            figures: HealthFigures::default(),
            ready_ms: None,
            states: vec![SessionState::Attract],
            attributed: Attributed::default(),
            threads,
            memory_locked: options.memory_locked,
            warnings: options.warnings.clone(),
        };
        let ServiceEnvironment { manager, stop, say, figures, tailor, stage, pose, black_box } = environment;
        let controller = Box::new(HeadlessController::new(options.times, options.measure_ns, options.played, now));
        Self {
            lives,
            context: ControllerContext { changing, tailor, stage, pose },
            controller,
            length: options.length,
            crash_after: options.crash_after,
            begun: options.begun,
            every_ns: options.health_ns,
            dog: Watchdog::new(manager.watchdog_timeout(), now),
            manager,
            stop,
            say,
            figures,
            black_box,
            counter: HealthCounter::default(),
            began_ns: now,
            health_ns: now + options.health_ns,
            record,
        }
    }

    /// The same with another controller: one with pages, for a window.
    #[must_use]
    pub fn controlled_by(self, controller: Box<dyn SessionController<S, E::Outfit> + 'a>) -> Self {
        Self { controller, ..self }
    }

    /// Runs until it is asked to end or its time is over. Returns a record of the run, and of the loop's threads.
    ///
    /// # Errors
    /// Where a thread has ended that must not: whoever started the service starts it again.
    pub fn run(mut self) -> Result<(Ended<S, E>, RunRecord), AppError> {
        while !self.stop.is_requested() && !self.is_time_over() {
            self.poll()?;
            thread::sleep(POLL);
        }
        self.notify(ServiceStatus::Stopping);
        self.count();
        Ok((self.lives.end(), self.record))
    }

    fn is_time_over(&self) -> bool {
        let uptime = Duration::from_nanos(self.lives.now_ns() - self.began_ns);
        let crashes = self.crash_after.is_some_and(|after| uptime >= after);
        assert!(!crashes, "the crash that --crash-after asked for");
        self.length.is_some_and(|length| uptime >= length)
    }

    /// One round.
    fn poll(&mut self) -> Result<(), AppError> {
        if let Some(role) = self.lives.over() {
            return Err(AppError::Internal(format!(
                "the {} thread has ended while the kiosk ran; start the kiosk again",
                role.name()
            )));
        }
        self.watch();
        let now = self.lives.now_ns();
        self.poll_controller(now)?;
        self.count();
        self.health(now);
        Ok(())
    }

    /// Feeds the watchdog, if physics and render got on; the first time that both have, the service is ready.
    fn watch(&mut self) {
        let count = self.lives.pulse.count();
        if self.record.ready_ms.is_none() && count.iter().all(|n| *n > 0) {
            self.record.ready_ms = Some((self.begun.elapsed().as_secs_f64() * 1e4).round() / 10.0);
            self.notify(ServiceStatus::Ready);
        }
        let now = self.lives.now_ns();
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
    fn poll_controller(&mut self, now: u64) -> Result<(), AppError> {
        while let Some(frame) = self.lives.frames.pop() {
            self.controller.frame(frame);
        }
        match self.context.tailor.look() {
            Some(Work::Done(mannequin)) if mannequin.made.still => {
                let act = self.context.act(*mannequin);
                self.context.changing.stand_by(act);
            }
            Some(Work::Died) => {
                return Err(AppError::Internal("the tailor's thread panicked; start the kiosk again".into()));
            }
            Some(work) => self.controller.work(work),
            None => {}
        }
        if let Some(change) = self.controller.poll(now, &mut self.context)? {
            if self.record.states.len() < MOST_STATES {
                self.record.states.push(change.to);
            }
            if change.to == SessionState::Measuring {
                self.counter.stepped_in(change.from == SessionState::Attract);
            }
        }
        self.context.dress_mannequin()?;
        self.context.changing.look();
        Ok(())
    }

    fn count(&mut self) {
        if let Some(black_box) = &self.black_box {
            black_box.drain(|_| {});
        }
        while let Some(beat) = self.lives.beats.pop() {
            self.counter.beat(&beat);
        }
        while let Some(event) = self.lives.events.pop() {
            self.counter.event(&event);
        }
        let [_, pictures] = self.lives.pulse.count();
        let uptime = self.lives.now_ns() - self.began_ns;
        self.record.attributed = self.counter.attributed();
        self.record.figures = self.counter.figures(uptime, self.controller.state(), pictures);
        if let Some(figures) = &mut self.figures {
            figures.publish(self.record.figures);
        }
    }

    fn health(&mut self, now: u64) {
        if self.every_ns > 0 && now >= self.health_ns {
            self.health_ns += self.every_ns;
            (self.say)(&self.record.figures.to_string());
            self.counter.reported();
        }
    }
}
