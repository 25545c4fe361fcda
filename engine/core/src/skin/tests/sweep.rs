//! Tests of the sweep: a reference in f64, nothing moves at rest, the same input gives the same bits, and a bent limb keeps its
//! volume better.

use glam::{Affine3A, DMat3, DQuat, DVec3, Quat, Vec3};
use toile_assets::body::{En, Wanted};
use toile_assets::scene;
use toile_base::body::{Body, Sex};
use toile_base::skeleton::{BONES, Joint, Pose, Twist};

use crate::body::palette;
use crate::skin::{Blend, PosedMesh, SkinningJob, SweepBinding, SweptLimb, SweptSkin};

fn woman() -> Body {
    toile_assets::body::fitted(Sex::Female, &Wanted::<En>::new()).unwrap().body
}

struct Swept {
    job: SkinningJob,
    sweep: SweptSkin,
    body: Body,
}

impl Swept {
    fn new(body: Body) -> Self {
        let (points, normals) = (&body.mesh.positions, &body.normals);
        Self {
            job: SkinningJob::new(points, normals, &body.weights).unwrap(),
            sweep: SweptSkin::new(&body.skeleton, points, normals, &body.weights),
            body,
        }
    }

    fn posed(&self, pose: &Pose, swept: bool) -> PosedMesh {
        let mut bones = [Affine3A::IDENTITY; BONES];
        palette(&self.body.skeleton, pose, &mut bones);
        let mut posed = self.job.posed_mesh();
        self.job.run_mesh(Blend::Dual, &bones, &mut posed);
        if swept {
            self.sweep.run(&bones, &mut posed);
        }
        posed
    }

    fn volume(&self, posed: &PosedMesh) -> f64 {
        let at = |v: u32| Vec3::from(posed.vertices()[v as usize].position).as_dvec3();
        self.body.mesh.triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum()
    }

    fn bent(&self, joint: Joint, degrees: f32) -> Pose {
        let skeleton = &self.body.skeleton;
        let bends = if joint == Joint::LeftElbow { Vec3::Z } else { Vec3::NEG_Z };
        let axis = skeleton.offset(joint).normalize().cross(bends).normalize();
        let mut pose = Pose::rest(skeleton);
        pose.local[joint.index()] = Quat::from_axis_angle(axis, degrees.to_radians());
        pose
    }
}

#[test]
fn a_sweep_at_rest_moves_nothing() {
    let swept = Swept::new(woman());
    let rest = swept.posed(&Pose::rest(&swept.body.skeleton), true);
    for (v, p) in rest.vertices().iter().zip(&swept.body.mesh.positions) {
        assert!(Vec3::from(v.position).distance(*p) < 2e-5, "{p} moved to {:?}", v.position);
    }
    assert!(swept.sweep.bindings.len() > 500, "{}", swept.sweep.bindings.len());
}

#[test]
fn a_bent_limb_that_is_swept_keeps_its_volume_and_the_same_bits() {
    let swept = Swept::new(woman());
    let rest = swept.volume(&swept.posed(&Pose::rest(&swept.body.skeleton), false));
    for (joint, degrees) in
        [(Joint::LeftElbow, 90.0), (Joint::LeftElbow, 120.0), (Joint::LeftKnee, 90.0), (Joint::LeftKnee, 120.0)]
    {
        let pose = swept.bent(joint, degrees);
        let (with, without) = (swept.posed(&pose, true), swept.posed(&pose, false));
        let lost = |p: &PosedMesh| 1e6 * (swept.volume(p) - rest);
        println!("{joint:?} {degrees}: dual {:+.1} ml, swept {:+.1} ml", lost(&without), lost(&with));
        assert!(lost(&with).abs() < lost(&without).abs(), "{joint:?} {degrees}");
        assert_eq!(with, swept.posed(&pose, true));
        for v in with.vertices() {
            let n = Vec3::from(v.normal);
            assert!(n.is_finite() && (n.length() - 1.0).abs() < 1e-3, "{n}");
        }
    }
}

/// How far the curve cuts the corner of a joint, as the kernel has it.
const CUT: f64 = 0.5;

/// Least and most that a section is scaled.
const SCALES: [f64; 2] = [0.85, 1.18];

/// A moment of the scene in which arms and legs are bent (s).
const MOMENT_S: f32 = 4.6;

/// A place of a limb's curve: where, its change a metre of limb, its rotation.
struct LimbPlace {
    at: DVec3,
    tangent: DVec3,
    turn: DQuat,
}

fn wide(m: &Affine3A) -> (DMat3, DVec3) {
    (glam::Mat3::from(m.matrix3).as_dmat3(), Vec3::from(m.translation).as_dvec3())
}

