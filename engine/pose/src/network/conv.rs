//! Convolution as a product of matrices: pixels by channels, times channels by channels.
//!
//! The weights are packed at load in panels of 16 output channels, so that a vector of them lies side by side. A tile of some
//! pixels and one panel is summed in registers; a panel stays in the nearest cache for a block of pixels. Each sum is that of one
//! output number, in the same order at every width: the bits do not depend on the processor.

use toile_engine::lanes::{Kernel, Lanes, MOST, ReadColumn, Store, WriteColumn};

use super::op::Sliding;
use super::single;
use crate::tflite::Activation;

/// Output channels of a panel.
pub const PANEL: usize = MOST;

/// Pixels for which a panel is used before the next one is fetched.
const BLOCK: usize = 64;

/// Weights and bias, packed for the kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct PackedConv {
    /// Weights `[panel][window and channel][PANEL]`, padded by zeros.
    weights: Store,
    /// Bias `[panel][PANEL]`.
    bias: Store,
    /// Numbers that a sum takes in: window times channels.
    depth: usize,
}

impl PackedConv {
    /// Packs weights `[out][depth]`. Called at load: it allocates.
    pub fn new(weights: &[f32], bias: &[f32]) -> Self {
        let (outs, depth) = (bias.len(), weights.len() / bias.len());
        let panels = outs.div_ceil(PANEL);
        let (mut packed, mut padded) = (Store::zeros(panels * depth * PANEL), Store::zeros(panels * PANEL));
        padded.as_mut()[..outs].copy_from_slice(bias);
        for (o, row) in weights.chunks_exact(depth).enumerate() {
            let panel = &mut packed.as_mut()[o / PANEL * depth * PANEL..][..depth * PANEL];
            row.iter().enumerate().for_each(|(k, w)| panel[k * PANEL + o % PANEL] = *w);
        }
        Self { weights: packed, bias: padded, depth }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.weights.bytes() + self.bias.bytes()
    }
}

/// Whether an image can be taken as it is: each pixel of the output is one of the input.
pub fn is_direct(sliding: &Sliding) -> bool {
    sliding.size == [1, 1] && sliding.stride == [1, 1] && sliding.before == [0, 0]
}

/// Numbers of scratch memory that a convolution needs: the windows of one row of the output, or what [`single`] lays out.
pub fn scratch(sliding: &Sliding) -> usize {
    if single::is_single(sliding) {
        return single::scratch(sliding);
    }
    let window = sliding.size[0] * sliding.size[1] * sliding.input.channels;
    if is_direct(sliding) { 0 } else { sliding.output.width * window }
}

/// Lays out the windows of one row of the output, each as a row of numbers.
pub fn windows(s: &Sliding, y: usize, from: &[f32], scratch: &mut [f32]) {
    let (channels, [down, across]) = (s.input.channels, s.size);
    let each = down * across * channels;
    let (first_row, rows) = s.within(0, y);
    for (x, window) in scratch.chunks_exact_mut(each).take(s.output.width).enumerate() {
        let (first_column, columns) = s.within(1, x);
        window.fill(0.0);
        for (row, iy) in rows.clone().enumerate() {
            let to = ((first_row + row) * across + first_column) * channels;
            let (at, len) = ((iy * s.input.width + columns.start) * channels, columns.len() * channels);
            window[to..to + len].copy_from_slice(&from[at..at + len]);
        }
    }
}

/// One product: rows of `depth` numbers to rows of `outs`.
pub struct Product<'a> {
    /// Weights and bias.
    pub packed: &'a PackedConv,
    /// Rows of numbers `[rows][depth]`.
    pub from: &'a [f32],
    /// Results `[rows][outs]`.
    pub to: &'a mut [f32],
    /// Output channels.
    pub outs: usize,
    /// What happens to each sum.
    pub activation: Activation,
}

impl Kernel for Product<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        match L::N {
            16 => self.blocks::<L, 12, 1>(),
            8 => self.blocks::<L, 4, 2>(),
            4 => self.blocks::<L, 2, 4>(),
            _ => self.blocks::<L, 1, PANEL>(),
        }
    }
}

impl Product<'_> {
    /// Block after block of pixels, panel after panel, tile after tile of `ROWS` pixels and `VECTORS` vectors of channels.
    #[inline(always)]
    fn blocks<L: Lanes, const ROWS: usize, const VECTORS: usize>(self) {
        let Self { packed, from, to, outs, activation } = self;
        let depth = packed.depth;
        let (weights, bias) = (packed.weights.as_slice(), packed.bias.as_slice());
        let (pixels, to) = (from.len() / depth, WriteColumn::new(to));
        for begin in (0..pixels).step_by(BLOCK) {
            let end = (begin + BLOCK).min(pixels);
            for (p, panel) in weights.chunks_exact(depth * PANEL).enumerate() {
                let bias = &bias[p * PANEL..][..PANEL];
                let part = (outs - p * PANEL).min(PANEL);
                let mut pixel = begin;
                while pixel + ROWS <= end {
                    let rows = std::array::from_fn(|r| &from[(pixel + r) * depth..][..depth]);
                    let sums = tile::<L, ROWS, VECTORS>(rows, panel, bias);
                    for (r, sums) in sums.into_iter().enumerate() {
                        put(sums, activation, to, (pixel + r) * outs + p * PANEL, part);
                    }
                    pixel += ROWS;
                }
                while pixel < end {
                    let [sums] = tile::<L, 1, VECTORS>([&from[pixel * depth..][..depth]], panel, bias);
                    put(sums, activation, to, pixel * outs + p * PANEL, part);
                    pixel += 1;
                }
            }
        }
    }
}

/// The sums of one tile.
#[inline(always)]
fn tile<L: Lanes, const ROWS: usize, const VECTORS: usize>(
    rows: [&[f32]; ROWS],
    panel: &[f32],
    bias: &[f32],
) -> [[L; VECTORS]; ROWS] {
    let bias = ReadColumn::new(bias);
    let mut sums = [std::array::from_fn(|v| L::load(bias, v * L::N)); ROWS];
    let (weights, depth) = (ReadColumn::new(panel), panel.len() / PANEL);
    let rows = rows.map(|row| &row[..depth]);
    for k in 0..depth {
        let weights: [L; VECTORS] = std::array::from_fn(|v| L::load(weights, k * PANEL + v * L::N));
        for (sums, row) in sums.iter_mut().zip(&rows) {
            let value = L::splat(row[k]);
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum = *sum + value * weight;
            }
        }
    }
    sums
}

/// Writes the sums of one pixel and panel, of which the first `part` channels are there.
#[inline(always)]
fn put<L: Lanes, const VECTORS: usize>(
    sums: [L; VECTORS],
    activation: Activation,
    to: WriteColumn<'_>,
    at: usize,
    part: usize,
) {
    for (v, sum) in sums.into_iter().enumerate() {
        let sum = super::kernels::activated(sum, activation);
        let from = v * L::N;
        if from + L::N <= part {
            sum.store(to, at + from);
        } else if from < part {
            sum.store_part(to, at + from, part - from);
        }
    }
}
