//! How a garment shows its cloth: where each triangle lies on the fabric, how far from hems and seams, and a mesh's picture.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec2;

use super::shape::{Painted, Shape};
use crate::pattern::{ClothTrim, MAX_TRIMS};
use crate::texture::{Atlas, Texture};

/// Farther from a hem or a seam nothing of either is seen (m).
pub const EDGE_REACH_M: f32 = 0.06;

/// What pictures need of a garment beside its places; all of it is empty for one that shows its fabric's colour alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Look {
    /// Where the corners of each triangle lie on the cloth (m): weft along x, warp along y, up the garment `[triangles]`; or
    /// empty, where no pattern says it.
    pub cloth: Box<[[Vec2; 3]]>,
    /// How far the corners of each triangle are from the nearest hem (x) and the nearest seam (y), [`EDGE_REACH_M`] at most
    /// (m) `[triangles]`; empty where `cloth` is.
    pub edges: Box<[[Vec2; 3]]>,
    /// What is put on the cloth: buttons, edges, strips, at most [`MAX_TRIMS`].
    pub trims: Box<[ClothTrim]>,
    /// Which of them each triangle may show, a bit for each `[triangles]`; empty where there are none.
    pub near: Box<[u32]>,
    /// The picture that a mesh brings.
    pub picture: Option<MeshPicture>,
}

/// A picture on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPicture {
    /// The picture.
    pub texture: Arc<Texture>,
    /// Where the corners of each triangle lie in it: 0 to 1 across, v upwards `[triangles]`.
    pub corners: Box<[[Vec2; 3]]>,
}

impl Look {
    /// Of a shape as drafted or imported.
    pub fn of(shape: &Shape) -> Self {
        let (cloth, edges) = if shape.flat.len() == shape.faces.len() && !shape.panels.is_empty() {
            let cloth = shape.corners(&shape.flat);
            let edges = edges(shape, &cloth);
            (cloth, edges)
        } else {
            Default::default()
        };
        let trims: Box<[ClothTrim]> =
            if cloth.is_empty() { Box::default() } else { shape.trims.iter().copied().take(MAX_TRIMS).collect() };
        let near = if trims.is_empty() { Box::default() } else { near(shape, &cloth, &trims) };
        Self { cloth: cloth.into(), edges: edges.into(), trims, near, picture: picture(shape) }
    }

    /// Bytes that it takes, without the picture, which garments share.
    pub fn bytes(&self) -> usize {
        let corners = self.picture.as_ref().map_or(0, |p| size_of_val(&*p.corners));
        let trims = size_of_val(&*self.trims) + size_of_val(&*self.near);
        size_of_val(&*self.cloth) + size_of_val(&*self.edges) + trims + corners
    }
}

fn picture(shape: &Shape) -> Option<MeshPicture> {
    let Painted { pictures, of_face } = shape.painted.as_ref()?;
    if shape.uvs.len() != shape.faces.len() || of_face.len() != shape.faces.len() {
        return None;
    }
    // What no material paints shows the fabric: a picture that covers nothing.
    let bare = of_face.contains(&0);
    let nothing = bare.then(|| Arc::new(Texture { width: 1, height: 1, texels: vec![[0; 4]] }));
    let all: Vec<Arc<Texture>> = nothing.into_iter().chain(pictures.iter().cloned()).collect();
    let atlas = Atlas::of(&all)?;
    let number: Vec<[u8; 4]> = of_face.iter().map(|k| [if bare { *k } else { k - 1 }; 4]).collect();
    let corners = shape.corners(&shape.uvs);
    let placed = corners.into_iter().zip(shape.corners(&number)).map(|(uvs, [k, ..])| atlas.place(usize::from(k), uvs));
    Some(MeshPicture { corners: placed.collect(), texture: atlas.texture })
}

/// The hems and the seams of a panel, as pieces of line in its plane (m).
#[derive(Default)]
struct PanelEdges {
    hems: Vec<[Vec2; 2]>,
    seams: Vec<[Vec2; 2]>,
}

/// Panel of each triangle.
fn panels(shape: &Shape) -> Vec<u32> {
    let numbers: Vec<[u32; 4]> = shape.panels.iter().map(|p| [*p; 4]).collect();
    shape.corners(&numbers).into_iter().map(|p| p[0]).collect()
}

/// How far beyond its own width a trim casts a shadow (m).
pub const TRIM_SHADOW_M: f32 = 0.006;

/// Which trims each triangle may show.
fn near(shape: &Shape, cloth: &[[Vec2; 3]], trims: &[ClothTrim]) -> Box<[u32]> {
    let touches = |corners: &[Vec2; 3], trim: &ClothTrim| {
        let reach = trim.half + TRIM_SHADOW_M;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners.iter().fold(0.0, |r: f32, p| r.max(p.distance(middle)));
        off_line(middle, trim.ends) < radius + reach
    };
    let word = |(corners, panel): (&[Vec2; 3], u32)| {
        let on = trims.iter().enumerate().filter(|(_, trim)| trim.panel == panel && touches(corners, trim));
        on.fold(0, |word, (i, _)| word | 1 << i)
    };
    cloth.iter().zip(panels(shape)).map(word).collect()
}

