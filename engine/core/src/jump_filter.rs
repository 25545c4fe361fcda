//! Jump filter: colliders that jump are not followed at once.
//!
//! A joint that a camera loses for some frames comes back somewhere else, and a sphere that crosses the cloth in one
//! step takes it along or leaves it inside out. No limb moves [`JUMP_M`] in a step; what does is held where it was, on
//! the moving body, and only when it stays away does its sphere go there, at [`FOLLOW_M_S`]. Sweeping the jump instead
//! makes it worse. A sphere that is not finite is held for as long as that lasts.

use glam::{Affine3A, Vec4, Vec4Swizzles};
use toile_base::limits::{MAX_SPHERES, STEP_SECONDS};

use crate::cone::PARKED;

/// What no sphere moves in a step of 1/120 s, relative to the root (m): 30 m/s, twice a thrown punch.
pub const JUMP_M: f32 = 0.25;

/// Steps that a sphere is held before it is followed: 50 ms, one and a half frames of a 30 Hz camera.
pub const HOLD_STEPS: u8 = 6;

/// How fast a held sphere goes to where it is said to be (m/s): a fast ankle, which cloth was tried at.
pub const FOLLOW_M_S: f32 = 10.0;

/// State of a sphere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum SphereState {
    /// The joint has not been seen yet.
    #[default]
    Absent,
    /// It is where it is said to be.
    There,
    /// It jumped, so many steps ago.
    Held(u8),
    /// It is on its way.
    Following,
}

/// The spheres of one body from step to step.
#[derive(Debug, Clone, PartialEq)]
pub struct JumpFilter {
    last: [Vec4; MAX_SPHERES],
    doing: [SphereState; MAX_SPHERES],
    /// Sphere steps held because of a jump, or because it was not finite.
    pub held: u64,
    /// Sphere steps on the way to where a sphere had jumped.
    pub followed: u64,
}

impl Default for JumpFilter {
    fn default() -> Self {
        Self { last: [PARKED; MAX_SPHERES], doing: [SphereState::Absent; MAX_SPHERES], held: 0, followed: 0 }
    }
}

impl JumpFilter {
    /// Changes the spheres `(x, y, z, radius)` of a step of `dt` seconds to where the cloth may meet them; says how many
    /// are not where they were said to be. `motion` is the root's in this step, in world space, finite. Spheres past [`MAX_SPHERES`] are left as they are.
    pub fn filter(&mut self, motion: &Affine3A, targets: &mut [Vec4], dt: f32) -> u32 {
        let mut away = 0;
        for ((target, last), doing) in targets.iter_mut().zip(&mut self.last).zip(&mut self.doing) {
            let carried = motion.transform_point3(last.xyz()).extend(last.w);
            let jump = JUMP_M * (dt / STEP_SECONDS).max(1.0);
            let (next, place) = decide(*doing, carried, *target, [jump, FOLLOW_M_S * dt]);
            (*doing, *target, *last) = (next, place, place);
            self.held += u64::from(matches!(next, SphereState::Held(_) | SphereState::Absent));
            self.followed += u64::from(next == SphereState::Following);
            away += u32::from(next != SphereState::There);
        }
        away
    }

    /// Forgets where the spheres were: a body that appears, or was teleported, does not jump.
    pub fn reset(&mut self) {
        self.doing = [SphereState::Absent; MAX_SPHERES];
    }
}

