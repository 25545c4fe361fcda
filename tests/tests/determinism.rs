//! The same input gives the same bits, on any thread; another input gives others.

use std::thread;

use toile_base::clock::ticks_to_ns;
use toile_base::frame::Joints;
use toile_engine::cloth::ContactRates;
use toile_engine::workers::WorkerPool;
use toile_engine::world::World;
use toile_sensors::sample::sample;
use toile_workspace::dressed;

/// Two seconds of the scene, in which the arms rise and the walk begins.
const STEPS: u64 = 240;

fn play(names: &[&str], track: &[Joints], workers: usize) -> World {
    let pool = WorkerPool::new(workers).expect("a pool of one or two");
    let mut world = dressed::dressed(names, track).with_workers(pool);
    let start = track[0].time_ns;
    for tick in 0..STEPS {
        world.step(&sample(track, start + ticks_to_ns(tick)).expect("a track with frames"));
    }
    world
}

#[test]
fn one_worker_and_two_end_in_the_same_bits_and_another_input_in_others() {
    let track = dressed::track(&dressed::shopper(), 1.8, 2.1);
    let mut other = track.clone();
    // One joint, one sensor frame, one millimetre.
    other[20].joints[6].position.y += 1e-3;

    let names: &[&str] = &["strap-dress"];
    let (first, second, third) = thread::scope(|scope| {
        let runs =
            [(&track, 1), (&track, 2), (&other, 1)].map(|(t, workers)| scope.spawn(move || play(names, t, workers)));
        let [a, b, c] = runs.map(|run| run.join().expect("a run that ends"));
        (a, b, c)
    });
    assert!(dressed::is_finite(&first));
    assert_eq!(first.state_hash(), second.state_hash());
    assert_eq!(first.pose(), second.pose());
    assert!(first.cloths()[0].positions == second.cloths()[0].positions, "equal hashes of unequal states");
    assert_ne!(first.state_hash(), third.state_hash(), "a joint that moved by a millimetre leaves no trace");
}

#[test]
fn three_layers_end_in_the_same_bits_by_one_worker_and_two() {
    let track = dressed::track(&dressed::shopper(), 1.8, 2.1);
    let names: &[&str] = &["straight-trousers", "shirt", "blazer"];
    let [first, second] = thread::scope(|scope| {
        let track = &track;
        let runs = [1, 2].map(|workers| scope.spawn(move || play(names, track, workers)));
        runs.map(|run| run.join().expect("a run that ends"))
    });
    assert!(dressed::is_finite(&first));
    assert_eq!(first.state_hash(), second.state_hash());
}

/// Two seconds in which contact is given up and taken back, as quality control does, measured every so many steps.
fn measured_every(steps: u64, track: &[Joints]) -> World {
    let mut world = dressed::dressed(&["strap-dress"], track);
    world.measure_every(steps);
    let start = track[0].time_ns;
    for tick in 0..STEPS {
        let part = (tick / 20 % 6) as usize;
        let rates = |kind: [u8; 6]| kind[part];
        world.set_contact(ContactRates {
            folds: rates([1, 2, 4, 0, 2, 0]),
            layers: rates([1, 1, 2, 0, 2, 0]),
            skin: rates([1, 2, 1, 0, 4, 1]),
        });
        world.step(&sample(track, start + ticks_to_ns(tick)).expect("a track with frames"));
    }
    world
}

/// A loop that is late measures at other steps than its replay.
#[test]
fn measuring_leaves_no_trace_in_the_state() {
    let track = dressed::track(&dressed::shopper(), 1.8, 2.1);
    let [never, often] = thread::scope(|scope| {
        let runs = [0, 3].map(|steps| {
            scope.spawn({
                let track = &track;
                move || measured_every(steps, track)
            })
        });
        runs.map(|run| run.join().expect("a run that ends"))
    });
    assert!(dressed::is_finite(&never));
    assert_eq!(never.state_hash(), often.state_hash());
}
