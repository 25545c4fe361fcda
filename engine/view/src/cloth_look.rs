//! Appearance of cloth beyond its colour: its print, its seams and stitched hems, and its transparency.

use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, GarmentAppearance};
use toile_base::texture::Texture;

use crate::image::linear;
use crate::trim_look::{DrawnTrim, TrimmedPoint};

/// Half the width of the groove at a seam (m).
pub(crate) const SEAM_HALF_M: f32 = 0.001;

/// How much darker the groove is (0..1).
pub(crate) const SEAM_DARK: f32 = 0.42;

/// How far from the edge a hem is stitched (m).
pub(crate) const HEM_M: f32 = 0.018;

/// Half the width of a line of stitches (m).
pub(crate) const STITCH_HALF_M: f32 = 0.0006;

/// How much darker a line of stitches is (0..1).
pub(crate) const STITCH_DARK: f32 = 0.3;

/// A picture with its coarser levels, each half as wide and as high, down to one texel: what is seen from afar is the mean of
/// what is seen close by.
///
/// Copies share it.
#[derive(Clone, PartialEq)]
pub struct TileLevels {
    shared: Arc<SharedLevels>,
}

/// The levels of a picture.
#[derive(PartialEq)]
struct SharedLevels {
    levels: Vec<Texture>,
    /// Whether it shows a recognisable person: then it is overwritten when the last copy goes.
    of_person: bool,
}

impl SharedLevels {
    fn overwrite(&mut self) {
        self.levels.iter_mut().for_each(|level| level.texels.fill([0; 4]));
        // Looked at, so that the compiler does not leave the writing out as unused.
        std::hint::black_box(&self.levels);
    }
}

impl Drop for SharedLevels {
    fn drop(&mut self) {
        if self.of_person {
            self.overwrite();
        }
    }
}

impl Debug for TileLevels {
    /// Its sizes, and nothing that it shows.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let finest = &self.levels()[0];
        write!(f, "TileLevels({} x {}, {} levels)", finest.width, finest.height, self.levels().len())
    }
}

impl TileLevels {
    /// All levels of a picture.
    pub fn of(texture: &Texture) -> Self {
        Self::new(texture.clone(), false)
    }

    /// All levels of a picture of a recognisable person: its memory is overwritten when the last copy goes.
    pub fn of_person(texture: Texture) -> Self {
        Self::new(texture, true)
    }

    fn new(texture: Texture, of_person: bool) -> Self {
        let mut levels = vec![texture];
        while let Some(next) = coarser(&levels[levels.len() - 1]) {
            levels.push(next);
        }
        Self { shared: Arc::new(SharedLevels { levels, of_person }) }
    }

    /// The levels, the finest first.
    pub fn levels(&self) -> &[Texture] {
        &self.shared.levels
    }

    /// Colour (linear RGB) and how much of the ground it covers at a texture point (v upwards), seen by a pixel so wide there
    /// (texture units).
    pub fn sample(&self, at: Vec2, pixel: f32) -> Vec4 {
        let levels = self.levels();
        let finest = &levels[0];
        let texels = pixel * finest.width.max(finest.height) as f32;
        let level = texels.max(1.0).log2().min((levels.len() - 1) as f32);
        let near = bilinear(&levels[level as usize], at);
        let part = level.fract();
        if part == 0.0 { near } else { near.lerp(bilinear(&levels[level as usize + 1], at), part) }
    }
}

/// A texel in linear light, its colour times what it covers.
fn premultiplied([r, g, b, a]: [u8; 4]) -> Vec4 {
    let cover = f32::from(a) / 255.0;
    (Vec3::new(channel(r), channel(g), channel(b)) * cover).extend(cover)
}

fn channel(byte: u8) -> f32 {
    linear(f32::from(byte) / 255.0)
}

fn coarser(fine: &Texture) -> Option<Texture> {
    if fine.width == 1 && fine.height == 1 {
        return None;
    }
    let (width, height) = ((fine.width / 2).max(1), (fine.height / 2).max(1));
    let texel = |x: u32, y: u32| fine.texels[(y.min(fine.height - 1) * fine.width + x.min(fine.width - 1)) as usize];
    let at = |x: u32, y: u32| premultiplied(texel(x, y));
    let straight = |x: u32, y: u32| {
        let [r, g, b, _] = texel(x, y).map(channel);
        Vec3::new(r, g, b)
    };
    let mean_texel = |i: u32| {
        let (x, y) = (2 * (i % width), 2 * (i / width));
        let mean = (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) * 0.25;
        // What covers nothing keeps its colour: filters mix it into its neighbours.
        let bare = || (straight(x, y) + straight(x + 1, y) + straight(x, y + 1) + straight(x + 1, y + 1)) * 0.25;
        let colour = if mean.w > 0.0 { mean.truncate() / mean.w } else { bare() };
        let [r, g, b] = colour.to_array().map(encoded);
        [r, g, b, (mean.w * 255.0).round() as u8]
    };
    Some(Texture { width, height, texels: (0..width * height).map(mean_texel).collect() })
}

