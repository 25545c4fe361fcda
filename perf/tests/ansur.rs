//! Bodies built to the measures of people of the survey.

use toile_assets::body::{Ansur, Wanted, fitted};
use toile_perf::ansur::{Survey, chosen};

use crate::recordings;

/// Measures that each body is built from, and the survey's names of them.
const GIVEN: [(Ansur, &str); 8] = [
    (Ansur::Stature, "stature"),
    (Ansur::NeckCircumference, "neckcircumference"),
    (Ansur::ChestCircumference, "chestcircumference"),
    (Ansur::WaistCircumferenceOmphalion, "waistcircumference"),
    (Ansur::ButtockCircumference, "buttockcircumference"),
    (Ansur::CrotchHeight, "crotchheight"),
    (Ansur::SleeveLengthSpineWrist, "sleevelengthspinewrist"),
    (Ansur::BiacromialBreadth, "biacromialbreadth"),
];

#[test]
fn bodies_meet_the_measures_of_surveyed_people() {
    let Some(folder) = recordings::folder() else { return };
    for file in ["ANSUR_II_FEMALE.csv", "ANSUR_II_MALE.csv"] {
        let survey = Survey::read(&folder.join("anthropometry/ansur2").join(file)).unwrap();
        let sex = survey.sex().unwrap();
        let columns = GIVEN.map(|(_, name)| survey.column(name).unwrap());
        for row in chosen(survey.people(), 40, 7) {
            let metres = |column: &Vec<f64>| (column[row] * 1e-3) as f32;
            let wanted = GIVEN.iter().zip(&columns).fold(Wanted::new(), |w, (given, c)| w.with(given.0, metres(c)));
            let body = fitted(sex, &wanted).unwrap_or_else(|e| panic!("{file}, line {}: {e}", row + 2));
            for ((measure, name), column) in GIVEN.iter().zip(&columns) {
                let off_mm = f64::from(body.readings.of(*measure)) * 1e3 - column[row];
                assert!(off_mm.abs() < 2.0, "{file}, line {}: {name} is off by {off_mm} mm", row + 2);
            }
        }
    }
}
