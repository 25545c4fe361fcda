//! Colliders that each part of a garment can ever touch: those that the part table leaves it, and of these the ones that
//! come nearer to the part's anchor than its cloth is long.
//!
//! A particle gets no farther from its tether's anchor than the tether is long. How near a capsule comes to the anchor
//! is looked for in poses: of a shopper in many that are drawn at random from ranges wider than any joint's, of a scene
//! file in those of its own tracks.

use glam::{Affine3A, Quat, Vec3, Vec3A};
use serde::Serialize;
use toile_base::garment::{Garment, Part};
use toile_base::limits::MAX_CAPSULES;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{BONES, Joint, Pose, Skeleton};
use toile_engine::body::palette;
use toile_engine::cloth::contact;
use toile_engine::colliders::Colliders;

use super::scene::{PlannedMotion, PlannedScene};

/// Poses that are drawn for a shopper, and most that are taken of a track.
const POSES: usize = 2_048;

/// Seed of the poses.
const SEED: u64 = 7;

/// What poses between those that were drawn may bring a capsule nearer (m).
const BETWEEN_M: f32 = 0.03;

/// How far a tether gives, as a share of its length.
const GIVES: f32 = 1.02;

/// A part of a garment and what it can touch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reach {
    /// Name of the garment.
    pub garment: String,
    /// The part of the body that carries it.
    pub part: &'static str,
    /// Number of its particles that move.
    pub particles: usize,
    /// Capsules that the part table leaves it.
    pub by_part: u32,
    /// Of these, the ones that any of its particles can come to.
    pub by_length: u32,
    /// How many of them a particle can come to, on average.
    pub mean: f64,
    /// The limbs that these belong to; the capsules' numbers where there is no body.
    pub touches: Vec<String>,
}

/// The parts of all garments of a scene.
pub fn reach(scene: &PlannedScene) -> Vec<Reach> {
    let poses = poses(scene);
    scene.garments.iter().flat_map(|g| of_garment(scene, g, &poses)).collect()
}

/// Bones and colliders in one pose.
type Posed = ([Affine3A; BONES], Colliders);

fn poses(scene: &PlannedScene) -> Vec<Posed> {
    let posed = |bones: [Affine3A; BONES]| {
        let mut colliders = scene.colliders.clone();
        // The first placement sweeps nothing.
        colliders.reset();
        colliders.place(&bones);
        (bones, colliders)
    };
    match (&scene.motion, &scene.skeleton) {
        (PlannedMotion::Shopper(_), Some(skeleton)) => {
            let mut rng = SplitMix64::new(SEED);
            (0..POSES).map(|_| posed(random_bones(skeleton, &mut rng))).collect()
        }
        (PlannedMotion::File(file), _) => {
            let steps = file.steps() as usize;
            let one = |step: usize| {
                let (mut bones, mut colliders) = ([Affine3A::IDENTITY; BONES], scene.colliders.clone());
                colliders.reset();
                scene.place(step, &mut bones, &mut colliders);
                (bones, colliders)
            };
            (0..steps).step_by(steps.div_ceil(POSES).max(1)).map(one).collect()
        }
        (PlannedMotion::Shopper(bones), None) => bones.iter().map(|b| posed(*b)).collect(),
    }
}

/// How far a joint turns at most, whatever about (degrees): more than `toile_engine::body::limits` lets it.
fn widest_deg(joint: Joint) -> f32 {
    use Joint::*;
    match joint {
        Pelvis | LeftToe | RightToe => 0.0,
        LeftClavicle | RightClavicle => 50.0,
        Spine | Chest | LeftAnkle | RightAnkle | LeftWrist | RightWrist | LeftHand | RightHand => 80.0,
        Neck | Head => 95.0,
        LeftElbow | RightElbow | LeftKnee | RightKnee => 155.0,
        LeftShoulder | RightShoulder | LeftHip | RightHip => 180.0,
    }
}

fn random_bones(skeleton: &Skeleton, rng: &mut SplitMix64) -> [Affine3A; BONES] {
    let mut pose = Pose::rest(skeleton);
    for joint in Joint::ALL {
        let mut side = || rng.uniform() * 2.0 - 1.0;
        let axis = Vec3::new(side(), side(), side()).normalize_or(Vec3::X);
        let angle = rng.uniform() * widest_deg(joint).to_radians();
        pose.local[joint.index()] = Quat::from_axis_angle(axis, angle);
    }
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, &pose, &mut bones);
    bones
}

fn of_garment(scene: &PlannedScene, garment: &Garment, poses: &[Posed]) -> Vec<Reach> {
    let nearest = nearest(garment, poses);
    let capsules = scene.colliders.capsules().len();
    let offset = garment.fabric.contact_offset_mm * 1e-3;
    let tethers = &garment.layout().tethers;
    let mut rows: Vec<(Part, ReachRow)> = Vec::new();
    for (i, &part) in garment.parts.iter().enumerate().filter(|(i, _)| garment.inverse_mass[*i] > 0.0) {
        let allowed = contact::body::reach(part, &scene.colliders);
        let length = tethers.length[i] * GIVES + offset + BETWEEN_M;
        let within = |c: &usize| match &nearest[tethers.anchor[i] as usize] {
            // Cloth that is attached nowhere can be anywhere.
            Some(near) if tethers.length[i] > 0.0 => near[*c] <= length,
            _ => true,
        };
        let bits = (0..capsules).filter(within).fold(0u32, |bits, c| bits | 1 << c) & allowed;
        let known = rows.iter().position(|(p, _)| *p == part).unwrap_or_else(|| {
            rows.push((part, ReachRow { allowed, ..ReachRow::default() }));
            rows.len() - 1
        });
        let row = &mut rows[known].1;
        row.particles += 1;
        row.sum += u64::from(bits.count_ones());
        row.any |= bits;
    }
    rows.into_iter().map(|(part, row)| row.report(garment, part, scene)).collect()
}

