//! Columns: one number a particle, padded and aligned for the widest lanes, shared by the workers of a step.

use std::marker::PhantomData;

use bytemuck::{Pod, Zeroable};

/// Most lanes of any width: storage is padded to it.
pub const MOST: usize = 16;

/// Numbers of a table ([`Lanes::among`](super::Lanes::among)): two of the widest vectors.
pub const TABLE: usize = 2 * MOST;

/// One cache line, one widest vector.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct CacheLine([f32; MOST]);

/// Owns the numbers of a column. Made at load; its length never changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Store {
    lines: Box<[CacheLine]>,
    len: usize,
}

impl Store {
    /// A column of `len` zeros.
    pub fn zeros(len: usize) -> Self {
        Self { lines: vec![CacheLine([0.0; MOST]); len.div_ceil(MOST)].into(), len }
    }

    /// Its numbers, without the padding behind them.
    pub fn as_slice(&self) -> &[f32] {
        &bytemuck::cast_slice(&self.lines)[..self.len]
    }

    /// Its numbers, to write.
    #[expect(clippy::should_implement_trait, reason = "a method that reads well; no caller is generic over AsMut")]
    pub fn as_mut(&mut self) -> &mut [f32] {
        &mut bytemuck::cast_slice_mut(&mut self.lines)[..self.len]
    }

    /// As a column for kernels.
    pub fn column(&mut self) -> WriteColumn<'_> {
        WriteColumn::new(self.as_mut())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.lines)
    }
}

/// What kernels read numbers from: a [`ReadColumn`] or a [`WriteColumn`].
pub trait Readable: Copy + sealed::Sealed {
    /// The same numbers, to read.
    fn reader(&self) -> ReadColumn<'_>;
}

mod sealed {
    /// Only this file's columns are readable.
    pub trait Sealed {}
    impl Sealed for super::ReadColumn<'_> {}
    impl Sealed for super::WriteColumn<'_> {}
}

/// A column that can only be read: constants of the bake, or what another column holds at the moment.
///
/// It has no method that writes, so numbers that were lent for reading stay as they are:
/// ```compile_fail,E0599
/// #![forbid(unsafe_code)]
/// use toile_engine::lanes::ReadColumn;
/// let shared = vec![1.0_f32, 2.0, 3.0];
/// let column = ReadColumn::new(&shared);
/// column.set(1, 99.0);
/// ```
/// ```compile_fail,E0308
/// #![forbid(unsafe_code)]
/// use toile_engine::lanes::{Numbers, ReadColumn};
/// static CONSTANT: [f32; 4] = [0.0; 4];
/// 1.0_f32.store(ReadColumn::new(&CONSTANT), 0);
/// ```
/// Nor can it be made a column that writes:
/// ```compile_fail,E0308
/// use toile_engine::lanes::WriteColumn;
/// let shared = vec![1.0_f32, 2.0, 3.0];
/// WriteColumn::new(&shared).set(1, 99.0);
/// ```
/// It may show what a [`WriteColumn`] of the same thread writes, so it stays on its thread too:
/// ```compile_fail,E0277
/// use toile_engine::lanes::ReadColumn;
/// let shared = vec![1.0_f32, 2.0, 3.0];
/// let column = ReadColumn::new(&shared);
/// std::thread::scope(|scope| _ = scope.spawn(|| column.get(0)));
/// ```
#[derive(Clone, Copy)]
pub struct ReadColumn<'a> {
    data: *const f32,
    len: usize,
    lender: PhantomData<&'a [f32]>,
}

/// A column that can be read and written, by every copy of it, on the thread on which it was made.
///
/// Soundness: it is made from a unique borrow and does not outlive it, so only its copies reach the numbers. The
/// raw pointer keeps them all on one thread (neither `Send` nor `Sync`), where one access follows the other, as with
/// `&[Cell<f32>]`. Every access is checked against the length. Only this crate hands columns to other threads, through
/// `Shared`.
/// ```compile_fail,E0277
/// use toile_engine::lanes::WriteColumn;
/// let mut numbers = vec![1.0_f32, 2.0, 3.0];
/// let column = WriteColumn::new(&mut numbers);
/// std::thread::scope(|scope| {
///     scope.spawn(|| column.set(0, 5.0));
///     scope.spawn(|| column.set(0, 6.0));
/// });
/// ```
/// ```compile_fail,E0502
/// use toile_engine::lanes::WriteColumn;
/// let mut numbers = vec![1.0_f32, 2.0, 3.0];
/// let column = WriteColumn::new(&mut numbers);
/// let first = &numbers[0];
/// column.set(0, 5.0);
/// assert_eq!(*first, 1.0);
/// ```
#[derive(Clone, Copy)]
pub struct WriteColumn<'a> {
    data: *mut f32,
    len: usize,
    owner: PhantomData<&'a mut [f32]>,
}

