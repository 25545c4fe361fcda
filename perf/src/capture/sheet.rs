//! A contact sheet of a row: what a camera saw, and the mesh that was found, coloured by its distance from the truth.

use image::RgbImage;
use toile_pose::depth_buffer::DepthBuffer;
use toile_sensors::calibration::CalibratedCamera;
use toile_view::contact_sheet::contact_sheet;
use toile_view::image::{Error, Image, Size};

use super::flow::{FlowRow, FollowedMoment};

/// Moments on a sheet.
const MOMENTS: usize = 5;

/// Distance at which the colour is full (mm).
const FULL_MM: f64 = 1.0;

/// Pictures are shown at this part of their size.
const SHRUNK: usize = 4;

/// The moments of one row.
pub struct Sheet {
    every: usize,
    seen: Vec<Image>,
    found: Vec<Image>,
    captions: Vec<String>,
}

impl Sheet {
    /// A sheet of a row of so many frames.
    pub fn new(frames: usize) -> Self {
        Self { every: ((frames - 1) / MOMENTS).max(1), seen: Vec::new(), found: Vec::new(), captions: Vec::new() }
    }

    /// Looks at a moment, and keeps it if it is due.
    pub fn see(&mut self, moment: &FollowedMoment<'_>) {
        if !moment.frame.is_multiple_of(self.every) || self.seen.len() == MOMENTS {
            return;
        }
        let k = moment.pictures.len() / 2;
        self.seen.push(shrunk(&moment.pictures[k]));
        self.found.push(drawn(moment, &moment.cloth.cameras[k]));
        let mean = moment.off.iter().sum::<f64>() / moment.off.len() as f64 * 1e3;
        self.captions.push(format!("frame {}: {mean:.2} mm", moment.frame));
    }

    /// The sheet as PNG.
    ///
    /// # Errors
    /// As the writer of PNG.
    pub fn png(&self, row: &FlowRow) -> Result<Vec<u8>, Error> {
        let images: Vec<&Image> = self.seen.iter().chain(&self.found).collect();
        let mut captions: Vec<&str> = vec![row.name.as_str()];
        captions.resize(self.seen.len(), "");
        captions.extend(self.captions.iter().map(String::as_str));
        let mut bytes = Vec::new();
        contact_sheet(&images, self.seen.len(), &captions).write_png(&mut bytes)?;
        Ok(bytes)
    }
}

fn shrunk(picture: &RgbImage) -> Image {
    let (w, h) = (picture.width() as usize / SHRUNK, picture.height() as usize / SHRUNK);
    let mut image = Image::filled(Size::new(w as u32, h as u32), [0; 3]);
    for (i, pixel) in image.pixels_mut().enumerate() {
        let (x, y) = (i % w * SHRUNK, i / w * SHRUNK);
        let mut sum = [0u32; 3];
        for k in 0..SHRUNK * SHRUNK {
            let of = picture.get_pixel((x + k % SHRUNK) as u32, (y + k / SHRUNK) as u32).0;
            sum.iter_mut().zip(of).for_each(|(s, c)| *s += u32::from(c));
        }
        *pixel = sum.map(|s| (s / (SHRUNK * SHRUNK) as u32) as u8);
    }
    image
}

/// The mesh as it was found, from white where it is right to red where it is [`FULL_MM`] off; edges of triangles in grey.
fn drawn(moment: &FollowedMoment<'_>, camera: &CalibratedCamera) -> Image {
    let mut buffer = DepthBuffer::new(camera.size, 1.0 / SHRUNK as f64);
    buffer.draw(camera, moment.found, &moment.cloth.triangles);
    let mut image = Image::filled(Size::new(buffer.width as u32, buffer.height as u32), [236, 235, 232]);
    for (i, pixel) in image.pixels_mut().enumerate() {
        let Some(corners) = moment.cloth.triangles.get(buffer.triangle[i] as usize) else { continue };
        let off = corners.iter().map(|v| moment.off[*v as usize]).sum::<f64>() / 3.0 * 1e3;
        let [a, b, c] = corners.map(|v| moment.found[v as usize]);
        let facing = (b - a).cross(c - a).normalize().dot((camera.position() - a).normalize()).abs();
        let far = (off / FULL_MM).min(1.0);
        let shade = 0.55 + 0.45 * facing;
        *pixel = [250.0, 250.0 - 210.0 * far, 250.0 - 230.0 * far].map(|c| (c * shade) as u8);
    }
    image
}
