//! The effect of both blends on limbs: volume kept under twist, on a cylinder and on the shopper's forearm, and the joints that
//! are bent.

use glam::{Affine3A, Quat, Vec3};
use serde::Serialize;
use toile_assets::scene;
use toile_base::body::{Body, Region};
use toile_base::mesh::{Influences, SkinWeights, WideWeights};
use toile_base::skeleton;
use toile_base::skeleton::{BONES, Joint, Pose};
use toile_engine::body::{JointFrames, palette};
use toile_engine::skin::{Blend, SkinningJob, SweptSkin};

use super::error::SkinningError;
use super::solid::ClosedSurface;

/// Volume that a twisted limb keeps (1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TwistVolume {
    /// The cylinder, the shopper's forearm with every triangle cut into 16 before it is skinned, so that what is lost
    /// is lost by skinning, or the forearm as it is meshed, whose triangles lose some more.
    pub of: &'static str,
    /// Angle of the twist (degrees).
    pub degrees: f64,
    /// What theory has for linear blending between two bones: 1 - (1 - cos)/3.
    pub theory: f64,
    /// Linear blending between the limb's two bones, weights linear along it.
    pub linear_one_bone: f64,
    /// Linear blending with the limb split.
    pub linear_split: f64,
    /// Dual quaternions between the two bones.
    pub dual_one_bone: f64,
    /// Dual quaternions with the limb split.
    pub dual_split: f64,
}

/// What a bent joint of the shopper looks like: linear, dual, and swept over dual.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BentJoint {
    /// Name of the joint.
    pub of: &'static str,
    /// Angle of the bend (degrees).
    pub degrees: f64,
    /// Volume within 12 cm of the joint over that at rest.
    pub volume: [f64; 3],
    /// Largest distance of the skin from the bones over that at rest, less 1: the bulge.
    pub bulge: [f64; 3],
    /// The same in millimetres.
    pub bulge_mm: [f64; 3],
    /// Least distance of the skin from the bones over that at rest, on the outer side, less 1.
    pub thinnest: [f64; 3],
}

/// How far apart the two blends put the shopper's skin in the scene's ten seconds.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BlendDistance {
    /// Trunk and head, or arms and legs.
    pub of: &'static str,
    /// Mean distance over vertices and moments (mm).
    pub mean_mm: f64,
    /// Largest distance (mm).
    pub max_mm: f64,
    /// Volume of the whole body over that at rest in the moment in which it is least, linear and dual.
    pub body_volume: [f64; 2],
}

/// Distances, volumes and bulges of both blends.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shapes {
    /// The blends against each other.
    pub apart: Vec<BlendDistance>,
    /// Volumes of twisted limbs.
    pub twists: Vec<TwistVolume>,
    /// Volumes and bulges of bent joints.
    pub hinges: Vec<BentJoint>,
}

/// Poses cylinder and shopper, and measures what is left of them.
///
/// # Errors
/// Where the shopper cannot be built.
pub fn shapes() -> Result<Shapes, SkinningError> {
    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures)?;
    let mut twists = Vec::new();
    for degrees in [90.0, 120.0, 180.0] {
        twists.push(twist("cylinder", degrees, |split, blend| cylinder(degrees, split, blend))?);
    }
    for (of, rounds) in [("forearm, skin", 2), ("forearm, its triangles", 0)] {
        let [plain, split] = [false, true].map(|split| Forearm::new(&body, split, rounds));
        for degrees in [90.0, 120.0] {
            let kept = |s: bool, blend| if s { &split } else { &plain }.kept(&body, degrees, blend);
            twists.push(twist(of, degrees, kept)?);
        }
    }
    let mut hinges = Vec::new();
    for (of, joint, bends) in [("elbow", Joint::LeftElbow, Vec3::Z), ("knee", Joint::LeftKnee, Vec3::NEG_Z)] {
        for degrees in [60.0, 90.0, 120.0] {
            hinges.push(hinge(&body, of, joint, bends, degrees)?);
        }
    }
    Ok(Shapes { twists, hinges, apart: apart(&body)? })
}

