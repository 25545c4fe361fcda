//! State of a tracker between frames, and the preparation of a frame's pictures.

use std::ops::Range;

use glam::{DVec2, DVec3};
use image::RgbImage;
use toile_sensors::calibration::CalibratedCamera;

use super::energy::Energy;
use super::patches::LevelSamples;
use super::residual::{LevelView, PatchSums, Tone, TriangleTerm};
use super::settings::FlowSettings;
use super::visibility::Visibility;
use crate::error::CaptureError;
use crate::plane::{Pyramid, Window, level_map};
use crate::sparse::BlockSystem;
use crate::surface::CapturedSurface;

/// Pixels around the surface that are read besides it: a step of it, and what smoothing reaches.
const MARGIN: f64 = 48.0;

/// Part of a vertex' velocity that is expected to last: where no picture places it, it comes to rest.
const KEPT: f64 = 0.85;

/// A camera sees a triangle if it sees this part of it.
pub(super) const SEEN: f32 = 0.35;

/// A surface that is followed, and what is known of it.
pub(super) struct FlowState {
    pub surface: CapturedSurface,
    pub cameras: Vec<CalibratedCamera>,
    /// The same with lenses that bend nothing.
    pub straight: Vec<CalibratedCamera>,
    pub settings: FlowSettings,
    pub system: BlockSystem,
    /// Blocks of each triangle's corners `[triangles]`.
    pub places: Vec<[usize; 9]>,
    pub energy: Energy,
    /// Samples of each level.
    pub levels: Vec<LevelSamples>,
    /// What each camera sees of the surface as it lies.
    pub views: Vec<Visibility>,
    /// Brightness `[cameras][triangles]`.
    pub tones: Vec<Vec<Tone>>,
    /// Frame in which each camera first saw each triangle `[cameras][triangles]`.
    pub taken: Vec<Vec<Option<u32>>>,
    /// Cosine of the angle at which it did: its sign is the side that was seen.
    pub sides: Vec<Vec<f64>>,
    /// Where the surface is, and where it was a frame before (m).
    pub positions: Vec<DVec3>,
    pub before: Vec<DVec3>,
    /// Frames that were followed.
    pub frame: u32,
    /// Frames one after the other in which cameras placed next to nothing.
    pub unseen: u32,
    /// Room for an iteration's terms and sums `[triangles]`, `[triangles][cameras]`.
    pub scratch: (Vec<TriangleTerm>, Vec<PatchSums>),
}

impl FlowState {
    /// A state before the first frame.
    pub fn new(
        surface: CapturedSurface,
        cameras: Vec<CalibratedCamera>,
        settings: FlowSettings,
    ) -> Result<Self, CaptureError> {
        if cameras.len() < 2 {
            let problem = format!("{} camera, where depth comes from two or more", cameras.len());
            return Err(CaptureError::unfit("the calibration", problem, "calibrate at least two cameras together"));
        }
        let straight: Vec<_> = cameras.iter().map(CalibratedCamera::straightened).collect();
        for camera in &straight {
            check_view(camera, &surface)?;
        }
        let groups = surface.folds.iter().map(|f| &f.corners[..]).chain(surface.triangles.iter().map(|t| &t[..]));
        let system = BlockSystem::new(surface.rest.len(), groups);
        let places = |t: &[u32; 3]| std::array::from_fn(|k| system.place(t[k / 3], t[k % 3]));
        let levels = (0..settings.levels).map(|l| {
            let sides = surface.triangles.iter().map(|t| longest_side(&straight, &surface, t) * 0.5_f64.powi(l as i32));
            LevelSamples::new(&sides.collect::<Vec<_>>(), settings.spacing, cameras.len(), settings.channels)
        });
        let (n, t) = (cameras.len(), surface.triangles.len());
        Ok(Self {
            places: surface.triangles.iter().map(places).collect(),
            energy: Energy::new(&surface, &system),
            levels: levels.collect(),
            views: straight.iter().map(|c| Visibility::new(c.size, t)).collect(),
            tones: vec![vec![Tone::SAME; t]; n],
            taken: vec![vec![None; t]; n],
            sides: vec![vec![0.0; t]; n],
            positions: written(&surface.rest),
            before: written(&surface.rest),
            frame: 0,
            unseen: 0,
            scratch: Default::default(),
            surface,
            cameras,
            straight,
            settings,
            system,
        })
    }

    /// Where the motion would carry each vertex (m).
    pub fn carried(&self) -> Vec<DVec3> {
        self.positions.iter().zip(&self.before).map(|(x, b)| *x + (*x - *b) * KEPT).collect()
    }

    /// The pictures around the surface as it is now, and around where it goes.
    pub fn pyramids(&self, pictures: &[RgbImage]) -> Result<Vec<Pyramid>, CaptureError> {
        let carried = self.carried();
        let mut all = Vec::with_capacity(pictures.len());
        for ((camera, straight), picture) in self.cameras.iter().zip(&self.straight).zip(pictures) {
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for pixel in carried.iter().chain(&self.positions).filter_map(|p| straight.pixel(*p)) {
                (low, high) = (low.min(pixel), high.max(pixel));
            }
            let step = 1 << (self.settings.levels - 1);
            let Some(window) = Window::around(low, high, MARGIN, camera.size, step) else {
                let problem = format!("the surface left its pictures after frame {}", self.frame);
                return Err(CaptureError::unfit(format!("camera {}", camera.name), problem, "leave the camera out"));
            };
            all.push(Pyramid::new(picture, camera, window, self.settings.channels, self.settings.levels));
        }
        Ok(all)
    }

