//! Tests of imports.

use std::sync::LazyLock;

use glam::{Mat4, Vec3};
use serde_json::{Value, json};

use super::*;
use crate::export::{DressedBody, glb};
use toile_base::body::Measures;
use toile_base::limits::MAX_BODY_VERTICES;

mod animation;
mod damage;

/// Our own female body, and its GLB file: every import test begins with it.
static OURS: LazyLock<Body> =
    LazyLock::new(|| crate::body::build(Sex::Female, &Measures::average(Sex::Female)).expect("an average body"));
static FILE: LazyLock<Vec<u8>> = LazyLock::new(|| glb(&DressedBody { body: &OURS, palette: None, worn: &[] }));

/// A GLB file taken apart, to be changed.
#[derive(Clone)]
struct GltfEdit {
    json: Value,
    bin: Vec<u8>,
}

impl GltfEdit {
    fn new() -> Self {
        let word = |at: usize| u32::from_le_bytes(FILE[at..at + 4].try_into().unwrap()) as usize;
        let (start, size) = (20, word(12));
        let json = serde_json::from_slice(&FILE[start..start + size]).unwrap();
        Self { json, bin: FILE[start + size + 8..].to_vec() }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = b"glTF".to_vec();
        let length = (28 + text.len() + self.bin.len()) as u32;
        for word in [2, length, text.len() as u32, 0x4e4f_534a] {
            out.extend(word.to_le_bytes());
        }
        out.extend(text);
        out.extend((self.bin.len() as u32).to_le_bytes());
        out.extend(0x004e_4942_u32.to_le_bytes());
        out.extend(&self.bin);
        out
    }

    /// Node of a joint.
    fn node(&mut self, name: &str) -> &mut Value {
        let nodes = self.json["nodes"].as_array_mut().unwrap();
        nodes.iter_mut().find(|n| n["name"] == name).unwrap()
    }

    /// Accessor of an attribute of the body.
    fn accessor(&self, attribute: &str) -> usize {
        self.json["meshes"][0]["primitives"][0]["attributes"][attribute].as_u64().unwrap() as usize
    }

    /// First byte of an accessor's data.
    fn start(&self, accessor: usize) -> usize {
        let view = self.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
        self.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize
    }

    /// Overwrites the `k`-th number of an attribute.
    fn set(&mut self, attribute: &str, k: usize, value: f32) {
        let at = self.start(self.accessor(attribute)) + 4 * k;
        self.bin[at..at + 4].copy_from_slice(&value.to_le_bytes());
    }

    /// Multiplies every position and inverse bind translation: another unit.
    fn scale(&mut self, factor: f32) {
        let matrices = self.json["skins"][0]["inverseBindMatrices"].as_u64().unwrap() as usize;
        let joints = self.json["accessors"][matrices]["count"].as_u64().unwrap() as usize;
        let vertices = self.json["accessors"][0]["count"].as_u64().unwrap() as usize;
        let (positions, matrices) = (self.start(self.accessor("POSITION")), self.start(matrices));
        let all = (0..3 * vertices).map(|k| positions + 4 * k);
        let moves = (0..joints).flat_map(|j| (12..15).map(move |k| matrices + 64 * j + 4 * k));
        for at in all.chain(moves).collect::<Vec<_>>() {
            let x = f32::from_le_bytes(self.bin[at..at + 4].try_into().unwrap()) * factor;
            self.bin[at..at + 4].copy_from_slice(&x.to_le_bytes());
        }
        for node in self.json["nodes"].as_array_mut().unwrap() {
            for x in node["translation"].as_array_mut().into_iter().flatten() {
                *x = (x.as_f64().unwrap() * f64::from(factor)).into();
            }
        }
    }

    /// Hangs the pelvis under a node of its own.
    fn below(&mut self, node: Value) {
        let nodes = self.json["nodes"].as_array_mut().unwrap();
        nodes.push(node);
        let (top, pelvis) = (nodes.len() - 1, 1);
        nodes[top]["children"] = json!([pelvis]);
        self.json["scenes"][0]["nodes"] = json!([0, top]);
    }

    fn import(&self) -> Result<ImportedBody, Flaw> {
        parse(&self.bytes(), &alone, &ImportOptions::default())
    }

    /// The sentence that is said, which ends with its cure.
    fn message(&self) -> String {
        let message = self.import().unwrap_err().to_string();
        assert!(message.contains(['l', ';', ',']) && !message.contains('\n') && message.len() < 300, "{message}");
        message
    }
}

fn alone(_: &str) -> Result<Vec<u8>, String> {
    Err("nothing lies beside it; put its buffer there".into())
}

