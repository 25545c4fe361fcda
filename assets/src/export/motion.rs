//! A mesh that moves as GLB, all of whose frames are known.

use std::io::Cursor;

use glam::Vec3;

use super::frame_rate::FrameRate;
use super::moving_glb::MovingGlb;
use super::part::MovingPart;
use super::surface::SurfaceLook;
use toile_bake::shape::NO_VERTEX;

/// Grey of a mesh without a look (sRGB).
const GREY: f32 = 0.8;

/// The GLB file of a mesh (m) in each of some frames, `rate` of them a second, as [`MovingGlb`] writes it. Colour is a plain light
/// grey, both sides shown. `None` where there are no frames or too many, or not all have the mesh's vertices.
pub fn motion_glb(name: &str, frames: &[Vec<Vec3>], triangles: &[[u32; 3]], rate: f32) -> Option<Vec<u8>> {
    let first = frames.first()?;
    if first.is_empty() || triangles.is_empty() || frames.iter().any(|f| f.len() != first.len()) {
        return None;
    }
    let part = MovingPart {
        name: name.to_owned(),
        vertices: first.len(),
        faces: triangles.iter().map(|&[a, b, c]| [a, b, c, NO_VERTEX]).collect(),
        uvs: Vec::new(),
        look: SurfaceLook::cloth([GREY; 3]),
        skinned: None,
    };
    let rate = FrameRate { frames: frames.len(), hz: f64::from(rate) };
    let mut glb = MovingGlb::begin(Cursor::new(Vec::new()), "motion", &[part], rate).ok()?;
    frames.iter().try_for_each(|frame| glb.add(None, &[frame])).ok()?;
    Some(glb.finish().ok()?.into_inner())
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
