//! A body's picture with what a collage has to know of it: where its arms are, how far its trunk and legs reach, where its levels lie.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};
use toile_base::body::{Body, Region};

use crate::figure::{Appearance, Figure};
use crate::image::{Image, Size};
use crate::scene::{Bounds, CameraFrame, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use crate::trace::{TraceQuality, TracedScene};

toile_base::named! {
    /// From where a collage is seen.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum CollageSide {
        /// From the front.
        Front = "front",
        /// From the wearer's left.
        Side = "side",
        /// From behind.
        Back = "back",
    }
}

impl CollageSide {
    const fn yaw(self) -> f32 {
        match self {
            Self::Front => 0.0,
            Self::Side => FRAC_PI_2,
            Self::Back => PI,
        }
    }
}

/// Samples along each side of a pixel that say what covers it.
const SAMPLES: usize = 3;

/// How far the camera stands off (m): so far that a garment's picture needs one scale.
const AWAY: f32 = 14.0;

/// Share of the picture's height that a body takes.
const FILL: f32 = 0.90;

/// A body's picture and its layers.
#[derive(Debug, Clone)]
pub struct BodyLayers {
    /// The picture.
    pub picture: Image,
    /// How much of each pixel is an arm of the body, 0 to 1 `[height x width]`.
    pub arms: Vec<f32>,
    /// Where trunk, head and legs begin and end in each row (px); none where they are not `[height]`.
    pub trunk: Vec<Option<[f32; 2]>>,
    /// Pixels a metre.
    pub per_metre: f32,
    /// Row of the floor.
    floor: f32,
}

/// Narrowest picture, in parts of its height, and what is left beside a body (parts of its height).
const NARROWEST: f32 = 0.6;
const BESIDE: f32 = 0.06;

impl BodyLayers {
    /// The size of a picture of so many rows on which this body is whole from every side, its arms half raised.
    pub fn size(body: &Body, rows: u32) -> Size {
        let Bounds { min, max } = Bounds::of(&body.mesh.positions);
        let wide = FILL * (max.x - min.x) / (max.y - min.y).max(0.1) + 2.0 * BESIDE;
        // Even, so that videos and sheets take it.
        Size::new((rows as f32 * wide.clamp(NARROWEST, 2.0) * 0.5).ceil() as u32 * 2, rows)
    }

    /// The picture of a body at rest from one side.
    pub fn new(body: &Body, appearance: Appearance, side: CollageSide, size: Size) -> Self {
        let figure = Figure::of(body, appearance);
        let Bounds { min, max } = Bounds::of(&figure.rest);
        let tall = (max.y - min.y).max(0.1);
        let fov_y = 2.0 * (0.5 * tall / FILL / AWAY).atan();
        let target = Vec3::new(0.5 * (min.x + max.x), 0.5 * tall, 0.5 * (min.z + max.z));
        let camera = OrbitCamera { target, yaw: side.yaw(), height: 0.0, distance: AWAY, fov_y };
        let skin = PictureSurface {
            positions: &figure.rest,
            normals: &figure.normals,
            triangles: &figure.triangles,
            colours: Colours::One(figure.colour),
            material: Material::Skin,
            look: Some(figure.look.shown()),
        };
        let surfaces = [skin];
        let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
        let picture = scene.render(&camera, size, TraceQuality::Still);
        let view = camera.view(size.width as f32 / size.height.max(1) as f32);
        let is_arm = |t: &[u32; 3]| {
            let of = |v: u32| body.regions.get(v as usize).copied();
            t.iter().all(|v| matches!(of(*v), Some(Region::LeftArm | Region::RightArm)))
        };
        let limbs: Vec<bool> = figure.triangles.iter().map(is_arm).collect();
        let seen = CoveredSamples::of(&view, size, &figure.rest, &figure.triangles, &limbs);
        let per_metre = size.height as f32 / (tall / FILL);
        let (arms, trunk) = seen.layers();
        Self { picture, arms, trunk, per_metre, floor: 0.5 * size.height as f32 + 0.5 * tall * per_metre }
    }

    /// The row of a height over the floor (m).
    pub fn row(&self, height: f32) -> f32 {
        self.floor - height * self.per_metre
    }

