//! From a file's operators to steps: only what the wanted outputs need, every shape checked, memory shared by values that do not live at
//! the same time.

use super::op::{Op, Sliding};
use super::shape::Shape;
use crate::tflite::{Constant, Model, NetworkFault, Operator, Padding, RawOp, TensorInfo, Window};

/// Most numbers of all images together that a network may need at once.
const MOST_MEMORY: usize = 1 << 26;

/// Most inputs of an operator.
pub const MOST_INPUTS: usize = 4;

/// One step: what it does, the buffers that it reads with their lengths, and the one that it writes.
#[derive(Debug)]
pub struct NetworkStep {
    /// What it does.
    pub op: Op,
    /// Buffers that it reads, and how many numbers of each.
    pub inputs: Vec<(usize, usize)>,
    /// The buffer that it writes, and how many numbers.
    pub output: (usize, usize),
}

/// Steps and the sizes of the buffers that they share.
#[derive(Debug)]
pub struct Plan {
    /// In the order in which they run.
    pub steps: Vec<NetworkStep>,
    /// Numbers of each buffer.
    pub buffers: Vec<usize>,
    /// The image that is given, its buffer.
    pub input: (Shape, usize),
    /// Outputs in the order in which they were asked for: buffer and numbers.
    pub outputs: Vec<(usize, usize)>,
}

impl Plan {
    /// A plan of what gives the outputs of these shapes, each the first of its shape.
    ///
    /// # Errors
    /// Another network, or one whose shapes do not fit together.
    pub fn new(mut model: Model, wanted: &[&[usize]]) -> Result<Self, NetworkFault> {
        let mut outputs = Vec::new();
        for shape in wanted {
            let found = model.outputs.iter().find(|o| model.tensors[**o].shape == **shape);
            outputs.push(
                *found.ok_or_else(|| NetworkFault::new(format!("it is another network: it gives no {shape:?}")))?,
            );
        }
        let needed = needed(&model, &outputs)?;
        // A reshaped image is the same numbers: both stand for one.
        let mut same: Vec<usize> = (0..model.tensors.len()).collect();
        let mut typed = Vec::new();
        for operator in needed {
            let inputs = inputs_of(&operator, &model.tensors);
            if operator.op == RawOp::Reshape {
                same[operator.output] = same[reshaped(&operator, &model.tensors)?];
                continue;
            }
            let op = typed_op(&operator, &mut model.tensors)?;
            typed.push((op, inputs.into_iter().map(|i| same[i]).collect::<Vec<_>>(), operator.output));
        }
        let outputs: Vec<usize> = outputs.into_iter().map(|o| same[o]).collect();
        let input = Shape::of(&model.tensors[model.input].shape)?;
        Memory::new(&model, model.input, &outputs)?.share(typed, input, &outputs)
    }
}

/// The operators that the outputs need, in their order.
fn needed(model: &Model, outputs: &[usize]) -> Result<Vec<Operator>, NetworkFault> {
    let mut wanted = vec![false; model.tensors.len()];
    outputs.iter().for_each(|o| wanted[*o] = true);
    let mut found = Vec::new();
    for operator in model.operators.iter().rev() {
        if wanted[operator.output] {
            operator.inputs.iter().flatten().for_each(|i| wanted[*i] = true);
            found.push(operator.clone());
        }
    }
    found.reverse();
    let mut known = vec![false; model.tensors.len()];
    known[model.input] = true;
    for operator in &found {
        let ready = |i: &usize| known[*i] || model.tensors[*i].constant.is_some();
        if !operator.inputs.iter().flatten().all(ready) || known[operator.output] {
            return Err(NetworkFault::new("its operators are in no order in which they could run"));
        }
        known[operator.output] = true;
    }
    match outputs.iter().all(|o| known[*o]) {
        true => Ok(found),
        false => Err(NetworkFault::new("nothing gives one of its outputs")),
    }
}

/// The tensors that an operator reads and that are no constants.
fn inputs_of(operator: &Operator, tensors: &[TensorInfo]) -> Vec<usize> {
    operator.inputs.iter().flatten().copied().filter(|i| tensors[*i].constant.is_none()).collect()
}

fn reshaped(operator: &Operator, tensors: &[TensorInfo]) -> Result<usize, NetworkFault> {
    let from = operator.inputs.first().copied().flatten().filter(|i| tensors[*i].constant.is_none());
    let from = from.filter(|i| tensors[*i].numbers() == tensors[operator.output].numbers());
    from.ok_or_else(|| NetworkFault::new("it reshapes an image to another number of numbers"))
}

fn image(operator: &Operator, at: usize, tensors: &[TensorInfo]) -> Result<Shape, NetworkFault> {
    let tensor = operator.inputs.get(at).copied().flatten().map(|i| &tensors[i]).filter(|t| t.constant.is_none());
    Shape::of(&tensor.ok_or_else(|| NetworkFault::new("an operator has no image to read"))?.shape)
}