/// Largest distance between the vertices of two bodies (m).
fn apart(a: &Body, b: &Body) -> f32 {
    a.mesh.positions.iter().zip(&b.mesh.positions).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

/// How our own body is moved by an import: the middle of its hips goes to x = z = 0.
fn moved() -> Vec3 {
    let s = &OURS.skeleton;
    -(0.5 * (s.at(Joint::LeftHip) + s.at(Joint::RightHip))).with_y(0.0)
}

#[test]
fn our_own_body_comes_back() {
    let ImportedBody { body, report } = GltfEdit::new().import().unwrap();
    assert_eq!((report.dialect, report.parts, report.boundary_edges), ("H-Anim 2", 1, 0));
    assert_eq!(report.joints.len(), toile_base::skeleton::JOINTS);
    assert!(report.notes.is_empty(), "{:?}", report.notes);
    assert_eq!(body.mesh.triangles, OURS.mesh.triangles);
    let shift = moved();
    for (a, b) in body.mesh.positions.iter().zip(&OURS.mesh.positions) {
        assert!(a.distance(*b + shift) < 1e-6);
    }
    for (a, b) in body.skeleton.rest.iter().zip(&OURS.skeleton.rest) {
        assert!(a.distance(*b + shift) < 1e-6);
    }
    for (a, b) in body.weights.iter().zip(&OURS.weights) {
        assert!((a.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6 && b.bones.len() == a.bones.len());
    }
    let (m, ours) = (&body.measures, &OURS.measures);
    println!("{m:?}\n{ours:?}\n{:?}\n{:?}", body.levels, OURS.levels);
    assert!((m.stature - ours.stature).abs() < 1e-3);
    assert!((m.shoulder_breadth - ours.shoulder_breadth).abs() < 2e-3);
    assert!((m.hip_girth - ours.hip_girth).abs() < 0.01);
    assert!((m.chest_girth - ours.chest_girth).abs() < 0.01);
    assert!((m.waist_girth - ours.waist_girth).abs() < 0.01);
    assert!((body.levels.crotch - OURS.levels.crotch).abs() < 0.02 && (body.levels.hip - OURS.levels.hip).abs() < 0.02);
    let same = body.regions.iter().zip(&OURS.regions).filter(|(a, b)| a == b).count();
    assert!(same as f32 > 0.9 * body.regions.len() as f32, "{same} of {}", body.regions.len());
}

#[test]
fn the_same_file_gives_the_same_bits() {
    assert_eq!(GltfEdit::new().import(), GltfEdit::new().import());
}

#[test]
fn units_are_recognised_and_said() {
    let plain = GltfEdit::new().import().unwrap();
    for (factor, unit) in [(10.0, "decimetres"), (100.0, "centimetres"), (1000.0, "millimetres")] {
        let mut edit = GltfEdit::new();
        edit.scale(factor);
        let ImportedBody { body, report } = edit.import().unwrap();
        assert!(report.notes[0].contains(unit), "{:?}", report.notes);
        assert!(apart(&body, &plain.body) < 1e-5);
    }
    for factor in [0.1, 3.0, 1e6] {
        let mut edit = GltfEdit::new();
        edit.scale(factor);
        assert!(edit.message().contains("scale it to metres"));
    }
}

#[test]
fn scales_and_turns_above_the_skeleton_are_undone() {
    let plain = GltfEdit::new().import().unwrap();
    let quarter = std::f32::consts::FRAC_1_SQRT_2;
    // Centimetres under a node that makes metres of them; z up; facing backwards, as VRM 0.x does.
    for (factor, scale, turn) in [
        (100.0, 0.01, [0.0, 0.0, 0.0, 1.0]),
        (1.0, 1.0, [quarter, 0.0, 0.0, quarter]),
        (1.0, 1.0, [0.0, 1.0, 0.0, 0.0]),
    ] {
        let mut edit = GltfEdit::new();
        edit.scale(factor);
        edit.below(json!({ "name": "Armature", "scale": [scale, scale, scale], "rotation": turn }));
        let ImportedBody { body, report } = edit.import().unwrap();
        assert!(apart(&body, &plain.body) < 1e-5, "{scale} {turn:?}");
        assert_eq!(report.notes.len(), usize::from(turn[3] != 1.0), "{:?}", report.notes);
    }
}

#[test]
fn vrm_names_say_which_node_is_which_joint() {
    let vrm = names::DIALECTS[0].title;
    let mut edit = GltfEdit::new();
    let nodes: Vec<(usize, String)> =
        Joint::ALL.into_iter().map(|j| (j.index() + 1, names::DIALECTS[0].names(j).remove(0))).collect();
    for (node, _) in &nodes {
        edit.json["nodes"][*node]["name"] = format!("J_{node}").into();
    }
    let mut old = edit.clone();
    let list: Vec<Value> = nodes.iter().map(|(node, bone)| json!({ "bone": bone, "node": node })).collect();
    old.json["extensions"]["VRM"]["humanoid"]["humanBones"] = list.into();
    for (node, bone) in &nodes {
        edit.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"][bone] = json!({ "node": node });
    }
    let plain = GltfEdit::new().import().unwrap();
    for edit in [old, edit] {
        let ImportedBody { body, report } = edit.import().unwrap();
        assert_eq!((report.dialect, &body.skeleton), (vrm, &plain.body.skeleton));
        assert_eq!(report.joints[0], ("sacroiliac".to_owned(), "J_1".to_owned()));
    }
}

#[test]
fn a_posed_file_is_taken_in_its_bind_pose() {
    let mut edit = GltfEdit::new();
    edit.node("l_shoulder")["rotation"] = json!([0.0, 0.0, 0.38268343, 0.92387953]);
    assert!(apart(&edit.import().unwrap().body, &GltfEdit::new().import().unwrap().body) < 1e-6);
}

#[test]
fn without_inverse_binds_the_nodes_pose_counts() {
    let mut edit = GltfEdit::new();
    edit.json["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
    // By the specification the mesh is then carried by its joints as it is: on our file that is no body.
    assert!(edit.import().is_err());
    // A mesh of one joint that stands in the origin is carried nowhere.
    for joints in edit.json["nodes"].as_array_mut().unwrap() {
        joints["translation"] = json!([0.0, 0.0, 0.0]);
    }
    assert!(edit.message().contains("no axis"));
}

#[test]
fn sparse_positions_are_read() {
    let mut edit = GltfEdit::new();
    let (accessor, at) = (edit.accessor("POSITION"), edit.bin.len());
    edit.bin.extend(7u32.to_le_bytes());
    edit.bin.extend([0.25f32, 1.0, 0.125].iter().flat_map(|x| x.to_le_bytes()));
    edit.json["buffers"][0]["byteLength"] = edit.bin.len().into();
    let views = edit.json["bufferViews"].as_array_mut().unwrap();
    let first = views.len();
    views.push(json!({ "buffer": 0, "byteOffset": at, "byteLength": 4 }));
    views.push(json!({ "buffer": 0, "byteOffset": at + 4, "byteLength": 12 }));
    edit.json["accessors"][accessor]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": first, "componentType": 5125 }, "values": { "bufferView": first + 1 },
    });
    let body = edit.import().unwrap().body;
    assert!(body.mesh.positions[7].distance(Vec3::new(0.25, 1.0, 0.125) + moved()) < 1e-6);
    edit.bin[at..at + 4].copy_from_slice(&9_000_000u32.to_le_bytes());
    assert!(edit.message().contains("9000000"));
}

#[test]
fn weights_that_do_not_sum_to_one_name_the_vertex() {
    let mut edit = GltfEdit::new();
    for k in 0..4 {
        edit.set("WEIGHTS_0", 4 * 12 + k, 0.1);
    }
    // Four tenths, or fewer where fewer joints carry it.
    assert!(
        edit.message().contains("the weights of vertex 12 (from 0 over all skinned parts) sum to 0.4"),
        "{}",
        edit.message()
    );
    edit.set("WEIGHTS_0", 4 * 12, -0.5);
    assert!(edit.message().contains("vertex 12 (from 0 over all skinned parts) has the weight -0.5"));
    edit.set("WEIGHTS_0", 4 * 12, f32::NAN);
    assert!(edit.message().contains("vertex 12 (from 0 over all skinned parts) has the weight NaN"));
}

#[test]
fn weights_rounded_to_bytes_are_normalised() {
    let mut edit = GltfEdit::new();
    let count = OURS.weights.len();
    for v in 0..count {
        for k in 0..4 {
            let w = OURS.weights[v].weights[k];
            edit.set("WEIGHTS_0", 4 * v + k, (w * 255.0).round() / 255.0);
        }
    }
    for w in edit.import().unwrap().body.weights {
        assert!((w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn eight_influences_become_four_and_the_loss_is_told() {
    let mut edit = GltfEdit::new();
    // The same joints and weights a second time: eight influences of half the weight, over the same bones.
    let (joints, weights) = (edit.accessor("JOINTS_0"), edit.accessor("WEIGHTS_0"));
    let attributes = &mut edit.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] = joints.into();
    attributes["WEIGHTS_1"] = weights.into();
    for (v, w) in OURS.weights.iter().enumerate() {
        (0..4).for_each(|k| edit.set("WEIGHTS_0", 4 * v + k, 0.5 * w.weights[k]));
    }
    let doubled = edit.import().unwrap();
    let plain = GltfEdit::new().import().unwrap();
    assert!(doubled.report.pruned.most_influences > 4 && doubled.report.pruned.over_four > 0);
    assert_eq!(doubled.report.pruned.vertices, plain.report.pruned.vertices);
    for (a, b) in doubled.body.weights.iter().zip(&plain.body.weights) {
        assert_eq!(a.bones, b.bones);
    }
    println!("{:?}", plain.report.pruned);
    assert!(plain.report.pruned.max_lost < 0.2);
}

#[test]
fn joints_out_of_range_name_vertex_and_joint() {
    let mut edit = GltfEdit::new();
    let at = edit.start(edit.accessor("JOINTS_0"));
    edit.bin[at + 4 * 5] = 200;
    assert!(edit.message().contains("vertex 5 (from 0 over all skinned parts) is bound to joint 200"));
    let mut edit = GltfEdit::new();
    edit.json["skins"][0]["joints"][3] = 5_000.into();
    assert!(edit.message().contains("joint 5000"));
}

#[test]
fn armatures_that_are_no_tree_are_refused() {
    let mut circle = GltfEdit::new();
    circle.node("l_talocrural")["children"] = json!([1]);
    assert!(circle.message().contains("below itself"));
    let mut itself = GltfEdit::new();
    itself.node("l_metatarsophalangeal")["children"] = json!([1 + Joint::LeftToe.index()]);
    assert!(itself.message().contains("two parents"));
    let mut roots = GltfEdit::new();
    let hip = 1 + Joint::LeftHip.index();
    roots.node("sacroiliac")["children"].as_array_mut().unwrap().retain(|c| *c != hip);
    assert!(roots.message().contains("\"l_hip\" has no way up to the hips"));
    let mut wrong = GltfEdit::new();
    let names = ["l_elbow", "l_shoulder"];
    wrong.node(names[0])["name"] = "x".into();
    wrong.node(names[1])["name"] = names[0].into();
    wrong.node("x")["name"] = names[1].into();
    assert!(wrong.message().contains("the parent of joint \"l_shoulder\" is \"l_elbow\""));
    let mut gone = GltfEdit::new();
    gone.node("l_hip")["children"] = json!([999]);
    assert!(gone.message().contains("a child that is not there"));
}

#[test]
fn missing_joints_are_named_or_placed() {
    let mut edit = GltfEdit::new();
    edit.node("l_knee")["name"] = "bone7".into();
    assert!(edit.message().contains("no joint was found for l_knee"));
    let mut edit = GltfEdit::new();
    for name in ["vl1", "vc4", "l_sternoclavicular", "r_metacarpophalangeal_3", "r_metatarsophalangeal"] {
        edit.node(name)["name"] = "something else".into();
    }
    let ImportedBody { body, report } = edit.import().unwrap();
    assert!(report.notes[0].contains("vl1, vc4"), "{:?}", report.notes);
    for joint in [Joint::Chest, Joint::Neck, Joint::LeftClavicle, Joint::RightHand, Joint::RightToe] {
        let off = body.skeleton.at(joint).distance(OURS.skeleton.at(joint) + moved());
        assert!(off < 0.08, "{joint:?} stands {off} m away");
    }
    // The skin of the trunk still follows the chest.
    let chest = Joint::Chest.index() as u8;
    assert!(body.weights.iter().any(|w| w.bones[0] == chest && w.weights[0] > 0.5));
}

#[test]
fn negative_and_empty_scales_name_the_node() {
    let mut edit = GltfEdit::new();
    edit.node("l_elbow")["scale"] = json!([1.0, -1.0, 1.0]);
    assert!(edit.message().contains("\"l_elbow\" is mirrored"));
    edit.node("l_elbow")["scale"] = json!([1.0, 0.0, 1.0]);
    assert!(edit.message().contains("\"l_elbow\" is scaled to nothing"));
    let mut edit = GltfEdit::new();
    let matrices = edit.json["skins"][0]["inverseBindMatrices"].as_u64().unwrap() as usize;
    let at = edit.start(matrices) + 64 * 2;
    let mirrored = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)).to_cols_array();
    edit.bin[at..at + 64].copy_from_slice(&mirrored.map(f32::to_le_bytes).concat());
    assert!(edit.message().contains("inverse bind matrix of joint \"vl1\""));
}

#[test]
fn a_mirrored_mesh_is_told_by_its_toes() {
    let mut edit = GltfEdit::new();
    for node in edit.json["nodes"].as_array_mut().unwrap() {
        let name = node["name"].as_str().unwrap().to_owned();
        let swapped = match name.split_at_checked(2) {
            Some(("l_", rest)) => format!("r_{rest}"),
            Some(("r_", rest)) => format!("l_{rest}"),
            _ => name,
        };
        node["name"] = swapped.into();
    }
    assert!(edit.message().contains("left and right are swapped"));
}

#[test]
fn empty_and_huge_meshes_are_refused_before_they_are_memory() {
    let accessor = GltfEdit::new().accessor("POSITION");
    for count in [0u64, 10_000_000, u64::from(u32::MAX), u64::MAX] {
        let mut edit = GltfEdit::new();
        edit.json["accessors"][accessor]["count"] = count.into();
        let message = edit.message();
        let expected = if count == 0 { "empty" } else { "vertices, and a body has 4 to 250000" };
        assert!(message.contains(expected), "{message}");
    }
    let mut edit = GltfEdit::new();
    edit.json["meshes"][0]["primitives"] = json!([]);
    assert!(edit.message().contains("it has 0 vertices"));
    const { assert!(MAX_BODY_VERTICES == 250_000) };
    let mut edit = GltfEdit::new();
    edit.json["nodes"][0].as_object_mut().unwrap().remove("skin");
    assert!(edit.message().contains("no mesh that is bound to a skeleton"));
}

#[test]
fn what_is_not_finite_names_its_vertex() {
    for (attribute, message) in [("POSITION", "position of vertex 3"), ("NORMAL", "normal of vertex 3")] {
        for value in [f32::NAN, f32::INFINITY] {
            let mut edit = GltfEdit::new();
            edit.set(attribute, 3 * 3, value);
            // An infinite normal has no direction, which is mended; no position is.
            match edit.import() {
                Err(flaw) => assert!(flaw.to_string().contains(message), "{flaw}"),
                Ok(_) => assert!(attribute == "NORMAL"),
            }
        }
    }
}

#[test]
fn holes_are_refused_on_the_trunk_and_accepted_on_the_head() {
    let corners = |keep: &dyn Fn(Vec3) -> bool| {
        let mut edit = GltfEdit::new();
        let indices = edit.json["meshes"][0]["primitives"][0]["indices"].as_u64().unwrap() as usize;
        let at = edit.start(indices);
        for (t, triangle) in OURS.mesh.triangles.iter().enumerate() {
            if !triangle.iter().all(|v| keep(OURS.mesh.positions[*v as usize])) {
                edit.bin[at + 12 * t..at + 12 * t + 12].fill(0);
            }
        }
        edit
    };
    let belly = corners(&|p| !(p.z > 0.0 && p.x.abs() < 0.03 && (p.y - OURS.levels.waist).abs() < 0.03));
    let message = belly.message();
    assert!(message.contains("the surface is open at") && message.contains("the first near"), "{message}");
    let open = parse(&belly.bytes(), &alone, &ImportOptions { allow_holes: true, ..ImportOptions::default() }).unwrap();
    assert!(open.report.boundary_edges > 3);
    let top = OURS.measures.stature - 0.05;
    let crown = corners(&|p| p.y < top).import().unwrap();
    assert!(crown.report.boundary_edges > 3 && crown.report.parts == 1);
}

#[test]
fn meshes_are_chosen_by_name() {
    let options = |name: &str| ImportOptions { meshes: vec![name.into()], ..ImportOptions::default() };
    assert!(parse(&FILE, &alone, &options("body")).is_ok());
    let message = parse(&FILE, &alone, &options("hair")).unwrap_err().to_string();
    assert!(message.contains("no mesh named hair, only body"), "{message}");
}

#[test]
fn truncated_files_are_errors() {
    for share in 0..64 {
        let end = (FILE.len() - 1) * share / 63;
        assert!(parse(&FILE[..end], &alone, &ImportOptions::default()).is_err(), "{end}");
    }
    for end in 0..200 {
        assert!(parse(&FILE[..end], &alone, &ImportOptions::default()).is_err(), "{end}");
    }
}

#[test]
fn files_are_named_in_their_errors() {
    let message = read(Path::new("no/such.glb"), &ImportOptions::default()).unwrap_err().to_string();
    assert!(message.starts_with("no/such.glb: it cannot be read"), "{message}");
}
