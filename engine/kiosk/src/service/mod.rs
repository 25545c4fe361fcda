//! The service: the whole loop, unattended, from shopper to shopper, until it is asked to end.
//!
//! It is ready within 5 s of its start. It has a round each 20 ms, which takes under 100 µs of the first core. Besides the threads of the
//! loop there is a service thread, one that watches the catalogue, one for metrics, and a dressing thread while a person is measured.
//!
//! [`session`] is the state machine that a window drives too, [`controller`] decides by it, and [`runner`] polls the loop. How the
//! loop's threads are joined, and how one dressed body takes another's place in them, is `toile_fitting::live`.

mod camera;
pub mod config;
mod config_keys;
pub mod controller;
pub mod health;
pub mod instance;
mod memory;
#[cfg(feature = "metrics")]
pub mod metrics;
pub mod picture_config;
pub mod report;
pub mod runner;
pub mod service_manager;
pub mod session;
pub mod stock;
pub mod stock_watch;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use toile_base::frame::Joints;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_engine::frame_loop::threads;
use toile_engine::triple_buffer::Writer;
use toile_engine::world::World;
use toile_fitting::dress::session as sessions;
use toile_fitting::live::assembly::{LoopOptions, LoopParts};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::own_picture::{PictureReceiver, PictureSwitch};
use toile_fitting::live::report::ThreadPlacement;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};
use toile_fitting::live::shopper_source::ShopperSource;
use toile_fitting::live::source::{Feed, RepeatedSession};
use toile_fitting::live::{crash, recording};
use toile_sensors::source::Session;

use crate::error::KioskError;
use camera::CameraFeeds;
use config::{Config, SensorSource};
use controller::{SessionController, ToScene};
use health::HealthFigures;
use instance::InstanceLock;
use report::KioskReport;
use runner::{Service, ServiceEnvironment, ServiceOptions};
use service_manager::{StopSignal, Systemd};
use stock::Stock;

/// What is asked of a run, beside its configuration.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KioskOptions {
    /// The configuration; `None` is the default one.
    pub config: Option<PathBuf>,
    /// A recording to play in place of what the configuration names.
    pub session: Option<PathBuf>,
    /// Name of this kiosk, where several run on one machine.
    pub instance: Option<String>,
    /// Whether it runs without a window.
    pub headless: bool,
    /// Size of a window (pixels), where it is not to cover the display.
    pub windowed: Option<[u32; 2]>,
    /// Length of the run (s); `None` runs until it is asked to end.
    pub seconds: Option<u32>,
    /// When it panics (s), to see what a crash leaves.
    pub crash_after: Option<u64>,
    /// Whether the system lets a program lock all of its memory, without limit.
    pub may_lock_memory: bool,
}

/// Prints a line for the operator.
pub type PrintLine<'a> = &'a (dyn Fn(&str) + Sync);

/// Runs a kiosk by `front`, with a window or without.
///
/// # Errors
/// A kiosk that already runs, a configuration, a session or a garment that cannot be used, a thread that ended while it ran; those
/// of `front`.
pub fn run(
    options: &KioskOptions,
    begun: Instant,
    print_line: PrintLine<'_>,
    front: fn(KioskRun<'_>) -> Result<KioskReport, KioskError>,
) -> Result<KioskReport, KioskError> {
    let stop = StopSignal::listen().map_err(KioskError::internal)?;
    let mut config = Config::open(options.config.as_deref())?;
    if options.session.is_some() {
        (config.sensor.source, config.sensor.session) = (SensorSource::Session, options.session.clone());
        config.sensor.camera = None;
    }
    let _lock = InstanceLock::take(options.instance.as_deref())?;
    let figures = figures(&config)?;
    let stock = Stock::read(&config)?;
    let clock = RealClock::default();
    let run = KioskRun { options, config: &config, stock: &stock, begun, clock, stop: &stop, print_line, figures };
    front(run)
}

/// Where no window was built in.
///
/// # Errors
/// That there is none, and the cure.
pub fn without_window(_: KioskRun<'_>) -> Result<KioskReport, KioskError> {
    let cure = "add `--headless`, or build with `--features kiosk`";
    Err(KioskError::Usage(format!("`toile kiosk` has no window in this build; {cure}")))
}

/// A run of the kiosk: its options, its configuration, and what it was started with.
pub struct KioskRun<'a> {
    /// Options of the command line.
    pub options: &'a KioskOptions,
    /// The configuration that was read.
    pub config: &'a Config,
    /// What it names to wear.
    pub stock: &'a Stock,
    /// When the program was started.
    pub begun: Instant,
    /// The loop's clock.
    pub clock: RealClock,
    /// Whether it is to end.
    pub stop: &'a StopSignal,
    /// Prints a line.
    pub print_line: PrintLine<'a>,
    figures: Option<Writer<HealthFigures>>,
}

