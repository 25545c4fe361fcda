//! Why a mesh does not become a garment: what, where, and the cure.

use thiserror::Error;

use crate::body::BodyError;
use crate::fabric::FabricError;
use crate::file::FileError;
use crate::import::avatar::AvatarError;
use crate::sizes::SizeError;
use toile_bake::check::MeshError;

/// Error of the user's mesh, or of a file beside it.
#[derive(Debug, Error)]
pub enum AdaptError {
    /// A file cannot be read, or is too large.
    #[error(transparent)]
    File(#[from] FileError),
    /// The mesh; the sentence names the cure.
    #[error("{path}: {flaw}")]
    Mesh {
        /// The file's path as the user gave it.
        path: String,
        /// The fault and its cure.
        flaw: String,
    },
    /// The TOML file of its measures.
    #[error("{path}: line {line}: {reason}; docs/meshes.md lists the keys")]
    Measures {
        /// The TOML file.
        path: String,
        /// Line of the text, from 1.
        line: usize,
        /// The fault.
        reason: String,
    },
    /// The clothes file or the base mesh.
    #[error(transparent)]
    Clothes(#[from] AvatarError),
    /// A size or size table that cannot be used.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A body of which none can be made.
    #[error("the body that {path} is made for cannot be built: {source}")]
    Body {
        /// The file's path as the user gave it.
        path: String,
        /// Why the body cannot be built.
        source: BodyError,
    },
    /// A size given for a mesh that has none.
    #[error("{path} is a mesh in one size, so it has no size {size}; leave the size out")]
    NoSizes {
        /// The file's path as the user gave it.
        path: String,
        /// The size asked for.
        size: String,
    },
    /// A mesh that cannot be cloth.
    #[error("garment {path}: {source}")]
    Cloth {
        /// The file's path as the user gave it.
        path: String,
        /// The fault of the mesh.
        source: MeshError,
    },
    /// A fabric that cannot be used.
    #[error(transparent)]
    Fabric(#[from] FabricError),
}