/// A linear value as an sRGB byte.
fn encoded(value: f32) -> u8 {
    let srgb = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
    (srgb.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Between the four texels around a point; the picture repeats.
fn bilinear(texture: &Texture, at: Vec2) -> Vec4 {
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let place = Vec2::new(at.x, 1.0 - at.y) * size - 0.5;
    let (low, part) = (place.floor(), place - place.floor());
    let texel = |dx: f32, dy: f32| {
        let x = (low.x + dx).rem_euclid(size.x) as u32;
        let y = (low.y + dy).rem_euclid(size.y) as u32;
        premultiplied(texture.texels[(y.min(texture.height - 1) * texture.width + x.min(texture.width - 1)) as usize])
    };
    let upper = texel(0.0, 0.0).lerp(texel(1.0, 0.0), part.x);
    let lower = texel(0.0, 1.0).lerp(texel(1.0, 1.0), part.x);
    upper.lerp(lower, part.y)
}

/// What a garment shows, made once: its picture with all levels, and where its triangles lie in it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GarmentLook {
    /// The print of its fabric, or the picture of its mesh.
    pub tile: Option<TileLevels>,
    /// Texture points of the corners of each triangle `[triangles]`, or empty.
    pub corners: Vec<[Vec2; 3]>,
    /// Positions on the cloth (m): weft along x, warp along y `[triangles]`, or empty.
    pub cloth: Vec<[Vec2; 3]>,
    /// Distance of each corner from the nearest hem and seam (m) `[triangles]`, or empty.
    pub edges: Vec<[Vec2; 3]>,
    /// Its trims.
    pub trims: Vec<DrawnTrim>,
    /// Trims that each triangle may show, a bit for each `[triangles]`, or empty.
    pub near: Vec<u32>,
    /// Share of light that the cloth holds back (0..1).
    pub opacity: f32,
}

/// Attributes of the drawn triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DrawnLook {
    corners: Vec<[Vec2; 3]>,
    cloth: Vec<[Vec2; 3]>,
    edges: Vec<[Vec2; 3]>,
    near: Vec<u32>,
}

impl GarmentLook {
    /// Of a garment.
    pub fn of(garment: &Garment) -> Self {
        Self::new(&garment.look, &garment.fabric)
    }

    /// Of a look in a fabric: a picture that a mesh brings goes before the fabric's print.
    pub fn new(look: &GarmentAppearance, fabric: &Fabric) -> Self {
        let edges = look.edges.to_vec();
        let (tile, corners) = match (&look.picture, &fabric.tile, &fabric.print) {
            (Some(picture), ..) => (Some(TileLevels::of(&picture.texture)), picture.corners.to_vec()),
            (None, Some(tile), Some(print)) if !look.cloth.is_empty() => {
                let repeat = print.repeat();
                (Some(TileLevels::of(tile)), look.cloth.iter().map(|t| t.map(|p| p / repeat)).collect())
            }
            _ => (None, Vec::new()),
        };
        let trims = look.trims.iter().map(DrawnTrim::of).collect();
        let (cloth, near) = (look.cloth.to_vec(), look.near.to_vec());
        Self { tile, corners, cloth, edges, trims, near, opacity: fabric.opacity }
    }

    /// As rays meet it, with all of its triangles.
    pub fn shown(&self) -> ClothLook<'_> {
        let Self { tile, corners, cloth, edges, trims, near, opacity } = self;
        ClothLook { tile: tile.as_ref(), corners, cloth, edges, trims, near, opacity: *opacity }
    }

    /// Attributes of some of the triangles.
    pub fn of_triangles(&self, kept: &[u32]) -> DrawnLook {
        fn pick<T: Copy>(all: &[T], kept: &[u32]) -> Vec<T> {
            if all.is_empty() { Vec::new() } else { kept.iter().map(|t| all[*t as usize]).collect() }
        }
        let of = |all: &[[Vec2; 3]]| pick(all, kept);
        let (corners, edges) = (of(&self.corners), of(&self.edges));
        // Trims alone ask where a point lies on the cloth.
        let cloth = if self.trims.is_empty() { Vec::new() } else { of(&self.cloth) };
        DrawnLook { corners, cloth, edges, near: pick(&self.near, kept) }
    }

    /// Attributes of all triangles.
    pub fn all(&self) -> DrawnLook {
        let Self { corners, cloth, edges, near, .. } = self.clone();
        DrawnLook { corners, cloth, edges, near }
    }

    /// As rays meet it, with the triangles that are drawn.
    pub fn shown_with<'a>(&'a self, drawn: &'a DrawnLook) -> ClothLook<'a> {
        let DrawnLook { corners, cloth, edges, near } = drawn;
        ClothLook { corners, cloth, edges, near, ..self.shown() }
    }
}

