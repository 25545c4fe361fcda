//! The shown part of a camera's picture: its place, its scale, and mirrored.

use glam::Vec2;

use crate::image::Size;

/// From pixels of a picture to those of the mirror.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Framing {
    /// Size of the mirror (pixels).
    pub size: Size,
    /// Pixels of the mirror across one of the picture.
    pub scale: f32,
    /// Column and row of the picture that lie at the mirror's `middle`.
    looks_at: Vec2,
    middle: Vec2,
}

impl Framing {
    /// A picture as high as the mirror, whose column `column` stands at the middle of what is free of the mirror (left and right, shares of
    /// its width), as far as the picture reaches: it covers the mirror where it is wide enough for it.
    pub fn covering(picture: [u32; 2], size: Size, column: f32, free: [f32; 2]) -> Self {
        let [width, height] = picture.map(|n| n.max(1) as f32);
        let mirror = Vec2::new(size.width as f32, size.height as f32);
        let scale = (mirror.y / height).max(1e-3);
        let middle = Vec2::new(0.5 * (free[0] + free[1]) * mirror.x, 0.5 * mirror.y);
        // Columns at the mirror's two sides: the picture's right is at its left.
        let (left, right) = (middle.x / scale, (mirror.x - middle.x) / scale);
        let column = if column.is_finite() { column + 0.5 } else { 0.5 * width };
        let column =
            if left + right <= width { column.clamp(right, width - left) } else { 0.5 * (width + right - left) };
        Self { size, scale, looks_at: Vec2::new(column, 0.5 * height), middle }
    }

    /// The whole picture, as large as it is.
    pub fn whole(picture: [u32; 2]) -> Self {
        let size = Size::new(picture[0], picture[1]);
        Self::covering(picture, size, 0.5 * picture[0] as f32 - 0.5, [0.0, 1.0])
    }

    /// Place of a picture's pixel in the mirror; whole numbers are centres of pixels.
    pub fn to_mirror(&self, pixel: Vec2) -> Vec2 {
        let off = (pixel + 0.5 - self.looks_at) * self.scale;
        self.middle + Vec2::new(-off.x, off.y) - 0.5
    }

    /// What pixel of the picture is seen there.
    pub fn to_picture(&self, pixel: Vec2) -> Vec2 {
        let off = (pixel + 0.5 - self.middle) / self.scale;
        self.looks_at + Vec2::new(-off.x, off.y) - 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_turns_left_and_right_and_keeps_the_shape() {
        let framing = Framing::whole([640, 480]);
        assert_eq!(framing.to_mirror(Vec2::new(0.0, 0.0)), Vec2::new(639.0, 0.0));
        assert_eq!(framing.to_mirror(Vec2::new(639.0, 479.0)), Vec2::new(0.0, 479.0));
        let tall = Framing::covering([640, 480], Size::new(608, 1080), 300.0, [0.0, 1.0]);
        assert_eq!(tall.scale, 2.25);
        let at = tall.to_mirror(Vec2::new(300.0, 240.0));
        assert!((at.x + 0.5 - 304.0).abs() < 1e-3, "{at}");
        assert!(tall.to_picture(at).distance(Vec2::new(300.0, 240.0)) < 1e-3);
    }

    #[test]
    fn a_shopper_at_the_side_is_cut_off() {
        let size = Size::new(608, 1080);
        for column in [-900.0, 0.0, 639.0, f32::NAN, 1e9] {
            let framing = Framing::covering([640, 480], size, column, [0.0, 0.5]);
            let (left, right) = (framing.to_picture(Vec2::ZERO).x, framing.to_picture(Vec2::new(607.0, 0.0)).x);
            assert!(left <= 639.5 && right >= -0.5, "{column}: {left} {right}");
        }
        // A picture that is too narrow stands in the middle.
        let narrow = Framing::covering([100, 480], size, 0.0, [0.0, 1.0]);
        assert!((narrow.to_mirror(Vec2::new(49.5, 0.0)).x - 303.5).abs() < 1e-3);
    }
}
