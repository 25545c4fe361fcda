use std::fs;
use std::path::{Path, PathBuf};

use toile_sensors::calibration::Rig;
use toile_sensors::pictures::PictureSequence;

use super::*;
use crate::flow::FlowSettings;
use crate::flow::tests::Waving;
use crate::render::{Lighting, look_at};
use crate::surface::CapturedSurface;

/// A folder that is removed when it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("toile-recording-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Writes so many frames of the cloth at a pace, the second camera `late` frames behind the others.
fn record(cloth: &Waving, folder: &Path, frames: usize, pace: impl Fn(usize) -> usize, late: usize) {
    for (k, camera) in cloth.cameras.iter().enumerate() {
        fs::create_dir_all(folder.join(&camera.name)).unwrap();
        for f in 0..frames {
            let of = pace(if k == 1 { f } else { f + late });
            let path = folder.join(&camera.name).join(format!("{:04}.png", f + 5));
            cloth.picture(k, of, &Lighting::default(), &[]).save(path).unwrap();
        }
    }
}

fn job(cloth: &Waving, folder: &Folder, out: &str, frames: Option<usize>) -> FlowJob {
    FlowJob {
        surface: CapturedSurface::new("cloth", cloth.positions(0), Vec::new(), cloth.triangles.clone()).unwrap(),
        rig: Rig { cameras: cloth.cameras.clone(), frame_rate: Some(50.0) },
        sequence: PictureSequence::open(&folder.0.join("pictures"), cloth.cameras.len()).unwrap(),
        out: folder.0.join(out),
        settings: FlowSettings::default(),
        frames,
        rate: 30.0,
        unsynchronised: false,
    }
}

#[test]
fn a_recording_becomes_meshes_and_goes_on_where_it_stopped() {
    let (cloth, folder) = (Waving::new(2), Folder::new("resume"));
    record(&cloth, &folder.0.join("pictures"), 5, |f| f, 0);
    let whole = job(&cloth, &folder, "whole", None).run(|_| {}).unwrap();
    assert_eq!((whole.frames, whole.resumed), (5, 0));
    assert!(whole.files[0].ends_with("motion.glb") && whole.residual < 4.0);
    job(&cloth, &folder, "parts", Some(3)).run(|_| {}).unwrap();
    let mut seen = Vec::new();
    let rest = job(&cloth, &folder, "parts", None).run(|p| seen.push(p.done)).unwrap();
    assert_eq!((rest.resumed, seen), (3, vec![3, 4, 5]));
    for number in 5..10 {
        let read = |out: &str| fs::read(folder.0.join(out).join(mesh_name(number))).unwrap();
        assert!(read("whole") == read("parts"), "frame {number}");
    }
    let mut other = job(&cloth, &folder, "parts", None);
    other.settings.threshold *= 2.0;
    let error = other.run(|_| {}).unwrap_err().to_string();
    assert!(error.contains("another mesh, other cameras, pictures or settings"), "{error}");
}

#[test]
fn cameras_out_of_step_are_found_before_anything_is_written() {
    let (mut cloth, folder) = (Waving::new(3), Folder::new("late"));
    // Small pictures: how much changes is seen from afar, too.
    for (k, camera) in cloth.cameras.iter_mut().enumerate() {
        let from = camera.position() * 1.2;
        *camera = look_at(&format!("cam{k}"), [96, 96], 420.0, [from, glam::DVec3::ZERO], glam::DVec3::Y);
    }
    // It moves and rests by turns, as what is filmed does.
    let pace = |f: usize| (0..f).filter(|k| k / 4 * 5 % 7 < 3).count() * 4;
    record(&cloth, &folder.0.join("pictures"), 60, pace, 4);
    let error = job(&cloth, &folder, "out", None).run(|_| {}).expect_err("cameras are out of step").to_string();
    assert!(error.contains("camera cam1: its pictures come 4 frames late"), "{error}");
    assert!(!folder.0.join("out").exists());
}
