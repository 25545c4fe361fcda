//! The bounded queue between two threads, and the hand-over of scenes through two such queues of one place. With weaker
//! orderings than the crate has, the model finds the fault.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};

use toile_models::ring::{Orders, ring};

const ORDERS: Orders = Orders { sent: Release, look: Acquire, taken: Release, free: Acquire };

/// Three entries through a queue of two places, so that one place is used twice.
fn explore(orders: Orders) {
    loom::model(move || {
        let (mut sender, mut receiver) = ring(2, orders);
        let sending = loom::thread::spawn(move || (1..=3).map(|i| sender.push([i; 2]).is_ok()).collect::<Vec<_>>());
        let mut popped: Vec<[u32; 2]> = (0..2).filter_map(|_| receiver.pop()).collect();
        let fitted = sending.join().unwrap();
        popped.extend(std::iter::from_fn(|| receiver.pop()));
        let sent = (1..=3).zip(fitted).filter(|(_, fits)| *fits).map(|(i, _)| [i; 2]);
        assert_eq!(popped, sent.collect::<Vec<_>>(), "each entry that fitted comes once, whole and in order");
    });
}

#[test]
fn entries_come_once_whole_and_in_order() {
    explore(ORDERS);
}

#[test]
fn each_ordering_of_the_queue_is_needed() {
    for weak in [
        Orders { sent: Relaxed, ..ORDERS },
        Orders { look: Relaxed, ..ORDERS },
        Orders { taken: Relaxed, ..ORDERS },
        Orders { free: Relaxed, ..ORDERS },
    ] {
        let found = catch_unwind(AssertUnwindSafe(|| explore(weak))).is_err();
        assert!(found, "{weak:?} would do");
    }
}

/// The protocol of `handover.rs`: scenes go one way, what they replaced comes back the other way, and the loop takes a scene only
/// while there is space for what goes back.
#[test]
fn no_scene_is_lost_in_a_hand_over() {
    loom::model(|| {
        let (mut to, mut from) = ring(1, ORDERS);
        let (mut back, mut returned) = ring(1, ORDERS);
        let stepping = loom::thread::spawn(move || {
            let mut here = 0;
            for _ in 0..2 {
                if back.is_full() {
                    continue;
                }
                let Some(mut scene) = from.pop() else { continue };
                std::mem::swap(&mut scene, &mut here);
                back.push(scene).expect("the loop is the only one that fills the way back");
            }
            (here, from)
        });
        let mut given: Vec<u32> = (1..=2).filter(|scene| to.push(*scene).is_ok()).collect();
        let mut seen: Vec<u32> = std::iter::from_fn(|| returned.pop()).collect();
        let (here, mut from) = stepping.join().unwrap();
        seen.extend(std::iter::from_fn(|| returned.pop()));
        seen.extend(from.pop());
        seen.push(here);
        seen.sort_unstable();
        given.insert(0, 0);
        assert_eq!(seen, given, "each scene is stepped, waiting or back");
    });
}
