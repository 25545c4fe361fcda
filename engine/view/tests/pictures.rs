//! Tests of the picture: the tree agrees with brute force, bytes do not depend on threads, files hold what was put in,
//! and bad meshes do no harm.

use std::io::Cursor;

use glam::Vec3;
use toile_view::{
    bvh::{Bvh, Hit, Ray},
    image::{Animation, Error, Image, Size},
    scene::{Bounds, Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface},
    trace::{TraceQuality, TracedScene, render},
};

/// A small generator of its own (Marsaglia 2003, xorshift), so that runs repeat.
struct Dice(u32);

impl Dice {
    /// Uniform in -1..1.
    fn roll(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.roll(), self.roll(), self.roll())
    }
}

/// The nearest hit by trying every triangle, in f64 (Moeller and Trumbore written out anew).
fn brute(faces: &[[Vec3; 3]], ray: &Ray, limit: f32) -> Option<(u32, f64)> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut best: Option<(u32, f64)> = None;
    for (id, face) in (0..).zip(faces) {
        let [a, b, c] = face.map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a);
        let t = (a - o).dot(normal) / d.dot(normal);
        let p = o + d * t;
        let inside = [(a, b), (b, c), (c, a)].iter().all(|(p0, p1)| (*p1 - *p0).cross(p - *p0).dot(normal) >= 0.0);
        if inside && t > 0.0 && t < f64::from(best.map_or(limit, |b| b.1 as f32)) {
            best = Some((id, t));
        }
    }
    best
}

#[test]
fn the_tree_agrees_with_brute_force() {
    let mut dice = Dice(7);
    for (count, size) in [(1, 0.8), (3, 0.5), (5, 0.5), (80, 0.3), (3000, 0.08)] {
        let faces: Vec<_> = (0..count)
            .map(|_| {
                let centre = dice.point();
                [centre + dice.point() * size, centre + dice.point() * size, centre + dice.point() * size]
            })
            .collect();
        let tree = Bvh::build(faces.iter().copied());
        assert_eq!(tree.len(), count);
        let mut hits = 0;
        for i in 0..1500 {
            let axis = [Vec3::X, -Vec3::Y, Vec3::Z][i % 3];
            let direction = if i % 10 == 0 { axis } else { (dice.point() + Vec3::splat(1e-3)).normalize() };
            let ray = Ray::new(dice.point() * 1.5, direction);
            let limit = if i % 4 == 0 { 0.7 } else { f32::INFINITY };
            let want = brute(&faces, &ray, limit);
            let got = tree.closest(&ray, limit);
            assert_eq!(tree.blocked(&ray, limit), got.is_some(), "any-hit and closest-hit disagree on ray {i}");
            match (got, want) {
                (Some(Hit { distance, triangle, u, v }), Some((id, t))) => {
                    assert!((f64::from(distance) - t).abs() < 2e-4, "ray {i}: {distance} m, brute force {t} m");
                    assert!(triangle == id || (f64::from(distance) - t).abs() < 1e-5, "ray {i}: {triangle} {id}");
                    let [a, b, c] = faces[triangle as usize];
                    let met = a + (b - a) * u + (c - a) * v;
                    assert!(met.distance(ray.origin + ray.direction * distance) < 1e-3, "ray {i}: weights are off");
                    hits += 1;
                }
                (None, None) => {}
                (got, want) => panic!("ray {i} of {count}: {got:?}, brute force {want:?}"),
            }
        }
        assert!(hits > if count > 50 { 100 } else { 0 }, "{hits} hits among {count} triangles prove little");
    }
}

#[test]
fn many_triangles_in_one_place_still_make_a_tree() {
    let face = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let tree = Bvh::build((0..5000).map(|_| face));
    let hit = tree.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z), 9.0);
    assert!((hit.expect("all are there").distance - 1.0).abs() < 1e-6);
}

/// A bowl over a plate: two surfaces, one with a colour a vertex.
struct Still {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    colours: Vec<Vec3>,
}

