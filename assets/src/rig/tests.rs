//! The collision body against brute force and against its own promises.

use super::*;
use crate::body::{Measures, Sex};

#[test]
fn fits_the_average_bodies() {
    for sex in [Sex::Female, Sex::Male] {
        let body = Body::build(sex, &Measures::average(sex)).unwrap();
        let start = std::time::Instant::now();
        let rig = Rig::fit(&body);
        eprintln!("{:?} {:?}", start.elapsed(), rig.report);
    }
}
