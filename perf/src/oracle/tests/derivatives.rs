//! Gradients against differences of values, Hessians against differences of gradients.

use glam::DVec3;
use toile_base::fabric::link_curve::LinkCurve;

use super::super::energy::TotalEnergy;
use super::super::energy::contact::Contact;
use super::super::energy::friction::Friction;
use super::super::energy::links::Springs;
use super::super::energy::load::Load;
use super::super::solids::SolidSurface;
use super::super::system::System;
use super::{Ball, Link, Plane, Problem, Random, Solids, State, furniture, square};

/// Step of the central differences (m); their error is of the order of its square.
const H: f64 = 1e-6;

/// Positions in which links are stretched, compressed and askew and some particles are inside of the furniture.
fn crumpled(problem: &Problem, random: &mut Random) -> Vec<DVec3> {
    let moved = |p: &DVec3| *p * 0.97 + DVec3::Y * -0.09 + random.vector() * 4e-3;
    problem.start.iter().map(moved).collect()
}

/// All energies at once, with multipliers that are not 0.
fn landscape<'a>(problem: &'a Problem, start: &'a [DVec3], random: &mut Random, load: Load) -> TotalEnergy<'a> {
    let multiplier = problem.links.iter().map(|_| 0.05 * random.unit()).collect();
    let surfaces = furniture().shapes();
    let pressure = (0..problem.particles() * surfaces.len()).map(|_| 1e-3 * random.unit().max(0.0)).collect();
    let contact = Contact::new(problem, surfaces.clone(), 50.0, pressure);
    let mut friction = Friction::new(0.4, 2e-3, start, [surfaces.clone(), surfaces]);
    friction.update(start, &contact.touches(start));
    TotalEnergy {
        problem,
        load,
        springs: Springs::new(&problem.links, problem.link_curves.clone(), 200.0, multiplier),
        contact,
        friction: Some(friction),
    }
}

/// The square with links that have knees and rub.
fn curved() -> Problem {
    let mut problem = square(6);
    let link_curve = |l: &Link| {
        let slope = if l.compliance > 0.0 { l.rest / l.compliance } else { 4e3 };
        LinkCurve { knees: [-0.02, 0.015], behind: [0.05, 6.0], half_width: 0.01 * slope, ..LinkCurve::plain(slope) }
    };
    problem.link_curves = problem.links.iter().map(link_curve).collect();
    problem
}

fn inertia(problem: &Problem) -> Load {
    Load::Inertia { target: problem.start.clone(), per_dt2: 120.0f64.powi(2) }
}

fn weight(problem: &Problem) -> Load {
    Load::Weight { gravity: problem.gravity, from: problem.start.clone() }
}

