//! The colour of cloth at a pixel: its print, seams and what is sewn on, from the same look that the other renderers draw, with the print
//! in linear light beforehand.

use glam::{Vec2, Vec3, Vec4};
use toile_base::garment::Garment;
use toile_base::texture::Texture;

use crate::cloth_look::{ClothLook, GarmentLook};
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

    /// A triangle of it. `size` is how long its sides are (m, the root of twice its area), `pixel` how wide a pixel is there (m).
    pub fn facet(&self, triangle: usize, size: f32, pixel: f32) -> ClothFacet<'_> {
        let print = self.look.corners.get(triangle).filter(|_| !self.print.is_empty()).map(|corners| {
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
            (self.level(pixel * area.sqrt() / size.max(1e-9)), *corners)
        });
        ClothFacet { of: self, print, triangle, size, pixel }
    }

    /// The level whose texels are as wide as a pixel (texture units).
    fn level(&self, pixel: f32) -> &Level {
        let [width, height] = self.print[0].size;
        let texels = pixel * width.max(height) as f32;
        let number = (texels.max(1.0).log2() + 0.5) as usize;
        &self.print[number.min(self.print.len() - 1)]
    }
}

/// A triangle of cloth: what is the same at all of its pixels.
#[derive(Debug, Clone, Copy)]
pub struct ClothFacet<'a> {
    of: &'a ClothColour,
    /// The level of the print that is seen, and where the corners lie in it (texture units).
    print: Option<(&'a Level, [Vec2; 3])>,
    triangle: usize,
    size: f32,
    pixel: f32,
}

impl ClothFacet<'_> {
    /// The colour (linear RGB) at weights of its corners, of a ground.
    pub fn at(&self, weights: [f32; 3], mut ground: Vec3) -> Vec3 {
        if let Some((level, corners)) = &self.print {
            let texel = level.at(corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]);
            ground = ground * (1.0 - texel.w) + texel.truncate();
        }
        let look = ClothLook { tile: None, ..self.of.look.shown() };
        look.colour(self.triangle, weights, ground, self.size, self.pixel)
    }
}

impl Level {
    /// Between four texels around a texture point (v upwards); the print repeats.
    fn at(&self, at: Vec2) -> Vec4 {
        let [width, height] = self.size;
        let (column, x) = around(at.x, width);
        let (row, y) = around(1.0 - at.y, height);
        let of = |row: usize, column: usize| self.texels[row * width as usize + column];
        let between = |row: usize| of(row, column[0]).lerp(of(row, column[1]), x);
        between(row[0]).lerp(between(row[1]), y)
    }
}

/// The texels before and behind a place of a side of `texels` that repeats, and how far it lies between them.
fn around(at: f32, texels: u32) -> ([usize; 2], f32) {
    // By way of a whole number: without SSE 4.1 `floor` is a call.
    let part = at - at as i32 as f32;
    let part = if part < 0.0 { part + 1.0 } else { part };
    // Half a texel back, and one repetition on.
    let place = part * texels as f32 + (texels as f32 - 0.5);
    let (low, end) = (place as usize, texels as usize);
    let once = |n: usize| if n >= end { n - end } else { n };
    let wrapped = |n: usize| once(once(n)).min(end - 1);
    ([wrapped(low), wrapped(low + 1)], place - low as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_print_repeats_in_both_directions_and_has_its_texels_in_their_middles() {
        let texels: Vec<Vec4> = (0..6).map(|i| Vec4::splat(i as f32)).collect();
        let level = Level { size: [3, 2], texels };
        for (across, down) in [(0.0, 0.0), (1.0, -2.0), (-7.0, 5.0)] {
            for (i, (column, row)) in (0..2).flat_map(|row| (0..3).map(move |column| (column, row))).enumerate() {
                let at = Vec2::new((column as f32 + 0.5) / 3.0 + across, 1.0 - (row as f32 + 0.5) / 2.0 + down);
                assert!((level.at(at).x - i as f32).abs() < 1e-4, "texel {i} at {at} is {}", level.at(at).x);
            }
        }
        // Between the last column and the first of the next repetition.
        assert!((level.at(Vec2::new(1.0, 0.75)).x - 1.0).abs() < 1e-4);
        assert!(level.at(Vec2::new(f32::NAN, 0.5)).x.is_nan());
    }
}
