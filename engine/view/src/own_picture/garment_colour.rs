//! The colour of cloth at a pixel: its print, seams and what is sewn on, from the same look that the other renderers draw, with the print
//! in linear light beforehand.

use glam::{Vec2, Vec3, Vec4};
use toile_assets::garment::Garment;
use toile_assets::texture::Texture;

use crate::cloth_look::GarmentLook;
use crate::image::linear;

/// One level of a print.
#[derive(Debug, Clone, PartialEq)]
struct Level {
    size: [u32; 2],
    /// Linear RGB times what it covers, and what it covers, rows from the top.
    texels: Vec<Vec4>,
}

/// How a garment looks.
#[derive(Debug, Clone, PartialEq)]
pub struct ClothColour {
    /// Colour of the ground, linear RGB.
    pub ground: Vec3,
    look: GarmentLook,
    print: Vec<Level>,
}

impl ClothColour {
    /// Of a garment. It allocates.
    pub fn of(garment: &Garment) -> Self {
        let look = GarmentLook::of(garment);
        let decoded: Vec<f32> = (0..=255_u8).map(|byte| linear(f32::from(byte) / 255.0)).collect();
        let level = |texture: &Texture| {
            let texel = |t: &[u8; 4]| {
                let cover = f32::from(t[3]) / 255.0;
                let [r, g, b] = [t[0], t[1], t[2]].map(|byte| decoded[usize::from(byte)]);
                (Vec3::new(r, g, b) * cover).extend(cover)
            };
            Level { size: [texture.width, texture.height], texels: texture.texels.iter().map(texel).collect() }
        };
        let print = look.tile.iter().flat_map(|tile| tile.levels()).map(level).collect();
        Self { ground: Vec3::from_array(garment.fabric.colour.map(linear)), look, print }
    }

    /// Share of light that the cloth holds back (0..1).
    pub fn opacity(&self) -> f32 {
        self.look.opacity
    }

    /// The colour (linear RGB) at weights of a triangle's corners, of a ground. `size` is how long its sides are (m, the root of twice its area),
    /// `pixel` how wide a pixel is there (m).
    pub fn at(&self, triangle: usize, weights: [f32; 3], mut ground: Vec3, [size, pixel]: [f32; 2]) -> Vec3 {
        if let Some(corners) = self.look.corners.get(triangle).filter(|_| !self.print.is_empty()) {
            let at = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
            let texel = self.texel(at, pixel * area.sqrt() / size.max(1e-9));
            ground = ground * (1.0 - texel.w) + texel.truncate();
        }
        let plain = crate::cloth_look::ClothLook { tile: None, ..self.look.shown() };
        plain.colour(triangle, weights, ground, size, pixel)
    }

    /// Between four texels of the level whose texels are as wide as a pixel.
    fn texel(&self, at: Vec2, pixel: f32) -> Vec4 {
        let [width, height] = self.print[0].size;
        let texels = pixel * width.max(height) as f32;
        let number = (texels.max(1.0).log2() + 0.5) as usize;
        let Level { size: [w, h], texels } = &self.print[number.min(self.print.len() - 1)];
        let place = Vec2::new(at.x, 1.0 - at.y) * Vec2::new(*w as f32, *h as f32) - 0.5;
        let (low, part) = (place.floor(), place - place.floor());
        let wrap = |x: f32, n: u32| x.rem_euclid(n as f32) as usize % n as usize;
        let of = |dx: f32, dy: f32| texels[wrap(low.y + dy, *h) * *w as usize + wrap(low.x + dx, *w)];
        of(0.0, 0.0).lerp(of(1.0, 0.0), part.x).lerp(of(0.0, 1.0).lerp(of(1.0, 1.0), part.x), part.y)
    }
}
