//! Programs in C: they are compiled without a warning, linked with both libraries, and run.
#![cfg(target_os = "linux")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use crate::coarse;

/// What a program is linked with beside the static library, as `rustc --print native-static-libs` says it.
const SYSTEM: [&str; 6] = ["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl"];
const WARNINGS: [&str; 5] = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];

#[derive(Clone, Copy, Debug)]
enum Linked {
    Static,
    Shared,
}

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where cargo has put the libraries that this test was built with.
fn libraries() -> PathBuf {
    let test = std::env::current_exe().expect("the test has a path");
    let libraries = test.parent().expect("the test lies in a folder").to_path_buf();
    for name in ["libtoile_c.so", "libtoile_c.a"] {
        assert!(libraries.join(name).exists(), "{name} does not lie beside the test");
    }
    libraries
}

fn done(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|e| panic!("{command:?} cannot be run: {e}"));
    let (out, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{out}\n{errors}", output.status);
    output
}

fn has(tool: &str) -> bool {
    Command::new(tool).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Compiles a program and links it.
fn compiled(source: &str, linked: Linked) -> PathBuf {
    let source = folder().join(source);
    let name = format!("{}-{linked:?}", source.file_stem().unwrap().to_string_lossy());
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let libraries = libraries();
    let mut cc = Command::new("cc");
    cc.args(WARNINGS)
        .args(["-O1", "-g", "-pthread", "-D_POSIX_C_SOURCE=200809L"])
        .arg("-I")
        .arg(folder().join("include"));
    cc.arg(&source).arg("-o").arg(&program);
    match linked {
        Linked::Static => cc.arg(libraries.join("libtoile_c.a")).args(SYSTEM),
        Linked::Shared => {
            // Under the name that stands in it, as ./install puts it.
            let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lib");
            std::fs::create_dir_all(&place).unwrap();
            let installed = place.join("libtoile.so.1");
            if !installed.exists() {
                _ = std::os::unix::fs::symlink(libraries.join("libtoile_c.so"), &installed);
            }
            cc.arg(&installed).arg(format!("-Wl,-rpath,{}", place.display())).arg("-lm")
        }
    };
    done(&mut cc);
    program
}

fn ran(program: &Path, arguments: &[&str]) -> String {
    let output = done(Command::new(program).args(arguments).current_dir(env!("CARGO_TARGET_TMPDIR")));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("programs write UTF-8")
}

/// The path of a T-shirt with a coarse mesh.
fn coarse_tee() -> &'static str {
    static TEE: OnceLock<String> = OnceLock::new();
    TEE.get_or_init(|| coarse::write(Path::new(env!("CARGO_TARGET_TMPDIR")), "tee").display().to_string())
}

#[test]
fn the_header_is_c_and_cpp() {
    let header = folder().join("include/toile.h");
    for standard in ["c99", "c11", "c17"] {
        let check = ["-x", "c", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];
        done(Command::new("cc").arg(format!("-std={standard}")).args(check).arg(&header));
    }
    if has("c++") {
        let check = ["-x", "c++", "-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];
        done(Command::new("c++").args(check).arg(&header));
    } else {
        println!("there is no c++ here: the header was not read as C++");
    }
}

#[test]
fn a_body_is_dressed_in_c_with_both_libraries() {
    let said = [Linked::Static, Linked::Shared]
        .map(|linked| ran(&compiled("examples/dressed.c", linked), &[coarse_tee(), "12"]));
    assert!(said[0].starts_with("size ") && said[0].contains("vertices"), "{}", said[0]);
    assert_eq!(said[0], said[1], "both libraries give the same bits");
    // The same in Rust.
    let mm = [("stature", 1720.0), ("chest", 920.0), ("waist", 760.0), ("hip", 1000.0)];
    let body = toile_sdk::Body::from_measures_mm(toile_sdk::Sex::Female, &mm).unwrap();
    let mut scene = toile_sdk::Scene::dress(&body, &[toile_sdk::Garment::open(coarse_tee()).unwrap()]).unwrap();
    scene.step_many(12);
    assert!(said[0].contains(&format!("state {:016x}", scene.state_hash())), "{}", said[0]);
}

#[test]
fn a_recording_is_tried_on_in_c() {
    let said = ran(&compiled("examples/recorded.c", Linked::Shared), &[]);
    assert!(said.contains("waist_girth: ") && said.contains("strap-dress in size "), "{said}");
    let picture = std::fs::read(Path::new(env!("CARGO_TARGET_TMPDIR")).join("recorded.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
}

#[test]
fn bad_input_is_refused_by_every_call() {
    // Measuring a person takes seconds: one library does it.
    for (linked, calls) in [(Linked::Static, "all"), (Linked::Shared, "few")] {
        let said = ran(&compiled("tests/c/bad_input.c", linked), &[calls, coarse_tee()]);
        assert!(said.contains("every call refuses what is wrong"), "{said}");
    }
}

#[test]
fn the_shared_library_shows_nothing_but_its_calls() {
    if !has("nm") || !has("readelf") {
        println!("there are no binutils here: the symbols were not read");
        return;
    }
    let library = libraries().join("libtoile_c.so");
    let listed = done(Command::new("nm").args(["-D", "--defined-only"]).arg(&library));
    let listed = String::from_utf8(listed.stdout).unwrap();
    let symbols: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().last()).collect();
    let header = std::fs::read_to_string(folder().join("include/toile.h")).unwrap();
    for symbol in &symbols {
        let declared = header.contains(&format!("{symbol}(")) || symbol.starts_with("rust_eh_personality");
        assert!(declared, "{symbol} is shown and stands in no header");
    }
    assert!(symbols.len() > 60, "{symbols:?}");
    let dynamic = done(Command::new("readelf").arg("-d").arg(&library));
    assert!(String::from_utf8(dynamic.stdout).unwrap().contains("soname: [libtoile.so.1]"));
}

/// In an optimised build: the calls of others are measured.
#[test]
fn a_call_costs_less_than_five_microseconds() {
    if cfg!(debug_assertions) {
        println!("a build without optimisation: nothing is measured");
        return;
    }
    print!("{}", ran(&compiled("tests/c/overhead.c", Linked::Shared), &[]));
}
