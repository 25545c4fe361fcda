//! The picture of the twist test: the shopper's forearm with its hand turned, by each blend, split and not.

use glam::{Affine3A, Quat, Vec3};
use toile_assets::scene;
use toile_base::body::Body;
use toile_base::mesh::{SkinWeights, vertex_normals};
use toile_base::skeleton::{BONES, Joint, Pose};
use toile_engine::body::palette;
use toile_engine::skin::Blend;
use toile_view::contact_sheet;
use toile_view::image::{Image, Size};
use toile_view::scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{self, TraceQuality};

use super::error::SkinningError;
use super::shapes::{posed, unsplit};

/// One panel (pixels).
const PANEL: Size = Size::new(360, 300);

/// Turns of the hand about the forearm (degrees), a row each.
const TURNS: [f32; 3] = [0.0, 90.0, 120.0];

/// How the forearm is skinned, a column each: caption, blend, whether the limb is split.
const COLUMNS: [(&str, Blend, bool); 4] = [
    ("linear, two bones", Blend::Linear, false),
    ("linear, split", Blend::Linear, true),
    ("dual quaternions, two bones", Blend::Dual, false),
    ("dual quaternions, split", Blend::Dual, true),
];

/// A sheet of the left forearm: a row a turn of the hand, a column a way of skinning.
///
/// # Errors
/// Where the shopper cannot be built.
pub fn twist_picture() -> Result<Image, SkinningError> {
    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures)?;
    let plain: Vec<SkinWeights> = body.weights.iter().map(unsplit).collect();
    let (mut images, mut captions) = (Vec::new(), Vec::new());
    for degrees in TURNS {
        for (caption, blend, split) in COLUMNS {
            let weights = if split { &body.weights } else { &plain };
            images.push(panel(&body, weights, degrees, blend)?);
            captions.push(format!("{degrees} degrees: {caption}"));
        }
    }
    let captions: Vec<&str> = captions.iter().map(String::as_str).collect();
    Ok(contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), COLUMNS.len(), &captions))
}

fn panel(body: &Body, weights: &[SkinWeights], degrees: f32, blend: Blend) -> Result<Image, SkinningError> {
    let skeleton = &body.skeleton;
    let axis = skeleton.offset(Joint::LeftWrist).normalize();
    let mut pose = Pose::rest(skeleton);
    pose.local[Joint::LeftWrist.index()] = Quat::from_axis_angle(axis, degrees.to_radians());
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, &pose, &mut bones);
    let positions = posed(&body.mesh.positions, weights, &bones, blend)?;
    let mut normals = vec![Vec3::ZERO; positions.len()];
    vertex_normals(&positions, &body.mesh.triangles, &mut normals);
    let surfaces = [PictureSurface {
        positions: &positions,
        normals: &normals,
        triangles: &body.mesh.triangles,
        colours: Colours::One(MANNEQUIN),
        material: Material::Skin,
        look: None,
    }];
    let middle = skeleton.at(Joint::LeftElbow).lerp(skeleton.at(Joint::LeftWrist), 0.85);
    let camera = OrbitCamera { target: middle, yaw: 0.5, height: 0.25, distance: 1.15, fov_y: 0.42 };
    Ok(trace::render(&PictureScene { surfaces: &surfaces, floor: false }, &camera, PANEL, TraceQuality::Still))
}
