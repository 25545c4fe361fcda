//! Pictures that the mirror draws off the screen, on whatever adapter there is, beside those of the ray tracer.

use std::sync::OnceLock;

use glam::Vec3;
use toile_view::image::{Image, Size};
use toile_view::raster::{
    AdapterChoice, Backdrop, Gpu, Line, Model, ModelError, Offscreen, OffscreenError, RenderQuality, Renderer, Viewport,
};
use toile_view::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene};
use toile_view::{fit_map, trace};

mod dressed;
mod figures;
mod offload;
mod prints;

use dressed::Dressed;

const SIZE: Size = Size::new(240, 400);

/// All beams of a still, on small maps: the same picture but for the sharpest shadows.
const FINE: RenderQuality =
    RenderQuality { samples: 4, key: 12, rim: 6, sky: 30, tile: 192, by_vertex: false, weave: true };

/// The adapter. Where there is none a test has nothing to say, but where everything has to be tested it fails.
fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let found = GPU.get_or_init(|| match Gpu::offscreen(&AdapterChoice::Fastest) {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var("CI").is_ok_and(|v| v == "true") => panic!("CI=true, but {error}"),
        Err(error) => {
            println!("nothing was drawn: {error}");
            None
        }
    });
    found.as_ref()
}

fn scene() -> &'static Dressed {
    static SCENE: OnceLock<Dressed> = OnceLock::new();
    // Of one colour, which nothing else in the picture has.
    SCENE.get_or_init(|| Dressed::in_fabric("strap-dress", "cotton-lawn", "38"))
}

fn camera(yaw: f32) -> OrbitCamera {
    OrbitCamera::framing(&scene().bounds(), yaw, SIZE.width as f32 / SIZE.height as f32)
}

fn renderer(gpu: &Gpu, quality: RenderQuality, map: bool) -> Renderer {
    let mut renderer = Renderer::new(gpu, Offscreen::FORMAT, quality);
    scene().put_on(&mut renderer, map);
    renderer
}

fn shoot(gpu: &Gpu, renderer: &mut Renderer, camera: &OrbitCamera) -> Image {
    let offscreen = Offscreen::new(gpu, SIZE).unwrap();
    offscreen.shoot(gpu, renderer, camera, Backdrop::Curved).unwrap()
}

fn traced(camera: &OrbitCamera, map: bool) -> Image {
    let surfaces = scene().surfaces(map);
    trace::render(&PictureScene { surfaces: &surfaces, floor: true }, camera, SIZE, trace::TraceQuality::Motion)
}

fn pixels(image: &Image) -> Vec<Vec3> {
    image.bytes().chunks_exact(3).map(|p| Vec3::new(p[0].into(), p[1].into(), p[2].into())).collect()
}

/// Pixels of the dress: clearly redder than anything else in the picture.
fn dress(image: &Image) -> Vec<bool> {
    pixels(image).iter().map(|p| p.x > 1.5 * p.z + 20.0).collect()
}

#[test]
fn silhouettes_and_colours_agree_with_the_ray_tracers() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, FINE, false);
    for yaw in [0.0, 1.1, 3.0] {
        let (ours, theirs) = (shoot(gpu, &mut renderer, &camera(yaw)), traced(&camera(yaw), false));
        let (a, b) = (dress(&ours), dress(&theirs));
        let count = |f: fn(bool, bool) -> bool| a.iter().zip(&b).filter(|(a, b)| f(**a, **b)).count();
        let iou = count(|a, b| a && b) as f32 / count(|a, b| a || b) as f32;
        let both: Vec<(Vec3, Vec3)> = pixels(&ours).into_iter().zip(pixels(&theirs)).collect();
        let far = |pick: &dyn Fn(usize) -> bool| {
            let off: Vec<f32> =
                (0..both.len()).filter(|i| pick(*i)).map(|i| (both[i].0 - both[i].1).length()).collect();
            (
                off.iter().sum::<f32>() / off.len() as f32,
                off.iter().filter(|d| **d > 40.0).count() as f32 / off.len() as f32,
            )
        };
        let (cloth, cloth_far) = far(&|i| a[i] && b[i]);
        let (all, all_far) = far(&|_| true);
        println!("yaw {yaw}: IoU {iou:.4}, cloth {cloth:.2} ({cloth_far:.4}), all {all:.2} ({all_far:.4}) of 255");
        assert!(iou >= 0.98, "yaw {yaw}: the dress agrees on {iou} only");
        assert!(cloth < 9.0 && all < 5.0, "yaw {yaw}: colours are {cloth} off on the dress, {all} in all");
        assert!(all_far < 0.01, "yaw {yaw}: {all_far} of the pixels are far off");
    }
}

