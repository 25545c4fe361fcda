//! The mesh of one panel.

use glam::DVec2;

use super::angles::{angles, interior};
use super::error::TailorError;
use super::improve::improve;
use super::lattice::Lattice;
use super::quads;
use super::ring::{Filled, Points};
use super::sampling::Boundary;
use crate::pattern::{Panel, crossing};
use toile_bake::shape::{Face, NO_VERTEX};

/// A panel as a flat mesh: quads along warp and weft inside, triangles towards the outline.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelMesh {
    /// Vertices in the panel's drawing (m) `[vertices]`: those of the outline first, in its order.
    pub points: Vec<DVec2>,
    /// Start of each edge's points among those of the outline `[edges + 1]`.
    pub boundary: Boundary,
    /// Faces, counter-clockwise in the drawing; a quad's first side runs along the weft.
    pub faces: Vec<Face>,
    /// True where a quad is split along b-d, its shorter diagonal `[faces]`.
    pub split: Vec<bool>,
    /// True for what lies on a warp and a weft fiber: the points of the lattice that are corners of quads, which
    /// none of the outline counts as `[vertices]`.
    pub regular: Vec<bool>,
    /// Unit vectors along weft and warp in the drawing.
    pub axes: [DVec2; 2],
}

/// How good a panel's mesh is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelQuality {
    /// Vertices that do not lie on the outline.
    pub inner: usize,
    /// Those of them that lie on a warp and a weft fiber.
    pub regular: usize,
    /// Smallest angle of a triangle, quads split as they are drawn (degrees).
    pub least_angle: f64,
    /// Smallest angle of the panel's own outline (degrees).
    pub sharpest_corner: f64,
    /// Area of the mesh over that of the exact outline, less one.
    pub area_error: f64,
}

/// Limits of meshing a panel.
#[derive(Debug, Clone, Copy)]
pub struct MeshBudget {
    /// Particles that the pattern may still have.
    pub particles: usize,
    /// Points that may be looked at while the panel is improved.
    pub effort: usize,
}

/// Meshes a panel whose outline was sampled; `extra` are further points to go through (m).
pub fn mesh(
    panel: &Panel,
    boundary: &Boundary,
    spacing: f64,
    extra: &[DVec2],
    allowed: MeshBudget,
) -> Result<PanelMesh, TailorError> {
    let outline = &boundary.points;
    let narrow =
        |at: DVec2| TailorError::Narrow { panel: panel.name.clone(), spacing_mm: spacing * 1e3, x: at.x, y: at.y };
    let too_many = || TailorError::TooMany { panel: panel.name.clone() };
    let area = 0.5 * twice_area(outline);
    if area.abs() / (spacing * spacing) + outline.len() as f64 > allowed.particles as f64 {
        return Err(too_many());
    }
    if outline.len() < 3 {
        return Err(narrow(panel.edges[0].curve.start()));
    }
    if let Some((i, _)) = crossing(outline) {
        return Err(narrow(outline[i]));
    }
    let lattice = Lattice::new(panel, boundary, spacing).ok_or_else(too_many)?;
    let mut points =
        Points { boundary, counter_clockwise: area > 0.0, lattice, free: extra.to_vec(), held: extra.len() };
    let filled = points.fill().ok_or_else(|| narrow(outline[0]))?;
    let filled = improve(&mut points, filled, spacing, allowed.effort);
    Ok(assemble(&points, &filled))
}

fn twice_area(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum()
}

/// Cells, quads beside the seams and triangles as one mesh, without the places that hold no point.
fn assemble(points: &Points<'_>, filled: &Filled) -> PanelMesh {
    let axes = points.lattice.axes();
    let (quads, triangles) = quads::pair(&filled.at, &filled.triangles, axes);
    let cells = points.lattice.cells().map(|cell| cell.map(|place| points.of_lattice(place)));
    let faces = cells.chain(quads).chain(triangles.into_iter().map(|[a, b, c]| [a, b, c, NO_VERTEX]));
    let mut faces: Vec<Face> = faces.collect();
    let outline = points.boundary.points.len();
    let mut used = vec![false; filled.at.len()];
    faces.iter().flatten().filter(|v| **v != NO_VERTEX).for_each(|v| used[*v as usize] = true);
    used[..outline].fill(true);
    let mut number = vec![NO_VERTEX; used.len()];
    let mut kept = Vec::new();
    for (i, at) in filled.at.iter().enumerate().filter(|(i, _)| used[*i]) {
        number[i] = kept.len() as u32;
        kept.push(*at);
    }
    faces.iter_mut().flatten().filter(|v| **v != NO_VERTEX).for_each(|v| *v = number[*v as usize]);
    let mut regular = vec![false; kept.len()];
    faces.iter().filter(|f| f[3] != NO_VERTEX).flatten().for_each(|v| regular[*v as usize] = true);
    let free = used[points.of_free(0) as usize..].iter().filter(|u| **u).count();
    let places = outline..kept.len() - free;
    regular.iter_mut().enumerate().filter(|(v, _)| !places.contains(v)).for_each(|(_, regular)| *regular = false);
    let length = |a: u32, b: u32| kept[a as usize].distance(kept[b as usize]);
    let split =
        faces.iter().map(|f| f[3] != NO_VERTEX && length(f[1], f[3]) < length(f[0], f[2]) * (1.0 - 1e-6)).collect();
    PanelMesh { points: kept, boundary: points.boundary.clone(), faces, split, regular, axes }
}

impl PanelMesh {
    /// Triangles, quads split along their shorter diagonal.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces.iter().zip(&self.split).flat_map(|(&[a, b, c, d], split)| {
            let both = match (d, split) {
                (NO_VERTEX, _) => [Some([a, b, c]), None],
                (_, true) => [Some([a, b, d]), Some([b, c, d])],
                (_, false) => [Some([a, b, c]), Some([a, c, d])],
            };
            both.into_iter().flatten()
        })
    }

    /// How good the mesh of a panel is.
    pub fn quality(&self, panel: &Panel) -> PanelQuality {
        let outline = self.boundary.points.len();
        let corners = |t: [u32; 3]| t.map(|v| self.points[v as usize]);
        let least = self.triangles().flat_map(|t| angles(corners(t))).fold(f64::MAX, f64::min);
        let area: f64 = self.triangles().map(|t| 0.5 * twice_area(&corners(t))).sum();
        let exact = panel.signed_area().abs();
        let own = interior(&self.boundary.points, panel.signed_area() > 0.0);
        PanelQuality {
            inner: self.points.len() - outline,
            regular: self.regular[outline..].iter().filter(|r| **r).count(),
            least_angle: least.to_degrees(),
            sharpest_corner: own.into_iter().fold(f64::MAX, f64::min).to_degrees(),
            area_error: area / exact - 1.0,
        }
    }
}