    /// Looks at the surface as it lies.
    pub fn look(&mut self) {
        let Self { views, straight, surface, positions, settings, .. } = self;
        let half = views.len().div_ceil(2);
        let ((first, rest), (cameras, others)) = (views.split_at_mut(half), straight.split_at(half));
        let (surface, positions, occlusion) = (&*surface, &*positions, settings.occlusion);
        let look = |views: &mut [Visibility], cameras: &[CalibratedCamera]| {
            let pairs = views.iter_mut().zip(cameras);
            pairs.for_each(|(view, camera)| view.look(camera, surface, positions, occlusion));
        };
        std::thread::scope(|scope| {
            scope.spawn(|| look(rest, others));
            look(first, cameras);
        });
    }

    /// [`Self::mask`] of every camera, half of them by another thread.
    pub fn masks(&self, level: usize, known: bool) -> Vec<Vec<f32>> {
        let half = self.cameras.len().div_ceil(2);
        let of = |cameras: Range<usize>| cameras.map(|c| self.mask(c, level, known)).collect::<Vec<_>>();
        std::thread::scope(|scope| {
            let later = scope.spawn(|| of(half..self.cameras.len()));
            let mut all = of(0..half);
            all.extend(later.join().unwrap_or_default());
            all
        })
    }

    /// The samples that a camera sees at a level, and has seen before where `known`, as 1 or 0.
    pub fn mask(&self, camera: usize, level: usize, known: bool) -> Vec<f32> {
        let samples = &self.levels[level];
        let mut mask = vec![0.0; samples.shares.len()];
        let view = &self.views[camera];
        view.mask(
            2.0_f64.powi(level as i32),
            &self.straight[camera],
            &self.surface,
            &self.positions,
            samples,
            &mut mask,
        );
        if known {
            for (t, side) in self.sides[camera].iter().enumerate() {
                let same = side * view.facing[t] > 0.0;
                let range = samples.starts[t]..samples.starts[t + 1];
                for (m, known) in mask[range.clone()].iter_mut().zip(&samples.known[camera][range]) {
                    *m *= if same { *known } else { 0.0 };
                }
            }
        }
        mask
    }

    /// Size of a pixel of a level on the surface (m).
    pub fn pixel(&self, level: usize) -> f64 {
        let middle = self.positions.iter().sum::<DVec3>() / self.positions.len() as f64;
        let size = |c: &CalibratedCamera| c.to_camera(middle).z / c.focal().x;
        let mean = self.straight.iter().map(size).sum::<f64>() / self.straight.len() as f64;
        mean * 2.0_f64.powi(level as i32)
    }

    /// A camera with its pictures of one level.
    pub fn view<'a>(&self, camera: usize, pyramid: &'a Pyramid, level: usize) -> LevelView<'a> {
        let camera = &self.straight[camera];
        let (scale, offset) = level_map(pyramid.window, level);
        LevelView {
            plane: &pyramid.levels[level],
            rotation: camera.rotation(),
            translation: camera.rows().1,
            focal: camera.focal() * scale,
            centre: camera.centre() * scale + offset,
        }
    }
}

/// Positions as files hold them, in f32: going on from what was written gives the same bits.
pub(super) fn written(positions: &[DVec3]) -> Vec<DVec3> {
    positions.iter().map(|p| p.as_vec3().as_dvec3()).collect()
}

/// Whether a camera sees any of the surface.
fn check_view(camera: &CalibratedCamera, surface: &CapturedSurface) -> Result<(), CaptureError> {
    let [w, h] = camera.size.map(f64::from);
    let inside = |p: DVec2| p.x >= 0.0 && p.y >= 0.0 && p.x < w && p.y < h;
    if surface.rest.iter().filter_map(|p| camera.pixel(*p)).any(inside) {
        return Ok(());
    }
    let ahead = surface.rest.iter().any(|p| camera.to_camera(*p).z > 0.0);
    let problem =
        if ahead { "sees nothing of the mesh: it lies beside its pictures" } else { "has the mesh behind it" };
    let cure = "check that mesh and cameras are in the same world, in metres, and that rotation and translation lead from the world \
                to the camera";
    Err(CaptureError::unfit(format!("camera {}", camera.name), problem, cure))
}

/// The longest side of a triangle in any camera (px).
fn longest_side(cameras: &[CalibratedCamera], surface: &CapturedSurface, t: &[u32; 3]) -> f64 {
    let side = |camera: &CalibratedCamera| {
        let seen = t.map(|v| camera.pixel(surface.rest[v as usize]).unwrap_or_default());
        (0..3).map(|k| seen[k].distance(seen[(k + 1) % 3])).fold(0.0, f64::max)
    };
    cameras.iter().map(side).fold(1.0, f64::max)
}
