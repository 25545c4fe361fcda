//! Read-only numpy arrays over memory of Rust, without a copy.
//!
//! The memory belongs to a Python object that never changes it. Every array that shows it holds that object, so that an array may
//! outlive the scene that it came from. numpy gives no way to make such an array writable, since it does not own its memory.
#![expect(unsafe_code, reason = "numpy is given the place of memory, which a Python object keeps")]

use std::sync::Arc;

use numpy::ndarray::ArrayView;
use numpy::npyffi::NPY_ARRAY_WRITEABLE;
use numpy::{Element, Ix1, Ix2, PyArray, PyArray1, PyArray2, PyUntypedArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use toile_sdk::glam::Vec3;

/// Owner of the memory that arrays show; it has no methods.
#[pyclass(frozen, module = "toile")]
#[derive(Debug)]
pub struct Memory(Kept);

#[derive(Debug)]
enum Kept {
    Vectors(Arc<Vec<Vec3>>),
    Triangles(Arc<[[u32; 3]]>),
    Numbers(Vec<f32>),
    Indices(Vec<u32>),
}

/// What a memory lends of one kind; nothing of another.
macro_rules! lends {
    ($name:ident, $Kind:ident, $Item:ty) => {
        fn $name(&self) -> &[$Item] {
            match &self.0 {
                Kept::$Kind(kept) => kept,
                _ => &[],
            }
        }
    };
}

impl Memory {
    lends!(vectors, Vectors, Vec3);
    lends!(triangles, Triangles, [u32; 3]);
    lends!(numbers, Numbers, f32);
    lends!(indices, Indices, u32);
}

const _: () = assert!(size_of::<Vec3>() == 3 * size_of::<f32>() && align_of::<Vec3>() == align_of::<f32>());

/// Positions as numbers, x, y, z of each.
fn flat(vectors: &[Vec3]) -> &[f32] {
    // SAFETY: a `Vec3` is three `f32` in their order, as the line above asserts with glam's `repr(C)`.
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 3 * vectors.len()) }
}

/// Shows what an object of a frozen class lends, as an array of this shape.
fn show<'py, C, T, D>(
    owner: Bound<'py, C>,
    shape: D,
    of: impl for<'a> Fn(&'a C) -> &'a [T],
) -> PyResult<Bound<'py, PyArray<T, D>>>
where
    C: PyClass<Frozen = True> + Sync,
    T: Element,
    D: numpy::ndarray::Dimension,
{
    let lent = owner.clone();
    let view = ArrayView::from_shape(shape, of(lent.get()));
    let view =
        view.map_err(|e| crate::failure::Failure::internal(format!("an array of another shape than its memory: {e}")))?;
    // SAFETY: `of` lends the memory out of the owner for as long as that lives, which is frozen, so that nothing moves or changes
    // it; the array holds the owner. It is handed out only once it cannot be written, for which there is a flag of its own.
    let array = unsafe { PyArray::borrow_from_array(&view, owner.into_any()) };
    // SAFETY: the array was made above and there is no other reference to it yet.
    unsafe { (*array.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE };
    Ok(array)
}

/// Vectors `[n, 3]` that an object lends.
pub fn lent_vectors<'py, C>(
    owner: Bound<'py, C>,
    of: impl for<'a> Fn(&'a C) -> &'a [Vec3],
) -> PyResult<Bound<'py, PyArray2<f32>>>
where
    C: PyClass<Frozen = True> + Sync,
{
    let rows = of(owner.get()).len();
    show(owner, Ix2(rows, 3), move |owner| flat(of(owner)))
}

/// Triangles `[n, 3]` that an object lends.
pub fn lent_triangles<'py, C>(
    owner: Bound<'py, C>,
    of: impl for<'a> Fn(&'a C) -> &'a [[u32; 3]],
) -> PyResult<Bound<'py, PyArray2<u32>>>
where
    C: PyClass<Frozen = True> + Sync,
{
    let rows = of(owner.get()).len();
    show(owner, Ix2(rows, 3), move |owner| of(owner).as_flattened())
}

/// A depth image `[rows, columns]` that an object lends.
pub fn lent_image<'py, C>(
    owner: Bound<'py, C>,
    [rows, columns]: [usize; 2],
    of: impl for<'a> Fn(&'a C) -> &'a [u16],
) -> PyResult<Bound<'py, PyArray2<u16>>>
where
    C: PyClass<Frozen = True> + Sync,
{
    show(owner, Ix2(rows, columns), of)
}

/// Vectors `[n, 3]`, shared.
pub fn vectors(py: Python<'_>, kept: Arc<Vec<Vec3>>) -> PyResult<Bound<'_, PyArray2<f32>>> {
    lent_vectors(Bound::new(py, Memory(Kept::Vectors(kept)))?, Memory::vectors)
}

/// Triangles `[n, 3]`, shared.
pub fn triangles(py: Python<'_>, kept: Arc<[[u32; 3]]>) -> PyResult<Bound<'_, PyArray2<u32>>> {
    lent_triangles(Bound::new(py, Memory(Kept::Triangles(kept)))?, Memory::triangles)
}

/// Numbers `[n]`.
pub fn numbers(py: Python<'_>, kept: Vec<f32>) -> PyResult<Bound<'_, PyArray1<f32>>> {
    let count = Ix1(kept.len());
    show(Bound::new(py, Memory(Kept::Numbers(kept)))?, count, Memory::numbers)
}

/// Numbers of vertices `[n]`.
pub fn indices(py: Python<'_>, kept: Vec<u32>) -> PyResult<Bound<'_, PyArray1<u32>>> {
    let count = Ix1(kept.len());
    show(Bound::new(py, Memory(Kept::Indices(kept)))?, count, Memory::indices)
}
