//! Pictures that a shop brings, as they are shown: read, turned upright, and made as small as they are seen.

use std::fmt::{self, Debug, Display, Formatter};
use std::io::Cursor;

use image::imageops;
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader, Limits, RgbaImage};

use super::limits::{MAX_DECODED_BYTES, MAX_PIXELS};

/// A picture, small enough to be shown.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB times opacity, and opacity, rows from the top `[height][width]`.
    pub pixels: Box<[[u8; 4]]>,
}

impl Debug for Picture {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "Picture({} x {})", self.width, self.height)
    }
}

impl Picture {
    /// Reads a PNG or JPEG picture, turns it as its camera says, and makes its longer side so many pixels at most.
    ///
    /// # Errors
    /// The fault and its cure, to follow the file's name.
    pub fn decode(bytes: &[u8], most: u32) -> Result<Self, String> {
        let unreadable = |e: &dyn Display| format!("it is no picture in PNG or JPEG ({e}); save it again");
        let refused = |e: ImageError| match e {
            ImageError::Limits(_) => format!("it takes more than {MAX_DECODED_BYTES} bytes to read; make it smaller"),
            other => unreadable(&other),
        };
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| unreadable(&e))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_PIXELS as u32), Some(MAX_PIXELS as u32));
        limits.max_alloc = Some(MAX_DECODED_BYTES);
        reader.limits(limits.clone());
        let mut decoder = reader.into_decoder().map_err(refused)?;
        limits.reserve(decoder.total_bytes()).map_err(refused)?;
        let upright = decoder.orientation().map_err(refused)?;
        let picture = DynamicImage::from_decoder(decoder).map_err(refused)?;
        let mut small = Self::within(picture, most);
        small.apply_orientation(upright);
        Ok(Self::of(&small.into_rgba8()))
    }

    /// The same picture, its longer side no longer than so many pixels; each is the mean of those that it stands for.
    fn within(picture: DynamicImage, most: u32) -> DynamicImage {
        let side = [picture.width(), picture.height()];
        let longer = side[0].max(side[1]);
        if longer <= most {
            return picture;
        }
        let [w, h] = side.map(|n| ((f64::from(n) * f64::from(most) / f64::from(longer)).round() as u32).max(1));
        if !picture.color().has_alpha() {
            return picture.thumbnail_exact(w, h);
        }
        // Colours weigh by their opacity, so that what is seen through lends its own to nothing.
        let mut whole = picture.into_rgba8();
        whole.pixels_mut().for_each(|p| p.0 = premultiplied(p.0));
        let mut small = imageops::thumbnail(&whole, w, h);
        small.pixels_mut().for_each(|p| p.0 = straight(p.0));
        DynamicImage::ImageRgba8(small)
    }

    fn of(picture: &RgbaImage) -> Self {
        let pixels = picture.pixels().map(|p| premultiplied(p.0)).collect();
        Self { width: picture.width(), height: picture.height(), pixels }
    }

    /// Bytes of its pixels.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.pixels)
    }
}

/// Width and height (pixels) that the header of a PNG or JPEG picture states.
///
/// # Errors
/// Bytes that are no such picture.
pub(super) fn size(bytes: &[u8]) -> Result<[usize; 2], String> {
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok();
    let size = reader.and_then(|reader| reader.into_dimensions().ok());
    let (width, height) = size.ok_or_else(|| "it is no picture in PNG or JPEG; convert it".to_owned())?;
    Ok([width as usize, height as usize])
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let times = |c: u8| ((u16::from(c) * u16::from(a) + 127) / 255) as u8;
    [times(r), times(g), times(b), a]
}

fn straight([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let part = |c: u8| ((u16::from(c) * 255 + u16::from(a) / 2) / u16::from(a).max(1)).min(255) as u8;
    [part(r), part(g), part(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::ImageFormat;

    fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
        let picture = RgbaImage::from_fn(width, height, |x, y| image::Rgba(pixel(x, y)));
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_large_picture_is_made_small_and_keeps_its_shape() {
        let read = Picture::decode(&png(800, 1_200, |_, _| [200, 100, 50, 255]), 320).unwrap();
        assert_eq!((read.width, read.height), (213, 320));
        assert!(read.pixels.iter().all(|p| *p == [200, 100, 50, 255]));
        let small = Picture::decode(&png(8, 4, |_, _| [1, 2, 3, 255]), 320).unwrap();
        assert_eq!((small.width, small.height, small.bytes()), (8, 4, 8 * 4 * 4));
    }

    #[test]
    fn what_is_seen_through_lends_no_colour() {
        let half = |x, _| if x < 400 { [250, 0, 0, 255] } else { [0, 250, 0, 0] };
        let read = Picture::decode(&png(800, 8, half), 10).unwrap();
        assert!(read.pixels.iter().all(|[_, g, _, _]| *g == 0), "{:?}", read.pixels);
        assert_eq!(read.pixels[0], [250, 0, 0, 255]);
        assert_eq!(read.pixels[9], [0; 4]);
    }

    #[test]
    fn what_is_no_picture_is_refused_with_the_cure() {
        let whole = png(40, 60, |_, _| [9, 9, 9, 255]);
        for bytes in [&b"GIF89a"[..], &whole[..whole.len() / 2], &[]] {
            let refused = Picture::decode(bytes, 8).unwrap_err();
            assert!(refused.contains("; ") && !refused.contains('\n'), "{refused}");
        }
    }
}
