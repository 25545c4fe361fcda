//! Links of several slopes that rub, as an energy: what [`LinkLaw`] says of a link whose friction sticks at one strain for a whole solution.
//!
//! The force of such a link grows with its strain, piece by piece on straight lines, so that its energy is convex and a step of
//! implicit Euler has one answer. With the yield `give` of a multiplier in series ([`Springs`](super::energy::links::Springs)) the strain e of the
//! link itself solves e + give T(e) = y, on one of five lines. Where it sticks moves after a step, as far as friction lets it.

use glam::DVec3;
use toile_base::fabric::friction_element::STICKING;
use toile_base::fabric::link_law::LinkLaw;

use super::problem::Link;

/// How a link answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawAnswer {
    /// Strain of the link itself (1).
    pub strain: f64,
    /// Force (N).
    pub force: f64,
    /// Growth of the force with the strain of the link and its yield together (N).
    pub slope: f64,
}

/// Strain over which friction sticks on either side (1); 0 where nothing rubs.
fn reach(law: &LinkLaw) -> f64 {
    law.half_width / (STICKING * law.slope)
}

/// Force at a strain while it sticks where it does (N).
pub fn force(law: &LinkLaw, strain: f64) -> f64 {
    let rubs = (STICKING * law.slope * (strain - law.stuck)).clamp(-law.half_width, law.half_width);
    law.elastic(strain) + rubs
}

/// Growth of the force with the strain (N), between knees.
fn slope(law: &LinkLaw, strain: f64) -> f64 {
    let ([lower, upper], [below, above]) = (law.knees, law.behind);
    let part = if strain > upper { above } else { 1.0 } * if strain < lower { below } else { 1.0 };
    let sticks = law.half_width > 0.0 && (strain - law.stuck).abs() < reach(law);
    law.slope * (part + if sticks { STICKING } else { 0.0 })
}

/// The steepest that a law can be (N).
pub fn steepest(law: &LinkLaw) -> f64 {
    let sticks = if law.half_width > 0.0 { STICKING } else { 0.0 };
    law.slope * (law.behind[0].max(law.behind[1]).max(1.0) + sticks)
}

/// The strain e with e + `give` T(e) = `whole` (1; 1/N), its force, and how that grows with the whole.
pub fn answer(law: &LinkLaw, whole: f64, give: f64) -> LawAnswer {
    let mut corners = [law.knees[0], law.knees[1], law.stuck - reach(law), law.stuck + reach(law)];
    corners.iter_mut().for_each(|c| *c = c.clamp(-FAR, FAR));
    corners.sort_unstable_by(f64::total_cmp);
    let sum = |e: f64| e + give * force(law, e);
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
    let grows = slope(law, middle);
    let strain = from + (whole - sum(from)) / (1.0 + give * grows);
    LawAnswer { strain, force: force(law, from) + grows * (strain - from), slope: grows / (1.0 + give * grows) }
}

/// Beyond this no knee is met (1).
const FAR: f64 = 1e6;

/// Energy of a link of length 1 from no strain up to one (J/m); friction counts as elastic within a solution.
pub fn energy(law: &LinkLaw, strain: f64) -> f64 {
    let ([lower, upper], [below, above]) = (law.knees, law.behind);
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
        let d = (e - law.stuck).abs();
        let stiff = STICKING * law.slope;
        if d < reach(law) { 0.5 * stiff * d * d } else { law.half_width * (d - 0.5 * reach(law)) }
    };
    law.slope * elastic + rubs(strain) - rubs(0.0)
}

fn strain_of(link: &Link, x: &[DVec3]) -> f64 {
    x[link.ends[0] as usize].distance(x[link.ends[1] as usize]) / link.rest - 1.0
}

/// The laws as they act from a state on: what has given way there does not rub, and sticks where it is when it is drawn again.
pub fn from_state(links: &[Link], laws: &[LinkLaw], x: &[DVec3]) -> Vec<LinkLaw> {
    let one = |(link, law): (&Link, &LinkLaw)| {
        let strain = strain_of(link, x);
        let gave = strain < law.knees[0] && law.behind[0] < 1.0;
        if gave { LinkLaw { half_width: 0.0, stuck: strain, ..*law } } else { *law }
    };
    links.iter().zip(laws).map(one).collect()
}

/// Moves where links stick as far as friction lets them at a state.
pub fn follow(links: &[Link], laws: &mut [LinkLaw], x: &[DVec3]) {
    for (link, law) in links.iter().zip(laws) {
        // The law says it itself.
        law.force(strain_of(link, x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law() -> LinkLaw {
        LinkLaw { knees: [-0.004, 0.02], behind: [0.01, 12.0], half_width: 1.2, stuck: 0.003, ..LinkLaw::plain(300.0) }
    }

    #[test]
    fn an_answer_lies_on_the_law_and_adds_up_with_its_yield() {
        for stuck in [-0.03, 0.003, 0.019, 0.05] {
            let law = LinkLaw { stuck, ..law() };
            for give in [0.0, 1e-5, 3e-3] {
                for k in -60..60 {
                    let whole = 1e-3 * f64::from(k);
                    let LawAnswer { strain, force: got, slope } = answer(&law, whole, give);
                    assert!((got - force(&law, strain)).abs() < 1e-9 * law.slope, "{stuck} {give} {whole}: {got}");
                    assert!((strain + give * got - whole).abs() < 1e-12, "{stuck} {give} {whole}: {strain}");
                    let beside = answer(&law, whole + 1e-8, give);
                    let grows = (beside.force - got) / 1e-8;
                    assert!((grows / slope - 1.0).abs() < 1e-3 || (beside.slope / slope - 1.0).abs() > 1e-3);
                }
            }
        }
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let law = law();
        for k in -50..50 {
            let (e, d) = (1e-3 * f64::from(k) + 3e-4, 1e-7);
            let slope = (energy(&law, e + d) - energy(&law, e - d)) / (2.0 * d);
            assert!((slope - force(&law, e)).abs() < 1e-5 * law.slope, "{e}: {slope} for {}", force(&law, e));
        }
        assert_eq!(energy(&law, 0.0), 0.0);
    }
}
