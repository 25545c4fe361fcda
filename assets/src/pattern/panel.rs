//! A panel: a closed outline of edges, the grain of its cloth, and where its source places it.

use glam::{DQuat, DVec2, DVec3};

use super::curve::{ArcLength, Curve};
use super::trim::Trim;

/// One edge of a panel's outline.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelEdge {
    /// Its course, from the end of the edge before it (m).
    pub curve: Curve,
    /// Its number in the source, from 0; an edge that was divided keeps the number in all of its parts.
    pub number: usize,
    /// Its name in the source.
    pub label: Option<String>,
}

/// Where a panel is placed around the body before it is sewn: a point (x, y) of the drawing goes to
/// `rotation (x, y, 0) + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelPlacement {
    /// Shift (m), y up and z towards the front.
    pub translation: DVec3,
    /// Rotation, applied first.
    pub rotation: DQuat,
}

/// A piece of cloth before it is sewn.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Its name, unlike those of all other panels.
    pub name: String,
    /// The part of the body that it is for, in the source's words.
    pub label: Option<String>,
    /// The outline: each edge starts where the one before it ends, and the first where the last ends.
    pub edges: Vec<PanelEdge>,
    /// Direction of the warp in the drawing (unit).
    pub grain: DVec2,
    /// True where the source says that the outside is what the drawing shows from behind.
    pub behind: bool,
    /// Where the source places it, if it does.
    pub placement: Option<PanelPlacement>,
    /// Its trims.
    pub trims: Vec<Trim>,
}

impl Panel {
    /// The area that the outline encloses (m2), positive where it runs counter-clockwise.
    pub fn signed_area(&self) -> f64 {
        0.5 * self.edges.iter().map(|e| e.curve.twice_area()).sum::<f64>()
    }

    /// Length of each edge (m) `[edges]`.
    pub fn lengths(&self) -> Vec<f64> {
        self.edges.iter().map(|e| ArcLength::of(&e.curve).whole()).collect()
    }

    /// An edge as messages name it: by its number in the source.
    pub fn edge_name(&self, edge: usize) -> String {
        let number = self.edges[edge].number;
        match &self.edges[edge].label {
            Some(label) => format!("edge {number} ({label})"),
            None => format!("edge {number}"),
        }
    }
}
