//! Why a pattern cannot be meshed: the panel or the seam, and the cure.

use thiserror::Error;

use super::limits::{MAX_OUTLINE_POINTS, MAX_PARTICLES, SPACING_M};

/// Why a pattern cannot be meshed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TailorError {
    /// A spacing that is none.
    #[error("a spacing of {} mm is outside of {} to {} mm; give one within", spacing * 1e3, SPACING_M.start() * 1e3, SPACING_M.end() * 1e3)]
    Spacing {
        /// The spacing asked for (m).
        spacing: f64,
    },
    /// More particles than a garment may have.
    #[error(
        "panel {panel} takes the pattern past {MAX_PARTICLES} particles (MAX_PARTICLES) or {MAX_OUTLINE_POINTS} on its outlines (MAX_OUTLINE_POINTS); mesh it at a larger spacing"
    )]
    TooMany {
        /// The panel at which they were too many.
        panel: String,
    },
    /// A part of a panel that is narrower than the mesh can show.
    #[error(
        "panel {panel} has a part too narrow for a spacing of {spacing_mm:.1} mm, near ({x:.3}, {y:.3}) m of its drawing; mesh it at a smaller spacing"
    )]
    Narrow {
        /// Name of the panel.
        panel: String,
        /// The spacing (mm).
        spacing_mm: f64,
        /// Place in the drawing of the panel, to the right (m).
        x: f64,
        /// Place in the drawing of the panel, upwards (m).
        y: f64,
    },
    /// A seam that joins what must stay apart.
    #[error(
        "the seams of panel {panel} fold one of its faces flat or join three faces at an edge, near ({x:.3}, {y:.3}) m of its drawing; mesh it at a smaller spacing or round the corner"
    )]
    Folded {
        /// Name of the panel.
        panel: String,
        /// Place in the drawing of the panel, to the right (m).
        x: f64,
        /// Place in the drawing of the panel, upwards (m).
        y: f64,
    },
}