impl Still {
    fn new() -> Self {
        let n = 24_u32;
        let spot = |i: u32, j: u32| {
            let (x, z) = (i as f32 / n as f32 - 0.5, j as f32 / n as f32 - 0.5);
            Vec3::new(x, 0.4 + 2.0 * (x * x + z * z) + 0.05 * (20.0 * x).sin(), z)
        };
        let grid = |i: u32| (i / (n + 1), i % (n + 1));
        let positions: Vec<_> = (0..(n + 1) * (n + 1)).map(|i| spot(grid(i).0, grid(i).1)).collect();
        let triangles: Vec<_> = (0..n * n)
            .map(|i| i / n * (n + 1) + i % n)
            .flat_map(|a| [[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]])
            .collect();
        let mut normals = vec![Vec3::ZERO; positions.len()];
        toile_base::mesh::vertex_normals(&positions, &triangles, &mut normals);
        let colours = positions.iter().map(|p| (*p + 0.5).clamp(Vec3::ZERO, Vec3::ONE)).collect();
        Self { positions, normals, triangles, colours }
    }

    fn surface(&self, material: Material) -> PictureSurface<'_> {
        PictureSurface {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.triangles,
            colours: Colours::PerVertex(&self.colours),
            material,
            look: None,
        }
    }
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let still = Still::new();
    let surfaces = [still.surface(Material::Cloth)];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let (size, camera) = (Size::new(61, 83), OrbitCamera::framing(&stage.bounds(), 0.7, 61.0 / 83.0));
    for quality in [TraceQuality::Motion, TraceQuality::Still] {
        let (one, cost) = stage.render_on(1, &camera, size, quality);
        assert!(cost.rays > 5000, "{cost:?}");
        for threads in [2, 3, 7] {
            let (more, same) = stage.render_on(threads, &camera, size, quality);
            assert!(one == more && cost == same, "{threads} threads, {quality:?}");
        }
        assert!(one == render(&PictureScene { surfaces: &surfaces, floor: true }, &camera, size, quality));
    }
}

#[test]
fn bad_meshes_are_skipped_and_the_good_remain() {
    let still = Still::new();
    let good = [still.surface(Material::Skin)];
    let mut positions = still.positions.clone();
    let mut normals = still.normals.clone();
    let first = positions.len() as u32;
    positions.extend([Vec3::NAN, Vec3::INFINITY, Vec3::ONE, Vec3::ONE, Vec3::splat(f32::MAX)]);
    normals.extend([Vec3::NAN; 2]);
    let mut triangles = still.triangles.clone();
    triangles.extend([[0, 1, first], [0, 1, first + 1], [first + 2, first + 3, first + 2], [0, 0, 0]]);
    triangles.extend([[0, 1, u32::MAX], [0, first + 4, 1]]);
    let spoilt = PictureSurface { positions: &positions, normals: &normals, triangles: &triangles, ..good[0] };
    let empty =
        PictureSurface { positions: &[], normals: &[], triangles: &[], colours: Colours::PerVertex(&[]), ..good[0] };
    let surfaces = [empty, spoilt, empty];
    let (size, camera) = (Size::new(40, 40), OrbitCamera::front(&Bounds::of(&still.positions), 1.0));
    let want = render(&PictureScene { surfaces: &good, floor: true }, &camera, size, TraceQuality::Motion);
    let got = render(&PictureScene { surfaces: &surfaces, floor: true }, &camera, size, TraceQuality::Motion);
    assert!(want == got, "the broken triangles left a trace");

    let bare = PictureSurface { normals: &[], colours: Colours::PerVertex(&[]), ..good[0] };
    for surfaces in [&[][..], &[empty][..], &[bare][..]] {
        for floor in [true, false] {
            let image = render(&PictureScene { surfaces, floor }, &camera, size, TraceQuality::Motion);
            assert_eq!(image.bytes().len(), 40 * 40 * 3);
        }
    }
    let nothing =
        render(&PictureScene { surfaces: &good, floor: true }, &camera, Size::new(0, 5), TraceQuality::Motion);
    assert!(nothing.bytes().is_empty());
}

