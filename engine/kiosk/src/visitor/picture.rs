//! Picture: the picture that a shopper asked for and takes along by scanning a code.
//!
//! The code of a link is small; the picture stands behind it (`picture_link`). The other code holds the picture itself, as a data link (RFC 2397): nothing is served, sent or written, and only a camera pointed at the
//! display gets it. A code holds 2,953 bytes at most (ISO/IEC 18004, version 40, level L), so the picture is small: the
//! largest of [`SIZES`] that fits, in [`SHADES`] shades of its own.

use qrcode::{Color, EcLevel, QrCode};
use thiserror::Error;
use toile_view::image::Size;

/// Sizes that are tried, largest first. All have the proportions of a standing person.
pub const SIZES: [Size; 5] =
    [Size::new(96, 160), Size::new(84, 140), Size::new(72, 120), Size::new(60, 100), Size::new(48, 80)];

/// Colours of the picture's palette: four bits a pixel.
pub const SHADES: usize = 16;

/// Most bytes that a link may have: those of a code of version 33, level L (ISO/IEC 18004). Phones read larger ones only when they
/// are held still and near.
pub const MOST_LINK: usize = 2_071;

/// Beginning of the link.
const PREFIX: &str = "data:image/png;base64,";

/// A picture before it is one: three bytes a pixel, rows from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct RgbImage {
    /// Width and height.
    pub size: Size,
    /// `[3 x width x height]`, sRGB.
    pub bytes: Vec<u8>,
}

/// A code to scan.
#[derive(Clone, PartialEq, Eq)]
pub struct PictureCode {
    /// Modules a side.
    pub side: usize,
    /// `[side * side]`, row by row; dark is true.
    pub dark: Vec<bool>,
}

impl std::fmt::Debug for PictureCode {
    /// Without what it shows: a picture is nothing for a log.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PictureCode").field("side", &self.side).finish_non_exhaustive()
    }
}

/// Why a picture cannot become a code.
#[derive(Debug, Error)]
pub enum PictureError {
    /// Too large even at the smallest size.
    #[error(
        "the picture has {bytes} bytes at its smallest, more than the {MOST_LINK} of a code; take it before a plainer wall"
    )]
    TooLarge {
        /// Length of its link (bytes).
        bytes: usize,
    },
    /// The encoder refused.
    #[error("the picture cannot be encoded ({0}); take it again")]
    Encoding(String),
}

/// A link as a code, which phones read from a step away: level M (ISO/IEC 18004).
///
/// # Errors
/// A link that is too long for any code.
pub fn link_code(url: &str) -> Result<PictureCode, PictureError> {
    code(url, EcLevel::M)
}

