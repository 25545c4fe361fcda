//! Depthwise convolution, sums and copies, on lanes of channels.

use toile_engine::lanes::{Kernel, Lanes, ReadColumn, WriteColumn};

use super::op::Sliding;
use super::reference;
use super::shape::Shape;
use crate::tflite::Activation;

/// Pixels that a vector of weights serves at once.
const PIXELS: usize = 4;

/// Columns of a larger image whose places are found at once.
const COLUMNS: usize = 64;

/// Numbers after their activation; of a NaN it makes the lower bound, as its reference does.
#[inline(always)]
pub fn activated<L: Lanes>(x: L, activation: Activation) -> L {
    match activation {
        Activation::None => x,
        Activation::Relu => x.max(L::splat(0.0)),
        Activation::Relu6 => x.max(L::splat(0.0)).min(L::splat(6.0)),
    }
}

/// Runs `each` with the first channel and their number, vector by vector.
#[inline(always)]
fn vectors<L: Lanes>(channels: usize, mut each: impl FnMut(usize, usize)) {
    for c in (0..channels).step_by(L::N) {
        each(c, L::N.min(channels - c));
    }
}

#[inline(always)]
fn load<L: Lanes>(from: ReadColumn<'_>, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

#[inline(always)]
fn store<L: Lanes>(value: L, to: WriteColumn<'_>, at: usize, n: usize) {
    if n == L::N { value.store(to, at) } else { value.store_part(to, at, n) }
}

/// Convolution of each channel by itself.
pub struct DepthwiseKernel<'a> {
    /// How the window goes over the image.
    pub sliding: &'a Sliding,
    /// Weights `[height][width][channel]`.
    pub weights: &'a [f32],
    /// Bias `[channel]`.
    pub bias: &'a [f32],
    /// The image `[height][width][channel]`.
    pub from: &'a [f32],
    /// The image that is written `[height][width][channel]`.
    pub to: &'a mut [f32],
}

impl Kernel for DepthwiseKernel<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (s, to) = (self.sliding, WriteColumn::new(self.to));
        let [weights, bias, from] = [self.weights, self.bias, self.from].map(ReadColumn::new);
        let channels = s.input.channels;
        for y in 0..s.output.height {
            let (first_row, rows) = s.within(0, y);
            let mut x = 0;
            while x < s.output.width {
                let (first_column, columns) = s.within(1, x);
                // Several pixels at once where the whole windows of all of them lie within the image.
                let last = s.within(1, (x + PIXELS - 1).min(s.output.width - 1)).1;
                let inside = x + PIXELS <= s.output.width && columns.len() == s.size[1] && last.len() == s.size[1];
                let taps = Taps { s, rows: &rows, first_row, columns: &columns, first_column };
                let at = (y * s.output.width + x) * channels;
                vectors::<L>(channels, |c, n| {
                    if inside {
                        taps.sum::<L, PIXELS>([weights, bias, from], to, [at + c, c, n]);
                    } else {
                        taps.sum::<L, 1>([weights, bias, from], to, [at + c, c, n]);
                    }
                });
                x += if inside { PIXELS } else { 1 };
            }
        }
    }
}

/// The part of a window that lies within the image.
struct Taps<'a> {
    s: &'a Sliding,
    rows: &'a std::ops::Range<usize>,
    first_row: usize,
    columns: &'a std::ops::Range<usize>,
    first_column: usize,
}

impl Taps<'_> {
    /// Sums of `P` neighbouring pixels for `n` channels from `c` on, written from `at` on.
    #[inline(always)]
    fn sum<L: Lanes, const P: usize>(
        &self,
        [weights, bias, from]: [ReadColumn<'_>; 3],
        to: WriteColumn<'_>,
        [at, c, n]: [usize; 3],
    ) {
        let (s, channels) = (self.s, self.s.input.channels);
        let step = s.stride[1] * channels;
        let mut sums = [load::<L>(bias, c, n); P];
        for (row, iy) in self.rows.clone().enumerate() {
            let tap = (self.first_row + row) * s.size[1] + self.first_column;
            let begin = (iy * s.input.width + self.columns.start) * channels + c;
            for column in 0..self.columns.len() {
                let weight = load::<L>(weights, (tap + column) * channels + c, n);
                for (p, sum) in sums.iter_mut().enumerate() {
                    *sum = *sum + load::<L>(from, begin + column * channels + p * step, n) * weight;
                }
            }
        }
        for (p, sum) in sums.into_iter().enumerate() {
            store(activated(sum, s.activation), to, at + p * channels, n);
        }
    }
}

