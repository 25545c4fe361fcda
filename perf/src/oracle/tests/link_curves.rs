//! Links of several slopes that rub.

use glam::DVec3;
use toile_base::fabric::link_curve::LinkCurve;

use super::super::link_curve;
use super::{GRAVITY, Link, Oracle, OracleStep, Problem, Solids, State, chain};

/// A knee at 1 %, ten times as stiff behind it, for a strain of 1 a force of 10 N.
fn knee() -> LinkCurve {
    LinkCurve { knees: [f64::NEG_INFINITY, 0.01], behind: [1.0, 10.0], ..LinkCurve::plain(10.0) }
}

#[test]
fn chain_with_a_knee_hangs_by_its_curve() {
    let (links, rest, mass) = (20, 0.05, 1e-3);
    for slope in [1.0, 1e4] {
        let link_curve = LinkCurve { slope: knee().slope * slope, ..knee() };
        let mut problem = chain(links, rest, mass * slope, rest / link_curve.slope, DVec3::NEG_Y);
        problem.link_curves = vec![link_curve; links];
        let start = problem.start.clone();
        let solved = Oracle::new(problem).unwrap().equilibrium(&start, &Solids::default()).unwrap();
        let carried = |k: usize| (links - k) as f64 * mass * slope * 9.81;
        let expected: f64 = (0..links).map(|k| rest * (1.0 + link_curve.deformation(carried(k)))).sum();
        let got = -solved.state.x[links].y;
        assert!((got - expected).abs() < 1e-7 * expected, "{slope}: {got} for {expected}");
        assert!((solved.tension_n[0] / carried(0) - 1.0).abs() < 1e-7 && solved.report.stable);
        assert!(link_curve.deformation(carried(0)) > 0.01 && link_curve.deformation(carried(links - 1)) < 0.01);
    }
}

#[test]
fn sticking_strains_follow_the_curve() {
    let mut exact = LinkCurve { half_width: 0.06, ..knee() };
    let mut link_curves = [exact];
    let links = [Link { ends: [0, 1], rest: 0.02, compliance: 2e-3 }];
    for k in 0..60 {
        let strain = 0.03 * (0.37 * f64::from(k)).sin();
        link_curve::follow(&links, &mut link_curves, &[DVec3::ZERO, DVec3::X * 0.02 * (1.0 + strain)]);
        let wanted = exact.force(strain);
        assert!(
            (link_curve::force(&link_curves[0], strain) - wanted).abs() < 1e-9
                && (link_curves[0].stuck - exact.stuck).abs() < 1e-12
        );
    }
}

/// A weight on a link that rubs, let go: it comes to rest within what friction holds of where it would hang without, and farther off
/// than nothing.
#[test]
fn what_rubs_comes_to_rest_where_friction_holds_it() {
    let link_curve = LinkCurve { half_width: 0.02, ..LinkCurve::plain(10.0) };
    let (rest, mass) = (0.1, 0.01);
    let mut problem = Problem { gravity: GRAVITY, ..chain(1, rest, mass, rest / link_curve.slope, DVec3::NEG_Y) };
    problem.link_curves = vec![link_curve];
    let start = State::at_rest(&problem.start);
    let step = OracleStep { kept: 0.97, ..OracleStep::of(1e-3) };
    let path = Oracle::new(problem).unwrap().trajectory(&start, 4_000, |_| step.clone()).unwrap();
    let last = path.last().unwrap();
    let strain = -last.state.x[1].y / rest - 1.0;
    // Air takes as much of what gravity adds as of what was there.
    let weight = mass * 9.81 * step.kept;
    let off = link_curve.slope * strain - weight;
    assert!(last.state.v[1].length() < 1e-6, "{:?}", last.state.v[1]);
    assert!(
        off.abs() <= link_curve.half_width * 1.001 && off.abs() > 0.2 * link_curve.half_width,
        "{off} N of {}",
        link_curve.half_width
    );
    assert!((last.tension_n[0] - weight).abs() < 1e-6);
}
