//! Choice of the renderer: `--renderer`, `--lines` and `--video` of the built program, with a GPU built in or without.

use std::process::Output;

use crate::common::Scratch;

fn stderr_of(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn lines_without_a_gpu_and_films_of_no_kind_are_refused() {
    let scratch = Scratch::new("look-refused");
    let lines = scratch.toile(&["try-on", "--lines", "tethers", "--out", "out"]);
    assert_eq!(lines.status.code(), Some(2), "{}", stderr_of(&lines));
    assert!(stderr_of(&lines).contains("--renderer gpu"), "{}", stderr_of(&lines));
    let bones = scratch.toile(&["try-on", "--lines", "bones"]);
    assert_eq!(bones.status.code(), Some(2), "{}", stderr_of(&bones));
    let film = scratch.toile(&["try-on", "--video", "film.gif", "--no-pictures", "--quiet"]);
    assert_eq!(film.status.code(), Some(4), "{}", stderr_of(&film));
    assert!(stderr_of(&film).contains(".webm") && !scratch.path().join("film.gif").exists(), "{}", stderr_of(&film));
}

#[test]
fn tones_and_hair_that_are_none_are_refused_with_the_nearest() {
    let scratch = Scratch::new("look-appearance");
    let lines: [&[&str]; 4] = [
        &["try-on", "--skin", "sandy"],
        &["tailor", "tee", "--skin", "sandy"],
        &["catalogue", "sheet", "shop", "--skin", "sandy"],
        &["body", "someone.glb", "--skin", "sandy"],
    ];
    for line in lines {
        let refused = scratch.toile(line);
        let said = stderr_of(&refused);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains("--skin") && said.contains("'sand'") && said.lines().count() == 1, "{said}");
    }
    let hair = scratch.toile(&["try-on", "--hair", "shrot"]);
    assert!(hair.status.code() == Some(2) && stderr_of(&hair).contains("'short'"), "{}", stderr_of(&hair));
    let own = scratch.toile(&["try-on", "--hair", "bob", "--body", "someone.glb"]);
    assert_eq!(own.status.code(), Some(2), "{}", stderr_of(&own));
    assert!(stderr_of(&own).contains("someone.glb keeps its own head"), "{}", stderr_of(&own));
}

#[cfg(not(feature = "view"))]
#[test]
fn a_gpu_that_was_not_built_in_is_told_with_the_cure() {
    let scratch = Scratch::new("look-without");
    let output = scratch.toile(&["try-on", "--renderer", "gpu", "--quiet"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr_of(&output));
    assert!(stderr_of(&output).contains("--features view"), "{}", stderr_of(&output));
    assert!(!scratch.path().join("out").exists(), "nothing is left behind");
}

#[cfg(feature = "view")]
mod built_in {
    use std::fs::File;
    use std::io::BufReader;
    use std::process::{Command, Stdio};

    use serde_json::Value;

    use super::*;

    /// Whether this machine has an adapter. Where there is none a test has nothing to say, but where everything has to
    /// be tested it fails.
    fn adapter() -> bool {
        let found = !toile_gpu::adapters().is_empty();
        let wanted = std::env::var("CI").is_ok_and(|v| v == "true");
        assert!(found || !wanted, "CI=true, but there is no graphics adapter");
        if !found {
            println!("nothing was drawn: there is no graphics adapter");
        }
        found
    }

    fn frames(path: &std::path::Path) -> (u32, u32, u32) {
        let reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
        let info = reader.info();
        (info.width, info.height, info.animation_control().map_or(1, |a| a.num_frames))
    }

    #[test]
    fn the_mirror_draws_a_whole_try_on_and_its_film() {
        if !adapter() {
            return;
        }
        let scratch = Scratch::new("look-gpu");
        let recorded = scratch.toile(&["record", "--out", "short.mcap", "--seconds", "2", "--quiet"]);
        assert_eq!(recorded.status.code(), Some(0), "{}", stderr_of(&recorded));
        let asked = ["try-on", "--session", "short.mcap", "--renderer", "gpu", "--lines", "colliders"];
        let output = scratch.toile(&[&asked[..], &["--video", "film.png", "--json"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr_of(&output));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(report["renderer"].as_str().unwrap().starts_with("gpu: "), "{}", report["renderer"]);
        let files = report["files"].as_array().unwrap();
        assert!(files.iter().any(|f| f == "film.png"), "{files:?}");
        let steps = report["physics"]["steps"].as_u64().unwrap();
        assert_eq!(frames(&scratch.path().join("film.png")), (540, 960, steps.div_ceil(4) as u32));
        let (width, height, _) = frames(&scratch.path().join("out/look.png"));
        assert!(width >= 3 * 480 && height >= 800);
        assert_eq!(frames(&scratch.path().join("out/session.png")).0, 240);
    }

    /// The Vulkan loader reads its drivers from this place alone.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_machine_without_an_adapter_is_told_with_the_cure() {
        let scratch = Scratch::new("look-none");
        let mut command = Command::new(crate::PROGRAM);
        command.args(["try-on", "--renderer", "gpu", "--quiet"]).current_dir(scratch.path()).stdin(Stdio::null());
        let none = scratch.path().join("none.json");
        let output = command.env("VK_DRIVER_FILES", &none).env("VK_ICD_FILENAMES", &none).output().unwrap();
        assert_eq!(output.status.code(), Some(5), "{}", stderr_of(&output));
        assert!(stderr_of(&output).contains("mesa-vulkan-drivers"), "{}", stderr_of(&output));
        assert!(!scratch.path().join("out").exists(), "nothing is left behind");
    }
}