#[test]
fn presets_look_from_their_side_and_frame_the_box() {
    // A post on the subject's left (+x) and a low block in front (+z).
    let block = |min: Vec3, max: Vec3| {
        let corner = |i: usize| {
            Vec3::new(
                if i & 1 == 0 { min.x } else { max.x },
                if i & 2 == 0 { min.y } else { max.y },
                if i & 4 == 0 { min.z } else { max.z },
            )
        };
        (0..8).map(corner).collect::<Vec<_>>()
    };
    let triangles = [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 4, 5], [0, 5, 1]];
    let more = [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]];
    let triangles = [triangles, more].concat();
    let left = block(Vec3::new(0.3, 0.0, -0.1), Vec3::new(0.4, 1.0, 0.1));
    let front = block(Vec3::new(-0.1, 0.0, 0.4), Vec3::new(0.1, 0.3, 0.5));
    let bounds = Bounds::of(&left).union(Bounds::of(&front)).grown(Vec3::new(-0.4, 0.0, -0.5));
    let paint = |positions, colour| PictureSurface {
        positions,
        normals: &[],
        triangles: &triangles,
        colours: Colours::One(colour),
        material: Material::Diffuse,
        look: None,
    };
    let surfaces = [paint(&left, Vec3::X), paint(&front, Vec3::Y)];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let size = Size::new(120, 120);
    let middle = |camera: &OrbitCamera, channel: usize| {
        let image = stage.render(camera, size, TraceQuality::Motion);
        let coloured = |x: u32, y: u32| {
            let p = image.pixel(x, y).unwrap().map(u32::from);
            p[channel] > 40 && (0..3).all(|c| c == channel || p[c] * 2 < p[channel])
        };
        let seen: Vec<_> =
            (0..120).flat_map(|y| (0..120).map(move |x| (x, y))).filter(|&(x, y)| coloured(x, y)).collect();
        assert!(seen.len() > 30, "channel {channel}: {} pixels", seen.len());
        assert!(seen.iter().all(|&(x, y)| x > 1 && x < 118 && y > 1 && y < 118), "the box is cut");
        seen.iter().map(|p| p.0 as f32).sum::<f32>() / seen.len() as f32 - 59.5
    };
    let (front, side, back) =
        (OrbitCamera::front(&bounds, 1.0), OrbitCamera::side(&bounds, 1.0), OrbitCamera::back(&bounds, 1.0));
    assert!(middle(&front, 0) > 15.0, "seen from the front, their left is on the right");
    assert!(middle(&back, 0) < -15.0, "seen from behind, their left is on the left");
    assert!(middle(&side, 1) < -15.0, "seen from their left, their front is on the left");
    assert_eq!(front.distance, back.distance);
}

#[test]
fn a_shadow_falls_on_the_floor_and_away_from_the_key_light() {
    let still = Still::new();
    let surfaces = [still.surface(Material::Cloth)];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let bare = TracedScene::build(PictureScene { surfaces: &[], floor: true });
    let camera = OrbitCamera { target: Vec3::new(0.0, 0.3, 0.0), yaw: 0.0, height: 1.5, distance: 3.0, fov_y: 0.6 };
    let size = Size::new(120, 120);
    let (with, without) =
        (stage.render(&camera, size, TraceQuality::Motion), bare.render(&camera, size, TraceQuality::Motion));
    let sum = |image: &Image, columns: std::ops::Range<u32>| -> i64 {
        let pixels = (60..110).flat_map(|y| columns.clone().map(move |x| (x, y)));
        pixels.map(|(x, y)| i64::from(image.pixel(x, y).unwrap()[1])).sum()
    };
    // The pool of light depends on the subject's size, so each picture is compared with itself.
    let (left, right) = (sum(&with, 12..32), sum(&with, 88..108));
    let even = (sum(&without, 12..32) - sum(&without, 88..108)).abs();
    assert!(left - right > 4 * even + 1000, "left {left}, right {right}, without a subject {even} apart");
}

