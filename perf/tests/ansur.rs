//! Bodies built to the measures of people of the survey: a small version of `toile bench body`.

use crate::recordings;
use toile_perf::ansur::{Survey, study};

#[test]
fn people_of_the_survey_are_met_and_look_right() {
    let Some(folder) = recordings::folder() else { return };
    for file in ["ANSUR_II_FEMALE.csv", "ANSUR_II_MALE.csv"] {
        let survey = Survey::read(&folder.join("anthropometry/ansur2").join(file)).unwrap();
        let study = study(&survey, 40, 7, &|| ()).unwrap();
        assert_eq!((study.drawn, study.unreachable), (40, 0), "{file}");
        for m in study.measures.iter().filter(|m| m.given) {
            assert!(m.within == Some(1.0) && m.max_mm < 2.0, "{file}: {m:?}");
        }
        // What follows from the given ones is as near as people vary about it: legs, arms and thighs to a few per cent.
        for m in study.measures.iter().filter(|m| !m.given) {
            assert!(m.mean_mm < 35.0 && m.bias_mm.abs() < 25.0, "{file}: {m:?}");
        }
        assert!(study.passes() && study.roughness.max < 1.10, "{file}: {study:?}");
    }
}
