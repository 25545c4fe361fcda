//! `toile latency` and `toile replay` as a user and a script meet them: short runs on whatever machine this is.

use std::fs;

use crate::coarse;
use crate::common::Scratch;
use serde_json::Value;
use toile_base::clock::SECOND_NS;
use toile_fitting::dress::session;
use toile_sensors::session::write;

/// What is run: the shopper's joints of two seconds, by which she is measured at once, and a dress that is soon draped.
const RUN: [&str; 5] = ["latency", "--session", "joints.mcap", "--garment", "strap-dress.json"];

/// A folder with both.
fn prepared(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let embedded = session::open(None, None).unwrap();
    let joints = embedded.joints.into_iter().filter(|frame| frame.time_ns < 2 * SECOND_NS).collect();
    write(&scratch.path().join("joints.mcap"), &session::of_joints(joints)).unwrap();
    coarse::write(scratch.path(), "strap-dress");
    scratch
}

fn object(scratch: &Scratch, args: &[&str]) -> (Option<i32>, Value) {
    let output = scratch.toile(args);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    let object = serde_json::from_slice(&output.stdout);
    (output.status.code(), object.unwrap_or_else(|e| panic!("stdout is not one JSON object ({e}): {words}")))
}

#[test]
fn a_run_is_told_by_stage_and_replayed_bit_for_bit_with_two_workers_and_with_one() {
    let scratch = prepared("latency");
    let more = ["--seconds", "1", "--record", "run.tape", "--load", "1", "--json"];
    let (code, found) = object(&scratch, &[&RUN[..], &more].concat());
    assert_eq!(code, Some(0), "missed goals fail only with --gate");
    assert_eq!(found["schema"], "toile.latency/1");
    for stage in ["filter", "intake", "pose", "skin", "place", "cloth", "publish", "picture", "total", "empty loop"] {
        let us = &found["stages_us"][stage];
        let [p50, p99, max] = ["p50", "p99", "max"].map(|q| us[q].as_f64().unwrap_or_else(|| panic!("{stage}: {us}")));
        assert!(p50 <= p99 && p99 <= max && us["count"].as_u64().unwrap() > 0, "{stage}: {us}");
    }
    let whole = |key: &str| found[key].as_u64().unwrap();
    // Whatever the machine did meanwhile, every step of the second was taken or counted as dropped.
    assert!((110..=130).contains(&(whole("steps") + whole("dropped"))), "{found}");
    let causes: u64 = found["attributed"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
    assert_eq!(causes, whole("deadline_misses"), "every miss has its cause");
    assert_eq!(found["quality"]["nonfinite"], 0);
    assert!(found["quality"]["strain"][0].as_f64().unwrap() > 0.0, "a time without its error");
    let threads: Vec<&str> =
        found["threads"].as_array().unwrap().iter().map(|t| t["thread"].as_str().unwrap()).collect();
    assert!(["sensor", "physics", "render"].iter().all(|t| threads.contains(t)));
    let capacities = found["capacities"].as_array().unwrap();
    for (name, least) in [("EVENTS", 0), ("MAX_CAPSULES", 1), ("MAX_SUBSTEPS", 1), ("pairs", 1), ("MOST_CATCH_UP", 0)] {
        let row = capacities.iter().find(|c| c["constant"].as_str().unwrap().starts_with(name));
        let row = row.unwrap_or_else(|| panic!("no {name} in {capacities:?}"));
        let [used, bound] = ["high_water", "bound"].map(|k| row[k].as_u64().unwrap());
        assert!((least..=bound).contains(&used), "{row}");
    }
    let record = fs::read(scratch.path().join("out/latency/latency.json")).unwrap();
    let record: Value = serde_json::from_slice(&record).unwrap();
    assert_eq!((&record["schema"], &record["state_hash"]), (&found["schema"], &found["state_hash"]));

    for workers in ["2", "1"] {
        let (code, again) = object(&scratch, &["replay", "run.tape", "--workers", workers, "--json"]);
        assert_eq!(code, Some(0), "{workers} workers: {again}");
        assert_eq!(again["diverged_at"], Value::Null);
        assert_eq!(again["state_hash"], found["state_hash"], "{workers} workers");
    }
    diverges(&scratch);
    damaged(&scratch);
}

/// One joint in one frame, half a millimetre: the replay says so with exit 6 and the step.
fn diverges(scratch: &Scratch) {
    use toile_engine::frame_loop::recording::{self, Entry, LoopRecording};
    let LoopRecording { text, mut entries, .. } =
        recording::read(&fs::read(scratch.path().join("run.tape")).unwrap()).unwrap();
    let frame = entries.iter().position(|e| matches!(e, Entry::SensorFrame(seen) if seen.number == 20)).unwrap();
    let Entry::SensorFrame(seen) = &mut entries[frame] else { unreachable!() };
    seen.joints.joints[0].position.y += 5e-4;
    seen.joints.joints[17].position.x += 5e-4;
    let Some(Entry::Step { tick: next, .. }) = entries[frame..].iter().find(|e| matches!(e, Entry::Step { .. })) else {
        panic!("no step after a frame")
    };
    let mut bytes = recording::header(&text);
    entries.iter().for_each(|e| recording::write(e, &mut bytes));
    fs::write(scratch.path().join("other.tape"), bytes).unwrap();
    let (code, again) = object(scratch, &["replay", "other.tape", "--json"]);
    let tick = again["diverged_at"].as_u64().unwrap();
    assert_eq!(code, Some(6));
    assert!((*next..next + 4).contains(&tick), "step {tick} after {next}");
}

fn damaged(scratch: &Scratch) {
    let bytes = fs::read(scratch.path().join("run.tape")).unwrap();
    let mut bad = bytes.clone();
    let middle = bad.len() / 2;
    bad[middle] ^= 0x10;
    for (name, bytes) in [("bad.tape", bad), ("short.tape", bytes[..40].to_vec()), ("no.tape", b"no".to_vec())] {
        fs::write(scratch.path().join(name), bytes).unwrap();
        let output = scratch.toile(&["replay", name]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(4), "{name}: {message}");
        assert!(message.contains(name) && message.lines().count() == 1, "{message}");
    }
}

#[test]
fn a_crash_leaves_a_recording_that_replays() {
    let scratch = prepared("latency-crash");
    let output = scratch.toile(&[&RUN[..], &["--seconds", "2", "--crash-after", "2"]].concat());
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(70), "{message}");
    assert!(message.contains("toile replay out/latency/crash.tape"), "{message}");
    let (code, again) = object(&scratch, &["replay", "out/latency/crash.tape", "--workers", "1", "--json"]);
    assert_eq!((code, &again["diverged_at"]), (Some(0), &Value::Null));
    assert!(again["ticks"].as_u64().unwrap() >= 120, "{again}");
}
