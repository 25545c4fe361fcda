//! TRC files of markers, as motion analysis programs exchange them: X, Y, Z of each marker in each frame, separated by tabs.
//!
//! Their axes are those of OpenSim, y up: (X, Y, Z) of the file is (y, z, x) of a world whose z is up.

use std::fmt::Write;

use glam::DVec3;

use super::bones::marker_name;
use super::fit::PoseMotion;
use crate::error::CaptureError;

/// Markers over time.
#[derive(Debug, Clone, PartialEq)]
pub struct TrcMotion {
    /// Their names.
    pub names: Vec<String>,
    /// Their positions (m, a world with z up); NaN where one is not seen `[frames][markers]`.
    pub frames: Vec<Vec<DVec3>>,
}

/// Reads a TRC file in metres or millimetres.
///
/// # Errors
/// One sentence where the text is no TRC file.
pub fn read_trc(path: &str, text: &str) -> Result<TrcMotion, CaptureError> {
    let wrong =
        |problem: String| CaptureError::unfit(path, problem, "give a TRC file as Pose2Sim or OpenSim writes it");
    let lines: Vec<&str> = text.lines().collect();
    if lines.len() < 6 || !lines[0].starts_with("PathFileType") {
        return Err(wrong("it is no TRC file".to_owned()));
    }
    let scale = if lines[2].split('\t').any(|word| word.trim() == "mm") { 1e-3 } else { 1.0 };
    let names: Vec<String> =
        lines[3].split('\t').skip(2).map(str::trim).filter(|n| !n.is_empty()).map(str::to_owned).collect();
    let mut frames = Vec::new();
    for line in lines[5..].iter().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())) {
        let numbers: Vec<f64> = line.split('\t').skip(2).map(|n| n.trim().parse().unwrap_or(f64::NAN)).collect();
        let frame: Vec<DVec3> =
            numbers.chunks_exact(3).take(names.len()).map(|p| DVec3::new(p[2], p[0], p[1]) * scale).collect();
        if frame.len() < names.len() {
            return Err(wrong(format!("frame {} has {} of {} markers", frames.len() + 1, frame.len(), names.len())));
        }
        frames.push(frame);
    }
    Ok(TrcMotion { names, frames })
}

/// The TRC file of a motion, in metres.
pub fn write_trc(name: &str, motion: &PoseMotion) -> String {
    let markers: Vec<usize> = (0..25).filter(|k| !marker_name(*k).is_empty()).collect();
    let names: Vec<&str> = markers.iter().map(|k| marker_name(*k)).collect();
    let frames = motion.frames.iter().map(|f| f.as_ref().map(|x| markers.iter().map(|k| x[*k]).collect()));
    let upright = |p: DVec3| DVec3::new(p.y, p.z, p.x);
    trc_text(
        name,
        motion.rate,
        &names,
        frames.map(|f: Option<Vec<DVec3>>| f.map(|x| x.into_iter().map(upright).collect())),
    )
}

/// A TRC file of points by name (m, y up), frame by frame; none where a frame has none of them.
pub fn trc_text(
    name: &str,
    rate: f64,
    names: &[&str],
    frames: impl ExactSizeIterator<Item = Option<Vec<DVec3>>>,
) -> String {
    let (all, count) = (frames.len(), names.len());
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\t{name}\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t\
         OrigNumFrames\n{rate}\t{rate}\t{all}\t{count}\tm\t{rate}\t0\t{all}\nFrame#\tTime"
    );
    for name in names {
        let _ = write!(text, "\t{name}\t\t");
    }
    text.push_str("\n\t");
    for i in 1..=count {
        let _ = write!(text, "\tX{i}\tY{i}\tZ{i}");
    }
    text.push('\n');
    for (f, frame) in frames.enumerate() {
        let _ = write!(text, "{}\t{}", f + 1, (f + 1) as f64 / rate);
        match frame {
            Some(points) => points.iter().for_each(|p| {
                let _ = write!(text, "\t{}\t{}\t{}", p.x, p.y, p.z);
            }),
            None => names.iter().for_each(|_| text.push_str("\t\t\t")),
        }
        text.push('\n');
    }
    text
}

/// How far a motion lies from markers of the same names, of all that both have (mm): every distance, sorted.
pub fn distances(motion: &PoseMotion, truth: &TrcMotion) -> Vec<f64> {
    let mut off = Vec::new();
    for (x, markers) in motion.frames.iter().zip(&truth.frames) {
        for (name, marker) in truth.names.iter().zip(markers) {
            let keypoint = (0..25).find(|k| marker_name(*k) == name);
            if let (Some(x), Some(k), true) = (x, keypoint, marker.is_finite()) {
                off.push(x[k].distance(*marker) * 1e3);
            }
        }
    }
    off.sort_by(f64::total_cmp);
    off
}
