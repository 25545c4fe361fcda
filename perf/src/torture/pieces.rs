//! The pieces of cloth that cases share.

use toile_engine::cloth::{Quality, Settings};
use toile_gpu::backend::Backends;

use super::error::TortureError;
use super::piece::{self, CURTAIN, PATCH, Piece};

/// Columns and rows of the tube that is twice too small, and its radius as cut (m).
pub const TUBE: [usize; 2] = [20, 18];
pub const TUBE_RADIUS_M: f32 = 0.07;

/// The pieces that cases share.
#[derive(Debug)]
pub struct Pieces {
    /// What steps them: the processor, or a graphics device.
    pub backends: Backends,
    /// How they are stepped.
    pub settings: Settings,
    /// Whether the oracle steps them instead.
    pub exact: bool,
    /// A sheet of denim.
    pub curtain: Piece,
    /// The same of thin cotton.
    pub lawn: Piece,
    /// A small sheet of denim.
    pub patch: Piece,
    /// A tube of denim.
    pub tube: Piece,
}

impl Pieces {
    /// Bakes them and lets them come to rest.
    ///
    /// # Errors
    /// Where a piece cannot be baked or has no equilibrium.
    pub fn new(quality: Quality, backends: Backends, exact: bool) -> Result<Self, TortureError> {
        let settings = Settings { quality, workers: 1, ..Settings::default() };
        let fabric = piece::denim();
        Ok(Self {
            curtain: Piece::new(&piece::sheet(CURTAIN), &fabric, &settings)?,
            lawn: Piece::new(&piece::sheet(CURTAIN), &piece::lawn(), &settings)?,
            patch: Piece::new(&piece::sheet(PATCH), &fabric, &settings)?,
            tube: Piece::new(&piece::tube(TUBE, TUBE_RADIUS_M, 2.0 * TUBE_RADIUS_M), &fabric, &settings)?,
            settings,
            exact,
            backends,
        })
    }
}
