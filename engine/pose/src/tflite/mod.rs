//! Files of TensorFlow Lite, as networks are shipped in them.
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
