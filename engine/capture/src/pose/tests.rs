use std::path::PathBuf;

use toile_sensors::source::openpose::{KeypointRecording, keypoints_of};

use super::*;

/// The shared recording, or nothing where it is not set up; with CI=true that is a failure.
fn shared() -> Option<(KeypointRecording, TrcMotion)> {
    let folder: PathBuf = crate::recordings::folder()?.join("multiview/pose2sim");
    let path = folder.join("S00_P00_T01_BalancingTrial_0-100.trc");
    let truth = read_trc("truth", &std::fs::read_to_string(path).unwrap()).unwrap();
    Some((keypoints_of(&folder).unwrap(), truth))
}

#[test]
fn joints_are_those_that_others_triangulated_and_bones_keep_their_lengths() {
    let Some((recording, truth)) = shared() else { return };
    let motion = fit(&recording).unwrap();
    assert_eq!((motion.frames.len(), truth.frames.len(), truth.names.len()), (100, 100, 21));
    let off = distances(&motion, &truth);
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    println!(
        "{} points: mean {mean:.1} mm, median {:.1}, p95 {:.1}; {:.1} px",
        off.len(),
        off[off.len() / 2],
        off[off.len() * 95 / 100],
        motion.residual_px
    );
    for name in &truth.names {
        let only = TrcMotion {
            names: vec![name.clone()],
            frames: truth.frames.iter().map(|f| vec![f[truth.names.iter().position(|n| n == name).unwrap()]]).collect(),
        };
        let off = distances(&motion, &only);
        println!("  {name}: {:.1} mm of {}", off.iter().sum::<f64>() / off.len() as f64, off.len());
    }
    assert!(off.len() >= 2_000 && mean <= 25.0, "{mean} mm over {}", off.len());
    for ([a, b], length) in motion.bones.iter().zip(&motion.lengths) {
        for x in motion.frames.iter().flatten() {
            assert!((x[*a].distance(x[*b]) - length).abs() < 1e-9);
        }
    }
}

#[test]
fn a_motion_comes_back_from_its_file() {
    let Some((recording, _)) = shared() else { return };
    let motion = fit(&recording).unwrap();
    let read = read_trc("again", &write_trc("again.trc", &motion)).unwrap();
    assert_eq!(read.frames.len(), motion.frames.len());
    assert!(distances(&motion, &read).iter().all(|d| *d < 1e-6));
    assert!(read_trc("x", "no trc").is_err());
}

#[test]
fn a_camera_that_fails_for_a_while_moves_the_pose_by_little() {
    let Some((mut recording, truth)) = shared() else { return };
    for frame in recording.frames.iter_mut().skip(30).take(30).flatten() {
        frame.views[2] = None;
    }
    let off = distances(&fit(&recording).unwrap(), &truth);
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    println!("mean {mean:.1} mm");
    assert!(mean < 35.0, "{mean}");
}
