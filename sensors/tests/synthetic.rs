//! The synthetic sensor from mesh to recording, on a column of a known radius.

use std::time::Instant;

use glam::Vec3;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::session::{self, Session};
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};

/// Radius of the column (m), as of a torso.
const RADIUS: f32 = 0.2;

/// A column 1.7 m high with 13,200 triangles.
fn column() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (around, up) = (110u32, 60u32);
    let mut positions = Vec::new();
    for j in 0..=up {
        for i in 0..around {
            let a = i as f32 / around as f32 * std::f32::consts::TAU;
            positions.push(Vec3::new(RADIUS * a.cos(), 1.7 * j as f32 / up as f32, RADIUS * a.sin()));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..up {
        for i in 0..around {
            let k = (i + 1) % around;
            let [a, b, c, d] = [j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (positions, triangles)
}

fn seen(seed: u64) -> DepthFrame {
    let (positions, triangles) = column();
    let eye = Vec3::new(0.3, 1.2, 2.2);
    let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, eye, Vec3::new(0.0, 0.85, 0.0));
    let mut z = vec![0.0; camera.intrinsics.pixels()];
    let begin = Instant::now();
    camera.render(&positions, &triangles, &mut z);
    let rendered = Instant::now();
    let depth = KinectNoise::new(seed).apply(&camera.intrinsics, &z);
    let [render, noise] = [rendered - begin, rendered.elapsed()].map(|d| d.as_secs_f64() * 1e3);
    println!("{} triangles: render {render:.1} ms, noise {noise:.1} ms", triangles.len());
    camera.frame(0, depth)
}

#[test]
fn the_middle_of_a_column_is_seen_where_it_is_without_bias() {
    let frame = seen(1);
    let sight = (frame.camera_to_world.translation * glam::Vec3A::new(1.0, 0.0, 1.0)).normalize();
    // The part that is turned to the camera by less than 45 degrees.
    let middle: Vec<f32> = frame
        .points()
        .filter(|p| (0.1..1.6).contains(&p.y) && Vec3::from(sight).dot(*p) > 0.71 * p.x.hypot(p.z))
        .map(|p| p.x.hypot(p.z) - RADIUS)
        .collect();
    let bias = middle.iter().sum::<f32>() / middle.len() as f32;
    let sigma = (middle.iter().map(|e| (e - bias).powi(2)).sum::<f32>() / middle.len() as f32).sqrt();
    println!("{} points: bias {:.2} mm, sigma {:.2} mm", middle.len(), bias * 1e3, sigma * 1e3);
    assert!(middle.len() > 15_000 && bias.abs() < 0.001, "{bias}");
    // 6 mm along the line of sight at 2 m, seen at up to 45 degrees.
    assert!((0.003..0.008).contains(&sigma), "{sigma}");
}

#[test]
fn the_edges_are_ragged_and_the_floor_is_not_invented() {
    let frame = seen(1);
    let points = frame.valid_pixels();
    assert!((20_000..120_000).contains(&points), "{points}");
    assert!(frame.points().all(|p| p.x.hypot(p.z) < 2.0 * RADIUS && (-0.1..1.8).contains(&p.y)));
}

#[test]
fn the_same_seed_gives_the_same_recording() {
    let record = |seed| {
        let session = Session { name: "column".to_owned(), depth: vec![seen(seed)], ..Session::default() };
        session.to_bytes().unwrap()
    };
    let bytes = record(3);
    assert_eq!(bytes, record(3));
    assert_ne!(bytes, record(4));
    println!("one noisy 640x480 frame is recorded in {} bytes", bytes.len());
    assert_eq!(session::read("column", &bytes).unwrap().depth[0], seen(3));
}
