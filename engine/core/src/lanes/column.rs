//! Columns: one number a particle, padded and aligned for the widest lanes, shared by the workers of a step.

use std::marker::PhantomData;

use bytemuck::{Pod, Zeroable};

use super::MOST;

/// One cache line, one widest vector.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct Line([f32; MOST]);

/// Owns the numbers of a column. Made at load; its length never changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Store {
    lines: Box<[Line]>,
    len: usize,
}

impl Store {
    /// So many zeros.
    pub fn zeros(len: usize) -> Self {
        Self { lines: vec![Line([0.0; MOST]); len.div_ceil(MOST)].into(), len }
    }

    /// The numbers of an iterator.
    pub fn collect(values: impl ExactSizeIterator<Item = f32>) -> Self {
        let mut this = Self::zeros(values.len());
        this.as_mut().iter_mut().zip(values).for_each(|(to, v)| *to = v);
        this
    }

    /// Its numbers.
    pub fn as_slice(&self) -> &[f32] {
        &bytemuck::cast_slice(&self.lines)[..self.len]
    }

    /// Its numbers, to write.
    #[expect(clippy::should_implement_trait, reason = "a method that reads well; no caller is generic over AsMut")]
    pub fn as_mut(&mut self) -> &mut [f32] {
        &mut bytemuck::cast_slice_mut(&mut self.lines)[..self.len]
    }

    /// As a column for kernels.
    pub fn column(&mut self) -> Column<'_> {
        Column::new(self.as_mut())
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.lines)
    }
}

/// A column as kernels see it: any place may be read and written, through a copy a worker.
///
/// Soundness: a column is made from a unique borrow and does not outlive it. Its copies may be used by the workers of
/// one step at once; that they never touch the same place between two meetings is what the bake's split guarantees
/// (`garment::layout`: no two constraints of a set share a particle, each particle and each constraint has one owner)
/// and the bake asserts. Every access is checked against the length.
#[derive(Clone, Copy)]
pub struct Column<'a> {
    data: *mut f32,
    len: usize,
    owner: PhantomData<&'a mut [f32]>,
}

// SAFETY: see the type; f32 may be sent, and the workers' places are disjoint.
unsafe impl Send for Column<'_> {}
// SAFETY: as above.
unsafe impl Sync for Column<'_> {}

impl<'a> Column<'a> {
    /// A column over numbers that nobody else can reach meanwhile.
    pub fn new(numbers: &'a mut [f32]) -> Self {
        Self { data: numbers.as_mut_ptr(), len: numbers.len(), owner: PhantomData }
    }

    /// Numbers that are only read: constants of the bake.
    pub fn read_only(numbers: &'a [f32]) -> Self {
        Self { data: numbers.as_ptr().cast_mut(), len: numbers.len(), owner: PhantomData }
    }

    /// How many.
    #[inline(always)]
    #[expect(clippy::len_without_is_empty, reason = "no caller asks")]
    pub fn len(self) -> usize {
        self.len
    }

    /// `len` numbers from `start` on as a column of their own.
    ///
    /// # Panics
    /// Where they are not all there.
    pub fn part(self, start: usize, len: usize) -> Self {
        Self { data: self.place(start, len), len, owner: PhantomData }
    }

    /// One number; 0 past the end.
    #[inline(always)]
    pub fn get(self, at: usize) -> f32 {
        // SAFETY: within the length.
        if at < self.len { unsafe { *self.data.add(at) } } else { 0.0 }
    }

    /// Writes one number; nothing past the end.
    #[inline(always)]
    pub fn set(self, at: usize, value: f32) {
        if at < self.len {
            // SAFETY: within the length.
            unsafe { *self.data.add(at) = value }
        }
    }

    /// Its first `len` numbers; columns cut to one length share their checks.
    ///
    /// # Panics
    /// Where there are not so many.
    #[inline(always)]
    pub fn cut(self, len: usize) -> Self {
        assert!(len <= self.len, "a column is shorter than the others");
        Self { len, ..self }
    }

    /// Where `n` numbers from `at` on lie.
    ///
    /// # Panics
    /// Where they are not all there, which no index of a bake is: the check of a slice, once a vector.
    #[inline(always)]
    pub(super) fn place(self, at: usize, n: usize) -> *mut f32 {
        // Two comparisons of which the first does not depend on the place: it leaves the loop.
        assert!(n <= self.len, "a kernel left its column");
        assert!(at <= self.len - n, "a kernel left its column");
        // SAFETY: within the length, or its end.
        unsafe { self.data.add(at) }
    }

    /// Where four times four numbers lie.
    ///
    /// # Panics
    /// Where they are not all there.
    #[inline(always)]
    pub(super) fn quads(self, at: &[u32; 4]) -> [*mut f32; 4] {
        let last = at[0].max(at[1]).max(at[2].max(at[3]));
        self.place(last as usize, 4);
        // SAFETY: none begins later than one that is within the length.
        at.map(|q| unsafe { self.data.add(q as usize) })
    }
}
