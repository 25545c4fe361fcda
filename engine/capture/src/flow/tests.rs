use glam::{DVec3, Vec2};
use image::RgbImage;
use toile_sensors::calibration::CalibratedCamera;

use super::*;
use crate::render::{Bar, Lighting, Print, PrintedSurface, Sensor, look_at, take};
use crate::surface::CapturedSurface;

/// Vertices along a side of the cloth, and its side (m).
const ALONG: usize = 13;
const SIDE: f64 = 0.12;

/// Size of the pictures (px), with two pixels a millimetre.
const PICTURE: [u32; 2] = [360, 360];

/// A cloth that waves and swings, written down.
pub struct Waving {
    print: Print,
    pub uvs: Vec<Vec2>,
    pub triangles: Vec<[u32; 3]>,
    pub cameras: Vec<CalibratedCamera>,
}

impl Waving {
    pub fn new(cameras: usize) -> Self {
        let at = |i: usize| ((i % ALONG) as f32 / (ALONG - 1) as f32, (i / ALONG) as f32 / (ALONG - 1) as f32);
        let mut triangles = Vec::new();
        for i in 0..(ALONG - 1) * (ALONG - 1) {
            let v = (i / (ALONG - 1) * ALONG + i % (ALONG - 1)) as u32;
            let w = v + ALONG as u32;
            triangles.extend([[v, w, v + 1], [v + 1, w, w + 1]]);
        }
        let camera = |k: usize| {
            let angle = (k as f64 - 0.5 * (cameras - 1) as f64) * 0.5;
            let from = DVec3::new(angle.sin(), 0.1 * (k % 2) as f64, angle.cos()) * 0.75;
            look_at(&format!("cam{k}"), PICTURE, 1_500.0, [from, DVec3::ZERO], DVec3::Y)
        };
        let uvs = (0..ALONG * ALONG).map(|i| Vec2::new(at(i).0, 1.0 - at(i).1) * 0.25).collect();
        Self { print: Print::new(7), uvs, triangles, cameras: (0..cameras).map(camera).collect() }
    }

    pub fn positions(&self, frame: usize) -> Vec<DVec3> {
        let t = frame as f64 * 0.06;
        let place = |uv: &Vec2| {
            let (x, y) = ((f64::from(uv.x) * 4.0 - 0.5) * SIDE, (f64::from(uv.y) * 4.0 - 0.5) * SIDE);
            let low = 0.5 - y / SIDE;
            let z = 0.010 * low * (x * 45.0 + 2.5 * t).sin() * (2.0 * t).sin() + 0.012 * low * (3.0 * t).sin();
            DVec3::new(x + 0.006 * low * (2.2 * t).sin(), y, z)
        };
        self.uvs.iter().map(place).collect()
    }

    /// What all cameras see of a frame.
    fn pictures(&self, frame: usize, light: &Lighting, bars: &[Bar]) -> Vec<RgbImage> {
        (0..self.cameras.len()).map(|camera| self.picture(camera, frame, light, bars)).collect()
    }

    /// What one camera sees of it.
    pub fn picture(&self, camera: usize, frame: usize, light: &Lighting, bars: &[Bar]) -> RgbImage {
        let positions = self.positions(frame);
        let surface =
            PrintedSurface { positions: &positions, uvs: &self.uvs, triangles: &self.triangles, print: &self.print };
        let sensor = Sensor { seed: (frame * 16 + camera) as u64, ..Sensor::default() };
        take(&surface, light, bars, &self.cameras[camera], &sensor)
    }

    fn tracker(&self, settings: FlowSettings) -> FlowTracker {
        let surface =
            CapturedSurface::new("cloth", self.positions(0), self.uvs.clone(), self.triangles.clone()).unwrap();
        FlowTracker::new(surface, self.cameras.clone(), settings).unwrap()
    }

    /// Mean distance from where the cloth is (mm).
    fn error(&self, tracker: &FlowTracker, frame: usize) -> f64 {
        let truth = self.positions(frame);
        let sum: f64 = truth.iter().zip(tracker.positions()).map(|(a, b)| a.distance(*b)).sum();
        sum / truth.len() as f64 * 1e3
    }
}

