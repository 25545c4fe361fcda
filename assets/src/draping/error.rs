//! Why a pattern cannot be laid around a body: the panel or the seam, and the cure.

use thiserror::Error;

use super::limits::MAX_OPEN_MM;
use crate::tailor::TailorError;
use toile_bake::check::MeshError;

/// Why a pattern cannot be draped.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DrapeError {
    /// The pattern cannot be meshed.
    #[error(transparent)]
    Tailor(#[from] TailorError),
    /// A panel of which neither the pattern nor its seams say where it belongs.
    #[error(
        "nothing says where panel {panel} goes around the body; give it a side (front, back, left or right) in the seam \
         file, or a translation and a rotation in the pattern"
    )]
    NoPlace {
        /// Name of the panel.
        panel: String,
    },
    /// A pattern without seams: its panels would fall off.
    #[error("the pattern has no seams, so that nothing would hold its panels together; give a seam file")]
    NoSeams,
    /// A seam that does not close.
    #[error(
        "{seam} stays {open_mm:.0} mm open on this body (at most {MAX_OPEN_MM:.0}); give a larger body or pattern a \
         smaller difference, or see that the seam joins the right edges"
    )]
    Open {
        /// Name of the seam.
        seam: String,
        /// Widest gap (mm).
        open_mm: f64,
    },
    /// Cloth that ended far from where it belongs.
    #[error(
        "panel {panel} ended on the wrong side of the body, {off_mm:.0} mm off; see that its side or placement and its \
         seams belong together"
    )]
    WrongSide {
        /// Name of the panel.
        panel: String,
        /// How far inside of the body or beyond its middle the panel lies (mm).
        off_mm: f64,
    },
    /// Cloth stretched past what cloth can take.
    #[error(
        "panel {panel} is stretched by {percent:.0} % around this body; the pattern is too small for it: choose a smaller \
         body or a larger pattern"
    )]
    Tight {
        /// Name of the panel.
        panel: String,
        /// Mean stretch of its threads (%).
        percent: f64,
    },
    /// The draped mesh cannot be baked.
    #[error("the draped mesh cannot be cloth: {0}")]
    Mesh(MeshError),
}
