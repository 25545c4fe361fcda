//! Garments on the skin that is seen: what it costs over cones, and how much of them is outside of it.

use glam::DVec3;
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::Pose;
use toile_engine::body_surface::BodyPart;
use toile_fitting::heap::HeapProbe;

use super::poses::POSES;
use super::row::{ContactError, ContactRow};
use super::worn::options;
use crate::distance::DistanceMesh;
use crate::worn::{WornOptions, WornScene, on_the_way};

/// Steps in which stages are metered.
const METERED: usize = 240;

/// How long the body takes from the pose that garments are cut in to another, and how long it then stays (s).
const INTO_POSE_S: [f32; 2] = [1.5, 1.0];

/// Most of the free particles that may be inside the skin (%).
const INSIDE: f64 = 0.1;

/// Time of contact with the skin less that with cones, of a tee and trousers.
pub fn skin() -> Result<Vec<ContactRow>, ContactError> {
    let mut us = [0.0; 2];
    let mut particles = 0;
    for (k, skin) in [false, true].into_iter().enumerate() {
        let asked = WornOptions { skin, layers: false, folds: false, ..options(&["wide-leg-trousers", "tee"], 1) };
        let mut scene = WornScene::new(&asked, &HeapProbe::none())?;
        particles = scene.garments.iter().map(|g| g.particles()).sum();
        scene.stages_us(METERED);
        us[k] = scene.stages_us(METERED).into_iter().filter(|(stage, _)| *stage == "contact").map(|(_, us)| us).sum();
    }
    let name = format!("body of triangles in place of cones, {particles} particles: contact takes longer by");
    Ok(vec![ContactRow::at_most(name, 0.5, (us[1] - us[0]) * 1e-3, "ms")])
}

/// Trousers, tee and dress in four poses: each on the skin by itself, and then over one another.
pub fn poses() -> Result<Vec<ContactRow>, ContactError> {
    let mut rows = Vec::new();
    for over in [false, true] {
        let garments = options(&["wide-leg-trousers", "tee", "strap-dress"], 2);
        let asked = WornOptions { layers: over, folds: over, ..garments };
        for pose in POSES {
            let mut scene = WornScene::new(&asked, &HeapProbe::none())?;
            let goal = (pose.of)(scene.skeleton());
            bring_into(&mut scene, &goal, INTO_POSE_S);
            rows.extend(SkinFindings::of(&scene).rows(pose.name, over));
        }
    }
    Ok(rows)
}

/// Steps until the body is in a pose, and then until the cloth has come to rest, for so long each (s).
pub(super) fn bring_into(scene: &mut WornScene, goal: &Pose, seconds: [f32; 2]) {
    let [way, rest] = seconds.map(|seconds| (seconds / STEP_SECONDS).round());
    for step in 1..=(way + rest) as u32 {
        let now = on_the_way(scene.skeleton(), goal, (step as f32 / way).min(1.0));
        scene.prepare_in(&now);
        scene.step();
    }
}

/// How much of the free particles is inside the skin.
#[derive(Debug, Default)]
struct SkinFindings {
    free: u32,
    inside: u32,
    /// Of these inside of a limb that their part of the garment meets.
    met: u32,
    /// How deep the deepest is (m).
    deepest: f64,
}

impl SkinFindings {
    /// As a scene stands.
    fn of(scene: &WornScene) -> Self {
        let (skin, triangles) = scene.skin();
        let skin: Vec<DVec3> = skin.iter().map(|p| p.as_dvec3()).collect();
        let mesh = DistanceMesh::new(&skin, triangles);
        let mut found = Self::default();
        for (cloth, garment) in scene.cloths.iter().zip(&scene.garments) {
            let particles = cloth.positions.iter().zip(&garment.inverse_mass).zip(&garment.parts);
            for ((p, _), part) in particles.filter(|((_, w), _)| **w > 0.0) {
                let (distance, triangle) = mesh.nearest(p.as_dvec3());
                found.free += 1;
                if distance < 0.0 {
                    found.inside += 1;
                    found.met += u32::from(BodyPart::of_bone(scene.bone_of(triangle)).touches(*part));
                    found.deepest = found.deepest.max(-distance);
                }
            }
        }
        found
    }

    /// Its rows; the target is for each garment by itself.
    fn rows(&self, pose: &str, over: bool) -> [ContactRow; 3] {
        let how = if over { "over one another" } else { "each by itself" };
        let name = |what: &str| format!("trousers, tee and dress, {how}, {pose}: {what}");
        let share = |count: u32| 100.0 * f64::from(count) / f64::from(self.free.max(1));
        let all = (name("free particles inside the skin"), share(self.inside));
        [
            if over { ContactRow::reported(all.0, all.1, "%") } else { ContactRow::at_most(all.0, INSIDE, all.1, "%") },
            ContactRow::reported(name("free particles inside a limb that their part meets"), share(self.met), "%"),
            ContactRow::reported(name("the deepest"), self.deepest * 1e3, "mm"),
        ]
    }
}
