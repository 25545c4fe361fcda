//! Strips that were cut at an angle to the threads: how each kind of mesh has them.
//!
//! A strip runs from s = 0 to its length, as in [`mesh`](super::mesh), and is clamped at s = 0; the warp of its cloth makes an angle with it.
//! Where threads run is said by the faces as they were cut, laid flat: weft along x, warp along y.

use std::f64::consts::SQRT_2;

use glam::{DVec2, DVec3};
use toile_assets::pattern::{Curve, Panel, PanelEdge, Pattern, Seam, SeamSide};
use toile_assets::tailor;
use toile_bake::Shape;
use toile_bake::shape::Face;
use toile_bake::shape::NO_VERTEX;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;

use super::mesh::{EndSupport, MeshStyle, Strip};

/// How a strip that was cut at an angle is meshed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TurnedMesh {
    /// Quads along the threads; cut at 45 degrees, the sides run through the corners of cells.
    Grid,
    /// Triangles along the strip, whatever way the threads run.
    Alternating,
    /// Irregular triangles.
    Unstructured,
    /// Three panels as the tailor meshes them, with a seam at the clamp and one in the middle.
    Sewn,
}

impl TurnedMesh {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Grid, Self::Alternating, Self::Unstructured, Self::Sewn];

    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid => MeshStyle::Grid.name(),
            Self::Alternating => MeshStyle::Alternating.name(),
            Self::Unstructured => MeshStyle::Unstructured.name(),
            Self::Sewn => "sewn",
        }
    }
}

/// A clamped strip whose warp runs at an angle to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnedStrip {
    /// From the clamp to the free end (m).
    pub length: f64,
    /// Across the strip (m).
    pub width: f64,
    /// Links along the strip.
    pub rows: usize,
    /// How it is meshed.
    pub style: TurnedMesh,
    /// Angle from the strip to the warp (degrees): 0, 45 or 90.
    pub degrees: u32,
}

impl TurnedStrip {
    /// Its shape, level along x.
    pub fn shape(&self) -> Shape {
        match (self.style, self.degrees) {
            (TurnedMesh::Sewn, _) => self.sewn(),
            (TurnedMesh::Grid, 45) => self.lattice(),
            (TurnedMesh::Grid, _) => self.grid(),
            (TurnedMesh::Alternating, _) => self.laid(self.strip(MeshStyle::Alternating)),
            (TurnedMesh::Unstructured, _) => self.laid(self.strip(MeshStyle::Unstructured)),
        }
    }

    fn angle(&self) -> f64 {
        f64::from(self.degrees).to_radians()
    }

    /// A place of the strip (along, across) on the cloth, weft along x and warp along y.
    fn on_cloth(&self, at: DVec2) -> DVec2 {
        DVec2::from_angle(self.angle()).rotate(DVec2::new(at.y, -at.x))
    }

    /// The strip as its threads' own meshes have it.
    fn strip(&self, style: MeshStyle) -> Shape {
        let columns = (self.width / self.length * self.rows as f64).round().max(2.0) as usize;
        let ends = [EndSupport::Clamped, EndSupport::Free];
        let strip = Strip { length: self.length, width: self.width, rows: self.rows, columns, style, ends };
        strip.shape(|along, across| DVec3::new(along, 0.0, across))
    }

    /// The same with its faces laid out on the cloth.
    fn laid(&self, mut shape: Shape) -> Shape {
        let at = |v: u32| {
            let p = shape.cut[v as usize].as_dvec3();
            self.on_cloth(DVec2::new(-p.y, p.x)).as_vec2()
        };
        let corners = |face: &Face| face.map(|v| at(if v == NO_VERTEX { face[0] } else { v }));
        shape.flat = shape.faces.iter().map(corners).collect();
        shape
    }

    /// Quads along threads that run along the strip or across it: their sides say which is the warp.
    fn grid(&self) -> Shape {
        let mut shape = self.strip(MeshStyle::Grid);
        if self.degrees == 90 {
            shape.faces.iter_mut().for_each(|face| face.rotate_left(1));
        }
        self.laid(shape)
    }

