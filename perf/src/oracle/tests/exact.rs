//! Solutions against closed forms, and rules that every solution keeps.

use glam::DVec3;

use super::super::{Bend, Link, Oracle, OracleError, OracleStep, Problem, Solids, State, measure};
use super::{GRAVITY, chain, furniture, square};

const DT: f64 = 1.0 / 120.0;

#[test]
fn free_fall_is_exact() {
    let problem =
        Problem { mass: vec![0.001, 2.0], start: vec![DVec3::ZERO, DVec3::X], gravity: GRAVITY, ..Problem::default() };
    let start = State { x: problem.start.clone(), v: vec![DVec3::Z; 2] };
    let solved = Oracle::new(problem).unwrap().trajectory(&start, 60, |_| OracleStep::of(DT)).unwrap();
    for (k, s) in solved.iter().enumerate() {
        let n = (k + 1) as f64;
        let fallen = DVec3::new(0.0, -9.81 * DT * DT * n * (n + 1.0) / 2.0, n * DT);
        assert!((s.state.x[0] - fallen).length() < 1e-12 && (s.state.x[1] - DVec3::X - fallen).length() < 1e-12);
    }
}

#[test]
fn damping_keeps_its_share_of_the_velocity_in_each_step() {
    let problem = Problem { mass: vec![0.1], start: vec![DVec3::ZERO], ..Problem::default() };
    let start = State { x: vec![DVec3::ZERO], v: vec![DVec3::X] };
    let step = OracleStep { kept: 0.9, ..OracleStep::of(DT) };
    let solved = Oracle::new(problem).unwrap().trajectory(&start, 3, |_| step.clone()).unwrap();
    assert!((solved[2].state.v[0].x - 0.729).abs() < 1e-12);
}

/// A mass on a vertical spring, one step of implicit Euler: m (x - y) / dt^2 = -k (x - rest), downwards.
#[test]
fn a_spring_takes_the_closed_form_step() {
    let (m, k, rest) = (0.02, 35.0, 0.3);
    let problem = chain(1, rest, m, 1.0 / k, -DVec3::Y);
    let mut start = State::at_rest(&problem.start);
    start.v[1].y = -0.4;
    let solved = Oracle::new(problem).unwrap().step(&start, &OracleStep::of(DT)).unwrap();
    let foreseen = rest + DT * (0.4 + 9.81 * DT);
    let length = (m / (DT * DT) * foreseen + k * rest) / (m / (DT * DT) + k);
    assert!((solved.state.x[1].y + length).abs() < 1e-13);
    assert!((solved.state.v[1].y + (length - rest) / DT).abs() < 1e-10);
    assert!((solved.tension_n[0] - k * (length - rest)).abs() < 1e-10);
}

/// Each link of a hanging chain carries what hangs below it, whatever its compliance.
#[test]
fn a_hanging_chain_carries_what_hangs_below() {
    for compliance in [0.0, 1e-6, 1e-4, 1e-2] {
        let problem = chain(12, 0.05, 0.003, compliance, DVec3::X);
        let start = problem.start.clone();
        let solved = Oracle::new(problem).unwrap().equilibrium(&start, &Solids::default()).unwrap();
        assert!(solved.report.stable && solved.report.residual_n < 1e-10);
        let mut depth = 0.0;
        for (e, tension) in solved.tension_n.iter().enumerate() {
            let below = (12 - e) as f64 * 0.003 * 9.81;
            assert!((tension - below).abs() < 1e-9, "{compliance} {e} {tension} {below}");
            depth += 0.05 + compliance * below;
            assert!((solved.state.x[e + 1] + DVec3::Y * depth).length() < 1e-8, "{compliance} {e}");
        }
    }
}

