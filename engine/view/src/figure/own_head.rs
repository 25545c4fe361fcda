//! A shopper's own head on a body: a drawn head that was adapted to them and its picture, brought to the size of the body's head.

use std::fmt::{self, Debug, Formatter};
use std::hint::black_box;

use glam::{Vec2, Vec3};
use toile_assets::body::base::BaseBody;
use toile_assets::body::shape::Shapes;
use toile_assets::body::{Body, Region, Sex};
use toile_assets::mesh::vertex_normals;
use toile_assets::skeleton::Joint;
use toile_assets::texture::Texture;

use super::head_space::HeadSpace;
use crate::base_layer::{self, HAIR_AT};
use crate::cloth_look::{GarmentLook, TileLevels};
use crate::image::linear;

/// Side of the picture (texels): a face fills some 500 of them, and no camera of a kiosk sees as many pixels of one.
const SIDE: usize = 1_024;

/// Rows above, whose first half is the base layer's edge. With so many it is seen unmixed where a pixel is 16 mm wide, farther off than
/// any shopper stands.
const EDGE: usize = 64;

/// Texels left free around the head's part, so that its coarser levels do not mix with the other side.
const FREE: usize = 8;

/// The picture of a head in the body's atlas.
#[derive(Clone, Copy)]
pub struct OwnHeadPicture<'a> {
    /// Texels along a side of the atlas.
    pub side: usize,
    /// Red, green, blue (sRGB), rows from the top `[3 x side x side]`.
    pub rgb: &'a [u8],
    /// Colour of the skin (sRGB).
    pub skin: [u8; 3],
    /// Colour of the hair (sRGB).
    pub hair: [u8; 3],
}

/// A shopper's own head. Its memory is overwritten when it goes.
pub struct OwnHead {
    sex: Sex,
    /// How far each vertex is from where it is drawn, in the head's space (mm) `[vertices]`.
    moved: Vec<Vec3>,
    /// The head's picture, and the base layer's edge above it.
    picture: TileLevels,
    /// Texture points of the head's triangles `[triangles]`; none of others.
    corners: Vec<Option<[Vec2; 3]>>,
    skin: [u8; 3],
    hair: [u8; 3],
}

impl Debug for OwnHead {
    /// Nothing of it.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("OwnHead")
    }
}

impl Drop for OwnHead {
    fn drop(&mut self) {
        self.moved.fill(Vec3::ZERO);
        (self.skin, self.hair) = ([0; 3], [0; 3]);
        // Looked at, so that the writing is not left out as one that nobody sees.
        black_box((&self.moved, &self.skin, &self.hair));
    }
}

impl OwnHead {
    /// Of the drawn body of a sex with an adapted head (m) `[vertices]`, and its picture. Takes 60 ms.
    ///
    /// None where the vertices are not those of the drawn body, or the picture is not as large as it says.
    pub fn new(sex: Sex, rest: &[Vec3], picture: OwnHeadPicture<'_>) -> Option<Self> {
        let base = Shapes::of(sex).base();
        let space = HeadSpace::around(&base.positions, &base.regions, base.skeleton.at(Joint::Head))?;
        if rest.len() != base.positions.len() || picture.rgb.len() != 3 * picture.side * picture.side {
            return None;
        }
        let pairs = rest.iter().zip(&base.positions);
        let frame = AtlasFrame::of(base);
        Some(Self {
            sex,
            moved: pairs.map(|(own, drawn)| space.inwards(*own) - space.inwards(*drawn)).collect(),
            picture: TileLevels::of_somebody(frame.cut(&picture)),
            corners: head_corners(base).map(|t| t.map(|t| t.map(|uv| frame.point(uv)))).collect(),
            skin: picture.skin,
            hair: picture.hair,
        })
    }

    /// Whose drawing it was adapted from.
    pub const fn sex(&self) -> Sex {
        self.sex
    }

    pub(super) fn hair(&self) -> [u8; 3] {
        self.hair
    }

    /// Linear RGB of the skin.
    pub(super) fn skin(&self) -> Vec3 {
        Vec3::from_array(self.skin.map(|b| linear(f32::from(b) / 255.0)))
    }

    /// Where in the picture the hair's colour is.
    pub(super) fn hair_at(&self) -> Vec2 {
        on_edge(HAIR_AT)
    }

