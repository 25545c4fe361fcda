//! What fibers must be, on meshes of every kind.

use std::collections::BTreeSet;

use glam::Quat;
use proptest::prelude::*;

use super::*;
use crate::check;
use crate::tests::meshes::{TestMesh, renumbered, rough_sheet, rough_skirt, sheet, split, tube};
use toile_base::numeric::random::SplitMix64;

fn traced((positions, faces): &TestMesh) -> (Vec<Edge>, Vec<Fiber>) {
    check::check(positions, faces).unwrap();
    let edges = edges(positions, faces);
    let fibers = trace(positions, &edges);
    (edges, fibers)
}

fn of(fibers: &[Fiber], direction: Direction) -> Vec<&Fiber> {
    fibers.iter().filter(|f| f.direction == direction).collect()
}

/// Checks the rules of any mesh: every edge once, connected chains, no crossing within a direction.
fn follows_the_rules(mesh: &TestMesh) -> (Vec<Edge>, Vec<Fiber>) {
    let (edges, fibers) = traced(mesh);
    let mut met = vec![0; edges.len()];
    for fiber in &fibers {
        assert_eq!(fiber.vertices.len(), fiber.edges.len() + 1);
        for (k, &e) in fiber.edges.iter().enumerate() {
            met[e as usize] += 1;
            let (a, b) = (fiber.vertices[k], fiber.vertices[k + 1]);
            assert_eq!((a.min(b), a.max(b)), (edges[e as usize].a, edges[e as usize].b));
        }
        let distinct: BTreeSet<u32> = fiber.vertices.iter().copied().collect();
        assert_eq!(distinct.len(), fiber.vertices.len() - usize::from(fiber.is_hoop()), "{fiber:?}");
    }
    assert!(met.iter().all(|&m| m == 1), "an edge is in no fiber or in two");
    for direction in [Direction::Warp, Direction::Weft] {
        // A warp fiber may begin at a vertex of the one that it hangs from; besides, none meets another.
        let mut through = vec![0; mesh.0.len()];
        for fiber in of(&fibers, direction) {
            let begins = usize::from(fiber.is_hoop() || direction == Direction::Warp);
            fiber.vertices[begins..].iter().for_each(|&v| through[v as usize] += 1);
        }
        assert!(through.iter().all(|&n| n <= 1), "two {direction:?} fibers cross");
    }
    assert_eq!(Coverage::of(&fibers, &vec![false; mesh.0.len()]).edges, edges.len());
    (edges, fibers)
}

/// Fibers by their vertices, whatever their numbers, order and sense.
fn names(fibers: &[Fiber], name: impl Fn(u32) -> u32) -> BTreeSet<(Direction, Vec<u32>)> {
    let one = |fiber: &Fiber| {
        let mut line: Vec<u32> = fiber.vertices.iter().map(|&v| name(v)).collect();
        if fiber.is_hoop() {
            line.pop();
            let least = (0..line.len()).min_by_key(|&k| line[k]).unwrap();
            line.rotate_left(least);
            if line[1] > line[line.len() - 1] {
                line[1..].reverse();
            }
        } else if line[0] > line[line.len() - 1] {
            line.reverse();
        }
        (fiber.direction, line)
    };
    fibers.iter().map(one).collect()
}

#[test]
fn a_tube_has_one_fiber_a_column_and_one_hoop_a_row() {
    let quads = tube(12, 5);
    for mesh in [quads.clone(), split(quads.clone(), false), split(quads, true)] {
        let (edges, fibers) = follows_the_rules(&mesh);
        let warp = of(&fibers, Direction::Warp);
        assert_eq!(warp.len(), 12);
        assert!(warp.iter().all(|f| f.edges.len() == 4));
        assert!(warp.iter().all(|f| f.vertices.iter().all(|v| v % 12 == f.vertices[0] % 12)));
        let weft = of(&fibers, Direction::Weft);
        assert_eq!(weft.len(), 5);
        assert!(weft.iter().all(|f| f.edges.len() == 12 && f.is_hoop()));
        assert!(weft.iter().all(|f| f.vertices.iter().all(|v| v / 12 == f.vertices[0] / 12)));
        let threads = edges.iter().filter(|e| e.direction != Direction::Bias).count();
        assert_eq!(threads, 12 * 4 + 12 * 5);
    }
}

