//! The picture of a fit: silhouettes and body over each other, view beside view.

use std::io::Cursor;

use glam::DVec3;
use image::{ImageFormat, Rgb, RgbImage};

use super::measured::SilhouetteView;
use toile_pose::depth_buffer::DepthBuffer;

/// Height of a view in the picture (px).
const TALL: f64 = 480.0;

/// Colours where body and silhouette lie together, of the body alone, of the silhouette alone, and of neither.
const BOTH: [u8; 3] = [226, 226, 222];
const BODY: [u8; 3] = [196, 54, 42];
const SILHOUETTE: [u8; 3] = [38, 86, 190];
const NEITHER: [u8; 3] = [34, 34, 38];

/// Draws a body (m, the cameras' world) over the silhouettes, as a PNG file: red where only the body is, blue where only the silhouette is.
///
/// # Errors
/// What the encoder says.
pub fn overlay_png(
    seen: &[SilhouetteView],
    positions: &[DVec3],
    triangles: &[[u32; 3]],
) -> Result<Vec<u8>, image::ImageError> {
    let views: Vec<RgbImage> = seen.iter().map(|s| one(s, positions, triangles)).collect();
    let (width, height) = (views.iter().map(RgbImage::width).sum(), views.iter().map(RgbImage::height).max());
    let mut sheet = RgbImage::from_pixel(width, height.unwrap_or(0), Rgb(NEITHER));
    let mut x = 0;
    for view in &views {
        image::imageops::replace(&mut sheet, view, x, 0);
        x += i64::from(view.width());
    }
    let mut png = Cursor::new(Vec::new());
    sheet.write_to(&mut png, ImageFormat::Png)?;
    Ok(png.into_inner())
}

fn one(seen: &SilhouetteView, positions: &[DVec3], triangles: &[[u32; 3]]) -> RgbImage {
    let camera = seen.camera.straightened();
    let scale = (TALL / f64::from(camera.size[1])).min(1.0);
    let mut buffer = DepthBuffer::new(camera.size, scale);
    buffer.draw(&camera, positions, triangles);
    RgbImage::from_fn(buffer.width as u32, buffer.height as u32, |x, y| {
        let small = glam::DVec2::new(f64::from(x), f64::from(y));
        let at = (small + 0.5) / scale - 0.5;
        let pixel = seen.camera.pixel_of_ray((at - camera.centre()) / camera.focal());
        let covered = seen.mask.at(pixel.x.round() as isize, pixel.y.round() as isize) >= 0.5;
        let drawn = buffer.triangle[y as usize * buffer.width + x as usize] != u32::MAX;
        Rgb(match (covered, drawn) {
            (true, true) => BOTH,
            (false, true) => BODY,
            (true, false) => SILHOUETTE,
            (false, false) => NEITHER,
        })
    })
}