/// Weights of so many dimensions, taken out of their tensor; and their shape.
fn floats(
    operator: &Operator,
    at: usize,
    tensors: &mut [TensorInfo],
) -> Result<(Box<[f32]>, Vec<usize>), NetworkFault> {
    let tensor = operator.inputs.get(at).copied().flatten().map(|i| &tensors[i]);
    match tensor.and_then(|t| t.constant.as_ref().zip(Some(&t.shape))) {
        Some((Constant::Floats(values), shape)) => Ok((values.clone(), shape.clone())),
        _ => Err(NetworkFault::new("the weights of an operator are missing")),
    }
}

fn typed_op(operator: &Operator, tensors: &mut [TensorInfo]) -> Result<Op, NetworkFault> {
    let output = Shape::of(&tensors[operator.output].shape)?;
    let input = image(operator, 0, tensors)?;
    let unfit = || NetworkFault::new(format!("a {} does not fit its image", name(&operator.op)));
    let fits = |holds: bool| if holds { Ok(()) } else { Err(unfit()) };
    match operator.op {
        RawOp::Add(activation) => {
            fits(input == output && image(operator, 1, tensors)? == output && operator.inputs.len() == 2)?;
            Ok(Op::Add(activation))
        }
        RawOp::Concatenation(axis) => {
            let parts: Vec<Shape> =
                (0..operator.inputs.len()).map(|i| image(operator, i, tensors)).collect::<Result<_, _>>()?;
            let rank = tensors[operator.output].shape.len() as i32;
            let same = parts.iter().all(|p| p.channels == output.channels && p.width == output.width);
            let below = (axis == 1 || axis + rank == 1) && rank > 2;
            fits(below && same && parts.iter().map(|p| p.height).sum::<usize>() == output.height)?;
            Ok(Op::Concatenation)
        }
        RawOp::Conv(window) => {
            let ((weights, shape), (bias, _)) = (floats(operator, 1, tensors)?, floats(operator, 2, tensors)?);
            let &[outs, down, across, ins] = &shape[..] else { return Err(unfit()) };
            let sliding = slide(window, [down, across], input, output)?;
            fits(outs == output.channels && bias.len() == outs && ins == input.channels)?;
            Ok(Op::Conv { sliding, weights, bias })
        }
        RawOp::Depthwise(window) => {
            let ((weights, shape), (bias, _)) = (floats(operator, 1, tensors)?, floats(operator, 2, tensors)?);
            let &[1, down, across, channels] = &shape[..] else { return Err(unfit()) };
            let sliding = slide(window, [down, across], input, output)?;
            fits([channels, bias.len(), output.channels] == [input.channels; 3])?;
            Ok(Op::Depthwise { sliding, weights, bias })
        }
        RawOp::MaxPool(window, size) => {
            let sliding = slide(window, size, input, output)?;
            fits(output.channels == input.channels)?;
            Ok(Op::MaxPool(sliding))
        }
        RawOp::DepthToSpace(block) => {
            let block = block as usize;
            let [height, width] = [input.height * block, input.width * block];
            fits([output.height, output.width, output.channels * block * block] == [height, width, input.channels])?;
            Ok(Op::DepthToSpace(input, block))
        }
        RawOp::Slopes { given } => {
            let slopes = if given { floats(operator, 1, tensors)?.0 } else { vec![0.0; input.channels].into() };
            fits(input == output && slopes.len() == input.channels)?;
            Ok(Op::Slopes(slopes))
        }
        RawOp::Logistic => fits(input == output).map(|()| Op::Logistic),
        RawOp::Resize => fits(input.channels == output.channels).map(|()| Op::Resize(input, output)),
        RawOp::Pad => {
            let constant = operator.inputs.get(1).copied().flatten().and_then(|i| tensors[i].constant.as_ref());
            let Some(Constant::Ints(sides)) = constant else { return Err(unfit()) };
            let &[0, 0, top, bottom, left, right, 0, more] = &sides[..] else { return Err(unfit()) };
            let [top, bottom, left, right, more] =
                [top, bottom, left, right, more].map(|n| usize::try_from(n).unwrap_or(usize::MAX / 4));
            let height = top.saturating_add(bottom).saturating_add(input.height);
            let width = left.saturating_add(right).saturating_add(input.width);
            let channels = more.saturating_add(input.channels);
            fits(output == Shape { height, width, channels })?;
            Ok(Op::Pad { input, output, before: [top, left] })
        }
        RawOp::Reshape | RawOp::Dequantize | RawOp::Densify => Err(unfit()),
    }
}

