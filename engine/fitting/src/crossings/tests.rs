//! The crossing test against shapes whose crossings are known, and against all pairs one by one in whole numbers.

use glam::{DVec3, I64Vec3};
use toile_base::numeric::random::SplitMix64;

use super::mesh::unique_edges;
use super::predicate::passes_through;
use super::*;

/// A triangle on its own.
const ONE: &[[u32; 3]] = &[[0, 1, 2]];

/// A triangle in the plane y = 0.
const LEVEL: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];

/// One that stands in it, with a corner in its plane.
const UPRIGHT: [[f64; 3]; 3] = [[0.2, -1.0, 0.2], [0.2, 1.0, 0.2], [5.0, 0.0, 0.2]];

/// Crossings between two triangles.
fn between(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> Vec<Crossing> {
    CrossingTest::new(&[ONE, ONE]).between(&[&a.map(DVec3::from), &b.map(DVec3::from)])
}

/// The triangles of a sheet of `rows` x `columns` vertices, row by row.
fn sheet(rows: u32, columns: u32) -> Vec<[u32; 3]> {
    let corners = (0..rows - 1).flat_map(|i| (0..columns - 1).map(move |j| i * columns + j));
    corners.flat_map(|a| [[a, a + 1, a + columns], [a + 1, a + columns + 1, a + columns]]).collect()
}

/// Positions of a sheet, by row and column as parts of 1.
fn laid(rows: u32, columns: u32, at: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let part = |k: u32, of: u32| f64::from(k) / f64::from(of - 1);
    (0..rows * columns).map(|k| at(part(k / columns, rows), part(k % columns, columns))).collect()
}

#[test]
fn two_triangles_cross_by_an_edge_of_each() {
    let found = between(LEVEL, UPRIGHT);
    let crossing = |edge, edge_mesh| Crossing { edge, edge_mesh, triangle: 0, triangle_mesh: 1 - edge_mesh };
    assert_eq!(found, [crossing([1, 2], 0), crossing([0, 1], 1)]);
    // Whichever way round they are.
    let turned = |[a, b, c]: [[f64; 3]; 3]| [c, b, a];
    assert_eq!(between(turned(LEVEL), turned(UPRIGHT)), [crossing([0, 1], 0), crossing([1, 2], 1)]);
}

#[test]
fn parallel_sheets_do_not_cross_however_near() {
    let triangles = sheet(30, 30);
    let test = CrossingTest::new(&[&triangles, &triangles]);
    let tilted = |apart: f64| laid(30, 30, |u, v| DVec3::new(u, 0.3 * u + 0.2 * v + apart * (1.0 + v), v));
    for apart in [1e-3, 1e-9, -1e-9] {
        assert_eq!(test.between(&[&tilted(0.0), &tilted(apart)]), []);
    }
    // Leant by as little, they do, along a line that runs between two columns: set aside so that no edges meet.
    let leant = laid(30, 30, |u, v| {
        let [u, v] = [u + 0.011, v + 0.007];
        DVec3::new(u, 0.3 * u + 0.2 * v + 1e-9 * (v - 0.49), v)
    });
    let found = test.between(&[&tilted(0.0), &leant]);
    assert!(found.len() >= 2 * 29, "{}", found.len());
    let columns = found.iter().flat_map(|c| c.edge).map(|v| v % 30);
    assert!(columns.into_iter().all(|column| column == 14 || column == 15));
}

#[test]
fn touching_is_no_crossing() {
    let touching = [
        ("a corner in the interior", [[0.2, 0.0, 0.2], [0.2, 1.0, 0.2], [0.4, 1.0, 0.2]]),
        ("a corner at a corner", [[0.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]]),
        ("a corner on an edge", [[0.5, 0.0, 0.0], [0.5, 1.0, -1.0], [0.5, -1.0, -1.0]]),
        ("an edge in an edge", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        ("an edge through an edge", [[0.5, -1.0, 0.0], [0.5, 1.0, 0.0], [0.5, 0.0, -1.0]]),
        ("an edge through a corner", [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, -1.0]]),
        ("an edge in the interior", [[0.2, 0.0, 0.2], [0.4, 0.0, 0.2], [0.2, 1.0, 0.2]]),
        ("in one plane", [[0.1, 0.0, 0.1], [2.0, 0.0, 0.1], [0.1, 0.0, 2.0]]),
        ("the same", LEVEL),
        ("without area", [[0.2, 0.0, 0.2]; 3]),
    ];
    for (what, triangle) in touching {
        assert_eq!(between(LEVEL, triangle), [], "{what}");
    }
}

#[test]
fn a_strip_that_is_folded_through_itself_crosses_there_only() {
    let triangles = sheet(41, 4);
    let test = CrossingTest::new(&[&triangles]);
    // A curve that closes a loop where its parameter is 1 and -1, drawn out along z to a strip.
    let strip = |curve: fn(f64) -> [f64; 2]| {
        laid(41, 4, move |u, v| {
            let [x, y] = curve(3.0 * u - 1.5);
            DVec3::new(x, y, 0.5 * v + 0.01 * u)
        })
    };
    let found = test.within(0, &strip(|t| [t * t, t * t * t - t]));
    assert!(!found.is_empty());
    let parameter = |vertex: u32| 3.0 * f64::from(vertex / 4) / 40.0 - 1.5;
    for crossing in &found {
        let triangle = triangles[crossing.triangle as usize];
        let [edge, triangle] = [parameter(crossing.edge[0]), parameter(triangle[0])];
        assert!((edge.abs() - 1.0).abs() < 0.1 && (triangle.abs() - 1.0).abs() < 0.1, "{crossing:?}");
        assert!(edge * triangle < 0.0, "{crossing:?}");
    }
    // Flat, and folded back to 1 mm from itself.
    assert_eq!(test.within(0, &strip(|t| [t, 0.0])), []);
    assert_eq!(test.within(0, &strip(|t| [t.abs(), if t < 0.0 { 0.0 } else { 1e-3 }])), []);
}

#[test]
fn what_shares_a_vertex_is_left_out_and_the_opposite_edge_is_not() {
    // Two triangles of one mesh at one vertex; the edge opposite of it passes through the other triangle.
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.3, -0.5, 0.3], [0.3, 0.5, 0.3]];
    let positions = positions.map(DVec3::from);
    let test = CrossingTest::new(&[&[[0, 1, 2], [0, 3, 4]]]);
    let expected = Crossing { edge: [3, 4], edge_mesh: 0, triangle: 0, triangle_mesh: 0 };
    assert_eq!(test.within(0, &positions), [expected]);
    // The same with both at vertices of the edge itself: nothing is left that could cross.
    let test = CrossingTest::new(&[&[[3, 1, 2], [0, 3, 4]]]);
    assert_eq!(test.within(0, &positions), []);
    // In two meshes the same numbers are other vertices.
    let apart = CrossingTest::new(&[&[[0, 1, 2]], &[[0, 3, 4]]]);
    assert_eq!(apart.between(&[&positions, &positions]).len(), 1);
}

