//! The outlines of panels in coordinates around the body: where their points lie, and how wide they are at a height.

use glam::DVec2;

use super::panels::{Around, ArrangedPanel};
use crate::tailor::SewnMesh;

/// The points of a panel's outline (m).
pub fn outline(sewn: &SewnMesh, panel: usize) -> impl Iterator<Item = DVec2> + '_ {
    let mesh = &sewn.panels[panel];
    mesh.points[..mesh.boundary.points.len()].iter().copied()
}

/// Coordinates of a panel's vertex.
pub fn coordinates(sewn: &SewnMesh, all: &[ArrangedPanel], [panel, vertex]: [u32; 2]) -> DVec2 {
    all[panel as usize].at(sewn.panels[panel as usize].points[vertex as usize])
}

/// How wide the trunk's panels are together at a height (m), those alone that `which` admits. What lies over each other at one
/// side of the body, a waistband and the skirt below it, counts once.
pub fn width(sewn: &SewnMesh, all: &[ArrangedPanel], height: f64, which: impl Fn(usize) -> bool) -> f64 {
    let hung = (0..all.len()).filter(|&i| all[i].around == Around::Trunk && which(i));
    let mut spans: Vec<(f64, [f64; 2])> =
        hung.filter_map(|i| Some((all[i].angle, breadth(sewn, all, i, height)?))).collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1[0].total_cmp(&b.1[0])));
    let (mut sum, mut before) = (0.0, (f64::MIN, f64::MIN));
    for (angle, [low, high]) in spans {
        let from = if (angle - before.0).abs() < 1e-3 { low.max(before.1) } else { low };
        sum += (high - from).max(0.0);
        before = (angle, if from > low { before.1.max(high) } else { high });
    }
    sum
}

/// Where a panel begins and ends around the body at a height (m).
pub fn breadth(sewn: &SewnMesh, all: &[ArrangedPanel], panel: usize, height: f64) -> Option<[f64; 2]> {
    let points: Vec<DVec2> = outline(sewn, panel).map(|p| all[panel].at(p)).collect();
    let mut found: Option<[f64; 2]> = None;
    for (i, p) in points.iter().enumerate() {
        let q = points[(i + 1) % points.len()];
        if (p.y > height) != (q.y > height) {
            let x = p.x + (q.x - p.x) * (height - p.y) / (q.y - p.y);
            let [low, high] = found.unwrap_or([x, x]);
            found = Some([low.min(x), high.max(x)]);
        }
    }
    found
}
