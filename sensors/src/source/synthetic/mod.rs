//! A synthetic sensor: the depth of a posed mesh, with the noise of a real camera, and joints with the noise of a
//! tracker.
//!
//! Runs offline, on the loading thread or on the sensor thread of a test: at most 10 ms a 640x480 frame.

mod joints;
mod noise;
pub mod room;

use glam::{Affine3A, Mat3, Vec3};

use toile_base::frame::{DepthFrame, Intrinsics};

pub use joints::JointNoise;
pub use noise::{KinectNoise, axial_sigma, lateral_sigma};

/// Nearest depth that is rendered (m); triangles are clipped there.
const NEAR: f32 = 0.05;

/// A depth camera that sees a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SyntheticCamera {
    /// Size, focal lengths and centre (px).
    pub intrinsics: Intrinsics,
    /// Camera to world (m): camera x right, y down, z forward.
    pub camera_to_world: Affine3A,
}

impl SyntheticCamera {
    /// A camera at `eye` that looks at `target` (world, m), upright. `target` must not lie straight above or below.
    pub fn looking_at(intrinsics: Intrinsics, eye: Vec3, target: Vec3) -> Self {
        let forward = (target - eye).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let down = forward.cross(right);
        let rotation = Mat3::from_cols(right, down, forward);
        Self { intrinsics, camera_to_world: Affine3A::from_mat3_translation(rotation, eye) }
    }

    /// Renders the depth along the camera's z (m) into `out` `[width * height]`, infinite where nothing is seen.
    /// `positions` are world (m); both faces of a triangle are seen. Allocates nothing.
    ///
    /// # Panics
    /// If `out` has another length than the image, or a triangle an index beyond `positions`.
    pub fn render(&self, positions: &[Vec3], triangles: &[[u32; 3]], out: &mut [f32]) {
        assert_eq!(out.len(), self.intrinsics.pixels(), "a depth image of the camera's size");
        out.fill(f32::INFINITY);
        let world_to_camera = self.camera_to_world.inverse();
        for triangle in triangles {
            let corners = triangle.map(|i| world_to_camera.transform_point3(positions[i as usize]));
            if !corners.iter().all(|c| c.is_finite()) {
                continue;
            }
            let (polygon, count) = clipped(corners);
            for k in 2..count {
                self.fill([polygon[0], polygon[k - 1], polygon[k]], out);
            }
        }
    }

    /// The frame of a depth image in millimetres, as from [`KinectNoise::apply`].
    pub fn frame(&self, time_ns: u64, depth_mm: Box<[u16]>) -> DepthFrame {
        DepthFrame { time_ns, intrinsics: self.intrinsics, camera_to_world: self.camera_to_world, depth_mm }
    }

    /// Draws one triangle in camera axes, all of it in front of the camera. 1/z is linear in the image.
    fn fill(&self, corners: [Vec3; 3], out: &mut [f32]) {
        let k = &self.intrinsics;
        let [a, b, c] = corners.map(|p| Vec3::new(k.cx + k.fx * p.x / p.z, k.cy + k.fy * p.y / p.z, 1.0 / p.z));
        let area = edge(a, b, c);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        // Float to integer casts saturate, so that a corner far outside is no harm.
        let (u0, u1) = (low.x.ceil().max(0.0) as usize, (high.x.floor().min(k.width as f32 - 1.0) + 1.0) as usize);
        let (v0, v1) = (low.y.ceil().max(0.0) as usize, (high.y.floor().min(k.height as f32 - 1.0) + 1.0) as usize);
        for v in v0..v1 {
            for u in u0..u1 {
                let p = Vec3::new(u as f32, v as f32, 0.0);
                let weights = [edge(b, c, p), edge(c, a, p), edge(a, b, p)].map(|w| w / area);
                if weights.iter().all(|w| *w >= 0.0) {
                    let z = 1.0 / (weights[0] * a.z + weights[1] * b.z + weights[2] * c.z);
                    let pixel = &mut out[v * k.width as usize + u];
                    *pixel = pixel.min(z);
                }
            }
        }
    }
}

