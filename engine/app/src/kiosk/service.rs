//! The service: looks at everything fifty times a second and has a host decide; it steps nothing and draws nothing itself.

use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::frame::Frame;
use toile_engine::pace::blackbox::BlackBox;
use toile_engine::pace::physics::Scene;
use toile_engine::pace::render::Eye;
use toile_engine::relay::Writer;
use toile_perf::latency::{Attributed, Placed};
use toile_sensors::frame::Joints;

use super::change::Changing;
use super::host::{Alone, Hall, Host};
use super::lives::{Ended, Lives};
use super::manager::{Ending, Manager, News};
use super::report::Course;
use super::session::{Rules, State};
use super::tailor::{Model, Tailor, Work};
use super::vitals::{Tally, Vitals};
use super::watchdog::Watchdog;
use crate::exit::AppError;

/// Time between two looks: the queues hold seconds, and a signal to end waits for no longer.
const LOOK: Duration = Duration::from_millis(20);

/// Most states that are told one by one.
const MOST_STATES: usize = 1000;

/// How the service behaves.
pub struct Plan {
    /// When the program was started.
    pub begun: Instant,
    /// When it ends by itself.
    pub length: Option<Duration>,
    /// When it panics, to see what a crash leaves.
    pub crash_after: Option<Duration>,
    /// The session's times.
    pub rules: Rules,
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

/// Everything that the service talks to beside the loop.
pub struct Around<'a, S, O> {
    /// Who manages it.
    pub manager: &'a dyn Manager,
    /// Whether it was told to end.
    pub ending: &'a Ending,
    /// Where health lines go.
    pub say: &'a dyn Fn(&str),
    /// Where figures go for whoever asks for them.
    pub figures: Option<Writer<Vitals>>,
    /// Who dresses shoppers.
    pub tailor: Tailor,
    /// What a dressed frame becomes on the stage, and what the eye has to know of it.
    pub stage: fn(Frame) -> (S, O),
    /// How the mannequin stands.
    pub pose: Joints,
    /// What is kept for a crash, where somebody asked for it.
    pub black_box: Option<Arc<BlackBox>>,
}

/// The service while it runs.
pub struct Service<'a, S: Scene, E: Eye> {
    lives: Lives<S, E>,
    hall: Hall<S, E::Outfit>,
    host: Box<dyn Host<S, E::Outfit> + 'a>,
    length: Option<Duration>,
    crash_after: Option<Duration>,
    begun: Instant,
    every_ns: u64,
    manager: &'a dyn Manager,
    ending: &'a Ending,
    say: &'a dyn Fn(&str),
    figures: Option<Writer<Vitals>>,
    black_box: Option<Arc<BlackBox>>,
    tally: Tally,
    dog: Option<Watchdog>,
    /// The loop's time when it began, and when the next health line is due (ns).
    began_ns: u64,
    health_ns: u64,
    course: Course,
}

impl<'a, S: Scene + Send + 'static, E: Eye + 'static> Service<'a, S, E> {
    /// Over lives that have begun.
    pub fn new(
        lives: Lives<S, E>,
        changing: Changing<S, E::Outfit>,
        plan: Plan,
        around: Around<'a, S, E::Outfit>,
    ) -> Self {
        let now = lives.now_ns();
        let threads = lives.placements().into_iter().map(Placed::from).collect();
        let course = Course {
            vitals: Vitals::default(),
            ready_ms: None,
            states: vec![State::Attract],
            attributed: Attributed::default(),
            threads,
            memory_locked: plan.memory_locked,
            warnings: plan.warnings.clone(),
        };
        let Around { manager, ending, say, figures, tailor, stage, pose, black_box } = around;
        let host = Box::new(Alone::new(plan.rules, plan.measure_ns, plan.played, now));
        Self {
            lives,
            hall: Hall { changing, tailor, stage, pose },
            host,
            length: plan.length,
            crash_after: plan.crash_after,
            begun: plan.begun,
            every_ns: plan.health_ns,
            dog: Watchdog::new(manager.patience(), now),
            manager,
            ending,
            say,
            figures,
            black_box,
            tally: Tally::default(),
            began_ns: now,
            health_ns: now + plan.health_ns,
            course,
        }
    }

