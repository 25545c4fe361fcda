//! Sizes of images.

use crate::tflite::NetworkFault;

/// Height, width and channels. Numbers lie row by row, pixel by pixel, channel by channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Rows (px).
    pub height: usize,
    /// Columns (px).
    pub width: usize,
    /// Numbers of a pixel.
    pub channels: usize,
}

impl Shape {
    /// Of a tensor with one image: `[1, h, w, c]`, `[1, n, c]` or `[1, c]`.
    pub fn of(dimensions: &[usize]) -> Result<Self, NetworkFault> {
        match *dimensions {
            [1, height, width, channels] => Ok(Self { height, width, channels }),
            [1, height, channels] => Ok(Self { height, width: 1, channels }),
            [1, channels] => Ok(Self { height: 1, width: 1, channels }),
            _ => Err(NetworkFault::new(format!("a tensor of {dimensions:?} is no image"))),
        }
    }

    /// Number of pixels.
    pub const fn pixels(self) -> usize {
        self.height * self.width
    }

    /// Numbers in all.
    pub const fn numbers(self) -> usize {
        self.pixels() * self.channels
    }
}
