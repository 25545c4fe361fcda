//! Pieces as a format without sewing draws them, and how they become panels: unfolded, divided where seams begin and end.

use glam::{DMat2, DVec2};

use super::error::PatternFault;
use crate::pattern::curve::{ArcLength, Curve};
use crate::pattern::limits::{LEAST_EDGE_M, MAX_PANEL_EDGES};
use crate::pattern::{PanelEdge, PatternFlaw};

/// A drawn piece: its outline, each edge with its number in the source.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its name in the source.
    pub name: String,
    /// The edges that have a length, with the numbers that the source gives them from 0.
    pub edges: Vec<(usize, Curve)>,
    /// Direction of its grain (unit), where the source draws it.
    pub grain: Option<DVec2>,
    /// Number of the edge on which it is folded, where the source says so.
    pub fold: Option<usize>,
}

impl Piece {
    /// A piece of a source that numbers every step of its outline, among which some have no length.
    pub fn of_steps(name: &str, steps: &[Curve], grain: Option<DVec2>) -> Result<Self, PatternFault> {
        let most = MAX_PANEL_EDGES;
        if steps.len() > most {
            let (place, what, limit) = (format!("piece {name}"), "edges", "MAX_PANEL_EDGES");
            return Err(PatternFlaw::TooMany { place, what, count: steps.len(), most, limit }.into());
        }
        let long = |c: &Curve| !c.is_finite() || ArcLength::of(c).whole() >= LEAST_EDGE_M;
        let edges = steps.iter().cloned().enumerate().filter(|(_, c)| long(c)).collect();
        Ok(Self { name: name.to_owned(), edges, grain, fold: None })
    }

    /// Longer side of the box around the ends of its edges (m).
    pub fn extent(&self) -> f64 {
        let ends = || self.edges.iter().map(|(_, curve)| curve.start());
        let low = ends().fold(DVec2::INFINITY, DVec2::min);
        let high = ends().fold(DVec2::NEG_INFINITY, DVec2::max);
        (high - low).max_element().max(0.0)
    }
}

/// Which half of an unfolded piece is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Half {
    /// The half that is drawn.
    #[default]
    Drawn,
    /// Its mirror image beyond the fold.
    Mirrored,
}

/// One edge of a piece after unfolding: where it lies along the source's own edges.
#[derive(Debug, Clone, PartialEq)]
struct UnfoldedEdge {
    curve: Curve,
    /// Number of the source's edge, and how much of it lies before this one and before its end.
    number: usize,
    span: [f64; 2],
    half: Half,
}

/// A run of edges by the source's numbers: from a position to another, where 4.5 is the middle of edge 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeRange {
    /// Start of the sewing.
    pub from: f64,
    /// Where it ends; lower than `from` where it goes against the drawing.
    pub to: f64,
    /// Half of an unfolded piece.
    pub half: Half,
}

/// A piece unfolded, ready to be divided.
#[derive(Debug, Clone, PartialEq)]
pub struct UnfoldedPiece {
    edges: Vec<UnfoldedEdge>,
}

/// Positions along an edge that differ by less than this share of it are one.
const SAME_POSITION: f64 = 1e-6;

impl UnfoldedPiece {
    /// Unfolds a piece along one of its edges, or takes it as it is; `mirrored` is its mirror image as a whole.
    pub fn new(piece: &Piece, fold: Option<usize>, mirrored: bool) -> Result<Self, String> {
        let whole = |(number, curve): &(usize, Curve)| UnfoldedEdge {
            curve: curve.clone(),
            number: *number,
            span: [0.0, 1.0],
            half: Half::Drawn,
        };
        let mut edges: Vec<UnfoldedEdge> = piece.edges.iter().map(whole).collect();
        if let Some(fold) = fold {
            let Some(at) = edges.iter().position(|e| e.number == fold) else {
                return Err(format!("its fold is edge {fold}, which is not there; name one of its edges"));
            };
            if !edges[at].curve.is_straight() {
                return Err(format!("its fold, edge {fold}, is not straight; name a straight edge"));
            }
            edges.rotate_left(at);
            let line = edges.remove(0).curve;
            let image = edges.iter().rev().map(|e| UnfoldedEdge {
                curve: reflected(&e.curve, line.start(), line.end()).reversed(),
                half: Half::Mirrored,
                ..e.clone()
            });
            let image: Vec<UnfoldedEdge> = image.collect();
            edges.extend(image);
        }
        if mirrored {
            for edge in &mut edges {
                edge.curve = reflected(&edge.curve, DVec2::ZERO, DVec2::Y);
            }
        }
        Ok(Self { edges })
    }

    /// Divides edges where a run begins or ends within one.
    pub fn divide(&mut self, range: &EdgeRange) {
        for position in [range.from, range.to] {
            let number = position.floor();
            let cut = |e: &UnfoldedEdge| {
                let (at, [a, b]) = (position - number, e.span);
                let inside = e.number as f64 == number && at > a + SAME_POSITION && at < b - SAME_POSITION;
                (inside && e.half == range.half).then_some((at, (at - a) / (b - a)))
            };
            if let Some((i, (at, share))) = self.edges.iter().enumerate().find_map(|(i, e)| Some((i, cut(e)?))) {
                let edge = self.edges[i].clone();
                // The mirror image runs the other way.
                let backward = edge.half == Half::Mirrored;
                let t = ArcLength::of(&edge.curve).parameter(if backward { 1.0 - share } else { share });
                let curves = edge.curve.split(t);
                let mut spans = [[edge.span[0], at], [at, edge.span[1]]];
                if backward {
                    spans.reverse();
                }
                let parts = [0, 1].map(|k| UnfoldedEdge { curve: curves[k].clone(), span: spans[k], ..edge.clone() });
                self.edges.splice(i..=i, parts);
            }
        }
    }

