//! Files of TensorFlow Lite, as networks are shipped in them.
//!
//! Reads: a `.tflite` file. Writes: its operators and tensors, the constants unpacked to f32 (from f16 behind DEQUANTIZE, from
//! sparse behind DENSIFY).
//! Budget: at load; at most 64 MB of file, and 64 million numbers of constants.
//! Thread: the loading thread.
//!
//! The tables and their numbered fields are those of `schema.fbs` of TensorFlow Lite, version 3.

mod fault;
mod model;
mod operators;
mod reader;
mod sparse;

pub use fault::NetworkFault;
pub use model::{Constant, Model, Operator, TensorInfo};
pub use operators::{Activation, Padding, RawOp, Window};
