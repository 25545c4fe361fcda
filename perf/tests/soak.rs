//! `toile soak`: hours in seconds, everything that can go wrong, a crash and what it leaves.

use std::collections::BTreeSet;
use std::fs;

use crate::common::Scratch;
use serde_json::Value;

fn object(scratch: &Scratch, args: &[&str]) -> (Option<i32>, Value) {
    let output = scratch.toile(args);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{args:?}: {e}; {message}"));
    (output.status.code(), value)
}

#[test]
fn every_kind_of_fault_is_borne_and_a_second_run_is_the_same() {
    let scratch = Scratch::new("soak");
    let (code, found) = object(&scratch, &["soak", "--minutes", "2", "--seed", "1", "--faults", "20", "--json"]);
    assert_eq!(found["schema"], "toile.soak/1");
    let checks = found["checks"].as_array().unwrap();
    let failed: Vec<&Value> = checks.iter().filter(|c| c["pass"] != true).collect();
    assert_eq!((code, failed), (Some(0), vec![]));
    // Memory over two minutes says nothing of an hour.
    let unchecked: Vec<&str> =
        checks.iter().filter(|c| c["found"].is_null()).map(|c| c["name"].as_str().unwrap()).collect();
    let memory =
        ["memory handed out", "resident memory"].map(|what| format!("{what}, growth behind the warm-up (KiB)"));
    assert!(cfg!(not(target_os = "linux")) || unchecked == memory, "{unchecked:?}");
    let kinds = found["faults"]["kinds"].as_array().unwrap();
    assert_eq!(kinds.len(), 20, "{kinds:?}");
    assert!(kinds.iter().all(|k| k["injected"] == 1 && k["recovered"] == 1), "{kinds:?}");
    assert!(found["recovery_ticks"]["max"].as_u64().unwrap() <= 120 && found["recovery_ticks"]["max"] != 0);
    assert_eq!((&found["nonfinite"], &found["allocations"]), (&Value::from(0), &Value::from(0)));
    assert_eq!(found["state_hash"], found["second_state_hash"]);
    // Stalls and jumps took some of the 14,400 steps.
    let whole = |key: &str| found[key].as_u64().unwrap();
    assert!(
        (13_000..14_400).contains(&whole("ticks")) && whole("ticks") + whole("deadline_misses") >= 14_390,
        "{found}"
    );
    assert!(whole("changes") >= 2 && found["pictures"][1] == 1 && found["off_mm"].as_f64().unwrap() < 80.0);
    let record: Value = serde_json::from_slice(&fs::read(scratch.path().join("out/soak/soak.json")).unwrap()).unwrap();
    assert_eq!(record["state_hash"], found["state_hash"]);
}

#[test]
fn an_uptime_of_years_changes_no_bit_and_another_seed_all_of_them() {
    let scratch = Scratch::new("uptime");
    let mut hashes = BTreeSet::new();
    for more in [&["--uptime-hours", "0"], &["--uptime-hours", "1200"], &["--uptime-hours", "9936"], &["--seed", "2"]] {
        let line = [&["soak", "--minutes", "0.3", "--faults", "3", "--once", "--json"], &more[..]].concat();
        let (_, found) = object(&scratch, &line);
        assert_eq!(found["second_state_hash"], Value::Null);
        hashes.insert(found["state_hash"].as_str().unwrap().to_owned());
    }
    assert_eq!(hashes.len(), 2);
}

#[test]
fn a_recorded_run_is_replayed_with_one_worker_as_with_two() {
    let scratch = Scratch::new("soak-replay");
    // With this seed the shopper changes after 25 seconds.
    let line =
        ["soak", "--minutes", "0.5", "--seed", "50", "--faults", "5", "--once", "--record", "run.tape", "--json"];
    let (_, found) = object(&scratch, &line);
    assert!(found["changes"].as_u64().unwrap() >= 1, "garments were changed: {found}");
    let again = ["1", "2"].map(|workers| {
        let (code, again) = object(&scratch, &["replay", "run.tape", "--workers", workers, "--json"]);
        assert_eq!((code, &again["diverged_at"]), (Some(0), &Value::Null), "{workers} workers");
        assert_eq!(again["ticks"], found["ticks"]);
        again["state_hash"].clone()
    });
    assert_eq!(again[0], again[1]);
}

#[test]
fn a_crash_leaves_its_last_ten_seconds_and_they_replay() {
    let scratch = Scratch::new("soak-crash");
    let output = scratch.toile(&["soak", "--minutes", "1", "--crash-after", "15", "--once"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(70), "{message}");
    assert!(message.contains("toile replay out/soak/crash.tape"), "{message}");
    let (code, again) = object(&scratch, &["replay", "out/soak/crash.tape", "--json"]);
    assert_eq!((code, &again["diverged_at"]), (Some(0), &Value::Null));
    assert!(again["ticks"].as_u64().unwrap() >= 10 * 120, "{again}");
    // A recording has no picture in it: some 15 kB a second.
    let bytes = fs::metadata(scratch.path().join("out/soak/crash.tape")).unwrap().len();
    assert!(bytes < again["ticks"].as_u64().unwrap() * 300, "{bytes} bytes");
}
