//! Links of several slopes that rub, as an energy: [`LinkCurve`] of a link whose friction sticks at one strain for a whole solution.
//!
//! The force of such a link grows with its strain, piece by piece on straight lines, so that its energy is convex and a step of
//! implicit Euler has one answer. With the yield `give` of a multiplier in series ([`Springs`](super::energy::links::Springs)) the strain e of the
//! link itself solves e + give T(e) = y, on one of five lines. Where it sticks moves after a step, as far as friction lets it.

use glam::DVec3;
use toile_base::fabric::friction_element::STICKING;
use toile_base::fabric::link_curve::LinkCurve;

use super::problem::Link;

/// How a link answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveAnswer {
    /// Strain of the link itself (1).
    pub strain: f64,
    /// Force (N).
    pub force: f64,
    /// Growth of the force with the strain of the link and its yield together (N).
    pub slope: f64,
}

/// Strain over which friction sticks on either side (1); 0 where nothing rubs.
fn reach(link_curve: &LinkCurve) -> f64 {
    link_curve.half_width / (STICKING * link_curve.slope)
}

/// Force at a strain while it sticks where it does (N).
pub fn force(link_curve: &LinkCurve, strain: f64) -> f64 {
    let rubs = (STICKING * link_curve.slope * (strain - link_curve.stuck))
        .clamp(-link_curve.half_width, link_curve.half_width);
    link_curve.elastic(strain) + rubs
}

/// Growth of the force with the strain (N), between knees.
fn slope(link_curve: &LinkCurve, strain: f64) -> f64 {
    let ([lower, upper], [below, above]) = (link_curve.knees, link_curve.behind);
    let part = if strain > upper { above } else { 1.0 } * if strain < lower { below } else { 1.0 };
    let sticks = link_curve.half_width > 0.0 && (strain - link_curve.stuck).abs() < reach(link_curve);
    link_curve.slope * (part + if sticks { STICKING } else { 0.0 })
}

/// The steepest slope of a curve (N).
pub fn steepest(link_curve: &LinkCurve) -> f64 {
    let sticks = if link_curve.half_width > 0.0 { STICKING } else { 0.0 };
    link_curve.slope * (link_curve.behind[0].max(link_curve.behind[1]).max(1.0) + sticks)
}

/// The strain e with e + `give` T(e) = `whole` (1; 1/N), its force, and how that grows with the whole.
pub fn answer(link_curve: &LinkCurve, whole: f64, give: f64) -> CurveAnswer {
    let mut corners = [
        link_curve.knees[0],
        link_curve.knees[1],
        link_curve.stuck - reach(link_curve),
        link_curve.stuck + reach(link_curve),
    ];
    corners.iter_mut().for_each(|c| *c = c.clamp(-FAR, FAR));
    corners.sort_unstable_by(f64::total_cmp);
    let sum = |e: f64| e + give * force(link_curve, e);
    let after = corners.iter().position(|c| sum(*c) > whole).unwrap_or(corners.len());
    let [before, next] = [after.checked_sub(1), Some(after)].map(|k| k.and_then(|k| corners.get(k)).copied());
    let middle = match (before, next) {
        (Some(before), Some(next)) => 0.5 * (before + next),
        (Some(before), None) => before + 1.0,
        (None, next) => next.unwrap_or(0.0) - 1.0,
    };
    // From the nearer to no strain of both ends of its line: from a far one rounding would be a force.
    let nearer = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
    let from = [before, next].into_iter().flatten().min_by(nearer).unwrap_or(0.0);
    let grows = slope(link_curve, middle);
    let strain = from + (whole - sum(from)) / (1.0 + give * grows);
    CurveAnswer {
        strain,
        force: force(link_curve, from) + grows * (strain - from),
        slope: grows / (1.0 + give * grows),
    }
}

/// Beyond this no knee is met (1).
const FAR: f64 = 1e6;