#[test]
fn a_sheet_has_one_fiber_a_column_and_one_a_row_even_where_cells_are_long() {
    for (width, height) in [(1.0, 1.0), (1.0, 0.4), (0.3, 1.0)] {
        for mesh in [
            sheet(7, 6, width, height),
            split(sheet(7, 6, width, height), false),
            split(sheet(7, 6, width, height), true),
        ] {
            let (_, fibers) = follows_the_rules(&mesh);
            let (warp, weft) = (of(&fibers, Direction::Warp), of(&fibers, Direction::Weft));
            assert_eq!((warp.len(), weft.len()), (7, 6), "{width} x {height}");
            assert!(warp.iter().all(|f| f.vertices.iter().all(|v| v % 7 == f.vertices[0] % 7)));
            assert!(weft.iter().all(|f| f.vertices.iter().all(|v| v / 7 == f.vertices[0] / 7)));
        }
    }
}

#[test]
fn inner_threads_of_a_grid_are_one_cell_wide() {
    let cell = std::f32::consts::TAU / 64.0;
    for mesh in [tube(64, 5), split(tube(64, 5), false)] {
        let rim = |e: &Edge| e.direction == Direction::Weft && (e.a < 64 || e.a >= 4 * 64);
        let threads = edges(&mesh.0, &mesh.1).into_iter().filter(|e| e.direction != Direction::Bias && !rim(e));
        threads.for_each(|e| assert!((e.width / cell - 1.0).abs() < 0.01, "{e:?}"));
    }
}

#[test]
fn fixed_links_are_cut_out_and_pieces_start_at_the_pin() {
    let fiber = Fiber { direction: Direction::Warp, vertices: vec![0, 1, 2, 3, 4], edges: vec![0, 1, 2, 3] };
    let pieces = fiber.split_at_pins(&[false, false, false, true, true]);
    assert_eq!(pieces.len(), 1);
    assert_eq!(pieces[0].vertices, [3, 2, 1, 0]);
    assert_eq!(pieces[0].edges, [2, 1, 0]);
    assert!(fiber.split_at_pins(&[true; 5]).is_empty());
}

#[test]
fn a_hoop_with_pins_is_cut_at_the_pins_alone() {
    let hoop = Fiber { direction: Direction::Weft, vertices: vec![0, 1, 2, 3, 0], edges: vec![0, 1, 2, 3] };
    assert_eq!(hoop.split_at_pins(&[false; 4]), std::slice::from_ref(&hoop));
    let pieces = hoop.split_at_pins(&[false, true, true, false]);
    assert_eq!(pieces.len(), 1, "the piece runs on over where the hoop began: {pieces:?}");
    assert_eq!(pieces[0].vertices, [2, 3, 0, 1]);
    assert_eq!(pieces[0].edges, [2, 3, 0]);
}

#[test]
fn the_same_cloth_has_the_same_fibers_whatever_its_numbers() {
    for mesh in [rough_sheet(0.8, 0.7, 0.05, 4), rough_skirt(0.06, 5), tube(12, 5), split(tube(16, 7), false)] {
        let expected = names(&traced(&mesh).1, |v| v);
        for seed in 1..4 {
            let (other, order) = renumbered(&mesh, seed);
            let mut back = vec![0; order.len()];
            order.iter().enumerate().for_each(|(from, &to)| back[to as usize] = from as u32);
            assert!(names(&traced(&other).1, |v| back[v as usize]) == expected);
        }
    }
}

/// Which share of the warp fibers two tracings have in common; of the weft as many edges must be covered.
fn alike(one: &TestMesh, other: &TestMesh) -> f32 {
    let found = [one, other].map(|mesh| traced(mesh).1);
    let covered = |f: &Vec<Fiber>| of(f, Direction::Weft).iter().map(|f| f.edges.len()).sum::<usize>();
    assert!(covered(&found[0]).abs_diff(covered(&found[1])) <= covered(&found[0]) / 50);
    let [one, other] = found.map(|f| names(&of(&f, Direction::Warp).into_iter().cloned().collect::<Vec<_>>(), |v| v));
    one.intersection(&other).count() as f32 / one.len().max(other.len()) as f32
}

