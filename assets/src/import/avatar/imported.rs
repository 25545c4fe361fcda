//! The result of an import: a body, and a report on its file.

use super::carry::PruningLoss;
use toile_base::body::Body;

/// A body, and what was found in its file.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedBody {
    /// The body in its rest pose: metres, y up, facing +z, the floor at y = 0.
    pub body: Body,
    /// Findings in the file and their interpretation.
    pub report: ImportReport,
}

/// Findings in a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImportReport {
    /// Dialect of its joints' names.
    pub dialect: &'static str,
    /// For each of our joints that was found: its H-Anim name, and the file's own.
    pub joints: Vec<(String, String)>,
    /// Weight lost by pruning influences.
    pub pruned: PruningLoss,
    /// Connected pieces of the surface.
    pub parts: usize,
    /// Edges with a triangle on one side alone.
    pub boundary_edges: usize,
    /// Edges of more than two triangles.
    pub crowded_edges: usize,
    /// Findings and their interpretation, one sentence each.
    pub notes: Vec<String>,
}
