//! Tests of animations.

use std::io::Cursor;

use glam::{Affine3A, DVec3, Quat, Vec3};
use serde_json::{Value, json};

use super::super::{ImportOptions, MovingBody, parse_moving};
use super::{GltfEdit, OURS, alone, moved};
use crate::export::{FrameRate, MovingGlb, MovingPart};
use toile_base::limits::STEP_HZ;
use toile_base::skeleton::{BONES, Joint};

impl GltfEdit {
    fn accessor_of(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let width = ["SCALAR", "", "VEC3", "VEC4"].iter().position(|k| *k == kind).unwrap() + 1;
        let start = self.bin.len();
        self.bin.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        self.json["buffers"][0]["byteLength"] = self.bin.len().into();
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": 4 * numbers.len() }));
        let view = views.len() - 1;
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({
            "bufferView": view, "componentType": 5126, "count": numbers.len() / width, "type": kind,
        }));
        accessors.len() - 1
    }

    /// Moves a node: the times of its keys and what is at each.
    fn animate(&mut self, node: usize, path: &str, interpolation: &str, times: &[f32], values: &[f32]) -> &mut Self {
        let input = self.accessor_of("SCALAR", times);
        let output = self.accessor_of(if path == "rotation" { "VEC4" } else { "VEC3" }, values);
        if !self.json["animations"].is_array() {
            self.json["animations"] = json!([{ "name": "walk", "samplers": [], "channels": [] }]);
        }
        let clip = &mut self.json["animations"][0];
        let sampler = clip["samplers"].as_array().unwrap().len();
        let added = json!({ "input": input, "output": output, "interpolation": interpolation });
        clip["samplers"].as_array_mut().unwrap().push(added);
        let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
        clip["channels"].as_array_mut().unwrap().push(channel);
        self
    }

    fn moving(&self) -> Result<MovingBody, String> {
        parse_moving(&self.bytes(), &alone, "walk", &ImportOptions::default()).map_err(|e| e.to_string())
    }
}

/// Node of one of our joints in [`GltfEdit`].
fn node(joint: Joint) -> usize {
    1 + joint.index()
}

/// Rotation of a joint at a time.
fn turn(moving: &MovingBody, joint: Joint, seconds: f32) -> Quat {
    moving.poses[(seconds * STEP_HZ as f32).round() as usize].local[joint.index()]
}

fn about_x(angle: f32) -> [f32; 4] {
    Quat::from_rotation_x(angle).to_array()
}

#[test]
fn keys_are_followed_as_their_interpolation_says() {
    let turns = [about_x(0.0), about_x(0.8)].concat();
    let knee = Joint::LeftKnee;
    let at = |interpolation: &str, values: &[f32]| {
        let mut edit = GltfEdit::new();
        edit.animate(node(knee), "rotation", interpolation, &[0.5, 1.5], values);
        let moving = edit.moving().unwrap();
        assert_eq!((moving.seconds, moving.poses.len()), (1.5, 181));
        [0.0, 0.75, 1.0, 1.5].map(|t| turn(&moving, knee, t).to_scaled_axis().x)
    };
    let near = |have: [f32; 4], want: [f32; 4]| {
        assert!(have.iter().zip(want).all(|(h, w)| (h - w).abs() < 1e-5), "{have:?} is not {want:?}");
    };
    near(at("LINEAR", &turns), [0.0, 0.2, 0.4, 0.8]);
    near(at("STEP", &turns), [0.0, 0.0, 0.0, 0.8]);
    // Without tangents a cubic spline of quaternions goes by 3 t^2 - 2 t^3.
    let spline = [[0.0; 4], about_x(0.0), [0.0; 4], [0.0; 4], about_x(0.8), [0.0; 4]].concat();
    let part = |t: f32| {
        let s = 3.0 * t * t - 2.0 * t * t * t;
        2.0 * (s * 0.4f32.sin()).atan2(1.0 - s + s * 0.4f32.cos())
    };
    near(at("CUBICSPLINE", &spline), [0.0, part(0.25), part(0.5), 0.8]);
}

#[test]
fn the_root_goes_where_the_file_has_it() {
    let mut edit = GltfEdit::new();
    let rest = OURS.skeleton.at(Joint::Pelvis);
    let gone = rest + Vec3::new(0.5, 0.1, -0.3);
    edit.animate(
        node(Joint::Pelvis),
        "translation",
        "LINEAR",
        &[0.0, 1.0],
        &[rest.to_array(), gone.to_array()].concat(),
    );
    let moving = edit.moving().unwrap();
    let end = moving.poses[120].root - moved();
    assert!(end.distance(gone) < 1e-5, "{end} is not {gone}");
    // Every vertex of the file's own skin goes with it.
    let apart =
        |(p, rest): (DVec3, &Vec3)| (p - rest.as_dvec3()).distance((gone - OURS.skeleton.at(Joint::Pelvis)).as_dvec3());
    let worst =
        moving.surface(120).into_iter().zip(&moving.imported.body.mesh.positions).map(apart).fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst} m");
}

