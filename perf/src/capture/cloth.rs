//! The truth: cloth that the engine steps, with a print, before cameras. A cloth hangs by four points and swings in the wind before
//! cameras on an arc; the benchmark's skirt walks with cameras all around it.

use glam::{DVec3, Vec2, Vec3};
use image::RgbImage;
use toile_assets::scene_file::{SceneFile, SceneSource};
use toile_capture::recover::VALUES;
use toile_capture::render::{Bar, Lighting, Print, PrintedSurface, Sensor, look_at, take};
use toile_engine::cloth::Quality;
use toile_fitting::heap::HeapProbe;
use toile_fitting::scene::{RunError, Runner};
use toile_sensors::calibration::CalibratedCamera;

use super::error::FlowStudyError;
use crate::skirt::SkirtScene;
use crate::skirt::options::SkirtOptions;

/// Vertices along a side, and the side (m): the 900 vertices of the source's cloth.
pub const ALONG: usize = 30;
const SIDE: f64 = 0.29;

/// The fabric of the hanging cloth: stretch of warp and weft and shear (N/m), bending (uN m), damping (1/s).
pub const FABRIC: [f64; VALUES] = [2_000.0, 60.0, 12.0, 0.5];

/// When the cameras' first frame of it is (s).
pub const FROM: f64 = 0.1;

/// Frames a second of the cameras, of which the engine steps twice as many.
pub const RATE: f64 = 60.0;

/// Pictures of 2 px a millimetre at the cloth: sides (px), focal length (px), distance (m).
const PICTURE: [u32; 2] = [800, 800];
const FOCAL: f64 = 2_400.0;
const DISTANCE: f64 = 1.2;

/// Angle between two neighbouring cameras (degrees), at most, and between the outermost.
const APART: f64 = 30.0;
const WIDEST: f64 = 100.0;

/// Vertices along a side of the skirt, by rows and columns; every so many of these its print is mirrored, once around in an even
/// number of times, so that nothing jumps where the columns close.
pub const SKIRT_SIDE: usize = 64;
const MIRRORED_COLUMNS: usize = 16;
const MIRRORED_ROWS: usize = 42;

/// The skirt is filmed at every step of 1/120 s, from when it walks as widely as it will (s).
const SKIRT_FROM: f64 = 2.0;

/// Pictures of 2 px a millimetre at the skirt's near side: sides (px), focal length (px), distance from its axis (m).
const SKIRT_PICTURE: [u32; 2] = [2_200, 1_900];
const SKIRT_FOCAL: f64 = 4_200.0;
const SKIRT_DISTANCE: f64 = 2.4;

/// What is filmed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filmed {
    /// The cloth that hangs by four points.
    Hanging,
    /// The benchmark's skirt, walking.
    WalkingSkirt,
}

/// What disturbs the cameras.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Disturbance {
    /// A shadow moves over the cloth.
    pub shadow: bool,
    /// An arm passes before it.
    pub arm: bool,
}

/// A cloth with its motion and its cameras.
pub struct FilmedCloth {
    /// Positions of each frame (m, world).
    pub frames: Vec<Vec<DVec3>>,
    /// The triangles of the mesh.
    pub triangles: Vec<[u32; 3]>,
    uvs: Vec<Vec2>,
    print: Print,
    /// The cameras before it.
    pub cameras: Vec<CalibratedCamera>,
}

/// The scene of the hanging cloth with a fabric's values as [`FABRIC`] has them.
pub fn scene([stretch, shear, bending, damping]: [f64; VALUES]) -> String {
    format!(
        "duration = 10\nstep_hz = 120\n[wind]\nvelocity = [0.3, 0.0, 0.8]\ndrag = 0.1\nlift = 0.05\n[settings]\nquality = \"fine\"\n\
         [garment]\ngrid = {{ rows = {ALONG}, columns = {ALONG}, width = {SIDE}, height = {SIDE} }}\nposition = [{}, {}, 0]\n\
         velocity = [0.2, 0.0, 0.3]\npin = {{ vertices = [0, 9, 20, 29] }}\n[garment.fabric]\nbase = \"cotton-lawn\"\nstretch_warp_n_m = {stretch}\n\
         stretch_weft_n_m = {stretch}\nshear_n_m = {shear}\nbend_warp_un_m = {bending}\nbend_weft_un_m = {bending}\n\
         bend_bias_un_m = {bending}\ndamping_per_s = {damping}\n",
        -SIDE / 2.0,
        SIDE / 2.0,
    )
}

/// Positions of a scene's only garment at the cameras' rate, from a time on (m).
///
/// # Errors
/// As [`Runner::new`].
///
/// # Panics
/// Where the text is no scene.
pub fn play(text: &str, from: f64, frames: usize) -> Result<Vec<Vec<Vec3>>, RunError> {
    let scene = SceneFile::parse("cloth.toml", text, SceneSource::Inside(&[])).expect("the scene is written here");
    let mut runner = Runner::new(scene)?;
    for _ in 0..(from * 2.0 * RATE) as usize {
        runner.step();
    }
    let mut all = Vec::with_capacity(frames);
    for _ in 0..frames {
        all.push(runner.positions(0).collect());
        runner.step();
        runner.step();
    }
    Ok(all)
}

