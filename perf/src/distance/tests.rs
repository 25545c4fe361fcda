//! Tests of signed distance: exact on what has a formula, and the same as by looking at every triangle.

use glam::DVec3;
use toile_base::body::{Measures, Sex};

use super::DistanceMesh;
use super::closest::{TrianglePart, closest_point};
use crate::random::CaseRandom;

/// A box from -1 to 1 with edges that meet in all ways: corners, faces in two triangles.
fn cube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corner = |k: u32| DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 }));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    ((0..8).map(corner).collect(), quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect())
}

/// Exact signed distance to that box.
fn to_cube(p: DVec3) -> f64 {
    let beyond = p.abs() - 1.0;
    beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
}

fn point(random: &mut CaseRandom, size: f64) -> DVec3 {
    random.point().as_dvec3() * size
}

#[test]
fn a_cube_has_its_distance_on_every_side_of_faces_edges_and_corners() {
    let (positions, triangles) = cube();
    let mesh = DistanceMesh::new(&positions, &triangles);
    let mut random = CaseRandom::new("cube", 1);
    for _ in 0..4_000 {
        let p = point(&mut random, 2.0);
        assert!((mesh.signed(p) - to_cube(p)).abs() < 1e-12, "{p}: {} for {}", mesh.signed(p), to_cube(p));
    }
}

#[test]
fn a_sharp_fold_keeps_its_sign_beyond_its_edge() {
    // A wedge of 5 degrees: beside its edge the nearest face alone would say inside for what is outside.
    let (sin, cos) = 5f64.to_radians().sin_cos();
    let end = |z: f64| [DVec3::new(0.0, 0.0, z), DVec3::new(1.0, 0.0, z), DVec3::new(cos, sin, z)];
    let positions = [end(-1.0), end(1.0)].concat();
    let sides = [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]];
    let mut triangles = vec![[0, 2, 1], [3, 4, 5]];
    triangles.extend(sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]));
    let mesh = DistanceMesh::new(&positions, &triangles);
    for p in [DVec3::new(-0.1, 0.05, 0.2), DVec3::new(-0.1, -0.05, 0.2), DVec3::new(-1e-3, 1e-4, 0.0)] {
        let exact = p.truncate().length();
        assert!((mesh.signed(p) - exact).abs() < 1e-12, "{p}: {}", mesh.signed(p));
    }
    assert!(mesh.signed(DVec3::new(0.9, 0.03, 0.0)) < 0.0);
}

#[test]
fn the_tree_finds_what_every_triangle_has_on_a_body() {
    let body = toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
    let positions: Vec<DVec3> = body.mesh.positions.iter().map(|p| p.as_dvec3()).collect();
    let mesh = DistanceMesh::new(&positions, &body.mesh.triangles);
    let mut random = CaseRandom::new("body", 1);
    for k in 0..60 {
        let p = positions[random.below(positions.len())] + point(&mut random, if k % 2 == 0 { 0.01 } else { 0.3 });
        let corners = body.mesh.triangles.iter().map(|t| t.map(|v| positions[v as usize]));
        let nearest = corners.map(|c| closest_point(p, c).0.distance(p)).fold(f64::INFINITY, f64::min);
        assert!((mesh.signed(p).abs() - nearest).abs() < 1e-12, "{p}: {} for {nearest}", mesh.signed(p));
    }
    for (normal, p) in body.normals.iter().zip(&positions).step_by(37) {
        let (out, into) = (mesh.signed(p + normal.as_dvec3() * 1e-4), mesh.signed(p - normal.as_dvec3() * 1e-4));
        assert!(out > 0.0 && into < 0.0, "{p}: {out}, {into}");
    }
}

#[test]
fn the_nearest_point_of_a_triangle_is_on_the_part_that_it_names() {
    let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::new(0.5, 1.0, 0.0)];
    let cases = [
        (DVec3::new(0.7, 0.3, 4.0), DVec3::new(0.7, 0.3, 0.0), TrianglePart::Inside),
        (DVec3::new(1.0, -2.0, 1.0), DVec3::X, TrianglePart::Edge(0)),
        (DVec3::new(-1.0, -1.0, 0.0), DVec3::ZERO, TrianglePart::Corner(0)),
        (DVec3::new(3.0, -0.5, 0.0), DVec3::X * 2.0, TrianglePart::Corner(1)),
        (DVec3::new(0.5, 2.0, 1.0), DVec3::new(0.5, 1.0, 0.0), TrianglePart::Corner(2)),
    ];
    for (p, q, part) in cases {
        let (found, on) = closest_point(p, corners);
        assert!(found.distance(q) < 1e-12 && on == part, "{p}: {found} {on:?}");
    }
    let mut random = CaseRandom::new("triangle", 1);
    for _ in 0..300 {
        let corners = [(); 3].map(|()| point(&mut random, 1.0));
        let p = point(&mut random, 2.0);
        let found = closest_point(p, corners).0.distance(p);
        let place = |u: usize, v: usize| {
            let [u, v] = [u, v].map(|k| k as f64 / 60.0);
            corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v * (1.0 - u)
        };
        let sampled = (0..=60).flat_map(|u| (0..=60).map(move |v| (u, v))).map(|(u, v)| place(u, v).distance(p));
        let sampled = sampled.fold(f64::INFINITY, f64::min);
        assert!(found <= sampled + 1e-12 && sampled < found + 0.05, "{found} for {sampled}");
    }
}

#[test]
fn nothing_is_infinitely_far() {
    assert_eq!(DistanceMesh::new(&[], &[]).signed(DVec3::ONE), f64::INFINITY);
}