    /// The middle of trunk or legs in a row (px); of the picture where nothing is.
    pub fn middle(&self, row: f32) -> f32 {
        let rows = self.trunk.len().max(1);
        let row = (row.max(0.0) as usize).min(rows - 1);
        let near = (0..rows).filter(|r| self.trunk[*r].is_some()).min_by_key(|r| r.abs_diff(row));
        let of = near.and_then(|r| self.trunk[r]);
        of.map_or(0.5 * self.picture.size().width as f32, |[left, right]| 0.5 * (left + right))
    }
}

/// What each sample of a picture sees: nothing, trunk and legs, or an arm; and, whatever lies before them, where trunk and legs are.
struct CoveredSamples {
    size: Size,
    /// First surface of each sample: 0 nothing, 1 trunk, 2 arm.
    first: Vec<u8>,
    /// Whether trunk or legs are there at all.
    trunk: Vec<bool>,
}

impl CoveredSamples {
    fn of(view: &CameraFrame, size: Size, positions: &[Vec3], triangles: &[[u32; 3]], limbs: &[bool]) -> Self {
        let (w, h) = (size.width as usize * SAMPLES, size.height as usize * SAMPLES);
        let mut depth = vec![f32::INFINITY; w * h];
        let mut seen = Self { size, first: vec![0; w * h], trunk: vec![false; w * h] };
        let place = |p: &Vec3| {
            let to = *p - view.origin;
            let z = to.dot(view.forward).max(1e-3);
            let at = Vec2::new(to.dot(view.right), -to.dot(view.up)) / (view.half * z);
            ((at + 1.0) * 0.5 * Vec2::new(w as f32, h as f32) - 0.5, z)
        };
        let placed: Vec<(Vec2, f32)> = positions.iter().map(place).collect();
        for (corners, arm) in triangles.iter().zip(limbs) {
            let [(a, za), (b, zb), (c, zc)] = corners.map(|v| placed[v as usize]);
            let area = (b - a).perp_dot(c - a);
            let low = a.min(b).min(c).max(Vec2::ZERO).ceil();
            let high = a.max(b).max(c).min(Vec2::new(w as f32 - 1.0, h as f32 - 1.0)).floor();
            if area.abs() < 1e-9 || !(low.x <= high.x && low.y <= high.y) {
                continue;
            }
            for y in low.y as usize..=high.y as usize {
                for x in low.x as usize..=high.x as usize {
                    let p = Vec2::new(x as f32, y as f32);
                    let (wb, wc) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
                    let wa = 1.0 - wb - wc;
                    if wa < 0.0 || wb < 0.0 || wc < 0.0 {
                        continue;
                    }
                    let at = y * w + x;
                    seen.trunk[at] |= !arm;
                    let z = wa * za + wb * zb + wc * zc;
                    if z < depth[at] {
                        (depth[at], seen.first[at]) = (z, 1 + u8::from(*arm));
                    }
                }
            }
        }
        seen
    }

    /// Coverage by arms of each pixel, and the ends of trunk and legs in each row.
    fn layers(&self) -> (Vec<f32>, Vec<Option<[f32; 2]>>) {
        let (width, height) = (self.size.width as usize, self.size.height as usize);
        let w = width * SAMPLES;
        let mut arms = vec![0.0; width * height];
        for i in (0..self.first.len()).filter(|i| self.first[*i] == 2) {
            arms[i / w / SAMPLES * width + i % w / SAMPLES] += 1.0 / (SAMPLES * SAMPLES) as f32;
        }
        let ends = |y: usize| {
            let rows = &self.trunk[y * SAMPLES * w..(y + 1) * SAMPLES * w];
            let at = rows.iter().enumerate().filter(|(_, t)| **t).map(|(i, _)| (i % w) as f32 / SAMPLES as f32);
            let (low, high) = at.fold((f32::MAX, f32::MIN), |(l, h), x| (l.min(x), h.max(x)));
            (low <= high).then_some([low, high + 1.0 / SAMPLES as f32])
        };
        (arms, (0..height).map(ends).collect())
    }
}
