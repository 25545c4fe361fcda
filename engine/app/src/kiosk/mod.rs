//! The kiosk: the whole loop, unattended, from shopper to shopper, until it is told to end.
//!
//! Reads: a configuration, frames of a sensor. Writes: a health line, figures of the machine; nothing about a person.
//! Budget: ready within 5 s of its start; a look at everything each 20 ms, under 100 us of the first core.
//! Thread: the loop's own; a service thread that looks, a tailor's thread while somebody is measured, one for figures.
//!
//! [`session`] is the machine of states that a window drives too; [`stage`] and [`change`] let another dressed body take the
//! place of one that has left, without the loop's threads allocating or waiting; [`recording`] keeps the last seconds for a
//! crash, where a shop asks for it.

pub mod change;
pub mod config;
pub mod host;
mod keys;
pub mod lives;
pub mod manager;
mod memory;
#[cfg(feature = "metrics")]
pub mod metrics;
pub mod recording;
pub mod report;
pub mod service;
pub mod session;
pub mod source;
pub mod stage;
pub mod tailor;
pub mod vitals;
pub mod watchdog;

use std::sync::Arc;
use std::time::{Duration, Instant};

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame::Frame;
use toile_engine::pace::physics::Staged;
use toile_engine::pace::render::Eye;
use toile_engine::pace::threads;
use toile_engine::relay::Writer;
use toile_perf::latency::Placed;
use toile_sensors::source::Session;

use crate::cli::KioskArgs;
use crate::crash;
use crate::exit::AppError;
use crate::report::Document;
use crate::shopper;
use crate::terminal::{self, Words};
use change::{Act, Changing};
use config::{Config, Source};
use lives::{Cast, Headless, Lives};
use manager::{Ending, Systemd};
use report::KioskReport;
use service::{Around, Plan, Service};
use source::{Feed, Visits};
use tailor::{Dressed, Model, Tailor};
use vitals::Vitals;

/// Runs `toile kiosk`.
///
/// # Errors
/// A configuration, a session or a garment that cannot be used, a thread that ended while it ran.
pub fn run(args: &KioskArgs) -> Result<(), AppError> {
    let begun = Instant::now();
    if args.print_config {
        return terminal::print(config::EXAMPLE);
    }
    if cfg!(not(feature = "kiosk")) && !args.headless {
        let cure = "add `--headless`, or build with `--features kiosk`";
        return Err(AppError::Usage(format!("`toile kiosk` has no window in this build; {cure}")));
    }
    let ending = Ending::listen().map_err(AppError::internal)?;
    let mut config = Config::open(args.config.as_deref())?;
    if args.session.is_some() {
        (config.sensor.source, config.sensor.session) = (Source::Session, args.session.clone());
    }
    let words = Words::new(args.quiet);
    let figures = figures(&config)?;
    let report = if args.headless {
        let clock = RealClock::default();
        let seeing = Seeing { eye: |_: &Frame| Ok(Headless::default()), stage: |frame| (Staged::new(frame), ()) };
        serve(args, &config, (begun, clock), &ending, &words, figures, seeing)?.0
    } else {
        seen(args, &config, begun, &ending, &words, figures)?
    };
    if args.json { terminal::print_json(&Document::new("kiosk", report)) } else { terminal::print(&report.summary()) }
}

/// The same with a window.
#[cfg(feature = "kiosk")]
fn seen(
    args: &KioskArgs,
    config: &Config,
    begun: Instant,
    ending: &Ending,
    said: &Words,
    figures: Option<Writer<Vitals>>,
) -> Result<KioskReport, AppError> {
    use crate::{guest, window};
    let clock = RealClock::default();
    let words = guest::words::Words::load()?;
    let shelf = Arc::new(guest::shelf::Shelf::stock()?);
    let house = guest::model::House {
        rules: guest::model::Rules::usual(config.rules(), config::ns(config.session.measure_s), 180_000_000_000),
        language: guest::words::Language::English,
        large: false,
        wear: config.wear.garments.clone(),
    };
    let model = guest::model::Model::new(house, shelf, clock.now_ns());
    let first = guest::screen::Screen::of(&model, &words, &guest::layout::Mount::default());
    let wanted = window::Wanted { windowed: args.windowed, height_mm: 1_210.0, begun, clock, motion: true, first };
    window::run(wanted, ending, |front| {
        let stage = |frame: Frame| {
            let look = window::look::Look::of(&frame);
            (Staged::new(frame), look)
        };
        let eye = |mannequin: &Frame| Ok(front.eye()?.0.seeing(window::look::Look::of(mannequin)));
        let (mut report, eye) = serve(args, config, (begun, clock), ending, said, figures, Seeing { eye, stage })?;
        report.window = eye.map(|mut glass: window::Glass| glass.report());
        Ok(report)
    })
}

#[cfg(not(feature = "kiosk"))]
fn seen(
    _: &KioskArgs,
    _: &Config,
    _: Instant,
    _: &Ending,
    _: &Words,
    _: Option<Writer<Vitals>>,
) -> Result<KioskReport, AppError> {
    Err(AppError::Usage("`toile kiosk` has no window in this build; add `--headless`".into()))
}