/// A clamped strip that bends by its own weight: for small deflections the tip sinks by q l^4 / (8 B), here with the
/// discrete beam's own sum in place of the integral.
#[test]
fn a_light_cantilever_sinks_as_its_discrete_beam() {
    let (n, h, q, b) = (20, 0.01, 1e-6, 1e-3);
    let mut problem = chain(n, h, q * h, 0.0, DVec3::X);
    problem.mass[1] = 0.0;
    let c = (b / h.powi(3)).sqrt();
    let bend = |i: u32| Bend { particles: vec![i, i - 1, i + 1], coefficients: vec![-2.0 * c, c, c] };
    problem.bends = (1..n as u32).map(bend).collect();
    let start = problem.start.clone();
    let solved = Oracle::new(problem).unwrap().equilibrium(&start, &Solids::default()).unwrap();
    // Curvature at particle i is the moment of what lies beyond over B; deflections add it up twice.
    let (mut slope, mut sunk) = (0.0, 0.0);
    for i in 1..n {
        let moment: f64 = (i + 1..=n).map(|j| q * h * 9.81 * (j - i) as f64 * h).sum();
        slope += moment / b * h;
        sunk += slope * h;
    }
    let got = -solved.state.x[n].y;
    assert!((got / sunk - 1.0).abs() < 1e-3, "{got} {sunk}");
}

/// Three hundred links in a row in short steps: by rounds that change each multiplier by its own lag alone, 200 are not
/// enough.
#[test]
fn long_chains_take_few_rounds() {
    let problem = chain(300, 0.01, 1e-4, 0.0, DVec3::X);
    let start = State::at_rest(&problem.start);
    let solved = Oracle::new(problem).unwrap().trajectory(&start, 4, |_| OracleStep::of(1e-3)).unwrap();
    let rounds = solved.iter().map(|s| s.report.rounds).max();
    assert!(rounds < Some(10), "{rounds:?}");
    assert!(solved.iter().all(|s| s.report.violation.strain < 1e-8 && s.report.residual_n < 1e-9));
}

/// A chain that stands on end is at a saddle: it comes to hang.
#[test]
fn a_saddle_is_left() {
    let problem = chain(6, 0.05, 0.003, 0.0, DVec3::Y);
    let start = problem.start.clone();
    let solved = Oracle::new(problem).unwrap().equilibrium(&start, &Solids::default()).unwrap();
    assert!(solved.report.stable && (solved.state.x[6].y + 0.3).abs() < 1e-8, "{:?}", solved.report);
}

#[test]
fn cloth_at_rest_stays_and_has_no_residual() {
    let problem = square(9);
    let start = problem.start.clone();
    let mut oracle = Oracle::new(problem).unwrap();
    let hung = oracle.equilibrium(&start, &furniture()).unwrap();
    assert!(hung.report.stable && hung.report.residual_n < 1e-10 && !hung.touches.is_empty(), "{:?}", hung.report);
    assert!(hung.report.violation.strain < 1e-7 && hung.report.violation.penetration_m < 1e-7);
    let worst = oracle.problem().links.iter().zip(measure::strains(oracle.problem(), &hung.state.x));
    let worst = worst.filter(|(l, _)| l.compliance == 0.0).map(|(_, s)| s.abs()).fold(0.0, f64::max);
    assert!(worst < 1e-7, "{worst}");
    let step = OracleStep { solids: [furniture(), furniture()], ..OracleStep::of(DT) };
    let later = oracle.trajectory(&hung.state, 3, |_| step.clone()).unwrap();
    let moved = measure::apart(&later[2].state.x, &hung.state.x);
    assert!(moved.max_m < 1e-8, "{moved:?}");
}

/// The same cloth with its particles, links and stencils in another order.
fn renumbered(problem: &Problem) -> (Problem, Vec<usize>) {
    let n = problem.particles();
    let new: Vec<usize> = (0..n).map(|i| (i * 7 + 3) % n).collect();
    let mut out = problem.clone();
    for (i, &to) in new.iter().enumerate() {
        (out.mass[to], out.start[to]) = (problem.mass[i], problem.start[i]);
    }
    let name = |i: u32| new[i as usize] as u32;
    out.links = problem.links.iter().rev().map(|l| Link { ends: [name(l.ends[1]), name(l.ends[0])], ..*l }).collect();
    let renamed = |b: &Bend| Bend { particles: b.particles.iter().map(|i| name(*i)).collect(), ..b.clone() };
    out.bends = problem.bends.iter().rev().map(renamed).collect();
    (out, new)
}

