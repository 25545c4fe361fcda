//! One person of the study: the measures of somebody in the survey, and a shape of their own.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{Ansur, Body, BodyError, Readings, Region, Sex, Wanted};
use toile_assets::mesh::vertex_normals;
use toile_assets::numeric::random::SplitMix64;
use toile_assets::skeleton::{BONES, JOINTS, Joint, Pose};
use toile_engine::body::{JointFrames, palette};

/// What of the survey a person's body is built to, with the survey's names.
pub const GIVEN: [(Ansur, &str); 12] = [
    (Ansur::Stature, "stature"),
    (Ansur::CervicaleHeight, "cervicaleheight"),
    (Ansur::WaistHeightOmphalion, "waistheightomphalion"),
    (Ansur::CrotchHeight, "crotchheight"),
    (Ansur::KneeHeightMidpatella, "kneeheightmidpatella"),
    (Ansur::NeckCircumference, "neckcircumference"),
    (Ansur::ChestCircumference, "chestcircumference"),
    (Ansur::WaistCircumferenceOmphalion, "waistcircumference"),
    (Ansur::ButtockCircumference, "buttockcircumference"),
    (Ansur::ThighCircumference, "thighcircumference"),
    (Ansur::SleeveLengthSpineWrist, "sleevelengthspinewrist"),
    (Ansur::BiacromialBreadth, "biacromialbreadth"),
];

/// Harmonics round the trunk's axis in which people's sections differ from the built body's, and by how much of the
/// radius: front against back; flat against round (the survey's log depth over breadth strays by .065 about what the
/// girths let expect, which is half of that each way); two more that make sections oval or square.
const HARMONICS: [(f32, f32); 4] = [(1.0, 0.012), (2.0, 0.030), (3.0, 0.008), (4.0, 0.008)];

/// Heights over stature at which each harmonic has its own strength; between them it is blended.
const KNOTS: [f32; 6] = [0.44, 0.52, 0.58, 0.64, 0.72, 0.82];

/// Roughness of flesh that nobody's family has: harmonics of the whole surface (m), about a hand wide.
const BUMPS: f32 = 0.0008;

/// Where the joints are at one moment, world (m).
pub type JointPositions = [Vec3; JOINTS];

/// A person who can stand before a camera.
pub struct SurveyPerson {
    /// Sex that the survey states.
    pub sex: Sex,
    body: Body,
    /// What the tape reads on them.
    pub readings: Readings,
    pose: Pose,
}

impl SurveyPerson {
    /// Builds a person of the survey, by their measures in the order of [`GIVEN`] (m). Where no body has all of them
    /// together, the nearest; what is true of them is read off in any case.
    ///
    /// # Errors
    /// A measure outside of all ranges.
    pub fn new(sex: Sex, measures: &[f32; GIVEN.len()], rng: &mut SplitMix64) -> Result<Self, BodyError> {
        let wanted = GIVEN.iter().zip(measures).fold(Wanted::new(), |w, (g, m)| w.with(g.0, *m));
        let shapes = Shapes::of(sex);
        let mut body = shapes.body(&shapes.wanted(&wanted)?).body;
        sculpt(&mut body, rng);
        let readings = shapes.read_surface(&body.mesh.positions);
        let pose = standing(&body, rng);
        Ok(Self { sex, body, readings, pose })
    }

