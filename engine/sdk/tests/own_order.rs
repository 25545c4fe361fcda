//! Positions come in the order of the caller's own mesh, and pins stay at their vertices' places.

use std::fmt::Write;
use std::path::PathBuf;

use toile_sdk::glam::Vec3;
use toile_sdk::{Body, Garment, Scene, Sex};

/// A sheet of vertices in a shuffled order, so that no order of the engine's can be the caller's by chance.
fn sheet() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (rows, columns) = (17u32, 13u32);
    let count = rows * columns;
    // 100 has no divisor in common with 221.
    let place = |v: u32| (v * 100 + 7) % count;
    let mut positions = vec![Vec3::ZERO; count as usize];
    for v in 0..count {
        let (row, column) = (v / columns, v % columns);
        // No number of these is a round one in binary.
        positions[place(v) as usize] =
            Vec3::new(0.031 * column as f32, 1.7 - 0.029 * row as f32, 0.011 * (row % 3) as f32);
    }
    let mut triangles = Vec::new();
    for a in (0..count - columns).filter(|a| a % columns != columns - 1) {
        triangles.push([a, a + columns, a + 1].map(place));
        triangles.push([a + 1, a + columns, a + columns + 1].map(place));
    }
    (positions, triangles)
}

#[test]
fn pins_stay_at_the_meshs_own_positions_to_the_bit() {
    let (positions, triangles) = sheet();
    let pins = [0, 5, 77, 111, 220];
    let mut scene = Scene::of_mesh(&positions, &triangles, &pins, "cotton-lawn").unwrap();
    assert_eq!(scene.positions(0).unwrap(), positions, "at the start everything is where the mesh has it");
    assert_eq!(scene.pinned(0).unwrap(), pins);
    assert_eq!(scene.faces(0).unwrap(), triangles);
    for _ in 0..60 {
        scene.step();
        let now = scene.positions(0).unwrap();
        assert!(pins.iter().all(|pin| now[*pin as usize] == positions[*pin as usize]));
    }
    let now = scene.positions(0).unwrap();
    let fell = now.iter().zip(&positions).filter(|(now, then)| now.y < then.y - 0.01).count();
    assert!(fell > positions.len() / 2, "the rest falls: {fell}");
    // Edges are as long as the caller's own: an order that is another one would stretch them.
    let longest = triangles.iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).map(|[a, b]| {
        let length = |p: &[Vec3]| p[*a as usize].distance(p[*b as usize]);
        length(&now) / length(&positions)
    });
    let longest = longest.fold(0.0, f32::max);
    assert!(longest < 1.3, "an edge is {longest} times as long");
    assert!(scene.stats(0).unwrap().strain_max < 0.3);
}

#[test]
fn a_vertex_of_no_face_stands_and_joined_ones_go_together() {
    let (mut positions, mut triangles) = sheet();
    // A double of vertex 3, used by one triangle, and a vertex that nothing uses.
    positions.extend([positions[3], Vec3::splat(3.0)]);
    let double = positions.len() as u32 - 2;
    let face = triangles.iter_mut().find(|t| t.contains(&3)).unwrap();
    *face = face.map(|v| if v == 3 { double } else { v });
    let mut scene = Scene::of_mesh(&positions, &triangles, &[0], "cotton-lawn").unwrap();
    scene.step_many(20);
    let now = scene.positions(0).unwrap();
    assert_eq!(now[double as usize], now[3]);
    assert_eq!(now.last(), Some(&Vec3::splat(3.0)));
    assert_eq!(scene.pinned(0).unwrap(), [0, double + 1]);
}