/// A mesh in whole numbers.
type WholeMesh = (Vec<[u32; 3]>, Vec<I64Vec3>);

/// Whole numbers by which lengths of 1 m are drawn.
const PER_M: f64 = 128.0;

/// Triangles at random with corners on the whole numbers: many pairs touch, lie in one plane or have no area. Centres in
/// a box of `size`, corners in one of `extent` about them; one corner of four is another triangle's.
fn soup(random: &mut SplitMix64, triangles: u32, size: usize, extent: usize) -> WholeMesh {
    let mut point = |size: usize| I64Vec3::from([(); 3].map(|()| random.below(size) as i64 - size as i64 / 2));
    let corners = (0..triangles).map(|_| point(size)).collect::<Vec<_>>();
    let positions = corners.iter().flat_map(|&centre| [centre; 3]).map(|centre| centre + point(extent)).collect();
    let mut corner = |own: u32| match random.below(4) {
        0 => random.below(3 * triangles as usize) as u32,
        _ => own,
    };
    ((0..triangles).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(&mut corner)).collect(), positions)
}

fn metres(positions: &[I64Vec3]) -> Vec<DVec3> {
    positions.iter().map(|p| p.as_dvec3() / PER_M).collect()
}

/// On which side of the plane through a, b, c a point lies, in whole numbers.
fn whole_side(a: I64Vec3, b: I64Vec3, c: I64Vec3, d: I64Vec3) -> i128 {
    let [u, v, w] = [a, b, c].map(|p| (p - d).to_array().map(i128::from));
    let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
    (u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)).signum()
}