/// Twice the signed area of the triangle a, b, p in the image.
fn edge(a: Vec3, b: Vec3, p: Vec3) -> f32 {
    (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)
}

/// The part of a triangle beyond [`NEAR`]: up to four corners (after Sutherland and Hodgman 1974).
fn clipped(corners: [Vec3; 3]) -> ([Vec3; 4], usize) {
    let mut out = [Vec3::ZERO; 4];
    let mut count = 0;
    for (i, a) in corners.into_iter().enumerate() {
        let b = corners[(i + 1) % 3];
        if a.z >= NEAR {
            out[count] = a;
            count += 1;
        }
        if (a.z >= NEAR) != (b.z >= NEAR) {
            out[count] = a.lerp(b, (NEAR - a.z) / (b.z - a.z));
            count += 1;
        }
    }
    (out, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> SyntheticCamera {
        SyntheticCamera::looking_at(Intrinsics::KINECT_V1, Vec3::new(0.0, 1.0, 3.0), Vec3::new(0.0, 1.0, 0.0))
    }

    #[test]
    fn the_camera_sees_the_shoppers_left_on_its_right_and_up_is_up() {
        let camera = camera();
        let inverse = camera.camera_to_world.inverse();
        let left = inverse.transform_point3(Vec3::new(0.5, 1.5, 0.0));
        assert!(left.x > 0.0 && left.y < 0.0 && (left.z - 3.0).abs() < 1e-5);
        assert!(camera.camera_to_world.matrix3.determinant() > 0.99);
    }

    #[test]
    fn a_slanted_plane_is_rendered_where_it_lies() {
        let camera = camera();
        // A plane that leans back: world z = -0.5 (y - 1), seen perspectively.
        let corner = |x: f32, y: f32| Vec3::new(x, y, -0.5 * (y - 1.0));
        let positions = [corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, 2.0), corner(-1.0, 2.0)];
        let mut out = vec![0.0; camera.intrinsics.pixels()];
        camera.render(&positions, &[[0, 1, 2], [0, 2, 3]], &mut out);
        let mut seen = 0;
        for (i, z) in out.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let p = camera.intrinsics.unproject((i % 640) as f32, (i / 640) as f32, *z);
            let world = camera.camera_to_world.transform_point3(p);
            assert!((world.z + 0.5 * (world.y - 1.0)).abs() < 1e-4, "{world}");
            seen += 1;
        }
        assert!(seen > 100_000, "{seen}");
        assert!(out[0].is_infinite());
    }

    #[test]
    fn the_nearer_surface_wins_and_a_triangle_through_the_camera_is_clipped() {
        let camera = camera();
        let wall = |z: f32| [Vec3::new(-9.0, -9.0, z), Vec3::new(9.0, -9.0, z), Vec3::new(0.0, 20.0, z)];
        let floor = [Vec3::new(-5.0, 0.0, 9.0), Vec3::new(5.0, 0.0, 9.0), Vec3::new(0.0, 0.0, -9.0)];
        let positions = [wall(0.0), wall(1.0), floor].concat();
        let mut out = vec![0.0; camera.intrinsics.pixels()];
        camera.render(&positions, &[[0, 1, 2], [3, 4, 5], [6, 7, 8]], &mut out);
        assert!((out[240 * 640 + 320] - 2.0).abs() < 1e-4);
        assert!(out.iter().all(|z| *z >= NEAR * 0.999));
        // The floor alone, 1 m below the camera, at the bottom row; one of its corners lies behind the camera.
        camera.render(&positions, &[[6, 7, 8]], &mut out);
        let expected = 575.8 / (479.0 - 239.5);
        assert!((out[479 * 640 + 320] - expected).abs() < 1e-3, "{}", out[479 * 640 + 320]);
    }
}
