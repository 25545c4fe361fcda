//! Meshes for the tests of baking: grids, tubes, and irregular triangle meshes by Delaunay's rule.

use std::f32::consts::TAU;

use glam::{DVec2, Vec2, Vec3};

use crate::shape::{Face, NO_VERTEX};
use toile_base::numeric::random::SplitMix64;

/// Positions (m) and faces.
pub type TestMesh = (Vec<Vec3>, Vec<Face>);

/// A tube of `columns` and `rows` of quads as large as they are wide, radius 1.
pub fn tube(columns: u32, rows: u32) -> TestMesh {
    let at = |r: u32, c: u32| r * columns + c % columns;
    let point = |r: u32, c: u32| {
        let a = TAU * c as f32 / columns as f32;
        Vec3::new(a.sin(), -(r as f32) * TAU / columns as f32, a.cos())
    };
    let positions = (0..rows).flat_map(|r| (0..columns).map(move |c| point(r, c))).collect();
    let face = |r, c| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)];
    (positions, (0..rows - 1).flat_map(|r| (0..columns).map(move |c| face(r, c))).collect())
}

/// A hanging sheet of quads, `width` by `height` each.
pub fn sheet(columns: u32, rows: u32, width: f32, height: f32) -> TestMesh {
    let at = |r: u32, c: u32| r * columns + c;
    let point = |r: u32, c: u32| Vec3::new(c as f32 * width, -(r as f32) * height, 0.0);
    let positions = (0..rows).flat_map(|r| (0..columns).map(move |c| point(r, c))).collect();
    let face = |r, c| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)];
    (positions, (0..rows - 1).flat_map(|r| (0..columns - 1).map(move |c| face(r, c))).collect())
}

/// The quads of a mesh split in two, all the same way or in turn.
pub fn split((positions, faces): TestMesh, in_turn: bool) -> TestMesh {
    let halves = |(i, f): (usize, Face)| {
        let [a, b, c, d] = f;
        if in_turn && i % 2 == 1 {
            [[a, b, d, NO_VERTEX], [b, c, d, NO_VERTEX]]
        } else {
            [[a, b, c, NO_VERTEX], [a, c, d, NO_VERTEX]]
        }
    };
    (positions, faces.into_iter().enumerate().flat_map(halves).collect())
}

/// Scattered points with about `spacing` between neighbours, in a rectangle; its sides have points on them.
pub fn scatter(width: f64, height: f64, spacing: f64, seed: u64) -> Vec<DVec2> {
    let (across, down) = ((width / spacing).round().max(1.0), (height / spacing).round().max(1.0));
    let mut points = Vec::new();
    let side = |k: usize, n: f64, length: f64| length * k as f64 / n;
    for k in 0..=across as usize {
        points.extend([DVec2::new(side(k, across, width), 0.0), DVec2::new(side(k, across, width), height)]);
    }
    for k in 1..down as usize {
        points.extend([DVec2::new(0.0, side(k, down, height)), DVec2::new(width, side(k, down, height))]);
    }
    let mut random = SplitMix64::new(seed);
    // Dart throwing: a point is kept if none lies nearer than the least distance.
    for _ in 0..(40.0 * across * down) as usize {
        let p = DVec2::new(random.uniform_f64() * width, random.uniform_f64() * height);
        if points.iter().all(|q| q.distance(p) > 0.75 * spacing) {
            points.push(p);
        }
    }
    points
}

/// Delaunay's triangulation (Bowyer and Watson 1981), counter-clockwise.
pub fn delaunay(points: &[DVec2]) -> Vec<[u32; 3]> {
    let n = points.len() as u32;
    let mut all = points.to_vec();
    all.extend([DVec2::new(-1e4, -1e4), DVec2::new(1e4, -1e4), DVec2::new(0.0, 1e4)]);
    let mut triangles = vec![[n, n + 1, n + 2]];
    for i in 0..n {
        let (bad, kept): (Vec<_>, Vec<_>) = triangles.into_iter().partition(|t| in_circle(&all, *t, all[i as usize]));
        let sides = bad.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect::<Vec<_>>();
        triangles = kept;
        let rim = sides.iter().filter(|(a, b)| !sides.contains(&(*b, *a)));
        triangles.extend(rim.map(|&(a, b)| [a, b, i]));
    }
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| all[i as usize]);
        (b - a).perp_dot(c - a)
    };
    triangles.retain(|t| t.iter().all(|&i| i < n) && area(t) > 1e-9);
    triangles
}

