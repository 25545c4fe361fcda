//! Operators as they run, each by its kernel at a width of lanes.

use toile_engine::lanes::Width;

use super::conv::{self, PackedConv, Product};
use super::kernels::{AddKernel, DepthwiseKernel, ResizeKernel, SlopesKernel};
use super::op::Op;
use super::reference;
use super::single::{self, Single};

/// Runs an operator; a convolution with its packed weights and the memory that [`conv::scratch`] asks for.
pub fn run(
    width: Width,
    op: &Op,
    packed: Option<&PackedConv>,
    inputs: &[&[f32]],
    out: &mut [f32],
    scratch: &mut [f32],
) {
    match (op, packed) {
        (Op::Add(activation), _) => {
            width.run(AddKernel { from: [inputs[0], inputs[1]], to: out, activation: *activation });
        }
        (Op::Conv { sliding, weights, bias }, Some(_)) if single::is_single(sliding) => {
            let scratch = &mut scratch[..single::scratch(sliding)];
            width.run(Single { sliding, weights, bias: bias[0], from: inputs[0], to: out, scratch });
        }
        (Op::Conv { sliding, .. }, Some(packed)) => {
            let (outs, activation) = (sliding.output.channels, sliding.activation);
            if conv::is_direct(sliding) {
                width.run(Product { packed, from: inputs[0], to: out, outs, activation });
                return;
            }
            let scratch = &mut scratch[..conv::scratch(sliding)];
            for (y, row) in out.chunks_exact_mut(sliding.output.width * outs).enumerate() {
                conv::windows(sliding, y, inputs[0], scratch);
                width.run(Product { packed, from: scratch, to: row, outs, activation });
            }
        }
        (Op::Depthwise { sliding, weights, bias }, _) => {
            narrow(width, sliding.input.channels).run(DepthwiseKernel {
                sliding,
                weights,
                bias,
                from: inputs[0],
                to: out,
            });
        }
        (Op::Resize(small, large), _) => {
            narrow(width, small.channels).run(ResizeKernel { shapes: [*small, *large], from: inputs[0], to: out });
        }
        (Op::Slopes(slopes), _) => {
            narrow(width, slopes.len()).run(SlopesKernel { slopes, from: inputs[0], to: out });
        }
        // These copy, or are a handful of numbers: their reference is as fast as can be.
        _ => reference::run(op, inputs, out),
    }
}

/// No more lanes than there are channels, where a whole vector of them would be half empty.
fn narrow(width: Width, channels: usize) -> Width {
    if channels <= Width::Eight.lanes() { width.min(Width::Eight) } else { width }
}
