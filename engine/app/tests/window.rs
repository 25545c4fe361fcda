//! A whole visit at a real window: the program itself under an X server of the test's own, drawn by the processor, seen through the
//! server's memory, pressed by its mouse and its keys.
//!
//! Screens are compared with those kept in tests/screens; `TOILE_KEEP_SCREENS=1` keeps new ones. What was seen lies in
//! target/screens.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::Scratch;
use crate::xvfb;
use crate::xvfb::{Display, Picture};
use serde_json::Value;

const SIZE: [u32; 2] = [540, 960];

/// Longest that a screen is waited for: a body is measured and dressed meanwhile, on a machine that may have other work.
const LONGEST: Duration = Duration::from_secs(90);

/// Where words and controls are (left, top, right, bottom, shares of the screen): a low panel, a column, and what is below a picture's code, which
/// is another for every picture.
const LOW: [f64; 4] = [0.0, 0.55, 1.0, 1.0];
const COLUMN: [f64; 4] = [0.53, 0.25, 0.97, 0.88];
const BELOW_CODE: [f64; 4] = [0.05, 0.73, 0.95, 0.92];
const ALL: [f64; 4] = [0.0, 0.0, 1.0, 1.0];

/// Greatest mean difference (of 255) of a screen from the one that was kept: of words and controls, and with the body, which moves.
const MOST: [f64; 2] = [2.5, 16.5];

/// The colour of the focus ring, which nothing else has.
const FOCUS: [u8; 3] = [255, 205, 96];

/// The recording comes and goes; the shopper has not left while it pauses, which is long enough for a slow machine to show the welcome.
const CONFIG: &str = "[sensor]\npause_s = 12.0\n[session]\nstep_out_s = 16.0\n[display]\nmotion = false\n";

/// The program at a window of its own.
struct Kiosk {
    display: Display,
    program: Child,
    shots: PathBuf,
}

