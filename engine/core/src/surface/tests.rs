//! Tests of surfaces: walking and looking find what a plain search in f64 finds, at every width the same.

use glam::{DVec3, Vec3, Vec3A};
use toile_bake::Shape;

use super::*;
use crate::lanes::{ReadColumn, Width};

/// A wavy sheet, and points over it.
struct Wavy {
    mesh: SurfaceMesh,
    at: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

fn wavy(rows: u32, columns: u32) -> Wavy {
    let place = |r: u32, c: u32| {
        let (x, z) = (c as f32 * 0.014, r as f32 * 0.013);
        (Vec3::new(x, 0.02 * (9.0 * x).sin() + 0.015 * (7.0 * z).cos(), z), false)
    };
    let shape = Shape::sheet(rows, columns, place);
    let triangles = shape.triangles();
    Wavy { mesh: SurfaceMesh::new(&triangles, shape.cut.len()), at: shape.cut, triangles }
}

fn columns(at: &[Vec3]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|axis| at.iter().map(|p| p[axis]).collect())
}

fn points() -> Vec<Vec3> {
    let wave = |i: u32, k: f32| (i as f32 * k).sin();
    (0..400)
        .map(|i| Vec3::new(0.2 + 0.18 * wave(i, 1.7), 0.01 + 0.05 * wave(i, 2.9), 0.18 + 0.16 * wave(i, 0.61)))
        .collect()
}

/// The square of the distance to a triangle, by trying a fine net of its edges and the projection, in f64.
fn distance2(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let edge = |a: DVec3, b: DVec3| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance_squared(a + (b - a) * t)
    };
    let n = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).cross(p - *s).dot(n) >= 0.0);
    let flat = if inside { (p - a).dot(n).powi(2) / n.length_squared() } else { f64::MAX };
    flat.min(edge(a, b)).min(edge(b, c)).min(edge(c, a))
}

fn ask(width: Width, wavy: &Wavy, points: &[Vec3], found: &mut [NearestPoint]) {
    let (surface, asking) = (columns(&wavy.at), columns(points));
    let list: Vec<u32> = (0..points.len() as u32).collect();
    width.run(FindNearest {
        mesh: &wavy.mesh,
        surface: surface.each_ref().map(|c| ReadColumn::new(c)),
        points: asking.each_ref().map(|c| ReadColumn::new(c)),
        list: &list,
        found,
    });
}

/// From the nearest vertex, as it is looked for from anew.
fn seeded(width: Width, wavy: &Wavy, points: &[Vec3]) -> Vec<NearestPoint> {
    let surface = columns(&wavy.at);
    let clusters = Clusters::new(&wavy.mesh, &wavy.at);
    let mut boxes = ClusterBoxes::new(&clusters);
    let surface = surface.each_ref().map(|c| ReadColumn::new(c));
    width.run(FillBoxes { clusters: &clusters, surface, boxes: &mut boxes });
    let look = |p: &Vec3| {
        let found =
            width.run(NearestVertex { clusters: &clusters, boxes: &boxes, surface, point: p.to_array(), within2: 1.0 });
        NearestPoint { triangle: wavy.mesh.fan(found.unwrap())[0], ..NearestPoint::default() }
    };
    points.iter().map(look).collect()
}