impl FilmedCloth {
    /// The motion of what is filmed over some frames, before so many cameras.
    ///
    /// # Errors
    /// As [`Runner::new`] and [`SkirtScene::new`].
    pub fn new(filmed: Filmed, frames: usize, cameras: usize) -> Result<Self, FlowStudyError> {
        match filmed {
            Filmed::Hanging => Ok(Self::hanging(frames, cameras)?),
            Filmed::WalkingSkirt => Self::walking_skirt(frames, cameras),
        }
    }

    fn hanging(frames: usize, cameras: usize) -> Result<Self, RunError> {
        let frames = in_f64(&play(&scene(FABRIC), FROM, frames)?);
        let at = |i: usize| Vec2::new((i % ALONG) as f32, (ALONG - 1 - i / ALONG) as f32) / (ALONG - 1) as f32 * 0.5;
        let uvs = (0..ALONG * ALONG).map(at).collect();
        let mut triangles = Vec::new();
        for i in 0..(ALONG - 1) * (ALONG - 1) {
            let v = (i / (ALONG - 1) * ALONG + i % (ALONG - 1)) as u32;
            let w = v + ALONG as u32;
            triangles.extend([[v, w, v + 1], [v + 1, w, w + 1]]);
        }
        let apart = (WIDEST / (cameras - 1) as f64).min(APART).to_radians();
        let angle = |k: usize| (k as f64 - 0.5 * (cameras - 1) as f64) * apart;
        let middle = middle(&frames);
        let cameras = (0..cameras).map(|k| camera(k, angle(k), middle, (PICTURE, FOCAL, DISTANCE))).collect();
        Ok(Self { frames, triangles, uvs, print: Print::new(11), cameras })
    }

    fn walking_skirt(frames: usize, cameras: usize) -> Result<Self, FlowStudyError> {
        let options =
            SkirtOptions { verts: SKIRT_SIDE * SKIRT_SIDE, quality: Some(Quality::Fine), ..SkirtOptions::default() };
        let mut scene = SkirtScene::new(&options, &HeapProbe::none())?;
        let particles = scene.particle_of();
        let step = |scene: &mut SkirtScene| {
            scene.prepare();
            scene.step();
        };
        (0..(SKIRT_FROM / f64::from(options.step_s)) as usize).for_each(|_| step(&mut scene));
        let mut played = Vec::with_capacity(frames);
        for _ in 0..frames {
            played.push(particles.iter().map(|p| Vec3::from(scene.cloths[0].positions[*p as usize])).collect());
            step(&mut scene);
        }
        let frames = in_f64(&played);
        let uvs = (0..options.verts)
            .map(|v| Vec2::new(mirrored(v % SKIRT_SIDE, MIRRORED_COLUMNS), mirrored(v / SKIRT_SIDE, MIRRORED_ROWS)));
        let middle = middle(&frames);
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / cameras as f64;
        let view = (SKIRT_PICTURE, SKIRT_FOCAL, SKIRT_DISTANCE);
        let cameras = (0..cameras).map(|k| camera(k, angle(k), middle, view)).collect();
        let triangles = scene.shape.triangles();
        Ok(Self { frames, triangles, uvs: uvs.collect(), print: Print::new(11), cameras })
    }

    /// The pictures of a frame, drawn by a thread a camera.
    pub fn pictures(&self, frame: usize, disturbed: Disturbance) -> Vec<RgbImage> {
        let surface = PrintedSurface {
            positions: &self.frames[frame],
            uvs: &self.uvs,
            triangles: &self.triangles,
            print: &self.print,
        };
        let along = frame as f64 / self.frames.len() as f64;
        let place = -0.25 + 0.5 * along;
        let light = Lighting { shadow: disturbed.shadow.then_some((0.6, place, 0.04)), ..Lighting::default() };
        // It comes in from the side and leaves again.
        let x = 0.35 - 0.7 * along;
        let arm = Bar { ends: [DVec3::new(x, -0.5, 0.30), DVec3::new(x - 0.05, 0.10, 0.24)], radius: 0.03 };
        let bars: &[Bar] = if disturbed.arm { &[arm] } else { &[] };
        let shot = |k: usize| {
            let sensor = Sensor { seed: (frame * 64 + k) as u64, ..Sensor::default() };
            take(&surface, &light, bars, &self.cameras[k], &sensor)
        };
        std::thread::scope(|scope| {
            let shot = &shot;
            let threads: Vec<_> = (0..self.cameras.len()).map(|k| scope.spawn(move || shot(k))).collect();
            threads.into_iter().map(|t| t.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        })
    }
}

fn in_f64(frames: &[Vec<Vec3>]) -> Vec<Vec<DVec3>> {
    frames.iter().map(|f| f.iter().map(|p| p.as_dvec3()).collect()).collect()
}

fn middle(frames: &[Vec<DVec3>]) -> DVec3 {
    frames.iter().flatten().sum::<DVec3>() / (frames.len() * frames[0].len()) as f64
}

/// A camera at an angle about the vertical through a point, in turns above and below it.
fn camera(k: usize, angle: f64, middle: DVec3, (size, focal, distance): ([u32; 2], f64, f64)) -> CalibratedCamera {
    let lift = if k.is_multiple_of(2) { 0.15 } else { -0.15 };
    let from = middle + DVec3::new(angle.sin(), lift, angle.cos()) * distance;
    look_at(&format!("cam{}", k + 1), size, focal, [from, middle], DVec3::Y)
}

/// 0 to 1 over a period, back to 0 over the next.
fn mirrored(k: usize, period: usize) -> f32 {
    let along = k % (2 * period);
    along.min(2 * period - along) as f32 / period as f32
}