    /// Triangles of the surface.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.body.mesh.triangles
    }

    /// The surface of the swaying person at one moment, feet on the floor (m) `[vertices]`.
    /// Gives where their joints are.
    pub fn stand(&self, rng: &mut SplitMix64, positions: &mut Vec<Vec3>) -> JointPositions {
        let mut pose = self.pose;
        let mut sway = |joint: Joint, by: f32| {
            let turn = Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian()) * by;
            pose.local[joint.index()] = Quat::from_scaled_axis(turn) * pose.local[joint.index()];
        };
        // A standing person's middle wanders by some millimetres in a second, their hands by some more.
        for (joint, by) in [
            (Joint::Pelvis, 0.006),
            (Joint::Spine, 0.004),
            (Joint::Neck, 0.015),
            (Joint::LeftShoulder, 0.015),
            (Joint::RightShoulder, 0.015),
            (Joint::LeftElbow, 0.010),
            (Joint::RightElbow, 0.010),
        ] {
            sway(joint, by);
        }
        pose.root += Vec3::new(rng.gaussian(), 0.0, rng.gaussian()) * 0.006;
        on_both_feet(&self.body, &mut pose);
        let mut bones = [glam::Affine3A::IDENTITY; BONES];
        palette(&self.body.skeleton, &pose, &mut bones);
        positions.clear();
        positions.extend(self.body.mesh.positions.iter().zip(&self.body.weights).map(|(p, weights)| {
            weights.iter().map(|(bone, w)| w * bones[bone as usize].transform_point3(*p)).sum::<Vec3>()
        }));
        let lowest = positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
        positions.iter_mut().for_each(|p| p.y -= lowest);
        JointFrames::new(&self.body.skeleton, &pose).position.map(|p| p - Vec3::Y * lowest)
    }
}

/// Lays both soles flat and level, as standing people have them: ankles turn, and the hips tilt where one leg reaches
/// lower than the other.
fn on_both_feet(body: &Body, pose: &mut Pose) {
    for _ in 0..3 {
        let frames = JointFrames::new(&body.skeleton, pose);
        for (ankle, knee) in [(Joint::LeftAnkle, Joint::LeftKnee), (Joint::RightAnkle, Joint::RightKnee)] {
            let foot = frames.rotation[ankle.index()];
            let level = Quat::from_rotation_arc(foot * Vec3::Y, Vec3::Y) * foot;
            pose.local[ankle.index()] = frames.rotation[knee.index()].inverse() * level;
        }
        let [left, right] = [Joint::LeftAnkle, Joint::RightAnkle].map(|j| frames.position[j.index()]);
        let tilt = Quat::from_rotation_z(-(left.y - right.y) / (left.x - right.x).max(0.05));
        pose.local[Joint::Pelvis.index()] = tilt * pose.local[Joint::Pelvis.index()];
    }
}

/// Gives the trunk sections that the parametric body does not have, and all of the surface some roughness.
fn sculpt(body: &mut Body, rng: &mut SplitMix64) {
    let stature = body.measures.stature;
    let mut strengths = [[(0.0, 0.0); KNOTS.len()]; HARMONICS.len()];
    for (row, (order, spread)) in strengths.iter_mut().zip(HARMONICS) {
        for knot in row.iter_mut() {
            // Bodies are symmetric: all harmonics are even in x.
            *knot = (order, spread * rng.gaussian());
        }
    }
    let phases: [[f32; 3]; 6] = std::array::from_fn(|_| std::array::from_fn(|_| TAU * rng.uniform()));
    let ways: [Vec3; 6] =
        std::array::from_fn(|_| Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian()) * (TAU / 0.25));
    let mut normals = vec![Vec3::ZERO; body.mesh.positions.len()];
    vertex_normals(&body.mesh.positions, &body.mesh.triangles, &mut normals);
    let axis = |y: f32| {
        let s = &body.skeleton;
        let (low, high) = (s.at(Joint::Pelvis), s.at(Joint::Neck));
        low.z + (high.z - low.z) * ((y - low.y) / (high.y - low.y)).clamp(0.0, 1.0)
    };
    let centres: Vec<f32> = body.mesh.positions.iter().map(|p| axis(p.y)).collect();
    for (v, p) in body.mesh.positions.iter_mut().enumerate() {
        let rest = *p;
        if matches!(body.regions[v], Region::Torso | Region::LeftLeg | Region::RightLeg) {
            let share = rest.y / stature;
            let (dx, dz) = (rest.x, rest.z - centres[v]);
            let angle = dx.atan2(dz);
            let grow: f32 = strengths.iter().map(|row| blended(row, share) * (row[0].0 * angle).cos()).sum();
            p.x += dx * grow;
            p.z += dz * grow;
        }
        let rough: f32 = ways.iter().zip(&phases).map(|(w, f)| (w.dot(rest.with_x(rest.x.abs())) + f[0]).sin()).sum();
        *p += normals[v] * (BUMPS * rough * (2.0f32 / 6.0).sqrt());
    }
    let lowest = body.mesh.positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
    body.mesh.positions.iter_mut().for_each(|p| p.y -= lowest);
}

