//! A file's tensors and operators, its constants unpacked.

use super::operators::{self, RawOp};
use super::reader::{Bytes, Table};
use super::{NetworkFault, sparse};

/// Most tensors, operators and buffers of a file: ten times what is needed.
const MOST: usize = 8_192;

/// Most numbers of one tensor, and of all constants together.
const MOST_NUMBERS: usize = 1 << 24;
const MOST_CONSTANTS: usize = 1 << 26;

/// Most dimensions of a tensor.
const MOST_DIMENSIONS: usize = 5;

/// Numbers that a file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Constant {
    /// Constants of the type f32, those of f16 unpacked.
    Floats(Box<[f32]>),
    /// Constants of the type i32.
    Ints(Box<[i32]>),
}

/// A tensor of the file: its shape, and its constants if it has any.
#[derive(Debug, Clone, PartialEq)]
pub struct TensorInfo {
    /// Its dimensions, outermost first.
    pub shape: Vec<usize>,
    /// Its numbers, where the file holds them.
    pub constant: Option<Constant>,
}

impl TensorInfo {
    /// How many numbers it has.
    pub fn numbers(&self) -> usize {
        self.shape.iter().product()
    }
}

/// An operator with the numbers of the tensors that it reads and writes.
#[derive(Debug, Clone, PartialEq)]
pub struct Operator {
    /// What it does.
    pub op: RawOp,
    /// Tensors that it reads; none where it is left out.
    pub inputs: Vec<Option<usize>>,
    /// The tensor that it writes.
    pub output: usize,
}

/// A network as its file has it, without what only unpacks constants.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// All tensors, in the order of the file.
    pub tensors: Vec<TensorInfo>,
    /// The operators in an order in which they can run.
    pub operators: Vec<Operator>,
    /// The tensor that is given.
    pub input: usize,
    /// The tensors that are wanted.
    pub outputs: Vec<usize>,
}

impl Model {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that is cut, garbled, not of this kind, too large, or has operators that are not known.
    pub fn read(bytes: &[u8]) -> Result<Self, NetworkFault> {
        let root = Bytes::root(bytes, b"TFL3")?;
        if root.int(0, 0)? != 3 {
            return Err(NetworkFault::new("it is of another version of TensorFlow Lite than 3"));
        }
        let codes = root.tables(1, MOST, "kinds of operators")?;
        let codes: Vec<i32> = codes.iter().map(code).collect::<Result<_, _>>()?;
        let graphs = root.tables(2, MOST, "graphs")?;
        let [graph] = &graphs[..] else {
            return Err(NetworkFault::new(format!("it has {} graphs instead of one", graphs.len())));
        };
        let buffers = root.tables(4, MOST, "buffers")?;
        let mut left = MOST_CONSTANTS;
        let tensors = graph.tables(0, MOST, "tensors")?;
        let count = tensors.len();
        let raw: Vec<RawTensor<'_>> = tensors.iter().map(|t| RawTensor::read(t, &buffers)).collect::<Result<_, _>>()?;
        let mut tensors = Vec::with_capacity(count);
        for raw in &raw {
            tensors.push(raw.unpack(&mut left)?);
        }
        let index = |given: i32| within(given, count);
        let mut operators = Vec::new();
        for table in graph.tables(3, MOST, "operators")? {
            let operator = read_operator(&table, &codes, index)?;
            match operator.op {
                RawOp::Dequantize | RawOp::Densify => unpack(&operator, &mut tensors, &mut left)?,
                _ => operators.push(operator),
            }
        }
        let outputs = graph.ints(2)?.into_iter().map(index).collect::<Result<_, _>>()?;
        let inputs = graph.ints(1)?;
        let [input] = inputs[..] else {
            return Err(NetworkFault::new(format!("it has {} inputs instead of one", inputs.len())));
        };
        Ok(Self { tensors, operators, input: index(input)?, outputs })
    }
}

/// The code of a kind of operator: a small one stands in the old field.
fn code(table: &Table<'_>) -> Result<i32, NetworkFault> {
    Ok(i32::from(table.byte(0, 0)?.cast_signed()).max(table.int(3, 0)?))
}

fn within(given: i32, count: usize) -> Result<usize, NetworkFault> {
    let index = usize::try_from(given).ok().filter(|i| *i < count);
    index.ok_or_else(|| NetworkFault::new(format!("it names tensor {given} of {count}")))
}

fn read_operator(
    table: &Table<'_>,
    codes: &[i32],
    index: impl Fn(i32) -> Result<usize, NetworkFault>,
) -> Result<Operator, NetworkFault> {
    let kind = table.int(0, 0)?;
    let code = usize::try_from(kind).ok().and_then(|kind| codes.get(kind));
    let code = *code.ok_or_else(|| NetworkFault::new(format!("it has an operator of no kind ({kind})")))?;
    let op = operators::operator(code, table.table(4)?.as_ref())?;
    let named = |i: i32| if i == -1 { Ok(None) } else { index(i).map(Some) };
    let inputs = table.ints(1)?.into_iter().map(named).collect::<Result<Vec<_>, _>>()?;
    let outputs = table.ints(2)?;
    let [output] = outputs[..] else {
        return Err(NetworkFault::new(format!("an operator has {} outputs instead of one", outputs.len())));
    };
    Ok(Operator { op, inputs, output: index(output)? })
}

