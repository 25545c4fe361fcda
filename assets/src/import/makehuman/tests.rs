//! The values that are known of MakeHuman's files.

use std::path::{Path, PathBuf};

use super::*;
use crate::import::avatar::surface::SurfaceCheck;
use toile_base::skeleton::Joint;

fn folder() -> Option<PathBuf> {
    Some(crate::recordings::folder()?.join("body/makehuman-hm08"))
}

fn with(targets: &[(&str, f32)]) -> MakehumanOptions {
    let targets = targets.iter().map(|(name, share)| ((*name).to_owned(), *share)).collect();
    MakehumanOptions { targets, ..MakehumanOptions::default() }
}

fn made(folder: &Path, targets: &[(&str, f32)]) -> MakehumanBody {
    read(folder, &with(targets), &ImportOptions::default()).unwrap()
}

/// Height, neck, bust, waist and hips as the files' makers and the shared data's table have them (cm).
#[test]
fn heights_and_girths_are_those_of_the_makers() {
    let Some(folder) = folder() else { return };
    let known = [
        (&[][..], [166.6, 30.6, 81.0, 75.1, 97.4]),
        (&[("caucasian-female-young", 1.0)], [160.5, 29.0, 83.9, 71.8, 95.3]),
        (&[("caucasian-male-young", 1.0)], [174.8, 37.9, 97.4, 77.7, 94.3]),
    ];
    for (targets, expected) in known {
        let girths = made(&folder, targets).girths;
        for ((name, value), expected) in girths.named().into_iter().zip(expected) {
            println!("{targets:?} {name}: {:.2} cm, known {expected}", value * 100.0);
            assert!((value * 100.0 - expected).abs() < 0.1, "{targets:?} {name}: {} {expected}", value * 100.0);
        }
    }
}

/// The waist's slider moves the waist by 10 cm and the bust by 3 mm.
#[test]
fn targets_add_up_and_are_coupled() {
    let Some(folder) = folder() else { return };
    let [plain, half, whole] = [0.0, 0.5, 1.0].map(|s| made(&folder, &[("measure-waist-circ-incr", s)]).girths);
    let cm = |a: f32, b: f32| (a - b) * 100.0;
    assert!((cm(whole.waist, plain.waist) - 10.0).abs() < 0.5, "{}", cm(whole.waist, plain.waist));
    assert!((cm(whole.bust, plain.bust) - 0.3).abs() < 0.1, "{}", cm(whole.bust, plain.bust));
    assert!((half.waist - 0.5 * (plain.waist + whole.waist)).abs() < 2e-3);
}

#[test]
fn weights_are_those_of_the_game_engine_rig() {
    let Some(folder) = folder() else { return };
    let base = MakehumanMesh::read(&folder).unwrap();
    let joints = rig::joints(&folder.join("rig.game_engine.json"), &base).unwrap();
    let influences = influences(&folder.join("weights.game_engine.json.gz"), &joints).unwrap();
    assert_eq!(joints.len(), 53);
    let counts: Vec<usize> = influences.iter().map(|i| i.0.iter().filter(|(_, w)| *w > 0.0).count()).collect();
    assert_eq!(counts.iter().filter(|c| **c > 4).count(), 608);
    assert_eq!(counts.iter().max(), Some(&6));
    for i in &influences {
        let sum: f32 = i.0.iter().map(|(_, w)| w).sum();
        assert!((0.9998..1.0002).contains(&sum), "{sum}");
    }
}

#[test]
fn every_body_stands_on_our_skeleton() {
    let Some(folder) = folder() else { return };
    for (rig, dialect) in [("game_engine", "Unreal"), ("cmu_mb", "MakeHuman CMU")] {
        let choice = MakehumanOptions { rig: rig.into(), ..with(&[("caucasian-female-young", 1.0)]) };
        let ImportedBody { body, report } = read(&folder, &choice, &ImportOptions::default()).unwrap().imported;
        println!("{rig}: {report:#?} {:?} {:?}", body.measures, body.levels);
        assert_eq!((report.dialect, report.parts, report.boundary_edges), (dialect, 1, 0));
        assert!((body.measures.stature - 1.605).abs() < 1e-3);
        assert_eq!((body.mesh.positions.len(), body.mesh.triangles.len()), (13_380, 26_756));
        assert_eq!(SurfaceCheck::of(&body.mesh.positions, &body.mesh.triangles).places, 13_380);
        for w in &body.weights {
            assert!((w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        assert!(body.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
        let s = &body.skeleton;
        assert!(s.at(Joint::LeftHip).x > 0.05 && (s.at(Joint::LeftHip).x + s.at(Joint::RightHip).x).abs() < 1e-4);
        assert!(s.at(Joint::LeftToe).z > s.at(Joint::LeftAnkle).z);
        let l = &body.levels;
        let order = [l.ankle, l.knee, l.crotch, l.hip, l.waist, l.underbust, l.chest, l.shoulder, l.neck];
        assert!(order.is_sorted(), "{l:?}");
    }
}

#[test]
fn the_same_files_give_the_same_bits() {
    let Some(folder) = folder() else { return };
    let targets = [("caucasian-male-young", 1.0), ("measure-bust-circ-incr", 0.5)];
    assert_eq!(made(&folder, &targets), made(&folder, &targets));
}

#[test]
fn what_is_missing_is_named() {
    let Some(folder) = folder() else { return };
    let message = |choice: &MakehumanOptions| read(&folder, choice, &ImportOptions::default()).unwrap_err().to_string();
    assert!(message(&with(&[("no-such-target", 1.0)])).contains("no target named no-such-target"));
    assert!(message(&with(&[("../hm08", 1.0)])).contains("no target named"));
    assert!(message(&MakehumanOptions { rig: "../x".into(), ..MakehumanOptions::default() }).contains("rig"));
    assert!(
        message(&MakehumanOptions { rig: "default".into(), ..MakehumanOptions::default() })
            .contains("weights.default.json.gz")
    );
}
