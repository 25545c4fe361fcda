//! `toile kiosk --headless` as a service manager and a script meet it: readiness, the watchdog, signals, files left behind.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::common::Scratch;
use serde_json::Value;

/// Short visits of the embedded shopper, who comes after two seconds and stays for ten, in a garment that is soon draped; a health line
/// each fifth of a second.
const VISITS: &str = "[wear]\ngarments = [\"scarf\"]\nquality = \"draft\"\n[shopper]\nsex = \"female\"\n[sensor]\npause_s = 2.0\n\
     [session]\nmeasure_s = 0.5\nstep_out_s = 0.5\nwipe_s = 0.5\n[health]\nevery_s = 0.2\n";

/// Longest that a shopper is waited for: on a machine that compiles something beside it, the tailor takes a visit or two.
const LONGEST: Duration = Duration::from_secs(120);

/// Kiosks that a test starts run beside those of other tests, but not beside the one that has so many seconds for a visit:
/// where threads get real-time priority, several kiosks on two cores leave the tailor of each next to none.
static MACHINE: RwLock<()> = RwLock::new(());

/// Held by a test that runs beside others.
fn beside_others() -> RwLockReadGuard<'static, ()> {
    MACHINE.read().unwrap_or_else(PoisonError::into_inner)
}

/// The empty file that is locked while a kiosk runs.
const LOCK: &str = "toile-kiosk.lock";

/// A kiosk that runs; it is killed with the test.
struct Running(Child);

