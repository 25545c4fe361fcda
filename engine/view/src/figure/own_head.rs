//! A shopper's own head on a body: a drawn head that was adapted to them and its picture, brought to the size of the body's head.

use std::fmt::{self, Debug, Formatter};
use std::hint::black_box;

use glam::{Vec2, Vec3};
use toile_assets::body::base::BaseBody;
use toile_assets::body::shape::Shapes;
use toile_base::body::{Body, Region, Sex};
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Joint;
use toile_base::texture::Texture;

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
        self.overwrite();
    }
}

impl OwnHead {
    /// Its picture overwrites itself.
    fn overwrite(&mut self) {
        self.moved.fill(Vec3::ZERO);
        (self.skin, self.hair) = ([0; 3], [0; 3]);
        // Looked at, so that the compiler does not leave the writing out as unused.
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
            picture: TileLevels::of_person(frame.cut(&picture)),
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

#[cfg(test)]
mod tests {
    use toile_base::body::Measures;

    use super::super::{Appearance, Figure, Hair};
    use super::*;

    /// The drawn head of a sex, larger by a tenth to the sides, with a picture of one colour.
    fn wide(sex: Sex, rgb: [u8; 3]) -> OwnHead {
        let base = Shapes::of(sex).base();
        let widened = |(p, region): (&Vec3, &Region)| match region {
            Region::Head => Vec3::new(1.1 * p.x, p.y, p.z),
            _ => *p,
        };
        let rest: Vec<Vec3> = base.positions.iter().zip(&base.regions).map(widened).collect();
        let picture: Vec<u8> = (0..64 * 64).flat_map(|_| rgb).collect();
        OwnHead::new(sex, &rest, OwnHeadPicture { side: 64, rgb: &picture, skin: rgb, hair: [20, 30, 40] }).unwrap()
    }

    #[test]
    fn a_head_comes_to_the_size_of_the_bodys_and_leaves_the_body_as_it_is() {
        for sex in Sex::ALL {
            let mut measures = Measures::average(sex);
            measures.stature *= 1.1;
            let body = toile_assets::body::build(sex, &measures).unwrap();
            let own = wide(sex, [200, 150, 120]);
            let figure = Figure::with_head(&body, Appearance::default(), Some(&own));
            assert_eq!(figure.colour, own.skin());
            for (v, p) in body.mesh.positions.iter().enumerate() {
                let at = figure.rest[v];
                let expected = if body.regions[v] == Region::Head { Vec3::new(1.1 * p.x, p.y, p.z) } else { *p };
                // The drawn head is that of the mean body, whose sides are not quite in this one's proportion.
                assert!(at.distance(expected) < 1e-3, "{sex:?} {v}: {at} and not {expected}");
            }
            // The face has its picture, the body the base layer, and the hair its colour.
            let tile = figure.look.tile.as_ref().unwrap();
            let seen = |t: usize| tile.sample(figure.look.corners[t].iter().sum::<Vec2>() / 3.0, 0.0);
            let head = |t: &usize| body.mesh.triangles[*t].iter().all(|v| body.regions[*v as usize] == Region::Head);
            let face = (0..body.mesh.triangles.len()).find(head).unwrap();
            assert!((seen(face).truncate() - own.skin()).length() < 0.02 && seen(face).w > 0.99);
            let arm = (0..body.mesh.triangles.len())
                .find(|t| body.mesh.triangles[*t].iter().all(|v| body.regions[*v as usize] == Region::LeftArm));
            assert!(seen(arm.unwrap()).w < 0.01, "nothing is painted on an arm");
            let hair = seen(figure.triangles.len() - 1).truncate();
            let dark = Vec3::from_array([20_u8, 30, 40].map(|b| linear(f32::from(b) / 255.0)));
            assert!((hair - dark).length() < 0.01, "{hair}");
            assert!(figure.rest.len() > body.mesh.positions.len(), "it has hair where mannequins have none");
            let bun = Figure::with_head(&body, Appearance { hair: Hair::Bun, ..Appearance::default() }, Some(&own));
            assert_ne!(bun.rest.len(), figure.rest.len(), "and the shop's cut where they have some");
        }
    }

    #[test]
    fn a_head_of_another_drawing_is_not_put_on() {
        let body = toile_assets::body::build(Sex::Male, &Measures::average(Sex::Male)).unwrap();
        let plain = Figure::of(&body, Appearance::default());
        let own = wide(Sex::Female, [200, 150, 120]);
        for head in [None, Some(&own)] {
            assert_eq!(Figure::with_head(&body, Appearance::default(), head).rest, plain.rest);
        }
        assert!(
            OwnHead::new(
                Sex::Female,
                &body.mesh.positions[1..],
                OwnHeadPicture { side: 0, rgb: &[], skin: [0; 3], hair: [0; 3] }
            )
            .is_none()
        );
    }

    #[test]
    fn a_head_is_overwritten_and_in_no_debug_text() {
        let mut own = wide(Sex::Female, [200, 150, 120]);
        assert!(own.moved.iter().any(|way| *way != Vec3::ZERO));
        assert_eq!(format!("{own:?}"), "OwnHead");
        own.overwrite();
        assert!(own.moved.iter().all(|way| *way == Vec3::ZERO) && own.skin == [0; 3]);
    }
}