fn whole_passes_through([p, q]: [I64Vec3; 2], [a, b, c]: [I64Vec3; 3]) -> bool {
    let ends = whole_side(a, b, c, p) * whole_side(a, b, c, q);
    let sides = || whole_side(p, q, a, b) + whole_side(p, q, b, c) + whole_side(p, q, c, a);
    ends == -1 && sides().abs() == 3
}

/// All crossings of the edges of a mesh with the triangles of another or the same, every edge with every triangle.
fn all_pairs(meshes: &[WholeMesh], edge_mesh: usize, triangle_mesh: usize) -> Vec<Crossing> {
    let (edges, ends) = (unique_edges(&meshes[edge_mesh].0), &meshes[edge_mesh].1);
    let (triangles, corners) = &meshes[triangle_mesh];
    let mut found = Vec::new();
    for edge in edges {
        for (triangle, vertices) in (0..).zip(triangles) {
            let segment = edge.map(|v| ends[v as usize]);
            if whole_passes_through(segment, vertices.map(|v| corners[v as usize])) {
                found.push(Crossing { edge, edge_mesh, triangle, triangle_mesh });
            }
        }
    }
    found
}

#[test]
fn the_grid_finds_what_all_pairs_have_in_the_same_order() {
    for (size, extent, seeds) in [(6, 6, 4), (40, 6, 4), (2_000, 60, 2), (1_000, 1_000, 2)] {
        for seed in 0..seeds {
            let mut random = SplitMix64::new(seed);
            let meshes = [(); 3].map(|()| soup(&mut random, 160, size, extent));
            let positions = meshes.each_ref().map(|mesh| metres(&mesh.1));
            let test = CrossingTest::new(&meshes.each_ref().map(|mesh| mesh.0.as_slice()));
            let pairs = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];
            let expected: Vec<Crossing> = pairs.iter().flat_map(|&(e, t)| all_pairs(&meshes, e, t)).collect();
            assert!(expected.len() > 100, "{size} {extent} {seed}: {}", expected.len());
            assert_eq!(test.between(&positions.each_ref().map(Vec::as_slice)), expected);
            for (mesh, positions) in positions.iter().enumerate() {
                assert_eq!(test.within(mesh, positions), all_pairs(&meshes, mesh, mesh));
            }
        }
    }
}

#[test]
fn signs_are_exact_where_rounding_loses_them() {
    let mut random = SplitMix64::new(1);
    let (mut crossings, mut lost) = (0, 0);
    for _ in 0..20_000 {
        let mut point = |size: usize| I64Vec3::from([(); 3].map(|()| random.below(2 * size + 1) as i64 - size as i64));
        // Corners within 2 units of a line of 10^11, and a segment of some units through its middle.
        let (from, along) = (point(100_000_000_000), point(10_000_000_000));
        let corners = [-2, 1, 2].map(|k| from + along * k + point(3));
        let ends = [from + point(3), from + point(3)];
        let expected = whole_passes_through(ends, corners);
        let [p, q] = ends.map(|p| p.as_dvec3());
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        assert_eq!(passes_through([p, q], [a, b, c]), expected, "{ends:?} {corners:?}");
        let rounded = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (a - d).dot((b - d).cross(c - d));
        let ends = rounded(a, b, c, p) * rounded(a, b, c, q);
        let sides = [rounded(p, q, a, b), rounded(p, q, b, c), rounded(p, q, c, a)];
        let plain = ends < 0.0 && (sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0));
        crossings += usize::from(expected);
        lost += usize::from(plain != expected);
    }
    assert!(crossings > 100 && lost > 100, "{crossings} crossings, {lost} lost by rounding");
}

