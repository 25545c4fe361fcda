//! A whole visit through the service with the visitor's pages: the recording stands before the sensor, a finger presses, and nothing of it is
//! written or sent.

#![cfg(all(target_os = "linux", feature = "window"))]

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::physics_thread::FrameScene;
use toile_engine::frame_loop::queue::{Receiver, Sender, bounded};
use toile_engine::triple_buffer::{Reader, TripleBuffer};
use toile_fitting::dress::{dressed, session};
use toile_fitting::live::assembly::{HeadlessRenderer, LoopOptions, LoopParts};
use toile_fitting::live::dresser::{Dresser, ShopperSource};
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};
use toile_fitting::live::source::{Feed, Visits};
use toile_kiosk::service::config::Config;
use toile_kiosk::service::runner::{Service, ServiceEnvironment, ServiceOptions};
use toile_kiosk::service::service_manager::{ServiceManager, ServiceStatus, StopSignal};
use toile_kiosk::service::session::SessionState;
use toile_kiosk::service::stock::Stock;
use toile_kiosk::visitor::controller::{OutfitPair, WindowChannels};
use toile_kiosk::visitor::model::Input;
use toile_kiosk::visitor::screen::{Action, Block, BodyView, Page, Screen};
use toile_kiosk::visitor::setup::VisitorSetup;

/// Longest that a page is waited for, beside compilers.
const LONGEST: Duration = Duration::from_secs(180);

/// A manager that ignores what it is notified of.
struct Nobody;

impl ServiceManager for Nobody {
    fn watchdog_timeout(&self) -> Option<Duration> {
        None
    }

    fn notify(&self, _status: ServiceStatus) -> io::Result<()> {
        Ok(())
    }
}

/// A visitor who sees screens and presses controls.
struct Finger {
    screens: Reader<Screen>,
    asked: Sender<Input>,
    pairs: Receiver<Option<OutfitPair<()>>>,
    pages: Vec<Page>,
}

