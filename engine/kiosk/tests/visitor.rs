//! A whole visit through the service with the visitor's pages: the recording stands before the sensor, a finger presses, and nothing of it is
//! written or sent.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use toile_assets::body::shape::Shapes;
use toile_base::body::Sex;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::frame_loop::queue::{Receiver, Sender, bounded};
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::triple_buffer::{Reader, TripleBuffer};
use toile_engine::world::Snapshot;
use toile_fitting::dress::session;
use toile_fitting::live::assembly::{HeadlessRenderer, LoopOptions, LoopParts};
use toile_fitting::live::camera_start::{self, CameraSetup, StartedCamera};
use toile_fitting::live::depth_camera::GATHERED;
use toile_fitting::live::lateness::ThreadAccount;
use toile_fitting::live::live_loop::LiveLoop;
use toile_fitting::live::own_picture::{PictureReceiver, PictureSwitch};
use toile_fitting::live::scene_changer::{DressedScene, SceneChanger};
use toile_fitting::live::shopper_source::ShopperSource;
use toile_fitting::live::source::{Feed, RepeatedSession};
use toile_fitting::live::webcam::WebcamOptions;
use toile_kiosk::service::config::Config;
use toile_kiosk::service::runner::{Service, ServiceEnvironment, ServiceOptions};
use toile_kiosk::service::service_manager::{ServiceManager, ServiceStatus, StopSignal};
use toile_kiosk::service::session::SessionState;
use toile_kiosk::service::stock::Stock;
use toile_kiosk::visitor::controller::VisitController;
use toile_kiosk::visitor::model::Input;
use toile_kiosk::visitor::own_face::WornFace;
use toile_kiosk::visitor::page_window::{OutfitPair, WindowChannels};
use toile_kiosk::visitor::plain;
use toile_kiosk::visitor::screen::{Action, Block, BodyView, Page, Screen};
use toile_kiosk::visitor::setup::VisitorSetup;
use toile_sensors::segment::Zone;
use toile_sensors::source::Session;
use toile_sensors::source::live::CameraOptions;
use toile_view::figure::{OwnHead, OwnHeadPicture};
use toile_view::image::Size;
use toile_view::own_picture::{OwnPicture, OwnPictureInput, OwnPictureModel, OwnPictureOptions};

use crate::ALONE;
use crate::coarse_shop::SHOP;

/// Longest that a page is waited for, beside compilers.
const LONGEST: Duration = Duration::from_secs(180);

/// A manager that ignores what it is notified of.
struct SilentSupervisor;

impl ServiceManager for SilentSupervisor {
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
    pairs: Receiver<Option<OutfitPair<Worn>>>,
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

    /// Waits for the code of a picture; gives what a phone reads in it.
    fn scan(&mut self) -> String {
        let is_code = |block: &Block| matches!(block, Block::Code { .. });
        let screen = self.wait("code", |s| s.blocks.iter().any(is_code));
        let Some(Block::Code { side, dark }) = screen.blocks.into_iter().find(is_code) else { unreachable!() };
        // Four pixels a module and the quiet zone around them, as on a screen.
        let pixels = 4 * (side + 8);
        let is_dark = |x: usize, y: usize| {
            let [x, y] = [x / 4, y / 4].map(|at| at.checked_sub(4).filter(|at| *at < side));
            x.zip(y).is_some_and(|(x, y)| dark[y * side + x])
        };
        let mut seen =
            rqrr::PreparedImage::prepare_from_greyscale(pixels, pixels, |x, y| if is_dark(x, y) { 0 } else { 255 });
        seen.detect_grids()[0].decode().expect("a phone reads it").1
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
        let link = self.scan();
        assert!(link.starts_with("data:image/png;base64,"), "{link}");
        self.press(Action::DeletePicture);
        self.page(Page::Fitting);
        self.press(Action::Leave);
        let after = self.page(Page::Attract);
        assert_eq!(after.body_view, BodyView::Mannequin);
        assert!(!format!("{after:?}").contains("cm"), "{after:?}");
    }
}

