//! Mannequins of every tone and with every hair, by both ways of drawing.

use glam::Vec3;
use toile_view::figure::{Appearance, Figure, Hair, SkinTone};
use toile_view::image::Image;
use toile_view::raster::{Model, Offscreen, Renderer};
use toile_view::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace;

use super::dressed::wearer;
use super::{FINE, SIZE, gpu, pixels, shoot};

/// A bust by the ray tracer and by the rasteriser.
fn both(appearance: Appearance) -> Option<[Image; 2]> {
    let gpu = gpu()?;
    let figure = Figure::of(&wearer(), appearance);
    let skin = PictureSurface {
        positions: &figure.rest,
        normals: &figure.normals,
        triangles: &figure.triangles,
        colours: Colours::One(figure.colour),
        material: Material::Skin,
        look: Some(figure.look.shown()),
    };
    let target = Vec3::Y * (Bounds::of(&figure.rest).max.y - 0.16);
    let camera = OrbitCamera { target, yaw: 0.7, height: 0.05, distance: 2.0, fov_y: 0.26 };
    let scene = PictureScene { surfaces: &[skin], floor: true };
    let theirs = trace::render(&scene, &camera, SIZE, trace::TraceQuality::Motion);
    let mut renderer = Renderer::new(gpu, Offscreen::FORMAT, FINE);
    renderer.set_model(&Model::of_outfit(&figure, &[])).expect("the model is whole");
    renderer.update(0, &figure.rest, &figure.normals).expect("as many as there are");
    Some([theirs, shoot(gpu, &mut renderer, &camera)])
}

#[test]
fn tones_and_hair_are_the_same_in_both_pictures() {
    let hairs = [Hair::None, Hair::Short, Hair::Bob, Hair::Bun, Hair::None, Hair::None];
    for (skin, hair) in SkinTone::ALL.into_iter().zip(hairs) {
        let Some([theirs, ours]) = both(Appearance { skin, hair }) else { return };
        let off: Vec<f32> = pixels(&theirs).iter().zip(pixels(&ours)).map(|(a, b)| (*a - b).length()).collect();
        let mean = off.iter().sum::<f32>() / off.len() as f32;
        let far = off.iter().filter(|d| **d > 40.0).count() as f32 / off.len() as f32;
        println!("{skin}, {hair}: {mean:.2} ({far:.4}) of 255");
        assert!(mean < 6.0 && far < 0.015, "{skin}, {hair}: {mean} off, {far} of the pixels far");
    }
}
