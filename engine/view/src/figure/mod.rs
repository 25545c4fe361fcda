//! The figure that is drawn of a body: a shop mannequin's head in the place of the drawn one, or the shopper's own; the tone of the
//! skin, the hair.
//!
//! The thread that dresses the shopper makes a figure (30 ms); the render thread then draws it (50 µs a picture, no allocation).
//!
//! It is a matter of pictures alone: measures, weights, colliders and cloth know the body as it is, so that a head costs no bit
//! of the physics. Below the neck, on the crown and on bodies by others no vertex is moved.

// Modules in the order of the data.
mod egg;
mod fairing;
mod head_space;

mod face;
mod moulded;
mod own_head;

mod appearance;
mod placed_head;
#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};
use toile_assets::body::base;
use toile_base::body::{Body, Region};
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Joint;

use crate::base_layer::{HAIR_AT, base_layer};
use crate::cloth_look::GarmentLook;

pub use appearance::{Appearance, Hair, SkinTone, UnknownName};
pub use own_head::{OwnHead, OwnHeadPicture};
pub use placed_head::PlacedHead;

use face::Face;
use head_space::HeadSpace;
use moulded::Moulded;

/// A body at rest as it is drawn.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Vertices (m): the body's, then the hair's `[vertices]`.
    pub rest: Vec<Vec3>,
    /// Their unit normals `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Vertex indices, the body's triangles first.
    pub triangles: Vec<[u32; 3]>,
    /// Base layer and hair, as a look of the skin.
    pub look: GarmentLook,
    /// Linear RGB of the skin.
    pub colour: Vec3,
    /// The placed head, which moves along with a posed skin.
    pub head: PlacedHead,
}

impl Figure {
    /// The figure of a body. A body by others keeps its own head, and takes no hair.
    pub fn of(body: &Body, appearance: Appearance) -> Self {
        let mut figure = Self {
            rest: body.mesh.positions.clone(),
            normals: body.normals.clone(),
            triangles: body.mesh.triangles.clone(),
            look: base_layer(body, appearance.skin.hair()),
            colour: appearance.skin.colour(),
            head: PlacedHead::default(),
        };
        if let Some(space) = HeadSpace::of(body).filter(|_| base::is_drawn(&body.mesh)) {
            let Face { positions, normals } = Face::of(body, &space);
            (figure.rest, figure.normals) = (positions, normals);
            figure.take_hair(body, &space, appearance.hair, HAIR_AT);
            figure.head = PlacedHead::new(body, &figure.rest, &figure.normals);
        }
        figure
    }

    /// The figure of a body with the shopper's own head, where there is one that fits: of the same sex's drawing. A mannequin's otherwise.
    pub fn with_head(body: &Body, appearance: Appearance, own: Option<&OwnHead>) -> Self {
        let space = HeadSpace::of(body).filter(|_| base::is_drawn(&body.mesh));
        let Some((own, space)) = own.filter(|own| own.sex() == body.sex).zip(space) else {
            return Self::of(body, appearance);
        };
        let (rest, normals) = own.on(body, &space);
        let mut figure = Self {
            rest,
            normals,
            triangles: body.mesh.triangles.clone(),
            look: own.look(base_layer(body, own.hair())),
            colour: own.skin(),
            head: PlacedHead::default(),
        };
        // A shop whose mannequins have no hair has said nothing of shoppers.
        let cut = if appearance.hair == Hair::None { Hair::usual(body.sex) } else { appearance.hair };
        let around = HeadSpace::around(&figure.rest, &body.regions, body.skeleton.at(Joint::Head)).unwrap_or(space);
        figure.take_hair(body, &around, cut, own.hair_at());
        figure.head = PlacedHead::new(body, &figure.rest, &figure.normals);
        figure
    }

    /// Puts hair on, which has its colour at a point of the look's picture.
    fn take_hair(&mut self, body: &Body, space: &HeadSpace, hair: Hair, at: Vec2) {
        let Some(hair) = HairMesh::on(&self.rest, &body.mesh.triangles, space, hair) else { return };
        let first = self.rest.len() as u32;
        self.look.corners.extend(hair.triangles.iter().map(|_| [at; 3]));
        self.triangles.extend(hair.triangles.into_iter().map(|t| t.map(|v| v + first)));
        self.rest.extend(hair.positions);
        self.normals.extend(hair.normals);
    }
}

/// Moulded hair as a mesh of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct HairMesh {
    /// Vertices (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Their unit normals `[vertices]`.
    pub normals: Vec<Vec3>,
    /// Indices of the vertices of each, counter-clockwise seen from outside `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
}

impl HairMesh {
    /// On a head of any shape, of the drawn body at rest: its vertices (m) with their parts of the body, its triangles, the joint (m).
    /// None for no hair.
    pub fn of(positions: &[Vec3], regions: &[Region], triangles: &[[u32; 3]], joint: Vec3, hair: Hair) -> Option<Self> {
        HeadSpace::around(positions, regions, joint).and_then(|space| Self::on(positions, triangles, &space, hair))
    }

    fn on(positions: &[Vec3], triangles: &[[u32; 3]], space: &HeadSpace, hair: Hair) -> Option<Self> {
        let scalp = triangles.iter().map(|t| t.map(|v| space.inwards(positions[v as usize])));
        let Moulded { points, triangles } = Moulded::of(hair.cut()?, scalp);
        let positions: Vec<Vec3> = points.into_iter().map(|p| space.outwards(p)).collect();
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, &triangles, &mut normals);
        Some(Self { positions, normals, triangles })
    }
}