/// Energy of a link of length 1 from no strain up to one (J/m); friction counts as elastic within a solution.
pub fn energy(link_curve: &LinkCurve, strain: f64) -> f64 {
    let ([lower, upper], [below, above]) = (link_curve.knees, link_curve.behind);
    let behind = |knee: f64, slope: f64| {
        let d = strain - knee;
        0.5 * knee * knee + knee * d + 0.5 * slope * d * d
    };
    let elastic = if strain > upper {
        behind(upper, above)
    } else if strain < lower {
        behind(lower, below)
    } else {
        0.5 * strain * strain
    };
    let rubs = |e: f64| {
        let d = (e - link_curve.stuck).abs();
        let stiff = STICKING * link_curve.slope;
        if d < reach(link_curve) { 0.5 * stiff * d * d } else { link_curve.half_width * (d - 0.5 * reach(link_curve)) }
    };
    link_curve.slope * elastic + rubs(strain) - rubs(0.0)
}

fn strain_of(link: &Link, x: &[DVec3]) -> f64 {
    x[link.ends[0] as usize].distance(x[link.ends[1] as usize]) / link.rest - 1.0
}

/// The curves as they act from a state on: a link that has given way there does not rub, and sticks at its strain when it is drawn
/// again.
pub fn from_state(links: &[Link], link_curves: &[LinkCurve], x: &[DVec3]) -> Vec<LinkCurve> {
    let one = |(link, link_curve): (&Link, &LinkCurve)| {
        let strain = strain_of(link, x);
        let gave = strain < link_curve.knees[0] && link_curve.behind[0] < 1.0;
        if gave { LinkCurve { half_width: 0.0, stuck: strain, ..*link_curve } } else { *link_curve }
    };
    links.iter().zip(link_curves).map(one).collect()
}

/// Moves where links stick as far as friction lets them at a state.
pub fn follow(links: &[Link], link_curves: &mut [LinkCurve], x: &[DVec3]) {
    for (link, link_curve) in links.iter().zip(link_curves) {
        // The curve moves it.
        link_curve.force(strain_of(link, x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link_curve() -> LinkCurve {
        LinkCurve {
            knees: [-0.004, 0.02],
            behind: [0.01, 12.0],
            half_width: 1.2,
            stuck: 0.003,
            ..LinkCurve::plain(300.0)
        }
    }

    #[test]
    fn an_answer_lies_on_the_curve() {
        for stuck in [-0.03, 0.003, 0.019, 0.05] {
            let link_curve = LinkCurve { stuck, ..link_curve() };
            for give in [0.0, 1e-5, 3e-3] {
                for k in -60..60 {
                    let whole = 1e-3 * f64::from(k);
                    let CurveAnswer { strain, force: got, slope } = answer(&link_curve, whole, give);
                    assert!(
                        (got - force(&link_curve, strain)).abs() < 1e-9 * link_curve.slope,
                        "{stuck} {give} {whole}: {got}"
                    );
                    assert!((strain + give * got - whole).abs() < 1e-12, "{stuck} {give} {whole}: {strain}");
                    let beside = answer(&link_curve, whole + 1e-8, give);
                    let grows = (beside.force - got) / 1e-8;
                    assert!((grows / slope - 1.0).abs() < 1e-3 || (beside.slope / slope - 1.0).abs() > 1e-3);
                }
            }
        }
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let link_curve = link_curve();
        for k in -50..50 {
            let (e, d) = (1e-3 * f64::from(k) + 3e-4, 1e-7);
            let slope = (energy(&link_curve, e + d) - energy(&link_curve, e - d)) / (2.0 * d);
            assert!(
                (slope - force(&link_curve, e)).abs() < 1e-5 * link_curve.slope,
                "{e}: {slope} for {}",
                force(&link_curve, e)
            );
        }
        assert_eq!(energy(&link_curve, 0.0), 0.0);
    }
}