/// A constant that was stored packed is copied to the tensor that stands for the unpacked one.
fn unpack(operator: &Operator, tensors: &mut [TensorInfo], left: &mut usize) -> Result<(), NetworkFault> {
    let packed = operator.inputs.first().copied().flatten().map(|i| &tensors[i]);
    let constant = packed.and_then(|t| t.constant.clone().filter(|_| t.shape == tensors[operator.output].shape));
    let constant = constant.ok_or_else(|| NetworkFault::new("it unpacks what is not constant"))?;
    spend(left, tensors[operator.output].numbers())?;
    tensors[operator.output].constant = Some(constant);
    Ok(())
}

fn spend(left: &mut usize, numbers: usize) -> Result<(), NetworkFault> {
    let rest = left.checked_sub(numbers);
    *left = rest.ok_or_else(|| NetworkFault::new(format!("it has more than {MOST_CONSTANTS} numbers of weights")))?;
    Ok(())
}

/// A tensor as it is stored.
struct RawTensor<'a> {
    shape: Vec<usize>,
    kind: u8,
    data: &'a [u8],
    sparsity: Option<Table<'a>>,
}

impl<'a> RawTensor<'a> {
    fn read(table: &Table<'a>, buffers: &[Table<'a>]) -> Result<Self, NetworkFault> {
        let dimensions = table.ints(0)?;
        let shape: Option<Vec<usize>> = dimensions.iter().map(|n| usize::try_from(*n).ok()).collect();
        let product = |shape: &Vec<usize>| shape.iter().try_fold(1_usize, |all, n| all.checked_mul(*n));
        let shape = shape.filter(|shape| {
            shape.len() <= MOST_DIMENSIONS && product(shape).is_some_and(|n| (1..=MOST_NUMBERS).contains(&n))
        });
        let shape = shape.ok_or_else(|| {
            NetworkFault::new(format!("a tensor of {dimensions:?} has no size, or more than {MOST_NUMBERS} numbers"))
        })?;
        let buffer = usize::try_from(table.int(2, 0)?).ok().and_then(|i| buffers.get(i));
        let buffer = buffer.ok_or_else(|| NetworkFault::new("a tensor has no buffer"))?;
        Ok(Self { shape, kind: table.byte(1, 0)?, data: buffer.bytes(0, 1)?, sparsity: table.table(6)? })
    }

    /// Its numbers, where the file holds them; those left out of a sparse one are 0.
    fn unpack(&self, left: &mut usize) -> Result<TensorInfo, NetworkFault> {
        let mut tensor = TensorInfo { shape: self.shape.clone(), constant: None };
        if self.data.is_empty() {
            return Ok(tensor);
        }
        let numbers = tensor.numbers();
        spend(left, numbers)?;
        let mut stored: Vec<f32> = match self.kind {
            0 => self.data.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect(),
            1 => self.data.as_chunks().0.iter().map(|b| of_half(u16::from_le_bytes(*b))).collect(),
            2 if self.data.len() == 4 * numbers => {
                let ints = self.data.as_chunks().0.iter().map(|b| i32::from_le_bytes(*b)).collect();
                tensor.constant = Some(Constant::Ints(ints));
                return Ok(tensor);
            }
            kind => return Err(NetworkFault::new(format!("it has constants of an unknown kind ({kind})"))),
        };
        if let Some(sparsity) = &self.sparsity {
            let places = sparse::places(sparsity, &self.shape)?;
            if places.len() != stored.len() {
                return Err(NetworkFault::new("its sparse weights are not as many as their places"));
            }
            let mut all = vec![0.0; numbers];
            places.iter().zip(&stored).for_each(|(at, value)| all[*at] = *value);
            stored = all;
        }
        if stored.len() != numbers {
            return Err(NetworkFault::new(format!("a tensor of {numbers} numbers holds {}", stored.len())));
        }
        if stored.iter().any(|x| !x.is_finite()) {
            return Err(NetworkFault::new("it has weights that are not finite: it is garbled"));
        }
        tensor.constant = Some(Constant::Floats(stored.into()));
        Ok(tensor)
    }
}

/// The value of a half-precision number (IEEE 754 binary16).
fn of_half(bits: u16) -> f32 {
    let sign = u32::from(bits & 0x8000) << 16;
    let magnitude = u32::from(bits & 0x7fff);
    let positive = match magnitude >> 10 {
        // Zero and what is below the least normal number: units of 2^-24.
        0 => (magnitude as f32 * (0.5f32).powi(24)).to_bits(),
        // Infinite or not a number.
        31 => 0x7f80_0000 | (magnitude & 0x3ff) << 13,
        _ => (magnitude << 13) + ((127 - 15) << 23),
    };
    f32::from_bits(sign | positive)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_precision_numbers_are_widened_exactly() {
        for bits in 0..=u16::MAX {
            let wanted = half::f16::from_bits(bits).to_f32();
            let found = of_half(bits);
            assert!(found.to_bits() == wanted.to_bits() || found.is_nan() && wanted.is_nan(), "{bits:#x}");
        }
    }
}