/// How a run shows itself: without a display, or at a window.
pub struct Frontend<F, H, O> {
    /// Makes the renderer, once the mannequin is dressed; it is given the camera's pictures, where shoppers may see themselves.
    pub renderer: F,
    /// Turns a dressed world into a scene of the loop, and into the data that the renderer needs.
    pub to_scene: ToScene<WorldScene, O>,
    /// Makes the controller, once the loop runs.
    pub controller: H,
}

/// What a controller begins with.
pub struct ControllerStart {
    /// The recording that shoppers are measured from, where one is played.
    pub played: Option<ShopperSource>,
    /// Whether the camera's pictures are handed on, where shoppers may see themselves.
    pub switch: Option<PictureSwitch>,
    /// The camera's pictures for faces, where those may be taken, and whether they are handed on.
    pub portraits: Option<(PictureReceiver, PictureSwitch)>,
    /// How the mannequin stands.
    pub pose: Joints,
}

/// A controller.
pub type BoxedController<'a, O> = Box<dyn SessionController<WorldScene, O> + 'a>;

/// Sets everything up and runs until the end; returns the report, and the renderer.
///
/// # Errors
/// As [`run`].
pub fn serve<'a, E, F, H>(
    run: KioskRun<'a>,
    frontend: Frontend<F, H, E::Outfit>,
) -> Result<(KioskReport, Option<E>), KioskError>
where
    E: Renderer<Outfit: Default> + 'static,
    F: FnOnce(&World, Option<PictureReceiver>) -> Result<E, KioskError>,
    H: FnOnce(ControllerStart) -> Result<BoxedController<'a, E::Outfit>, KioskError>,
{
    let KioskRun { options, config, stock, begun, clock, stop, print_line, figures } = run;
    let session = played_session(config)?;
    // The mannequin stands as a person does in the recording: a pose, and no body.
    let pose = sessions::standing(&session)?[0];
    let dressed = stock.first.on_mannequin(&pose)?;
    let SensorFeeds { feed, played, pictures, switch, portraits } = feed(config, session, clock)?;
    let workers = config.machine.workers.unwrap_or_else(workers);
    let (crew, worker) = threads::worker_pool(workers, ThreadRole::Physics).map_err(KioskError::input)?;
    let locked = if config.machine.lock_memory { memory::lock(options.may_lock_memory) } else { Ok(()) };
    let service_options = ServiceOptions {
        begun,
        length: options.seconds.map(|s| Duration::from_secs(s.into())),
        crash_after: options.crash_after.map(Duration::from_secs),
        health_ns: config::ns(config.health.every_s),
        played,
        memory_locked: config.machine.lock_memory && locked.is_ok(),
        warnings: locked.err().map(|e| e.to_string()).into_iter().collect(),
    };
    let (flight_recorder, recording) = match config.crash.recording.clone() {
        Some(path) => recording::keep(&dressed, path)
            .map(|(flight_recorder, recording)| (Some(flight_recorder), Some(recording)))?,
        None => (None, None),
    };
    let renderer = (frontend.renderer)(&dressed.world, pictures)?;
    let first = DressedScene::new(dressed, |world| (WorldScene::new(world.with_workers(crew)), E::Outfit::default()));
    let parts = LoopParts { first, renderer, source: feed, account: ThreadAccount::new(), recording };
    // From here on this thread keeps off the cores of the physics, and so do those that it starts without a role.
    thread_roles::apply(ThreadRole::Service);
    let (live, handover) = LiveLoop::start(parts, clock, LoopOptions::default()).map_err(KioskError::internal)?;
    stop.graceful();
    let changer = SceneChanger::new(handover, true, flight_recorder.clone());
    let environment = ServiceEnvironment {
        manager: &Systemd,
        stop,
        print_line,
        figures,
        first: stock.first.clone(),
        to_scene: frontend.to_scene,
        pose,
        flight_recorder,
    };
    let start = ControllerStart { played: service_options.played.clone(), switch, portraits, pose };
    let controller = (frontend.controller)(start)?;
    let ran = Service::new(live, changer, controller, &service_options, environment).run();
    crash::forget();
    let (ended, capacities, mut record) = ran?;
    record.threads.extend(worker.map(ThreadPlacement::from));
    let report = KioskReport::of(&ended, capacities, record);
    Ok((report, ended.render.map(|watched| watched.render.renderer)))
}

