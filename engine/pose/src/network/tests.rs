//! Fast kernels against their reference, on images and weights drawn at random: the same bits at every width.

mod small_file;

use toile_base::numeric::random::SplitMix64;
use toile_engine::lanes::Width;

use super::conv::{self, PackedConv};
use super::op::Op;
use super::plan::slide;
use super::shape::Shape;
use super::{fast, reference};
use crate::tflite::{Activation, Padding, Window};

fn drawn(random: &mut SplitMix64, count: usize) -> Box<[f32]> {
    (0..count).map(|_| random.between(-1.0, 1.0)).collect()
}

/// The same bits by the reference and at every width.
fn agrees(op: &Op, inputs: &[&[f32]], output: Shape) {
    let mut plain = vec![f32::NAN; output.numbers()];
    reference::run(op, inputs, &mut plain);
    let (packed, scratch) = match op {
        Op::Conv { sliding, weights, bias } => (Some(PackedConv::new(weights, bias)), conv::scratch(sliding)),
        _ => (None, 0),
    };
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        let (mut fast, mut scratch) = (vec![f32::NAN; output.numbers()], vec![f32::NAN; scratch]);
        fast::run(width, op, packed.as_ref(), inputs, &mut fast, &mut scratch);
        let differs = plain.iter().zip(&fast).position(|(a, b)| a.to_bits() != b.to_bits());
        assert_eq!(differs, None, "{width} lanes: {:?}", differs.map(|i| (plain[i], fast[i])));
    }
}

fn windows() -> Vec<(Window, [usize; 2], Shape)> {
    let mut all = Vec::new();
    let kinds = [([1, 1], [1, 1]), ([3, 3], [1, 1]), ([3, 3], [2, 2]), ([5, 5], [2, 2]), ([2, 3], [1, 2])];
    for (size, stride) in kinds {
        for (padding, channels) in [(Padding::Same, 3), (Padding::Same, 24), (Padding::Valid, 17)] {
            for (height, width) in [(7, 9), (8, 26), (5, 5)] {
                let activation = [Activation::None, Activation::Relu, Activation::Relu6][all.len() % 3];
                all.push((Window { padding, stride, activation }, size, Shape { height, width, channels }));
            }
        }
    }
    all
}

fn after(window: Window, size: [usize; 2], input: Shape, channels: usize) -> Shape {
    let length = |axis: usize, from: usize| match window.padding {
        Padding::Same => from.div_ceil(window.stride[axis]),
        Padding::Valid => (from + window.stride[axis] - size[axis]) / window.stride[axis],
    };
    Shape { height: length(0, input.height), width: length(1, input.width), channels }
}

#[test]
fn convolutions_equal_the_scalar_reference_bit_for_bit() {
    let mut random = SplitMix64::new(1);
    for (i, (window, size, input)) in windows().into_iter().enumerate() {
        let outs = [1, 13, 16, 40][i % 4];
        let output = after(window, size, input, outs);
        let sliding = slide(window, size, input, output).unwrap();
        let weights = drawn(&mut random, outs * size[0] * size[1] * input.channels);
        let op = Op::Conv { sliding, weights, bias: drawn(&mut random, outs) };
        agrees(&op, &[&drawn(&mut random, input.numbers())], output);
    }
}

#[test]
fn one_channel_convolutions_equal_the_scalar_reference() {
    let mut random = SplitMix64::new(4);
    let all = windows().into_iter().filter(|(window, ..)| window.stride == [1, 1]);
    let wide = Shape { height: 4, width: 131, channels: 8 };
    let window = Window { padding: Padding::Same, stride: [1, 1], activation: Activation::None };
    for (window, size, input) in all.chain([(window, [3, 3], wide), (window, [5, 2], wide), (window, [1, 7], wide)]) {
        let output = after(window, size, input, 1);
        let sliding = slide(window, size, input, output).unwrap();
        let weights = drawn(&mut random, size[0] * size[1] * input.channels);
        let op = Op::Conv { sliding, weights, bias: drawn(&mut random, 1) };
        agrees(&op, &[&drawn(&mut random, input.numbers())], output);
    }
}

#[test]
fn depthwise_convolutions_equal_the_scalar_reference() {
    let mut random = SplitMix64::new(2);
    for (window, size, input) in windows() {
        let output = after(window, size, input, input.channels);
        let sliding = slide(window, size, input, output).unwrap();
        let weights = drawn(&mut random, size[0] * size[1] * input.channels);
        let op = Op::Depthwise { sliding, weights, bias: drawn(&mut random, input.channels) };
        agrees(&op, &[&drawn(&mut random, input.numbers())], output);
    }
}

