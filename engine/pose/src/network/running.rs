//! Steps one after the other, each from buffers to a buffer.

use toile_engine::lanes::{Store, Width};

use super::conv::{self, PackedConv};
use super::op::Op;
use super::plan::{MOST_INPUTS, Plan};
use super::shape::Shape;
use super::{fast, reference};
use crate::tflite::{Model, NetworkFault};

/// A network with its memory.
#[derive(Debug)]
pub struct Network {
    plan: Plan,
    /// Packed weights of each step that is a convolution.
    packed: Vec<Option<PackedConv>>,
    buffers: Vec<Store>,
    scratch: Store,
    width: Width,
}

impl Network {
    /// Reads a file and makes ready what gives the outputs of these shapes. Called at load: it allocates.
    ///
    /// # Errors
    /// A file that is broken or too large, of another network, or with operators that are not known.
    pub fn load(bytes: &[u8], wanted: &[&[usize]]) -> Result<Self, NetworkFault> {
        Self::of(Plan::new(Model::read(bytes)?, wanted)?)
    }

    pub(super) fn of(plan: Plan) -> Result<Self, NetworkFault> {
        let mut scratch = 0;
        let mut packed = Vec::with_capacity(plan.steps.len());
        for step in &plan.steps {
            if step.inputs.len() > MOST_INPUTS {
                return Err(NetworkFault::new(format!("an operator reads more than {MOST_INPUTS} images")));
            }
            packed.push(match &step.op {
                Op::Conv { sliding, weights, bias } => {
                    scratch = scratch.max(conv::scratch(sliding));
                    Some(PackedConv::new(weights, bias))
                }
                _ => None,
            });
        }
        let buffers = plan.buffers.iter().map(|n| Store::zeros(*n)).collect();
        Ok(Self { packed, buffers, scratch: Store::zeros(scratch), width: Width::widest(), plan })
    }

    /// The size of the image that it takes.
    pub fn input_shape(&self) -> Shape {
        self.plan.input.0
    }

    /// Refuses a network that takes anything but a square picture of so many pixels a side.
    ///
    /// # Errors
    /// What it takes instead.
    pub fn takes_square(&self, side: usize) -> Result<(), NetworkFault> {
        let Shape { height, width, channels } = self.input_shape();
        if [height, width, channels] == [side, side, 3] {
            return Ok(());
        }
        Err(NetworkFault::new(format!("it takes an image of {width} x {height} pixels")))
    }

    /// The image, to be filled in before each run.
    pub fn input(&mut self) -> &mut [f32] {
        self.buffers[self.plan.input.1].as_mut()
    }

    /// An output of the last run, in the order in which they were asked for.
    pub fn output(&self, number: usize) -> &[f32] {
        let (buffer, numbers) = self.plan.outputs[number];
        &self.buffers[buffer].as_slice()[..numbers]
    }

    /// Overwrites what it has of the last image.
    pub fn wipe(&mut self) {
        self.buffers.iter_mut().for_each(|buffer| buffer.as_mut().fill(0.0));
        self.scratch.as_mut().fill(0.0);
    }

    /// Multiply-adds of a run.
    pub fn multiplications(&self) -> u64 {
        let of = |op: &Op| match op {
            Op::Conv { sliding, weights, .. } => (sliding.output.pixels() * weights.len()) as u64,
            Op::Depthwise { sliding, weights, .. } => (sliding.output.pixels() * weights.len()) as u64,
            _ => 0,
        };
        self.plan.steps.iter().map(|step| of(&step.op)).sum()
    }

    /// Memory of weights and images (bytes).
    pub fn bytes(&self) -> usize {
        let images: usize = self.buffers.iter().map(Store::bytes).sum();
        images + self.packed.iter().flatten().map(PackedConv::bytes).sum::<usize>()
    }

    /// Runs it over the image.
    pub fn run(&mut self) {
        self.steps(|network, i, inputs, out, scratch| {
            fast::run(network.width, &network.plan.steps[i].op, network.packed[i].as_ref(), inputs, out, scratch);
        });
    }

    /// The same in plain f32, a hundred times slower.
    pub fn run_plainly(&mut self) {
        self.steps(|network, i, inputs, out, _| reference::run(&network.plan.steps[i].op, inputs, out));
    }

    fn steps(&mut self, run: impl Fn(&Self, usize, &[&[f32]], &mut [f32], &mut [f32])) {
        // What a step writes is taken out meanwhile: an empty store allocates nothing.
        let mut scratch = std::mem::replace(&mut self.scratch, Store::zeros(0));
        for i in 0..self.plan.steps.len() {
            let (buffer, numbers) = self.plan.steps[i].output;
            let mut out = std::mem::replace(&mut self.buffers[buffer], Store::zeros(0));
            let step = &self.plan.steps[i];
            let mut inputs: [&[f32]; MOST_INPUTS] = [&[]; MOST_INPUTS];
            for (slot, (buffer, numbers)) in inputs.iter_mut().zip(&step.inputs) {
                *slot = &self.buffers[*buffer].as_slice()[..*numbers];
            }
            run(self, i, &inputs[..step.inputs.len()], &mut out.as_mut()[..numbers], scratch.as_mut());
            self.buffers[buffer] = out;
        }
        self.scratch = scratch;
    }
}