#[test]
fn the_same_is_found_again_in_the_order_of_meshes_edges_and_triangles() {
    let mut random = SplitMix64::new(1);
    let meshes = [(); 2].map(|()| soup(&mut random, 300, 40, 12));
    let positions = meshes.each_ref().map(|mesh| metres(&mesh.1));
    let positions = positions.each_ref().map(Vec::as_slice);
    let new = || CrossingTest::new(&meshes.each_ref().map(|mesh| mesh.0.as_slice()));
    let test = new();
    let found = test.between(&positions);
    assert_eq!(test.between(&positions), found);
    assert_eq!(new().between(&positions), found);
    let place = |c: &Crossing| (c.edge_mesh, c.triangle_mesh, c.edge, c.triangle);
    assert!(found.len() > 100 && found.windows(2).all(|w| place(&w[0]) < place(&w[1])));
}

#[test]
fn vertices_that_cannot_be_tested_take_nothing_but_their_own_crossings() {
    let mut random = SplitMix64::new(1);
    let meshes = [(); 2].map(|()| soup(&mut random, 200, 30, 12));
    let test = CrossingTest::new(&meshes.each_ref().map(|mesh| mesh.0.as_slice()));
    let [first, second] = meshes.each_ref().map(|mesh| metres(&mesh.1));
    let (between, within) = (test.between(&[&first, &second]), test.within(0, &first));
    let vertices = |c: &Crossing| (c.edge, meshes[c.triangle_mesh].0[c.triangle as usize]);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        let mut broken = first.clone();
        (0..broken.len()).step_by(5).for_each(|v| broken[v][v % 3] = bad);
        let whole = |c: &Crossing| {
            let (edge, triangle) = vertices(c);
            let is_bad = |v: &u32| v.is_multiple_of(5);
            (c.edge_mesh == 1 || !edge.iter().any(is_bad)) && (c.triangle_mesh == 1 || !triangle.iter().any(is_bad))
        };
        let left = |of: &[Crossing]| of.iter().filter(|c| whole(c)).copied().collect::<Vec<_>>();
        assert_eq!(test.between(&[&broken, &second]), left(&between));
        assert_eq!(test.within(0, &broken), left(&within));
        let untested = meshes[0].0.iter().filter(|t| t.iter().any(|v| v % 5 == 0)).count();
        assert_eq!(test.untested(&[&broken, &second]), untested);
    }
    let nowhere = vec![DVec3::NAN; first.len()];
    assert_eq!(test.between(&[&nowhere, &second]), []);
    assert_eq!(test.within(0, &nowhere), []);
}

#[test]
fn vertices_that_are_torn_far_away_hide_no_other_crossing() {
    let mut random = SplitMix64::new(1);
    let mut meshes = [(); 2].map(|()| soup(&mut random, 200, 60, 12));
    // Up to 2^31 m away, by 3 vertices of 20.
    for v in (0..meshes[0].1.len()).filter(|v| v % 20 < 3) {
        meshes[0].1[v] = meshes[0].1[v] * (1 << (v % 32)) + I64Vec3::splat(v as i64);
    }
    let test = CrossingTest::new(&meshes.each_ref().map(|mesh| mesh.0.as_slice()));
    let [first, second] = meshes.each_ref().map(|mesh| metres(&mesh.1));
    let expected = [all_pairs(&meshes, 0, 1), all_pairs(&meshes, 1, 0)].concat();
    assert_eq!(test.between(&[&first, &second]), expected);
    assert_eq!(test.within(0, &first), all_pairs(&meshes, 0, 0));
}

#[test]
fn nothing_crosses_nothing() {
    let test = CrossingTest::new(&[&[], ONE, &[[0, 0, 1], [2, 2, 2]]]);
    let triangle = LEVEL.map(DVec3::from);
    assert_eq!(test.between(&[&[], &triangle, &triangle]), []);
    assert_eq!((test.within(0, &[]), test.within(2, &[DVec3::ONE; 3])), (vec![], vec![]));
    assert_eq!(CrossingTest::new(&[]).between(&[]), []);
}

#[test]
#[should_panic(expected = "give all vertices")]
fn positions_that_are_missing_are_refused() {
    CrossingTest::new(&[ONE]).within(0, &[DVec3::ZERO; 2]);
}

#[test]
#[should_panic(expected = "give one list each")]
fn meshes_that_are_missing_are_refused() {
    CrossingTest::new(&[ONE, ONE]).between(&[&[DVec3::ZERO; 3]]);
}