/// A harmonic's strength at a height over stature: smooth between the knots, nothing beyond them.
fn blended(row: &[(f32, f32); KNOTS.len()], share: f32) -> f32 {
    if share <= KNOTS[0] - 0.06 || share >= KNOTS[KNOTS.len() - 1] {
        return 0.0;
    }
    let above = KNOTS.iter().position(|k| share < *k).unwrap_or(KNOTS.len() - 1);
    let (low, from) = if above == 0 { (KNOTS[0] - 0.06, 0.0) } else { (KNOTS[above - 1], row[above - 1].1) };
    let to = if above == KNOTS.len() - 1 { 0.0 } else { row[above].1 };
    let t = ((share - low) / (KNOTS[above] - low)).clamp(0.0, 1.0);
    from + (to - from) * t * t * (3.0 - 2.0 * t)
}

/// How a person stands when asked to: arms slightly out, nobody quite straight.
fn standing(body: &Body, rng: &mut SplitMix64) -> Pose {
    let mut pose = Pose::rest(&body.skeleton);
    let mut turn = |joint: Joint, usual: Vec3, spread: Vec3| {
        let by = usual + spread * Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian());
        pose.local[joint.index()] = Quat::from_scaled_axis(by);
    };
    turn(Joint::Pelvis, Vec3::ZERO, Vec3::new(0.02, 0.08, 0.01));
    turn(Joint::Spine, Vec3::ZERO, Vec3::new(0.03, 0.03, 0.015));
    turn(Joint::Chest, Vec3::ZERO, Vec3::new(0.03, 0.03, 0.015));
    turn(Joint::Neck, Vec3::ZERO, Vec3::new(0.05, 0.06, 0.03));
    for (shoulder, elbow, hip, side) in [
        (Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftHip, 1.0),
        (Joint::RightShoulder, Joint::RightElbow, Joint::RightHip, -1.0),
    ] {
        // The rest pose's arms are half raised: about 20 degrees lower is slightly out.
        turn(shoulder, Vec3::new(0.0, 0.0, -0.35 * side), Vec3::new(0.08, 0.10, 0.10));
        turn(elbow, Vec3::new(-0.10, 0.0, 0.0), Vec3::new(0.05, 0.05, 0.05));
        turn(hip, Vec3::new(0.0, 0.0, 0.02 * side), Vec3::new(0.015, 0.03, 0.015));
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_stand_on_both_feet() {
        let mut rng = SplitMix64::new(11);
        let measures = [1.65, 1.41, 0.98, 0.77, 0.46, 0.33, 0.93, 0.84, 1.01, 0.60, 0.80, 0.36];
        let person = SurveyPerson::new(Sex::Female, &measures, &mut rng).expect("a body");
        let soles: Vec<usize> =
            (0..person.body.mesh.positions.len()).filter(|&v| person.body.mesh.positions[v].y < 0.002).collect();
        let mut surface = Vec::new();
        for _ in 0..3 {
            person.stand(&mut rng, &mut surface);
            let highest = soles.iter().map(|&v| surface[v].y).fold(0.0, f32::max);
            assert!(soles.len() > 20 && highest < 0.006, "{} {highest}", soles.len());
            assert!(surface.iter().all(|p| p.y >= 0.0));
        }
    }
}