/// The cloth of a surface, as rays meet it.
#[derive(Debug, Clone, Copy)]
pub struct ClothLook<'a> {
    /// The picture on it.
    pub tile: Option<&'a TileLevels>,
    /// Texture points of the corners of each triangle `[triangles]`, or empty.
    pub corners: &'a [[Vec2; 3]],
    /// Positions on the cloth (m) `[triangles]`, or empty.
    pub cloth: &'a [[Vec2; 3]],
    /// Distance of each corner from the nearest hem and seam (m) `[triangles]`, or empty.
    pub edges: &'a [[Vec2; 3]],
    /// Its trims.
    pub trims: &'a [DrawnTrim],
    /// Trims that each triangle may show, a bit for each `[triangles]`, or empty.
    pub near: &'a [u32],
    /// Share of light that the cloth holds back (0..1).
    pub opacity: f32,
}

impl ClothLook<'_> {
    /// The colour at a point of a triangle whose ground is `base` (linear RGB). `size` is how long its sides are (m, the root of
    /// twice its area), `pixel` how wide a pixel is there (m).
    pub(crate) fn colour(&self, triangle: usize, weights: [f32; 3], base: Vec3, size: f32, pixel: f32) -> Vec3 {
        let blend = |c: &[Vec2; 3]| c[0] * weights[0] + c[1] * weights[1] + c[2] * weights[2];
        let mut colour = base;
        if let (Some(tile), Some(corners)) = (self.tile, self.corners.get(triangle)) {
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
            let texel = tile.sample(blend(corners), pixel * area.sqrt() / size.max(1e-9));
            colour = base * (1.0 - texel.w) + texel.truncate();
        }
        let near = self.near.get(triangle).copied().unwrap_or(0);
        let trims = || self.trims.iter().enumerate().filter(move |(i, _)| near >> i & 1 == 1).map(|(_, trim)| *trim);
        let point = self.cloth.get(triangle).filter(|_| near != 0).map(|c| TrimmedPoint::new(blend(c), pixel));
        if let Some(edges) = self.edges.get(triangle) {
            let covered = point.map_or(0.0, |p| p.covered(trims()));
            colour *= covered + (1.0 - covered) * sewn(blend(edges), pixel);
        }
        point.map_or(colour, |p| trims().fold(colour, |colour, trim| p.with(&trim, colour)))
    }
}

/// How much of the light the groove of a seam and a line of stitches leave, seen by a pixel so wide (m).
fn sewn(far: Vec2, pixel: f32) -> f32 {
    let line = |distance: f32, half: f32| {
        // Most of a garment is far from any seam.
        if distance >= half + 0.5 * pixel {
            return 0.0;
        }
        let seen = ((half + 0.5 * pixel - distance) / pixel.max(1e-6)).clamp(0.0, 1.0);
        seen * (2.0 * half / pixel.max(1e-6)).min(1.0)
    };
    let seam = SEAM_DARK * line(far.y, SEAM_HALF_M);
    let stitch = STITCH_DARK * line((far.x - HEM_M).abs(), STITCH_HALF_M);
    (1.0 - seam) * (1.0 - stitch)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checks(side: u32) -> Texture {
        let texel = |i: u32| if (i % side + i / side).is_multiple_of(2) { [255, 0, 0, 255] } else { [0, 0, 0, 0] };
        Texture { width: side, height: side, texels: (0..side * side).map(texel).collect() }
    }

    #[test]
    fn from_afar_a_picture_is_its_mean() {
        let tile = TileLevels::of(&checks(16));
        assert_eq!(tile.levels().len(), 5);
        let far = tile.sample(Vec2::new(0.3, 0.9), 4.0);
        assert!((far - Vec4::new(0.5, 0.0, 0.0, 0.5)).abs().max_element() < 0.01, "{far}");
        // In the middle of a texel it is that texel, on every repetition; the first row is the uppermost.
        let texel = |x: f32, y: f32| tile.sample(Vec2::new((x + 0.5) / 16.0, 1.0 - (y + 0.5) / 16.0), 0.0);
        assert_eq!((texel(0.0, 0.0).w, texel(1.0, 0.0).w, texel(17.0, 16.0).w), (1.0, 0.0, 0.0));
    }

    #[test]
    fn pictures_of_persons_are_overwritten_and_never_printed() {
        let TileLevels { shared } = TileLevels::of_person(checks(16));
        assert_eq!(format!("{:?}", TileLevels { shared: shared.clone() }), "TileLevels(16 x 16, 5 levels)");
        assert!(shared.of_person && !TileLevels::of(&checks(2)).shared.of_person);
        let mut levels = Arc::into_inner(shared).expect("copies share one, and the other is gone");
        levels.overwrite();
        assert!(levels.levels.iter().flat_map(|level| &level.texels).all(|texel| *texel == [0; 4]));
    }

    #[test]
    fn seams_and_stitches_are_lines_that_thin_out_from_afar() {
        let open = Vec2::splat(0.06);
        assert_eq!(sewn(open, 0.001), 1.0);
        assert!((sewn(Vec2::new(0.06, 0.0), 0.0005) - (1.0 - SEAM_DARK)).abs() < 1e-6);
        assert!((sewn(Vec2::new(HEM_M, 0.06), 0.0005) - (1.0 - STITCH_DARK)).abs() < 1e-6);
        // A pixel of 20 mm sees a tenth of the darkness at most.
        assert!(sewn(Vec2::new(0.06, 0.0), 0.02) > 1.0 - 0.11 * SEAM_DARK);
    }
}
