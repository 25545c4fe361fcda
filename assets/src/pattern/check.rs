//! The checks that every pattern passes, whichever format it came in.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::crossing::crossing;
use super::curve::Curve;
use super::flaw::PatternFlaw;
use super::limits::{LEAST_EDGE_M, LEAST_PANEL_M2, MAX_EDGES, MAX_PANEL_EDGES, MAX_PANELS, MAX_REACH_M, MAX_SEAMS};
use super::panel::Panel;
use super::seam::{Seam, SeamSide};

/// Largest gap between two edges that is no gap (m): coordinates are printed to a thousandth of a millimetre.
const GAP_M: f64 = 1e-6;

fn at_most(place: &str, what: &'static str, count: usize, most: usize, limit: &'static str) -> Result<(), PatternFlaw> {
    if count <= most {
        return Ok(());
    }
    Err(PatternFlaw::TooMany { place: place.into(), what, count, most, limit })
}

/// Counts first, so that nothing huge is looked at twice; then each panel by itself.
pub(super) fn panels(panels: &[Panel]) -> Result<(), PatternFlaw> {
    if panels.is_empty() {
        return Err(PatternFlaw::Empty);
    }
    at_most("the pattern", "panels", panels.len(), MAX_PANELS, "MAX_PANELS")?;
    at_most("the pattern", "edges", panels.iter().map(|p| p.edges.len()).sum(), MAX_EDGES, "MAX_EDGES")?;
    let mut names = BTreeSet::new();
    for one in panels {
        if !names.insert(&one.name) {
            return Err(PatternFlaw::SameName { name: one.name.clone() });
        }
        panel(one)?;
    }
    Ok(())
}

fn panel(panel: &Panel) -> Result<(), PatternFlaw> {
    let name = || panel.name.clone();
    let edges = &panel.edges;
    at_most(&format!("panel {}", panel.name), "edges", edges.len(), MAX_PANEL_EDGES, "MAX_PANEL_EDGES")?;
    if edges.len() < 2 || (edges.len() == 2 && edges.iter().all(|e| e.curve.is_straight())) {
        return Err(PatternFlaw::FewEdges { panel: name(), count: edges.len() });
    }
    if let Some(i) = edges.iter().position(|e| !within_reach(&e.curve)) {
        return Err(PatternFlaw::TooFar { panel: name(), edge: panel.edge_name(i) });
    }
    if let Some(i) = panel.lengths().iter().position(|l| *l < LEAST_EDGE_M) {
        return Err(PatternFlaw::ShortEdge { panel: name(), edge: panel.edge_name(i) });
    }
    for (i, edge) in edges.iter().enumerate() {
        let next = (i + 1) % edges.len();
        let gap = edge.curve.end().distance(edges[next].curve.start());
        if gap > GAP_M {
            let (edge, next) = (panel.edge_name(i), panel.edge_name(next));
            return Err(PatternFlaw::Open { panel: name(), edge, next, gap_mm: gap * 1e3 });
        }
    }
    outline(panel)?;
    let area = panel.signed_area().abs();
    if area < LEAST_PANEL_M2 {
        return Err(PatternFlaw::NoArea { panel: name(), area_cm2: area * 1e4 });
    }
    if !(panel.grain.length() - 1.0).abs().le(&1e-6) {
        return Err(PatternFlaw::NoGrain { panel: name() });
    }
    Ok(())
}

fn within_reach(curve: &Curve) -> bool {
    let near = |p: &DVec2| p.abs().max_element() <= MAX_REACH_M;
    let points = |p: &[DVec2]| p.iter().all(near);
    curve.is_finite()
        && match curve {
            Curve::Line(p) => points(p),
            Curve::Cubic(p) => points(p),
            Curve::Polyline(p) => points(p),
            Curve::Arc { ends, .. } => points(ends) && (0..=8).all(|i| near(&curve.point(f64::from(i) / 8.0))),
        }
}

