//! Sizes of a mesh that says in which one it is made: its girths, and its cut in another size.

use glam::{Vec2, Vec3};

use super::error::AdaptError;
use super::made_for::{MadeFor, arm_share};
use super::measures::MeshSizes;
use super::mesh::ForeignMesh;
use super::own_mesh::OwnMesh;
use super::place::{Below, BodyWay};
use crate::body::tape;
use crate::sizes::{Girth, SizeBody};
use toile_base::body::{Body, Measures};
use toile_base::mesh::Mesh;

/// A section of a garment that is shorter than this share of the body's girth does not go around it.
const AROUND: f32 = 0.9;

/// A garment in one size, with the body that it is cut for.
#[derive(Debug, Clone, PartialEq)]
pub struct GradedMesh {
    /// The mesh with the lengths of the size.
    pub mesh: ForeignMesh,
    /// The body of the size, its arms held as the sleeves are.
    pub body: Body,
}

impl OwnMesh {
    /// Girths of the garment as it is made (m), at the zones that it reaches: those of its file of measures, else measured by
    /// tape on the mesh, sleeves left out.
    pub fn finished(&self) -> Vec<(Girth, f32)> {
        let given = |zone| self.measures.finished_mm.at(zone).map(|mm| mm * 1e-3);
        let girth = |zone: &Girth| given(*zone).or_else(|| self.girth(*zone)).map(|m| (*zone, m));
        Girth::ALL.iter().filter_map(girth).collect()
    }

    /// The same in another size: girths grow as those of the bodies do.
    pub fn finished_in(&self, sizes: &MeshSizes, body: &SizeBody) -> Vec<(Girth, f32)> {
        let [to, from] = [body, &sizes.body].map(|b| Measures::from(*b));
        let grown = |(zone, m): (Girth, f32)| (zone, m * zone.of(&to) / zone.of(&from));
        self.finished().into_iter().map(grown).collect()
    }

    fn girth(&self, zone: Girth) -> Option<f32> {
        let levels = &self.made_for.body.levels;
        let (height, measures) = (levels, &self.made_for.body.measures);
        let (height, body) = match zone {
            Girth::Chest => (height.chest, measures.chest_girth),
            Girth::Waist => (height.waist, measures.waist_girth),
            Girth::Hip => (height.hip, measures.hip_girth),
        };
        let trunk = |v: u32| [1.0, -1.0].iter().all(|side| arm_share(&self.weights[v as usize], *side) < 0.5);
        let mut mesh = Mesh { positions: self.mesh.positions.clone(), ..Mesh::default() };
        for face in self.mesh.faces.iter().map(toile_bake::check::corners).filter(|f| f.iter().all(|v| trunk(*v))) {
            (2..face.len()).for_each(|k| mesh.triangles.push([face[0], face[k - 1], face[k]]));
        }
        let cut = tape::slice(&mesh, |_| true, Vec3::Y * height, Vec3::Y);
        let points: Vec<Vec2> = cut.iter().flatten().map(|p| Vec2::new(p.x, p.z)).collect();
        let girth = tape::perimeter(&tape::hull(&points));
        (girth >= AROUND * body).then_some(girth)
    }

    /// The mesh cut in another of its sizes.
    ///
    /// # Errors
    /// A size that its table does not have.
    pub fn graded(&self, sizes: &MeshSizes, code: &str) -> Result<GradedMesh, AdaptError> {
        let size = sizes.table.size_body(code)?;
        let made = MadeFor::mannequin(sizes.sex(), &Measures::from(size), String::new());
        let mut made = made.map_err(|source| AdaptError::Body { path: self.path.clone(), source })?;
        made.hold_limbs(&self.mesh);
        let [to, from] = [size, sizes.body].map(Measures::from);
        let times = Girth::ALL.map(|zone| zone.of(&to) / zone.of(&from));
        let way = BodyWay::growing(&self.made_for.body, &made.body, times);
        let mut mesh = self.mesh.clone();
        let below = self.below();
        for ((p, weights), below) in mesh.positions.iter_mut().zip(&self.weights).zip(below) {
            *p = way.place(*p, weights, below);
        }
        Ok(GradedMesh { mesh, body: made.body })
    }

    /// What each vertex's piece hangs around below the crotch.
    pub fn below(&self) -> Vec<Below> {
        super::wear::below(&self.mesh, &super::surface::pieces(&self.mesh), self.made_for.body.levels.crotch)
    }
}