fn twist(
    of: &'static str,
    degrees: f64,
    kept: impl Fn(bool, Blend) -> Result<f64, SkinningError>,
) -> Result<TwistVolume, SkinningError> {
    Ok(TwistVolume {
        of,
        degrees,
        theory: 1.0 - (1.0 - degrees.to_radians().cos()) / 3.0,
        linear_one_bone: kept(false, Blend::Linear)?,
        linear_split: kept(true, Blend::Linear)?,
        dual_one_bone: kept(false, Blend::Dual)?,
        dual_split: kept(true, Blend::Dual)?,
    })
}

/// The left forearm's segment of the skeleton.
fn segment() -> &'static skeleton::Twist {
    skeleton::Twist::towards(Joint::LeftWrist).expect("forearms are split")
}

/// Its bones, or only the first and the last.
fn chain(split: bool) -> Vec<usize> {
    let t = segment();
    let between = t.bones().filter(|_| split);
    std::iter::once(t.from.index()).chain(between).chain([t.to.index()]).collect()
}

/// Positions of points by skinning them (m).
pub(super) fn posed<const N: usize>(
    points: &[Vec3],
    weights: &[Influences<N>],
    palette: &[Affine3A; BONES],
    blend: Blend,
) -> Result<Vec<Vec3>, SkinningError> {
    let job = SkinningJob::new(points, &vec![Vec3::Y; points.len()], weights)?;
    let mut posed = job.posed();
    job.run(blend, palette, &mut posed);
    Ok((0..points.len()).map(|v| posed.position(v)).collect())
}

/// Volume kept by a unit cylinder whose twist grows linearly from end to end.
fn cylinder(degrees: f64, split: bool, blend: Blend) -> Result<f64, SkinningError> {
    const RINGS: usize = 421;
    const SIDES: usize = 96;
    let chain = chain(split);
    let stretches = (chain.len() - 1) as f32;
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for ring in 0..RINGS {
        let w = ring as f32 / (RINGS - 1) as f32;
        let below = ((w * stretches) as usize).min(chain.len() - 2);
        let up = w * stretches - below as f32;
        let pair = [(chain[below] as u8, 1.0 - up), (chain[below + 1] as u8, up)];
        for side in 0..SIDES {
            let (s, c) = (std::f32::consts::TAU * side as f32 / SIDES as f32).sin_cos();
            points.push(Vec3::new(c, w, s));
            weights.push(SkinWeights::strongest(pair).0);
        }
    }
    let mut palette = [Affine3A::IDENTITY; BONES];
    for (k, &bone) in chain.iter().enumerate() {
        palette[bone] = Affine3A::from_rotation_y(degrees.to_radians() as f32 * k as f32 / stretches);
    }
    let area = |ring: &[Vec3]| -> f64 {
        let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
        pairs.map(|(a, b)| f64::from(a.x) * f64::from(b.z) - f64::from(b.x) * f64::from(a.z)).sum()
    };
    // The trapezoidal rule over the rings.
    let volume = |points: &[Vec3]| -> f64 {
        let areas: Vec<f64> = points.chunks(SIDES).map(area).collect();
        areas.windows(2).map(|a| 0.5 * (a[0] + a[1])).sum()
    };
    Ok(volume(&posed(&points, &weights, &palette, blend)?) / volume(&points))
}

/// The shopper's left forearm, from elbow to wrist, and how it is skinned.
struct Forearm {
    solid: ClosedSurface,
    points: Vec<Vec3>,
    weights: Vec<WideWeights>,
}

impl Forearm {
    /// `rounds` of refinement make each triangle into four; nothing is smoothed.
    fn new(body: &Body, split: bool, rounds: usize) -> Self {
        let points = body.mesh.positions.clone();
        let [elbow, wrist] = [Joint::LeftElbow, Joint::LeftWrist].map(|j| body.skeleton.at(j));
        let inside = |v: u32| {
            let along = (points[v as usize] - elbow).dot(wrist - elbow) / elbow.distance_squared(wrist);
            body.regions[v as usize] == Region::LeftArm && (0.0..=1.0).contains(&along)
        };
        let solid = ClosedSurface::cut(&body.mesh.triangles, inside);
        let weights = body.weights.iter().map(|w| wide(&if split { *w } else { unsplit(w) })).collect();
        let mut forearm = Self { solid, points, weights };
        (0..rounds).for_each(|_| forearm.refine());
        forearm
    }

