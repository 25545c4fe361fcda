//! A turned square of a picture, and the network's image of it.

use glam::{Affine2, Mat2, Vec2};
use toile_sensors::source::live::ColourImage;

/// A square in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Its middle (px).
    pub centre: Vec2,
    /// Its side (px).
    pub side: f32,
    /// By how much it is turned clockwise (rad).
    pub turned: f32,
}

/// Squares are alike whose middles and sides differ by so much (sides), and which are turned by so much (rad).
const LIKE: f32 = 0.04;
const LIKE_TURNED: f32 = 0.06;

/// What lies outside of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Border {
    /// Black all around.
    Black,
    /// The nearest pixel of the picture.
    Nearest,
}

impl Region {
    /// The upright square around all of a picture.
    pub fn around(picture: &ColourImage) -> Self {
        let size = Vec2::new(picture.width as f32, picture.height as f32);
        Self { centre: size * 0.5, side: size.max_element(), turned: 0.0 }
    }

    /// The square of a person with this middle of the hips, and a point of the circle around all of them; it is turned so that the
    /// point lies above the hips.
    pub fn of_points(hips: Vec2, above: Vec2) -> Self {
        let up = above - hips;
        // A quarter of the circle's radius is left around it on each side.
        Self { centre: hips, side: 2.0 * up.length() * 1.25, turned: up.x.atan2(-up.y) }
    }

    /// The square of a face: around this middle, `times` as large as the longer side of a box of this size, turned so that the eyes, the
    /// wearer's right one first, lie on a level.
    pub fn of_eyes(middle: Vec2, size: Vec2, [right, left]: [Vec2; 2], times: f32) -> Self {
        let along = left - right;
        Self { centre: middle, side: times * size.max_element(), turned: along.y.atan2(along.x) }
    }

    /// Whether another square differs by so little that this one shows the same: with a new one in each picture of a standing person, the
    /// landmarks and the square that comes of them move each other to and fro.
    pub fn is_like(&self, other: &Self) -> bool {
        let side = LIKE * self.side;
        self.centre.distance(other.centre) <= side
            && (self.side - other.side).abs() <= side
            && (self.turned - other.turned).abs() <= LIKE_TURNED
    }

    /// From shares of the square, 0 to 1 right and down, to pixels of the picture.
    pub fn pixel(&self, share: Vec2) -> Vec2 {
        self.centre + self.turn() * ((share - 0.5) * self.side)
    }

    /// From pixels of the picture to shares of the square.
    pub fn from_picture(&self) -> Affine2 {
        let matrix2 = self.turn().transpose() * (1.0 / self.side);
        Affine2 { matrix2, translation: Vec2::splat(0.5) - matrix2 * self.centre }
    }

    /// Rotation of what is seen in the square to the picture.
    pub fn turn(&self) -> Mat2 {
        Mat2::from_angle(self.turned)
    }

    /// Whether it is a square of a person who can be seen in a picture of this size: finite, not tiny, its middle not far outside.
    pub fn is_within(&self, width: u32, height: u32) -> bool {
        let size = Vec2::new(width as f32, height as f32);
        let finite = self.centre.is_finite() && self.side.is_finite() && self.turned.is_finite();
        let near = self.centre.cmpge(-0.25 * size).all() && self.centre.cmple(1.25 * size).all();
        finite && near && (SMALLEST_SIDE..=LARGEST * size.max_element()).contains(&self.side)
    }

    /// Fills the network's square image `[side * side * 3]`: each value `scale * v + offset` of a v of 0 to 1, bilinear, by the centres
    /// of pixels.
    pub fn sample(
        &self,
        picture: &ColourImage,
        border: Border,
        [scale, offset]: [f32; 2],
        out: &mut [f32],
        side: usize,
    ) {
        let step = self.turn() * Vec2::new(self.side / side as f32, 0.0);
        let down = Vec2::new(-step.y, step.x);
        // Half a pixel from the square's corner, then in units in which whole numbers are centres of pixels.
        let first = self.pixel(Vec2::ZERO) + (step + down) * 0.5 - 0.5;
        let reader = PictureReader { picture, border, scale: scale / 255.0, offset };
        // Where a pixel stands for several of the picture, as many places of it are averaged as leave none out.
        let places = ((0.5 * self.side / side as f32).ceil() as usize).clamp(1, MOST_PLACES);
        let within = |i: usize| (i as f32 + 0.5) / places as f32 - 0.5;
        for (y, row) in out.chunks_exact_mut(side * 3).enumerate() {
            let begin = first + down * y as f32;
            for (x, pixel) in row.as_chunks_mut().0.iter_mut().enumerate() {
                let middle = begin + step * x as f32;
                if places == 1 {
                    *pixel = reader.at(middle);
                    continue;
                }
                let mut sum = [0.0; 3];
                for i in 0..places * places {
                    let at = middle + step * within(i % places) + down * within(i / places);
                    sum.iter_mut().zip(reader.at(at)).for_each(|(sum, v)| *sum += v);
                }
                *pixel = sum.map(|v| v / (places * places) as f32);
            }
        }
    }
}

/// Most places a side that are averaged for a pixel: enough for a picture of 4096 columns.
const MOST_PLACES: usize = 8;

/// Smallest square of a person (px): a head in it has 3 pixels.
const SMALLEST_SIDE: f32 = 32.0;

/// Largest square, in longer sides of the picture: of a person whose head alone is in it.
const LARGEST: f32 = 6.0;

struct PictureReader<'a> {
    picture: &'a ColourImage,
    border: Border,
    scale: f32,
    offset: f32,
}

