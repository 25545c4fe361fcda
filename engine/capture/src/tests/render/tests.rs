use glam::{DVec2, DVec3, Vec2};
use toile_sensors::calibration::CalibratedCamera;

use super::*;

/// A camera a metre and a half before the origin, turned about the upright axis by an angle (rad).
pub fn camera(size: [u32; 2], angle: f64) -> CalibratedCamera {
    let from = DVec3::new(1.5 * angle.sin(), 0.0, 1.5 * angle.cos());
    look_at("c", size, f64::from(size[0]) * 1.4, [from, DVec3::ZERO], DVec3::Y)
}

fn square() -> ([DVec3; 4], [Vec2; 4], [[u32; 3]; 2]) {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let uvs = corners.map(|(x, y): (f32, f32)| Vec2::new(x, y) * 0.5 + 0.5);
    (corners.map(|(x, y)| DVec3::new(x.into(), y.into(), 0.0) * 0.3), uvs, [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn a_point_of_the_print_is_seen_where_the_camera_projects_it() {
    let print = Print::new(3);
    let (positions, uvs, triangles) = square();
    let surface = PrintedSurface { positions: &positions, uvs: &uvs, triangles: &triangles, print: &print };
    let light = Lighting { ambient: 1.0, ..Lighting::default() };
    let sensor = Sensor { samples: 1, blur: 0.0, noise: 0.0, ..Sensor::default() };
    let camera = camera([160, 160], 0.4);
    let picture = take(&surface, &light, &[], &camera, &sensor);
    for (x, y) in [(60u32, 70u32), (80, 80), (100, 70)] {
        // The pixel's ray meets z = 0 at a point of the print.
        let ray = camera.ray(DVec2::new(f64::from(x), f64::from(y))).extend(1.0);
        let (from, along) = (camera.position(), camera.rotation().transpose() * ray);
        let at = from - along * (from.z / along.z);
        assert!(camera.pixel(at).unwrap().distance(DVec2::new(f64::from(x), f64::from(y))) < 1e-6);
        let [u, v] = [at.x, at.y].map(|c| (c / 0.6 + 0.5) as f32);
        let wanted = print.at(u, v);
        for (c, w) in picture.get_pixel(x, y).0.iter().zip(wanted) {
            assert!((f32::from(*c) - 255.0 * w).abs() < 1.5, "{x},{y}: {c} {}", 255.0 * w);
        }
    }
}

#[test]
fn noise_has_the_spread_that_is_asked_for_and_a_bar_hides() {
    let print = Print::new(3);
    let (positions, uvs, triangles) = square();
    let surface = PrintedSurface { positions: &positions, uvs: &uvs, triangles: &triangles, print: &print };
    let camera = camera([120, 120], 0.0);
    let shot = |noise: f32, bars: &[Bar]| {
        take(&surface, &Lighting::default(), bars, &camera, &Sensor { noise, samples: 1, ..Sensor::default() })
    };
    let (clean, noisy) = (shot(0.0, &[]), shot(2.0, &[]));
    let squares: f32 = clean.iter().zip(noisy.iter()).map(|(a, b)| (f32::from(*a) - f32::from(*b)).powi(2)).sum();
    let sigma = (squares / clean.len() as f32).sqrt();
    assert!((1.8..2.3).contains(&sigma), "{sigma}");
    let bar = Bar { ends: [DVec3::new(-0.5, 0.0, 0.2), DVec3::new(0.5, 0.0, 0.2)], radius: 0.04 };
    let hidden = shot(0.0, &[bar]);
    let changed = |y: u32| (0..120).filter(|x| hidden.get_pixel(*x, y) != clean.get_pixel(*x, y)).count();
    assert!(changed(60) > 60 && changed(100) == 0, "{} {}", changed(60), changed(100));
}