#[derive(Default)]
struct ReachRow {
    particles: usize,
    allowed: u32,
    any: u32,
    sum: u64,
}

impl ReachRow {
    fn report(&self, garment: &Garment, part: Part, scene: &PlannedScene) -> Reach {
        let part = match part {
            Part::All => "all",
            Part::Trunk => "trunk",
            Part::LeftArm => "left arm",
            Part::RightArm => "right arm",
            Part::Hollow => "hollow",
            Part::LeftLeg => "left leg",
            Part::RightLeg => "right leg",
        };
        Reach {
            garment: garment.name.clone(),
            part,
            particles: self.particles,
            by_part: self.allowed.count_ones(),
            by_length: self.any.count_ones(),
            mean: self.sum as f64 / self.particles.max(1) as f64,
            touches: touches(self.any, scene),
        }
    }
}

/// Limbs, or capsules by their numbers.
fn touches(bits: u32, scene: &PlannedScene) -> Vec<String> {
    if scene.skeleton.is_none() {
        return (0..u32::BITS).filter(|c| bits >> c & 1 != 0).map(|c| format!("capsule {c}")).collect();
    }
    let of = |part| contact::body::reach(part, &scene.colliders);
    let (arms, legs) = ([of(Part::LeftArm), of(Part::RightArm)], [of(Part::LeftLeg), of(Part::RightLeg)]);
    let limbs = [
        ("trunk", legs[0] & legs[1]),
        ("left arm", arms[0]),
        ("right arm", arms[1]),
        ("left leg", legs[0] & !legs[1]),
        ("right leg", legs[1] & !legs[0]),
    ];
    let named = limbs.into_iter().filter(|(_, limb)| limb & bits != 0);
    named.map(|(name, limb)| format!("{name} ({} of {})", (limb & bits).count_ones(), limb.count_ones())).collect()
}

/// How near each capsule comes to each particle that others are tethered to (m) `[particles]`; none for the others.
fn nearest(garment: &Garment, poses: &[Posed]) -> Vec<Option<[f32; MAX_CAPSULES]>> {
    let mut nearest = vec![None; garment.particles()];
    for (i, &anchor) in garment.layout().tethers.anchor.iter().enumerate() {
        if garment.layout().tethers.length[i] > 0.0 {
            nearest[anchor as usize] = Some([f32::INFINITY; MAX_CAPSULES]);
        }
    }
    for (bones, colliders) in poses {
        let cones = colliders.cones_at(1.0);
        for (&i, weights) in garment.fixed.iter().zip(&garment.fixed_weights) {
            let Some(near) = &mut nearest[i as usize] else { continue };
            let rest = Vec3A::from(garment.start[i as usize]);
            let blended = weights.bones.iter().zip(&weights.weights);
            let p: Vec3A = blended.map(|(&b, &w)| bones[usize::from(b)].transform_point3a(rest) * w).sum();
            for (near, cone) in near.iter_mut().zip(&cones) {
                *near = near.min(cone.distance(p.into()).0);
            }
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use toile_assets::scene_file::{SceneFile, SceneSource};

    use super::*;

    /// A cloth of 0.4 m that hangs at x = 0, with a ball that it can swing to and one that it cannot.
    fn scene(pinned: &str) -> PlannedScene {
        let ball = |centre: &str| format!("[[colliders.sphere]]\ncentre = {centre}\nradius = 0.05\n");
        let text = format!(
            "duration = 0.1\n[[garment]]\ngrid = {{ rows = 9, columns = 9, width = 0.4, height = 0.4 }}\nposition = [0, 2, \
             0]\n{pinned}\n[colliders]\ncapsules = [[0, 0], [1, 1]]\n{}{}",
            ball("[0, 1.8, 0.3]"),
            ball("[0, 1.0, 0]")
        );
        PlannedScene::file(SceneFile::parse("test", &text, SceneSource::Inside(&[])).unwrap()).unwrap()
    }

    #[test]
    fn what_hangs_touches_what_its_cloth_is_long_enough_for_and_what_falls_touches_anything() {
        let [row] = &reach(&scene("[[garment.pin]]\nvertices = [\"0-8\"]"))[..] else { panic!("one part") };
        assert_eq!((row.by_part, row.by_length, &row.touches[..]), (2, 1, &["capsule 0".to_owned()][..]));
        assert!(row.mean > 0.2 && row.mean < 1.0, "only the lower rows come so far: {}", row.mean);
        let [row] = &reach(&scene(""))[..] else { panic!("one part") };
        assert_eq!((row.by_length, row.mean), (2, 2.0));
    }

    #[test]
    fn ranges_are_wider_than_what_a_pose_is_held_to() {
        use toile_engine::body::limits;
        let wide = |joint, s: limits::Spread| {
            let most = |[a, b]: [f32; 2]| a.abs().max(b.abs());
            let all = Vec3::new(most(s.flexion), most(s.turn), most(s.side)).length();
            assert!(widest_deg(joint) >= all, "{joint:?}: {all}");
        };
        wide(Joint::Chest, limits::TRUNK);
        wide(Joint::Neck, limits::NECK);
        wide(Joint::LeftAnkle, limits::ANKLE);
        wide(Joint::LeftClavicle, limits::CLAVICLE);
        assert!(widest_deg(Joint::RightElbow) >= limits::ELBOW.max && widest_deg(Joint::RightKnee) >= limits::KNEE.max);
        assert!(widest_deg(Joint::LeftWrist) >= limits::WRIST_DEG);
    }
}