#[test]
fn a_png_holds_what_was_put_in() {
    let still = Still::new();
    let surfaces = [still.surface(Material::Cloth)];
    let camera = OrbitCamera::front(&Bounds::of(&still.positions), 1.0);
    let image =
        render(&PictureScene { surfaces: &surfaces, floor: true }, &camera, Size::new(37, 29), TraceQuality::Motion);
    let mut file = Vec::new();
    image.write_png(&mut file).unwrap();
    let mut reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
    assert!(reader.info().srgb.is_some(), "marked as sRGB");
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (37, 29, png::ColorType::Rgb));
    assert!(bytes == image.bytes());
    assert!(Image::filled(Size::new(0, 3), [0; 3]).write_png(&mut Vec::new()).is_err());
}

#[test]
fn an_animation_plays_back_every_frame() {
    let size = Size::new(40, 30);
    let frames: Vec<_> = [None, Some((3, 4, 5)), Some((3, 4, 5)), Some((30, 20, 10)), None]
        .iter()
        .map(|block| {
            let mut image = Image::filled(size, [200, 190, 180]);
            if let Some((x, y, side)) = *block {
                image.fill(x, y, Size::new(side, side), [9, 8, 7]);
            }
            image
        })
        .collect();
    let mut file = Vec::new();
    let mut animation = Animation::new(&mut file, size, 5, 12).unwrap();
    for frame in &frames {
        animation.push(frame).unwrap();
    }
    assert!(matches!(animation.push(&frames[0]), Err(Error::Png(_))), "a sixth frame is refused");
    let wrong = animation.push(&Image::filled(Size::new(1, 1), [0; 3]));
    assert!(matches!(wrong, Err(Error::FrameSize { .. })));
    animation.finish().unwrap();

    let mut reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (5, 0));
    let mut screen = Image::filled(size, [0; 3]);
    let mut patches = Vec::new();
    for (i, frame) in frames.iter().enumerate() {
        let mut bytes = vec![0; 40 * 30 * 3];
        let info = reader.next_frame(&mut bytes).unwrap();
        let control = *reader.info().frame_control().unwrap();
        assert_eq!((control.delay_num, control.delay_den), (1, 12));
        for (j, p) in (0..).zip(bytes[..info.buffer_size()].chunks_exact(3)) {
            let (x, y) = (control.x_offset + j % info.width, control.y_offset + j / info.width);
            screen.fill(x as i32, y as i32, Size::new(1, 1), [p[0], p[1], p[2]]);
        }
        assert!(screen == *frame, "frame {i}");
        patches.push((info.width, info.height));
    }
    assert_eq!(patches, [(40, 30), (5, 5), (1, 1), (37, 26), (10, 10)], "of each frame only what changed");
}

#[test]
fn an_unfinished_or_empty_animation_is_an_error() {
    let size = Size::new(8, 8);
    assert!(matches!(Animation::new(Vec::new(), size, 0, 12), Err(Error::Tempo { .. })));
    assert!(matches!(Animation::new(Vec::new(), size, 2, 0), Err(Error::Tempo { .. })));
    let mut animation = Animation::new(Vec::new(), size, 2, 12).unwrap();
    animation.push(&Image::filled(size, [1; 3])).unwrap();
    assert!(animation.finish().is_err(), "one frame of two is missing");
}

#[test]
fn the_mannequin_comes_out_warm_and_light() {
    let still = Still::new();
    let skin = PictureSurface { colours: Colours::One(MANNEQUIN), ..still.surface(Material::Skin) };
    let camera = OrbitCamera { height: 1.2, ..OrbitCamera::front(&Bounds::of(&still.positions), 1.0) };
    let image =
        render(&PictureScene { surfaces: &[skin], floor: true }, &camera, Size::new(60, 60), TraceQuality::Still);
    let [r, g, b] = image.pixel(30, 30).unwrap();
    assert!(r >= g && g >= b && r < 250 && b > 90, "{r} {g} {b}");
}
