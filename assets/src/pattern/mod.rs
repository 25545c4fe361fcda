//! Sewn patterns: flat panels with exact outlines, and the seams between their edges.

mod between;
mod check;
mod crossing;
pub mod curve;
mod flaw;
pub mod limits;
mod panel;
mod seam;
mod trim;

pub use between::GradingError;
pub use crossing::crossing;
pub use curve::Curve;
pub use flaw::PatternFlaw;
pub use panel::{Panel, PanelEdge, PanelPlacement};
pub use seam::{Seam, SeamSide};
pub use trim::Trim;

/// A pattern: its panels and how they are sewn. Made by [`Pattern::checked`], which guarantees that every seam names
/// existing edges, every outline is a closed loop that does not cross itself, and no edge is sewn twice.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// The panels, in the order of their file.
    panels: Vec<Panel>,
    /// The seams, in the order of their file.
    seams: Vec<Seam>,
    /// Whether each panel's outside is what its drawing shows from behind `[panels]`.
    behind: Vec<bool>,
}

impl Pattern {
    /// Checks panels and seams, and turns panels so that the outside of each goes on in the outside of its neighbours.
    ///
    /// # Errors
    /// The first [`PatternFlaw`] that is found.
    pub fn checked(panels: Vec<Panel>, seams: Vec<Seam>) -> Result<Self, PatternFlaw> {
        check::panels(&panels)?;
        check::seams(&panels, &seams)?;
        let behind = check::outsides(&panels, &seams)?;
        Ok(Self { panels, seams, behind })
    }

    /// The panels, in the order of their file.
    pub fn panels(&self) -> &[Panel] {
        &self.panels
    }

    /// The seams, in the order of their file.
    pub fn seams(&self) -> &[Seam] {
        &self.seams
    }

    /// Whether the outside of a panel is what its drawing shows from behind: faces then run clockwise in the drawing.
    pub fn shows_inside(&self, panel: usize) -> bool {
        self.behind[panel]
    }
}
