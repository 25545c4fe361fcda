//! The operators that are known, with their options.

use super::NetworkFault;
use super::reader::Table;

/// What is added around an image so that a window fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Padding {
    /// As many zeros as the output's size needs: every `stride`th place of the input has one.
    Same,
    /// The window stays within the image.
    Valid,
}

/// What an operator does with its sums in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Activation {
    /// Sums stay as they are.
    None,
    /// No less than 0.
    Relu,
    /// No less than 0, no more than 6.
    Relu6,
}

impl Activation {
    fn of(code: u8) -> Result<Self, NetworkFault> {
        match code {
            0 => Ok(Self::None),
            1 => Ok(Self::Relu),
            3 => Ok(Self::Relu6),
            _ => Err(NetworkFault::new(format!("it has an activation of an unknown kind ({code})"))),
        }
    }
}

/// A window that moves over an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Zeros around the image.
    pub padding: Padding,
    /// Steps down and across (px).
    pub stride: [usize; 2],
    /// What happens to each sum.
    pub activation: Activation,
}

/// An operator of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RawOp {
    /// Sum of two images.
    Add(Activation),
    /// Images one after the other along this dimension.
    Concatenation(i32),
    /// Convolution.
    Conv(Window),
    /// Convolution of each channel by itself.
    Depthwise(Window),
    /// Channels that become a block of so many pixels a side.
    DepthToSpace(i32),
    /// f32 of f16.
    Dequantize,
    /// Logistic function.
    Logistic,
    /// Greatest of a window of this height and width.
    MaxPool(Window, [usize; 2]),
    /// What is below 0 times a slope of its channel, where there are slopes; else 0.
    Slopes {
        /// Whether the file has slopes.
        given: bool,
    },
    /// The same numbers in another shape.
    Reshape,
    /// An image of another size, bilinear.
    Resize,
    /// Zeros around an image.
    Pad,
    /// Dense of sparse.
    Densify,
}

/// A step or a window's side: 1 to 64.
fn side(table: Option<&Table<'_>>, number: usize, what: &str) -> Result<usize, NetworkFault> {
    let given = table.map_or(Ok(0), |t| t.int(number, 0))?;
    usize::try_from(given)
        .ok()
        .filter(|n| (1..=64).contains(n))
        .ok_or_else(|| NetworkFault::new(format!("{what} of {given} is outside of 1 to 64")))
}

fn window(options: Option<&Table<'_>>, activation: usize) -> Result<Window, NetworkFault> {
    let byte = |number| options.map_or(Ok(0), |t| t.byte(number, 0));
    let padding = if byte(0)? == 0 { Padding::Same } else { Padding::Valid };
    let stride = [side(options, 2, "a step")?, side(options, 1, "a step")?];
    Ok(Window { padding, stride, activation: Activation::of(byte(activation)?)? })
}

/// Whether a window's samples lie side by side.
fn dense(options: Option<&Table<'_>>, fields: [usize; 2]) -> Result<(), NetworkFault> {
    let factor = |number| options.map_or(Ok(1), |t| t.int(number, 1));
    if factor(fields[0])? == 1 && factor(fields[1])? == 1 {
        return Ok(());
    }
    Err(NetworkFault::new("it has a dilated convolution, which is not known"))
}

/// The operator of a code.
pub fn operator(code: i32, options: Option<&Table<'_>>) -> Result<RawOp, NetworkFault> {
    let byte = |number| options.map_or(Ok(0), |t| t.byte(number, 0));
    Ok(match code {
        0 => RawOp::Add(Activation::of(byte(0)?)?),
        2 if byte(1)? == 0 => RawOp::Concatenation(options.map_or(Ok(0), |t| t.int(0, 0))?),
        3 => {
            dense(options, [4, 5])?;
            RawOp::Conv(window(options, 3)?)
        }
        4 => {
            dense(options, [5, 6])?;
            if side(options, 3, "a multiplier of channels")? != 1 {
                return Err(NetworkFault::new(
                    "it has a depthwise convolution that multiplies channels, which is not known",
                ));
            }
            RawOp::Depthwise(window(options, 4)?)
        }
        5 => RawOp::DepthToSpace(side(options, 0, "a block")? as i32),
        6 => RawOp::Dequantize,
        14 => RawOp::Logistic,
        17 => {
            let size = [side(options, 4, "a window")?, side(options, 3, "a window")?];
            RawOp::MaxPool(window(options, 5)?, size)
        }
        19 => RawOp::Slopes { given: false },
        22 => RawOp::Reshape,
        23 if byte(2)? == 0 && byte(3)? != 0 => RawOp::Resize,
        34 => RawOp::Pad,
        54 => RawOp::Slopes { given: true },
        124 => RawOp::Densify,
        other => return Err(NetworkFault::new(format!("it has an operator that is not known here (number {other})"))),
    })
}