/// A picture as a PNG, at the size that it has.
///
/// # Errors
/// What the encoder refuses.
pub fn png(image: &RgbImage) -> Result<Vec<u8>, PictureError> {
    let refused = |e: png::EncodingError| PictureError::Encoding(e.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.size.width, image.size.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&image.bytes).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// A picture as a code, at the largest size that fits.
///
/// # Errors
/// A picture that is too rich for a code at every size.
pub fn encode(image: &RgbImage) -> Result<PictureCode, PictureError> {
    let mut bytes = 0;
    for size in SIZES.into_iter().filter(|s| s.width <= image.size.width && s.height <= image.size.height) {
        let link = link(&smaller(image, size))?;
        if link.len() <= MOST_LINK {
            return code(&link, EcLevel::L);
        }
        bytes = link.len();
    }
    Err(PictureError::TooLarge { bytes })
}

/// The data link of a picture.
fn link(image: &RgbImage) -> Result<String, PictureError> {
    let (palette, places) = quantised(image);
    let refused = |e: png::EncodingError| PictureError::Encoding(e.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.size.width, image.size.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Four);
    encoder.set_palette(palette.concat());
    encoder.set_compression(png::Compression::High);
    // Neighbours of a palette are no neighbours in colour: a filter would only add noise.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(refused)?;
    let rows = places.chunks(image.size.width as usize);
    let packed: Vec<u8> =
        rows.flat_map(|row| row.chunks(2).map(|p| p[0] << 4 | p.get(1).copied().unwrap_or(0))).collect();
    writer.write_image_data(&packed).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(format!("{PREFIX}{}", base64(&bytes)))
}

fn code(link: &str, level: EcLevel) -> Result<PictureCode, PictureError> {
    let code = QrCode::with_error_correction_level(link, level).map_err(|e| PictureError::Encoding(e.to_string()))?;
    let side = code.width();
    Ok(PictureCode { side, dark: code.into_colors().into_iter().map(|c| c == Color::Dark).collect() })
}

/// The mean of what lies under each pixel of a smaller picture.
fn smaller(image: &RgbImage, size: Size) -> RgbImage {
    let (wide, high) = (image.size.width, image.size.height);
    let mut bytes = Vec::with_capacity(3 * size.width as usize * size.height as usize);
    for y in 0..size.height {
        let rows = y * high / size.height..(y + 1) * high / size.height;
        for x in 0..size.width {
            let columns = x * wide / size.width..(x + 1) * wide / size.width;
            let (mut sum, mut count) = ([0_u32; 3], 0);
            for (row, column) in rows.clone().flat_map(|r| columns.clone().map(move |c| (r, c))) {
                let at = 3 * (row as usize * wide as usize + column as usize);
                (0..3).for_each(|k| sum[k] += u32::from(image.bytes[at + k]));
                count += 1;
            }
            bytes.extend(sum.map(|s| (s / count.max(1)) as u8));
        }
    }
    RgbImage { size, bytes }
}

/// A palette of [`SHADES`] and each pixel's place in it: boxes of colours are halved where they are widest (Heckbert 1982, median cut).
fn quantised(image: &RgbImage) -> (Vec<[u8; 3]>, Vec<u8>) {
    let pixels: Vec<[u8; 3]> = image.bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    let mut boxes: Vec<Vec<[u8; 3]>> = vec![pixels.clone()];
    while boxes.len() < SHADES {
        let widest = (0..boxes.len()).max_by_key(|i| spread(&boxes[*i]).0).unwrap_or_default();
        let (width, channel) = spread(&boxes[widest]);
        if width == 0 {
            break;
        }
        let mut colours = boxes.swap_remove(widest);
        colours.sort_unstable_by_key(|c| c[channel]);
        // Cut between two values, so that one colour never falls into two boxes.
        let middle = colours[colours.len() / 2][channel].max(colours[0][channel] + 1);
        let at = colours.partition_point(|c| c[channel] < middle);
        let upper = colours.split_off(at);
        boxes.extend([colours, upper]);
    }
    let mut palette: Vec<[u8; 3]> = boxes.iter().map(|b| mean(b)).collect();
    palette.sort_unstable();
    let nearest = |p: &[u8; 3]| {
        let distance = |c: &[u8; 3]| (0..3).map(|k| (i32::from(c[k]) - i32::from(p[k])).pow(2)).sum::<i32>();
        (0..palette.len()).min_by_key(|i| distance(&palette[*i])).unwrap_or_default() as u8
    };
    let places = pixels.iter().map(nearest).collect();
    (palette, places)
}

/// The widest range of a channel, and which.
fn spread(colours: &[[u8; 3]]) -> (u8, usize) {
    let range = |k: usize| {
        let values = colours.iter().map(|c| c[k]);
        values.clone().max().unwrap_or_default() - values.min().unwrap_or_default()
    };
    (0..3).map(|k| (range(k), k)).max_by_key(|r| r.0).unwrap_or_default()
}

fn mean(colours: &[[u8; 3]]) -> [u8; 3] {
    let count = colours.len().max(1) as u32;
    [0, 1, 2].map(|k| (colours.iter().map(|c| u32::from(c[k])).sum::<u32>() / count) as u8)
}

/// Base 64 (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0_u32, |bits, k| bits << 8 | u32::from(three.get(k).copied().unwrap_or(0)));
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= three.len() { letter as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A person of that colour before a lit wall.
    pub(crate) fn figure(size: Size, colour: [u8; 3]) -> RgbImage {
        let mut bytes = Vec::new();
        for y in 0..size.height {
            for x in 0..size.width {
                let (u, v) = (x as f32 / size.width as f32 - 0.5, y as f32 / size.height as f32 - 0.5);
                let inside = (u / 0.22).powi(2) + (v / 0.42).powi(2) < 1.0;
                let light = if inside { 0.6 + 0.4 * (u * 9.0).cos() } else { 0.93 - 0.1 * v };
                let base = if inside { colour } else { [236, 234, 230] };
                bytes.extend(base.map(|c| (f32::from(c) * light) as u8));
            }
        }
        RgbImage { size, bytes }
    }

    /// What a phone reads.
    pub(crate) fn scanned(code: &PictureCode) -> String {
        let (border, scale) = (4, 3);
        let side = scale * (code.side + 2 * border);
        let dark = |x: usize, y: usize| {
            let at = |v: usize| (v / scale).checked_sub(border).filter(|v| *v < code.side);
            at(x).zip(at(y)).is_some_and(|(x, y)| code.dark[y * code.side + x])
        };
        let mut seen = rqrr::PreparedImage::prepare_from_greyscale(side, side, |x, y| if dark(x, y) { 0 } else { 255 });
        let grids = seen.detect_grids();
        assert_eq!(grids.len(), 1, "one code");
        grids[0].decode().unwrap().1
    }

    #[test]
    fn what_is_scanned_is_a_picture_of_what_was_shown() {
        let image = figure(Size::new(240, 400), [200, 70, 60]);
        let code = encode(&image).unwrap();
        let link = scanned(&code);
        assert!(link.starts_with(PREFIX) && link.len() <= MOST_LINK, "{} bytes", link.len());
        let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let place = |c: u8| letters.iter().position(|l| *l == c);
        let sixes: Vec<usize> = link[PREFIX.len()..].bytes().filter_map(place).collect();
        let bits: Vec<usize> = sixes.iter().flat_map(|s| (0..6).rev().map(move |k| s >> k & 1)).collect();
        let bytes: Vec<u8> = bits.chunks_exact(8).map(|b| b.iter().fold(0, |v, b| v << 1 | *b as u8)).collect();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut found = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut found).unwrap();
        let size = Size::new(info.width, info.height);
        assert!(SIZES.contains(&size), "{size:?}");
        let wanted = smaller(&image, size);
        let off: u32 = wanted.bytes.iter().zip(&found).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
        assert!(off as f32 / (wanted.bytes.len() as f32) < 6.0, "{off} in {} bytes", wanted.bytes.len());
    }

    #[test]
    fn the_code_of_a_link_is_small_and_says_the_link() {
        let url = "http://192.168.100.100:8080/0123456789abcdef0123456789abcdef.png";
        let code = link_code(url).unwrap();
        assert!(code.side <= 41, "{}", code.side);
        assert_eq!(scanned(&code), url);
    }

    #[test]
    fn a_picture_that_is_too_rich_is_refused_and_not_cut() {
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let size = SIZES[4];
        let bytes = (0..3 * size.width * size.height).map(|_| noise()).collect();
        let message = encode(&RgbImage { size, bytes }).unwrap_err().to_string();
        assert!(message.contains("bytes") && message.contains("plainer"), "{message}");
    }

    #[test]
    fn base64_is_that_of_the_standard() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