/// Body and dress painted in the fit map's tightest red, so that all that is red is subject. Twice as large as the other
/// pictures: the two ways of smoothing an edge differ by a tenth of a pixel, which on fingers would count.
#[test]
fn the_whole_subjects_silhouette_agrees() {
    let Some(gpu) = gpu() else { return };
    let tight = [vec![1.0; scene().body.len()], vec![1.0; scene().garment.particles()]];
    let mut renderer = renderer(gpu, RenderQuality { sky: 0, ..FINE }, false);
    (0..2).for_each(|i| renderer.set_fit(i, Some(&tight[i])).unwrap());
    let mut surfaces = scene().surfaces(true);
    for (surface, tight) in surfaces.iter_mut().zip(&tight) {
        (surface.colours, surface.material) = (Colours::Tightness(tight), Material::Diffuse);
    }
    let (camera, size) = (camera(0.4), Size::new(2 * SIZE.width, 2 * SIZE.height));
    let offscreen = Offscreen::new(gpu, size).unwrap();
    let ours = dress(&offscreen.shoot(gpu, &mut renderer, &camera, Backdrop::Curved).unwrap());
    let scene = PictureScene { surfaces: &surfaces, floor: true };
    let theirs = dress(&trace::render(&scene, &camera, size, trace::TraceQuality::Motion));
    let count = |f: fn(bool, bool) -> bool| ours.iter().zip(&theirs).filter(|(a, b)| f(**a, **b)).count() as f32;
    let (both, any) = (count(|a, b| a && b), count(|a, b| a || b));
    println!("IoU of the whole subject {:.4} over {any} pixels", both / any);
    assert!(both / any >= 0.98, "{}", both / any);
}

#[test]
fn the_fit_map_shows_all_eight_steps_in_their_order() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, true);
    let image = shoot(gpu, &mut renderer, &camera(0.0));
    let nearest = |p: Vec3| {
        // Light changes how bright a step is, so hues are compared.
        let hue = |c: Vec3| c / c.length().max(1.0);
        let far = |s: &[u8; 3]| hue(Vec3::from_array(s.map(f32::from))).distance(hue(p));
        (0..8).min_by(|a, b| far(&fit_map::STEPS[*a]).total_cmp(&far(&fit_map::STEPS[*b]))).unwrap()
    };
    let column: Vec<usize> = (0..SIZE.height)
        .filter_map(|y| image.pixel(120, y))
        .map(|p| nearest(Vec3::from_array(p.map(f32::from))))
        .collect();
    for step in 0..8 {
        assert!(column.contains(&step), "step {step} is not on the dress: {column:?}");
    }
    let first = |s: usize| column.iter().position(|c| *c == s).unwrap();
    assert!(first(0) < first(7), "loose above, tight below");
    scene().put_on(&mut renderer, false);
    assert!(shoot(gpu, &mut renderer, &camera(0.0)) != image, "and its own colour again");
}

