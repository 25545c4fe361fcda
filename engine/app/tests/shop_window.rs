//! A visit at a real window in a made-up shop, whose catalogue changes meanwhile: the shop that the example `shop` writes.
//!
//! `TOILE_SHOP_PICTURES=docs/pictures` keeps a picture of each screen there, for the documents; with `TOILE_SHOP_CAMERA=kinect` the visitor is seen by
//! a Kinect, which fakenect plays.

#[path = "../examples/shop/main.rs"]
#[expect(dead_code, reason = "of the example only what writes the shop is used")]
mod shop;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::Scratch;
use crate::kinect;
use crate::xvfb;
use crate::xvfb::{Display, Picture};

const SIZE: [u32; 2] = [540, 960];

/// The variable that names the folder of pictures for the documents.
const PICTURES: &str = "TOILE_SHOP_PICTURES";

/// Longest that a screen is waited for, on a machine that may have other work.
const LONGEST: Duration = Duration::from_secs(120);

/// Time in which a picture for the documents comes to rest, cloth and all.
const REST: Duration = Duration::from_secs(6);

/// The ring around what has the focus, on a light ground.
const FOCUS: [u8; 3] = [0, 89, 179];

/// What most will press next in the shop's colours.
const ACCENT: [u8; 3] = [148, 51, 43];

/// The shop's ground, and the one that it changes to, sRGB of 255.
const PAPER: [u8; 3] = [246, 241, 232];
const NIGHT: [u8; 3] = [20, 26, 46];

/// Depth images of the visitor who is seen by a Kinect: three minutes.
const IMAGES: usize = 5_400;

/// What is behind the words before the first body is drawn.
const BEHIND: [u8; 3] = [28, 29, 32];

const CONFIG: &str = "[wear]\ncatalogue = \"shop\"\n[sensor]\npause_s = 5.0\n[session]\nstep_out_s = 8.0\n[display]\nmotion = false\n[health]\nevery_s = 0.3\n";

/// The program at a window of its own.
struct Kiosk {
    display: Display,
    program: Child,
    pictures: Option<PathBuf>,
}

impl Kiosk {
    fn start(scratch: &Scratch) -> Self {
        let display = Display::start(SIZE);
        let mut command = Command::new(crate::PROGRAM);
        let mut config = CONFIG.to_owned();
        if std::env::var_os("TOILE_SHOP_CAMERA").is_some() {
            let library = kinect::player().expect("Debian's freenect is installed");
            let recording = scratch.path().join("visit");
            kinect::write_recording(&recording, IMAGES);
            kinect::play(&mut command, &library, &recording);
            config = config.replace("[sensor]", "[sensor]\ncamera = \"kinect\"");
        }
        fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
        let program = command
            .args(["kiosk", "--windowed", &format!("{}x{}", SIZE[0], SIZE[1]), "--json", "--config", "kiosk.toml"])
            .current_dir(scratch.path())
            .env("DISPLAY", display.name())
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_RUNTIME_DIR", scratch.path())
            .env("LP_NUM_THREADS", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(fs::File::create(scratch.path().join("lines")).unwrap())
            .spawn()
            .expect("the built program starts");
        let pictures = std::env::var_os(PICTURES).map(PathBuf::from);
        // Tests run in the folder of their crate.
        let pictures = pictures.map(|path| Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path));
        Self { display, program, pictures }
    }

    /// Waits until something is seen.
    fn wait(&self, what: &str, is_seen: impl Fn(&Picture) -> bool) -> Picture {
        self.display.wait(LONGEST, is_seen).unwrap_or_else(|last| {
            let shot = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shop.png");
            last.write(&shot);
            panic!("{what} is not seen; see {}", shot.display())
        })
    }

