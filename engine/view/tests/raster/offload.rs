//! A garment that is stepped on the device, drawn from there.

use std::sync::{Arc, OnceLock};

use glam::{Affine3A, Vec3, Vec3A};
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::BONES;
use toile_engine::cloth::{Settings, Step};
use toile_engine::colliders::{Colliders, RestSphere};
use toile_engine::skin::{Blend, SkinningJob};
use toile_gpu::cloth::Offload;
use toile_gpu::cloth::cloth_device::ClothDevice;
use toile_gpu::skin::Skinning;
use toile_view::hidden_skin::CoveringCloth;
use toile_view::image::Image;
use toile_view::raster::{Backdrop, Gpu, ModelError, Renderer};
use toile_view::scene::{Bounds, OrbitCamera};

use super::dressed::{Dressed, wearer};
use super::{AdapterChoice, FINE, Offscreen, RenderQuality, SIZE, gpu, pixels};

const HIDDEN_RETRY: [Affine3A; BONES] = [Affine3A::IDENTITY; BONES];

/// What a byte of the two ways may differ by, in the mean, on a device whose normals are off by a last bit.
const MEAN: f32 = 0.02;

fn shirt() -> &'static Dressed {
    static SHIRT: OnceLock<Dressed> = OnceLock::new();
    SHIRT.get_or_init(|| Dressed::new("tee", "38"))
}

fn renderer(gpu: &Gpu, quality: RenderQuality) -> Renderer {
    let mut renderer = Renderer::new(gpu, Offscreen::FORMAT, quality);
    shirt().put_on(&mut renderer, false);
    // What the live picture has in the place of tucking the skin beneath every step's cloth.
    let worn = shirt().garment.triangles.iter().map(|t| t.map(|i| shirt().garment.start[i as usize]));
    let dressed = CoveringCloth::new(worn).dressed(&shirt().body, &shirt().body_normals);
    let recess: Vec<f32> = dressed.into_iter().map(|d| if d { 0.04 } else { 0.0 }).collect();
    renderer.set_recess(0, &recess).expect("one for each vertex");
    renderer
}

fn shoot(gpu: &Gpu, renderer: &mut Renderer) -> Image {
    let camera = OrbitCamera::framing(&Bounds::of(&shirt().garment.start), 0.3, SIZE.width as f32 / SIZE.height as f32);
    let offscreen = Offscreen::new(gpu, SIZE).expect("it is small");
    offscreen.shoot(gpu, renderer, &camera, Backdrop::Curved).expect("it is drawn")
}

fn colliders() -> Colliders {
    let (body, rig) = (wearer(), toile_assets::rig::fit(&wearer()));
    let spheres = rig.spheres.each_ref().map(|s| RestSphere::on_bone(&body.skeleton, s.bone, s.offset, s.radius));
    Colliders::new(&spheres, &rig.capsules, true).expect("the rig is the project's own")
}

/// The shirt twice, so that the one that is drawn begins somewhere in the buffers.
fn offload(gpu: &Gpu, colliders: &Colliders) -> Offload {
    let opened = Arc::new(ClothDevice::on(gpu.clone()).expect("every driver takes the kernels"));
    let shirt = &shirt().garment;
    let made = Offload::drawn(&opened, &[shirt, shirt], &[colliders, colliders], &Settings::default());
    made.expect("a device that draws does the cloth as well")
}

fn step(offload: &mut Offload, colliders: &Colliders) {
    let (shirt, settings) = (&shirt().garment, Settings::default());
    let step = Step { palette: &HIDDEN_RETRY, colliders, settings: &settings };
    offload.step(&[shirt, shirt], &[step, step]).expect("the step is sent");
}

/// What the renderer shows of places that came by way of the CPU.
fn by_cpu(gpu: &Gpu, renderer: &mut Renderer, places: &[Vec3A]) -> Image {
    let places: Vec<Vec3> = places.iter().map(|p| Vec3::from(*p)).collect();
    let mut normals = vec![Vec3::ZERO; places.len()];
    vertex_normals(&places, &shirt().garment.triangles, &mut normals);
    renderer.update(1, &places, &normals).expect("as many as there are");
    shoot(gpu, renderer)
}

fn bounds(places: &[Vec3A]) -> Bounds {
    places.iter().fold(Bounds::EMPTY, |b, p| b.grown(Vec3::from(*p)))
}

/// How far two pictures are apart, of 255, in the mean.
fn apart(one: &Image, other: &Image) -> f32 {
    let (one, other) = (pixels(one), pixels(other));
    one.iter().zip(&other).map(|(a, b)| (*a - *b).abs().element_sum() / 3.0).sum::<f32>() / one.len() as f32
}

fn same(gpu: &Gpu, one: &Image, other: &Image, what: &str) {
    println!("{what}: {} of 255 apart", apart(one, other));
    assert!(apart(one, other) <= MEAN, "{what}: {} of 255 apart", apart(one, other));
    assert!(one == other || !gpu.is_software(), "{what}: not pixel for pixel");
}