/// The recording that is played, or for a live sensor the embedded one, whose shopper shows the mannequin how to stand.
fn played_session(config: &Config) -> Result<Session, KioskError> {
    let played = config.sensor.source == SensorSource::Session && config.sensor.camera.is_none();
    let path = config.sensor.session.as_deref().filter(|_| played);
    sessions::open(path, None)
}

/// What comes from a sensor of any kind.
struct SensorFeeds {
    feed: Feed,
    /// What shoppers are measured from.
    played: Option<ShopperSource>,
    pictures: Option<PictureReceiver>,
    switch: Option<PictureSwitch>,
    portraits: Option<(PictureReceiver, PictureSwitch)>,
}

/// What the sensor reads, and what shoppers are then measured from.
fn feed(config: &Config, session: Session, clock: RealClock) -> Result<SensorFeeds, KioskError> {
    if let Some(name) = config.sensor.camera().map_err(KioskError::input)? {
        let CameraFeeds { feed, handle, pictures, switch, portraits } = camera::feed(config, name, clock)?;
        let played = Some(ShopperSource::Camera(handle));
        return Ok(SensorFeeds { feed, played, pictures, switch, portraits });
    }
    let address = config.sensor.vmc;
    if config.sensor.source == SensorSource::Vmc {
        let refused = |e| {
            KioskError::Device(format!("nothing can be received at {address} ({e}); name a free one in sensor.vmc"))
        };
        let feed = Feed::listen(address, clock).map_err(refused)?;
        return Ok(SensorFeeds { feed, played: None, pictures: None, switch: None, portraits: None });
    }
    let session = Arc::new(session);
    let repeated = RepeatedSession::of(&session, clock.now_ns(), config::ns(config.sensor.pause_s));
    let played = Some(ShopperSource::Recording(session));
    Ok(SensorFeeds { feed: Feed::Played(repeated), played, pictures: None, switch: None, portraits: None })
}

fn workers() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(toile_engine::workers::SHARES)
}

#[cfg(feature = "metrics")]
fn figures(config: &Config) -> Result<Option<Writer<HealthFigures>>, KioskError> {
    use toile_engine::triple_buffer::TripleBuffer;
    let Some(port) = config.metrics.port else { return Ok(None) };
    let TripleBuffer { writer, reader } = TripleBuffer::new(&HealthFigures::default());
    let refused = |e| KioskError::Device(format!("port {port} of 127.0.0.1 cannot be opened ({e}); name a free one"));
    metrics::serve(port, reader).map_err(refused)?;
    Ok(Some(writer))
}

#[cfg(not(feature = "metrics"))]
fn figures(config: &Config) -> Result<Option<Writer<HealthFigures>>, KioskError> {
    match config.metrics.port {
        None => Ok(None),
        Some(_) => Err(KioskError::Input(
            "metrics.port is set, but this build has no metrics; build with `--features metrics` or delete the key"
                .into(),
        )),
    }
}
