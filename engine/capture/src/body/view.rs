//! One camera's silhouette as the fit uses it: the planes that touch the body, the mask at the size of the drawn body, and distances.

use glam::{DMat3, DVec2, DVec3};
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::masks::Mask;

use super::distance_field::DistanceField;
use super::outline::{Stretch, outline};

/// Longest side of a body's drawing (px): with 2 m in the picture, 4 mm a pixel.
const DRAWN: f64 = 480.0;

/// Stretches of outline along the height of a body: one a centimetre and a half.
const STRETCHES: f64 = 120.0;

/// A stretch of outline, and the plane through it and the camera: the body touches it from within.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TangentPlane {
    /// Where it is seen, as by a lens that bends nothing (px).
    pub at: DVec2,
    /// The way out in the picture.
    pub out: DVec2,
    /// The plane's normal in the world, away from the body.
    pub normal: DVec3,
}

/// One camera's silhouette.
#[derive(Debug, Clone)]
pub(super) struct CameraSilhouette {
    /// The camera, with a lens that bends nothing, in a world whose y is up.
    pub camera: CalibratedCamera,
    /// Where it stands (m).
    pub from: DVec3,
    /// The planes that touch the body.
    pub planes: Vec<TangentPlane>,
    /// Length of a stretch of outline (px).
    pub step: f64,
    /// Pixels of the drawing a pixel of the picture.
    pub scale: f64,
    /// What the person covers, at the size of the drawing.
    pub covered: Vec<bool>,
    /// Distance from the person, at the size of the drawing (px of it).
    pub field: DistanceField,
    /// Whether the picture's border cuts the person off.
    pub cut: bool,
}

impl CameraSilhouette {
    /// The view of a mask by its camera, in a world that is turned by `upright`.
    pub(super) fn new(mask: &Mask, camera: &CalibratedCamera, upright: DMat3) -> Self {
        let bent = camera.in_turned_world(upright);
        let straight = bent.straightened();
        let rows = |y: usize| mask.coverage[y * mask.width..][..mask.width].iter().any(|c| *c >= 0.5);
        let tall = (0..mask.height).filter(|y| rows(*y)).count();
        let step = ((tall as f64 / STRETCHES).round() as usize).max(3);
        let planes = outline(mask, step).iter().map(|s| plane(s, &bent)).collect();
        let side = f64::from(camera.size[0].max(camera.size[1]));
        let scale = (DRAWN / side).min(1.0);
        let [width, height] = camera.size.map(|s| ((f64::from(s) * scale).ceil() as usize).max(1));
        let covered: Vec<bool> = (0..width * height)
            .map(|i| {
                let small = DVec2::new((i % width) as f64, (i / width) as f64);
                let at = (small + 0.5) / scale - 0.5;
                let seen = bent.pixel_of_ray((at - straight.centre()) / straight.focal());
                mask.at(seen.x.round() as isize, seen.y.round() as isize) >= 0.5
            })
            .collect();
        let border = |i: usize| {
            let (x, y) = (i % mask.width, i / mask.width);
            x == 0 || y == 0 || x + 1 == mask.width || y + 1 == mask.height
        };
        let cut = mask.coverage.iter().enumerate().any(|(i, c)| *c >= 0.5 && border(i));
        let field = DistanceField::of(width, height, &covered);
        Self { from: straight.position(), camera: straight, planes, step: step as f64, scale, covered, field, cut }
    }

    /// Where a point is seen in the drawing (px), with its depth (m).
    pub(super) fn small(&self, point: DVec3) -> DVec3 {
        let p = self.camera.to_camera(point);
        let pixel = (p.truncate() / p.z * self.camera.focal() + self.camera.centre() + 0.5) * self.scale - 0.5;
        pixel.extend(p.z)
    }
}

/// The plane through a stretch of outline and the camera.
fn plane(stretch: &Stretch, camera: &CalibratedCamera) -> TangentPlane {
    let flat = |pixel: DVec2| camera.ray(pixel) * camera.focal() + camera.centre();
    let at = flat(stretch.at);
    let along = (flat(stretch.at + stretch.out.perp()) - at).normalize_or(stretch.out.perp());
    let out = if along.perp().dot(stretch.out) > 0.0 { along.perp() } else { -along.perp() };
    let ray = ((at - camera.centre()) / camera.focal()).extend(1.0);
    let normal = ray.cross((along / camera.focal()).extend(0.0)).normalize();
    let outwards = (out / camera.focal()).extend(0.0);
    let normal = if normal.dot(outwards) > 0.0 { normal } else { -normal };
    TangentPlane { at, out, normal: camera.rotation().transpose() * normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::look_at;

    #[test]
    fn planes_touch_a_ball_from_outside() {
        let (centre, radius) = (DVec3::new(0.1, 1.0, -0.05), 0.4);
        let camera = look_at("c", [400, 400], 500.0, [DVec3::new(0.3, 1.2, 2.2), centre], DVec3::Y);
        let from = camera.position();
        let hit = |x: f64, y: f64| {
            let ray = (DVec2::new(x, y) - camera.centre()) / camera.focal();
            let along = (camera.rotation().transpose() * ray.extend(1.0)).normalize();
            (centre - from).cross(along).length() < radius
        };
        let coverage = |i: usize| {
            let (x, y) = ((i % 400) as f64, (i / 400) as f64);
            let hits = (0..16).filter(|k| hit(x + f64::from(k % 4) / 4.0 - 0.375, y + f64::from(k / 4) / 4.0 - 0.375));
            hits.count() as f32 / 16.0
        };
        let mask = Mask { width: 400, height: 400, coverage: (0..160_000).map(coverage).collect() };
        let view = CameraSilhouette::new(&mask, &camera, DMat3::IDENTITY);
        assert!(view.planes.len() > 60 && !view.cut);
        for plane in &view.planes {
            let off = plane.normal.dot(centre - from) + radius;
            assert!(off.abs() < 1e-3, "{off}");
        }
    }
}