#[test]
fn what_is_found_is_nearest_of_all_at_every_width() {
    let (wavy, points) = (wavy(30, 32), points());
    let mut first: Option<Vec<NearestPoint>> = None;
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        let mut found = seeded(width, &wavy, &points);
        ask(width, &wavy, &points, &mut found);
        let mut wrong = 0;
        for (p, found) in points.iter().zip(&found) {
            let corners = |t: &[u32; 3]| t.map(|v| wavy.at[v as usize].as_dvec3());
            let least = wavy.triangles.iter().map(|t| distance2(p.as_dvec3(), corners(t))).fold(f64::MAX, f64::min);
            let (got, best) = (f64::from(found.distance2).sqrt(), least.sqrt());
            assert!(got > best - 1e-5, "{got} is nearer than anything is ({best})");
            wrong += usize::from(got > best + 1e-4);
            // The shares lead to a point that is so far away.
            let at = |k: usize| wavy.at[wavy.mesh.corners(found.triangle)[k] as usize];
            let q: Vec3 = (0..3).map(|k| at(k) * found.shares[k]).sum();
            assert!((q.distance(*p) - got as f32).abs() < 1e-4, "{} for {got}", q.distance(*p));
        }
        // A walk may end at a corner that is not quite the nearest point.
        assert!(wrong * 100 <= points.len(), "{wrong} of {} were not the nearest", points.len());
        assert_eq!(first.get_or_insert_with(|| found.clone()), &found, "{width} lanes give other bits");
    }
}

#[test]
fn a_walk_follows_a_point_that_moves() {
    let (wavy, mut points) = (wavy(30, 32), points());
    let mut found = seeded(Width::widest(), &wavy, &points);
    for _ in 0..20 {
        points.iter_mut().for_each(|p| *p += Vec3::new(0.004, 0.0, -0.003));
        ask(Width::widest(), &wavy, &points, &mut found);
    }
    let mut anew = seeded(Width::widest(), &wavy, &points);
    ask(Width::widest(), &wavy, &points, &mut anew);
    // Far from the sheet there are several points that no neighbour is nearer than.
    let near: Vec<_> = found.iter().zip(&anew).filter(|(_, b)| b.distance2 < 0.01 * 0.01).collect();
    let lost = near.iter().filter(|(a, b)| a.distance2.sqrt() > b.distance2.sqrt() + 1e-3).count();
    assert!(near.len() > 30 && lost * 50 <= near.len(), "{lost} of {} lost their way", near.len());
}

#[test]
fn normals_tell_front_from_back_on_faces_edges_and_corners() {
    let (wavy, points) = (wavy(30, 32), points());
    let mut found = seeded(Width::widest(), &wavy, &points);
    ask(Width::widest(), &wavy, &points, &mut found);
    let mut seen = [0; 3];
    for (p, found) in points.iter().zip(&found) {
        let feature = SurfaceMesh::feature(found.shares);
        if wavy.mesh.on_border(found.triangle, feature) {
            continue;
        }
        seen[match feature {
            Feature::Face => 0,
            Feature::Edge(_) => 1,
            Feature::Corner(_) => 2,
        }] += 1;
        let normal = wavy.mesh.normal(found.triangle, feature, |v| wavy.at[v as usize].into());
        let at = |k: usize| wavy.at[wavy.mesh.corners(found.triangle)[k] as usize];
        let q: Vec3 = (0..3).map(|k| at(k) * found.shares[k]).sum();
        // The sheet is a function of x and z, and its front looks down or up as it was wound.
        let over = p.y > 0.02 * (9.0 * p.x).sin() + 0.015 * (7.0 * p.z).cos();
        let front = normal.dot(Vec3A::from(*p - q)) > 0.0;
        let up = normal.y > 0.0;
        assert!(found.distance2 < 1e-6 || front == (over == up), "{p} {feature:?}");
    }
    assert!(seen.iter().all(|n| *n > 0), "no case of each: {seen:?}");
}

#[test]
fn borders_and_bad_triangles() {
    let mesh = SurfaceMesh::new(&[[0, 1, 2], [2, 1, 3], [1, 1, 2], [0, 9, 2]], 4);
    assert_eq!(mesh.len(), 2);
    assert_eq!(mesh.across(0)[0], 1);
    assert!((0..4).all(|v| mesh.is_border(v)));
    assert!(mesh.on_border(0, Feature::Edge(1)) && !mesh.on_border(0, Feature::Edge(0)));
    assert!(!mesh.on_border(0, Feature::Face));
    let tetrahedron = SurfaceMesh::new(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], 4);
    assert!((0..4).all(|v| !tetrahedron.is_border(v)));
}
