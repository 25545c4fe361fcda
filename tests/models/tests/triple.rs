//! The latest value between two threads: never torn, never older than what was seen before. With weaker orderings than the
//! crate has, the model finds the fault: it is able to.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering::{self, AcqRel, Acquire, Relaxed, Release};

use toile_models::triple::triple;

/// A writer publishes three times what has two halves, a reader looks twice.
fn explore(orders: [Ordering; 2]) {
    loom::model(move || {
        let (mut writer, mut reader) = triple(&[0u32; 2], orders);
        let writing = loom::thread::spawn(move || {
            for i in 1..=3 {
                writer.publish(|value| *value = [i; 2]);
            }
        });
        let mut last = 0;
        for _ in 0..2 {
            let (_, [a, b]) = reader.look(|value| *value);
            assert!(a == b && a >= last, "{a} {b} after {last}");
            last = a;
        }
        writing.join().unwrap();
        // All that was published before the join is seen.
        assert_eq!(reader.look(|value| *value).1, [3; 2]);
    });
}

#[test]
fn a_value_is_never_torn_and_never_goes_back() {
    explore([AcqRel, AcqRel]);
}

#[test]
fn each_ordering_is_needed() {
    // The writer's exchange releases what it wrote and acquires the reader's leaving of the place that it gets back; the
    // reader's does the same the other way round.
    for weak in [
        [Relaxed, AcqRel],
        [AcqRel, Relaxed],
        [Acquire, AcqRel],
        [Release, AcqRel],
        [AcqRel, Acquire],
        [AcqRel, Release],
    ] {
        let found = catch_unwind(AssertUnwindSafe(|| explore(weak))).is_err();
        assert!(found, "{weak:?} would do");
    }
}
