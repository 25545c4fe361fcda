//! Functions with the same bits on every platform: sines, angles, and those products of vectors that glam computes in
//! another order, or fused, outside of x86-64.
//!
//! The standard library takes sine and arc tangent from the system's C library, and each system has its own. Here they are
//! made of additions, multiplications and quotients alone, which IEEE 754 rounds exactly. The methods are those of glibc 2.36,
//! so on Linux for x86-64 their results are the bits of the standard library: sine and cosine by polynomials in f64 (Arm's
//! optimized routines), the arc tangent by fdlibm's polynomial of degree 11 around four points.

use std::f32::consts::FRAC_PI_4;

use glam::{Quat, Vec3, Vec3A};

/// 2 / pi times 2^24, and half of pi: which quarter an angle lies in.
const QUARTERS: f64 = f64::from_bits(0x4164_5F30_6DC9_C883);
const QUARTER: f64 = f64::from_bits(0x3FF9_21FB_5444_2D18);

/// Coefficients of the sine of f64 from its third power on: odd powers.
const SINE: [f64; 3] = [
    f64::from_bits(0xBFC5_5554_5995_A603),
    f64::from_bits(0x3F81_1076_0523_0BC4),
    f64::from_bits(0xBF29_94EB_3774_CF24),
];

/// Coefficients of the cosine from its second power on: even powers.
const COSINE: [f64; 4] = [
    f64::from_bits(0xBFDF_FFFF_FD0C_621C),
    f64::from_bits(0x3FA5_5553_E106_8F19),
    f64::from_bits(0xBF56_C087_E89A_359D),
    f64::from_bits(0x3EF9_9343_027B_F8C3),
];

/// Largest angle that one subtraction brings into a quarter (rad). No angle of a body comes near it.
const LARGEST: f32 = 120.0;

/// Below this the sine is the angle (rad).
const SMALLEST: f32 = 1.0 / 4_096.0;

fn sine_near_zero(x: f64) -> f64 {
    let x2 = x * x;
    let x3 = x2 * x;
    (x + x3 * SINE[0]) + x3 * x2 * (SINE[1] + x2 * SINE[2])
}

fn cosine_near_zero(x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    ((1.0 + x2 * COSINE[0]) + x4 * COSINE[1]) + x4 * x2 * (COSINE[2] + x2 * COSINE[3])
}

/// Sine and cosine of an angle (rad).
pub fn sin_cos(angle: f32) -> (f32, f32) {
    // Angles are told apart by exponent and three bits of their fraction.
    let coarse = |x: f32| x.to_bits() >> 20;
    let x = f64::from(angle);
    if coarse(angle.abs()) < coarse(FRAC_PI_4) {
        let small = coarse(angle.abs()) < coarse(SMALLEST);
        let sine = if small { angle } else { sine_near_zero(x) as f32 };
        return (sine, if small { 1.0 } else { cosine_near_zero(x) as f32 });
    }
    // Whole turns leave the largest angles first; they lose digits, as any angle of that size has few.
    let x = if angle.abs() < LARGEST { x } else { x % std::f64::consts::TAU };
    let quarter = ((x * QUARTERS) as i32).wrapping_add(0x80_0000) >> 24;
    let x = x - f64::from(quarter) * QUARTER;
    let (sine, cosine) = (sine_near_zero(x), cosine_near_zero(x));
    let (sine, cosine) = match quarter & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    };
    (sine as f32, cosine as f32)
}

/// Bits of 2^(i/32), less i/32 of an exponent's unit.
#[rustfmt::skip]
const ROOTS_OF_TWO: [u64; 32] = [
    0x3ff0_0000_0000_0000, 0x3fef_d9b0_d315_8574, 0x3fef_b558_6cf9_890f, 0x3fef_9301_d012_5b51,
    0x3fef_72b8_3c7d_517b, 0x3fef_5487_3168_b9aa, 0x3fef_387a_6e75_6238, 0x3fef_1e9d_f51f_dee1,
    0x3fef_06fe_0a31_b715, 0x3fee_f1a7_373a_a9cb, 0x3fee_dea6_4c12_3422, 0x3fee_ce08_6061_892d,
    0x3fee_bfda_d536_2a27, 0x3fee_b42b_569d_4f82, 0x3fee_ab07_dd48_5429, 0x3fee_a47e_b03a_5585,
    0x3fee_a09e_667f_3bcd, 0x3fee_9f75_e8ec_5f74, 0x3fee_a114_73eb_0187, 0x3fee_a589_994c_ce13,
    0x3fee_ace5_422a_a0db, 0x3fee_b737_b0cd_c5e5, 0x3fee_c491_82a3_f090, 0x3fee_d503_b23e_255d,
    0x3fee_e89f_995a_d3ad, 0x3fee_ff76_f2fb_5e47, 0x3fef_199b_dd85_529c, 0x3fef_3720_dcef_9069,
    0x3fef_5818_dcfb_a487, 0x3fef_7c97_337b_9b5f, 0x3fef_a4af_a2a4_90da, 0x3fef_d076_5b6e_4540,
];