#[test]
fn a_viewport_is_painted_and_the_rest_stays() {
    let Some(gpu) = gpu() else { return };
    for quality in [RenderQuality::LOW, RenderQuality { samples: 4, ..RenderQuality::LOW }] {
        let mut renderer = renderer(gpu, quality, false);
        let offscreen = Offscreen::new(gpu, Size::new(200, 160)).unwrap();
        let half = |x| Viewport { x, y: 20, size: Size::new(90, 140) };
        offscreen.draw(gpu, &mut renderer, half(5), &camera(0.0), Backdrop::Curved);
        let one = offscreen.read(gpu).unwrap();
        offscreen.draw(gpu, &mut renderer, half(105), &camera(3.0), Backdrop::Curved);
        let two = offscreen.read(gpu).unwrap();
        for (x, y) in [(2, 80), (50, 10), (99, 80), (197, 80)] {
            assert_eq!(two.pixel(x, y), Some([0; 3]), "({x}, {y}) is outside of both");
        }
        assert_eq!(one.pixel(150, 90), Some([0; 3]));
        assert!(two.pixel(150, 90).unwrap()[0] > 60);
        assert!((5..95).all(|x| one.pixel(x, 90) == two.pixel(x, 90)), "the second left the first alone");
        offscreen.draw(gpu, &mut renderer, Viewport { x: 500, y: 0, size: SIZE }, &camera(0.0), Backdrop::Curved);
        offscreen.draw(gpu, &mut renderer, Viewport { x: 150, y: 100, size: SIZE }, &camera(0.0), Backdrop::Curved);
        assert!(offscreen.read(gpu).is_ok(), "what reaches beyond the target is cut off");
    }
}

#[test]
fn a_picture_stands_behind_and_takes_the_shadow() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let green: Vec<u8> = [40, 160, 70].repeat(60 * 60);
    assert!(matches!(renderer.set_picture(Size::new(60, 60), &green[3..]), Err(ModelError::Length { .. })));
    renderer.set_picture(Size::new(60, 60), &green).unwrap();
    let offscreen = Offscreen::new(gpu, SIZE).unwrap();
    let image = offscreen.shoot(gpu, &mut renderer, &camera(0.0), Backdrop::Picture).unwrap();
    let near = |p: [u8; 3]| p.iter().zip([40, 160, 70]).all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 2);
    assert!(near(image.pixel(10, 10).unwrap()), "{:?}", image.pixel(10, 10));
    let darker = (0..SIZE.height).flat_map(|y| (0..SIZE.width).map(move |x| (x, y)));
    let shaded =
        darker.filter_map(|(x, y)| image.pixel(x, y)).filter(|p| p[1] < 140 && p[1] > 2 * p[0] && p[1] > p[2] * 2);
    assert!(shaded.count() > 100, "no shadow falls on the picture's floor");
    let curved = offscreen.shoot(gpu, &mut renderer, &camera(0.0), Backdrop::Curved).unwrap();
    assert!(!near(curved.pixel(10, 10).unwrap()));
}

#[test]
fn lines_are_drawn_over_what_hides_them_faintly() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let plain = shoot(gpu, &mut renderer, &camera(0.0));
    let blue = Vec3::new(0.0, 0.0, 1.0);
    let at = |y: f32, z: f32| Line { from: Vec3::new(-0.6, y, z), to: Vec3::new(0.6, y, z), colour: blue };
    renderer.set_lines(&[at(0.8, 1.0), at(0.6, -1.0)]);
    let lined = shoot(gpu, &mut renderer, &camera(0.0));
    let changed = |x: u32| -> Vec<f32> {
        let far = |y| {
            Vec3::from_array(lined.pixel(x, y).unwrap().map(f32::from))
                .distance(Vec3::from_array(plain.pixel(x, y).unwrap().map(f32::from)))
        };
        (0..SIZE.height).map(far).filter(|d| *d > 8.0).collect()
    };
    let middle = changed(120);
    assert!(middle.iter().any(|d| *d > 150.0), "the one before is whole: {middle:?}");
    assert!(middle.iter().any(|d| (8.0..120.0).contains(d)), "the one behind shines through: {middle:?}");
    renderer.set_lines(&[]);
    assert!(shoot(gpu, &mut renderer, &camera(0.0)) == plain);
}

