//! Operators as they run: shapes checked, weights unpacked.

use super::shape::Shape;
use crate::tflite::Activation;

/// A window over an image, with the zeros before its first row and column counted out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sliding {
    /// The image that is read, and the one that is written.
    pub input: Shape,
    pub output: Shape,
    /// Height and width (px).
    pub size: [usize; 2],
    /// Steps down and across (px).
    pub stride: [usize; 2],
    /// Rows and columns of the first window that lie before the image (px).
    pub before: [usize; 2],
    /// What happens to each sum.
    pub activation: Activation,
}

impl Sliding {
    /// The part of the window that lies within the image, for a row or column of the output: its first place in the window, and
    /// the places of the image.
    #[inline(always)]
    pub fn within(&self, axis: usize, at: usize) -> (usize, std::ops::Range<usize>) {
        let length = if axis == 0 { self.input.height } else { self.input.width };
        let begin = at * self.stride[axis];
        let first = self.before[axis].saturating_sub(begin).min(self.size[axis]);
        let from = (begin + first).saturating_sub(self.before[axis]).min(length);
        let until = (begin + self.size[axis]).saturating_sub(self.before[axis]).min(length);
        (first, from..until.max(from))
    }
}

/// What one step does.
#[derive(Debug, Clone, PartialEq)]
pub enum Op {
    /// Sum of two images, number by number.
    Add(Activation),
    /// Images one below the other.
    Concatenation,
    /// Convolution: weights `[out][height][width][in]`, a bias an output channel.
    Conv {
        /// How the window goes over the image.
        sliding: Sliding,
        /// Weights as the file has them.
        weights: Box<[f32]>,
        /// Bias `[out]`.
        bias: Box<[f32]>,
    },
    /// Convolution of each channel by itself: weights `[height][width][channel]`.
    Depthwise {
        /// How the window goes over the image.
        sliding: Sliding,
        /// Weights as the kernel reads them.
        weights: Box<[f32]>,
        /// Bias `[channel]`.
        bias: Box<[f32]>,
    },
    /// Channels that become a block of this side: input and output.
    DepthToSpace(Shape, usize),
    /// Logistic function of each number.
    Logistic,
    /// Greatest number of a window, channel by channel.
    MaxPool(Sliding),
    /// What is below 0 times the slope of its channel `[channel]`.
    Slopes(Box<[f32]>),
    /// Zeros above and left of an image; the rest of the output is zeros too, and so are channels that it has more.
    Pad {
        /// Shape of the image that is made larger.
        input: Shape,
        /// The larger image.
        output: Shape,
        /// Rows above and columns to the left (px).
        before: [usize; 2],
    },
    /// An image of another size, bilinear, pixels taken at their centres.
    Resize(Shape, Shape),
}
