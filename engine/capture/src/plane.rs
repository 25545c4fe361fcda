//! Pictures as the residuals read them: the part around the surface, straightened, smoothed, in levels of half the size.

use glam::DVec2;
use image::RgbImage;
use toile_sensors::calibration::CalibratedCamera;

/// Rec. 709 weights of red, green and blue in luminance.
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// A rectangle of a picture (px): first column and row, then width and height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Window {
    /// The whole of a picture.
    pub const fn whole(size: [u32; 2]) -> Self {
        Self { x: 0, y: 0, width: size[0], height: size[1] }
    }

    /// The pixels of a picture between two corners, with a margin around them, on multiples of `step`; `None` where they lie
    /// outside of the picture.
    pub fn around(low: DVec2, high: DVec2, margin: f64, size: [u32; 2], step: u32) -> Option<Self> {
        let [w, h] = size.map(f64::from);
        let begin = (low - margin).max(DVec2::ZERO).floor();
        let end = (high + margin).min(DVec2::new(w, h)).ceil();
        if !(begin.x + 1.0 < end.x && begin.y + 1.0 < end.y) {
            return None;
        }
        let [x, y] = [begin.x, begin.y].map(|v| v as u32 / step * step);
        let side = |from: u32, to: f64, most: u32| (to as u32 - from).next_multiple_of(step).min(most - from);
        Some(Self { x, y, width: side(x, end.x, size[0]), height: side(y, end.y, size[1]) })
    }
}

/// One level of a picture: channels side by side in each pixel, 0 to 255.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values a pixel: 1 or 3.
    pub channels: usize,
    /// Values `[height x width x channels]`.
    pub values: Vec<f32>,
}

/// One camera's picture: levels of half the size each, the finest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    /// The part of the picture that it holds.
    pub window: Window,
    /// The levels.
    pub levels: Vec<Plane>,
}

impl Pyramid {
    /// The levels of a part of a picture, of which the lens is straightened out.
    pub fn new(picture: &RgbImage, camera: &CalibratedCamera, window: Window, channels: usize, levels: usize) -> Self {
        let read = read(picture, camera, window, channels);
        let mut all = vec![read.smoothed(&[1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0])];
        while all.len() < levels {
            let Some(half) = all.last().and_then(Plane::halved) else { break };
            all.push(half);
        }
        Self { window, levels: all }
    }
}

/// Where a pixel of the whole picture lies in a level of a window: `level = scale * pixel + offset`.
pub fn level_map(window: Window, level: usize) -> (f64, DVec2) {
    let scale = 0.5_f64.powi(level as i32);
    let from = DVec2::new(f64::from(window.x), f64::from(window.y));
    // The middle of a pixel of a level is the middle of the pixels that it is the mean of.
    (scale, (DVec2::splat(0.5) - from) * scale - 0.5)
}

fn read(picture: &RgbImage, camera: &CalibratedCamera, window: Window, channels: usize) -> Plane {
    let (w, h) = (window.width as usize, window.height as usize);
    let mut values = Vec::with_capacity(w * h * channels);
    let mut push = |rgb: [f32; 3]| {
        if channels == 1 {
            values.push(rgb.iter().zip(LUMA).map(|(c, k)| c * k).sum());
        } else {
            values.extend(rgb);
        }
    };
    for y in window.y..window.y + window.height {
        for x in window.x..window.x + window.width {
            if camera.is_bent() {
                let straight = (DVec2::new(f64::from(x), f64::from(y)) - camera.centre()) / camera.focal();
                push(bilinear(picture, camera.pixel_of_ray(straight)));
            } else {
                push(picture.get_pixel(x, y).0.map(f32::from));
            }
        }
    }
    Plane { width: w, height: h, channels, values }
}

/// The colour between four pixels; the border's beyond the picture.
fn bilinear(picture: &RgbImage, at: DVec2) -> [f32; 3] {
    let most = DVec2::new(f64::from(picture.width() - 1), f64::from(picture.height() - 1));
    let at = at.clamp(DVec2::ZERO, most);
    let (x, y) = (at.x as u32, at.y as u32);
    let (a, b) = ((at.x - f64::from(x)) as f32, (at.y - f64::from(y)) as f32);
    let (right, below) = ((x + 1).min(picture.width() - 1), (y + 1).min(picture.height() - 1));
    let [p, q, r, s] =
        [(x, y), (right, y), (x, below), (right, below)].map(|(x, y)| picture.get_pixel(x, y).0.map(f32::from));
    std::array::from_fn(|c| (p[c] * (1.0 - a) + q[c] * a) * (1.0 - b) + (r[c] * (1.0 - a) + s[c] * a) * b)
}

impl Plane {
    /// Smoothed by a symmetric kernel, of which the outer half and the middle are given.
    fn smoothed<const N: usize>(&self, half: &[f32; N]) -> Self {
        let mut across = vec![0.0; self.values.len()];
        let mut out = self.clone();
        self.pass(&self.values, &mut across, half, true);
        self.pass(&across, &mut out.values, half, false);
        out
    }

