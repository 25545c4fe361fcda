//! A camera that fails: a thousand faults of every kind, in simulated time. Each that blinds it is noticed within a fifth of a second, and
//! after each it sees again within a second; no frame that comes out is old, half, the same again or from another day.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use glam::Affine3A;
use toile_base::clock::SECOND_NS;
use toile_base::numeric::random::SplitMix64;
use toile_sensors::source::live::fault_injection::{CameraFault, FaultPlan, FaultyCamera, SimulatedCamera, TimedFault};
use toile_sensors::source::live::{CameraCounts, CameraState, LiveDepth};

const MS: u64 = 1_000_000;

/// From the begin of one fault to that of the next (ns).
const APART_NS: u64 = 8 * SECOND_NS;

/// Between two looks (ns): so often the camera's thread looks.
const LOOK_NS: u64 = 10 * MS;

/// Longest until a blind camera is noticed, and until one that sees again is back (ns).
const NOTICED_NS: u64 = 200 * MS;
const BACK_NS: u64 = SECOND_NS;

/// So many faults, each kind in turn, each between half a second and three seconds long.
fn plan(faults: usize) -> FaultPlan {
    let mut rng = SplitMix64::new(3);
    let fault = |i: usize| {
        let from_ns = (i as u64 + 1) * APART_NS + (f64::from(rng.uniform()) * 1e9) as u64;
        let length = (f64::from(0.5 + 2.5 * rng.uniform()) * 1e9) as u64;
        let fault = CameraFault::ALL[i % CameraFault::ALL.len()];
        TimedFault { fault, from_ns, until_ns: from_ns + length }
    };
    FaultPlan { faults: (0..faults).map(fault).collect() }
}

/// Result of each kind: the longest time until it was noticed and until it was over (ns), and the fewest frames a second meanwhile.
#[derive(Debug, Clone, Copy)]
struct Outcome {
    noticed_ns: u64,
    back_ns: u64,
    faults: u64,
}

/// Runs the faults; gives the outcome of each kind, and the counts.
fn run(faults: usize) -> (BTreeMap<CameraFault, Outcome>, CameraCounts) {
    let plan = Arc::new(plan(faults));
    let now = Arc::new(AtomicU64::new(SECOND_NS));
    let clock = {
        let now = now.clone();
        Arc::new(move || now.load(Relaxed)) as Arc<dyn Fn() -> u64 + Send + Sync>
    };
    let opener = {
        let (plan, clock) = (plan.clone(), clock.clone());
        Box::new(move || {
            let camera = SimulatedCamera::new(clock.clone(), Affine3A::IDENTITY);
            Ok(Box::new(FaultyCamera::open(camera, plan.clone(), clock.clone())?) as Box<_>)
        })
    };
    let mut depth = LiveDepth::open(opener, 0, now.load(Relaxed)).unwrap();
    let mut outcomes: BTreeMap<CameraFault, Outcome> = BTreeMap::new();
    let (mut last_stamp, mut at) = (0, 0);
    let (mut noticed, mut back) = (None, None);
    let end = (faults as u64 + 2) * APART_NS;
    while now.load(Relaxed) < end {
        let update = depth.poll(&*clock, Duration::ZERO);
        let time = now.load(Relaxed);
        if let Some(frame) = &update.frame {
            assert!(
                frame.time_ns > last_stamp && frame.time_ns <= time,
                "{} after {last_stamp} at {time}",
                frame.time_ns
            );
            assert!(time - frame.time_ns < 150 * MS, "{} old at {time}", time - frame.time_ns);
            last_stamp = frame.time_ns;
        }
        if let Some(fault) = plan.faults.get(at) {
            let sees = update.state == CameraState::Seeing;
            if (fault.from_ns..fault.until_ns).contains(&time) && !sees {
                noticed.get_or_insert(time - fault.from_ns);
            }
            if time >= fault.until_ns && sees && update.frame.is_some() {
                back.get_or_insert(time - fault.until_ns);
            }
            if time >= fault.from_ns + APART_NS - 2 * SECOND_NS {
                let entry = outcomes.entry(fault.fault).or_insert(Outcome { noticed_ns: 0, back_ns: 0, faults: 0 });
                if fault.fault.is_blind() {
                    entry.noticed_ns = entry.noticed_ns.max(noticed.unwrap_or(u64::MAX));
                }
                entry.back_ns = entry.back_ns.max(back.unwrap_or(u64::MAX));
                entry.faults += 1;
                (noticed, back, at) = (None, None, at + 1);
            }
        }
        now.fetch_add(LOOK_NS, Relaxed);
    }
    (outcomes, depth.counts())
}

#[test]
fn a_thousand_faults_are_noticed_and_all_are_recovered() {
    let (outcomes, counts) = run(1_000);
    println!("| fault | times | noticed after at most | sees again after at most |");
    for (fault, outcome) in &outcomes {
        let noticed = if fault.is_blind() { format!("{} ms", outcome.noticed_ns / MS) } else { "-".into() };
        println!("| {fault} | {} | {noticed} | {} ms |", outcome.faults, outcome.back_ns / MS);
    }
    println!("{counts:?}");
    assert_eq!(outcomes.values().map(|o| o.faults).sum::<u64>(), 1_000);
    assert_eq!(outcomes.len(), CameraFault::ALL.len());
    for (fault, outcome) in &outcomes {
        assert!(outcome.noticed_ns <= NOTICED_NS, "{fault}: noticed after {} ms", outcome.noticed_ns / MS);
        assert!(outcome.back_ns <= BACK_NS, "{fault}: back after {} ms", outcome.back_ns / MS);
    }
    assert!(
        counts.half > 0 && counts.repeated > 0 && counts.empty > 0 && counts.clock_jumps > 0 && counts.reopened > 0
    );
}

#[test]
fn the_same_faults_end_in_the_same_counts() {
    assert_eq!(run(27).1, run(27).1);
}