    /// The same with somebody else who decides what happens to whoever stands there: one with pages, for a window.
    #[must_use]
    pub fn hosted_by(self, host: Box<dyn Host<S, E::Outfit> + 'a>) -> Self {
        Self { host, ..self }
    }

    /// Runs until it is told to end or its time is over. Gives what became of it, and of the lives.
    ///
    /// # Errors
    /// Where a thread has ended that must not: whoever started the service starts it again.
    pub fn run(mut self) -> Result<(Ended<S, E>, Course), AppError> {
        while !self.ending.is_asked() && !self.is_time_over() {
            self.look()?;
            thread::sleep(LOOK);
        }
        self.tell(News::Stopping);
        self.count();
        Ok((self.lives.end(), self.course))
    }

    fn is_time_over(&self) -> bool {
        let uptime = Duration::from_nanos(self.lives.now_ns() - self.began_ns);
        let crashes = self.crash_after.is_some_and(|after| uptime >= after);
        assert!(!crashes, "the crash that --crash-after asked for");
        self.length.is_some_and(|length| uptime >= length)
    }

    /// One look at everything.
    fn look(&mut self) -> Result<(), AppError> {
        if let Some(role) = self.lives.over() {
            return Err(AppError::Internal(format!(
                "the {} thread has ended while the kiosk ran; start the kiosk again",
                role.name()
            )));
        }
        self.watch();
        let now = self.lives.now_ns();
        self.host(now)?;
        self.count();
        self.health(now);
        Ok(())
    }

    /// Feeds the watchdog, if physics and render got on; the first time that both have, the service is ready.
    fn watch(&mut self) {
        let count = self.lives.pulse.count();
        if self.course.ready_ms.is_none() && count.iter().all(|n| *n > 0) {
            self.course.ready_ms = Some((self.begun.elapsed().as_secs_f64() * 1e4).round() / 10.0);
            self.tell(News::Ready);
        }
        let now = self.lives.now_ns();
        if self.dog.as_mut().is_some_and(|dog| dog.look(now, count)) {
            self.tell(News::Alive);
        }
    }

    fn tell(&mut self, news: News) {
        if let Err(e) = self.manager.tell(news)
            && !self.course.warnings.iter().any(|w| w.starts_with("the service manager"))
        {
            self.course.warnings.push(format!("the service manager cannot be reached ({e}); check NOTIFY_SOCKET"));
        }
    }

    /// Has the host decide, and does what is the service's to do.
    fn host(&mut self, now: u64) -> Result<(), AppError> {
        while let Some(frame) = self.lives.frames.pop() {
            self.host.frame(frame);
        }
        match self.hall.tailor.look() {
            Some(Work::Done(mannequin)) if mannequin.made.still => {
                let act = self.hall.act(*mannequin);
                self.hall.changing.stand_by(act);
            }
            Some(Work::Died) => {
                return Err(AppError::Internal("the tailor's thread panicked; start the kiosk again".into()));
            }
            Some(work) => self.host.work(work),
            None => {}
        }
        if let Some(change) = self.host.look(now, &mut self.hall)? {
            if self.course.states.len() < MOST_STATES {
                self.course.states.push(change.to);
            }
            if change.to == State::Measuring {
                self.tally.stepped_in(change.from == State::Attract);
            }
        }
        self.hall.dress_mannequin()?;
        self.hall.changing.look();
        Ok(())
    }

    fn count(&mut self) {
        if let Some(black_box) = &self.black_box {
            black_box.drain(|_| {});
        }
        while let Some(beat) = self.lives.beats.pop() {
            self.tally.beat(&beat);
        }
        while let Some(event) = self.lives.events.pop() {
            self.tally.event(&event);
        }
        let [_, pictures] = self.lives.pulse.count();
        let uptime = self.lives.now_ns() - self.began_ns;
        self.course.attributed = self.tally.attributed();
        self.course.vitals = self.tally.vitals(uptime, self.host.state(), pictures);
        if let Some(figures) = &mut self.figures {
            figures.publish(self.course.vitals);
        }
    }

    fn health(&mut self, now: u64) {
        if self.every_ns > 0 && now >= self.health_ns {
            self.health_ns += self.every_ns;
            (self.say)(&self.course.vitals.to_string());
            self.tally.said();
        }
    }
}