#[test]
fn a_waving_cloth_is_followed_within_a_quarter_of_a_millimetre() {
    let cloth = Waving::new(3);
    let mut tracker = cloth.tracker(FlowSettings::default());
    let first = tracker.start(&cloth.pictures(0, &Lighting::default(), &[])).unwrap();
    assert!(first.agreement > 0.9, "{first:?}");
    for frame in 1..9 {
        let light = Lighting { shadow: Some((0.6, -0.1 + 0.02 * frame as f64, 0.02)), ..Lighting::default() };
        let outcome = tracker.step(&cloth.pictures(frame, &light, &[])).unwrap();
        let error = cloth.error(&tracker, frame);
        println!("{frame}: {error:.3} mm, {outcome:?}");
        assert!(error < 0.25, "frame {frame}: {error} mm");
    }
}

#[test]
fn an_arm_that_passes_before_it_moves_it_by_less_than_a_millimetre() {
    let cloth = Waving::new(4);
    let mut tracker = cloth.tracker(FlowSettings::default());
    tracker.start(&cloth.pictures(0, &Lighting::default(), &[])).unwrap();
    for frame in 1..8 {
        let x = -0.08 + 0.02 * frame as f64;
        let bar = Bar { ends: [DVec3::new(x, -0.3, 0.12), DVec3::new(x + 0.02, 0.3, 0.12)], radius: 0.012 };
        let outcome = tracker.step(&cloth.pictures(frame, &Lighting::default(), &[bar])).unwrap();
        let error = cloth.error(&tracker, frame);
        println!("{frame}: {error:.3} mm, placed {:.2}", outcome.placed);
        assert!(error < 1.0, "frame {frame}: {error} mm");
    }
}

#[test]
fn a_mesh_beside_its_place_is_refused_with_its_residual() {
    let cloth = Waving::new(3);
    let beside = cloth.positions(0).iter().map(|p| *p + DVec3::Z * 0.02).collect();
    let surface = CapturedSurface::new("cloth", beside, cloth.uvs.clone(), cloth.triangles.clone()).unwrap();
    let mut tracker = FlowTracker::new(surface, cloth.cameras.clone(), FlowSettings::default()).unwrap();
    let error = tracker.start(&cloth.pictures(0, &Lighting::default(), &[])).unwrap_err().to_string();
    assert!(error.contains("does not fit the first frame") && error.contains("correlate"), "{error}");
}

#[test]
fn a_run_that_stopped_goes_on_with_the_same_bits() {
    let cloth = Waving::new(2);
    let pictures: Vec<_> = (0..5).map(|f| cloth.pictures(f, &Lighting::default(), &[])).collect();
    let mut whole = cloth.tracker(FlowSettings::default());
    whole.start(&pictures[0]).unwrap();
    let mut meshes = vec![whole.positions().to_vec()];
    let mut memory = None;
    for (f, pictures) in pictures.iter().enumerate().skip(1) {
        whole.step(pictures).unwrap();
        meshes.push(whole.positions().to_vec());
        if f == 2 {
            memory = Some(whole.memory());
        }
    }
    let mut again = cloth.tracker(FlowSettings::default());
    let earlier = |f: u32| Ok((meshes[f as usize].clone(), pictures[f as usize].clone()));
    again.resume(&memory.unwrap(), 3, [meshes[1].clone(), meshes[2].clone()], earlier).unwrap();
    for f in 3..5 {
        again.step(&pictures[f]).unwrap();
        assert_eq!(again.positions(), meshes[f], "frame {f}");
    }
}

#[test]
fn a_camera_that_does_not_see_the_mesh_is_named() {
    let mut cloth = Waving::new(2);
    cloth.cameras[1] = look_at("away", PICTURE, 1_500.0, [DVec3::Z, DVec3::Z * 2.0], DVec3::Y);
    let surface =
        CapturedSurface::new("cloth", cloth.positions(0), cloth.uvs.clone(), cloth.triangles.clone()).unwrap();
    let said = |s: CapturedSurface, c: Vec<CalibratedCamera>| {
        FlowTracker::new(s, c, FlowSettings::default()).err().unwrap().to_string()
    };
    assert!(said(surface.clone(), cloth.cameras.clone()).contains("camera away: has the mesh behind it"));
    assert!(said(surface, cloth.cameras[..1].to_vec()).contains("1 camera"));
}