#[test]
fn turning_mirroring_and_moving_change_nothing() {
    // In an irregular mesh rounding decides where two edges are as good; a quarter turn does not round.
    for (mesh, least) in [(rough_sheet(0.8, 0.7, 0.05, 6), 0.9), (rough_skirt(0.06, 7), 0.9), (tube(12, 5), 1.0)] {
        let with =
            |place: &dyn Fn(Vec3) -> Vec3| (mesh.0.iter().map(|&p| place(p)).collect::<Vec<_>>(), mesh.1.clone());
        let quarter = with(&|p| Vec3::new(p.z, p.y, -p.x));
        assert_eq!(alike(&mesh, &quarter), 1.0);
        let turn = Quat::from_rotation_y(0.7);
        let turned = alike(&mesh, &with(&|p| turn * p + Vec3::new(0.3, 1.0, -2.0)));
        assert!(turned >= least, "turned: {turned}");
        let inside_out = |f: &Face| if f[3] == u32::MAX { [f[0], f[2], f[1], f[3]] } else { [f[1], f[0], f[3], f[2]] };
        let (positions, faces) = with(&|p| Vec3::new(-p.x, p.y, p.z));
        let mirrored = alike(&mesh, &(positions, faces.iter().map(inside_out).collect()));
        assert!(mirrored >= least, "mirrored: {mirrored}");
    }
}

#[test]
fn nearly_all_of_an_irregular_mesh_hangs_by_long_fibers() {
    for (name, mesh, longest) in [("sheet", rough_sheet(1.0, 1.0, 0.04, 2), 15), ("skirt", rough_skirt(0.04, 3), 12)] {
        let (edges, fibers) = follows_the_rules(&mesh);
        let fixed: Vec<bool> = mesh.0.iter().map(|p| p.y > -0.001).collect();
        let found = Coverage::of(&fibers, &fixed);
        eprintln!("{name}: {found:?}, {:.3} hang", found.hanging_share());
        assert!(found.hanging_share() > 0.97, "{name}: {found:?}");
        assert!(found.longest >= longest, "{name}: {found:?}");
        assert!(found.warp > edges.len() / 4 && found.weft + found.hoops > edges.len() / 5, "{name}: {found:?}");
    }
}

#[test]
fn a_flat_ring_takes_the_warp_that_it_is_given() {
    // Cut as a flat ring, worn as a skirt: the warp is found on the skirt and carried to the ring.
    let (worn, faces) = split(tube(24, 6), true);
    let cut: Vec<Vec3> = worn.iter().map(|p| Vec3::new(p.x, 0.0, p.z) * (1.0 - p.y)).collect();
    let warp = warp::carried(&worn, &cut, &faces, &warp::steepest(&worn, &faces));
    for (face, warp) in faces.iter().zip(&warp) {
        let middle: Vec3 = face[..3].iter().map(|&v| cut[v as usize]).sum();
        assert!(warp.is_normalized() && warp.dot(middle.normalize()) > 0.97, "{warp}");
    }
    let edges = edges_along(&cut, &faces, &warp);
    let fibers = trace(&cut, &edges);
    assert_eq!(of(&fibers, Direction::Warp).len(), 24);
    assert!(of(&fibers, Direction::Weft).iter().all(|f| f.is_hoop()));
}

#[test]
fn a_flat_face_goes_on_as_its_neighbours_do() {
    // A table cloth: the top lies flat, one side hangs; and a sheet that lies flat altogether.
    let (mut positions, faces) = split(sheet(5, 7, 0.1, 0.1), false);
    for p in &mut positions {
        *p = if p.y < -0.35 { *p } else { Vec3::new(p.x, -0.35, -0.35 - p.y) };
    }
    let warp = warp::steepest(&positions, &faces);
    assert!(warp.iter().all(|w| w.is_normalized()));
    let flat: Vec<Vec3> = sheet(5, 7, 0.1, 0.1).0.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect();
    assert!(warp[0].dot(Vec3::Z) > 0.9 || warp[0].dot(Vec3::NEG_Z) > 0.9, "{}", warp[0]);
    let lying = warp::steepest(&flat, &faces);
    assert!(lying.iter().all(|w| w.is_normalized() && w.y.abs() < 1e-6), "{lying:?}");
}

