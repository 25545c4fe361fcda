//! The body in the skirt and its motion: worked out in f64 from the time, so that the hundredth hour is as exact as the
//! first second.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec4};

/// Spheres of the scene's body.
pub const SPHERES: usize = 16;

/// Centre and radius of each sphere at rest (m).
pub const JOINTS: [([f64; 3], f64); SPHERES] = [
    ([0.0, 1.0, 0.0], 0.14),
    ([0.0, 1.2, 0.0], 0.13),
    ([0.0, 1.4, 0.0], 0.14),
    ([0.0, 1.55, 0.0], 0.06),
    ([0.0, 1.7, 0.0], 0.10),
    ([0.10, 0.95, 0.0], 0.11),
    ([-0.10, 0.95, 0.0], 0.11),
    ([0.11, 0.52, 0.0], 0.07),
    ([-0.11, 0.52, 0.0], 0.07),
    ([0.11, 0.10, 0.0], 0.05),
    ([-0.11, 0.10, 0.0], 0.05),
    ([0.18, 1.45, 0.0], 0.07),
    ([-0.18, 1.45, 0.0], 0.07),
    ([0.38, 1.2, 0.0], 0.05),
    ([-0.38, 1.2, 0.0], 0.05),
    ([0.0, 1.1, 0.03], 0.12),
];

/// Pairs of spheres that tapered capsules join.
pub const CAPSULES: [[u8; 2]; 28] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 4],
    [0, 5],
    [0, 6],
    [5, 7],
    [6, 8],
    [7, 9],
    [8, 10],
    [2, 11],
    [2, 12],
    [11, 13],
    [12, 14],
    [5, 6],
    [1, 5],
    [1, 6],
    [1, 11],
    [1, 12],
    [11, 12],
    [0, 15],
    [15, 1],
    [15, 5],
    [15, 6],
    [15, 2],
    [3, 11],
    [3, 12],
    [0, 2],
];

/// Spheres of hip, knee, ankle, shoulder and elbow on either side.
const LIMBS: [[usize; 5]; 2] = [[5, 7, 9, 11, 13], [6, 8, 10, 12, 14]];

/// Time in which the amplitudes rise from nothing (s).
const RAMP_S: f64 = 1.0;

/// How far the root rises and falls, twice a cycle (m).
const BOB_M: f64 = 0.02;

toile_base::named! {
    /// Motion of the body.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum SkirtMotion {
        /// Walks on the spot: 1 Hz, legs 30 degrees to and fro, 0.05 m of sway, 10 degrees of yaw.
        Walk = "walk",
        /// The same in a hurry: 2 Hz, 50 degrees, 0.10 m, 45 degrees.
        Fast = "fast",
        /// Stands still: all amplitudes are 0.
        Settled = "settled",
    }
}

impl SkirtMotion {
    /// Frequency (Hz), leg (rad), sway (m), yaw (rad), bob (m).
    fn amplitudes(self) -> [f64; 5] {
        match self {
            Self::Walk => [1.0, 30f64.to_radians(), 0.05, 10f64.to_radians(), BOB_M],
            Self::Fast => [2.0, 50f64.to_radians(), 0.10, 45f64.to_radians(), BOB_M],
            Self::Settled => [0.0; 5],
        }
    }
}

/// One moment of a motion.
struct MotionPhase {
    phase: f64,
    leg: f64,
    root: DAffine3,
}

impl MotionPhase {
    fn new(motion: SkirtMotion, time: f64) -> Self {
        let [frequency, leg, sway, yaw, bob] = motion.amplitudes();
        let ramp = (time / RAMP_S).clamp(0.0, 1.0);
        let phase = std::f64::consts::TAU * frequency * time;
        let (sin, cos) = phase.sin_cos();
        let at = ramp * DVec3::new(sway * sin, bob * (2.0 * phase).cos(), sway * cos - sway);
        let turn = DMat3::from_rotation_y(ramp * yaw * sin);
        Self { phase, leg: ramp * leg, root: DAffine3::from_mat3_translation(turn, at) }
    }

    fn joints(&self) -> [DVec3; SPHERES] {
        let rest = JOINTS.map(|(p, _)| DVec3::from_array(p));
        let mut at = rest;
        for ([hip, knee, ankle, shoulder, elbow], side) in LIMBS.into_iter().zip([0.0, 1.0]) {
            let swing = (1.0 - 2.0 * side) * self.leg * self.phase.sin();
            let bend = 0.6 * self.leg * (1.0 + (self.phase + side * std::f64::consts::PI).sin());
            let turned = |angle: f64, from: usize, to: usize| DMat3::from_rotation_x(angle) * (rest[to] - rest[from]);
            at[knee] = rest[hip] + turned(-swing, hip, knee);
            at[ankle] = at[knee] + turned(bend - swing, knee, ankle);
            at[elbow] = rest[shoulder] + turned(swing, shoulder, elbow);
        }
        at.map(|p| self.root.transform_point3(p))
    }
}