/// 32 / ln 2, and the coefficients of 2^(r/32) from the third power down.
const THIRTY_SECONDS: f64 = f64::from_bits(0x4047_1547_652B_82FE);
const POWER: [f64; 3] = [
    f64::from_bits(0x3EBC_6AF8_4B91_2394),
    f64::from_bits(0x3F2E_BFCE_50FA_C4F3),
    f64::from_bits(0x3F96_2E42_FF0C_52D6),
];

/// The exponential function.
pub fn exp(x: f32) -> f32 {
    /// Adding and subtracting it rounds to a whole number.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    /// Beyond these the result is infinite, or zero.
    const RANGE: [f32; 2] = [-103.98, 88.723];
    if x.is_nan() {
        return x;
    }
    if !(RANGE[0]..=RANGE[1]).contains(&x) {
        return if x < 0.0 { 0.0 } else { f32::INFINITY };
    }
    let z = f64::from(x) * THIRTY_SECONDS;
    let shifted = z + SHIFT;
    let whole = shifted.to_bits();
    let r = z - (shifted - SHIFT);
    let root = f64::from_bits(ROOTS_OF_TWO[(whole % 32) as usize].wrapping_add(whole << 47));
    (((POWER[0] * r + POWER[1]) * (r * r) + (POWER[2] * r + 1.0)) * root) as f32
}

/// Arc tangents of 1/2, 1, 3/2 and infinity, each in two parts, and where the next one begins (as bits).
const POINTS: [(f32, f32); 4] = [
    (4.636_476e-1, 5.012_158_2e-9),
    (7.853_981e-1, 3.774_894_7e-8),
    (9.827_937e-1, 3.447_321_7e-8),
    (1.570_796_3, 7.549_789_4e-8),
];

/// Coefficients of the arc tangent from its third power on: odd powers.
const ARC: [f32; 11] = [
    3.333_333_4e-1,
    -2.0e-1,
    1.428_571_5e-1,
    -1.111_111_04e-1,
    9.090_887e-2,
    -7.691_876e-2,
    6.661_073e-2,
    -5.833_570_3e-2,
    4.976_878e-2,
    -3.653_157e-2,
    1.628_582e-2,
];

/// Arc tangent of a number that is not negative.
fn arc_tangent(x: f32) -> f32 {
    if x.to_bits() >= 0x4C00_0000 {
        return if x.is_nan() { x } else { POINTS[3].0 + POINTS[3].1 };
    }
    if x < f32::from_bits(0x3100_0000) {
        return x;
    }
    let (point, x) = match x.to_bits() {
        ..0x3EE0_0000 => (None, x),
        0x3EE0_0000..0x3F30_0000 => (Some(POINTS[0]), (2.0 * x - 1.0) / (2.0 + x)),
        0x3F30_0000..0x3F98_0000 => (Some(POINTS[1]), (x - 1.0) / (x + 1.0)),
        0x3F98_0000..0x401C_0000 => (Some(POINTS[2]), (x - 1.5) / (1.0 + 1.5 * x)),
        0x401C_0000.. => (Some(POINTS[3]), -1.0 / x),
    };
    let z = x * x;
    let w = z * z;
    let odd = z * (ARC[0] + w * (ARC[2] + w * (ARC[4] + w * (ARC[6] + w * (ARC[8] + w * ARC[10])))));
    let even = w * (ARC[1] + w * (ARC[3] + w * (ARC[5] + w * (ARC[7] + w * ARC[9]))));
    match point {
        None => x - x * (odd + even),
        Some((high, low)) => high - ((x * (odd + even) - low) - x),
    }
}