/// Who sees: the eye, once the mannequin is dressed, and what it has to know of a frame that takes the stage.
struct Seeing<F, O> {
    eye: F,
    stage: fn(Frame) -> (Staged, O),
}

/// Sets everything up and runs until the end.
fn serve<E: Eye<Outfit: Default> + 'static>(
    args: &KioskArgs,
    config: &Config,
    (begun, clock): (Instant, RealClock),
    ending: &Ending,
    words: &Words,
    figures: Option<Writer<Vitals>>,
    seeing: Seeing<impl FnOnce(&Frame) -> Result<E, AppError>, E::Outfit>,
) -> Result<(KioskReport, Option<E>), AppError> {
    let wish = config.wish();
    let session = recording(config)?;
    // The mannequin stands as somebody does in the recording: a pose, and no body.
    let pose = shopper::believable(&session);
    let pose = pose[shopper::stands_from(&pose).min(pose.len() - 1)];
    let dressed = tailor::mannequin(&wish, &pose)?;
    let (feed, played) = feed(config, session, clock)?;
    let workers = config.machine.workers.unwrap_or_else(workers);
    let (crew, worker) = threads::crew(workers).map_err(AppError::input)?;
    let locked = if config.machine.lock_memory { memory::lock() } else { Ok(()) };
    let plan = Plan {
        begun,
        length: args.seconds.map(|s| Duration::from_secs(s.into())),
        crash_after: args.crash_after.map(Duration::from_secs),
        rules: config.rules(),
        measure_ns: config::ns(config.session.measure_s),
        health_ns: config::ns(config.health.every_s),
        played,
        memory_locked: config.machine.lock_memory && locked.is_ok(),
        warnings: locked.err().map(|e| e.to_string()).into_iter().collect(),
    };
    let (black_box, tape) = match config.crash.recording.clone() {
        Some(path) => recording::keep(&dressed.made, path).map(|(black_box, tape)| (Some(black_box), Some(tape)))?,
        None => (None, None),
    };
    let Dressed { frame, reader, made } = dressed;
    let eye = (seeing.eye)(&frame)?;
    let first = Act { scene: Staged::new(frame.with_crew(crew)), reader, outfit: E::Outfit::default(), made };
    let cast = Cast { first, eye, feed, tape };
    let (lives, doors) = Lives::start(cast, clock).map_err(AppError::internal)?;
    ending.orderly();
    let say = |line: &str| words.say(line);
    let changing = Changing::new(doors, black_box.clone());
    let around = Around {
        manager: &Systemd,
        ending,
        say: &say,
        figures,
        tailor: Tailor::new(wish),
        stage: seeing.stage,
        pose,
        black_box,
    };
    let ran = Service::new(lives, changing, plan, around).run();
    crash::forget();
    let (mut ended, mut course) = ran?;
    course.threads.extend(worker.map(Placed::from));
    let report = KioskReport::of(&ended, course);
    Ok((report, ended.render.take().map(|render| render.eye)))
}

/// The recording that is played, or for a live sensor the embedded one, whose shopper shows the mannequin how to stand.
fn recording(config: &Config) -> Result<Session, AppError> {
    let path = config.sensor.session.as_deref().filter(|_| config.sensor.source == Source::Session);
    let session = shopper::open(path, None)?;
    if session.joints.is_empty() {
        return Err(AppError::Input(format!("session {} has no joints, so that no pose can be shown", session.name)));
    }
    Ok(session)
}

/// What the sensor reads, and what shoppers are then measured from.
fn feed(config: &Config, session: Session, clock: RealClock) -> Result<(Feed, Option<Model>), AppError> {
    let address = config.sensor.vmc;
    if config.sensor.source == Source::Vmc {
        let refused =
            |e| AppError::Device(format!("nothing can be received at {address} ({e}); name a free one in sensor.vmc"));
        return Ok((Feed::listen(address, clock).map_err(refused)?, None));
    }
    let visits = Visits::new(&session.joints, clock.now_ns(), config::ns(config.sensor.pause_s));
    Ok((Feed::Played(visits), Some(Model::Played(Arc::new(session)))))
}

fn workers() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(toile_engine::crew::SHARES)
}

#[cfg(feature = "metrics")]
fn figures(config: &Config) -> Result<Option<Writer<Vitals>>, AppError> {
    use toile_engine::relay::Relay;
    let Some(port) = config.metrics.port else { return Ok(None) };
    let Relay { writer, reader } = Relay::new(&Vitals::default());
    let refused = |e| AppError::Device(format!("port {port} of 127.0.0.1 cannot be opened ({e}); name a free one"));
    metrics::serve(port, reader).map_err(refused)?;
    Ok(Some(writer))
}

#[cfg(not(feature = "metrics"))]
fn figures(config: &Config) -> Result<Option<Writer<Vitals>>, AppError> {
    match config.metrics.port {
        None => Ok(None),
        Some(_) => Err(AppError::Input(
            "metrics.port is set, but this build has no metrics; build with `--features metrics` or delete the key"
                .into(),
        )),
    }
}
