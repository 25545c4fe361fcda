//! Errors of a pattern in any format: the fault, its place, and the cure.

use thiserror::Error;

use super::limits::{LEAST_EDGE_M, LEAST_PANEL_M2, MAX_REACH_M};

/// The first flaw that was found in a pattern.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PatternFlaw {
    /// Nothing to sew.
    #[error("the pattern has no panels; export it with its panels as closed outlines")]
    Empty,
    /// More of something than is read.
    #[error(
        "{place} has {count} {what}, more than the {most} of {limit}; leave out what is not cloth, or split the pattern"
    )]
    TooMany {
        /// Their owner: "the pattern", or a panel.
        place: String,
        /// The kind of thing that is too many.
        what: &'static str,
        /// Their number.
        count: usize,
        /// The limit.
        most: usize,
        /// Name of the limit.
        limit: &'static str,
    },
    /// Two panels of one name.
    #[error("two panels are named {name}; give each panel a name of its own")]
    SameName {
        /// The name that two panels have.
        name: String,
    },
    /// A coordinate that is NaN, infinite or far away.
    #[error(
        "panel {panel}: {edge} reaches beyond {MAX_REACH_M} m; check the unit of the file and the numbers of this edge"
    )]
    TooFar {
        /// Name of the panel.
        panel: String,
        /// The edge, as its file counts or labels it.
        edge: String,
    },
    /// An outline of fewer than two edges, or of two straight ones.
    #[error("panel {panel} has {count} edges and encloses nothing; draw its whole outline")]
    FewEdges {
        /// Name of the panel.
        panel: String,
        /// How many edges it has.
        count: usize,
    },
    /// An edge without length.
    #[error("panel {panel}: {edge} is shorter than {} mm; merge its ends", LEAST_EDGE_M * 1e3)]
    ShortEdge {
        /// Name of the panel.
        panel: String,
        /// The edge, as its file counts or labels it.
        edge: String,
    },
    /// An outline with a gap.
    #[error("panel {panel}: {edge} ends {gap_mm:.1} mm from where {next} starts; close the outline")]
    Open {
        /// Name of the panel.
        panel: String,
        /// The edge before the gap.
        edge: String,
        /// The edge after it.
        next: String,
        /// Width of the gap (mm).
        gap_mm: f64,
    },
    /// A circle arc that cannot reach from its start to its end.
    #[error(
        "panel {panel}: edge {edge} is an arc of {radius} m, too small a radius for its ends; give at least half of the distance between them"
    )]
    Radius {
        /// Name of the panel.
        panel: String,
        /// Number of the edge.
        edge: usize,
        /// Radius of the file (m).
        radius: f64,
    },
    /// An outline that crosses or touches itself.
    #[error("panel {panel}: {first} crosses or touches {second}; draw an outline that goes once around the piece")]
    Crossing {
        /// Name of the panel.
        panel: String,
        /// The first of the two edges, as its file counts or labels it.
        first: String,
        /// The other, or the same.
        second: String,
    },
    /// A panel of next to no area.
    #[error("panel {panel} has an area of {area_cm2:.2} cm2, less than {} cm2; delete it or check the unit of the file", LEAST_PANEL_M2 * 1e4)]
    NoArea {
        /// Name of the panel.
        panel: String,
        /// Its area (cm2).
        area_cm2: f64,
    },
    /// A grain that points nowhere.
    #[error("panel {panel}: its grain has no direction; draw the grain line with two different ends")]
    NoGrain {
        /// Name of the panel.
        panel: String,
    },
    /// A seam of a panel that is not there.
    #[error("{seam} names panel {name}, which is not there; {cure}")]
    NoPanel {
        /// Name of the seam.
        seam: String,
        /// The name that it gives.
        name: String,
        /// The name that may have been meant.
        cure: String,
    },
    /// A seam of an edge that is not there.
    #[error("{seam} names edge {edge} of panel {panel}, which has {count}; name one of 0 to {}", count.saturating_sub(1))]
    NoEdge {
        /// Name of the seam.
        seam: String,
        /// Name of the panel.
        panel: String,
        /// The edge that it names.
        edge: usize,
        /// How many edges there are.
        count: usize,
    },
    /// An edge in two seams, or on both sides of one.
    #[error(
        "{first} and {second} both sew {edge} of panel {panel}; sew each edge once, and split it where two others meet at it"
    )]
    SewnTwice {
        /// Name of the panel.
        panel: String,
        /// The edge, as its file counts or labels it.
        edge: String,
        /// Name of the seam that was read first.
        first: String,
        /// The other, or the same.
        second: String,
    },
    /// A seam that turns the cloth inside out.
    #[error(
        "{seam} sews the outside of panel {panel} to an inside, against the other seams; swap the ends of one of its sides"
    )]
    Twisted {
        /// Name of the seam.
        seam: String,
        /// The panel on its second side.
        panel: String,
    },
}
