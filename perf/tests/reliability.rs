//! Whether the probabilities that are stated of sizes are true, of real women.

use crate::recordings;
use toile_perf::reliability::{ansur, of_dress};

/// Of the sizes said to be right with some probability that share is right, on real women measured with errors.
#[test]
fn stated_probabilities_are_true_of_real_people() {
    let Some(folder) = recordings::folder() else { return };
    let file = folder.join("anthropometry/ansur2/ANSUR_II_FEMALE.csv");
    let people = ansur(&String::from_utf8_lossy(&std::fs::read(file).unwrap())).unwrap();
    assert_eq!(people.len(), 1986);
    let some: Vec<_> = people.into_iter().step_by(5).collect();
    for sigma in [0.01, 0.02] {
        let r = of_dress(&some, sigma, 3).unwrap();
        let [stated, right, error] = r.all.rates();
        assert!((stated - right).abs() < 3.0 * error, "{sigma}: {stated} said, {right} +- {error} right");
        for bin in r.bins.iter().filter(|b| b.people >= 30) {
            let [stated, right, error] = bin.rates();
            assert!((stated - right).abs() < 3.5 * error.max(0.03), "{sigma}: {bin:?}");
        }
        let [promised, came, error] = r.taped.rates();
        assert!(r.taped.people > 30 && (promised - came).abs() < 3.0 * error + 0.02, "{sigma}: {:?}", r.taped);
        assert!(came > r.untaped.rates()[1] + 0.1, "{sigma}: {:?} {:?}", r.untaped, r.taped);
    }
}