/// Columns on their way to the workers of one step: they go to any thread, but no thread reads or writes them before
/// [`Shared::open`].
#[derive(Clone, Copy)]
pub(crate) struct Shared<T>(T);

// SAFETY: nothing within can be reached but through `open`, whose caller answers for what the threads do with it.
unsafe impl<T: Copy> Send for Shared<T> {}
// SAFETY: a shared reference gives access through `open` alone, whose caller answers for what the threads do.
unsafe impl<T: Copy> Sync for Shared<T> {}

impl<T: Copy> Shared<T> {
    /// Wraps columns up.
    pub(crate) fn new(columns: T) -> Self {
        Self(columns)
    }

    /// The columns, for the calling thread.
    ///
    /// # Safety
    /// Until the next barrier, no place of the columns that this thread writes is read or written by another, and
    /// none that it reads is written by another. All writes before the last barrier happened before this call.
    pub(crate) unsafe fn open(&self) -> T {
        self.0
    }

    /// The same for tests whose jobs keep to places of their own.
    #[cfg(test)]
    pub(crate) fn open_in_test(&self) -> T {
        // SAFETY: each job of such a test writes only what belongs to its share, and reads what was written a phase before.
        unsafe { self.open() }
    }
}

/// Stops a kernel that has left its column.
#[cold]
#[inline(never)]
fn outside(at: usize, n: usize, len: usize) -> ! {
    panic!("a kernel left its column: {n} numbers from {at} on, of {len}");
}

impl<'a> ReadColumn<'a> {
    /// Makes a column over numbers that no thread writes meanwhile.
    #[inline(always)]
    pub fn new(numbers: &'a [f32]) -> Self {
        Self { data: numbers.as_ptr(), len: numbers.len(), lender: PhantomData }
    }

    /// How many numbers it has.
    #[inline(always)]
    #[expect(clippy::len_without_is_empty, reason = "no caller asks")]
    pub fn len(self) -> usize {
        self.len
    }

    /// One number.
    ///
    /// # Panics
    /// Past the end.
    #[inline(always)]
    pub fn get(self, at: usize) -> f32 {
        if at >= self.len {
            outside(at, 1, self.len);
        }
        // SAFETY: within the length; what it lies in is lent for 'a.
        unsafe { *self.data.add(at) }
    }

    /// Where `n` numbers from `at` on lie.
    ///
    /// # Panics
    /// Where they are not all there, which no index of a bake is: the check of a slice, once a vector.
    #[inline(always)]
    pub(super) fn place(self, at: usize, n: usize) -> *const f32 {
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
    #[allow(dead_code, reason = "only vectors of a processor read four numbers at once")]
    pub(super) fn quads(self, at: &[u32; 4]) -> [*const f32; 4] {
        let last = at[0].max(at[1]).max(at[2].max(at[3]));
        self.place(last as usize, 4);
        // SAFETY: none begins later than one that is within the length.
        at.map(|q| unsafe { self.data.add(q as usize) })
    }
}

impl Readable for ReadColumn<'_> {
    #[inline(always)]
    fn reader(&self) -> ReadColumn<'_> {
        *self
    }
}

impl Readable for WriteColumn<'_> {
    #[inline(always)]
    fn reader(&self) -> ReadColumn<'_> {
        ReadColumn { data: self.data, len: self.len, lender: PhantomData }
    }
}

impl<'a> WriteColumn<'a> {
    /// Makes a column over numbers that no other code can reach meanwhile.
    #[inline(always)]
    pub fn new(numbers: &'a mut [f32]) -> Self {
        Self { data: numbers.as_mut_ptr(), len: numbers.len(), owner: PhantomData }
    }

    /// How many numbers it has.
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

    /// The same numbers, to read, for as long as the column is there.
    #[inline(always)]
    pub fn to_read(self) -> ReadColumn<'a> {
        ReadColumn { data: self.data, len: self.len, lender: PhantomData }
    }

    /// One number.
    ///
    /// # Panics
    /// Past the end.
    #[inline(always)]
    pub fn get(self, at: usize) -> f32 {
        self.reader().get(at)
    }

    /// Writes one number.
    ///
    /// # Panics
    /// Past the end.
    #[inline(always)]
    pub fn set(self, at: usize, value: f32) {
        if at >= self.len {
            outside(at, 1, self.len);
        }
        // SAFETY: within the length; only copies of this column, all on this thread, reach the numbers.
        unsafe { *self.data.add(at) = value }
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
    /// Where they are not all there.
    #[inline(always)]
    pub(super) fn place(self, at: usize, n: usize) -> *mut f32 {
        self.reader().place(at, n).cast_mut()
    }

    /// Where four times four numbers lie.
    ///
    /// # Panics
    /// Where they are not all there.
    #[inline(always)]
    #[allow(dead_code, reason = "only vectors of a processor read four numbers at once")]
    pub(super) fn quads(self, at: &[u32; 4]) -> [*mut f32; 4] {
        self.reader().quads(at).map(<*const f32>::cast_mut)
    }
}