    /// The edges of a run after all divisions: the first, their number, and whether sewing goes against the outline.
    pub fn find(&self, range: &EdgeRange) -> Result<(usize, usize, bool), String> {
        let (low, high) = (range.from.min(range.to), range.from.max(range.to));
        let inside = |e: &UnfoldedEdge| {
            let at = |k: usize| e.number as f64 + e.span[k];
            e.half == range.half && at(0) >= low - SAME_POSITION && at(1) <= high + SAME_POSITION
        };
        let n = self.edges.len();
        let within = |i: usize| inside(&self.edges[i % n]);
        let count = (0..n).filter(|&i| within(i)).count();
        let Some(first) = (0..n).find(|&i| within(i) && (count == n || !within(i + n - 1))) else {
            return Err(format!(
                "edges {} to {} are none that it has; its edges are {}",
                range.from,
                range.to,
                self.numbers()
            ));
        };
        if (first..first + count).any(|i| !within(i)) {
            return Err(format!(
                "edges {} to {} do not follow each other; split the seam at the fold",
                range.from, range.to
            ));
        }
        let backward = range.half == Half::Mirrored;
        Ok((first, count, (range.from > range.to) != backward))
    }

    /// The numbers of its edges in words.
    fn numbers(&self) -> String {
        let numbers = self.edges.iter().map(|e| e.number);
        format!("{} to {}", numbers.clone().min().unwrap_or(0), numbers.max().unwrap_or(0))
    }

    /// The edges as a panel has them.
    pub fn into_edges(self) -> Vec<PanelEdge> {
        let edge = |e: UnfoldedEdge| {
            let label = (e.half == Half::Mirrored).then(|| "mirrored".to_owned());
            PanelEdge { curve: e.curve, number: e.number, label }
        };
        self.edges.into_iter().map(edge).collect()
    }
}

/// The mirror image of a curve on the line through two points.
fn reflected(curve: &Curve, a: DVec2, b: DVec2) -> Curve {
    let u = (b - a).normalize_or_zero();
    let turn = DMat2::from_cols(2.0 * u.x * u - DVec2::X, 2.0 * u.y * u - DVec2::Y);
    curve.moved(turn, a - turn * a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a rectangle: fold at x = 0, the bottom, the side, the top.
    fn half() -> Piece {
        let p = [[0.0, 1.0], [0.0, 0.0], [0.5, 0.0], [0.5, 1.0]].map(DVec2::from);
        let line = |i: usize| Curve::Line([p[i], p[(i + 1) % 4]]);
        Piece::of_steps("half", &[line(0), line(1), line(2), line(3)], None).unwrap()
    }

    #[test]
    fn a_fold_doubles_the_piece() {
        let whole = UnfoldedPiece::new(&half(), Some(0), false).unwrap();
        assert_eq!(whole.edges.len(), 6);
        let area: f64 = whole.edges.iter().map(|e| e.curve.twice_area() * 0.5).sum();
        assert!((area - 1.0).abs() < 1e-12);
        let ends = whole.edges.iter().zip(whole.edges.iter().cycle().skip(1));
        assert!(ends.into_iter().all(|(a, b)| a.curve.end().distance(b.curve.start()) < 1e-12));
        assert!(UnfoldedPiece::new(&half(), Some(7), false).unwrap_err().contains("not there"));
    }

    #[test]
    fn runs_are_divided_and_found_on_both_halves() {
        let mut whole = UnfoldedPiece::new(&half(), Some(0), false).unwrap();
        let run = |from, to, half| EdgeRange { from, to, half };
        let ranges = [run(2.25, 3.0, Half::Drawn), run(2.25, 3.0, Half::Mirrored), run(2.25, 2.0, Half::Mirrored)];
        ranges.iter().for_each(|r| whole.divide(r));
        assert_eq!(whole.edges.len(), 8);
        let (first, count, reversed) = whole.find(&ranges[0]).unwrap();
        let upper = &whole.edges[first].curve;
        assert!((count, reversed) == (1, false) && (upper.start() - DVec2::new(0.5, 0.25)).length() < 1e-9);
        let (first, _, reversed) = whole.find(&ranges[1]).unwrap();
        let upper = &whole.edges[first].curve;
        assert!(reversed && (upper.end() - DVec2::new(-0.5, 0.25)).length() < 1e-9);
        assert_eq!(whole.find(&ranges[2]).unwrap().1, 1);
        assert!(!whole.find(&ranges[2]).unwrap().2);
        assert!(whole.find(&run(7.0, 9.0, Half::Drawn)).unwrap_err().contains("its edges are 1 to 3"));
        // From the side over the fold to the other side there is no run of drawn edges.
        assert_eq!(whole.find(&run(1.0, 4.0, Half::Drawn)).unwrap().1, 4);
    }

    #[test]
    fn a_mirrored_copy_keeps_its_numbers() {
        let copy = UnfoldedPiece::new(&half(), None, true).unwrap();
        assert_eq!(copy.edges[2].curve.start(), DVec2::new(-0.5, 0.0));
        assert_eq!(copy.find(&EdgeRange { from: 3.0, to: 2.0, half: Half::Drawn }), Ok((2, 1, true)));
    }
}