    fn refine(&mut self) {
        let Self { solid, points, weights } = self;
        *solid = solid.refined(|edge| {
            let [a, b] = edge.map(|v| v as usize);
            points.push((points[a] + points[b]) * 0.5);
            weights.push(WideWeights::strongest(weights[a].iter().chain(weights[b].iter()).collect::<Vec<_>>()).0);
            points.len() as u32 - 1
        });
    }

    /// Volume kept when the hand is turned about the forearm.
    fn kept(&self, body: &Body, degrees: f64, blend: Blend) -> Result<f64, SkinningError> {
        let axis = body.skeleton.offset(Joint::LeftWrist).normalize();
        let mut pose = Pose::rest(&body.skeleton);
        pose.local[Joint::LeftWrist.index()] = Quat::from_axis_angle(axis, degrees.to_radians() as f32);
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&body.skeleton, &pose, &mut bones);
        let moved = posed(&self.points, &self.weights, &bones, blend)?;
        Ok(self.solid.volume(&moved) / self.solid.volume(&self.points))
    }
}

fn wide(weights: &SkinWeights) -> WideWeights {
    WideWeights::strongest(weights.iter()).0
}

/// The weights that a forearm of two bones would have: what its twist bones carry goes to its ends, linearly.
pub(super) fn unsplit(weights: &SkinWeights) -> SkinWeights {
    let t = segment();
    let parts = weights.iter().flat_map(|(bone, w)| {
        let twist = usize::from(bone).checked_sub(t.first).filter(|k| *k < t.count);
        let share = twist.map_or(0.0, |k| t.share(k + 1));
        let root = twist.map_or(bone, |_| t.from.index() as u8);
        [(root, w * (1.0 - share)), (t.to.index() as u8, w * share)]
    });
    SkinWeights::strongest(parts).0
}

/// What is within this distance of a joint (m) is looked at.
const NEAR_M: f32 = 0.12;

fn hinge(body: &Body, of: &'static str, joint: Joint, bends: Vec3, degrees: f64) -> Result<BentJoint, SkinningError> {
    let (skeleton, points) = (&body.skeleton, &body.mesh.positions);
    let root = joint.parent().expect("a hinge has a bone above it");
    let end = Joint::ALL.into_iter().find(|j| j.parent() == Some(joint)).expect("and one below it");
    let upper = skeleton.offset(joint).normalize();
    let mut pose = Pose::rest(skeleton);
    pose.local[joint.index()] = Quat::from_axis_angle(upper.cross(bends).normalize(), degrees.to_radians() as f32);
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, &pose, &mut bones);
    let at = |pose: &Pose| {
        let frames = JointFrames::new(skeleton, pose);
        [root, joint, end].map(|j| frames.at(j))
    };
    let (rest, bent) = (at(&Pose::rest(skeleton)), at(&pose));
    let near: Vec<usize> = (0..points.len()).filter(|&v| points[v].distance(rest[1]) < NEAR_M).collect();
    let solid = ClosedSurface::cut(&body.mesh.triangles, |v| points[v as usize].distance(rest[1]) < NEAR_M);
    let mut found =
        BentJoint { of, degrees, volume: [0.0; 3], bulge: [0.0; 3], bulge_mm: [0.0; 3], thinnest: [0.0; 3] };
    // Away from the inner side of the bend, where flesh meets flesh.
    let outwards = ((bent[1] - bent[0]).normalize() - (bent[2] - bent[1]).normalize()).normalize();
    let [linear, dual] = Blend::ALL.map(|blend| posed(points, &body.weights, &bones, blend));
    let ways = [linear?, dual?, swept(body, &bones)?];
    for (k, moved) in ways.into_iter().enumerate() {
        found.volume[k] = solid.volume(&moved) / solid.volume(points);
        let (mut most, mut most_mm, mut least) = (0.0f64, 0.0f64, f64::MAX);
        for &v in near.iter().filter(|&&v| (moved[v] - bent[1]).dot(outwards) > 0.0) {
            let (before, after) = (from_bones(points[v], rest), from_bones(moved[v], bent));
            most = most.max(after / before);
            most_mm = most_mm.max((after - before) * 1e3);
            least = least.min(after / before);
        }
        (found.bulge[k], found.bulge_mm[k], found.thinnest[k]) = (most - 1.0, most_mm, least - 1.0);
    }
    Ok(found)
}

