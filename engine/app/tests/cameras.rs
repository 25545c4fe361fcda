//! Live cameras as a user meets them, with a library that plays a recording in a Kinect's place (Debian's freenect).

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::common::Scratch;
#[cfg(unix)]
use crate::common::{alone, run_until};
use crate::kinect;
use crate::kinect::{IMAGES, player, write_recording};
use serde_json::Value;
use toile_sensors::source::live::CameraKind;

/// Runs a command with the recording in a Kinect's place.
fn with_kinect(scratch: &Scratch, library: &Path, recording: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(crate::PROGRAM);
    command.current_dir(scratch.path()).args(args);
    kinect::play(&mut command, library, recording).output().unwrap()
}

/// The report: the library may print words of its own before it or after it.
fn report(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let json = &text[text.find('{').expect("a report")..=text.rfind('}').expect("a report")];
    serde_json::from_str(json).unwrap()
}

#[test]
fn a_live_camera_gives_the_measures_of_its_recording_to_the_bit() {
    let Some(library) = player() else { return };
    let scratch = Scratch::new("camera-measures");
    let recording = scratch.path().join("visit");
    write_recording(&recording, IMAGES);
    let args = ["record", "--camera", "kinect", "--seconds", "3", "--out", "live.mcap", "--json", "--quiet"];
    let refused = with_kinect(&scratch, &library, &recording, &args);
    assert_eq!(refused.status.code(), Some(2), "no consent was asked for");
    let words = String::from_utf8_lossy(&refused.stderr);
    assert!(words.contains("consent"), "{words}");
    let recorded = report(&with_kinect(&scratch, &library, &recording, &[&args[..], &["--consent"]].concat()));
    assert!(recorded["holds"].as_str().unwrap().contains("no colour"), "{recorded}");
    assert_eq!(recorded["frames"], IMAGES, "{recorded}");
    // The raw folder holds the images by other names too: what is measured is what the index names.
    let measured = |file: &str| {
        let output = scratch.toile(&["measure", file, "--json"]);
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        (value["measurements"].clone(), value["methods"].clone(), value["valid_pixels"].clone())
    };
    let (live, file) = (measured("live.mcap"), measured("visit"));
    println!("{}", live.0);
    assert_eq!(live, file);
    assert!(live.0["chest_girth_mm"]["value"].as_f64().is_some_and(|mm| (800.0..1_200.0).contains(&mm)), "{}", live.0);
}

#[test]
fn what_a_camera_gives_is_shown() {
    let Some(library) = player() else { return };
    let scratch = Scratch::new("camera-live");
    let recording = scratch.path().join("visit");
    write_recording(&recording, 100);
    let args = ["live", "--camera", "kinect", "--seconds", "2", "--out", "look", "--json"];
    let output = with_kinect(&scratch, &library, &recording, &args);
    let live = report(&output);
    println!("{live:#}");
    assert_eq!((&live["size"][0], &live["people"], &live["state"]), (&640.into(), &1.into(), &"seeing".into()));
    assert_eq!(live["device"], "Kinect v1");
    // How fast is the machine's affair: beside other programs the tracker lets pass what it has no time for.
    assert!(live["rates_hz"]["depth"].as_f64().unwrap() > 0.0 && live["rates_hz"]["joints"].as_f64().unwrap() > 0.0);
    assert!(scratch.path().join("look/depth.png").is_file());
}

#[test]
fn a_camera_that_is_not_there_ends_with_the_code_of_a_device_and_a_bad_name_with_that_of_usage() {
    let scratch = Scratch::new("camera-missing");
    let none = scratch.toile(&["live", "--camera", "cctv"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&none.stderr).contains("give one of kinect, openni"));
    let file = scratch.toile(&["live", "--camera", "recording:no-such-file.mcap"]);
    assert_eq!(file.status.code(), Some(4), "{}", String::from_utf8_lossy(&file.stderr));
    let gone = scratch.toile(&["live", "--camera", "kinect"]);
    let words = String::from_utf8_lossy(&gone.stderr);
    assert_eq!(gone.status.code(), Some(5), "{words}");
    assert!(words.contains("no Kinect is connected") || words.contains("apt install libfreenect0.5"), "{words}");
    assert_eq!(words.lines().count(), 1, "{words}");
}