    /// Vertices (m) and unit normals of a drawn body with this head.
    pub(super) fn on(&self, body: &Body, space: &HeadSpace) -> (Vec<Vec3>, Vec<Vec3>) {
        let moved = |(p, way): (&Vec3, &Vec3)| match *way {
            Vec3::ZERO => *p,
            way => space.outwards(space.inwards(*p) + way),
        };
        let rest: Vec<Vec3> = body.mesh.positions.iter().zip(&self.moved).map(moved).collect();
        let mut normals = vec![Vec3::ZERO; rest.len()];
        vertex_normals(&rest, &body.mesh.triangles, &mut normals);
        // Below the neck they are the body's own, which snapshots have too.
        let kept = normals.iter_mut().zip(&body.normals).zip(&self.moved);
        kept.filter(|(_, way)| **way == Vec3::ZERO).for_each(|((to, own), _)| *to = *own);
        (rest, normals)
    }

    /// A base layer's look with this head's picture.
    pub(super) fn look(&self, base_layer: GarmentLook) -> GarmentLook {
        let corners = base_layer.corners.iter().zip(&self.corners);
        let corners = corners.map(|(edge, own)| own.unwrap_or_else(|| edge.map(on_edge))).collect();
        GarmentLook { tile: Some(self.picture.clone()), corners, ..base_layer }
    }
}

/// A point of the base layer's picture, which is one row, in that row of this one.
fn on_edge(at: Vec2) -> Vec2 {
    Vec2::new(0.5 * at.x, 1.0 - 0.25 * EDGE as f32 / SIDE as f32)
}

/// The texture points of the triangles of the head; none of others.
fn head_corners(base: &BaseBody) -> impl Iterator<Item = Option<[Vec2; 3]>> + '_ {
    let is_head = |t: &[u32; 3]| t.iter().all(|v| base.regions[*v as usize] == Region::Head);
    let of = move |(t, corners): (&[u32; 3], [u32; 3])| is_head(t).then(|| corners.map(|k| base.uvs[k as usize]));
    base.triangles.iter().zip(base.triangle_corners()).map(of)
}

/// The part of the atlas that has the head.
struct AtlasFrame {
    /// Its corner, and its size (texture units, v upwards).
    low: Vec2,
    size: Vec2,
}

impl AtlasFrame {
    fn of(base: &BaseBody) -> Self {
        let points = || head_corners(base).flatten().flatten();
        let low = points().fold(Vec2::INFINITY, Vec2::min);
        let high = points().fold(Vec2::NEG_INFINITY, Vec2::max);
        Self { low, size: (high - low).max(Vec2::splat(1e-6)) }
    }

    /// Width and height of the part in this picture (texels).
    fn room() -> Vec2 {
        Vec2::new((SIDE - 2 * FREE) as f32, (SIDE - EDGE - 2 * FREE) as f32)
    }

    /// A point of the atlas in this picture.
    fn point(&self, uv: Vec2) -> Vec2 {
        ((uv - self.low) / self.size * Self::room() + FREE as f32) / SIDE as f32
    }

    /// The part, between the atlas's texels; the skin's colour around it, and nothing where the base layer's edge comes.
    fn cut(&self, picture: &OwnHeadPicture<'_>) -> Texture {
        let (room, edge) = (Self::room(), base_layer::edge(picture.hair));
        let texel = |at: usize| {
            let (x, y) = (at % SIDE, at / SIDE);
            if y < EDGE {
                let [r, g, b] = picture.skin;
                return edge.texels.get(x).copied().filter(|_| y < EDGE / 2).unwrap_or([r, g, b, 0]);
            }
            let up = Vec2::new(x as f32 + 0.5, (SIDE - y) as f32 - 0.5) - FREE as f32;
            let uv = self.low + (up / room).clamp(Vec2::ZERO, Vec2::ONE) * self.size;
            let [r, g, b] = sample(picture, Vec2::new(uv.x, 1.0 - uv.y) * picture.side as f32 - 0.5);
            [r, g, b, 255]
        };
        Texture { width: SIDE as u32, height: SIDE as u32, texels: (0..SIDE * SIDE).map(texel).collect() }
    }
}

/// Between the four texels around a place.
fn sample(picture: &OwnHeadPicture<'_>, at: Vec2) -> [u8; 3] {
    let most = picture.side as f32 - 1.0;
    let at = at.clamp(Vec2::ZERO, Vec2::splat(most));
    let (low, part) = (at.floor(), at - at.floor());
    let next = (low + 1.0).min(Vec2::splat(most));
    let texel = |x: f32, y: f32, k: usize| f32::from(picture.rgb[3 * (y as usize * picture.side + x as usize) + k]);
    std::array::from_fn(|k| {
        let upper = texel(low.x, low.y, k) * (1.0 - part.x) + texel(next.x, low.y, k) * part.x;
        let lower = texel(low.x, next.y, k) * (1.0 - part.x) + texel(next.x, next.y, k) * part.x;
        (upper * (1.0 - part.y) + lower * part.y).round() as u8
    })
}
