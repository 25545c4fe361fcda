//! Pictures of webcams and files, made red, green and blue.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::live_camera::ColourImage;
use crate::limits::MAX_COLOUR_PIXELS;
use toile_base::limits::MAX_SIDE;

/// First bytes of a JPEG, and its last.
pub(super) const JPEG: &[u8] = b"\xff\xd8";
pub(super) const JPEG_END: &[u8] = b"\xff\xd9";

/// First bytes of a PNG.
pub(super) const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Webcams leave out the Huffman tables, which are always the same. A decoder puts them in where a file says that it is of an AVI.
const AVI: [u8; 18] = *b"\xff\xe0\x00\x10AVI1\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00";

/// Whether a picture of this size is looked at.
///
/// # Errors
/// Its size, and what the limit is.
pub(super) fn check_size(width: usize, height: usize) -> Result<(), String> {
    let most = MAX_SIDE as usize;
    if width == 0 || height == 0 || width > most || height > most || (width * height) as u64 > MAX_COLOUR_PIXELS {
        return Err(format!(
            "a picture of {width} x {height} pixels is outside of 1 to {most} a side and {MAX_COLOUR_PIXELS} in all"
        ));
    }
    Ok(())
}

/// Empties a picture, so that a reader sees that there is none.
pub(super) fn clear(to: &mut ColourImage) {
    (to.width, to.height) = (0, 0);
    to.rgb.clear();
}

fn sized(to: &mut ColourImage, width: usize, height: usize) -> &mut [u8] {
    (to.width, to.height) = (width as u32, height as u32);
    to.rgb.resize(width * height * 3, 0);
    &mut to.rgb
}

/// A JPEG or a PNG; nothing is left in `to` where it is broken.
///
/// # Errors
/// The fault, without the file's name.
pub(super) fn decode(bytes: &[u8], scratch: &mut Vec<u8>, to: &mut ColourImage) -> Result<(), String> {
    clear(to);
    let done = match bytes {
        _ if bytes.starts_with(JPEG) => jpeg(bytes, scratch, to),
        _ if bytes.starts_with(PNG) => png(bytes, to),
        _ => Err("it is neither a JPEG nor a PNG".to_owned()),
    };
    done.inspect_err(|_| clear(to))
}

fn jpeg(bytes: &[u8], scratch: &mut Vec<u8>, to: &mut ColourImage) -> Result<(), String> {
    let broken = |e: &dyn std::fmt::Display| format!("the JPEG is broken ({})", e.to_string().trim());
    let bytes = if has_tables(bytes) {
        bytes
    } else {
        scratch.clear();
        scratch.extend_from_slice(JPEG);
        scratch.extend_from_slice(&AVI);
        scratch.extend_from_slice(&bytes[JPEG.len()..]);
        scratch
    };
    // A picture that was cut short is none: its lower part would be grey.
    let options = DecoderOptions::default().set_strict_mode(true).jpeg_set_out_colorspace(ColorSpace::RGB);
    let options = options.set_max_width(1 << 16).set_max_height(1 << 16);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| broken(&e))?;
    let (width, height) = decoder.dimensions().ok_or_else(|| "the JPEG has no size".to_owned())?;
    check_size(width, height)?;
    decoder.decode_into(sized(to, width, height)).map_err(|e| broken(&e))
}

/// Whether a JPEG brings its Huffman tables: a marker before its first scan.
fn has_tables(bytes: &[u8]) -> bool {
    let mut at = JPEG.len();
    while let Some(&[0xff, marker, high, low]) = bytes.get(at..at + 4) {
        match marker {
            0xc4 => return true,
            0xda => return false,
            _ => at += 2 + usize::from(u16::from_be_bytes([high, low])),
        }
    }
    // Whatever this is, the decoder says it.
    true
}

fn png(bytes: &[u8], to: &mut ColourImage) -> Result<(), String> {
    let broken = |e: png::DecodingError| format!("the PNG is broken ({e})");
    let limits = png::Limits { bytes: 8 * MAX_COLOUR_PIXELS as usize };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height)?;
    let channels = reader.output_color_type().0.samples();
    let mut samples = vec![0; width * height * channels];
    reader.next_frame(&mut samples).map_err(broken)?;
    let out = sized(to, width, height);
    for (rgb, pixel) in out.as_chunks_mut::<3>().0.iter_mut().zip(samples.chunks_exact(channels)) {
        // Grey, grey and alpha, colour, colour and alpha: what is transparent is shown as it is.
        *rgb = if channels < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
    }
    Ok(())
}