#[test]
fn the_doctor_names_every_camera_with_its_library_or_the_command_that_installs_it() {
    let scratch = Scratch::new("camera-doctor");
    let doctor: Value = serde_json::from_slice(&scratch.toile(&["doctor", "--json"]).stdout).unwrap();
    let checks = doctor["checks"].as_array().unwrap();
    for kind in CameraKind::ALL.into_iter().filter(|kind| !kind.libraries().is_empty()) {
        let check = checks.iter().find(|c| c["name"] == format!("camera {kind}")).unwrap_or_else(|| panic!("{kind}"));
        let cure = check["cure"].as_str();
        assert!(check["status"] == "ok" || cure.is_some_and(|cure| cure.contains(" install ")), "{check}");
    }
}

/// A kiosk before which a recording of so many images is played, until it has said enough; its report and its words.
#[cfg(unix)]
fn kiosk(scratch: &Scratch, library: &Path, images: usize, enough: impl FnMut(&str) -> bool) -> (Value, String) {
    let recording = scratch.path().join(format!("visit-{images}"));
    write_recording(&recording, images);
    let config = "[sensor]\ncamera = \"kinect\"\n[session]\nstep_out_s = 1.5\nwipe_s = 0.5\n[health]\nevery_s = 0.2\n\
                  [machine]\nlock_memory = false\n[wear]\nquality = \"draft\"\n";
    fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
    let mut command = Command::new(crate::PROGRAM);
    command.current_dir(scratch.path()).args(["kiosk", "--headless", "--seconds", "76", "--json"]);
    command.args(["--config", "kiosk.toml", "--instance", "camera-test"]);
    let output = run_until(kinect::play(&mut command, library, &recording), enough);
    let (report, words) = (report(&output), String::from_utf8(output.stderr).unwrap());
    println!("{words}\n{report:#}");
    (report, words)
}

/// The states that a kiosk went through.
#[cfg(unix)]
fn states_of(report: &Value) -> Vec<&str> {
    report["states"].as_array().unwrap().iter().map(|s| s.as_str().unwrap()).collect()
}

#[test]
#[cfg(unix)]
fn a_visit_at_the_kiosk_is_seen_by_a_camera_from_start_to_end() {
    let Some(library) = player() else { return };
    let _alone = alone();
    let scratch = Scratch::new("camera-kiosk");
    // Long enough to be measured and dressed beside compilers, too.
    let (kiosk_report, words) = kiosk(&scratch, &library, 1_350, |line| line.contains(", try-on, "));
    let states = states_of(&kiosk_report);
    // Beside compilers the person is out of sight for seconds now and then, and begins anew.
    assert!(states.starts_with(&["attract", "measuring"]) && states.contains(&"try-on"), "{states:?}");
    assert!(words.contains("camera seeing"), "{words}");
    assert_eq!(kiosk_report["nonfinite"], 0);
    assert!(kiosk_report["ready_ms"].as_f64().is_some(), "{}", kiosk_report["ready_ms"]);
    assert!(kiosk_report["camera"]["followed"].as_u64().unwrap() > 30, "{}", kiosk_report["camera"]);
    // A recording ends, and with it the camera: the visit ends, and the loss is told.
    let mut lost = false;
    let (kiosk_report, words) = kiosk(&scratch, &library, 90, |line| {
        lost |= line.contains("camera lost");
        lost && line.contains(", attract, ")
    });
    let states = states_of(&kiosk_report);
    assert!(states.starts_with(&["attract", "measuring"]) && states.ends_with(&["left", "attract"]), "{states:?}");
    assert!(words.contains("camera seeing"), "{words}");
}
