//! Laws of exports, read back by a reader that is not ours.

use glam::{Affine3A, Quat, Vec3};
use gltf::mesh::util::ReadIndices;

use super::*;
use crate::body::{Body, Measures, Sex};
use crate::skeleton::{BONES, Joint, bone_name};

fn body() -> Body {
    Body::build(Sex::Male, &Measures::average(Sex::Male)).expect("an average body")
}

const TRIANGLE: WornGarment<'static> = WornGarment {
    name: "kerchief \"one\"",
    positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
    triangles: &[[0, 1, 2]],
    srgb: [0.5, 0.0, 1.0],
};

/// A pose: every bone turned about the pelvis, and moved.
fn palette(body: &Body) -> [Affine3A; BONES] {
    let origin = body.skeleton.at(Joint::Pelvis);
    let turn = Affine3A::from_rotation_translation(Quat::from_rotation_y(0.7), Vec3::new(0.1, 0.0, -0.2));
    [Affine3A::from_translation(origin) * turn * Affine3A::from_translation(-origin); BONES]
}

#[test]
fn another_reader_finds_what_was_written() {
    let mut body = body();
    body.mesh.uvs = body.mesh.positions.iter().map(|p| p.truncate()).collect();
    let bytes = glb(&DressedBody { body: &body, palette: None, worn: &[TRIANGLE] });
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = file.blob.clone().unwrap();
    assert_eq!(bytes.len() % 4, 0);
    assert_eq!((file.meshes().count(), file.skins().count(), file.materials().count()), (2, 1, 2));
    let primitive = file.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&blob));
    let positions: Vec<Vec3> = reader.read_positions().unwrap().map(Vec3::from).collect();
    assert_eq!(positions, body.mesh.positions);
    let bounds = primitive.bounding_box();
    let least = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    assert_eq!(Vec3::from(bounds.min), least);
    let Some(ReadIndices::U32(indices)) = reader.read_indices() else { panic!("indices of 32 bits") };
    assert!(indices.eq(body.mesh.triangles.iter().flatten().copied()));
    assert!(reader.read_tex_coords(0).unwrap().into_f32().eq(body.mesh.uvs.iter().map(|uv| uv.to_array())));
    assert!(reader.read_normals().unwrap().all(|n| (Vec3::from(n).length() - 1.0).abs() < 1e-5));
    for (weights, w) in reader.read_weights(0).unwrap().into_f32().zip(&body.weights) {
        assert_eq!(weights, w.weights);
    }
    let cloth = file.materials().nth(1).unwrap();
    assert_eq!((cloth.name(), cloth.double_sided()), (Some(TRIANGLE.name), true));
    let colour = cloth.pbr_metallic_roughness().base_color_factor();
    // Mid grey of sRGB is 21.4 % of the light.
    assert!((colour[0] - 0.214).abs() < 1e-3 && colour[1] == 0.0 && colour[2] == 1.0, "{colour:?}");
}

#[test]
fn joints_carry_the_skin_where_the_pose_puts_it() {
    let body = body();
    for palette in [None, Some(&palette(&body))] {
        let bytes = glb(&DressedBody { body: &body, palette, worn: &[] });
        let file = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = file.blob.clone().unwrap();
        let skin = file.skins().next().unwrap();
        let inverse: Vec<glam::Mat4> = skin
            .reader(|_| Some(&blob))
            .read_inverse_bind_matrices()
            .unwrap()
            .map(|m| glam::Mat4::from_cols_array_2d(&m))
            .collect();
        let nodes: Vec<gltf::Node<'_>> = file.nodes().collect();
        let parent = |i: usize| nodes.iter().find(|n| n.children().any(|c| c.index() == i)).map(gltf::Node::index);
        for (k, joint) in skin.joints().enumerate() {
            let (mut place, mut next) = (glam::Mat4::IDENTITY, Some(joint.index()));
            while let Some(i) = next {
                place = glam::Mat4::from_cols_array_2d(&nodes[i].transform().matrix()) * place;
                next = parent(i);
            }
            let wanted = palette.map_or(glam::Mat4::IDENTITY, |p| glam::Mat4::from(p[k]));
            assert!((place * inverse[k]).abs_diff_eq(wanted, 1e-5), "{}", joint.name().unwrap());
        }
    }
}

#[test]
fn bones_have_their_standard_names() {
    let names: Vec<String> = (0..BONES).filter_map(bone_name).collect();
    assert_eq!((names[0].as_str(), names[Joint::LeftShoulder.index()].as_str()), ("sacroiliac", "l_shoulder"));
    assert_eq!(names.iter().collect::<std::collections::BTreeSet<_>>().len(), BONES);
}

#[test]
fn the_same_body_gives_the_same_bytes() {
    let body = body();
    let palette = palette(&body);
    let all = || glb(&DressedBody { body: &body, palette: Some(&palette), worn: &[TRIANGLE] });
    assert_eq!(all(), all());
}