/// What a phone gets by a link, as far as there is something.
fn get(link: &str) -> io::Result<Vec<u8>> {
    let (address, path) = link.strip_prefix("http://").unwrap().split_once('/').unwrap();
    let mut stream = TcpStream::connect(address)?;
    stream.set_read_timeout(Some(LONGEST))?;
    write!(stream, "GET /{path} HTTP/1.1\r\nHost: {address}\r\n\r\n")?;
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer)?;
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n").ok_or(io::ErrorKind::UnexpectedEof)?;
    assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer[..end]));
    Ok(answer.split_off(end + 4))
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
        if !target.starts_with("socket:") && !target.starts_with('/') {
            continue;
        }
        let flags =
            fs::read_to_string(format!("/proc/self/fdinfo/{}", entry.file_name().display())).unwrap_or_default();
        let octal = flags.lines().find_map(|l| l.strip_prefix("flags:")).map(str::trim);
        let writes = octal.and_then(|f| u32::from_str_radix(f, 8).ok()).is_some_and(|f| f & 0o3 != 0);
        if writes || target.starts_with("socket:") {
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
fn a_visit_writes_no_file_and_opens_no_socket() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    LazyLock::force(&SHOP);
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
        states = serve("", Finger::visit);
        over.store(true, Relaxed);
    });
    let new: Vec<String> = opened.into_inner().unwrap().difference(&before.0).cloned().collect();
    assert_eq!(new, [""; 0]);
    assert_eq!(written() - before.1, 0, "bytes written");
    assert_eq!(states[..3], [SessionState::Attract, SessionState::Measuring, SessionState::TryOn]);
    assert_eq!(states[3], SessionState::Attract, "{states:?}");
}

/// A shop that serves pictures at an address of its own; the phone is in the same network.
#[test]
fn a_picture_by_a_link_is_large_and_gone_when_it_is_deleted() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let is_served = || TcpStream::connect(address).is_ok();
    serve(&format!("[picture]\nserve = \"{address}\"\nnetwork = \"Shop guest\"\n"), |finger| {
        finger.page(Page::Fitting);
        assert!(!is_served(), "nothing listens before a picture is asked for");
        finger.press(Action::TakePicture);
        let link = finger.scan();
        assert!(link.starts_with(&format!("http://{address}/")), "{link}");
        let screen = finger.page(Page::Picture);
        assert!(format!("{:?}", screen.blocks).contains("Shop guest"), "{screen:?}");
        let picture = png::Decoder::new(io::Cursor::new(get(&link).unwrap())).read_info().unwrap();
        assert_eq!((picture.info().width, picture.info().height), (720, 1200));
        // A phone that is not in that network.
        finger.press(Action::OtherCode);
        finger.wait("own code", |s| {
            s.controls.iter().any(|c| c.action == Action::OtherCode && c.label.contains("Large"))
        });
        assert!(finger.scan().starts_with("data:image/png;base64,"));
        finger.press(Action::DeletePicture);
        finger.page(Page::Fitting);
        let begun = Instant::now();
        while is_served() {
            assert!(begun.elapsed() < LONGEST, "it is served after it was deleted");
            thread::sleep(Duration::from_millis(20));
        }
        finger.press(Action::TakePicture);
        let again = finger.scan();
        assert!(again.starts_with("http://") && again != link, "a name is used once: {again}");
        finger.press(Action::Leave);
        finger.page(Page::Attract);
        assert!(get(&link).is_err() && get(&again).is_err(), "whoever has left is served no longer");
    });
}

