//! Pictures that lie on a surface: read from PNG and JPEG, drawn as prints, laid side by side as an atlas.

use std::io::Cursor;
use std::sync::Arc;

use image::imageops::{self, FilterType};
use image::{ImageReader, Limits, RgbaImage};
use toile_base::texture::Texture;

/// Most pixels along a side of a picture that is read.
pub const MAX_PIXELS: u32 = 8_192;

/// Most texels along a side that are kept: a garment of a metre has two of them a millimetre.
pub const MOST_SIDE: u32 = 1_024;

/// Most bytes that reading one picture may take: an RGBA picture of [`MAX_PIXELS`] along both sides.
const MAX_DECODED_BYTES: u64 = 4 * (MAX_PIXELS as u64) * (MAX_PIXELS as u64);

/// Reads a PNG or JPEG picture and brings it to sides that are powers of two, [`MOST_SIDE`] at most.
///
/// # Errors
/// The fault and its cure, to follow the file's name.
pub fn decode(bytes: &[u8]) -> Result<Texture, String> {
    let unreadable = |e: &dyn std::fmt::Display| format!("it is no picture in PNG or JPEG ({e}); save it again");
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| unreadable(&e))?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MAX_PIXELS), Some(MAX_PIXELS));
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    let picture = reader.decode().map_err(|e| match e {
        image::ImageError::Limits(_) => {
            format!("it has more than {MAX_PIXELS} pixels along a side; make it smaller")
        }
        other => unreadable(&other),
    })?;
    Ok(fitting(&picture.into_rgba8(), MOST_SIDE))
}

/// A picture with sides that are powers of two, `most` at most.
fn fitting(picture: &RgbaImage, most: u32) -> Texture {
    let side = |n: u32| n.next_power_of_two().min(most);
    let (width, height) = (side(picture.width()), side(picture.height()));
    let fitting = if (width, height) == picture.dimensions() {
        picture.clone()
    } else {
        imageops::resize(picture, width, height, FilterType::Triangle)
    };
    Texture { width, height, texels: fitting.pixels().map(|p| p.0).collect() }
}

fn picture_of(texture: &Texture) -> RgbaImage {
    RgbaImage::from_fn(texture.width, texture.height, |x, y| {
        image::Rgba(texture.texels[(y * texture.width + x) as usize])
    })
}

/// Several pictures in one, each in its cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    /// All of them.
    pub texture: Arc<Texture>,
    /// Cells along a side.
    cells: u32,
}

impl Atlas {
    /// Lays pictures side by side, in rows from the top; one alone keeps its size, and repeats.
    pub fn of(pictures: &[Arc<Texture>]) -> Option<Self> {
        if let [only] = pictures {
            return Some(Self { texture: only.clone(), cells: 1 });
        }
        let cells = (pictures.len() as f32).sqrt().ceil() as u32;
        let largest = pictures.iter().map(|p| p.width.max(p.height)).max()?;
        let cells = cells.next_power_of_two();
        let side = (largest + 2 * MARGIN).next_power_of_two().min((2 * MOST_SIDE / cells).max(4 * MARGIN));
        let mut whole = RgbaImage::new(side * cells, side * cells);
        for (i, picture) in (0..).zip(pictures) {
            let inner =
                imageops::resize(&picture_of(picture), side - 2 * MARGIN, side - 2 * MARGIN, FilterType::Triangle);
            let (left, top) = (i % cells * side, i / cells * side);
            // The margin repeats the border, so that a coarser level of detail mixes nothing of a neighbour in.
            for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                let clamp = |v: u32| v.saturating_sub(MARGIN).min(side - 2 * MARGIN - 1);
                whole.put_pixel(left + x, top + y, *inner.get_pixel(clamp(x), clamp(y)));
            }
        }
        Some(Self { texture: Arc::new(fitting(&whole, 2 * MOST_SIDE)), cells })
    }

    /// Where a face's texture points (0 to 1 across its own picture, v upwards) lie in the atlas. Faces that lie in a
    /// repetition of their picture are brought back to the first.
    pub fn place(&self, picture: usize, corners: [glam::Vec2; 3]) -> [glam::Vec2; 3] {
        if self.cells == 1 {
            return corners;
        }
        let least = corners[0].min(corners[1]).min(corners[2]).floor();
        let cells = self.cells as f32;
        let column = (picture as u32 % self.cells) as f32;
        let row = (picture as u32 / self.cells) as f32;
        let side = self.texture.width as f32 / cells;
        let margin = MARGIN as f32 / side;
        corners.map(|uv| {
            let own = (uv - least).clamp(glam::Vec2::ZERO, glam::Vec2::ONE) * (1.0 - 2.0 * margin) + margin;
            glam::Vec2::new((column + own.x) / cells, 1.0 - (row + 1.0 - own.y) / cells)
        })
    }
}

/// Texels around a picture in an atlas: three levels of detail stay clean.
const MARGIN: u32 = 8;

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        let picture = RgbaImage::from_fn(width, height, |x, y| image::Rgba([x as u8, y as u8, 7, 255]));
        picture.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
        bytes
    }

    #[test]
    fn pictures_come_to_powers_of_two() {
        let read = decode(&png(100, 64)).unwrap();
        assert_eq!((read.width, read.height, read.texels.len()), (128, 64, 128 * 64));
        assert!(read.texels.iter().all(|t| t[3] == 255));
        assert_eq!(decode(&png(16, 8)).unwrap().texels[17], [1, 1, 7, 255]);
    }

    #[test]
    fn broken_and_huge_pictures_are_told() {
        let whole = png(40, 30);
        for end in [0, 1, 8, 20, 40, whole.len() / 2] {
            assert!(decode(&whole[..end]).unwrap_err().contains("save it again"), "{end}");
        }
        let mut huge = whole.clone();
        // The width of a PNG stands in its header, bytes 16 to 19, and its checksum behind.
        huge[16..20].copy_from_slice(&100_000_u32.to_be_bytes());
        assert!(decode(&huge).is_err());
        assert!(decode(b"GIF89a, but not really").is_err());
    }

    #[test]
    fn every_picture_of_an_atlas_is_found_in_its_cell() {
        let colours = [[250, 0, 0], [0, 250, 0], [0, 0, 250], [200, 200, 0], [0, 200, 200]];
        let pictures: Vec<Arc<Texture>> = colours.iter().map(|c| Arc::new(Texture::plain(*c))).collect();
        let atlas = Atlas::of(&pictures).unwrap();
        for (i, colour) in colours.iter().enumerate() {
            for uv in [Vec2::ZERO, Vec2::ONE, Vec2::new(0.4, 0.7), Vec2::new(3.5, -1.5)] {
                let [at, ..] = atlas.place(i, [uv; 3]);
                let texture = &atlas.texture;
                let (x, y) = (at.x * texture.width as f32, (1.0 - at.y) * texture.height as f32);
                let texel = texture.texels[(y as u32 * texture.width + x as u32) as usize];
                assert_eq!(&texel[..3], colour, "picture {i} at {uv}");
            }
        }
        assert!(Atlas::of(&[]).is_none());
        let alone = Atlas::of(&pictures[..1]).unwrap();
        assert_eq!(alone.place(0, [Vec2::splat(2.5); 3]), [Vec2::splat(2.5); 3], "one picture repeats");
    }
}