#[test]
fn sums_and_resizes_equal_the_scalar_reference() {
    let mut random = SplitMix64::new(3);
    let small = Shape { height: 5, width: 7, channels: 19 };
    let [a, b] = [drawn(&mut random, small.numbers()), drawn(&mut random, small.numbers())];
    for activation in [Activation::None, Activation::Relu, Activation::Relu6] {
        agrees(&Op::Add(activation), &[&a, &b], small);
    }
    for (height, width) in [(10, 14), (5, 7), (3, 20)] {
        let large = Shape { height, width, ..small };
        agrees(&Op::Resize(small, large), &[&a], large);
        // As few channels as the mask has.
        let [few, more] = [small, large].map(|shape| Shape { channels: 8, ..shape });
        agrees(&Op::Resize(few, more), &[&a[..few.numbers()]], more);
    }
}

#[test]
fn slopes_equal_the_scalar_reference_bit_for_bit() {
    let mut random = SplitMix64::new(6);
    for channels in [1, 5, 16, 19, 128] {
        let shape = Shape { height: 3, width: 5, channels };
        let mut image = drawn(&mut random, shape.numbers());
        (image[0], image[1], image[2]) = (0.0, -0.0, f32::NAN);
        agrees(&Op::Slopes(drawn(&mut random, channels)), &[&image], shape);
        agrees(&Op::Slopes(vec![0.0; channels].into()), &[&image], shape);
    }
    let mut out = [0.0; 4];
    reference::run(&Op::Slopes(vec![0.5, -2.0].into()), &[&[3.0, 3.0, -3.0, -3.0]], &mut out);
    assert_eq!(out, [3.0, 3.0, -1.5, 6.0]);
}

#[test]
fn a_border_has_zeros_around_and_in_channels_that_are_more() {
    let [input, output] = [(1, 2, 1), (2, 3, 2)].map(|(height, width, channels)| Shape { height, width, channels });
    let mut out = [f32::NAN; 12];
    reference::run(&Op::Pad { input, output, before: [1, 1] }, &[&[7.0, 8.0]], &mut out);
    assert_eq!(out, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 7.0, 0.0, 8.0, 0.0]);
}

/// What the reference itself computes, against numbers worked out by hand.
#[test]
fn a_convolution_of_ones_counts_the_places_of_its_window() {
    let input = Shape { height: 3, width: 3, channels: 2 };
    let window = Window { padding: Padding::Same, stride: [1, 1], activation: Activation::None };
    let sliding = slide(window, [3, 3], input, Shape { channels: 1, ..input }).unwrap();
    let op = Op::Conv { sliding, weights: vec![1.0; 18].into(), bias: vec![0.5].into() };
    let mut out = [0.0; 9];
    reference::run(&op, &[&[1.0; 18]], &mut out);
    assert_eq!(out, [8.5, 12.5, 8.5, 12.5, 18.5, 12.5, 8.5, 12.5, 8.5]);
    // An even image of stride 2 has its extra row of zeros below.
    let input = Shape { height: 4, width: 4, channels: 1 };
    let window = Window { stride: [2, 2], activation: Activation::Relu6, ..window };
    let sliding = slide(window, [3, 3], input, Shape { height: 2, width: 2, channels: 1 }).unwrap();
    let op = Op::Depthwise { sliding, weights: vec![1.0; 9].into(), bias: vec![0.0].into() };
    let mut out = [0.0; 4];
    reference::run(&op, &[&[1.0; 16]], &mut out);
    assert_eq!(out, [6.0, 6.0, 6.0, 4.0]);
}

#[test]
fn the_greatest_is_taken_and_blocks_are_laid_out() {
    let input = Shape { height: 2, width: 2, channels: 4 };
    let window = Window { padding: Padding::Valid, stride: [2, 2], activation: Activation::None };
    let pool = Op::MaxPool(slide(window, [2, 2], input, Shape { height: 1, width: 1, channels: 4 }).unwrap());
    let image: Vec<f32> = (0..16).map(|i| if i % 4 == 1 { -i as f32 } else { i as f32 }).collect();
    let mut out = [0.0; 4];
    reference::run(&pool, &[&image], &mut out);
    assert_eq!(out, [12.0, -1.0, 14.0, 15.0]);
    let mut out = [0.0; 16];
    reference::run(&Op::DepthToSpace(input, 2), &[&image], &mut out);
    assert_eq!(out[..8], [0.0, -1.0, 4.0, -5.0, 2.0, 3.0, 6.0, 7.0]);
}

#[test]
fn windows_that_do_not_fit_are_refused() {
    let input = Shape { height: 8, width: 8, channels: 1 };
    let window = Window { padding: Padding::Same, stride: [2, 2], activation: Activation::None };
    assert!(slide(window, [3, 3], input, input).is_err());
    assert!(slide(window, [0, 3], input, Shape { height: 4, width: 4, channels: 1 }).is_err());
}