#[test]
fn patterns_give_their_warp_by_their_texture() {
    let (positions, faces) = split(sheet(6, 6, 0.1, 0.1), false);
    // The pattern lies turned by a fifth of a turn: v runs along (sin, cos).
    let axis = Vec2::from_angle(1.2);
    let uv =
        |v: u32| Vec2::new(axis.perp_dot(positions[v as usize].truncate()), axis.dot(positions[v as usize].truncate()));
    let uvs: Vec<[Vec2; 4]> = faces.iter().map(|f| [uv(f[0]), uv(f[1]), uv(f[2]), Vec2::ZERO]).collect();
    let fallback = warp::steepest(&positions, &faces);
    for warp in warp::from_uvs(&positions, &faces, &uvs, &fallback) {
        assert!((warp + axis.extend(0.0)).length() < 1e-4, "{warp}");
    }
    assert!(warp::is_pattern(&positions, &faces, &uvs));
    let shape = Shape { cut: positions.clone(), faces: faces.clone(), uvs: uvs.clone(), ..Shape::default() };
    let downwards = |edges: &[Edge]| edges.iter().filter(|e| e.direction == Direction::Warp).count();
    let by_pattern = edges_of(&shape);
    // A fifth of a turn: the diagonals of the cells are no nearer to the threads than their sides were.
    assert!(by_pattern != edges(&positions, &faces) && downwards(&by_pattern) > 0);
    // Squeezed to fill a square, or missing, it is no pattern.
    let squeezed: Vec<[Vec2; 4]> = uvs.iter().map(|uv| uv.map(|p| p * Vec2::new(1.0, 2.0))).collect();
    assert!(!warp::is_pattern(&positions, &faces, &squeezed) && !warp::is_pattern(&positions, &faces, &[]));
    assert_eq!(edges_of(&Shape { uvs: squeezed, ..shape }), edges(&positions, &faces));
    let nothing = vec![[Vec2::ZERO; 4]; faces.len()];
    assert!(!warp::is_pattern(&positions, &faces, &nothing));
    assert_eq!(warp::from_uvs(&positions, &faces, &nothing, &fallback), fallback);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_edge_is_in_one_fiber_and_no_fibers_of_a_direction_cross(
        seed in 1u64..1_000_000, width in 0.2f64..0.8, height in 0.2f64..0.8, tilt in -1.6f32..1.6, turn in 0f32..6.3,
    ) {
        let (mut positions, faces) = rough_sheet(width, height, 0.07, seed);
        let rotation = Quat::from_rotation_y(turn) * Quat::from_rotation_x(tilt);
        positions.iter_mut().for_each(|p| *p = rotation * *p);
        follows_the_rules(&(positions, faces));
    }

    #[test]
    fn crumpled_cloth_is_traced_as_lawfully(seed in 1u64..1_000_000) {
        let (mut positions, faces) = split(sheet(9, 9, 0.05, 0.05), seed % 2 == 0);
        let mut random = SplitMix64::new(seed);
        let mut jolt = || (random.uniform_f64() as f32 - 0.5) * 0.06;
        positions.iter_mut().for_each(|p| *p += Vec3::new(jolt(), jolt(), jolt()));
        if check::check(&positions, &faces).is_ok() {
            follows_the_rules(&(positions, faces));
        }
    }
}

/// How many sets without a common vertex first fit needs for the fibers of one direction, long ones first.
fn sets(fibers: &[Fiber], direction: Direction) -> usize {
    let mut all = of(fibers, direction);
    all.sort_by_key(|f| std::cmp::Reverse(f.vertices.len()));
    let mut sets: Vec<BTreeSet<u32>> = Vec::new();
    for fiber in all {
        let vertices: BTreeSet<u32> = fiber.vertices.iter().copied().collect();
        match sets.iter_mut().find(|s| s.is_disjoint(&vertices)) {
            Some(set) => set.extend(vertices),
            None => sets.push(vertices),
        }
    }
    sets.len()
}

#[test]
fn few_sets_hold_all_fibers() {
    for mesh in [rough_sheet(1.0, 1.0, 0.04, 2), rough_skirt(0.04, 3)] {
        let (_, fibers) = follows_the_rules(&mesh);
        let counts = [Direction::Warp, Direction::Weft, Direction::Bias].map(|d| sets(&fibers, d));
        assert!(counts[0] <= 3 && counts[1] == 1 && counts[2] <= 6, "{counts:?}");
    }
}