/// YUYV: two pixels in four bytes, by BT.601 with brightness of 16 to 235, as webcams have it.
///
/// # Errors
/// Fewer bytes than a picture of this size has.
pub(super) fn yuyv(bytes: &[u8], [width, height, stride]: [usize; 3], to: &mut ColourImage) -> Result<(), String> {
    clear(to);
    check_size(width, height)?;
    let whole = stride.checked_mul(height).filter(|whole| stride >= 2 * width && *whole <= bytes.len());
    if whole.is_none() || !width.is_multiple_of(2) {
        return Err(format!("{} bytes are no YUYV picture of {width} x {height} pixels", bytes.len()));
    }
    let out = sized(to, width, height);
    for (row, from) in out.chunks_exact_mut(3 * width).zip(bytes.chunks_exact(stride)) {
        for (two, &[y0, u, y1, v]) in row.as_chunks_mut::<6>().0.iter_mut().zip(from.as_chunks::<4>().0) {
            let (u, v) = (i32::from(u) - 128, i32::from(v) - 128);
            // In 1/256: 1.164 of the brightness; 1.596, 0.813, 0.391 and 2.018 of the colours.
            let shares = [409 * v, -208 * v - 100 * u, 516 * u];
            for (pixel, y) in two.as_chunks_mut::<3>().0.iter_mut().zip([y0, y1]) {
                let light = 298 * (i32::from(y) - 16) + 128;
                pixel.iter_mut().zip(shares).for_each(|(to, share)| *to = ((light + share) >> 8).clamp(0, 255) as u8);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> image::RgbImage {
        image::RgbImage::from_fn(64, 48, |x, y| image::Rgb([4 * x as u8, 5 * y as u8, 90]))
    }

    fn encoded(format: image::ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    /// A JPEG as webcams send it: without its tables.
    fn without_tables(jpeg: &[u8]) -> Vec<u8> {
        let mut out = jpeg[..2].to_vec();
        let mut at = 2;
        while jpeg[at + 1] != 0xda {
            let end = at + 2 + usize::from(u16::from_be_bytes([jpeg[at + 2], jpeg[at + 3]]));
            if jpeg[at + 1] != 0xc4 {
                out.extend_from_slice(&jpeg[at..end]);
            }
            at = end;
        }
        out.extend_from_slice(&jpeg[at..]);
        out
    }

    fn decoded(bytes: &[u8]) -> Result<ColourImage, String> {
        let mut to = ColourImage { width: 9, height: 9, rgb: vec![1; 9] };
        let done = decode(bytes, &mut Vec::new(), &mut to);
        assert!(done.is_ok() || to == ColourImage::default(), "nothing is left of a broken picture");
        done.map(|()| to)
    }

    #[test]
    fn pictures_are_what_they_were() {
        let png = decoded(&encoded(image::ImageFormat::Png)).unwrap();
        assert_eq!((png.width, png.height, &png.rgb), (64, 48, picture().as_raw()));
        let jpeg = encoded(image::ImageFormat::Jpeg);
        let whole = decoded(&jpeg).unwrap();
        let apart = whole.rgb.iter().zip(&png.rgb).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(apart < Some(40) && (whole.width, whole.height) == (64, 48), "{apart:?}");
        let bare = without_tables(&jpeg);
        assert!(bare.len() < jpeg.len() - 300, "the tables were taken out");
        assert_eq!(decoded(&bare).unwrap(), whole);
    }

    #[test]
    fn broken_and_cut_pictures_are_refused() {
        for format in [image::ImageFormat::Png, image::ImageFormat::Jpeg] {
            let bytes = encoded(format);
            for share in [1, 4, 7] {
                assert!(decoded(&bytes[..bytes.len() * share / 8]).is_err(), "{format:?} {share}/8");
            }
        }
        assert!(decoded(b"").is_err() && decoded(b"GIF89a").is_err());
    }

    #[test]
    fn a_picture_of_sixteen_thousand_pixels_a_side_is_refused_before_memory_is_taken() {
        let mut jpeg = encoded(image::ImageFormat::Jpeg);
        let frame = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
        jpeg[frame + 5..frame + 9].copy_from_slice(&[0x3e, 0x80, 0x3e, 0x80]);
        let error = decoded(&jpeg).unwrap_err();
        assert!(error.starts_with("a picture of 16000 x 16000 pixels is outside of"), "{error}");
        assert!(check_size(16_000, 1).is_err() && check_size(4096, 2160).is_ok());
    }

    #[test]
    fn grey_black_and_red_of_yuyv_are_what_they_are() {
        let mut to = ColourImage::default();
        yuyv(&[126, 128, 16, 128, 81, 90, 81, 240], [2, 2, 4], &mut to).unwrap();
        assert_eq!(to.rgb[..6], [128, 128, 128, 0, 0, 0]);
        assert!(to.rgb[6] > 250 && to.rgb[7] < 5 && to.rgb[8] < 5, "{:?}", to.rgb);
        assert!(yuyv(&[0; 7], [2, 2, 4], &mut to).is_err() && to.width == 0);
        assert!(yuyv(&[0; 64], [3, 2, 6], &mut to).is_err());
        assert!(yuyv(&[0; 64], [2, 2, usize::MAX], &mut to).is_err());
    }
}
