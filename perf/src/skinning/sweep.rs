//! The sweep around elbows and knees: its time, and its distance from a reference in f64 that computes every vertex' own section.

use glam::{Affine3A, DMat3, DQuat, DVec3, Vec3};
use serde::Serialize;
use std::hint::black_box;
use toile_assets::scene;
use toile_base::skeleton::{BONES, Twist};
use toile_engine::body::palette;
use toile_engine::skin::{Blend, SkinningJob, SweepBinding, SweptLimb, SweptSkin};
use toile_fitting::scene::reference_time::{self, ReferenceTimer};
use toile_fitting::timing;

use super::error::SkinningError;

/// How far the curve cuts the corner of a joint, as the kernel has it.
const CUT: f64 = 0.5;

/// Least and most that a section is scaled.
const SCALES: [f64; 2] = [0.85, 1.18];

/// A moment of the scene in which arms and legs are bent (s).
const MOMENT_S: f32 = 4.6;

/// What the sweep costs, and how exact it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SweepTiming {
    /// Vertices of the body, and those that are swept.
    pub verts: usize,
    /// Vertices that are swept.
    pub swept: usize,
    /// Time of the sweep (us, median).
    pub us: f64,
    /// Time of the dual quaternions that it works on (us, median).
    pub dual_us: f64,
    /// The sweep's time over the reference time of as many vertices as are swept.
    pub y_ratio: f64,
    /// Largest distance of a swept position from the same sections in f64 (m).
    pub max_error_m: f64,
    /// Largest distance from the vertex' own section, which the kernel takes between two of a table (m).
    pub section_error_m: f64,
}

/// Times the sweep of the scene's shopper and finds its errors.
///
/// # Errors
/// Where the shopper cannot be built.
pub fn sweep_timing() -> Result<SweepTiming, SkinningError> {
    let (sex, measures) = scene::SHOPPER;
    let body = toile_assets::body::build(sex, &measures)?;
    let (points, normals) = (&body.mesh.positions, &body.normals);
    let job = SkinningJob::new(points, normals, &body.weights)?;
    let sweep = SweptSkin::new(&body.skeleton, points, normals, &body.weights);
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&body.skeleton, &scene::shopper(&body.skeleton, MOMENT_S), &mut bones);
    let mut posed = job.posed_mesh();
    let reference_us = ReferenceTimer::new()?.read_us();
    let dual_us = timing::median_us(|| {
        job.run_mesh(Blend::Dual, black_box(&bones), &mut posed);
        black_box(&posed);
    });
    let plain = posed.clone();
    let us = timing::median_us(|| {
        sweep.run(black_box(&bones), &mut posed);
        black_box(&posed);
    });
    let mut once = plain.clone();
    sweep.run(&bones, &mut once);
    let mut errors = [0.0f64; 2];
    for b in &sweep.bindings {
        let limb = &sweep.limbs[usize::from(b.limb)];
        let v = b.vertex as usize;
        let rest = points[v].as_dvec3();
        let skinned = Vec3::from(plain.vertices()[v].position).as_dvec3();
        let got = Vec3::from(once.vertices()[v].position).as_dvec3();
        let share = f64::from(b.share);
        for (error, exact) in errors.iter_mut().zip([tabled(limb, b, rest, &bones), own(limb, b, rest, &bones)]) {
            *error = error.max(got.distance(skinned.lerp(exact, share)));
        }
    }
    Ok(SweepTiming {
        verts: points.len(),
        swept: sweep.bindings.len(),
        us,
        dual_us,
        y_ratio: us / (reference_us * sweep.bindings.len() as f64 / reference_time::VERTICES as f64),
        max_error_m: errors[0],
        section_error_m: errors[1],
    })
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_agrees_with_its_f64_reference() {
        let found = sweep_timing().unwrap();
        println!("{found:?}");
        assert!(found.swept > 500 && found.us > 0.0);
        assert!((1e-9..1e-5).contains(&found.max_error_m), "{} m", found.max_error_m);
        assert!(found.section_error_m < 3e-4, "{} m", found.section_error_m);
    }
}