impl Kiosk {
    fn start(scratch: &Scratch) -> Self {
        let display = Display::start(SIZE);
        fs::write(scratch.path().join("kiosk.toml"), CONFIG).unwrap();
        let program = Command::new(crate::PROGRAM)
            .args(["kiosk", "--windowed", &format!("{}x{}", SIZE[0], SIZE[1]), "--json", "--config", "kiosk.toml"])
            .current_dir(scratch.path())
            .env("DISPLAY", display.name())
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_RUNTIME_DIR", scratch.path())
            .env("LP_NUM_THREADS", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the built program starts");
        let shots = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("screens");
        Self { display, program, shots }
    }

    /// Waits for a screen that was kept. Its panel has to be as it was; the body only about.
    fn expect(&self, name: &str, panel: [f64; 4]) {
        let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/screens").join(format!("{name}.png"));
        let shot = self.shots.join(format!("{name}.png"));
        if std::env::var_os("TOILE_KEEP_SCREENS").is_some() {
            // A person steps in soon after the start, and is measured and dressed.
            std::thread::sleep(Duration::from_secs(match name {
                "1-attract" => 4,
                "2-fitting" => 16,
                // Two sizes are sewn up meanwhile.
                "6-compare" => 25,
                _ => 7,
            }));
            self.display.look().write(&kept);
        }
        let wanted = Picture::read(&kept).unwrap_or_else(|| panic!("{} is missing", kept.display()));
        // A picture's code is a third of its page and changes with every picture.
        let all = if panel == BELOW_CODE { panel } else { ALL };
        let differences = |seen: &Picture| [panel, all].map(|part| seen.differs(&wanted, part));
        let like = |seen: &Picture| differences(seen).iter().zip(MOST).all(|(d, most)| *d < most);
        match self.display.wait(LONGEST, like) {
            Ok(seen) => seen.write(&shot),
            Err(seen) => {
                seen.write(&shot);
                let [words, all] = differences(&seen);
                panic!("{name}: {words:.1} in the panel, {all:.1} over all; see {}", shot.display());
            }
        }
    }

    /// Where the focus ring is, once it is elsewhere than it was.
    fn focus(&self, before: Option<[i32; 2]>) -> [i32; 2] {
        let moved = |seen: &Picture| seen.middle_of(FOCUS).is_some_and(|now| Some(now) != before);
        let seen = self.display.wait(LONGEST, moved).unwrap_or_else(|_| panic!("the focus stays at {before:?}"));
        seen.middle_of(FOCUS).unwrap()
    }

    /// Goes so many controls on with the Tab key; gives where the focus is then.
    fn tab(&self, times: usize) -> [i32; 2] {
        (0..times).fold(self.focus(None), |before, _| {
            self.display.key("Tab");
            self.focus(Some(before))
        })
    }

    /// Presses the control so many places on, by the mouse.
    fn click(&self, places: usize) {
        let at = self.tab(places);
        self.display.click(at);
    }

    /// Presses the last control by the mouse: it is one place before the first.
    fn click_last(&self) {
        let first = self.focus(None);
        self.display.key("shift+Tab");
        self.display.click(self.focus(Some(first)));
    }

    /// Presses it by the Enter key.
    fn enter(&self, places: usize) {
        self.tab(places);
        self.display.key("Return");
    }

    /// Ends it as a service manager does; gives its report.
    fn end(mut self) -> Value {
        let sent = Command::new("kill").args(["-TERM", &self.program.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let end = Instant::now() + Duration::from_secs(20);
        while self.program.try_wait().unwrap().is_none() {
            assert!(Instant::now() < end, "it runs on after it was told to end");
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(self.program.wait().unwrap().code(), Some(0));
        serde_json::from_reader(self.program.stdout.take().unwrap()).unwrap()
    }
}

impl Drop for Kiosk {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

#[test]
fn a_visit_by_mouse_and_keys_from_arriving_to_leaving() {
    if xvfb::missing().is_some() {
        return;
    }
    let scratch = Scratch::new("window");
    let kiosk = Kiosk::start(&scratch);
    kiosk.expect("1-attract", LOW);
    kiosk.display.give_keys("Toile");
    // A person steps in and is measured; nothing is pressed for it.
    kiosk.expect("2-fitting", COLUMN);
    kiosk.click(3);
    kiosk.expect("3-zones", COLUMN);
    kiosk.enter(1);
    kiosk.expect("4-zone", COLUMN);
    kiosk.display.key("Escape");
    kiosk.expect("3-zones", COLUMN);
    kiosk.display.key("Escape");
    kiosk.expect("2-fitting", COLUMN);
    kiosk.enter(0);
    kiosk.expect("5-garments", COLUMN);
    kiosk.display.key("Escape");
    kiosk.expect("2-fitting", COLUMN);
    kiosk.click(4);
    kiosk.expect("6-compare", LOW);
    kiosk.display.key("Escape");
    kiosk.expect("2-fitting", COLUMN);
    kiosk.click(7);
    kiosk.expect("7-picture", BELOW_CODE);
    // The picture is deleted, and the shopper forgotten.
    kiosk.enter(0);
    kiosk.display.key("Escape");
    kiosk.expect("2-fitting", COLUMN);
    kiosk.click_last();
    kiosk.expect("1-attract", LOW);
    let report = kiosk.end();
    let states: Vec<&str> = report["states"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(states[..3], ["attract", "measuring", "try-on"]);
    assert_eq!(states.last(), Some(&"attract"));
    let window = &report["window"];
    assert!(window["presented"].as_u64().unwrap() > 20, "{window}");
    assert_eq!((window["refused"].as_u64(), window["lost"].as_u64()), (Some(0), Some(0)));
    assert_eq!(report["nonfinite"], 0);
    eprintln!("{window:#}");
}

#[test]
fn without_a_display_it_says_what_to_do() {
    let scratch = Scratch::new("nowhere");
    let mut command = Command::new(crate::PROGRAM);
    command.arg("kiosk").current_dir(scratch.path()).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.env_remove("WAYLAND_SOCKET").output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(5), "{message}");
    assert!(message.contains("--headless") && message.lines().count() == 1, "{message}");
}
