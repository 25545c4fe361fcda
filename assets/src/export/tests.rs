//! Tests of exports, read back by a reader that is not ours.

use std::io::Cursor;

use glam::{Affine3A, Quat, Vec2, Vec3};
use gltf::animation::util::ReadOutputs;
use gltf::mesh::util::ReadIndices;

use super::*;
use toile_bake::shape::NO_VERTEX;
use toile_base::body::{Body, Measures, Sex};
use toile_base::skeleton::{BONES, Joint, bone_name};
use toile_base::texture::Texture;

fn body() -> Body {
    crate::body::build(Sex::Male, &Measures::average(Sex::Male)).expect("an average body")
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

/// The local transform of a node in a frame of the only animation.
fn animated(file: &gltf::Gltf, blob: &[u8], node: usize, frame: usize) -> glam::Mat4 {
    let (mut at, turn, _) = file.nodes().nth(node).unwrap().transform().decomposed();
    let mut turn = Quat::from_array(turn);
    for channel in file.animations().flat_map(|a| a.channels()).filter(|c| c.target().node().index() == node) {
        match channel.reader(|_| Some(blob)).read_outputs().unwrap() {
            ReadOutputs::Translations(mut all) => at = all.nth(frame).unwrap(),
            ReadOutputs::Rotations(all) => turn = Quat::from_array(all.into_f32().nth(frame).unwrap()),
            _ => {}
        }
    }
    glam::Mat4::from_rotation_translation(turn, at.into())
}

/// Three frames of a body that turns and a kerchief that rises.
fn session() -> (Vec<[Affine3A; BONES]>, Vec<Vec<Vec3>>, Vec<u8>) {
    let body = body();
    let turned = |k: usize| {
        let origin = body.skeleton.at(Joint::Pelvis);
        let turn = Affine3A::from_rotation_translation(Quat::from_rotation_y(2.0 * k as f32), Vec3::X * k as f32);
        [Affine3A::from_translation(origin) * turn * Affine3A::from_translation(-origin); BONES]
    };
    let palettes: Vec<_> = (0..3).map(turned).collect();
    let cloth = |k: usize| vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 0.1 * k as f32), Vec3::Y * k as f32];
    let cloths: Vec<_> = (0..3).map(cloth).collect();
    let picture = Texture { width: 2, height: 1, texels: vec![[10, 20, 30, 255], [40, 50, 60, 255]] };
    let look = SurfaceLook { picture: Some(picture.into()), opacity: 0.5, ..SurfaceLook::cloth([0.5; 3]) };
    let uv = |u: f32| [Vec2::new(u, 0.25); 4];
    let kerchief = MovingPart {
        name: "kerchief".into(),
        vertices: 4,
        faces: vec![[0, 1, 2, NO_VERTEX], [0, 2, 3, NO_VERTEX]],
        uvs: vec![uv(0.0), uv(2.0)],
        look,
        skinned: None,
    };
    let rate = FrameRate { frames: 3, hz: 30.0 };
    let parts = [MovingPart::body(&body, [0.5; 3]), kerchief];
    let mut glb = MovingGlb::begin(Cursor::new(Vec::new()), "session", &parts, rate).unwrap();
    for (palette, cloth) in palettes.iter().zip(&cloths) {
        glb.add(Some(palette), &[&body.mesh.positions, cloth]).unwrap();
    }
    assert!(glb.add(None, &[&[], &[]]).is_err(), "a frame too many");
    let bytes = glb.finish().unwrap().into_inner();
    (palettes, cloths, bytes)
}