#[test]
fn a_garment_is_drawn_from_where_it_is_stepped_and_nothing_comes_by_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut colliders = colliders();
    colliders.place(&HIDDEN_RETRY);
    let mut offload = offload(gpu, &colliders);
    for quality in [RenderQuality::LOW, FINE] {
        let mut renderer = renderer(gpu, quality);
        renderer.set_subject(Some(shirt().bounds()));
        let source = offload.source(1).expect("it was made to be drawn");
        for _ in 0..5 {
            step(&mut offload, &colliders);
        }
        offload.finish().expect("it comes back");
        let late = offload.positions(1).to_vec();
        step(&mut offload, &colliders);
        let tally = offload.tally();
        renderer.follow(1, &source, bounds(&late)).expect("it lies on the same device");
        let shown = shoot(gpu, &mut renderer);
        assert_eq!((offload.tally(), offload.positions(1)), (tally, &late[..]), "nothing was taken in for it");
        offload.finish().expect("it comes back");
        let newest = offload.positions(1).to_vec();
        assert_ne!(newest, late, "the last step moved the shirt");
        renderer.follow(1, &source, bounds(&newest)).expect("it lies on the same device");
        let followed = shoot(gpu, &mut renderer);
        same(gpu, &followed, &by_cpu(gpu, &mut renderer, &newest), "after six steps");
        assert!(by_cpu(gpu, &mut renderer, &late) != followed, "a picture of the step before is another");
        assert!(apart(&shown, &followed) < 1.0, "a box a step old: {} of 255 apart", apart(&shown, &followed));
    }
}

#[test]
fn a_garment_that_was_not_stepped_yet_is_drawn_as_it_is_put_on() {
    let Some(gpu) = gpu() else { return };
    let offload = offload(gpu, &colliders());
    let mut renderer = renderer(gpu, RenderQuality::LOW);
    let put_on = shoot(gpu, &mut renderer);
    let source = offload.source(1).expect("it was made to be drawn");
    renderer.follow(1, &source, Bounds::of(&shirt().garment.start)).expect("it lies on the same device");
    same(gpu, &shoot(gpu, &mut renderer), &put_on, "put on");
}

#[test]
fn a_body_is_drawn_from_where_it_is_skinned() {
    let Some(gpu) = gpu() else { return };
    let body = wearer();
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).expect("it is a skin");
    let mut skins = Skinning::new(gpu, &[&job, &job]).expect("two bodies fit every device");
    let mut bent = HIDDEN_RETRY;
    bent.iter_mut().skip(1).step_by(2).for_each(|bone| *bone = Affine3A::from_rotation_z(0.03));
    skins.step(gpu, Blend::Linear, &[&HIDDEN_RETRY, &bent]).expect("the step is sent");
    let mut renderer = renderer(gpu, RenderQuality::LOW);
    let put_on = shoot(gpu, &mut renderer);
    let mut posed = job.posed();
    job.run(Blend::Linear, &bent, &mut posed);
    let (mut positions, mut normals) = (body.mesh.positions.clone(), body.normals.clone());
    posed.read(&mut positions, &mut normals);
    renderer.update(0, &positions, &normals).expect("one for each");
    let by_cpu = shoot(gpu, &mut renderer);
    assert!(by_cpu != put_on, "the body has moved");
    let source = skins.source(gpu, 1).expect("it is the second");
    renderer.follow(0, &source, Bounds::of(&positions)).expect("it lies on the same device");
    same(gpu, &shoot(gpu, &mut renderer), &by_cpu, "a body");
    assert!(skins.source(gpu, 2).is_none());
}

#[test]
fn what_does_not_fit_is_not_followed() {
    let Some(gpu) = gpu() else { return };
    let source = offload(gpu, &colliders()).source(0).expect("it was made to be drawn");
    let mut here = renderer(gpu, RenderQuality::LOW);
    let before = shoot(gpu, &mut here);
    let (particles, skin) = (shirt().garment.particles(), shirt().body.len());
    let error = here.follow(0, &source, Bounds::EMPTY).unwrap_err();
    assert!(
        matches!(error, ModelError::Length { surface: 0, got, want, .. } if (got, want) == (particles, skin)),
        "{error}"
    );
    assert_eq!(here.follow(7, &source, Bounds::EMPTY), Err(ModelError::Surface { surface: 7, count: 2 }));
    let other = Gpu::offscreen(&AdapterChoice::Fastest).unwrap();
    let mut there = renderer(&other, RenderQuality::LOW);
    assert_eq!(there.follow(1, &source, Bounds::EMPTY), Err(ModelError::Device { surface: 1 }));
    assert!(shoot(gpu, &mut here) == before, "the last places stay");
    assert_eq!((gpu.fault(), other.fault()), (None, None));
}