/// Positions of the body's vertices, skinned by dual quaternions and swept around elbows and knees (m).
pub(super) fn swept(body: &Body, palette: &[Affine3A; BONES]) -> Result<Vec<Vec3>, SkinningError> {
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights)?;
    let mut posed = job.posed_mesh();
    job.run_mesh(Blend::Dual, palette, &mut posed);
    let sweep = SweptSkin::new(&body.skeleton, &body.mesh.positions, &body.normals, &body.weights);
    sweep.run(palette, &mut posed);
    Ok(posed.vertices().iter().map(|v| Vec3::from(v.position)).collect())
}

/// Moments of the scene that are looked at: ten a second.
const MOMENTS: usize = 100;

fn apart(body: &Body) -> Result<Vec<BlendDistance>, SkinningError> {
    let (skeleton, points) = (&body.skeleton, &body.mesh.positions);
    let limb = |v: usize| !matches!(body.regions[v], Region::Torso | Region::Head);
    let whole = ClosedSurface::of(body.mesh.triangles.clone());
    let mut found = ["trunk and head", "arms and legs"].map(|of| BlendDistance {
        of,
        body_volume: [1.0; 2],
        ..BlendDistance::default()
    });
    let mut counts = [0usize; 2];
    for moment in 0..MOMENTS {
        let mut bones = [Affine3A::IDENTITY; BONES];
        let time = scene::LENGTH_S * moment as f32 / MOMENTS as f32;
        palette(skeleton, &scene::shopper(skeleton, time), &mut bones);
        let [linear, dual] = Blend::ALL.map(|blend| posed(points, &body.weights, &bones, blend));
        let (linear, dual) = (linear?, dual?);
        for v in 0..points.len() {
            let mm = f64::from(linear[v].distance(dual[v])) * 1e3;
            let part = usize::from(limb(v));
            found[part].mean_mm += mm;
            found[part].max_mm = found[part].max_mm.max(mm);
            counts[part] += 1;
        }
        let volumes = [linear, dual].map(|p| whole.volume(&p) / whole.volume(points));
        for part in &mut found {
            part.body_volume = std::array::from_fn(|k| part.body_volume[k].min(volumes[k]));
        }
    }
    found.iter_mut().zip(counts).for_each(|(f, n)| f.mean_mm /= n.max(1) as f64);
    Ok(found.to_vec())
}

/// Distance of a point from two bones that meet (m).
fn from_bones(p: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let segment = |from: Vec3, to: Vec3| {
        let along = ((p - from).dot(to - from) / from.distance_squared(to)).clamp(0.0, 1.0);
        p.distance(from.lerp(to, along))
    };
    f64::from(segment(a, b).min(segment(b, c)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twisted_limbs_keep_what_theory_has_and_split_ones_nearly_all() {
        let found = shapes().unwrap();
        for t in &found.twists {
            if t.of == "cylinder" {
                assert!((t.linear_one_bone - t.theory).abs() < 1e-4, "{t:?}");
                assert!(t.degrees > 179.0 || (t.dual_one_bone - 1.0).abs() < 1e-4, "{t:?}");
            } else {
                assert!(t.linear_one_bone < 0.9, "the forearm is thinned without its twist bones: {t:?}");
                assert!(t.dual_one_bone >= 0.98, "{t:?}");
            }
            if t.degrees < 121.0 {
                assert!(t.linear_split >= 0.98 && t.dual_split >= 0.98, "{t:?}");
            }
        }
        assert_eq!(found.twists.len(), 7);
        for a in &found.apart {
            assert!(a.mean_mm > 0.0 && a.mean_mm < a.max_mm && a.max_mm < 100.0, "{a:?}");
            assert!(a.body_volume.iter().all(|v| (0.9..=1.0).contains(v)), "{a:?}");
        }
    }

    #[test]
    fn bent_joints_thin_under_linear_blending_and_bulge_under_dual_quaternions() {
        for h in shapes().unwrap().hinges {
            let [linear, dual, _] = h.bulge;
            assert!(dual > linear, "{h:?}");
            let [linear, dual, _] = h.thinnest;
            assert!(linear < dual, "{h:?}");
            let [linear, dual, swept] = h.volume.map(|v| (v - 1.0).abs());
            assert!(swept < dual && dual < linear, "{h:?}");
        }
    }
}
