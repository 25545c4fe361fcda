//! The service: looks at everything fifty times a second and decides; it steps nothing and draws nothing itself.

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

use super::change::{Act, Changing};
use super::lives::{Ended, Lives};
use super::manager::{Ending, Manager, News};
use super::report::Course;
use super::session::{Change, Rules, Session, Sight, State};
use super::tailor::{Dressed, Job, Model, Tailor, Work};
use super::vitals::{Tally, Vitals};
use super::watchdog::Watchdog;
use crate::exit::AppError;
use crate::shopper;

/// Time between two looks: the queues hold seconds, and a signal to end waits for no longer.
const LOOK: Duration = Duration::from_millis(20);

/// A sensor frame older than this says nothing about who is there now (ns).
const STALE_NS: u64 = 500_000_000;

/// Most states that are told one by one.
const MOST_STATES: usize = 1000;

/// Most sensor frames that a shopper is measured from: the longest measuring at 60 Hz.
const MOST_FRAMES: usize = 3600;

/// Fewest frames that somebody can be measured from.
const FEWEST_FRAMES: usize = 10;

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
    changing: Changing<S, E::Outfit>,
    plan: Plan,
    around: Around<'a, S, E::Outfit>,
    session: Session,
    tally: Tally,
    dog: Option<Watchdog>,
    /// The loop's time when it began, and when the next health line is due (ns).
    began_ns: u64,
    health_ns: u64,
    /// When a frame last came, and whether somebody was seen in it.
    seen: (u64, bool),
    /// What the shopper is measured from, and who was made of it.
    model: Vec<Joints>,
    fitted: Option<Box<Dressed>>,
    dressed: bool,
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
        Self {
            session: Session::new(plan.rules, now),
            tally: Tally::default(),
            dog: Watchdog::new(around.manager.patience(), now),
            began_ns: now,
            health_ns: now + plan.health_ns,
            seen: (0, false),
            model: Vec::new(),
            fitted: None,
            dressed: false,
            course,
            lives,
            changing,
            plan,
            around,
        }
    }

    /// Runs until it is told to end or its time is over. Gives what became of it, and of the lives.
    ///
    /// # Errors
    /// Where a thread has ended that must not: whoever started the service starts it again.
    pub fn run(mut self) -> Result<(Ended<S, E>, Course), AppError> {
        while !self.around.ending.is_asked() && !self.is_time_over() {
            self.look()?;
            thread::sleep(LOOK);
        }
        self.tell(News::Stopping);
        self.count();
        Ok((self.lives.end(), self.course))
    }

    fn is_time_over(&self) -> bool {
        let uptime = Duration::from_nanos(self.lives.now_ns() - self.began_ns);
        let crashes = self.plan.crash_after.is_some_and(|after| uptime >= after);
        assert!(!crashes, "the crash that --crash-after asked for");
        self.plan.length.is_some_and(|length| uptime >= length)
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
        let shopper = self.frames(now);
        self.work()?;
        let sight = Sight { shopper, dressed: self.dressed };
        if let Some(change) = self.session.look(now, sight) {
            self.change(change);
        }
        self.measure(now)?;
        self.changing.look();
        self.count();
        self.health(now);
        Ok(())
    }

    /// Feeds the watchdog, if physics and render got on; the first time that both have, the service is ready.
    fn watch(&mut self) {
        let count = self.lives.pulse.count();
        if self.course.ready_ms.is_none() && count.iter().all(|n| *n > 0) {
            self.course.ready_ms = Some((self.plan.begun.elapsed().as_secs_f64() * 1e4).round() / 10.0);
            self.tell(News::Ready);
        }
        let now = self.lives.now_ns();
        if self.dog.as_mut().is_some_and(|dog| dog.look(now, count)) {
            self.tell(News::Alive);
        }
    }

    fn tell(&mut self, news: News) {
        if let Err(e) = self.around.manager.tell(news)
            && !self.course.warnings.iter().any(|w| w.starts_with("the service manager"))
        {
            self.course.warnings.push(format!("the service manager cannot be reached ({e}); check NOTIFY_SOCKET"));
        }
    }

    /// Takes in what the sensor saw; gives whether somebody is there.
    fn frames(&mut self, now: u64) -> bool {
        while let Some(frame) = self.lives.frames.pop() {
            self.seen = (frame.time_ns, shopper::is_seen(&frame));
            if self.session.state() == State::Measuring && self.seen.1 && self.model.len() < MOST_FRAMES {
                self.model.push(frame);
            }
        }
        self.seen.1 && now.saturating_sub(self.seen.0) < STALE_NS
    }

    /// Takes what the tailor has made.
    fn work(&mut self) -> Result<(), AppError> {
        match self.around.tailor.look() {
            Some(Work::Done(mannequin)) if mannequin.made.still => {
                let act = self.act(*mannequin);
                self.changing.stand_by(act);
            }
            Some(Work::Done(dressed)) => (self.fitted, self.dressed) = (Some(dressed), true),
            Some(Work::Failed) => self.model.clear(),
            Some(Work::Died) => {
                return Err(AppError::Internal("the tailor's thread panicked; start the kiosk again".into()));
            }
            None => {}
        }
        Ok(())
    }

    /// What a change of state brings about.
    fn change(&mut self, change: Change) {
        if self.course.states.len() < MOST_STATES {
            self.course.states.push(change.to);
        }
        match change.to {
            State::Measuring => {
                self.tally.stepped_in(change.from == State::Attract);
                self.model.clear();
            }
            State::TryOn => {
                self.model.clear();
                if let Some(fitted) = self.fitted.take() {
                    let act = self.act(*fitted);
                    self.changing.bring(act, true);
                }
            }
            State::Left => {}
            State::Attract => self.wipe(),
        }
    }

    /// Somebody dressed, as the stage takes them.
    fn act(&self, dressed: Dressed) -> Act<S, E::Outfit> {
        let Dressed { frame, reader, made } = dressed;
        let (scene, outfit) = (self.around.stage)(frame);
        Act { scene, reader, outfit, made }
    }

    /// Forgets the shopper.
    fn wipe(&mut self) {
        self.model.clear();
        (self.fitted, self.dressed) = (None, false);
        self.around.tailor.forget();
        self.changing.wipe();
    }

    /// Sends the tailor to work when there is enough to measure, or when there is no mannequin to come back.
    fn measure(&mut self, now: u64) -> Result<(), AppError> {
        let enough = self.session.lasted_ns(now) >= self.plan.measure_ns && self.model.len() >= FEWEST_FRAMES;
        let wanted = self.session.state() == State::Measuring && !self.dressed && !self.around.tailor.is_busy();
        let job = if enough && wanted {
            let model = self.plan.played.clone();
            Job::Shopper(model.unwrap_or_else(|| Model::Joints(std::mem::take(&mut self.model))))
        } else if self.changing.lacks_mannequin() && !self.around.tailor.is_busy() {
            Job::Mannequin(Box::new(self.around.pose))
        } else {
            return Ok(());
        };
        self.around.tailor.begin(job).map_err(AppError::internal)
    }

    fn count(&mut self) {
        if let Some(black_box) = &self.around.black_box {
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
        self.course.vitals = self.tally.vitals(uptime, self.session.state(), pictures);
        if let Some(figures) = &mut self.around.figures {
            figures.publish(self.course.vitals);
        }
    }

    fn health(&mut self, now: u64) {
        if self.plan.health_ns > 0 && now >= self.health_ns {
            self.health_ns += self.plan.health_ns;
            (self.around.say)(&self.course.vitals.to_string());
            self.tally.said();
        }
    }
}
