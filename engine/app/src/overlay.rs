//! A picture of a fitted body over the depth frame that it was fitted to.

use glam::Vec3;
use toile_base::body::Body;
use toile_base::frame::DepthFrame;
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Pose;
use toile_fitting::dress::depth::posed;
use toile_sensors::source::synthetic::SyntheticCamera;
use toile_view::image::{Image, Size};

/// A fitted body and the frame that it was fitted to.
#[derive(Debug, Clone, Copy)]
pub struct Fit<'a> {
    /// The depth frame that the body was fitted to.
    pub frame: &'a DepthFrame,
    /// The same with nothing in it but the shopper.
    pub alone: &'a DepthFrame,
    /// The body at rest.
    pub body: &'a Body,
    /// The body's pose in that frame.
    pub pose: &'a Pose,
}

/// Height of the picture's panels (px).
const HEIGHT: u32 = 640;

/// Room left around the shopper (m).
const MARGIN: f32 = 0.12;

/// Distance between surface and body that is shown in full colour (m).
const FULL: f32 = 0.04;

const GROUND: [u8; 3] = [246, 246, 244];

/// Three panels, seen from the camera and the right way up: the depth, the body over it, and how far the depth lies
/// before (blue) or behind (red) the body's surface, in full colour from 4 cm.
pub fn overlay(fit: &Fit) -> Image {
    let surface = posed(fit.body, fit.pose);
    let mut normals = vec![Vec3::ZERO; surface.len()];
    vertex_normals(&surface, &fit.body.mesh.triangles, &mut normals);
    let camera = SyntheticCamera { intrinsics: fit.frame.intrinsics, camera_to_world: fit.frame.camera_to_world };
    let mut body = vec![0.0; fit.frame.intrinsics.pixels()];
    camera.render(&surface, &fit.body.mesh.triangles, &mut body);
    let panel = Panel::around(fit.alone, &surface);
    let width = panel.width();
    let mut image = Image::filled(Size::new(3 * width, HEIGHT), GROUND);
    let depth: Vec<f32> = fit.frame.depth_mm.iter().map(|mm| f32::from(*mm) * 1e-3).collect();
    for y in 0..HEIGHT {
        for x in 0..width {
            let Some(i) = panel.pixel(fit.frame, x, y) else { continue };
            let grey = shade(fit.frame, &depth, i);
            let skin = body[i].is_finite().then(|| shade(fit.frame, &body, i));
            let over = match skin {
                Some(s) => [236.0, 178.0, 140.0].map(|c: f32| c * s),
                None => [1.0; 3].map(|c: f32| 255.0 * c * grey),
            };
            let seen = fit.alone.depth_mm[i] != 0;
            let off = match (seen, skin) {
                (true, Some(_)) => coloured(body[i] - depth[i]),
                (true, None) => [40, 90, 200],
                (false, Some(_)) => [214, 196, 190],
                (false, None) => GROUND,
            };
            let grey = [(255.0 * grey) as u8; 3];
            for (k, colour) in [grey, over.map(|c| c as u8), off].into_iter().enumerate() {
                image.fill((x + k as u32 * width) as i32, y as i32, Size::new(1, 1), colour);
            }
        }
    }
    image
}

/// White where the two agree, blue where the surface lies before the body, red where it lies behind.
fn coloured(before: f32) -> [u8; 3] {
    let t = (before / FULL).clamp(-1.0, 1.0);
    let fade = |c: f32| (255.0 * (1.0 - t.abs()) + c * t.abs()) as u8;
    if t > 0.0 { [fade(30.0), fade(80.0), fade(210.0)] } else { [fade(205.0), fade(40.0), fade(40.0)] }
}

/// Brightness of a surface lit from the camera, 0 to 1; of nothing that of paper.
fn shade(frame: &DepthFrame, depth: &[f32], i: usize) -> f32 {
    let width = frame.intrinsics.width as usize;
    let z = depth[i];
    if z <= 0.0 || !z.is_finite() {
        return 0.96;
    }
    // Over a few pixels, for a sensor's steps would be all that one sees.
    const BESIDE: usize = 3;
    let at = |j: usize| depth.get(j).copied().filter(|d| (d - z).abs() < 0.08).unwrap_or(z);
    let slope = |a: usize, b: usize| (at(a) - at(b)) / (2.0 * BESIDE as f32 * z / frame.intrinsics.fx);
    let (dx, dy) =
        (slope(i + BESIDE, i.wrapping_sub(BESIDE)), slope(i + BESIDE * width, i.wrapping_sub(BESIDE * width)));
    0.25 + 0.65 / (1.0 + dx * dx + dy * dy).sqrt()
}

/// The part of the camera's picture that is shown, the world's up upwards.
struct Panel {
    /// Middle (m), metres a pixel, and which way right and up are in the world.
    middle: Vec3,
    scale: f32,
    half: f32,
    right: Vec3,
}

impl Panel {
    fn around(alone: &DepthFrame, surface: &[Vec3]) -> Self {
        let eye: Vec3 = alone.camera_to_world.translation.into();
        let seen: Vec<Vec3> = alone.points().collect();
        let points = if seen.is_empty() { surface } else { &seen };
        let (low, high) = points.iter().fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        let middle = (low + high) * 0.5;
        let right = Vec3::Y.cross((eye - middle).with_y(0.0)).normalize_or(Vec3::X);
        let reach = points.iter().map(|p| (*p - middle).dot(right).abs()).fold(0.0, f32::max);
        Self { middle, scale: (high.y - low.y + 2.0 * MARGIN) / HEIGHT as f32, half: reach + MARGIN, right }
    }

    fn width(&self) -> u32 {
        (2.0 * self.half / self.scale) as u32
    }

    /// The camera's pixel that a pixel of the panel shows.
    fn pixel(&self, frame: &DepthFrame, x: u32, y: u32) -> Option<usize> {
        let right = (x as f32 - 0.5 * self.width() as f32) * self.scale;
        let up = (0.5 * HEIGHT as f32 - y as f32) * self.scale;
        let p = frame.camera_to_world.inverse().transform_point3(self.middle + self.right * right + Vec3::Y * up);
        let (u, v) = frame.intrinsics.project(p)?;
        let (u, v) = (u.round(), v.round());
        let inside = u >= 0.0 && v >= 0.0 && u < frame.intrinsics.width as f32 && v < frame.intrinsics.height as f32;
        inside.then(|| v as usize * frame.intrinsics.width as usize + u as usize)
    }
}