/// What a sphere does now, and where it is. A sphere that moved further than `jump` has jumped; one on its way
/// goes as far as `reach` (m).
fn decide(doing: SphereState, carried: Vec4, target: Vec4, [jump, reach]: [f32; 2]) -> (SphereState, Vec4) {
    let finite = target.is_finite() && target.w >= 0.0;
    let gap = target - carried;
    // A radius jumps like a place.
    let far = gap.length();
    match doing {
        SphereState::Absent if finite => (SphereState::There, target),
        SphereState::Absent => (doing, PARKED),
        // It is followed when it is back and known, however long that takes.
        _ if !finite => (if doing == SphereState::Following { doing } else { SphereState::Held(0) }, carried),
        SphereState::There | SphereState::Held(_) if far <= jump => (SphereState::There, target),
        SphereState::There => (SphereState::Held(1), carried),
        SphereState::Held(steps) if steps < HOLD_STEPS => (SphereState::Held(steps + 1), carried),
        _ if far <= reach => (SphereState::There, target),
        _ => (SphereState::Following, carried + gap * (reach / far)),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    const DT: f32 = 1.0 / 120.0;
    const HERE: Vec4 = Vec4::new(0.1, 0.5, 0.0, 0.06);
    const STILL: Affine3A = Affine3A::IDENTITY;

    fn step(hold: &mut JumpFilter, targets: [Vec4; 2]) -> [Vec4; 2] {
        let mut targets = targets;
        hold.filter(&STILL, &mut targets, DT);
        targets
    }

    #[test]
    fn a_jump_of_one_frame_and_back_leaves_the_sphere_undisturbed() {
        let mut hold = JumpFilter::default();
        for k in 0..20 {
            let shift = Vec4::X * 0.02 * k as f32;
            let away = if k == 8 { Vec4::X } else { Vec4::ZERO };
            let [jumps, other] = step(&mut hold, [HERE + shift + away, HERE + shift]);
            assert_eq!(other, HERE + shift);
            let expected = if k == 8 { HERE + Vec4::X * 0.02 * 7.0 } else { HERE + shift };
            assert_eq!(jumps, expected, "step {k}");
        }
        assert_eq!((hold.held, hold.followed), (1, 0));
    }

    #[test]
    fn a_jump_that_lasts_is_followed_at_a_bounded_speed() {
        let mut hold = JumpFilter::default();
        step(&mut hold, [HERE; 2]);
        let there = HERE + Vec4::X;
        let mut last = HERE;
        for k in 0..u32::from(HOLD_STEPS) + 13 {
            let [sphere, _] = step(&mut hold, [there, HERE]);
            assert!(sphere.distance(last) <= FOLLOW_M_S * DT * 1.001, "step {k}");
            assert!(k >= u32::from(HOLD_STEPS) || sphere == HERE, "held at first");
            last = sphere;
        }
        assert_eq!(last, there, "12 steps of 83 mm");
        assert_eq!((hold.held, hold.followed), (6, 12));
        assert_eq!(hold.filter(&STILL, &mut [there, HERE], DT), 0);
    }

    #[test]
    fn what_is_no_number_is_held_and_counted() {
        let mut hold = JumpFilter::default();
        // Before it was ever seen it stands where nothing is.
        assert_eq!(step(&mut hold, [Vec4::NAN, HERE]), [PARKED, HERE]);
        step(&mut hold, [HERE; 2]);
        let bad = [Vec4::NAN, HERE * f32::INFINITY, HERE - Vec4::W, HERE.with_w(f32::NAN)];
        for target in bad {
            assert_eq!(step(&mut hold, [target, HERE]), [HERE; 2]);
        }
        for _ in 0..100 {
            assert_eq!(step(&mut hold, [bad[0], HERE]), [HERE; 2]);
        }
        assert_eq!(hold.held, 105);
        assert_eq!(step(&mut hold, [HERE + Vec4::Y * 0.1, HERE])[0], HERE + Vec4::Y * 0.1);
    }

    #[test]
    fn a_held_sphere_goes_with_the_body_and_what_the_body_carries_does_not_jump() {
        let mut hold = JumpFilter::default();
        step(&mut hold, [HERE; 2]);
        let motion = Affine3A::from_rotation_y(1.0) * Affine3A::from_translation(Vec3::new(0.4, 0.0, 0.3));
        let carried = motion.transform_point3(HERE.xyz()).extend(HERE.w);
        let mut targets = [carried, carried + Vec4::Y];
        assert_eq!(hold.filter(&motion, &mut targets, DT), 1);
        assert_eq!(targets, [carried; 2]);
        hold.reset();
        assert_eq!(step(&mut hold, [HERE + Vec4::X * 3.0, HERE])[0], HERE + Vec4::X * 3.0);
    }
}