/// The outline must not cross itself, its curves taken as chords.
fn outline(panel: &Panel) -> Result<(), PatternFlaw> {
    let mut points = Vec::new();
    let mut owner = Vec::new();
    for (i, edge) in panel.edges.iter().enumerate() {
        let chords = edge.curve.chord_count();
        points.extend((0..chords).map(|k| edge.curve.point(k as f64 / chords as f64)));
        owner.resize(points.len(), i);
    }
    match crossing(&points) {
        None => Ok(()),
        Some((a, b)) => Err(PatternFlaw::Crossing {
            panel: panel.name.clone(),
            first: panel.edge_name(owner[a]),
            second: panel.edge_name(owner[b]),
        }),
    }
}

/// Every side names edges that are there, and no edge is sewn twice.
pub(super) fn seams(panels: &[Panel], seams: &[Seam]) -> Result<(), PatternFlaw> {
    at_most("the pattern", "seams", seams.len(), MAX_SEAMS, "MAX_SEAMS")?;
    let mut sewn: BTreeMap<(usize, usize), &Seam> = BTreeMap::new();
    for seam in seams {
        for side in &seam.sides {
            for edge in edges_of(panels, seam, side)? {
                if let Some(other) = sewn.insert((side.panel, edge), seam) {
                    let panel = &panels[side.panel];
                    return Err(PatternFlaw::SewnTwice {
                        panel: panel.name.clone(),
                        edge: panel.edge_name(edge),
                        first: other.name.clone(),
                        second: seam.name.clone(),
                    });
                }
            }
        }
    }
    Ok(())
}

fn edges_of(panels: &[Panel], seam: &Seam, side: &SeamSide) -> Result<Vec<usize>, PatternFlaw> {
    let Some(panel) = panels.get(side.panel) else {
        let cure = format!("the pattern has {} panels", panels.len());
        return Err(PatternFlaw::NoPanel { seam: seam.name.clone(), name: side.panel.to_string(), cure });
    };
    let count = panel.edges.len();
    if side.first >= count || side.count == 0 || side.count > count {
        let edge = side.first.max(side.count);
        return Err(PatternFlaw::NoEdge { seam: seam.name.clone(), panel: panel.name.clone(), edge, count });
    }
    Ok(side.run(count).collect())
}

/// Which panels show their inside, so that outside goes on in outside at every seam. The first panel of a garment's
/// connected part is as its source says; the others follow, and a seam that contradicts is refused.
pub(super) fn outsides(panels: &[Panel], seams: &[Seam]) -> Result<Vec<bool>, PatternFlaw> {
    let clockwise: Vec<bool> = panels.iter().map(|p| p.signed_area() < 0.0).collect();
    let mut behind: Vec<Option<bool>> = vec![None; panels.len()];
    for start in 0..panels.len() {
        if behind[start].is_some() {
            continue;
        }
        behind[start] = Some(panels[start].behind);
        let mut open = vec![start];
        while let Some(at) = open.pop() {
            for seam in seams.iter().filter(|s| s.sides.iter().any(|side| side.panel == at)) {
                let [a, b] = seam.sides;
                let other = if a.panel == at { b.panel } else { a.panel };
                // Outlines that run the same way round, seen from outside, pass a seam in opposite directions.
                let around = |panel: usize, behind: bool| clockwise[panel] == behind;
                let same = a.reversed == b.reversed;
                let wanted = behind[at].map(|b| clockwise[other] == (around(at, b) != same));
                match behind[other] {
                    None => {
                        behind[other] = wanted;
                        open.push(other);
                    }
                    found if found != wanted => {
                        let panel = panels[other].name.clone();
                        return Err(PatternFlaw::Twisted { seam: seam.name.clone(), panel });
                    }
                    Some(_) => {}
                }
            }
        }
    }
    Ok(behind.into_iter().map(|b| b.unwrap_or(false)).collect())
}
