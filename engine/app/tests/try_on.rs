//! A whole try-on through the built program: the JSON, the files, and the same bits twice.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::thread;

use crate::common::{Scratch, object};
use serde_json::Value;

/// Every key that the contract names for `try-on`.
const KEYS: [&str; 24] = [
    "/version",
    "/machine/cpu",
    "/machine/cores",
    "/machine/lanes",
    "/machine/adapter",
    "/measurements/stature_mm/sigma",
    "/measurements/shoulder_breadth_mm/value",
    "/measurements/chest_girth_mm/value",
    "/measurements/waist_girth_mm/value",
    "/measurements/hip_girth_mm/sigma",
    "/recommendation/garment",
    "/recommendation/size",
    "/recommendation/zones/0/zone",
    "/recommendation/zones/0/ease_mm",
    "/recommendation/zones/0/sigma_mm",
    "/recommendation/zones/0/verdict",
    "/physics/step_us/p50",
    "/physics/step_us/p999",
    "/physics/strain/mean",
    "/physics/strain/p99",
    "/physics/strain/max",
    "/physics/penetration_mm/max",
    "/physics/warnings",
    "/files/0",
];

/// What is so whatever the machine: the contract, and what the embedded shopper measures.
fn is_whole(report: &Value) {
    assert_eq!(report["schema"], "toile.try-on/1");
    for key in KEYS {
        assert!(report.pointer(key).is_some(), "{key} is missing");
    }
    assert_eq!(report["physics"]["hz"], 120);
    assert_eq!(report["physics"]["nonfinite"], 0);
    assert!(report["physics"]["steps"].as_u64().unwrap() > 1_000, "ten seconds at 120 Hz");
    let hash = report["state_hash"].as_str().unwrap();
    assert!(hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    // The scene's shopper is 1,694 mm high; three sigmas of what the sensor says must hold her.
    let stature = &report["measurements"]["stature_mm"];
    let (value, sigma) = (stature["value"].as_f64().unwrap(), stature["sigma"].as_f64().unwrap());
    assert!((value - 1_694.0).abs() < 3.0 * sigma.max(5.0) && sigma < 60.0, "{stature}");
}

/// Decodes every frame of a PNG; gives its size, its number of frames and how many grey levels its first frame has.
fn decode(path: &Path) -> ([u32; 2], u32, usize) {
    let file = BufReader::new(File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())));
    let mut reader = png::Decoder::new(file).read_info().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let frames = reader.info().animation_control().map_or(1, |a| a.num_frames);
    let size = [reader.info().width, reader.info().height];
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size that fits")];
    let mut levels = 0;
    for frame in 0..frames {
        reader.next_frame(&mut pixels).unwrap_or_else(|e| panic!("{}, frame {frame}: {e}", path.display()));
        if frame == 0 {
            let mut seen = [false; 256];
            pixels.iter().for_each(|p| seen[usize::from(*p)] = true);
            levels = seen.iter().filter(|s| **s).count();
        }
    }
    (size, frames, levels)
}

/// Two runs beside each other, of which only the first draws.
#[test]
fn a_run_leaves_its_pictures_and_a_second_has_the_same_bits() {
    let scratch = Scratch::new("pictures");
    let (output, second) = thread::scope(|scope| {
        let plain = scope.spawn(|| object(&scratch.toile(&["try-on", "--no-pictures", "--json", "--out", "plain"])));
        (scratch.toile(&["try-on", "--json", "--out", "out"]), plain.join().expect("a run that ends"))
    });
    let report = object(&output);
    is_whole(&report);
    for key in ["state_hash", "measurements", "recommendation"] {
        assert_eq!(report[key], second[key], "{key}");
    }
    assert_eq!(report["physics"]["strain"], second["physics"]["strain"]);
    let plain: Vec<_> = fs::read_dir(scratch.path().join("plain")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(plain, ["report.json"], "no picture was asked for, and no part is left");
    assert_eq!(second["files"].as_array().unwrap().len(), 1);
    let out = scratch.path().join("out");
    assert_eq!(fs::read(out.join("report.json")).unwrap(), output.stdout, "the report is what was printed");

    let promised: Vec<_> = report["files"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    let mut left: Vec<_> = fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    left.sort();
    let mut names: Vec<_> = promised.iter().map(|f| f.rsplit('/').next().unwrap().to_owned()).collect();
    names.sort();
    assert_eq!(left, names, "exactly the promised files");
    for name in ["session.png", "contact-sheet.png", "look.png", "fit.png", "report.json"] {
        assert!(names.iter().any(|n| n == name), "{name} is missing in {names:?}");
    }
    let crossed = report["crossings"]["frames_with"] != 0;
    assert_eq!(names.iter().any(|n| n == "worst.png"), crossed, "{}", report["crossings"]);
    assert_eq!(report["crossings"]["worst_s"].is_number(), crossed);

    let (size, frames, levels) = decode(&out.join("session.png"));
    assert_eq!(size, [240, 360]);
    assert!((40..=100).contains(&frames), "{frames} frames of animation");
    assert!(levels > 64, "the animation shows nothing: {levels} levels");
    // Front, side and back of 480 x 800 side by side, words above or below them.
    for name in ["look.png", "fit.png"] {
        let ([width, height], frames, levels) = decode(&out.join(name));
        assert!(width >= 3 * 480 && (800..1200).contains(&height), "{name}: {width} x {height}");
        assert_eq!(frames, 1);
        assert!(levels > 64, "{name} shows nothing: {levels} levels");
    }
    // Twelve moments in two rows of six.
    let ([width, height], _, levels) = decode(&out.join("contact-sheet.png"));
    assert!(width >= 6 * 240 && height >= 2 * 360, "the contact sheet is {width} x {height}");
    assert!(levels > 64, "the contact sheet shows nothing: {levels} levels");
}