/// Angle of the point (x, y) from the x axis (rad), -pi to pi, of finite numbers.
pub fn atan2(y: f32, x: f32) -> f32 {
    const PI: f32 = 3.141_592_7;
    /// Pi less [`PI`].
    const PI_LOW: f32 = -8.742_278e-8;
    if x.is_nan() || y.is_nan() {
        return f32::NAN;
    }
    let sign = |angle: f32| angle.copysign(y);
    if y == 0.0 {
        return if x.is_sign_negative() { sign(PI) } else { y };
    }
    if x == 0.0 {
        return sign(PI / 2.0);
    }
    let apart = (y.abs().to_bits() as i32 - x.abs().to_bits() as i32) >> 23;
    let acute = if apart > 60 {
        PI / 2.0 + 0.5 * PI_LOW
    } else if x < 0.0 && apart < -60 {
        0.0
    } else {
        arc_tangent((y / x).abs())
    };
    match (x < 0.0, y < 0.0) {
        (false, _) => sign(acute),
        (true, false) => PI - (acute - PI_LOW),
        (true, true) => (acute - PI_LOW) - PI,
    }
}

/// Angle of a cosine (rad), 0 to pi; not a number beyond -1 to 1. Rational functions around 0 and 1, as fdlibm has them.
pub fn acos(cosine: f32) -> f32 {
    const ABOVE: [f32; 6] =
        [1.666_666_7e-1, -3.255_658_1e-1, 2.012_125_3e-1, -4.005_553_6e-2, 7.915_35e-4, 3.479_331e-5];
    const BELOW: [f32; 5] = [1.0, -2.403_395e0, 2.020_945_8e0, -6.882_84e-1, 7.703_815_4e-2];
    /// Half of pi in two parts, and twice the first.
    const HALF: f32 = 1.570_796_3;
    const LOW: f32 = 7.549_789_4e-8;
    const WHOLE: f32 = 2.0 * HALF;
    let polynomial = |coefficients: &[f32], x: f32| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let ratio = |z: f32| z * polynomial(&ABOVE, z) / polynomial(&BELOW, z);
    let size = cosine.abs();
    if size >= 1.0 || cosine.is_nan() {
        return if cosine == 1.0 {
            0.0
        } else if cosine == -1.0 {
            WHOLE + 2.0 * LOW
        } else {
            f32::NAN
        };
    }
    if size <= f32::from_bits(0x3280_0000) {
        return HALF + LOW;
    }
    if size < 0.5 {
        return HALF - (cosine - (LOW - cosine * ratio(cosine * cosine)));
    }
    let z = (1.0 - size) * 0.5;
    let root = z.sqrt();
    if cosine < 0.0 {
        return WHOLE - 2.0 * (root + (ratio(z) * root - LOW));
    }
    let high = f32::from_bits(root.to_bits() & 0xFFFF_F000);
    let rest = (z - high * high) / (root + high);
    2.0 * (high + (ratio(z) * root + rest))
}

/// The cross product.
pub fn cross(a: Vec3A, b: Vec3A) -> Vec3A {
    Vec3A::new(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y)
}

/// The point between two, `t` of the way.
pub fn lerp(from: Vec3A, to: Vec3A, t: f32) -> Vec3A {
    from * (1.0 - t) + to * t
}

/// The inner product of two quaternions.
pub fn inner(a: Quat, b: Quat) -> f32 {
    (a.x * b.x + a.z * b.z) + (a.y * b.y + a.w * b.w)
}

/// A quaternion at unit length.
pub fn unit(q: Quat) -> Quat {
    let length = inner(q, q).sqrt();
    Quat::from_xyzw(q.x / length, q.y / length, q.z / length, q.w / length)
}

/// A vector as a rotation turns it.
pub fn turned(q: Quat, v: Vec3) -> Vec3 {
    let (axis, v) = (Vec3A::new(q.x, q.y, q.z), Vec3A::from(v));
    let kept = v * (q.w * q.w - axis.dot(axis));
    (kept + axis * (v.dot(axis) * 2.0) + cross(axis, v) * (q.w * 2.0)).into()
}

/// The rotation between two of unit length, `t` of the way (0 to 1), by the shorter arc.
///
/// Arc cosine and sine are the polynomials of DirectXMath (`XMScalarACos`, `XMVectorSin`), exact to 1e-6 within a right angle.
pub fn slerp(from: Quat, to: Quat, t: f32) -> Quat {
    const ARC_COSINE: [f32; 8] = [
        -0.001_262_491_1,
        0.006_670_09,
        -0.017_088_126,
        0.030_891_88,
        -0.050_174_303,
        0.088_978_99,
        -0.214_598_8,
        1.570_796_3,
    ];
    const SINE: [f32; 6] = [-2.388_986e-8, 2.752_556_2e-6, -0.000_198_408_74, 0.008_333_331, -0.166_666_67, 1.0];
    let cosine = inner(from, to);
    let (to, cosine) = if cosine < 0.0 { (-to, -cosine) } else { (to, cosine) };
    if cosine > 1.0 - f32::EPSILON {
        return unit(from * (1.0 - t) + to * t);
    }
    let polynomial =
        |coefficients: &[f32], x: f32| coefficients[1..].iter().fold(coefficients[0], |sum, c| sum * x + c);
    let arc = polynomial(&ARC_COSINE, cosine) * (1.0 - cosine).sqrt();
    let sine = |x: f32| polynomial(&SINE, x * x) * x;
    let (first, second, whole) = (sine(arc * (1.0 - t)), sine(arc * t), sine(arc));
    let number = |from: f32, to: f32| (to * second + from * first) / whole;
    Quat::from_xyzw(number(from.x, to.x), number(from.y, to.y), number(from.z, to.z), number(from.w, to.w))
}