fn shifted(x: &[DVec3], by: &[DVec3], h: f64) -> Vec<DVec3> {
    x.iter().zip(by).map(|(x, d)| *x + *d * h).collect()
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// A direction in which only free particles move.
fn direction(problem: &Problem, random: &mut Random) -> Vec<DVec3> {
    problem.mass.iter().map(|m| if *m > 0.0 { random.vector() } else { DVec3::ZERO }).collect()
}

#[test]
fn gradients_are_the_differences_of_values() {
    for (problem, load) in [inertia, weight].into_iter().flat_map(|load| [(square(6), load), (curved(), load)]) {
        let mut random = Random::new(1);
        let start = crumpled(&problem, &mut random);
        let x = crumpled(&problem, &mut random);
        let sum = landscape(&problem, &start, &mut random, load(&problem));
        assert!(sum.contact.touches(&x).len() > 3 && sum.friction.as_ref().is_some_and(|f| f.value(&x) > 0.0));
        for _ in 0..8 {
            let d = direction(&problem, &mut random);
            let expected = (sum.value(&shifted(&x, &d, H)) - sum.value(&shifted(&x, &d, -H))) / (2.0 * H);
            let got = dot(&sum.gradient(&x), &d);
            assert!((got - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{got} {expected}");
        }
    }
}

#[test]
fn the_exact_hessian_is_the_difference_of_gradients() {
    let problem = square(6);
    let mut system = System::new(&problem);
    for load in [inertia, weight] {
        let mut random = Random::new(2);
        let start = crumpled(&problem, &mut random);
        let x = crumpled(&problem, &mut random);
        let sum = landscape(&problem, &start, &mut random, load(&problem));
        sum.hessian(&x, true, 0.0, &mut system);
        for _ in 0..8 {
            let d = direction(&problem, &mut random);
            let got = system.times(&d);
            let (to, from) = (sum.gradient(&shifted(&x, &d, H)), sum.gradient(&shifted(&x, &d, -H)));
            let size = got.iter().map(|g| g.length()).fold(0.0, f64::max);
            for ((got, to), from) in got.iter().zip(to).zip(from) {
                let expected = (to - from) / (2.0 * H);
                assert!((*got - expected).length() < 1e-5 * size, "{got} {expected}");
            }
        }
    }
}

/// What is left out of the exact Hessian takes nothing that is positive away: the projected one is at least as large in
/// every direction, and it is positive definite where the exact one is not.
#[test]
fn the_projected_hessian_is_positive_and_above_the_exact_one() {
    let problem = square(6);
    let mut random = Random::new(3);
    let start = crumpled(&problem, &mut random);
    let x: Vec<DVec3> = problem.start.iter().map(|p| *p * 0.8 + random.vector() * 1e-3).collect();
    let sum = landscape(&problem, &start, &mut random, weight(&problem));
    let [mut exact, mut projected] = [0, 1].map(|_| System::new(&problem));
    sum.hessian(&x, true, 0.0, &mut exact);
    sum.hessian(&x, false, 1e-3, &mut projected);
    assert!(!exact.factor() && projected.factor());
    for _ in 0..50 {
        let d = direction(&problem, &mut random);
        let [low, high] = [&exact, &projected].map(|s| dot(&d, &s.times(&d)));
        assert!(high >= low && high > 0.0, "{high} {low}");
    }
}

#[test]
fn the_factors_solve_the_system() {
    let problem = square(7);
    let mut random = Random::new(4);
    let start = crumpled(&problem, &mut random);
    let sum = landscape(&problem, &start, &mut random, inertia(&problem));
    let mut system = System::new(&problem);
    sum.hessian(&start, false, 0.0, &mut system);
    assert!(system.factor());
    let side = direction(&problem, &mut random);
    let solution = system.solve(&side).unwrap();
    let left = system.times(&solution).iter().zip(&side).map(|(a, b)| (*a + *b).length()).fold(0.0, f64::max);
    assert!(left < 1e-9, "{left}");
    assert!(problem.mass.iter().zip(&solution).all(|(m, d)| *m > 0.0 || *d == DVec3::ZERO));
}

/// The least distance to the balls along the axis, by golden sections of that convex function.
fn slow_distance([a, b]: [Ball; 2], p: DVec3) -> f64 {
    let at = |s: f64| p.distance(a.centre.lerp(b.centre, s)) - (a.radius + (b.radius - a.radius) * s);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let (l, h) = (low + 0.381_966 * (high - low), high - 0.381_966 * (high - low));
        if at(l) < at(h) { high = h } else { low = l }
    }
    at(low)
}

#[test]
fn distances_are_those_to_the_hull_with_their_derivatives() {
    let mut random = Random::new(5);
    for _ in 0..300 {
        let mut ball = || Ball { centre: random.vector() * 0.3, radius: 0.05 + 0.04 * random.unit() };
        let cone = [ball(), ball()];
        let surface = Solids { cones: vec![cone], planes: Vec::new() }.shapes()[0];
        let p = random.vector() * 0.5;
        assert!((surface.distance(p) - slow_distance(cone, p)).abs() < 1e-9);
        let sight = surface.sight(p);
        for axis in DVec3::AXES {
            let slope = (surface.distance(p + axis * H) - surface.distance(p - axis * H)) / (2.0 * H);
            assert!((slope - sight.normal.dot(axis)).abs() < 1e-6, "{slope} {}", sight.normal);
            let bend = (surface.sight(p + axis * H).normal - surface.sight(p - axis * H).normal) / (2.0 * H);
            let got = sight.curvature * axis;
            assert!((bend - got).length() < 1e-4 * (1.0 + got.length()), "{bend} {got}");
        }
    }
}

#[test]
fn a_ball_within_the_other_is_the_larger_alone() {
    let (large, small) = (Ball { centre: DVec3::ZERO, radius: 0.2 }, Ball { centre: DVec3::X * 0.05, radius: 0.1 });
    for cone in [[large, small], [small, large]] {
        let surface = Solids { cones: vec![cone], planes: Vec::new() }.shapes()[0];
        assert!((surface.distance(DVec3::X) - 0.8).abs() < 1e-12);
    }
}

/// A solid that moves without turning carries every point of its surface by that; one that turns about its axis's middle
/// carries what lies on the side by the lever.
#[test]
fn surfaces_carry_what_lies_on_them() {
    let cone = |shift: DVec3, turn: f64| {
        let (s, c) = turn.sin_cos();
        let end = DVec3::new(c, s, 0.0) * 0.2;
        let ends = [shift - end, shift + end].map(|centre| Ball { centre, radius: 0.05 });
        Solids { cones: vec![ends], planes: vec![Plane { normal: DVec3::Y, offset_m: 0.0 }] }.shapes()
    };
    let p = DVec3::new(0.1, 0.051, 0.0);
    let carried = |before: &[SolidSurface], now: &[SolidSurface]| now[0].carried(&before[0], &now[0].sight(p));
    let moved = carried(&cone(DVec3::ZERO, 0.0), &cone(DVec3::new(1e-3, 2e-3, 3e-3), 0.0));
    assert!((moved - DVec3::new(1e-3, 2e-3, 3e-3)).length() < 1e-12);
    let turned = carried(&cone(DVec3::ZERO, -1e-4), &cone(DVec3::ZERO, 0.0));
    assert!((turned - DVec3::new(-0.05, 0.1, 0.0) * 1e-4).length() < 1e-8, "{turned}");
    let planes = [cone(DVec3::ZERO, 0.0), cone(DVec3::ONE, 0.0)];
    assert_eq!(planes[1][1].carried(&planes[0][1], &planes[1][1].sight(p)), DVec3::ZERO);
    assert!(State::at_rest(&[p]).v[0] == DVec3::ZERO);
}
