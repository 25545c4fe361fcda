//! Meshes without a file: a rectangle and an open tube, vertex after vertex down their rows.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::error::SceneError;
use super::table::SceneTable;
use crate::import::plain::PlainMesh;
use crate::scene::skirt;
use toile_bake::Shape;
use toile_bake::shape::Face;

/// A rectangle, centred on x = 0. Vertex (row, column) is `row * columns + column`; row 0 is the top, or the far edge
/// of a level one.
pub(super) fn grid(table: &SceneTable<'_>) -> Result<PlainMesh, SceneError> {
    let (rows, columns) = (table.count("rows")?, table.count("columns")?);
    let (width, height) = (table.needed("width")?, table.needed("height")?);
    let level = table.choice("plane")? == Some(1);
    let place = |row: u32, column: u32| {
        let x = width * (f64::from(column) / f64::from(columns - 1) - 0.5);
        let down = height * f64::from(row) / f64::from(rows - 1);
        if level { DVec3::new(x, 0.0, down - 0.5 * height) } else { DVec3::new(x, -down, 0.0) }
    };
    Ok(mesh(rows, columns, false, place))
}

/// An open tube around the y axis, row 0 on top at y = 0.
pub(super) fn tube(table: &SceneTable<'_>) -> Result<PlainMesh, SceneError> {
    let (rows, columns) = (table.count("rows")?, table.count("columns")?);
    let (top, bottom) = (table.needed("top_radius")?, table.needed("bottom_radius")?);
    let height = table.needed("height")?;
    let place = |row: u32, column: u32| {
        let down = f64::from(row) / f64::from(rows - 1);
        let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        let radius = top + (bottom - top) * down;
        DVec3::new(radius * cos, -height * down, radius * sin)
    };
    Ok(mesh(rows, columns, true, place))
}

/// The benchmark's skirt; its faces run down from row 0, the waistband.
pub(super) fn skirt(table: &SceneTable<'_>) -> Result<PlainMesh, SceneError> {
    let side = table.count("side")? as usize;
    let Shape { cut, faces, split, .. } =
        if table.choice("layout")? == Some(1) { skirt::irregular(side, SEED) } else { skirt::shape(side) };
    Ok(PlainMesh { face_materials: vec![None; faces.len()], positions: cut, faces, split, ..PlainMesh::default() })
}

/// Seed of the irregular skirt.
const SEED: u64 = 1;

/// Rows of vertices and the quads between them; `a-b` runs along the row, so that warp runs down the columns.
fn mesh(rows: u32, columns: u32, closed: bool, place: impl Fn(u32, u32) -> DVec3) -> PlainMesh {
    let positions: Vec<Vec3> =
        (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))).map(|(r, c)| place(r, c).as_vec3()).collect();
    let at = |r: u32, c: u32| r * columns + c % columns;
    let across = if closed { columns } else { columns - 1 };
    let face = |r: u32, c: u32| -> Face {
        // Both ways round are counter-clockwise seen from outside of a tube, and from the front of a rectangle.
        if closed {
            [at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)]
        } else {
            [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)]
        }
    };
    let faces: Vec<Face> = (0..rows - 1).flat_map(|r| (0..across).map(move |c| face(r, c))).collect();
    PlainMesh { face_materials: vec![None; faces.len()], positions, faces, ..PlainMesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_closes_and_both_face_outwards() {
        let flat = mesh(2, 3, false, |r, c| DVec3::new(f64::from(c), -f64::from(r), 0.0));
        assert_eq!(flat.faces.len(), 2);
        let round = mesh(2, 4, true, |r, c| {
            let (sin, cos) = (TAU * f64::from(c) / 4.0).sin_cos();
            DVec3::new(cos, -f64::from(r), sin)
        });
        assert_eq!(round.faces.len(), 4);
        for (mesh, outside) in [(flat, None), (round, Some(Vec3::ZERO))] {
            for face in &mesh.faces {
                let [a, b, c, d] = face.map(|v| mesh.positions[v as usize]);
                let middle = (a + b + c + d) / 4.0;
                let out = outside.map_or(Vec3::Z, |o| middle.with_y(0.0) - o);
                assert!((b - a).cross(c - a).dot(out) > 0.0, "{face:?}");
                assert!((b - a).y.abs() < 1e-6, "the side a-b runs along the row");
            }
        }
    }
}