/// How the root, and with it the pinned ring, is moved at a time (s).
pub fn root(motion: SkirtMotion, time: f64) -> Affine3A {
    let root = MotionPhase::new(motion, time).root;
    Affine3A::from_mat3_translation(root.matrix3.as_mat3(), root.translation.as_vec3())
}

/// The body's spheres at a time (s): centre and radius, world (m).
pub fn spheres(motion: SkirtMotion, time: f64) -> [Vec4; SPHERES] {
    let at = MotionPhase::new(motion, time).joints();
    std::array::from_fn(|i| at[i].extend(JOINTS[i].1).as_vec4())
}

#[cfg(test)]
mod tests {
    use glam::{Vec3, Vec4Swizzles};

    use super::*;

    fn close(a: Vec4, b: [f32; 3]) -> bool {
        a.xyz().distance(Vec3::from_array(b)) < 1e-6
    }

    #[test]
    fn it_starts_at_rest_and_a_settled_body_stays_there() {
        for (motion, time) in [(SkirtMotion::Walk, 0.0), (SkirtMotion::Fast, 0.0), (SkirtMotion::Settled, 7.3)] {
            assert_eq!(root(motion, time), Affine3A::IDENTITY);
            for (s, (p, r)) in spheres(motion, time).iter().zip(JOINTS) {
                assert_eq!(*s, DVec3::from_array(p).extend(r).as_vec4());
            }
        }
    }

    #[test]
    fn a_quarter_into_a_walk_one_leg_is_forward_and_the_other_back() {
        // phi = pi/2: yaw 10 degrees, root (.05, -.02, -.05); left leg 30 degrees forward, its knee bent by 36, the
        // right leg 30 degrees back and straight.
        let s = spheres(SkirtMotion::Walk, 2.25);
        assert!(close(s[0], [0.05, 0.98, -0.05]));
        // Hip (.1, .95, 0); thigh (.01, -.43, 0) turned by -30 degrees about x: (.01, -.37239, .215); turned by yaw.
        let (yaw_sin, yaw_cos) = (0.173_648_18_f32, 0.984_807_7_f32);
        let turned =
            |x: f32, y: f32, z: f32| [x * yaw_cos + z * yaw_sin + 0.05, y - 0.02, -x * yaw_sin + z * yaw_cos - 0.05];
        assert!(close(s[7], turned(0.11, 0.577_609_1, 0.215)), "{}", s[7]);
        // Shin (0, -.42, 0) turned by +6 degrees: (0, -.417699, -.043902).
        assert!(close(s[9], turned(0.11, 0.577_609_1 - 0.417_699_2, 0.215 - 0.043_901_95)), "{}", s[9]);
        assert!(close(s[8], turned(-0.11, 0.577_609_1, -0.215)), "{}", s[8]);
        assert!(close(s[10], turned(-0.11, 0.577_609_1 - 0.363_730_67, -0.215 - 0.21)), "{}", s[10]);
        // The left arm swings back: shoulder (.18, 1.45, 0), arm (.2, -.25, 0) turned by +30 degrees.
        assert!(close(s[13], turned(0.38, 1.45 - 0.216_506_35, -0.125)), "{}", s[13]);
        assert_eq!(s[13].w, 0.05);
    }

    #[test]
    fn amplitudes_rise_within_the_first_second() {
        // phi = pi at 0.5 s of a walk: root (0, .01, -.05), no yaw; half the amplitude leaves z at -.05.
        let at = Vec3::from(root(SkirtMotion::Walk, 0.5).translation);
        assert!(at.distance(Vec3::new(0.0, 0.01, -0.05)) < 1e-6, "{at}");
        // phi = pi/2 at 1.125 s when fast: all of it.
        let fast = root(SkirtMotion::Fast, 1.125);
        assert!(Vec3::from(fast.translation).distance(Vec3::new(0.10, -0.02, -0.10)) < 1e-6);
        let yaw = (-fast.matrix3.x_axis.z).atan2(fast.matrix3.x_axis.x).to_degrees();
        assert!((yaw - 45.0).abs() < 1e-4, "{yaw}");
    }

    #[test]
    fn bones_keep_their_lengths() {
        for tick in 0..480 {
            let s = spheres(SkirtMotion::Fast, f64::from(tick) / 120.0);
            for [a, b] in [[5, 7], [7, 9], [6, 8], [8, 10], [11, 13], [0, 5]] {
                let rest = DVec3::from_array(JOINTS[a].0).distance(DVec3::from_array(JOINTS[b].0));
                let length = s[a].xyz().distance(s[b].xyz());
                assert!((f64::from(length) - rest).abs() < 1e-6, "tick {tick}: {a}-{b}");
            }
        }
    }
}
