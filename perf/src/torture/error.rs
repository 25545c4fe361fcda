//! Why a case cannot be run.

use thiserror::Error;
use toile_bake::check::MeshError;

use crate::oracle::OracleError;

/// Why a case cannot be run.
#[derive(Debug, Error)]
pub enum TortureError {
    /// A piece that cannot be baked.
    #[error("a piece of cloth cannot be baked: {0}")]
    Mesh(#[from] MeshError),
    /// A piece whose equilibrium is not found.
    #[error("a piece of cloth has no equilibrium: {0}")]
    Oracle(#[from] OracleError),
    /// A case that the oracle cannot step.
    #[error("the oracle cannot step `{0}`: it knows no contact of cloth with cloth and no time; leave out --oracle")]
    NotExact(&'static str),
}
