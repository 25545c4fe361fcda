//! One person of the study: the measures of a person in the survey, and a shape of their own.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{Ansur, BodyError, Wanted};
use toile_base::body::{Body, Region, Sex};
use toile_base::mesh::vertex_normals;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{Joint, Pose};
use toile_track::fit::measuring::MEASURES;

use super::standing::{StandingMotion, StudyPerson};

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

/// Roughness of flesh that no family of bodies has: harmonics of the whole surface (m), about a hand wide.
const BUMPS: f32 = 0.0008;

/// Builds a person of the survey, by their measures in the order of [`GIVEN`] (m). Where no body has all of them
/// together, the nearest; what is true of them is read off in any case.
///
/// # Errors
/// A measure outside of all ranges.
pub fn survey_person(sex: Sex, measures: &[f32; GIVEN.len()], rng: &mut SplitMix64) -> Result<StudyPerson, BodyError> {
    let wanted = GIVEN.iter().zip(measures).fold(Wanted::new(), |w, (g, m)| w.with(g.0, *m));
    let shapes = Shapes::of(sex);
    let mut body = shapes.body(&shapes.wanted(&wanted)?).body;
    sculpt(&mut body, rng);
    let readings = shapes.read_surface(&body.mesh.positions);
    let pose = standing(&body, rng);
    let truth = MEASURES.map(|(_, measure, _)| Some(measure.of(&readings)));
    Ok(StudyPerson { sex, truth, body, pose, motion: StandingMotion::Independent })
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

/// How a person stands when asked to: arms slightly out, never quite straight.
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
    use super::super::standing::Moment;
    use super::*;

    #[test]
    fn people_stand_on_both_feet() {
        let mut rng = SplitMix64::new(11);
        let measures = [1.65, 1.41, 0.98, 0.77, 0.46, 0.33, 0.93, 0.84, 1.01, 0.60, 0.80, 0.36];
        let person = survey_person(Sex::Female, &measures, &mut rng).expect("a body");
        let soles: Vec<usize> =
            (0..person.body.mesh.positions.len()).filter(|&v| person.body.mesh.positions[v].y < 0.002).collect();
        let mut surface = Vec::new();
        for _ in 0..3 {
            person.stand(Moment::default(), &mut rng, &mut surface);
            let highest = soles.iter().map(|&v| surface[v].y).fold(0.0, f32::max);
            assert!(soles.len() > 20 && highest < 0.006, "{} {highest}", soles.len());
            assert!(surface.iter().all(|p| p.y >= 0.0));
        }
    }
}
