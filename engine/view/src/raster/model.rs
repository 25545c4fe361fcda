//! Surfaces and their materials, as the rasteriser draws them.

use glam::{Vec2, Vec3};

use toile_base::fabric::{Fabric, Weave};
use toile_base::garment::Garment;

use crate::cloth_look::GarmentLook;
use crate::figure::Figure;
use crate::image::linear;

/// All surfaces of a scene, in dressing order: the body, then garments from the skin outwards.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Model {
    /// The surfaces; their places in this list are the numbers that they are called by.
    pub surfaces: Vec<RenderSurface>,
}

impl Model {
    /// A figure and what it wears, inner garments first.
    pub fn of_outfit(figure: &Figure, garments: &[Garment]) -> Self {
        let surfaces =
            std::iter::once(RenderSurface::of_figure(figure)).chain(garments.iter().map(RenderSurface::of_garment));
        Self { surfaces: surfaces.collect() }
    }
}

/// A surface's constant data: mesh, colour and material.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderSurface {
    /// Where the vertices are at rest (m) `[vertices]`: what the weave lies along, and what is drawn until the first
    /// update.
    pub rest: Vec<Vec3>,
    /// What cloth shows beside its colour; where it does not say how the surface lies on the cloth, the weave is laid on from
    /// three sides of the rest shape.
    pub look: Option<GarmentLook>,
    /// Vertex indices, counter-clockwise seen from outside `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// Base colour, linear RGB, each 0..1.
    pub colour: Vec3,
    /// How the surface reflects light.
    pub material: RenderMaterial,
}

/// How a surface meets light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RenderMaterial {
    /// A matte mannequin.
    Skin,
    /// Woven or knitted cloth, lit on both sides.
    Cloth(ClothAppearance),
    /// Two-sided, diffuse alone, so that the colours of a map match their legend.
    Diffuse,
}

/// How cloth looks, beside its colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothAppearance {
    /// How its threads run.
    pub weave: Weave,
    /// Distance between threads, of weft and of warp (m).
    pub pitch: Vec2,
    /// Strength of the sheen at the most grazing angle (0..1).
    pub sheen: f32,
}

impl From<&Fabric> for ClothAppearance {
    fn from(fabric: &Fabric) -> Self {
        let [weft, warp] = fabric.threads_per_cm;
        Self { weave: fabric.weave, pitch: 0.01 / Vec2::new(weft, warp), sheen: fabric.sheen }
    }
}

/// Why a surface cannot be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// No surface has this number.
    #[error("there is no surface {surface}, only {count}; count them from 0")]
    Surface {
        /// The number asked for.
        surface: usize,
        /// Number of surfaces.
        count: usize,
    },
    /// A list has not as many entries as the surface has vertices.
    #[error("surface {surface} has {want} vertices but {got} {what} were given; give one for each vertex")]
    Length {
        /// Index of the surface.
        surface: usize,
        /// Name of the list.
        what: &'static str,
        /// Number of entries given.
        got: usize,
        /// Number of entries needed.
        want: usize,
    },
    /// A list of what belongs to triangles' corners has not as many entries as there are triangles.
    #[error("surface {surface} has {want} triangles but {got} {what} were given; give one for each triangle, or none")]
    Corners {
        /// Index of the surface.
        surface: usize,
        /// Name of the list.
        what: &'static str,
        /// Number of entries given.
        got: usize,
        /// Number of entries needed.
        want: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} of surface {surface} names a vertex beyond its {want}; leave it out")]
    Triangle {
        /// Index of the surface.
        surface: usize,
        /// Index of the triangle.
        triangle: usize,
        /// How many vertices there are.
        want: usize,
    },
    /// A triangle is none of those that a surface with a texture was made with.
    #[error("triangle {triangle} of surface {surface} is none that it was made with; choose among those")]
    Unknown {
        /// Index of the surface.
        surface: usize,
        /// Index of the triangle.
        triangle: usize,
    },
    /// A vertex position is not finite.
    #[error("vertex {vertex} of surface {surface} is not finite; the picture keeps the last places that were")]
    NotFinite {
        /// Index of the surface.
        surface: usize,
        /// The first such vertex.
        vertex: usize,
    },
    /// The surface's buffers belong to another device.
    #[error("surface {surface} lies on another graphics device than what draws it; open one device for both")]
    Device {
        /// Index of the surface.
        surface: usize,
    },
}

impl RenderSurface {
    /// A figure at rest.
    pub fn of_figure(figure: &Figure) -> Self {
        Self {
            rest: figure.rest.clone(),
            look: Some(figure.look.clone()),
            triangles: figure.triangles.clone(),
            colour: figure.colour,
            material: RenderMaterial::Skin,
        }
    }

    /// A garment as it is put on, in its fabric's colour and weave.
    pub fn of_garment(garment: &Garment) -> Self {
        Self {
            rest: garment.start.to_vec(),
            look: Some(GarmentLook::of(garment)),
            triangles: garment.triangles.to_vec(),
            colour: Vec3::from_array(garment.fabric.colour.map(linear)),
            material: RenderMaterial::Cloth((&garment.fabric).into()),
        }
    }

    /// Checks the lists against each other.
    ///
    /// # Errors
    /// [`ModelError::Length`], [`ModelError::Triangle`] or [`ModelError::NotFinite`].
    pub fn check(&self, surface: usize) -> Result<(), ModelError> {
        let want = self.rest.len();
        if let Some(vertex) = self.rest.iter().position(|p| !p.is_finite()) {
            return Err(ModelError::NotFinite { surface, vertex });
        }
        if let Some(look) = &self.look {
            let want = self.triangles.len();
            let lists =
                [("texture points", &look.corners), ("places on the cloth", &look.cloth), ("edges", &look.edges)];
            let mut lists = lists.into_iter();
            if let Some((what, list)) = lists.find(|(_, list)| !list.is_empty() && list.len() != want) {
                return Err(ModelError::Corners { surface, what, got: list.len(), want });
            }
        }
        check_triangles(surface, &self.triangles, want)
    }
}

/// Checks that every corner is a vertex.
pub(super) fn check_triangles(surface: usize, triangles: &[[u32; 3]], want: usize) -> Result<(), ModelError> {
    let beyond = |t: &[u32; 3]| t.iter().any(|&i| i as usize >= want);
    triangles.iter().position(beyond).map_or(Ok(()), |triangle| Err(ModelError::Triangle { surface, triangle, want }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_do_not_fit_together_are_refused_with_their_place() {
        let good = RenderSurface {
            rest: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            look: None,
            triangles: vec![[0, 1, 2]],
            colour: Vec3::ONE,
            material: RenderMaterial::Skin,
        };
        assert_eq!(good.check(0), Ok(()));
        let triangle = RenderSurface { triangles: vec![[0, 1, 2], [0, 1, 3]], ..good.clone() };
        assert_eq!(triangle.check(2), Err(ModelError::Triangle { surface: 2, triangle: 1, want: 3 }));
        let nowhere = RenderSurface { rest: vec![Vec3::ZERO, Vec3::NAN, Vec3::Y], ..good.clone() };
        assert_eq!(nowhere.check(1), Err(ModelError::NotFinite { surface: 1, vertex: 1 }));
        let look = GarmentLook { cloth: vec![[Vec2::ZERO; 3]; 2], ..GarmentLook::default() };
        let long = RenderSurface { look: Some(look), ..good };
        assert!(long.check(0).unwrap_err().to_string().contains("1 triangles but 2"));
    }
}
