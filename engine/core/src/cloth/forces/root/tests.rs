use glam::Vec3;
use proptest::prelude::*;

use super::super::wind::Accelerations;
use super::*;
use crate::cloth::state::{self, State};

const DT: f32 = 1.0 / 120.0;
const SUBSTEPS: usize = 4;

fn scales(linear: f32, angular: f32, centrifugal: f32) -> RootSettings {
    RootSettings { linear, angular, centrifugal, ..RootSettings::default() }
}

fn pose(axis: Vec3, angle: f32, at: Vec3) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_axis_angle(axis.normalize(), angle), at)
}

fn particles() -> State {
    let places: Vec<Vec3> =
        (0..37).map(|i| Vec3::new((i as f32).sin(), 1.0 + 0.02 * i as f32, (i as f32).cos())).collect();
    State::new(&places, &[1_000.0; 37])
}

fn place(columns: [&[f32]; 3], i: usize) -> Vec3A {
    Vec3A::from_array(columns.map(|c| c[i]))
}

/// A step of free particles without gravity, as predict moves them.
fn step(state: &mut State, root: &mut RootMotion, at: &Affine3A) -> RootStep {
    let mut accelerations = Accelerations::new(37);
    let motion = root.advance(at, DT);
    if let RootStep::Carried(carried) = motion {
        carried.apply(Width::widest(), state.columns(), (0, 37), accelerations.columns());
    }
    let dt = DT / SUBSTEPS as f32;
    for _ in 0..SUBSTEPS {
        for i in 0..37 {
            let c = state.columns();
            let v = state::get(c.v, i) + accelerations.of(i) * dt;
            state::set(c.v, i, v);
            state::set(c.x, i, state::get(c.x, i) + v * dt);
        }
    }
    motion
}

#[test]
fn scales_of_one_do_nothing_whatever_the_root_does() {
    let mut root = RootMotion::new(RootSettings::default());
    for k in 0..50 {
        let t = k as f32 * DT;
        let at = pose(Vec3::new(1.0, 2.0, 0.5), 3.0 * t, Vec3::new((5.0 * t).sin(), t, 0.0));
        assert_eq!(root.advance(&at, DT), RootStep::Plain);
    }
    assert_eq!((root.held, root.teleports), (0, 0));
}

#[test]
fn linear_scale_0_keeps_a_particle_at_rest_relative_to_a_root_that_accelerates() {
    let (mut root, mut state) = (RootMotion::new(scales(0.0, 1.0, 1.0)), particles());
    let start = state.clone();
    let mut offset = Vec3::ZERO;
    for k in 0..=240 {
        let t = k as f32 * DT;
        offset = Vec3::new(2.0 * t * t, 0.0, -t * t);
        step(&mut state, &mut root, &Affine3A::from_translation(offset));
    }
    for i in 0..37 {
        let moved = place(state.positions(), i) - place(start.positions(), i);
        assert!(moved.distance(offset.into()) < 1e-4, "moved {moved}, the root {offset}");
    }
    // A half takes half of the acceleration.
    let (mut root, mut state) = (RootMotion::new(scales(0.5, 1.0, 1.0)), particles());
    for k in 0..=120 {
        step(&mut state, &mut root, &Affine3A::from_translation(Vec3::X * (k * k) as f32 * 1e-4));
    }
    assert!((place(state.positions(), 0) - place(start.positions(), 0)).x / (120.0f32 * 120.0 * 1e-4) - 0.5 < 1e-3);
}

#[test]
fn a_particle_that_turns_with_the_root_keeps_turning_without_the_centrifugal_force() {
    let spin = 4.0;
    let at = |k: usize| pose(Vec3::Y, spin * k as f32 * DT, Vec3::ZERO);
    for angular in [0.0, 1.0] {
        let (mut root, mut state) = (RootMotion::new(scales(1.0, angular, 0.0)), particles());
        let start = state.clone();
        // The root has turned before.
        root.advance(&at(0), DT);
        root.advance(&at(1), DT);
        for i in 0..37 {
            state::set(state.columns().v, i, Vec3A::Y.cross(place(start.positions(), i)) * spin);
        }
        for k in 2..242 {
            step(&mut state, &mut root, &at(k));
        }
        for i in 0..37 {
            let back = at(240).inverse().transform_point3a(place(state.positions(), i));
            let error = back.distance(place(start.positions(), i));
            // Nothing brings it back; it has gone 8 m. With the centrifugal force it would be 7 m out.
            assert!(error < 0.02 * 8.0, "angular {angular}: {error} m from where it turned with the root");
        }
    }
    // With it, it flies off.
    let (mut root, mut state) = (RootMotion::new(RootSettings::default()), particles());
    let tangent = Vec3A::Y.cross(place(state.positions(), 0)) * spin;
    state::set(state.columns().v, 0, tangent);
    for k in 0..120 {
        step(&mut state, &mut root, &at(k));
    }
    assert!(place(state.positions(), 0).length() > 3.0);
}

