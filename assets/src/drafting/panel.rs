//! Panels as they are drawn: outlines of labelled edges, counter-clockwise as seen from outside.

use glam::DVec2;

use crate::pattern::curve::ArcLength;
use crate::pattern::{Curve, Trim};
use toile_base::garment::trim::TrimKind;

/// Where a panel is laid: the side of the body that it is seen from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DraftSide {
    /// Before the body.
    Front,
    /// Behind it.
    Back,
    /// Over the left arm.
    LeftArm,
    /// Over the right arm.
    RightArm,
}

/// An edge and what seams call it.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftEdge {
    /// Unlike that of the panel's other edges.
    pub label: String,
    /// Its course (m).
    pub curve: Curve,
}

/// A panel of a draft.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftPanel {
    /// Unlike that of the garment's other panels.
    pub name: &'static str,
    /// The place where it is laid.
    pub side: DraftSide,
    /// The outline.
    pub edges: Vec<DraftEdge>,
    /// Its trims.
    pub trims: Vec<Trim>,
}

/// An outline on its way.
#[derive(Debug, Clone)]
pub struct Outline {
    at: DVec2,
    edges: Vec<DraftEdge>,
}

impl Outline {
    /// Begins at a point (m).
    pub fn from(at: DVec2) -> Self {
        Self { at, edges: Vec::new() }
    }

    /// A straight edge.
    #[must_use]
    pub fn line(self, label: &str, to: DVec2) -> Self {
        let curve = Curve::Line([self.at, to]);
        self.edge(label, curve)
    }

    /// An edge with one control point.
    #[must_use]
    pub fn bow(self, label: &str, control: DVec2, to: DVec2) -> Self {
        let curve = Curve::quadratic(self.at, control, to);
        self.edge(label, curve)
    }

    /// An edge with two control points.
    #[must_use]
    pub fn curve(self, label: &str, controls: [DVec2; 2], to: DVec2) -> Self {
        let curve = Curve::Cubic([self.at, controls[0], controls[1], to]);
        self.edge(label, curve)
    }

    /// Where it has come to (m).
    pub fn end(&self) -> DVec2 {
        self.at
    }

    fn edge(mut self, label: &str, curve: Curve) -> Self {
        self.at = curve.end();
        self.edges.push(DraftEdge { label: label.to_owned(), curve });
        self
    }

    /// The panel of an outline that has come back to its beginning.
    pub fn panel(self, name: &'static str, side: DraftSide) -> DraftPanel {
        DraftPanel { name, side, edges: self.edges, trims: Vec::new() }
    }

    /// The panel cut on the fold: an outline that goes from the lower end of the line x = 0 to its upper end, and its mirror
    /// image. Labels of the one begin with `right` where those of the other begin with `left`.
    pub fn on_the_fold(self, name: &'static str, side: DraftSide) -> DraftPanel {
        let beyond = mirrored(&self.edges);
        DraftPanel { name, side, edges: self.edges.into_iter().chain(beyond).collect(), trims: Vec::new() }
    }
}

impl DraftPanel {
    /// The same for the other side of the body; labels that begin with `left` begin with `right`.
    pub fn mirrored(&self, name: &'static str, side: DraftSide) -> Self {
        Self { name, side, edges: mirrored(&self.edges), trims: self.trims.iter().map(across).collect() }
    }

    /// Length of an edge (m), 0 where there is none of this label.
    pub fn length(&self, label: &str) -> f64 {
        self.edges.iter().find(|e| e.label == label).map_or(0.0, |e| ArcLength::of(&e.curve).whole())
    }
}

/// A trim seen in a mirror.
pub fn across(trim: &Trim) -> Trim {
    let [a, b] = trim.ends.map(|p| DVec2::new(-p.x, p.y));
    // What lies to the left of an edge lies to its right in a mirror.
    Trim { ends: if trim.kind == TrimKind::Edge { [b, a] } else { [a, b] }, ..*trim }
}

/// Edges seen in a mirror, in the order in which their outline runs counter-clockwise again.
fn mirrored(edges: &[DraftEdge]) -> Vec<DraftEdge> {
    let flip = |p: DVec2| DVec2::new(-p.x, p.y);
    let one = |e: &DraftEdge| {
        let curve = match e.curve.reversed() {
            Curve::Line(p) => Curve::Line(p.map(flip)),
            Curve::Cubic(p) => Curve::Cubic(p.map(flip)),
            other => other,
        };
        DraftEdge { label: opposite(&e.label), curve }
    };
    edges.iter().rev().map(one).collect()
}

fn opposite(label: &str) -> String {
    match (label.strip_prefix("left"), label.strip_prefix("right")) {
        (Some(rest), _) => format!("right{rest}"),
        (_, Some(rest)) => format!("left{rest}"),
        _ => label.to_owned(),
    }
}

/// A point (m).
pub fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_on_the_fold_is_closed_and_symmetrical() {
        let half =
            Outline::from(at(0.0, -1.0)).line("left hem", at(1.0, -1.0)).bow("left side", at(1.5, 0.0), at(0.0, 1.0));
        let panel = half.on_the_fold("front", DraftSide::Front);
        let labels: Vec<&str> = panel.edges.iter().map(|e| e.label.as_str()).collect();
        assert_eq!(labels, ["left hem", "left side", "right side", "right hem"]);
        for (i, edge) in panel.edges.iter().enumerate() {
            assert!(edge.curve.end().distance(panel.edges[(i + 1) % 4].curve.start()) < 1e-12);
        }
        assert!((panel.length("left side") - panel.length("right side")).abs() < 1e-12);
        assert_eq!(panel.length("neck"), 0.0);
    }
}