impl Finger {
    /// Waits for a screen that shows something.
    fn wait(&mut self, what: &str, is_shown: impl Fn(&Screen) -> bool) -> Screen {
        let begun = Instant::now();
        loop {
            let screen = self.screens.latest().clone();
            if self.pages.last() != Some(&screen.page) {
                self.pages.push(screen.page);
            }
            if is_shown(&screen) {
                return screen;
            }
            assert!(begun.elapsed() < LONGEST, "no {what}: {screen:?}");
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn page(&mut self, page: Page) -> Screen {
        self.wait(&format!("{page:?}"), |screen| screen.page == page)
    }

    /// Presses what is on the page.
    fn press(&mut self, action: Action) {
        self.wait(&format!("{action:?}"), |screen| screen.controls.iter().any(|c| c.action == action));
        assert!(self.asked.push(Input::Pressed(action)));
    }

    fn visit(&mut self) {
        let measuring = self.page(Page::Measuring);
        assert!(
            measuring.blocks.iter().any(|b| matches!(b, Block::TurnGuide { .. })),
            "depth comes: a turn is offered"
        );
        let fitting = self.page(Page::Fitting);
        assert!(fitting.blocks.iter().any(|b| matches!(b, Block::Fit { text, .. } if text.contains('±'))));
        self.press(Action::Open(Page::Garments));
        let garments = self.page(Page::Garments);
        let other = garments.controls.iter().find(|c| matches!(c.action, Action::Garment(_)) && !c.chosen);
        self.press(other.unwrap().action);
        self.press(Action::Colour(1));
        self.press(Action::Back);
        self.wait("new clothes", |s| s.page == Page::Fitting && !s.blocks.iter().any(is_progress));
        self.press(Action::Open(Page::Zones));
        self.press(Action::Zone(0));
        self.page(Page::Zone);
        self.press(Action::Back);
        self.page(Page::Zones);
        self.press(Action::Open(Page::Compare));
        self.wait("two sizes", |s| matches!(s.body_view, BodyView::Two { .. }));
        let pairs: Vec<_> = std::iter::from_fn(|| self.pairs.pop()).collect();
        assert!(matches!(pairs.last(), Some(Some(_))), "the renderer has both");
        self.press(Action::Back);
        self.page(Page::Zones);
        self.press(Action::Back);
        self.press(Action::TakePicture);
        self.wait("code", |s| s.blocks.iter().any(|b| matches!(b, Block::Code { .. })));
        self.press(Action::DeletePicture);
        self.page(Page::Fitting);
        self.press(Action::Leave);
        let after = self.page(Page::Attract);
        assert_eq!(after.body_view, BodyView::Mannequin);
        assert!(!format!("{after:?}").contains("cm"), "{after:?}");
    }
}

fn is_progress(block: &Block) -> bool {
    matches!(block, Block::Progress { .. })
}

/// What the process has open that could keep or send something: files that may be written, sockets of any kind.
fn open_to_the_world() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in fs::read_dir("/proc/self/fd").unwrap().flatten() {
        // One that was closed meanwhile.
        let Ok(target) = fs::read_link(entry.path()) else { continue };
        let target = target.display().to_string();
        let flags =
            fs::read_to_string(format!("/proc/self/fdinfo/{}", entry.file_name().display())).unwrap_or_default();
        let octal = flags.lines().find_map(|l| l.strip_prefix("flags:")).map(str::trim);
        let writes = octal.and_then(|f| u32::from_str_radix(f, 8).ok()).is_some_and(|f| f & 0o3 != 0);
        if target.starts_with("socket:") || (writes && target.starts_with('/')) {
            found.insert(format!("{} -> {target}", entry.file_name().display()));
        }
    }
    found
}

/// Bytes that were handed to any call that writes, by all threads but the one that the test's harness reports from.
fn written() -> i64 {
    let count = |path: &str| {
        let text = fs::read_to_string(path).unwrap();
        text.lines().find_map(|l| l.strip_prefix("wchar: ")).unwrap().parse::<i64>().unwrap()
    };
    count("/proc/self/io") - count(&format!("/proc/self/task/{}/io", std::process::id()))
}

#[test]
fn a_whole_visit_opens_no_file_to_write_and_no_socket_and_writes_not_a_byte() {
    let before = (open_to_the_world(), written());
    let (over, opened) = (AtomicBool::new(false), Mutex::new(BTreeSet::new()));
    let mut states = Vec::new();
    thread::scope(|scope| {
        scope.spawn(|| {
            // Relaxed: a flag that a test sets.
            while !over.load(Relaxed) {
                opened.lock().unwrap().extend(open_to_the_world());
                thread::sleep(Duration::from_millis(2));
            }
        });
        states = serve();
        over.store(true, Relaxed);
    });
    let new: Vec<String> = opened.into_inner().unwrap().difference(&before.0).cloned().collect();
    assert_eq!(new, [""; 0]);
    assert_eq!(written() - before.1, 0, "bytes written");
    assert_eq!(states[..3], [SessionState::Attract, SessionState::Measuring, SessionState::TryOn]);
    assert_eq!(states[3], SessionState::Attract, "{states:?}");
}

/// The whole visit; gives the states that were entered.
fn serve() -> Vec<SessionState> {
    let clock = RealClock::default();
    let config = Config::parse("kiosk.toml", "[wear]\nquality = \"draft\"").unwrap();
    let stock = Stock::read(&config).unwrap();
    let setup = VisitorSetup::new(&config, &stock, clock.now_ns()).unwrap();
    let session = Arc::new(session::open(None, None).unwrap());
    let pose = session::standing(&session).unwrap()[0];
    let dressed = dressed::mannequin_in(&stock.first, &pose).unwrap();
    // They stand there for as long as the visit takes.
    let source = Feed::Played(Visits::of(&session, clock.now_ns(), 0));
    let first = DressedScene::new(dressed, |frame| (FrameScene::new(frame), ()));
    let renderer = HeadlessRenderer::default();
    let parts = LoopParts { first, renderer, source, account: ThreadAccount::new(), recording: None };
    let (live, handover) = LiveLoop::start(parts, clock, LoopOptions::default()).unwrap();
    let played = Some(ShopperSource::Recording(session));
    let options = ServiceOptions {
        begun: Instant::now(),
        length: Some(5 * LONGEST),
        crash_after: None,
        times: config.times(),
        measure_ns: 1_000_000_000,
        health_ns: 0,
        played: played.clone(),
        memory_locked: false,
        warnings: Vec::new(),
    };
    let screens = TripleBuffer::new(&setup.first());
    let (asked, mut asks) = bounded("ASKED", 16);
    let (show, pairs) = bounded("PAIRS", 8);
    let mut finger = Finger { screens: screens.reader, asked, pairs, pages: Vec::new() };
    let window = WindowChannels {
        screens: screens.writer,
        next_input: Box::new(move || asks.pop()),
        pairs: show,
        draped: Box::new(|_, _| ()),
    };
    let stop = StopSignal::default();
    thread::scope(|scope| {
        let hand = scope.spawn(|| {
            let _end = AtTheEnd(&stop);
            finger.visit();
        });
        let print_line = |_: &str| {};
        let environment = ServiceEnvironment {
            manager: &Nobody,
            stop: &stop,
            print_line: &print_line,
            figures: None,
            dresser: Dresser::new(stock.first.clone()),
            to_scene: Box::new(|frame| (FrameScene::new(frame), ())),
            pose,
            flight_recorder: None,
        };
        let service = Service::new(live, SceneChanger::new(handover, true, None), options, environment);
        let (_, _, record) = service.controlled_by(Box::new(setup.controller(window, played))).run().unwrap();
        hand.join().expect("the visit goes through all pages");
        record.states
    })
}

/// Ends the service when the visit is over, and where it failed.
struct AtTheEnd<'a>(&'a StopSignal);

impl Drop for AtTheEnd<'_> {
    fn drop(&mut self) {
        self.0.request();
    }
}