fn name(op: &RawOp) -> &'static str {
    match op {
        RawOp::Add(_) => "sum",
        RawOp::Concatenation(_) => "concatenation",
        RawOp::Conv(_) => "convolution",
        RawOp::Depthwise(_) => "depthwise convolution",
        RawOp::DepthToSpace(_) => "block of pixels",
        RawOp::Dequantize | RawOp::Densify => "packed constant",
        RawOp::Logistic => "logistic function",
        RawOp::MaxPool(..) => "maximum",
        RawOp::Slopes { .. } => "slope",
        RawOp::Reshape => "reshaping",
        RawOp::Resize => "resizing",
        RawOp::Pad => "border",
    }
}

/// A window over an image, its place and the output's size as TensorFlow defines them.
pub fn slide(window: Window, size: [usize; 2], input: Shape, output: Shape) -> Result<Sliding, NetworkFault> {
    let Window { padding, stride, activation } = window;
    let mut before = [0; 2];
    let lengths = [[input.height, output.height], [input.width, output.width]];
    for (axis, [from, to]) in lengths.into_iter().enumerate() {
        let expected = match padding {
            Padding::Same => from.div_ceil(stride[axis]),
            Padding::Valid => (from + stride[axis]).saturating_sub(size[axis]) / stride[axis],
        };
        if expected != to || size[axis] == 0 || to == 0 {
            return Err(NetworkFault::new(format!("a window gives {expected} rows or columns where it says {to}")));
        }
        if padding == Padding::Same {
            before[axis] = ((to - 1) * stride[axis] + size[axis]).saturating_sub(from) / 2;
        }
    }
    Ok(Sliding { input, output, size, stride, before, activation })
}

/// Which buffer each image has while it is needed.
struct Memory {
    /// Numbers of each tensor.
    numbers: Vec<usize>,
    /// Buffer of each tensor.
    of: Vec<Option<usize>>,
    /// Sizes of the buffers, and the free ones.
    sizes: Vec<usize>,
    free: Vec<usize>,
}

impl Memory {
    fn new(model: &Model, input: usize, outputs: &[usize]) -> Result<Self, NetworkFault> {
        let numbers: Vec<usize> = model.tensors.iter().map(TensorInfo::numbers).collect();
        if outputs.contains(&input) {
            return Err(NetworkFault::new("one of its outputs is its input"));
        }
        let mut of = vec![None; numbers.len()];
        of[input] = Some(0);
        Ok(Self { sizes: vec![numbers[input]], numbers, of, free: Vec::new() })
    }

    /// A free buffer, if possible one that is large enough but not larger than need be.
    fn take(&mut self, numbers: usize) -> usize {
        let by_waste = |i: &usize| (self.sizes[*i] < numbers, self.sizes[*i].abs_diff(numbers));
        let best = (0..self.free.len()).min_by_key(|i| by_waste(&self.free[*i]));
        let buffer = best.map_or(self.sizes.len(), |i| self.free.swap_remove(i));
        if buffer == self.sizes.len() {
            self.sizes.push(0);
        }
        self.sizes[buffer] = self.sizes[buffer].max(numbers);
        buffer
    }

    /// Gives each step its buffers; one that is read for the last time is free for what comes after.
    fn share(
        mut self,
        typed: Vec<(Op, Vec<usize>, usize)>,
        input: Shape,
        outputs: &[usize],
    ) -> Result<Plan, NetworkFault> {
        let mut last = vec![0; self.numbers.len()];
        for (i, (_, inputs, _)) in typed.iter().enumerate() {
            inputs.iter().for_each(|tensor| last[*tensor] = i);
        }
        let mut steps = Vec::with_capacity(typed.len());
        for (i, (op, inputs, output)) in typed.into_iter().enumerate() {
            let unknown = || NetworkFault::new("an operator reads what nothing wrote");
            let buffer = |tensor: &usize| Ok((self.of[*tensor].ok_or_else(unknown)?, self.numbers[*tensor]));
            let read = inputs.iter().map(buffer).collect::<Result<Vec<_>, NetworkFault>>()?;
            let numbers = self.numbers[output];
            let written = self.take(numbers);
            self.of[output] = Some(written);
            steps.push(NetworkStep { op, inputs: read.clone(), output: (written, numbers) });
            let over = |tensor: &usize| last[*tensor] == i && !outputs.contains(tensor) && self.of[*tensor] != Some(0);
            let mut over: Vec<usize> = inputs.iter().filter(|t| over(t)).filter_map(|t| self.of[*t]).collect();
            over.sort_unstable();
            over.dedup();
            self.free.extend(over);
        }
        if self.sizes.iter().try_fold(0_usize, |all, n| all.checked_add(*n)).is_none_or(|n| n > MOST_MEMORY) {
            return Err(NetworkFault::new(format!("it needs more than {MOST_MEMORY} numbers at once")));
        }
        let given =
            |o: &usize| Ok((self.of[*o].ok_or_else(|| NetworkFault::new("an output is missing"))?, self.numbers[*o]));
        let outputs = outputs.iter().map(given).collect::<Result<_, NetworkFault>>()?;
        Ok(Plan { steps, buffers: self.sizes, input: (input, 0), outputs })
    }
}
