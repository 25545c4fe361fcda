//! A picture of a head before and after it was adapted, with hair.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};
use toile_assets::body::base::BaseBody;
use toile_assets::body::shape::Shapes;
use toile_base::body::{Region, Sex};
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Joint;
use toile_base::texture::Texture;
use toile_pose::face::{AdaptedHead, HeadTexture};
use toile_view::cloth_look::{GarmentLook, TileLevels};
use toile_view::contact_sheet;
use toile_view::figure::{Hair, HairMesh};
use toile_view::image::{Image, Size, linear};
use toile_view::scene::{Bounds, Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

/// A picture of one side.
const STILL: Size = Size::new(420, 520);

/// Turns of the camera.
const VIEWS: [f32; 3] = [0.0, 0.7, FRAC_PI_2];

/// How much of the neck is shown below the head's border (m).
const NECK: f32 = 0.02;

/// Colour of the hair, sRGB bytes: a dark brown.
pub(super) const HAIR: [u8; 3] = [76, 57, 47];

/// A head with what it looks like.
struct ShownHead<'a> {
    positions: Vec<Vec3>,
    hair: Option<HairMesh>,
    look: Option<&'a GarmentLook>,
    colour: Vec3,
}

/// The hair of a head of a sex whose body's vertices are here (m); none for no hair.
pub(super) fn hair_on(sex: Sex, positions: &[Vec3], hair: Hair) -> Option<HairMesh> {
    let base = Shapes::of(sex).base();
    HairMesh::of(positions, &base.regions, &base.triangles, base.skeleton.at(Joint::Head), hair)
}

/// Above the mannequin's head, below the adapted one with its texture, each from three sides.
pub(super) fn before_and_after(head: &AdaptedHead, texture: &HeadTexture, hair: Hair) -> Image {
    let base = Shapes::of(head.sex).base();
    let look = look(base, texture);
    let own: Vec<Vec3> = head.rest.iter().map(|p| p.as_vec3()).collect();
    let skin = Vec3::from_array(texture.skin.map(|b| linear(f32::from(b) / 255.0)));
    let before = ShownHead {
        hair: hair_on(head.sex, &base.positions, hair),
        positions: base.positions.clone(),
        look: None,
        colour: MANNEQUIN,
    };
    let after = ShownHead { hair: hair_on(head.sex, &own, hair), positions: own, look: Some(&look), colour: skin };
    let images: Vec<Image> = [before, after].iter().flat_map(|shown| sides(base, shown)).collect();
    let captions = ["the mannequin", "", "", "adapted to the photographs", "", ""];
    contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), VIEWS.len(), &captions)
}

/// The texture as a look of the skin.
fn look(base: &BaseBody, texture: &HeadTexture) -> GarmentLook {
    let picture = &texture.picture;
    let texels = picture.pixels().map(|p| [p.0[0], p.0[1], p.0[2], 255]).collect();
    let tile = Texture { width: picture.width(), height: picture.height(), texels };
    let corners: Vec<[Vec2; 3]> = base.triangle_corners().iter().map(|t| t.map(|k| base.uvs[k as usize])).collect();
    GarmentLook { tile: Some(TileLevels::of(&tile)), corners, opacity: 1.0, ..GarmentLook::default() }
}

/// A head from all sides.
fn sides(base: &BaseBody, shown: &ShownHead<'_>) -> Vec<Image> {
    let mut normals = vec![Vec3::ZERO; shown.positions.len()];
    vertex_normals(&shown.positions, &base.triangles, &mut normals);
    let mut surfaces = vec![PictureSurface {
        positions: &shown.positions,
        normals: &normals,
        triangles: &base.triangles,
        colours: Colours::One(shown.colour),
        material: Material::Skin,
        look: shown.look.map(GarmentLook::shown),
    }];
    surfaces.extend(shown.hair.as_ref().map(|hair| PictureSurface {
        positions: &hair.positions,
        normals: &hair.normals,
        triangles: &hair.triangles,
        colours: Colours::One(Vec3::from_array(HAIR.map(|b| linear(f32::from(b) / 255.0)))),
        material: Material::Skin,
        look: None,
    }));
    let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: false });
    let of_head = shown.positions.iter().zip(&base.regions).filter(|(_, r)| **r == Region::Head);
    let hair = shown.hair.iter().flat_map(|hair| &hair.positions);
    let points: Vec<Vec3> = of_head.map(|(p, _)| *p).chain(hair.copied()).collect();
    let bounds = Bounds::of(&points);
    let bounds = Bounds { min: bounds.min - Vec3::Y * NECK, ..bounds };
    let aspect = STILL.width as f32 / STILL.height as f32;
    // The camera stands at the height of the head's middle, as one before whom a face stands does.
    let camera = |yaw: f32| OrbitCamera { height: 0.0, ..OrbitCamera::framing(&bounds, yaw, aspect) };
    VIEWS.iter().map(|yaw| scene.render(&camera(*yaw), STILL, TraceQuality::Still)).collect()
}