/// The same with the shopper's own picture: a camera's pictures go through the mirror, and nothing of them is written or sent, nor left where
/// the renderer could find it.
#[test]
fn who_sees_themselves_is_neither_stored_nor_sent() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    LazyLock::force(&SHOP);
    let before = (open_to_the_world(), written());
    let (over, opened) = (AtomicBool::new(false), Mutex::new(BTreeSet::new()));
    thread::scope(|scope| {
        scope.spawn(|| {
            // Relaxed: a flag that a test sets.
            while !over.load(Relaxed) {
                opened.lock().unwrap().extend(open_to_the_world());
                thread::sleep(Duration::from_millis(2));
            }
        });
        let face = Arc::downgrade(&wear_a_face());
        serve_with("", true, |finger| {
            finger.page(Page::Fitting);
            assert!(WORN.of(Sex::Female).is_some());
            finger.press(Action::OwnPicture);
            finger.wait("themselves", |s| matches!(s.body_view, BodyView::Shopper { own_picture: true, .. }));
            let begun = Instant::now();
            while DRAWN.load(Relaxed) < 15 {
                assert!(begun.elapsed() < LONGEST, "only {} pictures with the garment", DRAWN.load(Relaxed));
                thread::sleep(Duration::from_millis(20));
            }
            finger.press(Action::OwnPicture);
            finger.wait("the mannequin", |s| matches!(s.body_view, BodyView::Shopper { own_picture: false, .. }));
            finger.press(Action::OwnPicture);
            finger.press(Action::Leave);
            finger.page(Page::Attract);
            let begun = Instant::now();
            while !BLANK.load(Relaxed) {
                assert!(begun.elapsed() < LONGEST, "the picture of whoever has left is still there");
                thread::sleep(Duration::from_millis(20));
            }
            assert!(WORN.of(Sex::Female).is_none() && face.upgrade().is_none(), "their face is still there");
        });
        over.store(true, Relaxed);
    });
    let new: Vec<String> = opened.into_inner().unwrap().difference(&before.0).cloned().collect();
    assert_eq!(new, [""; 0]);
    assert_eq!(written() - before.1, 0, "bytes written");
}

/// The face that the visitor's figure wears.
static WORN: LazyLock<WornFace> = LazyLock::new(WornFace::default);

/// Puts a face on; the returned handle is the only one.
fn wear_a_face() -> Arc<OwnHead> {
    let rest = &Shapes::of(Sex::Female).base().positions;
    let picture = OwnHeadPicture { side: 64, rgb: &[120; 3 * 64 * 64], skin: [120; 3], hair: [120; 3] };
    let head = Arc::new(OwnHead::new(Sex::Female, rest, picture).unwrap());
    WORN.put_on(vec![head.clone()]);
    head
}

/// Pictures on which the garment was drawn, and whether what the renderer holds now is blank.
static DRAWN: AtomicU64 = AtomicU64::new(0);
static BLANK: AtomicBool = AtomicBool::new(false);

/// What is drawn of a scene.
type Worn = Option<Arc<OwnPictureModel>>;

/// A display that shows the shopper themselves, where they look.
#[derive(Default)]
struct MirrorRenderer {
    headless: HeadlessRenderer,
    pictures: Option<PictureReceiver>,
    worn: Worn,
    mirror: OwnPicture,
}

impl Renderer for MirrorRenderer {
    type Outfit = Worn;

    fn set_outfit(&mut self, outfit: &mut Worn) {
        std::mem::swap(&mut self.worn, outfit);
    }

    fn draw(&mut self, snapshot: &Snapshot) {
        self.headless.draw(snapshot);
        let (Some(pictures), Some(worn)) = (&mut self.pictures, &self.worn) else { return };
        if !pictures.is_on() {
            let seen = pictures.latest();
            BLANK.store(DRAWN.load(Relaxed) > 0 && seen.picture.rgb.iter().all(|b| *b == 0), Relaxed);
            self.mirror.forget();
            return;
        }
        let Some(seen) = pictures.news().filter(|seen| seen.taken_ns > 0) else { return };
        let input = OwnPictureInput {
            picture: &seen.picture,
            camera: seen.camera.as_ref(),
            joints: &seen.joints,
            depth: seen.depth.as_deref(),
            mask: None,
            colours: &[],
        };
        let drawn = self.mirror.draw(worn, snapshot, &input, &OwnPictureOptions::of(Size::new(304, 540)));
        DRAWN.fetch_add(u64::from(drawn.is_ok()), Relaxed);
        pictures.report(plain::code(drawn.err()));
    }
}

/// What the sensor reads, what shoppers are measured from, and the camera's pictures.
type VisitSource = (Feed, ShopperSource, Option<(PictureReceiver, PictureSwitch)>);

