//! The watchdog starves where physics or render stands still, whatever else runs on: the service over real threads, with a
//! scene and a display that can be made to hang.

use std::io;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use toile_base::frame::Joints;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::physics_thread::{LoopScene, WorldScene};
use toile_engine::frame_loop::quality_control::QualityLevel;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::world::{Snapshot, SnapshotTimes, World};
use toile_fitting::dress::session;
use toile_fitting::live::assembly::{HeadlessRenderer, LoopOptions, LoopParts};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};
use toile_fitting::live::source::{Feed, RepeatedSession};
use toile_kiosk::service::config::Config;
use toile_kiosk::service::runner::{Service, ServiceEnvironment, ServiceOptions};
use toile_kiosk::service::service_manager::{ServiceManager, ServiceStatus, StopSignal};
use toile_kiosk::service::stock::Stock;
use toile_kiosk::visitor::setup::VisitorSetup;

/// Blocks the threads that pass it while it is shut.
type Gate = Arc<AtomicBool>;

fn pass(gate: &Gate) {
    // Relaxed: a flag that a test sets.
    while gate.load(Relaxed) {
        thread::sleep(Duration::from_millis(1));
    }
}

/// The gate of whichever scene comes onto the stage.
fn physics_gate() -> &'static Gate {
    static GATE: OnceLock<Gate> = OnceLock::new();
    GATE.get_or_init(Gate::default)
}

struct Gated(WorldScene, Gate);

impl Gated {
    fn new(world: World) -> Self {
        Self(WorldScene::new(world), physics_gate().clone())
    }
}

impl LoopScene for Gated {
    fn step(&mut self, joints: &Joints, times: SnapshotTimes, clock: &impl Clock) {
        pass(&self.1);
        self.0.step(joints, times, clock);
    }
    fn set_level(&mut self, level: &QualityLevel) {
        self.0.set_level(level);
    }
    fn measure(&mut self) {
        self.0.measure();
    }
    fn clear_meters(&mut self) {
        self.0.clear_meters();
    }
    fn fingerprint(&self) -> u64 {
        self.0.fingerprint()
    }
    fn take_workers_from(&mut self, before: &mut Self) {
        self.0.take_workers_from(&mut before.0);
    }
    fn fault_counts(&self) -> [u64; 2] {
        self.0.fault_counts()
    }
}

struct Display(HeadlessRenderer, Gate);

impl Renderer for Display {
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        pass(&self.1);
        self.0.draw(snapshot);
    }
}

/// A manager that writes down what it is told and when.
struct Diary(Mutex<Vec<(Instant, ServiceStatus)>>);

impl Diary {
    /// Feedings between two times.
    fn fed(&self, from: Instant, to: Instant) -> usize {
        let statuses = self.0.lock().unwrap();
        statuses.iter().filter(|(at, status)| *status == ServiceStatus::Alive && (from..to).contains(at)).count()
    }

    fn is_ready(&self) -> bool {
        self.0.lock().unwrap().iter().any(|(_, status)| *status == ServiceStatus::Ready)
    }
}

impl ServiceManager for Diary {
    fn watchdog_timeout(&self) -> Option<Duration> {
        Some(Duration::from_millis(300))
    }

    fn notify(&self, status: ServiceStatus) -> io::Result<()> {
        self.0.lock().unwrap().push((Instant::now(), status));
        Ok(())
    }
}

/// Runs the service, and meanwhile on another thread what is given.
fn serve(diary: &Diary, display: Gate, meanwhile: impl FnOnce() + Send) {
    let (session, clock) = (Arc::new(session::open(None, None).unwrap()), RealClock::default());
    let pose = session::filtered(&session)[0];
    let config = Config::parse("kiosk.toml", "[wear]\ngarments = [\"scarf\"]\nquality = \"draft\"\n").unwrap();
    let stock = Stock::read(&config).unwrap();
    let setup = VisitorSetup::new(&config, &stock, clock.now_ns()).unwrap();
    let dressed = stock.first.on_mannequin(&pose).unwrap();
    // No shopper ever comes: the stall is the only thing that happens.
    let source = Feed::Played(RepeatedSession::of(&session, clock.now_ns(), 3_600_000_000_000));
    let first = DressedScene::new(dressed, |world| (Gated::new(world), ()));
    let renderer = Display(HeadlessRenderer::default(), display);
    let parts = LoopParts { first, renderer, source, account: ThreadAccount::new(), recording: None };
    let (live, handover) = LiveLoop::start(parts, clock, LoopOptions::default()).unwrap();
    let options = ServiceOptions {
        begun: Instant::now(),
        length: Some(Duration::from_secs(120)),
        crash_after: None,
        health_ns: 0,
        played: None,
        memory_locked: false,
        warnings: Vec::new(),
    };
    let stop = StopSignal::default();
    thread::scope(|scope| {
        scope.spawn(|| {
            meanwhile();
            stop.request();
        });
        let print_line = |_: &str| {};
        let environment = ServiceEnvironment {
            manager: diary,
            stop: &stop,
            print_line: &print_line,
            figures: None,
            first: stock.first.clone(),
            to_scene: Box::new(|world| (Gated::new(world), ())),
            pose,
            flight_recorder: None,
        };
        let (changer, controller) = (SceneChanger::new(handover, true, None), Box::new(setup.headless(None)));
        Service::new(live, changer, controller, &options, environment).run().unwrap();
    });
}

/// Waits until it is fed twice, within a second: ten times where the machine is quiet.
fn is_fed(diary: &Diary, when: &str) {
    let from = Instant::now();
    while diary.fed(from, Instant::now()) < 2 {
        assert!(from.elapsed() < Duration::from_secs(1), "it is fed {when}");
        thread::sleep(Duration::from_millis(5));
    }
}

fn starves_while(gate: &Gate, diary: &Diary) {
    is_fed(diary, "while all is well");
    gate.store(true, Relaxed);
    // What was counted before the gate was shut is fed once more.
    thread::sleep(Duration::from_millis(300));
    let from = Instant::now();
    thread::sleep(Duration::from_millis(600));
    let fed = diary.fed(from, Instant::now());
    gate.store(false, Relaxed);
    assert_eq!(fed, 0, "it is fed while a thread hangs");
    is_fed(diary, "again");
}

#[test]
fn the_watchdog_starves_where_a_turn_of_physics_or_of_render_hangs() {
    let (diary, display) = (Diary(Mutex::default()), Gate::default());
    serve(&diary, display.clone(), || {
        while !diary.is_ready() {
            thread::sleep(Duration::from_millis(5));
        }
        starves_while(physics_gate(), &diary);
        starves_while(&display, &diary);
    });
    assert_eq!(diary.0.lock().unwrap().last().unwrap().1, ServiceStatus::Stopping);
}