#[test]
fn a_session_moves_by_targets_and_by_its_skeleton() {
    let (palettes, cloths, bytes) = session();
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = file.blob.clone().unwrap();
    let kerchief = file.meshes().find(|m| m.name() == Some("kerchief")).unwrap();
    let primitive = kerchief.primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&blob));
    let first: Vec<Vec3> = reader.read_positions().unwrap().map(Vec3::from).collect();
    // The corners of the second face lie elsewhere in the picture: two copies behind the four vertices.
    assert_eq!(first, [&cloths[0][..], &[cloths[0][0], cloths[0][2]]].concat());
    let targets: Vec<Vec<Vec3>> =
        reader.read_morph_targets().map(|(p, ..)| p.unwrap().map(Vec3::from).collect()).collect();
    for (k, target) in targets.iter().enumerate() {
        let worst = (0..4).map(|v| (first[v] + target[v]).distance(cloths[k + 1][v])).fold(0.0, f32::max);
        assert!(worst < 1e-6, "frame {}: {worst}", k + 1);
    }
    let uvs: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
    assert_eq!((uvs[0], uvs[4], uvs[3]), ([0.0, 0.75], [2.0, 0.75], [2.0, 0.75]));
    let material = primitive.material();
    assert_eq!((material.alpha_mode(), material.double_sided()), (gltf::material::AlphaMode::Blend, true));
    let gltf::image::Source::View { view, mime_type } =
        material.pbr_metallic_roughness().base_color_texture().unwrap().texture().source().source()
    else {
        panic!("the picture is inside")
    };
    let png = &blob[view.offset()..][..view.length()];
    assert_eq!((mime_type, crate::texture::decode(png).unwrap().texels[1]), ("image/png", [40, 50, 60, 255]));
    // The weights: one target a frame.
    let of_kerchief = |c: &gltf::animation::Channel<'_>| {
        c.target().property() == gltf::animation::Property::MorphTargetWeights
            && c.target().node().name() == Some("kerchief")
    };
    let animation = file.animations().next().unwrap();
    let channel = animation.channels().find(of_kerchief).unwrap();
    let Some(ReadOutputs::MorphTargetWeights(weights)) = channel.reader(|_| Some(&blob)).read_outputs() else {
        panic!("weights")
    };
    assert!(weights.into_f32().eq([0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    let times: Vec<f32> = channel.reader(|_| Some(&blob)).read_inputs().unwrap().collect();
    assert!((times[2] - 2.0 / 30.0).abs() < 1e-7);
    // The skeleton: each joint's place times its inverse bind matrix is the skin matrix.
    let skin = file.skins().next().unwrap();
    let inverse: Vec<glam::Mat4> = skin
        .reader(|_| Some(&blob))
        .read_inverse_bind_matrices()
        .unwrap()
        .map(|m| glam::Mat4::from_cols_array_2d(&m))
        .collect();
    let nodes: Vec<gltf::Node<'_>> = file.nodes().collect();
    let parent = |i: usize| nodes.iter().find(|n| n.children().any(|c| c.index() == i)).map(gltf::Node::index);
    for (frame, palette) in palettes.iter().enumerate() {
        for (k, joint) in skin.joints().enumerate() {
            let (mut place, mut next) = (glam::Mat4::IDENTITY, Some(joint.index()));
            while let Some(i) = next {
                place = animated(&file, &blob, i, frame) * place;
                next = parent(i);
            }
            let skinned = place * inverse[k];
            assert!(skinned.abs_diff_eq(palette[k].into(), 1e-5), "{} in frame {frame}", joint.name().unwrap());
        }
    }
}

#[test]
fn a_body_has_what_linear_blending_misses() {
    let body = body();
    // One arm turned by a right angle at the elbow: blended matrices are no rotations there.
    let mut palette = [Affine3A::IDENTITY; BONES];
    let at = body.skeleton.at(Joint::LeftElbow);
    let bent = Affine3A::from_translation(at) * Affine3A::from_rotation_y(1.5) * Affine3A::from_translation(-at);
    for joint in [Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand] {
        palette[joint.index()] = bent;
    }
    let blend = |v: usize| {
        let weighted = body.weights[v].iter().map(|(b, w)| glam::Mat4::from(palette[usize::from(b)]) * w);
        weighted.fold(glam::Mat4::ZERO, |sum, m| sum + m)
    };
    // Every vertex away from the linear skin by a way of its own, and one that is on it.
    let rest = &body.mesh.positions;
    let linear: Vec<Vec3> = rest.iter().enumerate().map(|(v, p)| blend(v).transform_point3(*p)).collect();
    let shown: Vec<Vec3> = linear.iter().enumerate().map(|(v, p)| *p + Vec3::Y * 1e-6 * v as f32).collect();
    let rate = FrameRate { frames: 1, hz: 30.0 };
    let part = MovingPart::body(&body, [0.5; 3]);
    let mut glb = MovingGlb::begin(Cursor::new(Vec::new()), "session", &[part], rate).unwrap();
    glb.add(Some(&palette), &[&shown]).unwrap();
    let bytes = glb.finish().unwrap().into_inner();
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = file.blob.clone().unwrap();
    let primitive = file.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&blob));
    let target: Vec<Vec3> = reader.read_morph_targets().next().unwrap().0.unwrap().map(Vec3::from).collect();
    let worst = (0..rest.len()).map(|v| blend(v).transform_point3(rest[v] + target[v]).distance(shown[v]));
    let worst = worst.fold(0.0, f32::max);
    assert!(worst < 1.1e-5, "{worst} m of {} m", 1e-6 * rest.len() as f32);
    assert_eq!(target[1], Vec3::ZERO, "what is alike has no target");
    assert!(target[rest.len() - 1].length() > 1e-3);
}

#[test]
fn a_session_cut_short_is_no_file() {
    let part = MovingPart { skinned: None, ..MovingPart::body(&body(), [0.5; 3]) };
    let rate = FrameRate { frames: 2, hz: 30.0 };
    let mut bytes = Cursor::new(Vec::new());
    let mut glb = MovingGlb::begin(&mut bytes, "session", std::slice::from_ref(&part), rate).unwrap();
    glb.add(None, &[&body().mesh.positions]).unwrap();
    assert!(glb.finish().is_err());
    assert!(gltf::Gltf::from_slice(bytes.get_ref()).is_err());
    let rate = FrameRate { frames: MAX_GLB_FRAMES + 1, hz: 30.0 };
    let refused = ExportPlan::new("s", &[ExportFormat::Glb], vec![part.clone()], rate).unwrap_err();
    assert!(refused.contains("1200 frames, and this has 1201"), "{refused}");
    assert!(ExportPlan::new("s", &[ExportFormat::Usd], vec![part], rate).is_ok());
}

#[test]
fn parts_of_one_name_get_files_of_their_own() {
    let part = |name: &str| MovingPart { name: name.into(), ..MovingPart::body(&body(), [0.5; 3]) };
    let parts = vec![part("a b/c"), part("a-b-c"), part("a-b_c")];
    let rate = FrameRate { frames: 2, hz: 30.0 };
    let plan = ExportPlan::new("my run", &[ExportFormat::Pc2, ExportFormat::Glb], parts, rate).unwrap();
    let files = plan.files();
    assert_eq!(files[..4], ["my-run.glb", "my-run-a-b-c.obj", "my-run-a-b-c.mtl", "my-run-a-b-c.pc2"]);
    assert_eq!((files[6].as_str(), files[9].as_str()), ("my-run-a-b-c-2.pc2", "my-run-a-b_c-3.pc2"));
}
