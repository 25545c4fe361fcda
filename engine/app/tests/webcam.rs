//! A webcam as a user meets it: refused with the command that fetches its network, or seen through files that play in its place.
//!
//! The network's files are no part of the repository: where they are not fetched, the tests that need them say so and do not run.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::common::Scratch;
#[cfg(unix)]
use crate::common::{alone, run_until};
use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use serde_json::Value;
use toile_base::numeric::random::SplitMix64;
use toile_pose::files::{self, NetworkPackage};

/// The program with the network of a folder.
fn program(scratch: &Scratch, network: &Path) -> Command {
    let mut command = Command::new(crate::PROGRAM);
    command.stdin(Stdio::null()).current_dir(scratch.path()).env("XDG_RUNTIME_DIR", scratch.path());
    command.env(files::FOLDER_VARIABLE, network);
    command
}

fn run(scratch: &Scratch, network: &Path, args: &[&str]) -> Output {
    program(scratch, network).args(args).output().unwrap()
}

/// Whether the network is there. Where continuous integration names a folder, it must be.
fn is_fetched() -> bool {
    let found = files::check(&files::folder());
    let Err(error) = &found else { return true };
    assert!(std::env::var_os(files::FOLDER_VARIABLE).is_none(), "{error}");
    eprintln!("skipped, did not run: {error}");
    false
}

/// A folder of pictures of a person who stands, each with noise of its own; every tenth is cut short.
fn write_pictures(folder: &Path, count: usize) {
    fs::create_dir_all(folder).unwrap();
    let person = image::load_from_memory(include_bytes!("../../../engine/pose/tests/data/standing.png")).unwrap();
    let person = imageops::resize(&person.to_rgb8(), 275, 440, FilterType::Triangle);
    let mut random = SplitMix64::new(3);
    for i in 0..count {
        let mut picture = RgbImage::from_pixel(640, 480, Rgb([184, 183, 180]));
        imageops::overlay(&mut picture, &person, 180 + i as i64, 20);
        picture.pixels_mut().for_each(|p| p.0.iter_mut().for_each(|v| *v = v.wrapping_add(random.below(3) as u8)));
        let file = folder.join(format!("{i:03}.jpg"));
        picture.save(&file).unwrap();
        if i % 10 == 9 {
            let bytes = fs::read(&file).unwrap();
            fs::write(&file, &bytes[..bytes.len() / 2]).unwrap();
        }
    }
}

#[test]
fn without_the_network_a_webcam_is_refused_with_the_command_that_fetches_it() {
    let scratch = Scratch::new("webcam-refused");
    let refused = run(&scratch, scratch.path(), &["live", "--camera", "webcam"]);
    let words = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(5), "{words}");
    assert!(words.contains(files::FETCH) && words.lines().count() == 1, "{words}");
    let doctor = run(&scratch, scratch.path(), &["doctor", "--json"]);
    let doctor: Value = serde_json::from_slice(&doctor.stdout).unwrap();
    for package in NetworkPackage::ALL {
        let check = doctor["checks"].as_array().unwrap().iter().find(|c| c["name"] == package.name()).unwrap();
        assert_eq!(check["cure"], format!("`{}`", package.fetch()), "{check}");
    }
}

#[test]
fn a_session_is_not_recorded_by_a_webcam() {
    let scratch = Scratch::new("webcam-record");
    let args = ["record", "--camera", "webcam", "--seconds", "1", "--out", "a.mcap", "--consent"];
    let refused = run(&scratch, scratch.path(), &args);
    let words = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(4), "{words}");
    assert!(words.contains("a session holds depth, and webcam gives none"), "{words}");
}

#[test]
fn a_person_in_a_folder_of_pictures_is_followed() {
    if !is_fetched() {
        return;
    }
    let scratch = Scratch::new("webcam-live");
    write_pictures(&scratch.path().join("pictures"), 60);
    let args = ["live", "--camera", "webcam-file:pictures", "--seconds", "4", "--out", "look", "--json", "--quiet"];
    let output = run(&scratch, &files::folder(), &args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let live: Value = serde_json::from_slice(&output.stdout).unwrap();
    println!("{live:#}");
    assert_eq!((&live["size"][0], &live["people"], &live["state"]), (&640.into(), &1.into(), &"seeing".into()));
    let rate = |what: &str| live["rates_hz"][what].as_f64().unwrap();
    // How fast is the machine's affair.
    assert!(rate("joints") > 0.0 && rate("colour") > 0.0 && rate("depth") == 0.0, "{live}");
    assert!(live["unusable"][0].as_u64().unwrap() > 0, "one picture in ten is cut short: {live}");
    assert!(live["notes"][0].as_str().unwrap().contains("1.70 m (assumed); say it"), "{live}");
    assert!(scratch.path().join("look/colour.png").is_file() && !scratch.path().join("look/depth.png").exists());
}

#[test]
#[cfg(unix)]
fn a_visit_at_the_kiosk_is_seen_by_a_webcam() {
    if !is_fetched() {
        return;
    }
    let _alone = alone();
    let scratch = Scratch::new("webcam-kiosk");
    write_pictures(&scratch.path().join("pictures"), 60);
    let config = "[sensor]\ncamera = \"webcam-file\"\ndevice = \"pictures\"\n[shopper]\nmeasures = [\"stature=1680\"]\n\
                  [health]\nevery_s = 0.5\n[machine]\nlock_memory = false\n[wear]\nquality = \"draft\"\n";
    fs::write(scratch.path().join("kiosk.toml"), config).unwrap();
    let args = ["kiosk", "--headless", "--seconds", "120", "--config", "kiosk.toml", "--instance", "webcam", "--json"];
    let mut dressed = 0;
    let output = run_until(program(&scratch, &files::folder()).args(args), |line| {
        dressed += usize::from(line.contains(", try-on, "));
        dressed >= 3
    });
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    println!("{report:#}");
    let states: Vec<&str> = report["states"].as_array().unwrap().iter().map(|s| s.as_str().unwrap()).collect();
    // Beside compilers the person is out of sight for seconds now and then, and begins anew.
    assert!(states.starts_with(&["attract", "measuring"]) && states.contains(&"try-on"), "{states:?}");
    assert_eq!(report["nonfinite"], 0);
    assert!(report["camera"]["followed"].as_u64().unwrap() > 30, "{}", report["camera"]);
}