/// A shift of 0.6 m around the average woman's trunk, its vertices in the order that `place` gives.
fn shift(place: impl Fn(usize) -> usize) -> (Vec<Vec3>, Vec<[u32; 3]>, String) {
    let (rows, around) = (30usize, 48usize);
    let mut positions = vec![Vec3::ZERO; rows * around];
    for v in 0..rows * around {
        let (row, k) = (v / around, v % around);
        let (sin, cos) = (k as f32 / around as f32 * std::f32::consts::TAU).sin_cos();
        positions[place(v)] = Vec3::new(0.24 * cos, 1.25 - 0.02 * row as f32, 0.02 + 0.2 * sin);
    }
    let mut triangles = Vec::new();
    for v in 0..(rows - 1) * around {
        let (row, k) = (v / around, v % around);
        let [a, b] = [v, row * around + (k + 1) % around];
        let [c, d] = [a + around, b + around];
        triangles.push([a, b, c].map(|v| place(v) as u32));
        triangles.push([b, d, c].map(|v| place(v) as u32));
    }
    let mut text = String::new();
    positions.iter().for_each(|p| writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap());
    triangles.iter().for_each(|t| writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap());
    (positions, triangles, text)
}

struct TestFile(PathBuf);

impl TestFile {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("toile-sdk-{}-{name}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        Self(path)
    }

    fn garment(&self) -> Garment {
        Garment::open(self.0.to_str().unwrap()).unwrap()
    }
}

impl Drop for TestFile {
    fn drop(&mut self) {
        _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn a_mesh_on_a_body_comes_in_the_order_of_its_file() {
    let count = 30 * 48;
    // 1001 has no divisor in common with 1440.
    let shuffled = |v: usize| (v * 1001 + 17) % count;
    let (positions, triangles, text) = shift(shuffled);
    let file = TestFile::new("shift.obj", &text);
    let body = Body::average(Sex::Female).unwrap();
    let mut scene = Scene::dress(&body, &[file.garment()]).unwrap();
    assert_eq!(scene.faces(0).unwrap(), triangles);
    scene.step_many(10);
    let worn = scene.positions(0).unwrap();
    assert_eq!(worn.len(), positions.len());
    // Edges are about as long as the file has them; in another order they would lead across the body.
    let edges = triangles.iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut stretch: Vec<f32> = edges
        .map(|[a, b]| {
            let length = |p: &[Vec3]| p[*a as usize].distance(p[*b as usize]);
            length(&worn) / length(&positions)
        })
        .collect();
    stretch.sort_by(f32::total_cmp);
    let share = |part: f32| stretch[(part * (stretch.len() - 1) as f32) as usize];
    // Shear makes the diagonals of some faces longer.
    assert!(share(0.05) > 0.7 && share(0.95) < 1.3 && share(1.0) < 4.0, "{:?}", [0.05, 0.95, 1.0].map(share));
    let row = |row: usize| (0..48).map(|k| worn[shuffled(row * 48 + k)].y).sum::<f32>() / 48.0;
    assert!((1..30).all(|r| row(r) < row(r - 1)), "rows lie below each other");
}

#[test]
fn what_a_repair_joins_is_still_there_in_the_files_order() {
    let (positions, triangles, mut text) = shift(|v| v);
    // The last triangle gets corners of its own, as exporters write them, and one vertex has no face.
    let last = triangles.last().unwrap();
    let cut = text.rfind("f ").unwrap();
    text.truncate(cut);
    let first = positions.len();
    for corner in last {
        let p = positions[*corner as usize];
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    writeln!(text, "v 0 0.5 0\nf {} {} {}", first + 1, first + 2, first + 3).unwrap();
    let file = TestFile::new("joined.obj", &text);
    let mut scene = Scene::dress(&Body::average(Sex::Female).unwrap(), &[file.garment()]).unwrap();
    scene.step_many(5);
    let worn = scene.positions(0).unwrap();
    assert_eq!((worn.len(), scene.faces(0).unwrap().len()), (first + 4, triangles.len()));
    assert_eq!(scene.garments()[0].vertices, worn.len());
    for (k, corner) in last.iter().enumerate() {
        assert_eq!(worn[first + k], worn[*corner as usize]);
    }
    assert_eq!(worn[first + 3], Vec3::new(0.0, 0.5, 0.0));
    assert!(scene.pinned(0).unwrap().contains(&(first as u32 + 3)));
    assert!(scene.fit_map(0).unwrap()[first + 3].is_nan());
    assert!(scene.garments()[0].notes.iter().any(|note| note.contains("joined")), "{:?}", scene.garments()[0].notes);
}
