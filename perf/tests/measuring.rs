//! A small study of measuring: the whole way from the survey to the table.

#[path = "../../tests/src/recordings.rs"]
mod recordings;

use std::path::{Path, PathBuf};

use toile_perf::ansur::Survey;
use toile_perf::measuring::{Family, MeasuringOptions, MeasuringStudy, Sensor, study};

/// The folder of shared data; absent data is a failure in continuous integration.
fn folder() -> Option<PathBuf> {
    Some(recordings::folder()?.join("anthropometry/ansur2"))
}

/// Both files of the survey.
fn surveys(folder: &Path) -> Vec<Survey> {
    let files = std::fs::read_dir(folder).expect("the survey's folder").map(|f| f.expect("an entry").path());
    let mut files: Vec<PathBuf> = files.filter(|f| f.extension().is_some_and(|e| e == "csv")).collect();
    files.sort();
    files.iter().map(|f| Survey::read(f).expect("a survey")).filter(|s| s.sex().is_ok()).collect()
}

/// Largest mean absolute error (mm) over a handful of people: half as much again as over the many of docs/measuring.md,
/// for over four the mean wanders by a half.
const LIMITS: [(&str, f64); 5] =
    [("stature", 9.0), ("shoulder_breadth", 16.0), ("chest_girth", 35.0), ("waist_girth", 35.0), ("hip_girth", 30.0)];

#[test]
fn people_before_both_cameras_are_found_and_measured() {
    let Some(folder) = folder() else { return };
    let surveys = surveys(&folder);
    assert_eq!(surveys.len(), 2);
    for sensor in [Sensor::Kinect, Sensor::Azure] {
        let options = MeasuringOptions { family: Family::Survey, people: 2, frames: 3, seed: 5, sensor };
        let found: MeasuringStudy = study(&surveys, &options, &|_| ()).expect("a study");
        assert_eq!((found.people, found.lost), (4, 0));
        assert_eq!(found.sex_right, 1.0, "{}", found.sensor);
        for (name, limit) in LIMITS {
            let row = found.fit.iter().find(|a| a.measure == name).expect("a measure that is taken");
            assert_eq!(row.taken, 4);
            assert!(row.mean_absolute_mm < limit, "{} {name}: {row:?}", found.sensor);
            assert!(row.sigma_mm > 0.0 && row.within_two_sigma > 0.4, "{} {name}: {row:?}", found.sensor);
        }
    }
}
