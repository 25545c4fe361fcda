//! Appearance of an exported surface: its colour, its picture, how rough it is and how much is seen through it.

use std::io::Cursor;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use image::{ImageFormat, RgbImage};

use toile_base::garment::Garment;
use toile_base::texture::Texture;

/// Roughness of skin and of cloth: neither shines.
pub const SKIN_ROUGHNESS: f32 = 0.6;
/// Roughness of cloth.
pub const CLOTH_ROUGHNESS: f32 = 0.9;

/// The look of one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceLook {
    /// Colour, linear RGB 0..1; where there is a picture, that has it too.
    pub colour: [f32; 3],
    /// An opaque picture, the texture points of which repeat; none shows the colour alone.
    pub picture: Option<Arc<Texture>>,
    /// Roughness of the metallic-roughness model (0..1).
    pub roughness: f32,
    /// Share of light that it holds back (0..1).
    pub opacity: f32,
    /// Whether it is seen from both sides.
    pub double_sided: bool,
}

impl SurfaceLook {
    /// Skin of a colour (linear RGB).
    pub fn skin(colour: [f32; 3]) -> Self {
        Self { colour, picture: None, roughness: SKIN_ROUGHNESS, opacity: 1.0, double_sided: false }
    }

    /// Cloth of a colour (sRGB).
    pub fn cloth(srgb: [f32; 3]) -> Self {
        let colour = srgb.map(linear);
        Self { colour, picture: None, roughness: CLOTH_ROUGHNESS, opacity: 1.0, double_sided: true }
    }

    /// The cloth of a garment, and the texture points of its triangles' corners (v upwards) `[triangles]`: those of the picture
    /// that its mesh brings, else in repeats of its print, else in metres of the cloth; none where no pattern says where they lie.
    pub fn of_garment(garment: &Garment) -> (Self, Vec<[Vec2; 3]>) {
        let (look, fabric) = (&garment.look, &garment.fabric);
        let plain = Self { opacity: fabric.opacity, ..Self::cloth(fabric.colour) };
        match (&look.picture, &fabric.tile, &fabric.print) {
            (Some(picture), ..) => (plain.painted(&picture.texture, fabric.colour), picture.corners.to_vec()),
            (None, Some(tile), Some(print)) if !look.cloth.is_empty() => {
                let repeat = print.repeat();
                let corners = look.cloth.iter().map(|t| t.map(|p| p / repeat)).collect();
                (plain.painted(tile, fabric.colour), corners)
            }
            _ => (plain, look.cloth.to_vec()),
        }
    }

    fn painted(self, picture: &Texture, ground: [f32; 3]) -> Self {
        Self { picture: Some(Arc::new(on_ground(picture, ground))), ..self }
    }
}

/// A picture laid on a ground (sRGB), whose colour shows where the picture covers it in part: mixed in linear light, as pictures
/// of Toile mix it.
fn on_ground(picture: &Texture, ground: [f32; 3]) -> Texture {
    let ground = Vec3::from_array(ground.map(linear));
    let texel = |&[r, g, b, a]: &[u8; 4]| {
        let cover = f32::from(a) / 255.0;
        let top = Vec3::from_array([r, g, b].map(|c| linear(f32::from(c) / 255.0)));
        let [r, g, b] = ground.lerp(top, cover).to_array().map(encoded);
        [r, g, b, 255]
    };
    Texture { width: picture.width, height: picture.height, texels: picture.texels.iter().map(texel).collect() }
}

/// A picture as PNG, without what it covers.
pub(super) fn png(picture: &Texture) -> Vec<u8> {
    let [width, height] = [picture.width, picture.height];
    let pixel = |x, y| {
        let [r, g, b, _] = picture.texels[(y * width + x) as usize];
        image::Rgb([r, g, b])
    };
    let mut bytes = Vec::new();
    // Writing to memory fails for no picture of such sides.
    let _ = RgbImage::from_fn(width, height, pixel).write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png);
    bytes
}

/// A linear value of an sRGB one (IEC 61966-2-1).
pub(crate) fn linear(srgb: f32) -> f32 {
    let c = srgb.clamp(0.0, 1.0);
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// A linear value as an sRGB byte.
fn encoded(value: f32) -> u8 {
    let srgb = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
    (srgb.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_covers_its_ground_as_far_as_it_says() {
        let picture = Texture { width: 3, height: 1, texels: vec![[255, 0, 0, 0], [255, 0, 0, 255], [255, 0, 0, 128]] };
        let laid = on_ground(&picture, [0.0, 0.0, 1.0]);
        assert_eq!(laid.texels[..2], [[0, 0, 255, 255], [255, 0, 0, 255]]);
        // Half of the light is 188 of 255 in sRGB.
        assert_eq!(laid.texels[2], [188, 0, 187, 255]);
        let read =
            crate::texture::decode(&png(&Texture { width: 2, height: 1, texels: laid.texels[..2].to_vec() })).unwrap();
        assert_eq!(read.texels, laid.texels[..2]);
    }
}
