//! The kiosk: the whole loop, unattended, from shopper to shopper, until it is asked to end.
//!
//! Reads: a configuration, frames of a sensor. Writes: a health line, figures of the machine; nothing about a person.
//! Budget: ready within 5 s of its start; a round of the service each 20 ms, under 100 us of the first core.
//! Thread: the loop's own; a service thread, a dressing thread while somebody is measured, one for metrics.
//!
//! [`session`] is the state machine that a window drives too; [`stage`] and [`change`] let another dressed body take the
//! place of one that has left, without the loop's threads allocating or waiting; [`recording`] keeps the last seconds for a
//! crash, where a shop asks for it.

pub mod config;
mod config_keys;
pub mod controller;
pub mod health;
pub mod instance;
mod memory;
#[cfg(feature = "metrics")]
pub mod metrics;
pub mod report;
pub mod service;
pub mod service_manager;
pub mod session;

use std::sync::Arc;
use std::time::{Duration, Instant};

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame::Frame;
use toile_engine::frame_loop::physics_thread::FrameScene;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::frame_loop::threads;
use toile_engine::triple_buffer::Writer;
use toile_fitting::dress::dressed;
use toile_fitting::dress::session as sessions;
use toile_fitting::live::assembly::{HeadlessRenderer, LoopOptions, LoopParts};
use toile_fitting::live::dresser::{Dresser, ShopperSource};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::report::ThreadPlacement;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};
use toile_fitting::live::source::{Feed, Visits};
use toile_fitting::live::{crash, recording};
use toile_sensors::source::Session;

use crate::commands::kiosk::KioskArgs;
use crate::exit::AppError;
use crate::report::Document;
use crate::terminal::{self, Words};
use config::{Config, SensorSource};
use controller::SessionController;
use health::HealthFigures;
use instance::InstanceLock;
use report::KioskReport;
use service::{Service, ServiceEnvironment, ServiceOptions};
use service_manager::{StopSignal, Systemd};

/// Runs `toile kiosk`; with a window, by `windowed`.
///
/// # Errors
/// A kiosk that already runs, a configuration, a session or a garment that cannot be used, a thread that ended while it ran; those of `windowed`.
pub fn run(args: &KioskArgs, windowed: fn(KioskRun<'_>) -> Result<KioskReport, AppError>) -> Result<(), AppError> {
    let begun = Instant::now();
    if args.print_config {
        return terminal::print(config::EXAMPLE);
    }
    let stop = StopSignal::listen().map_err(AppError::internal)?;
    let mut config = Config::open(args.config.as_deref())?;
    if args.session.is_some() {
        (config.sensor.source, config.sensor.session) = (SensorSource::Session, args.session.clone());
    }
    let _lock = InstanceLock::take(args.instance.as_deref())?;
    let words = Words::new(args.printing.quiet);
    let figures = figures(&config)?;
    let clock = RealClock::default();
    let run = KioskRun { args, config: &config, begun, clock, stop: &stop, words: &words, figures };
    let report = if args.headless {
        let eye = |_: &Frame| Ok(HeadlessRenderer::default());
        serve(run, Frontend { renderer: eye, stage: |frame| (FrameScene::new(frame), ()), controller: |_| None })?.0
    } else {
        windowed(run)?
    };
    if args.printing.json {
        terminal::print_json(&Document::new("kiosk", report))
    } else {
        terminal::print(&report.summary())
    }
}

/// Where no window was built in.
///
/// # Errors
/// That there is none, and the cure.
pub fn without_window(_: KioskRun<'_>) -> Result<KioskReport, AppError> {
    let cure = "add `--headless`, or build with `--features kiosk`";
    Err(AppError::Usage(format!("`toile kiosk` has no window in this build; {cure}")))
}

/// A run of the kiosk: its arguments, its configuration, and what it was started with.
pub struct KioskRun<'a> {
    /// The command line.
    pub args: &'a KioskArgs,
    /// The configuration.
    pub config: &'a Config,
    /// When the program began.
    pub begun: Instant,
    /// The loop's clock.
    pub clock: RealClock,
    /// Whether it is to end.
    pub stop: &'a StopSignal,
    /// Prints progress.
    pub words: &'a Words,
    figures: Option<Writer<HealthFigures>>,
}

/// How a run shows itself: without a display, or at a window.
pub struct Frontend<F, H, O> {
    /// Makes the renderer, once the mannequin is dressed.
    pub renderer: F,
    /// A dressed frame as a scene of the loop, and what the renderer has to know of it.
    pub stage: fn(Frame) -> (FrameScene, O),
    /// Makes the controller, given the recording that shoppers are measured from, if one is played.
    pub controller: H,
}

/// A controller; none is that of the session alone.
pub type BoxedController<'a, O> = Option<Box<dyn SessionController<FrameScene, O> + 'a>>;