#[test]
fn a_session_that_was_exported_comes_back_as_an_animation() {
    let frames = 16;
    let bent = |k: usize, joint: Joint| Quat::from_rotation_y(0.03 * (k * (joint.index() + 1) % 40) as f32);
    let rest = OURS.skeleton.bone_origins();
    // The bones of a chain, each turned on from the one above.
    let palette = |k: usize| -> [Affine3A; BONES] {
        let mut world = [Affine3A::IDENTITY; BONES];
        for joint in Joint::ALL {
            let i = joint.index();
            let above =
                joint.parent().map_or(Affine3A::from_translation(Vec3::X * 0.01 * k as f32), |p| world[p.index()]);
            let about = Affine3A::from_translation(rest[i]) * Affine3A::from_quat(bent(k, joint));
            world[i] = above * about * Affine3A::from_translation(-rest[i]);
        }
        let whole = toile_base::skeleton::bone_joint;
        std::array::from_fn(|b| whole(b).map_or(world[b], |j| world[j.index()]))
    };
    let rate = FrameRate { frames, hz: 30.0 };
    let mut glb =
        MovingGlb::begin(Cursor::new(Vec::new()), "walk", &[MovingPart::body(&OURS, [0.5; 3])], rate).unwrap();
    for k in 0..frames {
        glb.add(Some(&palette(k)), &[&OURS.mesh.positions]).unwrap();
    }
    let bytes = glb.finish().unwrap().into_inner();
    let moving = parse_moving(&bytes, &alone, "walk", &ImportOptions::default()).unwrap();
    assert_eq!(moving.poses.len(), 61);
    for k in 0..frames {
        for joint in Joint::ALL {
            let have = moving.poses[4 * k].local[joint.index()];
            assert!(have.angle_between(bent(k, joint)) < 2e-3, "{joint:?} in frame {k}");
        }
    }
}

#[test]
fn an_animation_that_cannot_be_followed_is_a_sentence() {
    let knee = node(Joint::LeftKnee);
    let turns = [about_x(0.0), about_x(0.8)].concat();
    let moving = |change: &dyn Fn(&mut GltfEdit)| {
        let mut edit = GltfEdit::new();
        edit.animate(knee, "rotation", "LINEAR", &[0.0, 1.0], &turns);
        change(&mut edit);
        edit.moving().unwrap_err()
    };
    let of_clip = |edit: &mut GltfEdit, path: &str, value: Value| {
        *edit.json["animations"][0].pointer_mut(path).unwrap() = value;
    };
    for (message, change) in [
        (
            "no animation named walk, only run",
            &(|e: &mut GltfEdit| of_clip(e, "/name", json!("run"))) as &dyn Fn(&mut GltfEdit),
        ),
        ("it has no animation", &|e: &mut GltfEdit| e.json["animations"] = json!([])),
        ("interpolated by BEZIER", &|e: &mut GltfEdit| of_clip(e, "/samplers/0/interpolation", json!("BEZIER"))),
        ("lacks a sampler", &|e: &mut GltfEdit| of_clip(e, "/samplers/0", json!({}))),
        ("moves no joint", &|e: &mut GltfEdit| of_clip(e, "/channels/0/target/node", json!(0))),
        ("2 values for 6", &|e: &mut GltfEdit| of_clip(e, "/samplers/0/interpolation", json!("CUBICSPLINE"))),
        ("data of another type than VEC3", &|e: &mut GltfEdit| of_clip(e, "/channels/0/target/path", json!("scale"))),
        ("times that do not rise", &|e: &mut GltfEdit| {
            e.animate(knee, "translation", "LINEAR", &[1.0, 1.0], &[0.0; 6]);
        }),
        ("numbers that say no place", &|e: &mut GltfEdit| {
            e.animate(knee, "translation", "STEP", &[0.0, 1.0], &[f32::NAN; 6]);
        }),
        ("twice at once", &|e: &mut GltfEdit| {
            e.animate(knee, "rotation", "LINEAR", &[0.0, 1.0], &[about_x(0.0), about_x(0.8)].concat());
        }),
        ("more than 1200 s", &|e: &mut GltfEdit| {
            e.animate(knee, "translation", "LINEAR", &[0.0, 5e3], &[0.0; 6]);
        }),
        ("whose place is a matrix", &|e: &mut GltfEdit| {
            let at = OURS.skeleton.offset(Joint::LeftKnee);
            e.json["nodes"][knee] = json!({
                "name": e.json["nodes"][knee]["name"], "children": e.json["nodes"][knee]["children"],
                "matrix": glam::Mat4::from_translation(at).to_cols_array(),
            });
        }),
    ] {
        let said = moving(change);
        assert!(said.contains(message) && !said.contains('\n') && said.len() < 300, "{said}");
    }
}
