//! The embedded session is the one that `toile record` makes, and its facts about the shopper are those of the scene.

use toile::commands::record;
use toile_assets::scene;
use toile_fitting::dress::measured::{self, ShopperFacts};
use toile_fitting::dress::session;

/// Frames that are made again: the second in which the shopper is measured.
const FRAMES: u64 = 30;

/// Seed that `toile record` takes where none is given.
const SEED: u64 = 1;

#[test]
fn the_embedded_session_can_be_made_again() {
    let embedded = session::open(None, None).unwrap();
    let again = record::perform(SEED, FRAMES, || ()).unwrap();
    // Not by bits: sines and roots of another C library may round otherwise.
    for (a, b) in again.joints.iter().zip(&embedded.joints) {
        assert_eq!(a.time_ns, b.time_ns);
        for (p, q) in a.joints.iter().zip(&b.joints) {
            assert_eq!(p.confidence > 0.5, q.confidence > 0.5);
            assert!(p.position.distance(q.position) < 1e-4, "{p:?} {q:?}");
        }
    }
    for (a, b) in again.depth.iter().zip(&embedded.depth) {
        let other = a.depth_mm.iter().zip(&b.depth_mm).filter(|(x, y)| x != y).count();
        assert!(other * 1_000 < a.depth_mm.len(), "{other} pixels differ at {} ns", a.time_ns);
    }
    assert_eq!((again.joints.len() as u64, again.depth.len() as u64), (FRAMES, FRAMES));
}

#[test]
fn the_shopper_is_measured_as_she_is() {
    let session = session::open(None, None).unwrap();
    let measured = measured::measure(&session, ShopperFacts::default()).unwrap();
    let truth = scene::SHOPPER.1;
    let [stature, shoulder, chest, waist, hip] = measured.best.completed(measured.population);
    let estimates = [
        ("stature", stature, truth.stature),
        ("shoulder breadth", shoulder, truth.shoulder_breadth),
        ("chest girth", chest, truth.chest_girth),
        ("waist girth", waist, truth.waist_girth),
        ("hip girth", hip, truth.hip_girth),
    ];
    for (name, estimate, truth) in estimates {
        let off = (estimate.value - truth).abs();
        assert!(off < 2.0 * estimate.sigma, "{name}: {} +- {}, is {truth}", estimate.value, estimate.sigma);
    }
}
