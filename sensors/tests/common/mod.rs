//! Finds the shared recordings, and measures joints.

#[path = "../../../tests/src/recordings.rs"]
mod recordings;
pub mod samples;
pub mod skeletons;

use std::path::{Path, PathBuf};

use toile_base::frame::Joints;
use toile_base::numeric::statistics::median_of;
use toile_base::skeleton::Joint;
use toile_sensors::filter::JointFilter;
use toile_sensors::session::Session;
use toile_sensors::source::{OpenOptions, open};

/// The folder of recordings, where there is one.
pub fn data() -> Option<PathBuf> {
    recordings::folder()
}

/// Opens one recording.
pub fn session(folder: &Path, file: &str) -> Session {
    open(&folder.join(file), &OpenOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// All frames of a session, filtered.
pub fn filtered(session: &Session) -> Vec<Joints> {
    let mut filter = JointFilter::default();
    session.joints.iter().map(|f| filter.push(f)).collect()
}

/// Median of a value over the frames that have it.
pub fn median(values: impl Iterator<Item = f32>) -> f32 {
    median_of(values).expect("a frame has the value")
}

/// Mean and standard deviation.
pub fn spread(values: impl Iterator<Item = f32>) -> (f32, f32) {
    let all: Vec<f32> = values.collect();
    let mean = all.iter().sum::<f32>() / all.len() as f32;
    (mean, (all.iter().map(|x| (x - mean).powi(2)).sum::<f32>() / all.len() as f32).sqrt())
}

/// Length of a bone whose ends are both at least inferred (m).
pub fn length(frame: &Joints, from: Joint, to: Joint) -> Option<f32> {
    let (a, b) = (frame.at(from), frame.at(to));
    (a.confidence > 0.0 && b.confidence > 0.0).then(|| a.position.distance(b.position))
}

/// Fastest step of any joint that is present in both frames (m/s), the joint and the frame.
pub fn top_speed(track: &[Joints]) -> (f32, Joint, usize) {
    let mut top = (0.0, Joint::Pelvis, 0);
    for (i, w) in track.windows(2).enumerate() {
        let seconds = (w[1].time_ns - w[0].time_ns) as f32 * 1e-9;
        for joint in Joint::ALL {
            let (a, b) = (w[0].at(joint), w[1].at(joint));
            let speed = a.position.distance(b.position) / seconds;
            if a.confidence > 0.0 && b.confidence > 0.0 && speed > top.0 {
                top = (speed, joint, i + 1);
            }
        }
    }
    top
}