impl PictureReader<'_> {
    #[inline]
    fn at(&self, place: Vec2) -> [f32; 3] {
        let (width, height) = (self.picture.width as i32, self.picture.height as i32);
        let low = place.floor();
        let share = place - low;
        // Casts saturate, so that a place far outside is no harm.
        let (x, y) = (low.x as i32, low.y as i32);
        let inside = x >= 0 && y >= 0 && x < width - 1 && y < height - 1;
        let corners = if inside {
            let at = (y as usize * width as usize + x as usize) * 3;
            let below = at + width as usize * 3;
            [at, at + 3, below, below + 3].map(Some)
        } else {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| self.place(x.saturating_add(dx), y.saturating_add(dy)))
        };
        let shares = [
            (1.0 - share.x) * (1.0 - share.y),
            share.x * (1.0 - share.y),
            (1.0 - share.x) * share.y,
            share.x * share.y,
        ];
        let mut sum = [0.0; 3];
        for (corner, weight) in corners.into_iter().zip(shares) {
            let Some(rgb) = corner.and_then(|at| self.picture.rgb.get(at..at + 3)) else { continue };
            sum.iter_mut().zip(rgb).for_each(|(sum, v)| *sum += f32::from(*v) * weight);
        }
        sum.map(|v| v * self.scale + self.offset)
    }

    /// Where a pixel's numbers begin; none outside of the picture where that is black.
    fn place(&self, x: i32, y: i32) -> Option<usize> {
        let (width, height) = (self.picture.width as i32, self.picture.height as i32);
        let within = (0..width).contains(&x) && (0..height).contains(&y);
        if !within && self.border == Border::Black {
            return None;
        }
        let (x, y) = (x.clamp(0, width - 1), y.clamp(0, height - 1));
        Some((y as usize * width as usize + x as usize) * 3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    fn picture(width: u32, height: u32) -> ColourImage {
        let rgb = (0..height).flat_map(|y| (0..width).flat_map(move |x| [x as u8, y as u8, 100])).collect();
        ColourImage { width, height, rgb }
    }

    #[test]
    fn a_square_is_like_another_that_is_a_little_aside_and_not_like_one_of_a_step() {
        let square = Region { centre: Vec2::new(320.0, 240.0), side: 400.0, turned: 0.0 };
        let near = Region { centre: Vec2::new(330.0, 246.0), side: 408.0, turned: -0.03 };
        assert!(square.is_like(&near) && square.is_like(&square));
        let aside = Region { centre: Vec2::new(345.0, 240.0), ..square };
        let (larger, turned) = (Region { side: 420.0, ..square }, Region { turned: 0.1, ..square });
        assert!([aside, larger, turned].iter().all(|other| !square.is_like(other)));
    }

    #[test]
    fn a_square_of_the_pictures_own_pixels_is_the_picture() {
        let picture = picture(8, 8);
        let mut out = vec![0.0; 8 * 8 * 3];
        Region::around(&picture).sample(&picture, Border::Black, [255.0, 0.0], &mut out, 8);
        let differs = out.iter().zip(&picture.rgb).any(|(a, b)| (a - f32::from(*b)).abs() > 1e-3);
        assert!(!differs, "{out:?}");
    }

    #[test]
    fn a_wide_picture_has_black_above_and_below() {
        let picture = picture(8, 4);
        let mut out = vec![0.0; 8 * 8 * 3];
        Region::around(&picture).sample(&picture, Border::Black, [2.0, -1.0], &mut out, 8);
        assert_eq!((out[2], out[7 * 8 * 3 + 2]), (-1.0, -1.0));
        assert!((out[(3 * 8 + 2) * 3] - (2.0 * 2.0 / 255.0 - 1.0)).abs() < 1e-6);
        Region::around(&picture).sample(&picture, Border::Nearest, [1.0, 0.0], &mut out, 8);
        assert!((out[2] - 100.0 / 255.0).abs() < 1e-6);
    }

    #[test]
    fn stripes_that_are_finer_than_a_pixel_are_grey() {
        let rgb = (0..64 * 64).flat_map(|i| [if i % 2 == 0 { 0 } else { 200 }; 3]).collect();
        let stripes = ColourImage { width: 64, height: 64, rgb };
        let mut out = vec![0.0; 8 * 8 * 3];
        Region::around(&stripes).sample(&stripes, Border::Nearest, [255.0, 0.0], &mut out, 8);
        assert!(out.iter().all(|v| (v - 100.0).abs() < 5.0), "{out:?}");
    }

    #[test]
    fn a_lying_person_is_turned_upright() {
        let region = Region::of_points(Vec2::new(50.0, 40.0), Vec2::new(70.0, 40.0));
        assert!((region.turned - FRAC_PI_2).abs() < 1e-6 && (region.side - 50.0).abs() < 1e-4);
        // Straight above the middle of the square is to the right of the hips in the picture.
        assert!(region.pixel(Vec2::new(0.5, 0.0)).distance(Vec2::new(75.0, 40.0)) < 1e-3);
    }

    #[test]
    fn squares_without_a_person_are_known() {
        let good = Region { centre: Vec2::new(300.0, 200.0), side: 400.0, turned: 0.0 };
        assert!(good.is_within(640, 480));
        let bad = [
            Region { side: f32::NAN, ..good },
            Region { side: 3.0, ..good },
            Region { side: 1e5, ..good },
            Region { centre: Vec2::new(5_000.0, 0.0), ..good },
        ];
        assert!(bad.iter().all(|region| !region.is_within(640, 480)));
        let far = Region { centre: Vec2::splat(-1e30), ..good };
        let mut out = vec![0.0; 12];
        far.sample(&picture(4, 4), Border::Nearest, [1.0, 0.0], &mut out, 2);
        assert!(out.iter().all(|v| v.is_finite()));
    }
}