/// Sum of two images.
pub struct AddKernel<'a> {
    /// The two images that are added, of one shape.
    pub from: [&'a [f32]; 2],
    /// The image that is written `[height][width][channel]`.
    pub to: &'a mut [f32],
    /// What happens to each sum.
    pub activation: Activation,
}

impl Kernel for AddKernel<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let ([a, b], count) = (self.from.map(ReadColumn::new), self.to.len());
        let to = WriteColumn::new(self.to);
        vectors::<L>(count, |i, n| {
            store(activated(load::<L>(a, i, n) + load::<L>(b, i, n), self.activation), to, i, n);
        });
    }
}

/// Numbers of which those below 0 have a slope.
pub struct SlopesKernel<'a> {
    /// Slopes `[channel]`.
    pub slopes: &'a [f32],
    /// The image `[height][width][channel]`.
    pub from: &'a [f32],
    /// The image that is written `[height][width][channel]`.
    pub to: &'a mut [f32],
}

impl Kernel for SlopesKernel<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let (channels, pixels) = (self.slopes.len(), self.to.len() / self.slopes.len());
        let (slopes, from, to) = (ReadColumn::new(self.slopes), ReadColumn::new(self.from), WriteColumn::new(self.to));
        let zero = L::splat(0.0);
        for pixel in 0..pixels {
            vectors::<L>(channels, |c, n| {
                let (x, at) = (load::<L>(from, pixel * channels + c, n), pixel * channels + c);
                store(x.max(zero) + x.min(zero) * load::<L>(slopes, c, n), to, at, n);
            });
        }
    }
}

/// An image of another size, bilinear.
pub struct ResizeKernel<'a> {
    /// Sizes of both.
    pub shapes: [Shape; 2],
    /// The image `[height][width][channel]`.
    pub from: &'a [f32],
    /// The image that is written `[height][width][channel]`.
    pub to: &'a mut [f32],
}

impl Kernel for ResizeKernel<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let ([small, large], from, to) = (self.shapes, ReadColumn::new(self.from), WriteColumn::new(self.to));
        let channels = small.channels;
        // Where a column lies is the same in every row.
        for first in (0..large.width).step_by(COLUMNS) {
            let mut columns = [(0, 0, 0.0); COLUMNS];
            let count = COLUMNS.min(large.width - first);
            for (i, column) in columns[..count].iter_mut().enumerate() {
                let (left, right, across) = reference::between(first + i, small.width, large.width);
                *column = (left * channels, right * channels, across);
            }
            for y in 0..large.height {
                let (top, bottom, down) = reference::between(y, small.height, large.height);
                let [top, bottom] = [top, bottom].map(|row| row * small.width * channels);
                let mut pixel = (y * large.width + first) * channels;
                for (left, right, across) in &columns[..count] {
                    // One by one: an array's `map` is called, and not compiled for this width.
                    let [s0, s1, s2, s3] = reference::shares(down, *across);
                    let (s0, s1, s2, s3) = (L::splat(s0), L::splat(s1), L::splat(s2), L::splat(s3));
                    let mut c = 0;
                    while c < channels {
                        let n = L::N.min(channels - c);
                        let (a, b) = (load::<L>(from, top + left + c, n), load::<L>(from, bottom + left + c, n));
                        let (d, e) = (load::<L>(from, top + right + c, n), load::<L>(from, bottom + right + c, n));
                        store(a * s0 + b * s1 + d * s2 + e * s3, to, pixel + c, n);
                        c += n;
                    }
                    pixel += channels;
                }
            }
        }
    }
}