fn in_circle(points: &[DVec2], t: [u32; 3], p: DVec2) -> bool {
    let [a, b, c] = t.map(|i| points[i as usize] - p);
    let lift = |v: DVec2| v.length_squared();
    lift(a) * b.perp_dot(c) + lift(b) * c.perp_dot(a) + lift(c) * a.perp_dot(b) > 1e-12
}

/// A mesh of a triangulation laid into space.
pub fn laid(points: &[DVec2], triangles: &[[u32; 3]], place: impl Fn(Vec2) -> Vec3) -> TestMesh {
    let faces = triangles.iter().map(|&[a, b, c]| [a, b, c, NO_VERTEX]).collect();
    (points.iter().map(|p| place(p.as_vec2())).collect(), faces)
}

/// An irregular sheet that hangs in the x-y plane from y = 0.
pub fn rough_sheet(width: f64, height: f64, spacing: f64, seed: u64) -> TestMesh {
    let points = scatter(width, height, spacing, seed);
    laid(&points, &delaunay(&points), |p| Vec3::new(p.x, p.y - height as f32, 0.0))
}

/// An irregular skirt: a cone from radius 0.18 m at the waist (y = 0) to 0.42 m, 0.78 m below, closed.
pub fn rough_skirt(spacing: f64, seed: u64) -> TestMesh {
    let (inner, outer) = (0.18, 0.42);
    let mut random = SplitMix64::new(seed);
    let mut points: Vec<DVec2> = Vec::new();
    for r in [inner, outer] {
        let n = (std::f64::consts::TAU * r / spacing).round() as usize;
        points.extend((0..n).map(|k| DVec2::from_angle(std::f64::consts::TAU * k as f64 / n as f64) * r));
    }
    let slope = 0.78 / (outer - inner);
    let lift = |p: DVec2| glam::DVec3::new(p.x, -(p.length() - inner) * slope, p.y);
    for _ in 0..(60.0 / spacing / spacing) as usize {
        let r = inner + (outer - inner) * random.uniform_f64();
        let p = DVec2::from_angle(std::f64::consts::TAU * random.uniform_f64()) * r;
        if points.iter().all(|q| lift(*q).distance(lift(p)) > 0.75 * spacing) {
            points.push(p);
        }
    }
    // Delaunay's rule is applied in the plane that the cone is mapped to without changing angles: radius to the power of
    // the cone's slant over its radius.
    let power = (outer - inner).hypot(0.78) / (outer - inner);
    let flat: Vec<DVec2> = points.iter().map(|p| p.normalize() * (p.length() / inner).powf(power)).collect();
    let in_hole = |t: &[u32; 3]| t.iter().all(|&i| flat[i as usize].length() < 1.0 + 1e-6);
    let triangles: Vec<[u32; 3]> = delaunay(&flat).iter().filter(|t| !in_hole(t)).map(|&[a, b, c]| [a, c, b]).collect();
    laid(&points, &triangles, |p| {
        let r = p.length();
        Vec3::new(p.x, -(r - inner as f32) * slope as f32, p.y)
    })
}

/// The same mesh under other numbers: vertex i becomes `order[i]`; faces come in another order and begin elsewhere.
pub fn renumbered((positions, faces): &TestMesh, seed: u64) -> (TestMesh, Vec<u32>) {
    let mut random = SplitMix64::new(seed);
    let mut shuffle = |n: usize| {
        let mut order: Vec<u32> = (0..n as u32).collect();
        (1..n).for_each(|i| order.swap(i, (random.uniform_f64() * (i + 1) as f64) as usize));
        order
    };
    let order = shuffle(positions.len());
    let mut moved = vec![Vec3::ZERO; positions.len()];
    order.iter().zip(positions).for_each(|(&to, p)| moved[to as usize] = *p);
    let name = |i: u32| if i == NO_VERTEX { i } else { order[i as usize] };
    let turned = |f: &Face| if f[3] == NO_VERTEX { [f[1], f[2], f[0], NO_VERTEX] } else { *f };
    let mixed = shuffle(faces.len()).into_iter().map(|f| turned(&faces[f as usize]).map(name)).collect();
    ((moved, mixed), order)
}
