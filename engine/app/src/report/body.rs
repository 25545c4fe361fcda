//! The JSON of `toile body`.

use std::path::PathBuf;

use serde::Serialize;

use super::Followed;

/// The body of `toile body`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BodyReport {
    /// The file or folder.
    pub file: PathBuf,
    /// Dialect of its joints' names.
    pub dialect: &'static str,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Whether it has texture coordinates.
    pub texture_coordinates: bool,
    /// Measures as the tape reads them (mm): name and value.
    pub measures_mm: Vec<Named>,
    /// Heights of the measuring levels above the floor (mm).
    pub levels_mm: Vec<Named>,
    /// The joints that were found.
    pub joints: Vec<JointFound>,
    /// What pruning to four influences cost.
    pub influences: Influences,
    /// Whether the surface is closed.
    pub surface: SurfaceReport,
    /// MakeHuman's own girths along rows of its mesh (mm).
    pub makehuman_mm: Option<Vec<Named>>,
    /// How closely the collision body follows the skin, zone by zone.
    pub colliders: Vec<Followed>,
    /// What was found and how it was taken, one sentence each.
    pub notes: Vec<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// A number with its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Named {
    /// What the value is of.
    pub name: &'static str,
    /// The value, in the unit that its place says.
    pub value: f64,
}

/// One of our joints, and what the file calls it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointFound {
    /// Name of the joint after H-Anim.
    pub joint: String,
    /// The file's own name.
    pub named: String,
}

/// Weight lost by pruning influences.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Influences {
    /// Most influences of a vertex in the file.
    pub most: usize,
    /// Vertices with more than four in the file.
    pub over_four: usize,
    /// Vertices that lost weight.
    pub pruned: usize,
    /// Mean over those of the weight lost (1).
    pub mean_lost: f64,
    /// Most weight that a vertex lost (1).
    pub max_lost: f64,
}

/// Whether a surface is closed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SurfaceReport {
    /// Connected pieces of the surface.
    pub parts: usize,
    /// Edges with a triangle on one side alone.
    pub boundary_edges: usize,
    /// Edges of more than two triangles.
    pub crowded_edges: usize,
}
