//! Convolution to one channel, such as the mask's last: a panel of [`super::conv`] would compute fifteen others that are not needed.
//!
//! Lanes are neighbouring pixels instead. The rows that a window reaches over lie apart channel by channel, each laid out once and kept for the
//! windows below. Each sum has its products in the reference's order, so the bits are the same at every width.

use toile_engine::lanes::{Kernel, Lanes, MOST, ReadColumn, WriteColumn};

use super::op::Sliding;

/// Vectors of pixels that a weight serves at once.
const VECTORS: usize = 4;

/// Whether it can be computed so: one channel, and a window that goes from pixel to pixel.
pub fn is_single(s: &Sliding) -> bool {
    s.output.channels == 1 && s.stride == [1, 1]
}

/// Numbers of a row of one channel, with the zeros beside the image, and as many as are read at once.
fn stretch(s: &Sliding) -> usize {
    s.output.width.next_multiple_of(VECTORS * MOST) + s.size[1] - 1
}

/// Numbers of scratch memory: rows of a window, channel by channel.
pub fn scratch(s: &Sliding) -> usize {
    s.size[0] * s.input.channels * stretch(s)
}

/// One convolution.
pub struct Single<'a> {
    /// How the window goes over the image.
    pub sliding: &'a Sliding,
    /// Weights `[height][width][in]`.
    pub weights: &'a [f32],
    /// Bias of the one channel.
    pub bias: f32,
    /// The image `[height][width][in]`.
    pub from: &'a [f32],
    /// The image that is written `[height][width]`.
    pub to: &'a mut [f32],
    /// As [`scratch`] asks for it `[row of the window][in][stretch]`.
    pub scratch: &'a mut [f32],
}

impl Kernel for Single<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { sliding: s, weights, bias, from, to, scratch } = self;
        let (channels, width, [down, across]) = (s.input.channels, s.output.width, s.size);
        let each = stretch(s);
        scratch.fill(0.0);
        let mut laid = 0;
        let to = WriteColumn::new(to);
        for y in 0..s.output.height {
            let (first_row, rows) = s.within(0, y);
            for iy in laid..rows.end {
                let row = &from[iy * s.input.width * channels..][..s.input.width * channels];
                lay_out(row, channels, s.before[1], each, &mut scratch[iy % down * channels * each..]);
            }
            laid = laid.max(rows.end);
            let planes = ReadColumn::new(scratch);
            for x in (0..width).step_by(VECTORS * L::N) {
                let mut sums = [L::splat(bias); VECTORS];
                for (row, iy) in rows.clone().enumerate() {
                    let weights = &weights[(first_row + row) * across * channels..][..across * channels];
                    for (k, weight) in weights.iter().enumerate() {
                        let (column, channel) = (k / channels, k % channels);
                        let at = (iy % down * channels + channel) * each + x + column;
                        for (v, sum) in sums.iter_mut().enumerate() {
                            *sum = *sum + L::load(planes, at + v * L::N) * L::splat(*weight);
                        }
                    }
                }
                for (v, sum) in sums.into_iter().enumerate() {
                    let at = x + v * L::N;
                    let sum = super::kernels::activated(sum, s.activation);
                    if at + L::N <= width {
                        sum.store(to, y * width + at);
                    } else if at < width {
                        sum.store_part(to, y * width + at, width - at);
                    }
                }
            }
        }
    }
}

/// Lays a row of an image out channel by channel, each behind the zeros left of the image.
#[inline(always)]
fn lay_out(row: &[f32], channels: usize, before: usize, each: usize, planes: &mut [f32]) {
    for (channel, plane) in planes.chunks_exact_mut(each).take(channels).enumerate() {
        for (to, pixel) in plane[before..].iter_mut().zip(row.chunks_exact(channels)) {
            *to = pixel[channel];
        }
    }
}
