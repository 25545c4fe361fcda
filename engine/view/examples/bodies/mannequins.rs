//! Mannequins by choice: the head that all have, five tones of skin, three caps of hair, in `mannequins.png`.

use std::f32::consts::FRAC_PI_2;
use std::{error::Error, fs::File, io::BufWriter, path::Path};

use glam::Vec3;
use toile_base::body::{Body, Measures, Sex};
use toile_view::contact_sheet;
use toile_view::figure::{Appearance, Figure, Hair, SkinTone};
use toile_view::image::{Image, Size};
use toile_view::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

const SIZE: Size = Size::new(320, 400);

/// How far the camera is from a whole body (m).
const AWAY_M: f32 = 5.2;

/// From the crown down, as far as a bust is shown, and half as wide (m).
const BUST_M: f32 = 0.44;

/// Pictures in a row.
const COLUMNS: usize = 6;

/// Where the camera stands for a bust: before the face, or at its left.
const FRONT: f32 = 0.0;
const TURNED: f32 = 0.55;
const SIDE: f32 = FRAC_PI_2;

/// Writes the picture of all mannequins.
pub fn write_all(folder: &str) -> Result<(), Box<dyn Error>> {
    let path = Path::new(folder).join("mannequins.png");
    let [woman, man] = Sex::ALL.map(|sex| toile_assets::body::build(sex, &Measures::average(sex)));
    let (woman, man) = (woman?, man?);
    let plain = Appearance::default();
    let tone = |skin| Appearance { skin, ..plain };
    let cut = |hair, skin| Appearance { skin, hair };
    use Hair::{Bob, Bun, Short};
    use SkinTone::{Honey, Sand, Umber};
    let mut shots = Vec::new();
    for (body, who) in [(&woman, "woman"), (&man, "man")] {
        for (yaw, from) in [(FRONT, "front"), (TURNED, "turned"), (SIDE, "side")] {
            shots.push((bust(body, plain, yaw), format!("{who}, {from}")));
        }
    }
    for (i, skin) in SkinTone::ALL.into_iter().enumerate() {
        shots.push((whole(if i % 2 == 0 { &woman } else { &man }, tone(skin)), skin.name().to_owned()));
    }
    for (body, hair, skin) in [(&man, Short, Honey), (&woman, Bob, Sand), (&woman, Bun, Umber)] {
        for yaw in [TURNED, SIDE] {
            shots.push((bust(body, cut(hair, skin), yaw), format!("{hair}, {skin}")));
        }
    }
    let (images, captions): (Vec<&Image>, Vec<&str>) = shots.iter().map(|(i, c)| (i, c.as_str())).unzip();
    let sheet = contact_sheet::contact_sheet(&images, COLUMNS, &captions);
    sheet.write_png(&mut BufWriter::new(File::create(path)?))?;
    Ok(())
}

fn traced(body: &Body, appearance: Appearance, shot: impl Fn(&TracedScene) -> Image) -> Image {
    let figure = Figure::of(body, appearance);
    let skin = PictureSurface {
        positions: &figure.rest,
        normals: &figure.normals,
        triangles: &figure.triangles,
        colours: Colours::One(figure.colour),
        material: Material::Skin,
        look: Some(figure.look.shown()),
    };
    let surfaces = [skin];
    shot(&TracedScene::build(PictureScene { surfaces: &surfaces, floor: true }))
}

fn whole(body: &Body, appearance: Appearance) -> Image {
    traced(body, appearance, |scene| {
        let Bounds { min, max } = scene.bounds();
        let target = (min + max) * 0.5;
        let camera = OrbitCamera { target, yaw: FRONT, height: 0.25, distance: AWAY_M, fov_y: 0.38 };
        scene.render(&camera, SIZE, TraceQuality::Still)
    })
}

fn bust(body: &Body, appearance: Appearance, yaw: f32) -> Image {
    let top = Bounds::of(&body.mesh.positions).max.y;
    let camera =
        OrbitCamera { target: Vec3::new(0.0, top - 0.42 * BUST_M, 0.0), yaw, height: 0.05, distance: 2.0, fov_y: 0.24 };
    traced(body, appearance, |scene| scene.render(&camera, SIZE, TraceQuality::Still))
}