/// Distance of every corner from hems and seams of its panel.
fn edges(shape: &Shape, cloth: &[[Vec2; 3]]) -> Vec<[Vec2; 3]> {
    let triangles = shape.triangles();
    let panels = panels(shape);
    // Every side of a triangle: the panels on both sides of it, and where it lies in each.
    let mut sides: HashMap<[u32; 2], Vec<(u32, [Vec2; 2])>> = HashMap::new();
    for ((t, flat), panel) in triangles.iter().zip(cloth).zip(&panels) {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let ends = if a < b { [flat[k], flat[(k + 1) % 3]] } else { [flat[(k + 1) % 3], flat[k]] };
            sides.entry([a.min(b), a.max(b)]).or_default().push((*panel, ends));
        }
    }
    let mut of: HashMap<u32, PanelEdges> = HashMap::new();
    for side in sides.values() {
        let apart = |(panel, ends): &(u32, [Vec2; 2])| {
            let same = ends[0].distance(side[0].1[0]) + ends[1].distance(side[0].1[1]) < SAME_M;
            *panel != side[0].0 || !same
        };
        let sewn = side.iter().any(apart);
        for (panel, ends) in side {
            let own = of.entry(*panel).or_default();
            match (side.len(), sewn) {
                (1, _) => own.hems.push(*ends),
                (_, true) => own.seams.push(*ends),
                _ => {}
            }
        }
    }
    let none = PanelEdges::default();
    let far = |lines: &[[Vec2; 2]], p: Vec2| lines.iter().map(|l| off_line(p, *l)).fold(EDGE_REACH_M, f32::min);
    let corner = |(flat, panel): (&[Vec2; 3], &u32)| {
        let own = of.get(panel).unwrap_or(&none);
        let mut at = flat.map(|p| Vec2::new(far(&own.hems, p), far(&own.seams, p)));
        // A triangle with all corners on seams has no inside to tell them from.
        if at.iter().all(|d| d.y < SAME_M) {
            at.iter_mut().for_each(|d| d.y = EDGE_REACH_M);
        }
        if at.iter().all(|d| d.x < SAME_M) {
            at.iter_mut().for_each(|d| d.x = EDGE_REACH_M);
        }
        at
    };
    cloth.iter().zip(&panels).map(corner).collect()
}

/// Points of the plane that are nearer than this are one (m).
const SAME_M: f32 = 1e-4;

/// Distance of a point from a piece of line.
fn off_line(p: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::garment::shape::{NO_VERTEX, Part};

    /// Two squares of 40 mm side by side, sewn along the side that they share, each drawn at an origin of its own.
    fn sewn() -> Shape {
        let mut shape = Shape::default();
        for at in [[0.0, 0.0], [0.04, 0.0], [0.08, 0.0], [0.0, 0.04], [0.04, 0.04], [0.08, 0.04]] {
            let at = Vec3::new(at[0], at[1], 0.0);
            shape.push(at, at, false, Part::All);
        }
        shape.faces = vec![[0, 1, 4, 3], [1, 2, 5, 4]];
        let square = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.0, 0.04]].map(Vec2::from);
        shape.flat = vec![square, square];
        shape.panels = vec![0, 1];
        shape
    }

    #[test]
    fn seams_and_hems_are_told_apart() {
        let look = Look::of(&sewn());
        assert_eq!((look.cloth.len(), look.edges.len()), (4, 4));
        for (triangle, (places, edges)) in look.cloth.iter().zip(&look.edges).enumerate() {
            for (p, far) in places.iter().zip(edges) {
                let seam = if triangle < 2 { 0.04 - p.x } else { p.x };
                assert!((far.y - seam).abs() < 1e-6, "triangle {triangle} at {p}: {far}");
            }
        }
        // All corners of these squares lie on the outline.
        assert!(look.edges.iter().flatten().all(|far| far.x == EDGE_REACH_M));
    }

    #[test]
    fn triangles_know_the_trims_of_their_own_panel_near_them() {
        let mut shape = sewn();
        let button = |panel, x| ClothTrim {
            panel,
            kind: crate::pattern::TrimKind::Button,
            ends: [Vec2::new(x, 0.02); 2],
            half: 0.005,
            colour: [1.0; 3],
        };
        shape.trims = vec![button(0, 0.02), button(1, 0.02), button(1, 0.5)];
        assert_eq!(*Look::of(&shape).near, [1, 1, 2, 2]);
        shape.flat.clear();
        assert_eq!(Look::of(&shape).trims.len(), 0, "without flat panels nothing says where they are");
    }

    #[test]
    fn a_mesh_shows_its_pictures_and_its_fabric_where_it_has_none() {
        let mut shape = sewn();
        (shape.flat, shape.panels) = (Vec::new(), Vec::new());
        shape.faces[1] = [1, 2, 5, NO_VERTEX];
        shape.uvs = vec![[Vec2::splat(0.5); 4]; 2];
        assert_eq!(Look::of(&shape), Look::default());
        shape.painted = Some(Painted { pictures: vec![Arc::new(Texture::plain([9, 8, 7]))], of_face: vec![1, 0] });
        let picture = Look::of(&shape).picture.unwrap();
        assert_eq!(picture.corners.len(), 3);
        let texel = |uv: Vec2| {
            let at = uv * picture.texture.width as f32;
            picture.texture.texels
                [(picture.texture.width - 1 - at.y as u32) as usize * picture.texture.width as usize + at.x as usize]
        };
        assert_eq!(texel(picture.corners[0][0]), [9, 8, 7, 255]);
        assert_eq!(texel(picture.corners[2][0])[3], 0, "the fabric's own colour");
    }
}
