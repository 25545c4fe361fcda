//! Scalar reference: every operator in plain f32, one number after the other. The fast kernels give the same bits.
//!
//! A sum begins with its bias and takes the window's rows, its columns and the channels in this order. Terms outside of the
//! image are left out.

use super::op::{Op, Sliding};
use super::shape::Shape;
use crate::tflite::Activation;

/// One number after its activation.
pub fn activated(x: f32, activation: Activation) -> f32 {
    let low = if x > 0.0 { x } else { 0.0 };
    match activation {
        Activation::None => x,
        Activation::Relu => low,
        Activation::Relu6 => {
            if low < 6.0 {
                low
            } else {
                6.0
            }
        }
    }
}

/// Runs an operator.
pub fn run(op: &Op, inputs: &[&[f32]], out: &mut [f32]) {
    match op {
        Op::Add(activation) => {
            let sums = inputs[0].iter().zip(inputs[1]).map(|(a, b)| activated(a + b, *activation));
            out.iter_mut().zip(sums).for_each(|(to, sum)| *to = sum);
        }
        Op::Concatenation => {
            let all = inputs.iter().flat_map(|input| input.iter());
            out.iter_mut().zip(all).for_each(|(to, x)| *to = *x);
        }
        Op::Conv { sliding, weights, bias } => conv(sliding, weights, bias, inputs[0], out),
        Op::Depthwise { sliding, weights, bias } => depthwise(sliding, weights, bias, inputs[0], out),
        Op::DepthToSpace(shape, block) => depth_to_space(*shape, *block, inputs[0], out),
        Op::Logistic => out.iter_mut().zip(inputs[0]).for_each(|(to, x)| *to = logistic(*x)),
        Op::MaxPool(sliding) => max_pool(sliding, inputs[0], out),
        Op::Slopes(slopes) => {
            for (to, from) in out.chunks_exact_mut(slopes.len()).zip(inputs[0].chunks_exact(slopes.len())) {
                to.iter_mut().zip(from).zip(slopes).for_each(|((to, x), slope)| *to = sloped(*x, *slope));
            }
        }
        Op::Pad { input, output, before } => pad(*input, *output, *before, inputs[0], out),
        Op::Resize(from, to) => resize(*from, *to, inputs[0], out),
    }
}

/// One number, times a slope where it is below 0. Of a NaN it makes 0.
pub fn sloped(x: f32, slope: f32) -> f32 {
    let (above, below) = (if x > 0.0 { x } else { 0.0 }, if x < 0.0 { x } else { 0.0 });
    above + below * slope
}

/// 1 / (1 + e^-x).
pub fn logistic(x: f32) -> f32 {
    1.0 / (1.0 + (-x).exp())
}

fn conv(s: &Sliding, weights: &[f32], bias: &[f32], from: &[f32], out: &mut [f32]) {
    let (channels, [_, across]) = (s.input.channels, s.size);
    let each = s.size[0] * across * channels;
    for y in 0..s.output.height {
        let (first_row, rows) = s.within(0, y);
        for x in 0..s.output.width {
            let (first_column, columns) = s.within(1, x);
            for (o, bias) in bias.iter().enumerate() {
                let mut sum = *bias;
                for (row, iy) in rows.clone().enumerate() {
                    for (column, ix) in columns.clone().enumerate() {
                        let tap = (first_row + row) * across + first_column + column;
                        let (pixel, weight) = ((iy * s.input.width + ix) * channels, o * each + tap * channels);
                        for c in 0..channels {
                            sum += from[pixel + c] * weights[weight + c];
                        }
                    }
                }
                out[(y * s.output.width + x) * s.output.channels + o] = activated(sum, s.activation);
            }
        }
    }
}

fn depthwise(s: &Sliding, weights: &[f32], bias: &[f32], from: &[f32], out: &mut [f32]) {
    let channels = s.input.channels;
    for y in 0..s.output.height {
        let (first_row, rows) = s.within(0, y);
        for x in 0..s.output.width {
            let (first_column, columns) = s.within(1, x);
            for c in 0..channels {
                let mut sum = bias[c];
                for (row, iy) in rows.clone().enumerate() {
                    for (column, ix) in columns.clone().enumerate() {
                        let tap = (first_row + row) * s.size[1] + first_column + column;
                        sum += from[(iy * s.input.width + ix) * channels + c] * weights[tap * channels + c];
                    }
                }
                out[(y * s.output.width + x) * channels + c] = activated(sum, s.activation);
            }
        }
    }
}

fn max_pool(s: &Sliding, from: &[f32], out: &mut [f32]) {
    let channels = s.input.channels;
    for y in 0..s.output.height {
        for x in 0..s.output.width {
            for c in 0..channels {
                let mut most = f32::NEG_INFINITY;
                for iy in s.within(0, y).1 {
                    for ix in s.within(1, x).1 {
                        let value = from[(iy * s.input.width + ix) * channels + c];
                        most = if value > most { value } else { most };
                    }
                }
                out[(y * s.output.width + x) * channels + c] = activated(most, s.activation);
            }
        }
    }
}

fn depth_to_space(shape: Shape, block: usize, from: &[f32], out: &mut [f32]) {
    let channels = shape.channels / (block * block);
    for y in 0..shape.height * block {
        for x in 0..shape.width * block {
            let pixel = (y / block * shape.width + x / block) * shape.channels;
            let part = (y % block * block + x % block) * channels;
            let to = (y * shape.width * block + x) * channels;
            out[to..to + channels].copy_from_slice(&from[pixel + part..][..channels]);
        }
    }
}

fn pad(input: Shape, output: Shape, before: [usize; 2], from: &[f32], out: &mut [f32]) {
    out.fill(0.0);
    for (at, pixel) in from.chunks_exact(input.channels).enumerate() {
        let (y, x) = (at / input.width + before[0], at % input.width + before[1]);
        out[(y * output.width + x) * output.channels..][..input.channels].copy_from_slice(pixel);
    }
}

/// Two neighbouring rows or columns, and how far between them a place of the larger image lies.
#[inline(always)]
pub fn between(at: usize, from: usize, to: usize) -> (usize, usize, f32) {
    let place = (at as f32 + 0.5) * (from as f32 / to as f32) - 0.5;
    let low = place.floor().max(0.0);
    let high = (place.ceil().max(0.0) as usize).min(from - 1);
    (low as usize, high, place - low)
}

fn resize(from_shape: Shape, to_shape: Shape, from: &[f32], out: &mut [f32]) {
    let channels = from_shape.channels;
    for y in 0..to_shape.height {
        let (top, bottom, down) = between(y, from_shape.height, to_shape.height);
        for x in 0..to_shape.width {
            let (left, right, across) = between(x, from_shape.width, to_shape.width);
            let at = |row: usize, column: usize| (row * from_shape.width + column) * channels;
            let places = [at(top, left), at(bottom, left), at(top, right), at(bottom, right)];
            let shares = shares(down, across);
            let to = (y * to_shape.width + x) * channels;
            for c in 0..channels {
                out[to + c] = from[places[0] + c] * shares[0]
                    + from[places[1] + c] * shares[1]
                    + from[places[2] + c] * shares[2]
                    + from[places[3] + c] * shares[3];
            }
        }
    }
}

/// Shares of the four neighbours: above left, below left, above right, below right.
#[inline(always)]
pub fn shares(down: f32, across: f32) -> [f32; 4] {
    [(1.0 - down) * (1.0 - across), down * (1.0 - across), (1.0 - down) * across, down * across]
}
