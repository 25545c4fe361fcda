//! The kernels against scalar references: in f64 within a tolerance, in plain f32 bit for bit.

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, DVec4, Mat3, Vec3, Vec3A};
use toile_base::mesh::Influences;
use toile_base::skeleton::{BONE_CHAIN, BONES};

use super::*;
use crate::lanes::reciprocal_root;
use crate::skin::dual;

/// Agreement of the f32 kernels with the f64 references (m), within 3 m of the origin.
const REFERENCE_TOLERANCE: f64 = 2e-6;

fn wide(m: &Affine3A) -> DAffine3 {
    DAffine3 { matrix3: Mat3::from(m.matrix3).as_dmat3(), translation: Vec3::from(m.translation).as_dvec3() }
}

/// The plain sum of weighted matrices.
fn linear<const N: usize>(crowd: &Crowd<N>, v: usize) -> [DVec3; 2] {
    let sum: f64 = crowd.weights[v].iter().map(|(_, w)| f64::from(w)).sum();
    let mut blend = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    for (bone, weight) in crowd.weights[v].iter() {
        let m = wide(&crowd.palette[usize::from(bone)]);
        blend.matrix3 += m.matrix3 * (f64::from(weight) / sum);
        blend.translation += m.translation * (f64::from(weight) / sum);
    }
    let (p, n) = (crowd.positions[v].as_dvec3(), crowd.normals[v].as_dvec3());
    [blend.transform_point3(p), (blend.matrix3 * n).normalize_or_zero()]
}

/// The motion of a bone as the blend of dual quaternions takes it, applied the long way: rotation, then translation.
fn dual_blend<const N: usize>(crowd: &Crowd<N>, duals: &[[DQuat; 2]; BONES], v: usize) -> [DVec3; 2] {
    let mut sum = [DVec4::ZERO; 2];
    for (bone, weight) in crowd.weights[v].iter() {
        let [real, dual] = duals[usize::from(bone)];
        sum[0] += DVec4::from(real) * f64::from(weight);
        sum[1] += DVec4::from(dual) * f64::from(weight);
    }
    let length = sum[0].length();
    let (turn, dual) = (DQuat::from_vec4(sum[0] / length), DQuat::from_vec4(sum[1] / length));
    let translation = (dual * turn.conjugate()).xyz() * 2.0;
    [turn * crowd.positions[v].as_dvec3() + translation, turn * crowd.normals[v].as_dvec3()]
}

fn duals(palette: &[Affine3A; BONES]) -> [[DQuat; 2]; BONES] {
    let mut duals = [[DQuat::IDENTITY; 2]; BONES];
    for (bone, parent) in BONE_CHAIN {
        let m = wide(&palette[bone]);
        let mut real = DQuat::from_mat3(&m.matrix3).normalize();
        if parent.is_some_and(|p| duals[p][0].dot(real) < 0.0) {
            real = -real;
        }
        let t = m.translation * 0.5;
        duals[bone] = [real, DQuat::from_xyzw(t.x, t.y, t.z, 0.0) * real];
    }
    duals
}

fn agree<const N: usize>() {
    let crowd = Crowd::<N>::new(4_001, 1.0);
    let (job, duals) = (crowd.job(), duals(&crowd.palette));
    for blend in Blend::ALL {
        let got = posed(&job, blend, &crowd.palette);
        let mut worst: f64 = 0.0;
        for v in 0..got.vertices() {
            let [p, n] = match blend {
                Blend::Linear => linear(&crowd, v),
                Blend::Dual => dual_blend(&crowd, &duals, v),
            };
            worst = worst.max(got.position(v).as_dvec3().distance(p));
            assert!(got.normal(v).as_dvec3().distance(n) < 1e-5, "{blend}: normal {v}");
            assert!((got.normal(v).length() - 1.0).abs() < 3e-6, "{blend}: length of normal {v}");
        }
        assert!(worst > 0.0 && worst < REFERENCE_TOLERANCE, "{blend}, {N} influences: worst position {worst} m");
    }
}

#[test]
fn the_kernels_agree_with_their_f64_references() {
    agree::<1>();
    agree::<4>();
    agree::<8>();
}

/// Number `i` of the posed vertex, computed as a loop over vertices would, without blocks and lanes.
fn plain<const N: usize>(crowd: &Crowd<N>, bones: &[u8], v: usize) -> [Vec3; 2] {
    let weight = |bone: u8| Influences::<8>::strongest(crowd.weights[v].iter()).0.iter().find(|w| w.0 == bone);
    let columns = |b: u8| {
        let m = &crowd.palette[usize::from(b)];
        [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation]
    };
    let mut m = columns(bones[0]);
    for &bone in &bones[1..] {
        let w = weight(bone).map_or(0.0, |w| w.1);
        let (other, base) = (columns(bone), columns(bones[0]));
        (0..4).for_each(|c| m[c] += (other[c] - base[c]) * w);
    }
    let (p, n) = (crowd.positions[v], crowd.normals[v].normalize_or_zero());
    let at: Vec3A = (m[0] * p.x + m[1] * p.y) + (m[2] * p.z + m[3]);
    let normal: Vec3A = m[0] * n.x + m[1] * n.y + m[2] * n.z;
    let squared = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
    [at.into(), (normal * reciprocal_root(squared)).into()]
}

#[test]
fn linear_blending_is_a_plain_loop_bit_for_bit() {
    let crowd = Crowd::<4>::new(1_001, 1.0);
    let job = crowd.job();
    let got = posed(&job, Blend::Linear, &crowd.palette);
    for v in 0..got.vertices() {
        let bones = job.layout.bones_of(v);
        let [p, n] = plain(&crowd, &bones, v);
        assert_eq!(got.position(v).to_array().map(f32::to_bits), p.to_array().map(f32::to_bits), "position {v}");
        assert_eq!(got.normal(v).to_array().map(f32::to_bits), n.to_array().map(f32::to_bits), "normal {v}");
    }
}

#[test]
fn a_dual_quaternion_is_its_matrix_and_stands_on_its_parents_side() {
    let crowd = Crowd::<4>::new(1, 3.1);
    let duals = dual::palette(&crowd.palette);
    for (bone, parent) in BONE_CHAIN {
        let d = duals[bone];
        let turn = Quat::from_vec4(d.real);
        let t = (Quat::from_vec4(d.dual) * turn.conjugate()).xyz() * 2.0;
        let m = &crowd.palette[bone];
        assert!(t.distance(m.translation.into()) < 1e-6);
        assert!((turn * Vec3::ONE).distance(m.transform_vector3(Vec3::ONE)) < 1e-5);
        assert!(parent.is_none_or(|p| duals[p].real.dot(d.real) >= 0.0), "bone {bone}");
    }
}