    /// Cells of the threads that stand on their corners; halves of them along both sides and at the ends.
    fn lattice(&self) -> Shape {
        // An even number of rows, half a cell's diagonal apart, of the cells that links of a grid would have.
        let rows = 2 * (self.rows as f64 / SQRT_2).round() as i64;
        let half = self.length / rows as f64;
        let across = (self.width / (2.0 * half)).round() as i64;
        let number = |row: i64, k: i64| {
            // An even row has a point more than an odd one.
            let before = (row + BEHIND) / 2 * (2 * across + 1) + if row.rem_euclid(2) == 1 { across + 1 } else { 0 };
            (before + k) as u32
        };
        let mut points = Vec::new();
        for row in -BEHIND..=rows {
            let odd = row.rem_euclid(2);
            points.extend(
                (0..=across - odd).map(|k| DVec2::new(row as f64 * half, (2 * k + odd - across) as f64 * half)),
            );
        }
        self.laid(held(points, lattice_faces([-BEHIND, rows], across, number)))
    }

    /// A panel behind the clamp and one for each half of the strip, sewn one to the other.
    fn sewn(&self) -> Shape {
        let spacing = self.length / self.rows as f64;
        let grain = DVec2::from_angle(-self.angle()).rotate(DVec2::Y);
        let panel = |name: &str, [from, to]: [f64; 2]| {
            let half = 0.5 * self.width;
            let corners = [[half, -from], [-half, -from], [-half, -to], [half, -to]].map(DVec2::from);
            let edge = |k: usize| {
                let curve = Curve::Line([corners[k], corners[(k + 1) % 4]]);
                PanelEdge { curve, number: k, label: None }
            };
            let edges = (0..4).map(edge).collect();
            Panel { name: name.into(), label: None, edges, grain, behind: false, placement: None, trims: Vec::new() }
        };
        let middle = 0.5 * self.length;
        let panels = vec![
            panel("clamp", [-2.0 * spacing, 0.0]),
            panel("first half", [0.0, middle]),
            panel("second half", [middle, self.length]),
        ];
        let side = |panel, first, reversed| SeamSide { panel, first, count: 1, reversed };
        let seam = |k: usize| Seam { name: format!("seam {k}"), sides: [side(k, 2, false), side(k + 1, 0, true)] };
        // The panels are made here and lie as they are sewn: nothing of them can be refused.
        let pattern = Pattern::checked(panels, vec![seam(0), seam(1)]).expect("panels side by side");
        let sewn = tailor::sew(&pattern, spacing).expect("rectangles can be meshed");
        let place = |member: &[u32; 2]| {
            let p = sewn.panels[member[0] as usize].points[member[1] as usize];
            DVec2::new(-p.y, p.x)
        };
        let points = sewn.members.iter().map(|members| place(&members[0])).collect();
        let mut shape = held(points, sewn.faces);
        (shape.flat, shape.split, shape.panels) = (sewn.flat, sewn.split, sewn.face_panels);
        shape
    }
}

/// What lies no farther along than this is held (m): rounding.
const CLAMP_M: f64 = 1e-6;

/// Rows of the lattice behind its clamp: what lies behind a stencil at the clamp is held.
const BEHIND: i64 = 4;

/// The cells between the points of a lattice that stands on its corners, and halves of them along its sides. Even rows have `across` + 1 points, odd
/// ones one less; the first side of a cell runs along the weft.
fn lattice_faces([first, last]: [i64; 2], across: i64, number: impl Fn(i64, i64) -> u32) -> Vec<Face> {
    let mut faces: Vec<Face> = Vec::new();
    for row in first..last {
        let odd = row.rem_euclid(2);
        for k in 0..=across - odd {
            let [left, right] = [k - 1 + odd, k + odd];
            let has = [left >= 0, right <= across - 1 + odd];
            let (near, far) = (number(row, k), (row + 1 < last).then(|| number(row + 2, k)));
            let [l, r] = [left, right].map(|k| number(row + 1, k));
            match (has, far) {
                // The first side leads from the left corner to the far one, along the weft.
                ([true, true], Some(far)) => faces.push([l, far, r, near]),
                ([true, false], Some(far)) => faces.push([near, l, far, NO_VERTEX]),
                ([false, _], Some(far)) => faces.push([near, far, r, NO_VERTEX]),
                ([true, true], None) => faces.push([near, l, r, NO_VERTEX]),
                _ => {}
            }
            if row == first && k < across {
                faces.push([near, r, number(row, k + 1), NO_VERTEX]);
            }
        }
    }
    faces
}

/// A shape of points (along, across), level along x, held up to the clamp.
fn held(points: Vec<DVec2>, faces: Vec<Face>) -> Shape {
    let mut shape = Shape { faces, ..Shape::default() };
    for p in points {
        let (cut, worn) = (DVec3::new(p.y, -p.x, 0.0), DVec3::new(p.x, 0.0, p.y));
        shape.push(cut.as_vec3(), worn.as_vec3(), p.x < CLAMP_M, Part::All);
        shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
    }
    shape
}