    fn pass<const N: usize>(&self, from: &[f32], to: &mut [f32], half: &[f32; N], rows: bool) {
        let (w, h, c) = (self.width, self.height, self.channels);
        let reach = N - 1;
        for y in 0..h {
            for x in 0..w {
                for k in 0..c {
                    let at = |by: isize| {
                        let (x, y) = if rows {
                            (x.saturating_add_signed(by).min(w - 1), y)
                        } else {
                            (x, y.saturating_add_signed(by).min(h - 1))
                        };
                        from[(y * w + x) * c + k]
                    };
                    let mut sum = half[reach] * at(0);
                    for d in 1..=reach {
                        sum += half[reach - d] * (at(d as isize) + at(-(d as isize)));
                    }
                    to[(y * w + x) * c + k] = sum;
                }
            }
        }
    }

    /// Half the size, each pixel the mean of four, smoothed; `None` where it would be less than four pixels.
    fn halved(&self) -> Option<Self> {
        let (w, h, c) = (self.width / 2, self.height / 2, self.channels);
        if w < 4 || h < 4 {
            return None;
        }
        let mut values = Vec::with_capacity(w * h * c);
        for y in 0..h {
            for x in 0..w {
                for k in 0..c {
                    let at = |dx: usize, dy: usize| self.values[((2 * y + dy) * self.width + 2 * x + dx) * c + k];
                    values.push(0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)));
                }
            }
        }
        Some(Self { width: w, height: h, channels: c, values }.smoothed(&[0.25, 0.5]))
    }

    /// The pixel above and left of a point and the parts beyond it; `None` outside.
    #[inline(always)]
    pub fn cell(&self, u: f32, v: f32) -> Option<(usize, f32, f32)> {
        let inside = u >= 0.0 && v >= 0.0 && u < (self.width - 1) as f32 && v < (self.height - 1) as f32;
        if !inside {
            return None;
        }
        let (x, y) = (u as usize, v as usize);
        Some(((y * self.width + x) * self.channels, u - x as f32, v - y as f32))
    }

    /// One channel at a place of [`Plane::cell`], bilinear, with its exact derivatives along rows and columns.
    #[inline(always)]
    pub fn sample(&self, (at, a, b): (usize, f32, f32), channel: usize) -> [f32; 3] {
        let (c, row) = (self.channels, self.width * self.channels);
        let from = &self.values[at + channel..];
        let (p, q, r, s) = (from[0], from[c], from[row], from[row + c]);
        let (upper, lower) = (p + (q - p) * a, r + (s - r) * a);
        [upper + (lower - upper) * b, (q - p) + ((s - r) - (q - p)) * b, lower - upper]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_shows_a_point_where_its_map_says() {
        // A blob at a known place is found at the mapped place of each level.
        let at = DVec2::new(61.3, 42.8);
        let picture = RgbImage::from_fn(128, 96, |x, y| {
            let d = DVec2::new(f64::from(x), f64::from(y)).distance_squared(at);
            image::Rgb([(255.0 * (-d / 50.0).exp()) as u8; 3])
        });
        let window = Window::around(at, at, 30.0, [128, 96], 8).unwrap();
        let camera = crate::render::tests::camera([128, 96], 0.0);
        let pyramid = Pyramid::new(&picture, &camera, window, 1, 3);
        for (level, plane) in pyramid.levels.iter().enumerate() {
            let (mut sum, mut whole) = (DVec2::ZERO, 0.0);
            for y in 0..plane.height {
                for x in 0..plane.width {
                    let v = f64::from(plane.values[y * plane.width + x]);
                    sum += DVec2::new(x as f64, y as f64) * v;
                    whole += v;
                }
            }
            let (scale, offset) = level_map(window, level);
            assert!((sum / whole).distance(at * scale + offset) < 0.1, "level {level}: {}", sum / whole);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_samples() {
        let values = (0..12 * 9).map(|i| ((i * i) % 97) as f32).collect();
        let plane = Plane { width: 12, height: 9, channels: 1, values };
        for (u, v) in [(3.3, 4.7), (0.2, 0.4), (9.9, 6.5)] {
            let at = |u, v| plane.sample(plane.cell(u, v).unwrap(), 0);
            let by = 0.01;
            let [_, du, dv] = at(u, v);
            assert!((du - (at(u + by, v)[0] - at(u - by, v)[0]) / (2.0 * by)).abs() < 0.02);
            assert!((dv - (at(u, v + by)[0] - at(u, v - by)[0]) / (2.0 * by)).abs() < 0.02);
        }
        assert!(plane.cell(11.0, 3.0).is_none() && plane.cell(-0.1, 3.0).is_none());
    }
}