/// The rotation about an axis by the length of the vector (rad).
pub fn from_scaled_axis(v: Vec3) -> Quat {
    let length = v.length();
    if length == 0.0 {
        return Quat::IDENTITY;
    }
    let (sine, cosine) = sin_cos(length * 0.5);
    let axis = v / length * sine;
    Quat::from_xyzw(axis.x, axis.y, axis.z, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::SplitMix64;

    /// Most results in ten million that may differ from the system's: its library may fuse what is rounded twice here.
    const DIFFERENT: u32 = 3;

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
    fn sines_have_the_bits_of_the_system() {
        let mut different = 0;
        for bits in (1e-6f32.to_bits()..LARGEST.to_bits()).step_by(50) {
            for angle in [f32::from_bits(bits), -f32::from_bits(bits)] {
                let (sine, cosine) = sin_cos(angle);
                different += u32::from(sine.to_bits() != angle.sin().to_bits());
                different += u32::from(cosine.to_bits() != angle.cos().to_bits());
            }
        }
        assert!(different <= DIFFERENT, "{different}");
    }

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
    fn exponentials_have_the_bits_of_the_system() {
        let mut different = 0;
        for bits in (1e-6f32.to_bits()..87f32.to_bits()).step_by(50) {
            for x in [f32::from_bits(bits), -f32::from_bits(bits)] {
                different += u32::from(exp(x).to_bits() != x.exp().to_bits());
            }
        }
        assert!(different <= DIFFERENT, "{different}");
    }

    #[test]
    fn arc_tangents_are_exact_to_the_last_digit_or_two() {
        let mut random = SplitMix64::new(3);
        let mut next = || random.between(-1.0, 1.0);
        for _ in 0..200_000 {
            let (y, x) = (next(), next());
            // Directions of every kind, and those that are upright but for a rounding error.
            for x in [x, 1e-7 * x] {
                let exact = f64::from(y).atan2(f64::from(x));
                assert!((f64::from(atan2(y, x)) - exact).abs() <= 2.4e-7, "{y} {x}");
                if cfg!(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64")) {
                    assert_eq!(atan2(y, x).to_bits(), y.atan2(x).to_bits(), "{y} {x}");
                }
            }
        }
        for (y, x) in [(0.0, 1.0), (-0.0, 1.0), (0.0, -1.0), (-0.0, -1.0), (1.0, 0.0), (-2.0, 0.0), (1e30, 1e-30)] {
            assert_eq!(atan2(y, x).to_bits(), f32::atan2(y, x).to_bits(), "{y} {x}");
        }
    }

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
    fn arc_cosines_have_the_bits_of_the_system() {
        for bits in (0..=1f32.to_bits()).step_by(50) {
            for cosine in [f32::from_bits(bits), -f32::from_bits(bits)] {
                assert_eq!(acos(cosine).to_bits(), cosine.acos().to_bits(), "{cosine}");
            }
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn products_have_glams_bits_on_x86() {
        let mut random = SplitMix64::new(5);
        let mut next = || random.between(-1.0, 1.0);
        for _ in 0..100_000 {
            let (a, b) = (Vec3A::new(next(), next(), next()), Vec3A::new(next(), next(), next()));
            let (p, q) =
                (Quat::from_xyzw(next(), next(), next(), next()), Quat::from_xyzw(next(), next(), next(), next()));
            assert_eq!(cross(a, b), a.cross(b));
            assert_eq!(inner(p, q), p.dot(q));
            assert_eq!(unit(p), p.normalize());
            assert_eq!(turned(unit(p), b.into()), p.normalize() * Vec3::from(b));
            assert_eq!(from_scaled_axis(b.into()), Quat::from_scaled_axis(b.into()));
            let (t, p, q) = (0.5 + 0.5 * a.x, unit(p), unit(q));
            assert_eq!(lerp(a, b, t), a.lerp(b, t));
            assert_eq!(slerp(p, q, t), p.slerp(q, t));
        }
    }
}