    /// Waits until the lines that it has printed say something.
    fn until(&self, what: &str, scratch: &Scratch, is_said: impl Fn(&str) -> bool) {
        let begun = Instant::now();
        loop {
            let lines = fs::read_to_string(scratch.path().join("lines")).unwrap();
            if is_said(&lines) {
                return;
            }
            assert!(begun.elapsed() < LONGEST, "{what} is not said: {lines}");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Keeps a picture of what is on the display, where pictures are asked for.
    fn keep(&self, name: &str) {
        if let Some(folder) = &self.pictures {
            std::thread::sleep(REST);
            self.display.look().write(&folder.join(format!("shop-{name}.png")));
        }
    }

    /// Goes so many controls on with the Tab key.
    fn tab(&self, times: usize) {
        let mut before = self.focus(None);
        for _ in 0..times {
            self.display.key("Tab");
            before = self.focus(Some(before));
        }
    }

    fn focus(&self, before: Option<[i32; 2]>) -> [i32; 2] {
        let moved = |seen: &Picture| seen.middle_of(FOCUS).is_some_and(|now| Some(now) != before);
        self.wait("another focus", moved).middle_of(FOCUS).unwrap()
    }

    fn enter(&self, places: usize) {
        self.tab(places);
        self.display.key("Return");
    }
}

impl Drop for Kiosk {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// Share of a picture below a height (share of it from above) that has about a colour.
fn share(picture: &Picture, from: f64, colour: [u8; 3]) -> f64 {
    let part = &picture.rgb[(picture.size[1] as f64 * from) as usize * picture.size[0] * 3..];
    let close = |p: &&[u8]| p.iter().zip(colour).all(|(a, b)| a.abs_diff(b) < 16);
    part.chunks_exact(3).filter(close).count() as f64 / (part.len() / 3) as f64
}

/// Where the page begins on which no person is in view; other pages stand anywhere.
const LOW: f64 = 0.6;

#[test]
fn a_shop_shows_its_own_screens_and_a_change_is_seen_when_the_visitor_has_left() {
    if xvfb::missing().is_some() {
        return;
    }
    let scratch = Scratch::new("shop-window");
    let folder = scratch.path().join("shop");
    // Each garment is draped and drawn for its photograph: without pictures for the documents two are enough.
    let garments = if std::env::var_os(PICTURES).is_some() { &shop::GARMENTS[..] } else { &shop::GARMENTS[..2] };
    shop::write(&folder, garments).unwrap();
    let kiosk = Kiosk::start(&scratch);
    kiosk.wait("the shop's ground", |seen| share(seen, LOW, PAPER) > 0.4);
    kiosk.display.give_keys("Toile");
    if let Some(folder) = &kiosk.pictures {
        // The first picture of the body comes after the words.
        kiosk.wait("a mannequin", |seen| share(seen, 0.0, BEHIND) < 0.05);
        kiosk.display.look().write(&folder.join("shop-attract.png"));
    }
    kiosk.until("a dressed shopper", &scratch, |lines| {
        lines.lines().last().is_some_and(|line| line.contains(", try-on, "))
    });
    let has_primary = |seen: &Picture| share(seen, 0.0, ACCENT) > 0.008;
    kiosk.wait("the fitting page", has_primary);
    kiosk.keep("fitting");
    kiosk.enter(0);
    kiosk.wait("the page of clothes", |seen| !has_primary(seen) && share(seen, 0.0, PAPER) > 0.1);
    kiosk.keep("garments");
    // The shop changes while a person looks: they keep what they see.
    let text = fs::read_to_string(folder.join("catalogue.toml")).unwrap();
    let night = text
        .replace("garments = [", "garments = [\"half.toile\", ")
        .replace("ground = [0.965, 0.945, 0.910]", "ground = [0.08, 0.10, 0.18]")
        .replace("text = [0.13, 0.16, 0.19]", "text = [0.97, 0.96, 0.92]");
    fs::write(folder.join("half.toile"), b"PK\x03\x04").unwrap();
    fs::write(folder.join("new"), night).unwrap();
    fs::rename(folder.join("new"), folder.join("catalogue.toml")).unwrap();
    kiosk.until("what is left out", &scratch, |lines| {
        let said = |words: &str| lines.contains(words);
        said("left out of the catalogue: half.toile") || (said("left out of the catalogue: ") && said("half.toile"))
    });
    assert!(share(&kiosk.display.look(), 0.0, PAPER) > 0.1, "the visitor keeps what they see");
    kiosk.display.key("Escape");
    kiosk.wait("the fitting page again", has_primary);
    if kiosk.pictures.is_some() {
        rest_of_the_visit(&kiosk);
    }
    // The last control forgets them.
    kiosk.display.key("shift+Tab");
    kiosk.focus(None);
    kiosk.display.key("Return");
    let after = kiosk.wait("the shop's new ground", |seen| share(seen, LOW, NIGHT) > 0.25);
    assert!(share(&after, LOW, PAPER) < 0.05);
}

/// The other screens, for the documents.
fn rest_of_the_visit(kiosk: &Kiosk) {
    // Another garment, and how it fits.
    kiosk.enter(0);
    std::thread::sleep(REST);
    kiosk.enter(0);
    std::thread::sleep(2 * REST);
    kiosk.keep("skirt");
    for (places, name) in [(3, "zones"), (4, "compare")] {
        kiosk.display.key("Escape");
        std::thread::sleep(REST);
        kiosk.enter(places);
        std::thread::sleep(REST);
        kiosk.keep(name);
    }
    kiosk.display.key("Escape");
    std::thread::sleep(REST);
}
