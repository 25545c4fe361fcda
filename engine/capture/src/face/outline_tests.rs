use glam::{DVec2, DVec3};
use toile_base::body::Sex;
use toile_base::numeric::random::SplitMix64;

use super::head_mesh::{HeadMesh, normals};
use super::tests::{Case, case, off};
use super::*;
use crate::depth_buffer::DepthBuffer;

/// Where the drawing of a true head ends, from above its chin over the crown to the other side, in rays from the middle of its points;
/// each point with noise.
fn outline(truth: &[DVec3], triangles: &[[u32; 3]], view: &FaceView, sigma: f64, seed: u64) -> Vec<DVec2> {
    let mut rng = SplitMix64::new(seed);
    let mut buffer = DepthBuffer::new(view.camera.size, 2.0);
    buffer.draw(&view.camera, truth, triangles);
    let count = view.points.iter().flatten().count() as f64;
    let middle = view.points.iter().flatten().sum::<DVec2>() / count;
    let drawn = |p: DVec2| {
        let p = (p + 0.5) * 2.0 - 0.5;
        buffer.triangle[p.y.round() as usize * buffer.width + p.x.round() as usize] != u32::MAX
    };
    (-50..=50)
        .filter_map(|k| {
            let (s, c) = (f64::from(k) * 2.6_f64.to_radians()).sin_cos();
            let way = DVec2::new(s, -c);
            let last = (0..1_200).rev().map(|i| 0.5 * f64::from(i)).find(|r| drawn(middle + way * *r))?;
            let noise = DVec2::new(f64::from(rng.gaussian()), f64::from(rng.gaussian())) * sigma;
            Some(middle + way * (last + 0.25) + noise)
        })
        .collect()
}

/// Cranium, cheeks and jaw where a camera sees them at a flat angle, which is where outlines are: vertices above the neck without the middle
/// of the face, with their true normals.
fn rim_region(mesh: &HeadMesh, case: &Case) -> Vec<(usize, DVec3)> {
    let middle = |p: DVec3| p.z > 0.02 && p.x.abs() < 0.045 && p.y < 0.09;
    let flat = |v: usize, normal: DVec3| {
        let way = |view: &FaceView| (view.camera.position() - case.truth[v]).normalize();
        case.views.iter().any(|view| normal.dot(way(view)).abs() < 0.3)
    };
    let all = normals(&case.truth, &mesh.triangles).into_iter().enumerate();
    all.filter(|(v, n)| mesh.share[*v] >= 1.0 && !middle(mesh.positions[*v]) && flat(*v, *n)).collect()
}

/// A head scaled about the camera until its vertices are as far off as the true ones on average: all that a photograph cannot tell.
fn as_far_as_the_truth(case: &Case, placed: &[DVec3]) -> Vec<DVec3> {
    let from = case.views[0].camera.position();
    let far = |of: &[DVec3]| case.face.iter().map(|v| of[*v].distance(from)).sum::<f64>();
    let scale = far(&case.truth) / far(placed);
    placed.iter().map(|p| from + (*p - from) * scale).collect()
}

/// Mean errors (mm), without and with outlines: of the region of the outlines across the true surface and as a distance of vertices, and
/// of the face.
fn errors(case: &mut Case, sex: Sex, seed: u64, sized: bool) -> [[f64; 3]; 2] {
    let mesh = HeadMesh::of(sex);
    let region = rim_region(&mesh, case);
    let of = |case: &Case| {
        let head = adapt(&case.views, sex).unwrap();
        let placed = if sized { as_far_as_the_truth(case, &head.placed) } else { head.placed.clone() };
        let mean = |of: &dyn Fn(&(usize, DVec3)) -> f64| 1e3 * region.iter().map(of).sum::<f64>() / region.len() as f64;
        let by = |v: usize| placed[v] - case.truth[v];
        [mean(&|(v, n)| by(*v).dot(*n).abs()), mean(&|(v, _)| by(*v).length()), off(case, &head.placed, sized)]
    };
    let without = of(case);
    for view in &mut case.views {
        view.outlines = vec![outline(&case.truth, &mesh.triangles, view, 1.0, seed)];
    }
    [without, of(case)]
}

#[test]
fn outlines_bring_cranium_cheeks_and_jaw_nearer_to_the_truth() {
    for (what, angles) in [("three", &[-35.0, 0.0, 35.0][..]), ("one", &[0.0])] {
        let mut all = Vec::new();
        for (k, sex) in [Sex::Female, Sex::Male, Sex::Female, Sex::Male].into_iter().enumerate() {
            let seed = 900 + k as u64;
            all.push(errors(&mut case(sex, seed, angles), sex, seed, angles.len() == 1));
        }
        let mean = |k: usize, j: usize| all.iter().map(|e| e[k][j]).sum::<f64>() / all.len() as f64;
        let [before, after] = [0, 1].map(|k| [mean(k, 0), mean(k, 1), mean(k, 2)]);
        println!("{what}: across, distance, face {before:.2?} mm by points, {after:.2?} with outlines; each {all:.1?}");
        assert!(after[0] < 0.7 * before[0] && after[1] < before[1] && after[2] < before[2] + 0.1, "{what}");
    }
}

#[test]
fn an_outline_of_something_else_is_refused() {
    let mut wrong = case(Sex::Female, 3, &[0.0]);
    wrong.views[0].outlines =
        vec![vec![DVec2::new(20.0, 20.0), DVec2::new(1_150.0, 20.0), DVec2::new(1_150.0, 1_500.0)]];
    let said = adapt(&wrong.views, Sex::Female).unwrap_err().to_string();
    assert!(said.contains("lie near the rim of the head") && !said.contains('\n'), "{said}");
}