impl Running {
    fn start(scratch: &Scratch, manager: &Path, args: &[&str]) -> Self {
        let mut command = Command::new(crate::PROGRAM);
        command.args(["kiosk", "--headless", "--json"]).args(args).current_dir(scratch.path());
        command.env("NOTIFY_SOCKET", manager).env("WATCHDOG_USEC", "900000").env_remove("WATCHDOG_PID");
        command.env_remove("RUST_BACKTRACE").env("TMPDIR", scratch.path()).env("XDG_RUNTIME_DIR", scratch.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Self(command.spawn().expect("the built program starts"))
    }

    fn terminate(&self) {
        let killed = Command::new("kill").args(["-TERM", &self.0.id().to_string()]).status();
        assert!(killed.expect("kill is there").success());
    }

    /// Its exit code; none where a signal ended it.
    fn wait(&mut self, longest: Duration) -> Option<i32> {
        let end = Instant::now() + longest;
        while Instant::now() < end {
            if let Some(status) = self.0.try_wait().unwrap() {
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("it runs on {longest:?} after it was told to end");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The states as the health lines tell them, each once in a row, until all were seen and the first came back.
fn watch(running: &mut Running) -> Vec<String> {
    let begun = Instant::now();
    let mut states: Vec<String> = Vec::new();
    let lines = BufReader::new(running.0.stderr.take().unwrap()).lines();
    for line in lines.map_while(Result::ok) {
        let mut parts =
            line.strip_prefix("health: up ").unwrap_or_else(|| panic!("not a health line: {line}")).split(", ");
        let state = parts.nth(1).unwrap().to_owned();
        if states.last() != Some(&state) {
            states.push(state);
        }
        let seen = |name: &str| states.iter().position(|s| s == name);
        if seen("try-on").is_some_and(|i| states[i..].iter().any(|s| s == "attract")) {
            // Where nothing reads its stderr any more, it must not end of that.
            return states;
        }
        assert!(begun.elapsed() < LONGEST, "{states:?}");
    }
    panic!("it ended by itself: {states:?}");
}

/// What a process has open that could keep or send something of a person.
#[cfg(target_os = "linux")]
fn open_to_the_world(pid: u32) -> Vec<String> {
    let net: String = ["tcp", "tcp6", "udp", "udp6", "raw", "packet"]
        .iter()
        .map(|name| fs::read_to_string(format!("/proc/net/{name}")).unwrap_or_default())
        .collect();
    let of_net = |inode: &str| net.split_whitespace().any(|word| word == inode);
    let mut found = Vec::new();
    for entry in fs::read_dir(format!("/proc/{pid}/fd")).unwrap().flatten() {
        // One that was closed meanwhile.
        let Ok(target) = fs::read_link(entry.path()) else { continue };
        let target = target.display().to_string();
        let is_file = target.starts_with('/') && !target.starts_with("/dev/null") && !target.starts_with("/proc/");
        let inode = target.strip_prefix("socket:[").and_then(|t| t.strip_suffix(']'));
        if is_file || inode.is_some_and(of_net) {
            found.push(target);
        }
    }
    found
}

/// A manager that reads what it is told as it comes: an unread datagram holds its sender up.
struct Manager {
    reading: JoinHandle<Vec<String>>,
    over: Arc<AtomicBool>,
}

impl Manager {
    fn at(path: &Path) -> Self {
        let socket = UnixDatagram::bind(path).unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
        let over = Arc::new(AtomicBool::new(false));
        let ended = over.clone();
        let read = move || {
            let (mut messages, mut bytes) = (Vec::new(), [0; 512]);
            // Whatever was sent before the end is read: it waits in the socket.
            while let Some(n) = socket.recv(&mut bytes).map_or_else(|_| (!ended.load(Relaxed)).then_some(0), Some) {
                messages.extend(String::from_utf8_lossy(&bytes[..n]).lines().map(str::to_owned));
            }
            messages
        };
        Self { reading: std::thread::spawn(read), over }
    }

    /// All lines that it was told.
    fn messages(self) -> Vec<String> {
        self.over.store(true, Relaxed);
        self.reading.join().unwrap()
    }
}

#[test]
fn a_visit_is_reported_and_leaves_no_files() {
    let _beside = beside_others();
    let scratch = Scratch::new("kiosk");
    fs::write(scratch.path().join("kiosk.toml"), VISITS).unwrap();
    let manager = scratch.path().join("manager");
    let reading = Manager::at(&manager);
    let mut running = Running::start(&scratch, &manager, &["--config", "kiosk.toml"]);
    watch(&mut running);
    #[cfg(target_os = "linux")]
    assert_eq!(open_to_the_world(running.0.id()), [scratch.path().join(LOCK).display().to_string()]);

    running.terminate();
    let told_ns = Instant::now();
    assert_eq!(running.wait(Duration::from_secs(3)), Some(0));
    println!("ended {:?} after it was told to", told_ns.elapsed());
    let mut text = String::new();
    running.0.stdout.take().unwrap().read_to_string(&mut text).unwrap();
    let found: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(found["schema"], "toile.kiosk/1");
    let states: Vec<&str> = found["states"].as_array().unwrap().iter().map(|s| s.as_str().unwrap()).collect();
    assert_eq!(states[..2], ["attract", "measuring"]);
    let dressed = states.iter().position(|s| *s == "try-on").unwrap();
    assert_eq!(states[dressed..dressed + 3], ["try-on", "left", "attract"]);
    let whole = |key: &str| found[key].as_u64().unwrap();
    assert!(whole("sessions") >= 1 && whole("nonfinite") == 0);
    // Whatever the machine did meanwhile, every step was taken or counted as dropped.
    let due = found["seconds"].as_f64().unwrap() * 120.0;
    let taken = (whole("steps") + whole("steps_dropped")) as f64;
    assert!((taken / due - 1.0).abs() < 0.02, "{taken} steps of {due}");
    assert!(whole("frames") > 0 && found["step_us"]["count"].as_u64() == Some(whole("steps")));
    assert!(found["present_us"]["p50"].as_f64().unwrap() > 0.0);
    println!("ready after {} ms", found["ready_ms"]);

    let messages = reading.messages();
    assert_eq!(messages[0], "READY=1");
    assert_eq!(messages.last().unwrap(), "STOPPING=1");
    let alive = messages.iter().filter(|t| *t == "WATCHDOG=1").count();
    assert_eq!(alive, messages.len() - 2);
    assert!(alive as f64 > due / 120.0, "{alive} in {} s: less than once a second", due / 120.0);
    let mut left: Vec<_> = fs::read_dir(scratch.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["kiosk.toml", "manager", LOCK], "a visit left files behind");
    assert_eq!(fs::metadata(scratch.path().join(LOCK)).unwrap().len(), 0, "the lock is an empty file");
}

/// Whether a process has a handler for SIGTERM yet.
#[cfg(target_os = "linux")]
fn listens(pid: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let mask = status.lines().find_map(|l| l.strip_prefix("SigCgt:")).map(str::trim);
    mask.and_then(|m| u64::from_str_radix(m, 16).ok()).is_some_and(|m| m >> (15 - 1) & 1 == 1)
}

#[test]
#[cfg(target_os = "linux")]
fn it_ends_on_the_spot_while_it_still_starts() {
    let _beside = beside_others();
    let scratch = Scratch::new("kiosk-start");
    let mut running = Running::start(&scratch, Path::new("nowhere"), &[]);
    while !listens(running.0.id()) {
        assert!(running.0.try_wait().unwrap().is_none());
    }
    running.terminate();
    assert_eq!(running.wait(Duration::from_secs(2)), Some(0));
    let mut text = String::new();
    running.0.stdout.take().unwrap().read_to_string(&mut text).unwrap();
    assert_eq!(text, "", "there is nothing to tell yet");
}

#[test]
fn joints_that_arrive_over_the_loopback_are_a_shopper() {
    let _beside = beside_others();
    let scratch = Scratch::new("kiosk-vmc");
    // A port that was free a moment ago.
    let port = std::net::UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let config = format!(
        "[wear]\ngarments = [\"scarf\"]\n[sensor]\nsource = \"vmc\"\nvmc = \"127.0.0.1:{port}\"\n[health]\nevery_s = 0.0\n"
    );
    fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
    let output = scratch.toile(&["kiosk", "--headless", "--json", "--seconds", "1", "--config", "kiosk.toml"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(found["states"], serde_json::json!(["attract"]), "without a sender no shopper is there");
    assert!(found["steps"].as_u64().unwrap() + found["steps_dropped"].as_u64().unwrap() > 100);
    assert!(output.stderr.is_empty(), "health lines are off");
}

#[test]
fn what_cannot_be_used_is_refused_in_one_sentence() {
    let _beside = beside_others();
    let scratch = Scratch::new("kiosk-bad");
    fs::write(scratch.path().join("bad.toml"), "[wear]\ngarmets = [\"tee\"]\n").unwrap();
    fs::write(scratch.path().join("other.toml"), "[wear]\ngarments = [\"tent\"]\n").unwrap();
    for (args, code, expected) in [
        (&["--headless", "--config", "bad.toml"][..], 4, "bad.toml:2: [wear] has no key \"garmets\""),
        (&["--headless", "--config", "other.toml"], 4, "tent"),
        (&["--headless", "--config", "none.toml"], 4, "none.toml"),
        (&["--headless", "--session", "none.csv"], 4, "none.csv"),
        (&[], 2, "--headless"),
    ] {
        // With a window it opens one; tests/window.rs has that.
        if cfg!(feature = "kiosk") && args.is_empty() {
            continue;
        }
        let output = scratch.toile(&[&["kiosk"], args].concat());
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
        assert!(message.contains(expected) && message.lines().count() == 1, "{args:?}: {message}");
    }
    let printed = scratch.toile(&["kiosk", "--print-config"]);
    assert_eq!(printed.status.code(), Some(0));
    fs::write(scratch.path().join("printed.toml"), printed.stdout).unwrap();
    let output = scratch.toile(&["kiosk", "--headless", "--quiet", "--seconds", "1", "--config", "printed.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_second_kiosk_says_that_one_runs_and_a_named_one_runs_beside_it() {
    let _beside = beside_others();
    let scratch = Scratch::new("kiosk-second");
    fs::write(scratch.path().join("kiosk.toml"), VISITS).unwrap();
    let line = ["kiosk", "--headless", "--quiet", "--seconds", "1", "--config", "kiosk.toml"];
    let mut first = Running::start(&scratch, Path::new("nowhere"), &["--config", "kiosk.toml"]);
    let begun = Instant::now();
    while !scratch.path().join(LOCK).exists() {
        assert!(begun.elapsed() < LONGEST && first.0.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    // The file is there a moment before it is locked.
    std::thread::sleep(Duration::from_millis(200));
    let second = scratch.toile(&line);
    let message = String::from_utf8(second.stderr).unwrap();
    assert_eq!(second.status.code(), Some(5), "{message}");
    assert!(
        message.contains("already runs") && message.contains("--instance") && message.lines().count() == 1,
        "{message}"
    );
    let named = scratch.toile(&[&line[..], &["--instance", "left"]].concat());
    assert_eq!(named.status.code(), Some(0), "{}", String::from_utf8_lossy(&named.stderr));
    assert!(scratch.path().join("toile-kiosk-left.lock").exists());
    // Killed: the system releases the lock.
    first.0.kill().unwrap();
    first.0.wait().unwrap();
    let next = scratch.toile(&line);
    assert_eq!(next.status.code(), Some(0), "{}", String::from_utf8_lossy(&next.stderr));
}

/// The value of a unit's key.
fn value<'a>(unit: &'a str, key: &str) -> &'a str {
    let find = |line: &'a str| line.strip_prefix(key)?.strip_prefix('=');
    unit.lines().find_map(find).unwrap_or_else(|| panic!("the unit has no {key}"))
}

#[test]
fn the_unit_starts_what_there_is_with_the_rights_that_it_needs() {
    let _beside = beside_others();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../kiosk/systemd");
    let unit = fs::read_to_string(folder.join("toile.service")).unwrap();
    let line = value(&unit, "ExecStart");
    let words = toile::cli::command().try_get_matches_from(line.split_whitespace()).expect("the grammar knows it");
    let (name, args) = words.subcommand().expect("a command");
    assert!(name == "kiosk" && args.get_flag("headless") && args.contains_id("config"), "{line}");
    for (key, expected) in [
        ("Type", "notify"),
        ("Restart", "always"),
        ("StartLimitIntervalSec", "0"),
        ("PrivateNetwork", "yes"),
        ("ProtectSystem", "strict"),
        ("LimitCORE", "0"),
        ("LimitMEMLOCK", "infinity"),
        ("RuntimeDirectory", "toile"),
        ("CapabilityBoundingSet", ""),
    ] {
        assert_eq!(value(&unit, key), expected, "{key}");
    }
    use toile_engine::frame_loop::thread_roles::ThreadRole;
    let highest = ThreadRole::ALL.into_iter().filter_map(ThreadRole::priority).max();
    assert_eq!(value(&unit, "LimitRTPRIO").parse().ok(), highest, "the limit is what the threads ask for");
    assert!(value(&unit, "WatchdogSec").parse::<u64>().unwrap() >= 3, "a stall of two seconds is survived");
    let loopback = fs::read_to_string(folder.join("loopback.conf")).unwrap();
    assert_eq!(value(&loopback, "IPAddressAllow"), "localhost");
    // Pictures are served in a private network: one that `picture.serve` takes.
    let link = fs::read_to_string(folder.join("link.conf")).unwrap();
    assert!(value(&link, "IPAddressAllow").starts_with("192.168."), "{link}");
    // systemd itself, where there is one. It looks whether the program is there, so the one that is.
    let program = crate::PROGRAM;
    let scratch = Scratch::new("kiosk-unit");
    fs::write(scratch.path().join("toile.service"), unit.replace("/usr/bin/toile", program)).unwrap();
    let verify = Command::new("systemd-analyze").args(["verify", "toile.service"]).current_dir(scratch.path()).output();
    if let Ok(output) = verify {
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !message.contains("toile.service"), "{message}");
    }
}

/// Where the configuration asks for it, and only there: the mannequin, a visit, and the mannequin again.
#[test]
fn a_crash_leaves_its_last_seconds_where_a_shop_asked_for_them_and_they_replay() {
    let _alone = MACHINE.write().unwrap_or_else(PoisonError::into_inner);
    let scratch = Scratch::new("kiosk-crash");
    let run = |config: &str, seconds: &str| {
        fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
        let output = scratch.toile(&["kiosk", "--headless", "--config", "kiosk.toml", "--crash-after", seconds]);
        assert_eq!(output.status.code(), Some(70));
        String::from_utf8(output.stderr).unwrap()
    };
    // The shopper comes after two seconds, stays for ten, and is forgotten a second later.
    let message = run(&format!("{VISITS}[crash]\nrecording = \"crash.tape\"\n"), "14");
    assert!(message.contains("toile replay crash.tape"), "{message}");
    for workers in ["2", "1"] {
        let output = scratch.toile(&["replay", "crash.tape", "--workers", workers, "--json"]);
        let again: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((output.status.code(), &again["diverged_at"]), (Some(0), &Value::Null), "{workers} workers");
        assert!(again["ticks"].as_u64().unwrap() >= 9 * 120, "{again}");
    }
    let bytes = fs::read(scratch.path().join("crash.tape")).unwrap();
    let notes = toile_engine::frame_loop::recording::read(&bytes).unwrap().notes;
    assert!(notes.iter().any(|n| n.text.contains("\"still\":false")), "a shopper was there: {notes:?}");
    fs::remove_file(scratch.path().join("crash.tape")).unwrap();
    let message = run(VISITS, "1");
    assert!(!message.contains("recorded"), "{message}");
    let mut left: Vec<_> = fs::read_dir(scratch.path()).unwrap().flatten().map(|e| e.file_name()).collect();
    left.sort();
    assert_eq!(left, ["kiosk.toml", LOCK]);
}
