//! The mesh of the first frame, from an OBJ file in the cameras' world.

use std::path::Path;

use glam::Vec2;
use toile_assets::file::{self, FileKind};
use toile_assets::import::plain::parse_obj;
use toile_bake::check::corners;

use crate::error::CaptureError;
use crate::surface::CapturedSurface;

/// Largest file of a mesh.
const MESH: FileKind = FileKind { name: "a mesh as OBJ", max_bytes: 256 << 20, cure: "give a coarser mesh" };

/// Reads the mesh that is followed; its vertices keep their order, and quads are split along the diagonal that they are given with.
///
/// # Errors
/// One sentence with the path, the line and the cure.
pub fn read_mesh(path: &Path) -> Result<CapturedSurface, CaptureError> {
    let shown = path.display().to_string();
    let unfit = |problem: String| CaptureError::unfit(&shown, problem, "give the mesh as OBJ, in metres");
    let text = file::read_text(path, &MESH).map_err(|e| CaptureError::Source(e.into()))?;
    let mesh = parse_obj(&text).map_err(|e| unfit(format!("it is no OBJ mesh ({e})")))?;
    let mut triangles = Vec::with_capacity(2 * mesh.faces.len());
    for face in &mesh.faces {
        let ring = corners(face);
        for k in 1..ring.len() - 1 {
            triangles.push([ring[0], ring[k], ring[k + 1]]);
        }
    }
    let positions = mesh.positions.iter().map(|p| p.as_dvec3()).collect();
    CapturedSurface::new(&shown, positions, Vec::<Vec2>::new(), triangles)
}
