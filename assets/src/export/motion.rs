//! A mesh that moves as GLB: the first frame, a morph target for each later one, and an animation that blends from one to the next.

use glam::Vec3;
use serde_json::{Value, json};

use super::parts::GlbBuffer;

/// The GLB file of a mesh (m) in each of some frames, `rate` of them a second. Colour is a plain light grey, both sides shown.
/// `None` where there are no frames, or not all have the mesh's vertices.
pub fn motion_glb(name: &str, frames: &[Vec<Vec3>], triangles: &[[u32; 3]], rate: f32) -> Option<Vec<u8>> {
    let first = frames.first()?;
    if first.is_empty() || triangles.is_empty() || frames.iter().any(|f| f.len() != first.len()) {
        return None;
    }
    let mut parts = GlbBuffer::default();
    let position = parts.positions(first);
    let mut targets = Vec::new();
    for frame in &frames[1..] {
        let moved: Vec<Vec3> = frame.iter().zip(first).map(|(p, from)| *p - *from).collect();
        targets.push(json!({ "POSITION": parts.positions(&moved) }));
    }
    let later = targets.len();
    let indices = parts.indices(triangles);
    let mut primitive = json!({ "attributes": { "POSITION": position }, "indices": indices, "material": 0 });
    let mut mesh = json!({ "name": name });
    let mut animations: Vec<Value> = Vec::new();
    if later > 0 {
        primitive["targets"] = targets.into();
        mesh["weights"] = vec![0.0; later].into();
        let times = parts.times(frames.len(), rate);
        // At each frame one target counts, and none at the first.
        let weights = (0..frames.len()).flat_map(|f| (1..=later).map(move |t| if t == f { 1.0 } else { 0.0 }));
        let output = parts.scalars(weights, frames.len() * later);
        animations.push(json!({
            "name": "motion",
            "samplers": [{ "input": times, "output": output, "interpolation": "LINEAR" }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
        }));
    }
    mesh["primitives"] = json!([primitive]);
    let mut description = json!({
        "asset": { "version": "2.0", "generator": concat!("Toile ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": name, "mesh": 0 }],
        "meshes": [mesh],
        "materials": [{ "name": name, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.6, 0.6, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 } }],
    });
    if !animations.is_empty() {
        description["animations"] = animations.into();
    }
    Some(parts.glb(description))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_frame_is_a_target_that_counts_at_its_time() {
        let frame = |k: f32| vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 0.1 * k)];
        let frames: Vec<_> = (0..4).map(|k| frame(k as f32)).collect();
        let bytes = motion_glb("cloth", &frames, &[[0, 1, 2]], 60.0).unwrap();
        let file = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = file.blob.clone().unwrap();
        let mesh = file.meshes().next().unwrap();
        let primitive = mesh.primitives().next().unwrap();
        let moved: Vec<f32> = primitive
            .reader(|_| Some(&blob))
            .read_morph_targets()
            .map(|(positions, _, _)| positions.unwrap().nth(2).unwrap()[2])
            .collect();
        assert_eq!(moved, [0.1, 0.2, 0.3].map(|z: f32| z));
        let animation = file.animations().next().unwrap();
        let channel = animation.channels().next().unwrap();
        let times: Vec<f32> = channel.reader(|_| Some(&blob)).read_inputs().unwrap().collect();
        assert_eq!(times.len(), 4);
        assert!((times[3] - 0.05).abs() < 1e-6);
        assert_eq!(motion_glb("cloth", &[], &[[0, 1, 2]], 60.0), None);
    }
}