/// The embedded recording: played as joints and depth, or in a camera's place.
fn source(session: &Arc<Session>, own: bool, clock: RealClock) -> VisitSource {
    if !own {
        // They stand there for as long as the visit takes.
        let feed = Feed::Played(RepeatedSession::of(session, clock.now_ns(), 0));
        return (feed, ShopperSource::Recording(session.clone()), None);
    }
    let recording = concat!("recording:", env!("CARGO_MANIFEST_DIR"), "/../../assets/data/sessions/shopper.mcap");
    let webcam = WebcamOptions { own_picture: true, ..WebcamOptions::default() };
    let (name, options) = (recording.parse().unwrap(), CameraOptions::default());
    let setup = CameraSetup { name, options, kept: GATHERED, zone: Zone::default(), webcam, portraits: false };
    let StartedCamera { feed, handle, pictures, .. } = camera_start::start(setup, clock).unwrap();
    (Feed::Camera(feed), ShopperSource::Camera(handle), pictures)
}

fn serve(config: &str, visit: impl FnOnce(&mut Finger) + Send) -> Vec<SessionState> {
    serve_with(config, false, visit)
}

/// A visit to a kiosk of this configuration, with the shopper's own picture or without; gives the states that were entered.
fn serve_with(config: &str, own: bool, visit: impl FnOnce(&mut Finger) + Send) -> Vec<SessionState> {
    let clock = RealClock::default();
    let config = format!("[wear]\nquality = \"draft\"\ncatalogue = {:?}\n{config}", SHOP.display().to_string());
    let config = Config::parse("kiosk.toml", &config).unwrap();
    let stock = Stock::read(&config).unwrap();
    let setup = VisitorSetup::new(&config, &stock, clock.now_ns()).unwrap();
    let session = Arc::new(session::open(None, None).unwrap());
    let pose = session::standing(&session).unwrap()[0];
    let dressed = stock.first.on_mannequin(&pose).unwrap();
    let (source, played, pictures) = source(&session, own, clock);
    let (pictures, switch) = pictures.unzip();
    let first = DressedScene::new(dressed, |world| (WorldScene::new(world), Worn::default()));
    let renderer = MirrorRenderer { pictures, mirror: OwnPicture::new(), ..MirrorRenderer::default() };
    let parts = LoopParts { first, renderer, source, account: ThreadAccount::new(), recording: None };
    let (live, handover) = LiveLoop::start(parts, clock, LoopOptions::default()).unwrap();
    let played = Some(played);
    let options = ServiceOptions {
        begun: Instant::now(),
        length: Some(5 * LONGEST),
        crash_after: None,
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
        draped: Box::new(|_, _| Worn::default()),
    };
    let stop = StopSignal::default();
    thread::scope(|scope| {
        let hand = scope.spawn(|| {
            let _end = AtTheEnd(&stop);
            visit(&mut finger);
        });
        let print_line = |_: &str| {};
        let environment = ServiceEnvironment {
            manager: &SilentSupervisor,
            stop: &stop,
            print_line: &print_line,
            figures: None,
            first: stock.first.clone(),
            to_scene: Box::new(|world| {
                let worn = OwnPictureModel::of(world.body(), world.garments());
                (WorldScene::new(world), Some(worn))
            }),
            pose,
            flight_recorder: None,
        };
        let (changer, controller) = (SceneChanger::new(handover, true, None), visit_of(setup, window, played, switch));
        let service = Service::new(live, changer, Box::new(controller), &options, environment);
        let (_, _, record) = service.run().unwrap();
        hand.join().expect("the visit goes through all pages");
        record.states
    })
}

fn visit_of(
    setup: VisitorSetup,
    window: WindowChannels<'_, Worn>,
    played: Option<ShopperSource>,
    switch: Option<PictureSwitch>,
) -> VisitController<'_> {
    setup.controller(window, played).switching(switch).taking_faces(None, WORN.clone())
}

/// Ends the service when the visit is over, and where it failed.
struct AtTheEnd<'a>(&'a StopSignal);

impl Drop for AtTheEnd<'_> {
    fn drop(&mut self) {
        self.0.request();
    }
}
