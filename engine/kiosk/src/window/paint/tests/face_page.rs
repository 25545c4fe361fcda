//! The page of a shopper's own face with the body behind it, from a picture of a drawn person to the pixels of the display.
//!
//! `TOILE_FACE_PAGE=docs/pictures` keeps the page there, for the documents. The network's file is no part of the repository: where it is not
//! fetched, this test says so and does not run.

#[path = "../../../../tests/common/painted_face.rs"]
#[expect(dead_code, reason = "of the drawn heads only the picture is used")]
mod painted_face;

use std::env;
use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec2};
use painted_face::{PaintedHead, Shot};
use toile_base::body::Sex;
use toile_base::frame::Joints;
use toile_engine::world::{Snapshot, World};
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::DressedWorld;
use toile_pose::files::{self, NetworkPackage};
use toile_sensors::colour_camera::ColourCamera;
use toile_view::figure::{Appearance, OwnHead};
use toile_view::image::{Image, Size};
use toile_view::raster::{AdapterChoice, Gpu, Offscreen};

use crate::service::config::Config;
use crate::service::stock::Stock;
use crate::visitor::face_maker::FaceMaker;
use crate::visitor::own_face::Portrait;
use crate::visitor::screen::{Action, Page};
use crate::visitor::tests::Play;
use crate::window::body_model::BodyModel;
use crate::window::body_renderer::{BodyRenderer, BodyScene};
use crate::window::overlay::Overlay;
use crate::window::paint::*;

const PAGE: &str = "TOILE_FACE_PAGE";

/// A kiosk's usual display.
const DISPLAY: DisplayMetrics = DisplayMetrics { size: [1080, 1920], pixel_mm: 0.63 };

/// A person 2.3 m before a camera in portrait format that sees all of them.
const STANDING: Shot =
    Shot { below: 0.7, distance: 2.3, yaw: 0.0, height: 0.35, size: Size::new(720, 1280), fov_y: 0.84 };

/// Steps after which the dress hangs.
const STEPS: usize = 180;

/// The head of a drawn person, sought where their joints would say that it is.
fn face(folder: &Path) -> Arc<OwnHead> {
    let (picture, _) = PaintedHead::new(Sex::Female, 900).taken(&STANDING);
    let camera = Some(ColourCamera::pinhole(PaintedHead::lens(&STANDING), Affine3A::IDENTITY));
    let portrait = Portrait { picture, camera, head: Some((Vec2::new(360.0, 210.0), 400.0)) };
    FaceMaker::load(folder).unwrap().make(&portrait, &[Sex::Female]).unwrap().remove(0)
}

/// A frame in which a dress hangs, and its snapshot.
fn hanging() -> (World, Snapshot) {
    let stock = Stock::read(&Config::parse("k.toml", "[wear]\ngarments = [\"strap-dress\"]\n").unwrap()).unwrap();
    let pose: Joints = session::standing(&session::open(None, None).unwrap()).unwrap()[0];
    let DressedWorld { mut world, mut reader, .. } = stock.first.on_mannequin(&pose).unwrap();
    (0..STEPS).for_each(|_| {
        world.step(&pose);
    });
    let snapshot = reader.latest().clone();
    (world, snapshot)
}

/// The page on which the face is, or is not yet.
fn page(on: bool) -> Screen {
    let mut play = Play::dressed();
    play.offer_faces(Ok(()));
    play.press(Action::Open(Page::Face));
    if on {
        play.press(Action::TakeFace);
        play.wait(2_000);
    }
    play.screen()
}

fn drawn(gpu: &Gpu, screen: &Screen, model: &BodyModel, snapshot: &Snapshot) -> Image {
    let [width, height] = DISPLAY.size;
    let canvas = Offscreen::new(gpu, Size::new(width, height)).unwrap();
    let painted = ScreenPainter::default().paint(screen, DISPLAY);
    let (mut body, mut overlay) =
        (BodyRenderer::new(gpu, Offscreen::FORMAT), Overlay::new(&gpu.device, Offscreen::FORMAT));
    body.dress(model, None);
    body.take(snapshot, 0);
    overlay.update_textures(&gpu.device, &gpu.queue, &painted);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let view = canvas.target().create_view(&Default::default());
    let (body_view, colours) = (&screen.body_view, &screen.colours[..]);
    let scene = BodyScene { body_view, colours, free: painted.free, time_s: None, own: None };
    body.draw(&mut encoder, &view, Size::new(width, height), &scene);
    overlay.draw((&gpu.device, &gpu.queue), &mut encoder, (&view, DISPLAY.size), &painted, false);
    gpu.queue.submit([encoder.finish()]);
    canvas.read(gpu).unwrap()
}

/// Share of the picture that has the colour of the person's skin; the mannequin's is paler.
fn skin(image: &Image) -> f64 {
    let is_skin = |p: &&[u8]| {
        let [r, g, b] = [p[0], p[1], p[2]].map(f64::from);
        r > 90.0 && (0.66..0.84).contains(&(g / r)) && (0.48..0.72).contains(&(b / r))
    };
    let pixels = image.bytes().chunks_exact(3);
    let count = pixels.len() as f64;
    pixels.filter(is_skin).count() as f64 / count
}

#[test]
fn a_portrait_becomes_the_face_on_the_page() {
    if let Err(error) = NetworkPackage::Face.check(&files::folder()) {
        assert!(env::var_os(files::FOLDER_VARIABLE).is_none(), "{error}");
        eprintln!("skipped, did not run: {error}");
        return;
    }
    let Ok(gpu) = Gpu::offscreen(&AdapterChoice::Software) else {
        eprintln!("skipped, did not run: install mesa-vulkan-drivers");
        return;
    };
    let (world, snapshot) = hanging();
    let face = face(&files::folder());
    let model = |face: Option<&OwnHead>| BodyModel::of(&world, Appearance::default(), face);
    let before = drawn(&gpu, &page(false), &model(None), &snapshot);
    let after = drawn(&gpu, &page(true), &model(Some(&face)), &snapshot);
    println!("skin on {:.4} of the page, {:.4} with the face", skin(&before), skin(&after));
    if let Some(folder) = env::var_os(PAGE) {
        // Tests run in the folder of their crate.
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
        let mut bytes = Vec::new();
        after.write_png(&mut bytes).unwrap();
        std::fs::write(folder.join("face-page.png"), bytes).unwrap();
    }
    assert!(skin(&before) < 0.005 && skin(&after) > 0.015);
}