/// Sets everything up and runs until the end; returns the report, and the renderer.
///
/// # Errors
/// As [`run`].
pub fn serve<'a, E, F, H>(
    run: KioskRun<'a>,
    frontend: Frontend<F, H, E::Outfit>,
) -> Result<(KioskReport, Option<E>), AppError>
where
    E: Renderer<Outfit: Default> + 'static,
    F: FnOnce(&Frame) -> Result<E, AppError>,
    H: FnOnce(Option<ShopperSource>) -> BoxedController<'a, E::Outfit>,
{
    let KioskRun { args, config, begun, clock, stop, words, figures } = run;
    let wish = config.wish();
    let session = played_session(config)?;
    // The mannequin stands as somebody does in the recording: a pose, and no body.
    let pose = sessions::standing(&session)?[0];
    let dressed = dressed::mannequin(&wish, &pose)?;
    let (feed, played) = feed(config, session, clock)?;
    let workers = config.machine.workers.unwrap_or_else(workers);
    let (crew, worker) = threads::worker_pool(workers).map_err(AppError::input)?;
    let locked = if config.machine.lock_memory { memory::lock() } else { Ok(()) };
    let options = ServiceOptions {
        begun,
        length: args.seconds.map(|s| Duration::from_secs(s.into())),
        crash_after: args.crash_after.map(Duration::from_secs),
        times: config.times(),
        measure_ns: config::ns(config.session.measure_s),
        health_ns: config::ns(config.health.every_s),
        played,
        memory_locked: config.machine.lock_memory && locked.is_ok(),
        warnings: locked.err().map(|e| e.to_string()).into_iter().collect(),
    };
    let (black_box, tape) = match config.crash.recording.clone() {
        Some(path) => {
            recording::keep(&dressed.dressing, path).map(|(black_box, tape)| (Some(black_box), Some(tape)))?
        }
        None => (None, None),
    };
    let renderer = (frontend.renderer)(&dressed.frame)?;
    let first = DressedScene::new(dressed, |frame| (FrameScene::new(frame.with_workers(crew)), E::Outfit::default()));
    let parts = LoopParts { first, renderer, source: feed, account: ThreadAccount::new(), recording: tape };
    let (live, handover) = LiveLoop::start(parts, clock, LoopOptions::default()).map_err(AppError::internal)?;
    stop.graceful();
    let say = |line: &str| words.say(line);
    let changer = SceneChanger::new(handover, true, black_box.clone());
    let environment = ServiceEnvironment {
        manager: &Systemd,
        stop,
        say: &say,
        figures,
        dresser: Dresser::new(wish),
        stage: frontend.stage,
        pose,
        black_box,
    };
    let controller = (frontend.controller)(options.played.clone());
    let service = Service::new(live, changer, options, environment);
    let ran = match controller {
        Some(controller) => service.controlled_by(controller).run(),
        None => service.run(),
    };
    crash::forget();
    let (ended, capacities, mut record) = ran?;
    record.threads.extend(worker.map(ThreadPlacement::from));
    let report = KioskReport::of(&ended, capacities, record);
    Ok((report, ended.render.map(|watched| watched.render.renderer)))
}

/// The recording that is played, or for a live sensor the embedded one, whose shopper shows the mannequin how to stand.
fn played_session(config: &Config) -> Result<Session, AppError> {
    let path = config.sensor.session.as_deref().filter(|_| config.sensor.source == SensorSource::Session);
    Ok(sessions::open(path, None)?)
}

/// What the sensor reads, and what shoppers are then measured from.
fn feed(config: &Config, session: Session, clock: RealClock) -> Result<(Feed, Option<ShopperSource>), AppError> {
    let address = config.sensor.vmc;
    if config.sensor.source == SensorSource::Vmc {
        let refused =
            |e| AppError::Device(format!("nothing can be received at {address} ({e}); name a free one in sensor.vmc"));
        return Ok((Feed::listen(address, clock).map_err(refused)?, None));
    }
    let session = Arc::new(session);
    let visits = Visits::of(&session, clock.now_ns(), config::ns(config.sensor.pause_s));
    Ok((Feed::Played(visits), Some(ShopperSource::Recording(session))))
}

fn workers() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(toile_engine::workers::SHARES)
}

#[cfg(feature = "metrics")]
fn figures(config: &Config) -> Result<Option<Writer<HealthFigures>>, AppError> {
    use toile_engine::triple_buffer::TripleBuffer;
    let Some(port) = config.metrics.port else { return Ok(None) };
    let TripleBuffer { writer, reader } = TripleBuffer::new(&HealthFigures::default());
    let refused = |e| AppError::Device(format!("port {port} of 127.0.0.1 cannot be opened ({e}); name a free one"));
    metrics::serve(port, reader).map_err(refused)?;
    Ok(Some(writer))
}

#[cfg(not(feature = "metrics"))]
fn figures(config: &Config) -> Result<Option<Writer<HealthFigures>>, AppError> {
    match config.metrics.port {
        None => Ok(None),
        Some(_) => Err(AppError::Input(
            "metrics.port is set, but this build has no metrics; build with `--features metrics` or delete the key"
                .into(),
        )),
    }
}