fn place(limb: &SweptLimb, along: f64, palette: &[Affine3A; BONES]) -> LimbPlace {
    let [(r1, s1), (r2, s2)] = [0, 1].map(|k| wide(&palette[limb.joints[k].index()]));
    let [a, b, c] = limb.rest.map(|p| p.as_dvec3());
    let (e1, e2) = ((b - a).normalize(), (c - b).normalize());
    let turn = |k: usize, share: f64| {
        let of = |bone: usize| DQuat::from_mat3(&wide(&palette[bone]).0);
        let first = of(limb.joints[k].index());
        let Some(twist) = Twist::towards(limb.joints[k + 1]) else { return first };
        let last = of(twist.first + twist.count - 1);
        let last = if first.dot(last) < 0.0 { -last } else { last };
        first.lerp(last, share / f64::from(twist.share(twist.count)))
    };
    let (d, hinge) = (f64::from(limb.bend), f64::from(limb.hinge));
    let by = along - hinge;
    let (l1, l2) = (hinge, b.distance(c));
    if by <= -d {
        return LimbPlace { at: r1 * (a + e1 * along) + s1, tangent: r1 * e1, turn: turn(0, along / l1) };
    }
    if by >= d {
        return LimbPlace { at: r2 * (b + e2 * by) + s2, tangent: r2 * e2, turn: turn(1, by / l2) };
    }
    let (t1, t2, joint) = (r1 * e1, r2 * e2, r2 * b + s2);
    let middle = joint + (t2 - t1) * (0.25 * d * CUT);
    let across = (t1 + t2).normalize();
    let (p, q, m, n, u) = if by < 0.0 {
        (r1 * (b - e1 * d) + s1, middle, t1, across, (by + d) / d)
    } else {
        (middle, r2 * (b + e2 * d) + s2, across, t2, by / d)
    };
    // The cubic of Hermite in Bezier's form, by de Casteljau.
    let c = [p, p + m * (d / 3.0), q - n * (d / 3.0), q];
    let one: [DVec3; 3] = std::array::from_fn(|i| c[i].lerp(c[i + 1], u));
    let two: [DVec3; 2] = std::array::from_fn(|i| one[i].lerp(one[i + 1], u));
    let (q1, q2) = (turn(0, 1.0 - d / l1), turn(1, d / l2));
    let q2 = if q1.dot(q2) < 0.0 { -q2 } else { q2 };
    LimbPlace {
        at: two[0].lerp(two[1], u),
        tangent: (two[1] - two[0]) * (3.0 / d),
        turn: q1.slerp(q2, (by + d) / (2.0 * d)),
    }
}

/// A rest point moved with the section at a place along its limb.
fn moved(limb: &SweptLimb, along: f64, rest: DVec3, palette: &[Affine3A; BONES]) -> DVec3 {
    let (before, now) = (place(limb, along, &[Affine3A::IDENTITY; BONES]), place(limb, along, palette));
    let axis = before.tangent.normalize();
    let turned = now.turn * axis;
    let square = DQuat::from_rotation_arc(turned, now.tangent.normalize()) * now.turn;
    let scale = (before.tangent.length() / now.tangent.length()).sqrt().clamp(SCALES[0], SCALES[1]);
    let off = rest - before.at;
    let ahead = axis * off.dot(axis);
    now.at + square * (ahead + (off - ahead) * scale)
}

/// By the vertex' own section.
fn own(limb: &SweptLimb, b: &SweepBinding, rest: DVec3, palette: &[Affine3A; BONES]) -> DVec3 {
    moved(limb, f64::from(b.along), rest, palette)
}

/// Between the two sections of the table that the kernel takes.
fn tabled(limb: &SweptLimb, b: &SweepBinding, rest: DVec3, palette: &[Affine3A; BONES]) -> DVec3 {
    let at = |s: f32| moved(limb, f64::from(s), rest, palette);
    let [low, high] = b.sections(limb);
    at(low).lerp(at(high), f64::from(b.between))
}

#[test]
fn a_sweep_agrees_with_its_f64_reference() {
    let (sex, measures) = scene::SHOPPER;
    let swept = Swept::new(toile_assets::body::build(sex, &measures).unwrap());
    let skeleton = &swept.body.skeleton;
    let pose = scene::shopper(skeleton, MOMENT_S);
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(skeleton, &pose, &mut bones);
    let (plain, posed) = (swept.posed(&pose, false), swept.posed(&pose, true));
    // By the sections of the kernel's table, and by the vertex' own section.
    let mut errors = [0.0f64; 2];
    for b in &swept.sweep.bindings {
        let limb = &swept.sweep.limbs[usize::from(b.limb)];
        let v = b.vertex as usize;
        let rest = swept.body.mesh.positions[v].as_dvec3();
        let at = |mesh: &PosedMesh| Vec3::from(mesh.vertices()[v].position).as_dvec3();
        for (error, exact) in errors.iter_mut().zip([tabled(limb, b, rest, &bones), own(limb, b, rest, &bones)]) {
            *error = error.max(at(&posed).distance(at(&plain).lerp(exact, f64::from(b.share))));
        }
    }
    assert!((1e-9..1e-5).contains(&errors[0]), "{} m", errors[0]);
    assert!(errors[1] < 3e-4, "{} m", errors[1]);
}
