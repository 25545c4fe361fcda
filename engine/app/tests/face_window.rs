//! A shopper's own face at a real window: a drawn person before a webcam, whose pictures a folder holds, puts their face on the mannequin and takes it
//! away again.
//!
//! `TOILE_FACE_PICTURES=docs/pictures` keeps a picture of the page there, for the documents. The networks' files are no part of the repository: where
//! they are not fetched, this test says so and does not run.

#![cfg(all(feature = "kiosk", target_os = "linux"))]

mod common;
#[path = "../../kiosk/tests/common/painted_face.rs"]
#[expect(dead_code, reason = "of the drawn heads only the picture is used")]
mod painted_face;
mod xvfb;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::Scratch;
use image::RgbImage;
use painted_face::{PaintedHead, Shot};
use toile_assets::body::Sex;
use toile_pose::files::{self, NetworkPackage};
use toile_view::image::Size;
use xvfb::{Display, Picture};

const SIZE: [u32; 2] = [1080, 1920];

/// Longest that a screen is waited for, on a machine that may have other work.
const LONGEST: Duration = Duration::from_secs(120);

/// Time in which a screen comes to rest.
const REST: Duration = Duration::from_secs(4);

/// A whole person, 2.3 m before a camera on its side, as high as their chest.
const STANDING: Shot =
    Shot { below: 0.70, distance: 2.3, yaw: 0.0, height: 0.35, size: Size::new(720, 1280), fov_y: 0.84 };

const CONFIG: &str = "[sensor]\ncamera = \"webcam-file\"\ndevice = \"people\"\ncamera_height_mm = 1230.0\n[shopper]\nsex = \"female\"\nmeasures = [\"stature=1690\"]\n\
                      [wear]\ngarments = [\"strap-dress\"]\n[display]\nmotion = false\nface = true\n[health]\nevery_s = 0.3\n";

/// Whether the networks are there. Where continuous integration names a folder, they must be.
fn has_networks() -> bool {
    NetworkPackage::ALL.into_iter().all(|package| match package.check(&files::folder()) {
        Ok(()) => true,
        Err(error) => {
            assert!(std::env::var_os(files::FOLDER_VARIABLE).is_none(), "{error}");
            eprintln!("skipped, did not run: {error}");
            false
        }
    })
}

struct Kiosk {
    display: Display,
    program: Child,
}

impl Drop for Kiosk {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

impl Kiosk {
    fn start(scratch: &Scratch) -> Self {
        let people = scratch.path().join("people");
        fs::create_dir(&people).unwrap();
        let (picture, _) = PaintedHead::new(Sex::Female, 902).taken(&STANDING);
        let picture = RgbImage::from_raw(picture.width, picture.height, picture.rgb).unwrap();
        picture.save(people.join("person.png")).unwrap();
        fs::write(scratch.path().join("kiosk.toml"), CONFIG).unwrap();
        let display = Display::start(SIZE);
        let program = Command::new(env!("CARGO_BIN_EXE_toile"))
            .args(["kiosk", "--windowed", &format!("{}x{}", SIZE[0], SIZE[1]), "--config", "kiosk.toml"])
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
        Self { display, program }
    }

    /// Waits until something is seen; else a picture of the display and what was printed say why.
    fn wait(&self, what: &str, scratch: &Scratch, is_seen: impl Fn(&Picture) -> bool) -> Picture {
        self.display.wait(LONGEST, is_seen).unwrap_or_else(|last| {
            let shot = Path::new(env!("CARGO_TARGET_TMPDIR")).join("face.png");
            last.write(&shot);
            let lines = fs::read_to_string(scratch.path().join("lines")).unwrap_or_default();
            panic!("{what} is not seen; see {}, and what it printed: {lines}", shot.display())
        })
    }

    /// Waits until somebody stands dressed.
    fn until_dressed(&self, scratch: &Scratch) {
        let begun = Instant::now();
        let lines = || fs::read_to_string(scratch.path().join("lines")).unwrap();
        while !lines().lines().last().is_some_and(|line| line.contains(", try-on, ")) {
            assert!(begun.elapsed() < LONGEST, "nobody is dressed: {}", lines());
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    fn keys(&self, keys: &[&str]) {
        for key in keys {
            self.display.key(key);
            std::thread::sleep(Duration::from_millis(700));
        }
    }
}

/// Share of the left half, where the body stands, that has the colour of the person's skin; the mannequin's is paler.
fn skin(seen: &Picture) -> f64 {
    let [width, height] = seen.size;
    let is_skin = |p: &[u8]| {
        let [r, g, b] = [p[0], p[1], p[2]].map(f64::from);
        r > 90.0 && (0.66..0.84).contains(&(g / r)) && (0.48..0.72).contains(&(b / r))
    };
    let left = (0..width * height).filter(|i| i % width < width / 2);
    left.filter(|i| is_skin(&seen.rgb[3 * i..3 * i + 3])).count() as f64 / (width * height / 2) as f64
}

#[test]
fn a_shopper_puts_their_face_on_and_takes_it_away() {
    if xvfb::missing().is_some() || !has_networks() {
        return;
    }
    let scratch = Scratch::new("face-window");
    let kiosk = Kiosk::start(&scratch);
    kiosk.until_dressed(&scratch);
    std::thread::sleep(REST);
    kiosk.display.give_keys("Toile");
    let plain = skin(&kiosk.display.look());
    // Clothes, two sizes, zones, compare, see myself, my face.
    kiosk.keys(&["Tab", "Tab", "Tab", "Tab", "Tab", "Tab", "Return"]);
    assert!(skin(&kiosk.display.look()) < plain + 0.003, "nothing is taken before they press");
    kiosk.keys(&["Return"]);
    let on = kiosk.wait("a face on the mannequin", &scratch, |seen| skin(seen) > plain + 0.02);
    println!("skin: {plain:.4} of the plain mannequin, {:.4} with the face", skin(&on));
    std::thread::sleep(REST);
    if let Some(folder) = std::env::var_os("TOILE_FACE_PICTURES").map(PathBuf::from) {
        // Tests run in the folder of their crate.
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
        kiosk.display.look().write(&folder.join("face-page.png"));
    }
    // Beside trying again, taking it away.
    kiosk.keys(&["Tab", "Return"]);
    kiosk.wait("the plain mannequin", &scratch, |seen| skin(seen) < plain + 0.005);
}
