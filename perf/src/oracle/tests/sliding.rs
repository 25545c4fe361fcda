//! Contact and friction: what lies, slides and is carried.

use glam::DVec3;

use super::super::{Ball, Oracle, OracleStep, Plane, Problem, Solids, State};
use super::GRAVITY;

const DT: f64 = 1.0 / 120.0;
const MASS: f64 = 0.01;

/// One particle on a slope of so many degrees that falls towards +x.
fn on_slope(degrees: f64, friction: f64) -> (Problem, Solids, DVec3) {
    let (s, c) = degrees.to_radians().sin_cos();
    let normal = DVec3::new(s, c, 0.0);
    let problem = Problem {
        mass: vec![MASS],
        start: vec![normal * 2e-3],
        gravity: GRAVITY,
        offset_m: 2e-3,
        friction,
        ..Problem::default()
    };
    let down = DVec3::new(c, -s, 0.0);
    (problem, Solids { cones: Vec::new(), planes: vec![Plane { normal, offset_m: 0.0 }] }, down)
}

fn run(problem: Problem, solids: &Solids, v: DVec3, steps: usize) -> Vec<State> {
    let start = State { x: problem.start.clone(), v: vec![v] };
    let step = OracleStep { solids: [solids.clone(), solids.clone()], ..OracleStep::of(DT) };
    let solved = Oracle::new(problem).unwrap().trajectory(&start, steps, |_| step.clone()).unwrap();
    solved.into_iter().map(|s| s.state).collect()
}

#[test]
fn below_the_angle_of_friction_it_sticks() {
    let (problem, solids, down) = on_slope(16.0, 0.3);
    let start = problem.start[0];
    let end = run(problem, &solids, DVec3::ZERO, 60).pop().unwrap();
    let crept = (end.x[0] - start).dot(down);
    assert!((0.0..0.5e-5).contains(&crept), "{crept} m in half a second");
}

/// g (sin - mu cos), and half of it times t (t + dt) for the way.
#[test]
fn beyond_the_angle_of_friction_it_slides_as_coulomb_says() {
    let (problem, solids, down) = on_slope(30.0, 0.3);
    let start = problem.start[0];
    let states = run(problem, &solids, DVec3::ZERO, 60);
    let (s, c) = 30.0f64.to_radians().sin_cos();
    let (a, t) = (9.81 * (s - 0.3 * c), 60.0 * DT);
    let end = &states[59];
    assert!((end.v[0].dot(down) / (a * t) - 1.0).abs() < 1e-3, "{} {}", end.v[0].dot(down), a * t);
    assert!(((end.x[0] - start).dot(down) / (a * t * (t + DT) / 2.0) - 1.0).abs() < 1e-3);
    assert!(states.iter().all(|s| (solids.planes[0].normal.dot(s.x[0]) - 2e-3).abs() < 1e-7));
}

#[test]
fn a_slide_on_the_level_stops_after_its_stopping_distance() {
    let (problem, solids, down) = on_slope(0.0, 0.5);
    let start = problem.start[0];
    let end = run(problem, &solids, down * 0.8, 40).pop().unwrap();
    // Velocities fall by mu g dt a step; the steps end with the velocity that is left.
    let (mut v, mut way) = (0.8f64, 0.0);
    while v > 0.0 {
        v = (v - 0.5 * 9.81 * DT).max(0.0);
        way += v * DT;
    }
    assert!(((end.x[0] - start).dot(down) - way).abs() < 1e-4 * way, "{} {way}", (end.x[0] - start).dot(down));
    assert!(end.v[0].length() < 1e-5);
}

#[test]
fn without_friction_nothing_is_held_and_nothing_goes_through() {
    let (problem, solids, down) = on_slope(30.0, 0.0);
    let end = run(problem, &solids, DVec3::ZERO, 60).pop().unwrap();
    assert!((end.v[0].dot(down) / (9.81 * 0.5 * 60.0 * DT) - 1.0).abs() < 1e-6);
    assert!(solids.planes[0].normal.dot(end.x[0]) > 2e-3 - 1e-7);
}

/// What hits a floor stays there: implicit Euler has no bounce.
#[test]
fn what_falls_comes_to_rest_on_the_floor() {
    let (mut problem, solids, _) = on_slope(0.0, 0.2);
    problem.start[0].y = 0.1;
    let end = run(problem, &solids, DVec3::ZERO, 60).pop().unwrap();
    assert!((end.x[0].y - 2e-3).abs() < 1e-7 && end.v[0].length() < 1e-5, "{:?}", end);
}

/// A capsule that moves away below takes along what friction holds.
#[test]
fn friction_takes_along() {
    let capsule = |x: f64| {
        let ends = [-0.1, 0.1].map(|z| Ball { centre: DVec3::new(0.0, 0.0, z + x), radius: 0.05 });
        Solids { cones: vec![ends], planes: Vec::new() }
    };
    let problem = Problem {
        mass: vec![MASS],
        start: vec![DVec3::Y * 0.05],
        gravity: GRAVITY,
        friction: 0.5,
        ..Problem::default()
    };
    let start = State::at_rest(&problem.start);
    let pace = 0.1 * DT;
    let mut oracle = Oracle::new(problem).unwrap();
    let step = |k: usize| OracleStep {
        solids: [capsule(k as f64 * pace), capsule((k + 1) as f64 * pace)],
        ..OracleStep::of(DT)
    };
    // mu g = 4.9 m/s2 brings it to 0.1 m/s within three steps.
    let solved = oracle.trajectory(&start, 12, step).unwrap();
    let v = solved[11].state.v[0];
    assert!((v - DVec3::Z * 0.1).length() < 1e-4, "{v}");
}

/// In statics a held particle stays where the slope is less than the angle of friction, by a force that is the slope's.
#[test]
fn a_held_equilibrium_stays_within_the_cone_of_friction() {
    let (problem, solids, _) = on_slope(16.0, 0.3);
    let start = problem.start.clone();
    let mut oracle = Oracle::new(problem).unwrap();
    let held = oracle.held_equilibrium(&start, &solids).unwrap();
    assert!((held.state.x[0] - start[0]).length() < 1e-6, "{:?}", held.report);
    let load = MASS * 9.81 * 16.0f64.to_radians().cos();
    assert!((held.touches[0].force_n - load).abs() < 1e-8);
}