#[test]
fn results_do_not_depend_on_the_numbering() {
    let problem = square(9);
    let (other, new) = renumbered(&problem);
    let step = OracleStep { solids: [furniture(), furniture()], ..OracleStep::of(1.0 / 30.0) };
    let run = |problem: Problem| {
        let start = State::at_rest(&problem.start);
        Oracle::new(problem).unwrap().trajectory(&start, 8, |_| step.clone()).unwrap().pop().unwrap()
    };
    let (one, two) = (run(problem), run(other));
    assert!(!one.touches.is_empty());
    let apart = (0..new.len()).map(|i| one.state.x[i].distance(two.state.x[new[i]])).fold(0.0, f64::max);
    assert!(apart < 1e-7, "{apart}");
}

#[test]
fn pins_go_where_they_are_told() {
    let problem = square(5);
    let start = State::at_rest(&problem.start);
    let pins = vec![DVec3::new(0.0, 0.01, 0.0), DVec3::new(0.078, 0.012, 0.0)];
    let step = OracleStep { pins: pins.clone(), ..OracleStep::of(DT) };
    let solved = Oracle::new(problem).unwrap().step(&start, &step).unwrap();
    assert_eq!([solved.state.x[0], solved.state.x[4]], [pins[0], pins[1]]);
}

/// Without gravity, solids and pins nothing from outside acts.
#[test]
fn momentum_is_kept() {
    let mut problem = square(6);
    problem.mass.iter_mut().for_each(|m| *m = m.max(4e-5));
    problem.gravity = DVec3::ZERO;
    let mut start = State::at_rest(&problem.start);
    start.v.iter_mut().enumerate().for_each(|(i, v)| *v = DVec3::new((i % 5) as f64, (i % 3) as f64, -1.0) * 0.2);
    let sum = |state: &State| problem.mass.iter().zip(&state.v).map(|(m, v)| *v * *m).sum::<DVec3>();
    let before = sum(&start);
    let solved = Oracle::new(problem.clone()).unwrap().trajectory(&start, 10, |_| OracleStep::of(DT)).unwrap();
    assert!((sum(&solved[9].state) - before).length() < 1e-9 * before.length().max(1.0));
}

#[test]
fn what_cannot_be_solved_is_said() {
    let problem = square(6);
    let start = problem.start.clone();
    let mut oracle = Oracle::new(problem.clone()).unwrap();
    oracle.options.most_iterations = 2;
    let error = oracle.equilibrium(&start, &furniture()).unwrap_err();
    assert!(matches!(&error, OracleError::NotConverged(best) if best.state.x.len() == 36), "{error}");
    assert!(error.to_string().contains("2 Newton iterations"), "{error}");
    let mut state = State::at_rest(&start);
    state.x[7].y = f64::NAN;
    let error = oracle.step(&state, &OracleStep::of(DT)).unwrap_err();
    assert_eq!(error, OracleError::Unusable { what: "particle", at: 7 });
    let error = oracle.step(&State::at_rest(&start[1..]), &OracleStep::of(DT)).unwrap_err();
    assert!(matches!(error, OracleError::Length { got: 35, expected: 36, .. }), "{error}");
    assert!(oracle.step(&State::at_rest(&start), &OracleStep::of(0.0)).is_err());
    let broken = Problem { links: vec![Link { ends: [0, 0], rest: 1.0, compliance: 0.0 }], ..problem };
    assert!(matches!(Oracle::new(broken), Err(OracleError::Unusable { what: "link", at: 0 })));
}