#[test]
fn recessed_skin_does_not_show_through_cloth() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let plain = dress(&shoot(gpu, &mut renderer, &camera(0.0)));
    let through: Vec<Vec3> = scene().body.iter().zip(&scene().body_normals).map(|(p, n)| *p + *n * 0.02).collect();
    renderer.update(0, &through, &scene().body_normals).unwrap();
    let poked = dress(&shoot(gpu, &mut renderer, &camera(0.0)));
    renderer.set_recess(0, &vec![0.08; scene().body.len()]).unwrap();
    let mended = dress(&shoot(gpu, &mut renderer, &camera(0.0)));
    let lost = |image: &[bool]| plain.iter().zip(image).filter(|(a, b)| **a && !**b).count();
    assert!(lost(&poked) > 200, "{}", lost(&poked));
    assert!(lost(&mended) < lost(&poked) / 10, "{} of {}", lost(&mended), lost(&poked));
}

#[test]
fn what_does_not_fit_is_refused_and_the_picture_stays() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let before = shoot(gpu, &mut renderer, &camera(0.0));
    let mut broken = scene().body.clone();
    broken[7].x = f32::NAN;
    let normals = &scene().body_normals;
    assert_eq!(renderer.update(0, &broken, normals), Err(ModelError::NotFinite { surface: 0, vertex: 7 }));
    assert!(matches!(renderer.update(0, &broken[1..], normals), Err(ModelError::Length { .. })));
    assert!(matches!(renderer.set_triangles(0, &[[0, 1, u32::MAX]]), Err(ModelError::Triangle { .. })));
    assert_eq!(renderer.set_colour(9, Vec3::ONE), Err(ModelError::Surface { surface: 9, count: 2 }));
    assert!(matches!(renderer.set_fit(1, Some(&[0.0])), Err(ModelError::Length { .. })));
    assert!(shoot(gpu, &mut renderer, &camera(0.0)) == before);
    assert!(matches!(Offscreen::new(gpu, Size::new(0, 5)), Err(OffscreenError::Size { .. })));
    assert!(matches!(Offscreen::new(gpu, Size::new(9, 1 << 20)), Err(OffscreenError::Size { .. })));
    assert_eq!(gpu.fault(), None);
}

#[test]
fn an_empty_model_shows_the_backdrop_and_hidden_surfaces_are_left_out() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let dressed = shoot(gpu, &mut renderer, &camera(0.0));
    renderer.set_visible(1, false).unwrap();
    let bare = shoot(gpu, &mut renderer, &camera(0.0));
    assert!(dress(&dressed).iter().filter(|d| **d).count() > 2_000);
    assert!(dress(&bare).iter().all(|d| !d));
    renderer.set_model(&Model::default()).unwrap();
    let empty = shoot(gpu, &mut renderer, &camera(0.0));
    let [r, g, b] = empty.pixel(120, 200).unwrap();
    assert!(r > 180 && g > 180 && b > 180, "{r} {g} {b}");
    renderer.set_subject(Some(Bounds { min: Vec3::ZERO, max: Vec3::ONE }));
    assert!(shoot(gpu, &mut renderer, &camera(0.0)) != empty, "the backdrop is fitted to another subject");
}

#[test]
fn the_same_picture_twice_has_the_same_bytes() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, RenderQuality::LOW, false);
    let first = shoot(gpu, &mut renderer, &camera(0.3));
    for _ in 0..9 {
        // More often than there are blocks for views, so that they are used again.
        assert!(shoot(gpu, &mut renderer, &camera(0.3)) == first);
    }
}

#[test]
fn an_adapter_that_is_not_there_is_named_with_those_that_are() {
    let Some(gpu) = gpu() else { return };
    let error = Gpu::offscreen(&AdapterChoice::Named("no such card".into())).err().unwrap().to_string();
    assert!(error.contains("no such card") && error.contains(&gpu.adapter().name), "{error}");
    let name = gpu.adapter().name.to_uppercase();
    assert_eq!(Gpu::offscreen(&AdapterChoice::Named(name)).unwrap().adapter(), gpu.adapter());
}

#[test]
fn a_destroyed_device_is_known_to_be_lost() {
    if gpu().is_none() {
        return;
    }
    let own = Gpu::offscreen(&AdapterChoice::Fastest).unwrap();
    assert!(!own.lost());
    own.device.destroy();
    own.finish();
    assert!(own.lost());
}
