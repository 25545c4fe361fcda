//! The depth benchmark: every stage from a depth frame to the shopper's clean points, with the errors of the same run.

mod stages;
mod truth;

use serde::Serialize;
use toile_assets::body::BodyError;
use toile_assets::put_line;
use toile_base::frame::Intrinsics;

pub use stages::StageTimes;
pub use truth::DepthErrors;

/// Cameras of the table: half a Kinect's, a Kinect's, and about an Azure Kinect's straightened.
const CAMERAS: [(&str, Intrinsics); 3] = [
    ("320 x 240", Intrinsics { width: 320, height: 240, fx: 287.9, fy: 287.9, cx: 159.5, cy: 119.5 }),
    ("640 x 480", Intrinsics::KINECT_V1),
    ("749 x 667", Intrinsics { width: 749, height: 667, fx: 504.6, fy: 504.7, cx: 374.0, cy: 333.0 }),
];

/// Longest that smoothing may take for a whole image of 640 x 480 pixels (us).
pub const SMOOTHING_TARGET_US: f64 = 3_000.0;

/// One camera's row.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DepthRow {
    /// The image's size.
    pub image: &'static str,
    /// Pixels of the shopper.
    pub shopper_pixels: usize,
    /// Times (us, median).
    #[serde(flatten)]
    pub stages_us: StageTimes,
    /// Errors of the same frames.
    #[serde(flatten)]
    pub errors: DepthErrors,
}

/// Errors and times of depth processing, with their targets.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DepthTable {
    /// Longest that smoothing may take for a whole image of 640 x 480 (us).
    pub smoothing_target_us: f64,
    /// A row for each camera.
    pub rows: Vec<DepthRow>,
}

/// Runs the benchmark; `say` is given the name of each camera.
///
/// # Errors
/// Where the people cannot be made.
pub fn run(progress: &mut dyn FnMut(&str)) -> Result<DepthTable, BodyError> {
    let people = truth::People::new()?;
    let mut rows = Vec::new();
    for (image, intrinsics) in CAMERAS {
        progress(image);
        let scene = people.before(intrinsics);
        let (stages_us, shopper_pixels) = stages::time(&scene);
        rows.push(DepthRow { image, shopper_pixels, stages_us, errors: truth::errors(&scene) });
    }
    Ok(DepthTable { smoothing_target_us: SMOOTHING_TARGET_US, rows })
}

impl DepthTable {
    /// The table for a person to read.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| image | find the shopper | fill | smooth the shopper | smooth the full image | scalar reference | Gaussian | points and normals | all stages |\n\
             |---|---|---|---|---|---|---|---|---|\n",
        );
        for row in &self.rows {
            let t = &row.stages_us;
            let ms = |us: f64| format!("{:.2}", us * 1e-3);
            let all = [t.segment, t.fill, t.smooth, t.smooth_whole, t.smooth_plain, t.gaussian, t.cloud, t.all].map(ms);
            put_line!(text, "| {} | {} |", row.image, all.join(" | "));
        }
        text.push_str(
            "\nTimes in ms, median of many runs, one thread. The errors of the same run:\n\n\
             | image | noise of the body: raw, edge-preserving, Gaussian (mm) | noise of a wall at 2.5 m: raw, edge-preserving, Gaussian (mm) | edge of 20 cm, 10 to 90 %: raw, edge-preserving, Gaussian (px) | scalar reference differs in | leaked | missed |\n\
             |---|---|---|---|---|---|---|\n",
        );
        for row in &self.rows {
            let e = &row.errors;
            let three = |x: &[f64; 3]| x.map(|v| format!("{v:.2}")).join(", ");
            put_line!(
                text,
                "| {} | {} | {} | {} | {} px | {} px | {:.1} % |",
                row.image,
                three(&e.body_rms_mm),
                three(&e.wall_rms_mm),
                three(&e.edge_px),
                e.twin_differs_px,
                e.leaked_px,
                e.missed_percent
            );
        }
        let smoothing = self.rows.iter().find(|r| r.image == "640 x 480").map_or(0.0, |r| r.stages_us.smooth_whole);
        let verdict = if smoothing <= self.smoothing_target_us { "met" } else { "missed" };
        put_line!(
            text,
            "\nSmoothing a full 640 x 480 image: {:.2} ms of {:.0} ms: {verdict}.",
            smoothing * 1e-3,
            self.smoothing_target_us * 1e-3
        );
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_camera_is_measured_with_its_errors() {
        let people = truth::People::new().unwrap();
        let scene = people.before(CAMERAS[0].1);
        let errors = truth::errors(&scene);
        assert_eq!((errors.twin_differs_px, errors.leaked_px), (0, 0));
        assert!(
            errors.body_rms_mm[1] < 0.6 * errors.body_rms_mm[0] && errors.wall_rms_mm[1] < 0.34 * errors.wall_rms_mm[0]
        );
        assert!(errors.edge_px[1] < errors.edge_px[2], "{errors:?}");
        let row = DepthRow { image: "640 x 480", shopper_pixels: 1, stages_us: StageTimes::default(), errors };
        let late = StageTimes { smooth_whole: 3_001.0, ..StageTimes::default() };
        let table_of =
            |row: DepthRow| DepthTable { smoothing_target_us: SMOOTHING_TARGET_US, rows: vec![row] }.markdown();
        assert!(table_of(row.clone()).ends_with(": met.\n"));
        assert!(table_of(DepthRow { stages_us: late, ..row }).ends_with(": missed.\n"));
    }
}
