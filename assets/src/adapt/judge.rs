//! Decides the use of each piece: cloth if it can be simulated well, else skin; small pieces ride along without bending.

use glam::Vec3;

use super::lay::LaidMesh;
use super::mesh::{ForeignMesh, sides};
use super::report::{Behaviour, PieceReport};
use toile_base::mesh::SkinWeights;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::BONES;

/// Pieces no larger than this in any direction (m) are buttons, buckles, zips: they ride along.
const TRIM_M: f32 = 0.08;

/// Half of the edges at most may be longer than this (m): coarser cloth cannot bend around an arm.
const COARSEST_M: f32 = 0.06;

/// Half of the edges at least must be longer than this (m): twice the thickness that contact keeps cloth apart by.
const FINEST_M: f32 = 0.004;

/// Share of the faces that may be needles, and how long in comparison to their width these are.
const MOST_NEEDLES: f32 = 0.25;
const NEEDLE: f32 = 10.0;

/// Stretch or compression with which 95 % of the edges may start (1): what starts beyond is folded or torn on this body.
const MOST_STRAIN: f32 = 0.35;

/// The same with which 99 % may start: few edges that far off are enough to tear a leg open.
const WORST_STRAIN: f32 = 0.45;

/// Vertices that move at once, of a whole mesh: twice the built-in outfits', which take half of a step's time.
pub const MOST_MOVING: usize = 12_000;

/// Share of a piece that has to move for it to be cloth.
const LEAST_MOVING: f32 = 0.05;

/// Properties of a piece before any decision.
pub struct PieceMeasures {
    extent: f32,
    edge: f32,
    needles: f32,
    strain: [f32; 2],
}

impl PieceMeasures {
    /// Measures a piece of these vertices and faces.
    pub fn of(mesh: &ForeignMesh, laid: &LaidMesh, piece: &[u32], faces: &[usize]) -> Self {
        let faces = || faces.iter().copied();
        let ends = || faces().flat_map(|f| sides(&mesh.faces[f])).map(|[a, b]| [a as usize, b as usize]);
        let mut lengths: Vec<f32> = ends().map(|[a, b]| mesh.positions[a].distance(mesh.positions[b])).collect();
        let strain = |[a, b]: [usize; 2]| {
            laid.worn[a].distance(laid.worn[b]) / mesh.positions[a].distance(mesh.positions[b]) - 1.0
        };
        let mut strains: Vec<f32> = ends().map(|e| strain(e).abs()).collect();
        let needle = |f: &usize| {
            let longest =
                sides(&mesh.faces[*f]).map(|[a, b]| mesh.positions[a as usize].distance(mesh.positions[b as usize]));
            let longest = longest.fold(0.0, f32::max);
            0.5 * mesh.area_normal(*f).length() * NEEDLE < longest * longest
        };
        let points = || piece.iter().map(|v| mesh.positions[*v as usize]);
        let (low, high) = (points().fold(Vec3::INFINITY, Vec3::min), points().fold(Vec3::NEG_INFINITY, Vec3::max));
        Self {
            extent: (high - low).max_element(),
            edge: quantile(&mut lengths, 0.5).unwrap_or(0.0),
            needles: faces().filter(needle).count() as f32 / faces().count().max(1) as f32,
            strain: [quantile(&mut strains, 0.95).unwrap_or(0.0), quantile(&mut strains, 0.99).unwrap_or(0.0)],
        }
    }

    /// Why the piece cannot be cloth; nothing where it can.
    pub fn flaw(&self) -> Option<String> {
        let mm = self.edge * 1e3;
        if self.edge > COARSEST_M {
            Some(format!("too coarse, half of its edges are longer than {mm:.0} mm"))
        } else if self.edge < FINEST_M {
            Some(format!("too fine, half of its edges are shorter than {mm:.1} mm"))
        } else if self.needles > MOST_NEEDLES {
            Some(format!("{:.0} % of its faces are needles", self.needles * 100.0))
        } else if self.strain[0] > MOST_STRAIN {
            Some(format!(
                "5 % of its edges start more than {:.0} % off their length on this body",
                self.strain[0] * 100.0
            ))
        } else if self.strain[1] > WORST_STRAIN {
            Some(format!(
                "1 % of its edges start more than {:.0} % off their length on this body",
                self.strain[1] * 100.0
            ))
        } else {
            None
        }
    }

    /// Whether it is a button, a buckle or the like.
    pub fn is_trim(&self) -> bool {
        self.extent < TRIM_M
    }

    /// The report on a piece.
    pub fn report(
        &self,
        vertex: u32,
        vertices: usize,
        moving: usize,
        (behaviour, why): (Behaviour, String),
    ) -> PieceReport {
        let (edge_mm, start_strain) = (self.edge * 1e3, self.strain[1]);
        PieceReport { vertex, vertices, moving, behaviour, why, edge_mm, start_strain }
    }
}

/// Whether so few vertices of a piece are left to move that it is none.
pub fn is_tight(moving: usize, vertices: usize) -> bool {
    (moving as f32) < LEAST_MOVING * vertices as f32
}

/// Gives the vertices of a trim one and the same weights: their mean.
pub fn stiffen(weights: &mut [SkinWeights], piece: &[u32]) {
    let mut sum = [0.0f32; BONES];
    for v in piece {
        weights[*v as usize].iter().for_each(|(bone, w)| sum[usize::from(bone)] += w);
    }
    let mean = SkinWeights::strongest((0u8..).zip(sum)).0;
    piece.iter().for_each(|v| weights[*v as usize] = mean);
}