#[test]
fn scales_of_zero_carry_a_free_particle_with_any_smooth_motion() {
    let (mut root, mut state) = (RootMotion::new(scales(0.0, 0.0, 0.0)), particles());
    let start = state.clone();
    let at = |k: usize| {
        let t = k as f32 * DT;
        let place = Vec3::new(0.5 * (3.0 * t).sin(), 0.1 * (7.0 * t).cos(), t);
        pose(Vec3::new(0.2, 1.0, 0.1), 0.8 * (2.0 * t).sin(), place)
    };
    for k in 0..=240 {
        step(&mut state, &mut root, &at(k));
    }
    for i in 0..37 {
        let dressed = (at(240) * at(0).inverse()).transform_point3a(place(start.positions(), i));
        let error = dressed.distance(place(state.positions(), i));
        assert!(error < 0.05, "{error} m after two seconds");
    }
}

#[test]
fn every_width_compensates_with_the_same_bits() {
    let run = |width: Width| {
        let (mut root, mut state, mut out) =
            (RootMotion::new(scales(0.3, 0.2, 0.1)), particles(), Accelerations::new(37));
        root.advance(&Affine3A::IDENTITY, DT);
        let RootStep::Carried(carried) = root.advance(&pose(Vec3::ONE, 0.05, Vec3::X * 0.02), DT) else { panic!() };
        [(0, 20), (20, 17)].into_iter().for_each(|span| carried.apply(width, state.columns(), span, out.columns()));
        Moved { motion: root.motion() }.apply(width, state.columns(), (3, 30));
        ([state.positions(), state.velocities()].map(|c| c.map(<[f32]>::to_vec)), out)
    };
    Width::ALL.into_iter().filter(|w| w.available()).for_each(|w| assert_eq!(run(w), run(Width::One), "{w} lanes"));
}

#[test]
fn a_root_that_is_not_finite_or_not_rigid_is_held() {
    let mut root = RootMotion::new(scales(0.0, 0.0, 0.0));
    let nan = Affine3A::from_translation(Vec3::NAN);
    assert_eq!(root.advance(&nan, DT), RootStep::Plain);
    root.advance(&Affine3A::IDENTITY, DT);
    for bad in [nan, Affine3A::from_scale(Vec3::ZERO), Affine3A::from_translation(Vec3::splat(f32::INFINITY))] {
        assert!(matches!(root.advance(&bad, DT), RootStep::Carried(_)));
        assert_eq!(root.motion(), Affine3A::IDENTITY);
    }
    assert_eq!((root.held, root.teleports), (4, 0));
}

#[test]
fn a_jump_or_a_sudden_turn_is_a_teleport_and_the_next_step_is_not() {
    for (far, turn) in [(0.6, 0.0), (0.0, 61.0f32)] {
        let to = pose(Vec3::Y, turn.to_radians(), Vec3::X * far);
        let mut root = RootMotion::new(scales(0.0, 0.0, 0.0));
        root.advance(&Affine3A::IDENTITY, DT);
        assert_eq!(root.advance(&to, DT), RootStep::Reset);
        let RootStep::Carried(next) = root.advance(&to, DT) else { panic!("no second teleport") };
        assert_eq!((next.jolt, next.twist), (Vec3A::ZERO, Vec3A::ZERO));
        assert_eq!(root.teleports, 1);
    }
    let mut root = RootMotion::new(RootSettings::default());
    root.advance(&Affine3A::IDENTITY, DT);
    assert_eq!(root.advance(&pose(Vec3::Y, 1.0, Vec3::X * 0.49), DT), RootStep::Plain, "57 degrees and 49 cm");
}

proptest! {
    #[test]
    fn keep_leaves_edges_and_relative_velocities(
        axis in prop::array::uniform3(-1.0f32..1.0), angle in -3.0f32..3.0, far in prop::array::uniform3(1.0f32..5.0),
    ) {
        let axis = Vec3::from(axis) + Vec3::new(0.0, 0.0, 1e-3);
        prop_assume!(axis.length() > 0.01);
        let mut root = RootMotion::new(RootSettings { teleport: Teleport::Keep, ..RootSettings::default() });
        let from = pose(Vec3::X, 0.3, Vec3::Y);
        let to = pose(axis, angle, Vec3::from(far) + Vec3::Y);
        root.advance(&from, DT);
        let RootStep::Keep(moved) = root.advance(&to, DT) else { panic!("not noticed") };
        let mut state = particles();
        (0..37).for_each(|i| state::set(state.columns().v, i, Vec3A::new(i as f32 * 0.1, 1.0, -0.3)));
        let before = state.clone();
        moved.apply(Width::widest(), state.columns(), (0, 37));
        let carry = to * from.inverse();
        for i in 0..37 {
            let j = (i * 7 + 1) % 37;
            let edge = |s: &State| place(s.positions(), i).distance(place(s.positions(), j));
            prop_assert!((edge(&state) - edge(&before)).abs() < 1e-5);
            let speed = |s: &State| place(s.velocities(), i).distance(place(s.velocities(), j));
            prop_assert!((speed(&state) - speed(&before)).abs() < 1e-5);
            prop_assert!(place(state.positions(), i).distance(carry.transform_point3a(place(before.positions(), i))) < 1e-5);
            prop_assert!(place(state.velocities(), i).distance(carry.transform_vector3a(place(before.velocities(), i))) < 1e-5);
            let step = {
                let c = state.columns();
                state::get(c.x, i).distance(state::get(c.previous, i))
            };
            prop_assert!(step < 1e-5, "previous moves along");
        }
    }
}
