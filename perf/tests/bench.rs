//! `toile-perf bench` as a user or a script meets it: the built program, its streams and its exit codes.

use std::process::Output;

use serde_json::Value;

use crate::common::{Scratch, refusal, sentence, stdout};

fn toile(args: &[&str]) -> Output {
    Scratch::new(&args.join("-")).toile(args)
}

#[test]
fn help_and_version_name_the_program() {
    assert_eq!(stdout(&toile(&["--version"])), format!("toile-perf {}\n", env!("CARGO_PKG_VERSION")));
    let help = stdout(&toile(&["bench", "skirt", "--help"]));
    assert!(help.contains("Example: ") && !help.contains('\x1b'), "{help}");
    for line in [&["bench"][..], &["bench", "skinning", "--verts", "0"], &["bench", "skrt"]] {
        assert!(refusal(&toile(line), 2).contains("`toile-perf bench --help`"), "{line:?}");
    }
}

#[test]
fn bench_skinning_reports_time_and_error_together() {
    let output = toile(&["bench", "skinning", "--verts", "2000", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!(json["schema"], "toile.bench-skinning/1");
    assert_eq!(json["verts"], 2000);
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} is no number: {json}"));
    assert!(number("us") > 0.0 && number("yardstick_us") > 0.0);
    assert!((number("ns_per_vertex") - number("us") / 2.0).abs() < 1e-6);
    assert!((0.0..1e-6).contains(&number("max_error_m")), "{json}");
    assert!(json["machine"]["cpu"].is_string());

    let output = toile(&["bench", "skinning", "--verts", "500"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("500 vertices") && text.contains("ns a vertex") && !text.contains('\x1b'), "{text}");

    let output = toile(&["bench", "skinning", "--backend", "gpu", "--dual"]);
    assert_eq!(output.status.code(), Some(2), "what is reported anyway is no option");
    let output = toile(&["bench", "skinning", "--table"]);
    assert_eq!(output.status.code(), Some(2), "the table is one of graphics devices");
}

#[test]
fn bench_skirt_reports_time_and_error_of_the_same_steps() {
    let output = toile(&["bench", "skirt", "--verts", "256", "--runs", "2", "--steps", "30", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    let json: Value = serde_json::from_str(&stdout(&output)).expect("stdout is exactly one JSON object");
    assert_eq!(json["schema"], "toile.bench-skirt/1");
    let contract = [
        "/step_us/p50",
        "/step_us/p99",
        "/step_us/p999",
        "/step_us/max",
        "/strain/mean",
        "/strain/p99",
        "/strain/max",
        "/penetration_mm/max",
        "/penetration_mm/fraction",
        "/allocations_per_step",
        "/memory_bytes",
        "/yardstick_us",
        "/y_ratio",
        "/substeps",
        "/lanes",
        "/hem_winding_wrong",
        "/kinetic_energy_mj",
    ];
    for key in contract {
        assert!(json.pointer(key).is_some_and(Value::is_number), "{key}: {json}");
    }
    assert!(json["stages_us"].is_object() && json["state_hash"].as_str().unwrap().len() == 16);
    assert_eq!(json["allocations_per_step"], 0.0, "the built program counts its own allocations");
    assert!(json["memory_bytes"].as_u64().unwrap() > 256 * 12, "{json}");
    let ratio = json["step_us"]["p50"].as_f64().unwrap() / json["yardstick_us"].as_f64().unwrap();
    assert!((ratio - json["y_ratio"].as_f64().unwrap()).abs() < 1e-9);

    let output = toile(&["bench", "skirt", "--verts", "256", "--runs", "1", "--steps", "5", "--motion", "settled"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("256 vertices") && text.contains("strain") && !text.contains('\x1b'), "{text}");
}

#[test]
fn bench_skirt_refuses_what_is_no_grid() {
    let output = toile(&["bench", "skirt", "--verts", "1000"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(sentence(&output).contains("1000 vertices"));
}
