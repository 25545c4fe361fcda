//! Grading: a pattern between two drafts of it, as grade rules have it: every point moves in proportion.

use thiserror::Error;

use super::curve::Curve;
use super::panel::{Panel, PanelEdge, PanelPlacement};
use super::{Pattern, PatternFlaw};

/// Why there is nothing between two drafts; each message says what differs.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GradingError {
    /// Panels of one that the other does not have in the same order.
    #[error("one draft has the panels {0} and the other {1}; give drafts of the same pattern")]
    Panels(String, String),
    /// An outline of other edges.
    #[error("panel {0}: its edges are not the same in both drafts ({1} and {2}); give drafts of the same pattern")]
    Edges(String, usize, usize),
    /// Other seams.
    #[error("the drafts are not sewn the same way; give them the same seam file")]
    Seams,
    /// What lies between is no pattern.
    #[error("between the drafts: {0}")]
    Flaw(#[from] PatternFlaw),
}

impl Pattern {
    /// The pattern that lies between this one and another, at `t` from 0 (this one) to 1 (the other).
    ///
    /// # Errors
    /// Drafts of different patterns, or whose mean crosses itself.
    pub fn between(&self, other: &Self, t: f64) -> Result<Self, GradingError> {
        let named = |p: &Self| p.panels.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
        if self.panels.len() != other.panels.len() || named(self) != named(other) {
            return Err(GradingError::Panels(named(self), named(other)));
        }
        if self.seams.iter().map(|s| s.sides).ne(other.seams.iter().map(|s| s.sides)) {
            return Err(GradingError::Seams);
        }
        let panels = self.panels.iter().zip(&other.panels).map(|(a, b)| panel(a, b, t)).collect::<Result<_, _>>()?;
        Ok(Self::checked(panels, self.seams.clone())?)
    }
}

fn panel(a: &Panel, b: &Panel, t: f64) -> Result<Panel, GradingError> {
    let differ = || GradingError::Edges(a.name.clone(), a.edges.len(), b.edges.len());
    if a.edges.len() != b.edges.len() {
        return Err(differ());
    }
    let edge = |(a, b): (&PanelEdge, &PanelEdge)| {
        Ok(PanelEdge { curve: curve(&a.curve, &b.curve, t).ok_or_else(differ)?, ..a.clone() })
    };
    Ok(Panel {
        edges: a.edges.iter().zip(&b.edges).map(edge).collect::<Result<_, GradingError>>()?,
        grain: a.grain.lerp(b.grain, t).try_normalize().unwrap_or(a.grain),
        placement: a.placement.zip(b.placement).map(|(a, b)| PanelPlacement {
            translation: a.translation.lerp(b.translation, t),
            rotation: a.rotation.slerp(b.rotation, t),
        }),
        trims: a
            .trims
            .iter()
            .enumerate()
            .map(|(i, own)| b.trims.get(i).map_or(*own, |other| own.between(other, t)))
            .collect(),
        ..a.clone()
    })
}

/// The curve between two of a kind; a straight line also goes with a Bezier curve.
fn curve(a: &Curve, b: &Curve, t: f64) -> Option<Curve> {
    match (a, b) {
        (Curve::Line(a), Curve::Line(b)) => Some(Curve::Line([a[0].lerp(b[0], t), a[1].lerp(b[1], t)])),
        (Curve::Line(a), Curve::Cubic(_)) => curve(&straight(*a), b, t),
        (Curve::Cubic(_), Curve::Line(b)) => curve(a, &straight(*b), t),
        (Curve::Cubic(a), Curve::Cubic(b)) => Some(Curve::Cubic(std::array::from_fn(|k| a[k].lerp(b[k], t)))),
        (Curve::Arc { ends: a, sweep: from, .. }, Curve::Arc { ends: b, sweep: to, .. }) => {
            let (ends, sweep) = ([a[0].lerp(b[0], t), a[1].lerp(b[1], t)], from + (to - from) * t);
            let chord = ends[1] - ends[0];
            let centre = 0.5 * (ends[0] + ends[1]) + 0.5 * chord.perp() / (0.5 * sweep).tan();
            (sweep != 0.0 && centre.is_finite()).then_some(Curve::Arc { ends, centre, sweep })
        }
        (Curve::Polyline(a), Curve::Polyline(b)) if a.len() == b.len() => {
            Some(Curve::Polyline(a.iter().zip(b).map(|(a, b)| a.lerp(*b, t)).collect()))
        }
        _ => None,
    }
}

/// A straight line as a Bezier curve.
fn straight([a, b]: [glam::DVec2; 2]) -> Curve {
    Curve::Cubic([a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b])
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::pattern::{Seam, SeamSide};

    /// A half disc of a radius, its straight edge sewn to itself nowhere.
    fn half_disc(radius: f64) -> Pattern {
        let ends = [dvec2(radius, 0.0), dvec2(-radius, 0.0)];
        let edges = [Curve::arc(ends, radius, false, true).unwrap(), Curve::Line([ends[1], ends[0]])];
        let edges = edges.into_iter().enumerate().map(|(number, curve)| PanelEdge { curve, number, label: None });
        let panel = |name: &str| Panel {
            name: name.into(),
            label: None,
            edges: edges.clone().collect(),
            grain: DVec2::Y,
            behind: false,
            placement: None,
            trims: Vec::new(),
        };
        let side = |panel| SeamSide { panel, first: 0, count: 1, reversed: panel == 1 };
        let seam = Seam { name: "rim".into(), sides: [side(0), side(1)] };
        Pattern::checked(vec![panel("front"), panel("back")], vec![seam]).unwrap()
    }

    #[test]
    fn between_two_circles_lies_the_circle_of_the_mean_radius() {
        let mean = half_disc(0.2).between(&half_disc(0.4), 0.25).unwrap();
        let want = half_disc(0.25);
        for (got, want) in mean.panels().iter().zip(want.panels()) {
            assert!((got.signed_area() - want.signed_area()).abs() < 1e-12);
            assert!((got.lengths()[0] - want.lengths()[0]).abs() < 1e-12);
        }
    }

    #[test]
    fn at_its_ends_it_is_the_drafts() {
        let (a, b) = (half_disc(0.2), half_disc(0.4));
        for (t, draft) in [(0.0, &a), (1.0, &b)] {
            let at = a.between(&b, t).unwrap();
            assert!((at.panels()[1].signed_area() - draft.panels()[1].signed_area()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_line_bends_on_its_way_to_a_curve() {
        let line = Curve::Line([DVec2::ZERO, dvec2(0.3, 0.0)]);
        let bent = Curve::quadratic(DVec2::ZERO, dvec2(0.15, 0.2), dvec2(0.3, 0.0));
        let middle = curve(&line, &bent, 0.5).unwrap().point(0.5);
        assert!((middle - dvec2(0.15, 0.05)).length() < 1e-12, "{middle}");
        let arc = Curve::arc([DVec2::ZERO, dvec2(0.3, 0.0)], 0.2, false, true).unwrap();
        assert_eq!(curve(&bent, &arc, 0.5), None);
    }

    #[test]
    fn drafts_of_different_patterns_are_told_apart() {
        let a = half_disc(0.2);
        let mut panels = a.panels().to_vec();
        panels[1].name = "skirt".into();
        let b = Pattern::checked(panels, a.seams().to_vec()).unwrap();
        let told = a.between(&b, 0.5).unwrap_err().to_string();
        assert_eq!(
            told,
            "one draft has the panels front, back and the other front, skirt; give drafts of the same pattern"
        );
    }
}
