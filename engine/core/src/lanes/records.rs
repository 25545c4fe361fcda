//! Records: four numbers a particle side by side, for what reads particles in no order. One record is one load.

use super::column::WriteColumn;

/// Numbers of a record.
pub const RECORD: usize = 4;

/// Numbers of two records side by side, which are written at once.
pub const DOUBLE: usize = 2 * RECORD;

/// Which records of a column are taken, one after the other. Made at load.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordList {
    /// Where each record begins.
    at: Box<[u32]>,
    /// Behind the last number of all of them.
    end: usize,
    /// Whether each has another behind it, that is its own.
    double: bool,
}

impl RecordList {
    /// The records of these numbers.
    ///
    /// # Panics
    /// Where a number is beyond what 32 bits can place: 2^30 records.
    pub fn new(records: impl IntoIterator<Item = u32>) -> Self {
        Self::wide(records, RECORD)
    }

    /// The double records of these numbers ([`Lanes::store_doubles`](super::Lanes::store_doubles)).
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn doubles(records: impl IntoIterator<Item = u32>) -> Self {
        Self::wide(records, DOUBLE)
    }

    fn wide(records: impl IntoIterator<Item = u32>, numbers: usize) -> Self {
        let place = |r: u32| r.checked_mul(numbers as u32).expect("a garment has far fewer particles");
        let at: Box<[u32]> = records.into_iter().map(place).collect();
        let end = at.iter().max().map_or(0, |last| *last as usize + numbers);
        Self { at, end, double: numbers == DOUBLE }
    }

    /// Number of records in the list.
    pub fn len(&self) -> usize {
        self.at.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.at.is_empty()
    }

    /// The number of a record.
    pub fn record(&self, k: usize) -> u32 {
        self.at[k] / RECORD as u32
    }

    /// The same records in a column.
    ///
    /// # Panics
    /// Where the column ends before one of them.
    #[inline(always)]
    pub fn within<'a>(&'a self, column: WriteColumn<'a>) -> RecordsAt<'a> {
        assert!(self.end <= column.len(), "a record lies outside of its column");
        RecordsAt { first: column.place(0, self.end), at: &self.at, double: self.double, column }
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.at)
    }
}

/// Records of a column, in some order: those of a list ([`RecordsAt`]) or one after the other ([`RecordRun`]).
pub trait Records: Copy + sealed::SealedRecords {
    /// Checks that there are `n` records from the `k`th on.
    ///
    /// # Panics
    /// Where there are not so many.
    fn check(self, k: usize, n: usize);

    /// Where the `k`th record begins: within the column, with all its numbers.
    ///
    /// # Safety
    /// It is one of those that [`Records::check`] has let pass.
    #[doc(hidden)]
    unsafe fn place(self, k: usize) -> *mut f32;

    /// One number of the `k`th record.
    fn get(self, k: usize, number: usize) -> f32;

    /// Writes it.
    fn set(self, k: usize, number: usize, value: f32);
}

mod sealed {
    /// Vectors are read where this file's types say.
    pub trait SealedRecords {}
    impl SealedRecords for super::RecordsAt<'_> {}
    impl SealedRecords for super::RecordRun<'_> {}
}

/// The records of a list in a column that has all of them.
#[derive(Clone, Copy)]
pub struct RecordsAt<'a> {
    /// Where the column begins.
    first: *mut f32,
    /// Within the column, with all numbers of each record: [`RecordList::within`] has checked it.
    at: &'a [u32],
    double: bool,
    column: WriteColumn<'a>,
}

impl RecordsAt<'_> {
    /// Checks that there are `n` double records from the `k`th on.
    ///
    /// # Panics
    /// Where there are not so many.
    #[inline(always)]
    pub fn check_doubles(self, k: usize, n: usize) {
        assert!(self.double, "a list of single records");
        self.check(k, n);
    }
}

impl Records for RecordsAt<'_> {
    #[inline(always)]
    fn check(self, k: usize, n: usize) {
        assert!(n <= self.at.len() && k <= self.at.len() - n, "a list of records ends before");
    }
    #[inline(always)]
    unsafe fn place(self, k: usize) -> *mut f32 {
        // SAFETY: the list has it, by the caller; each of the list is within the column.
        unsafe { self.first.add(*self.at.get_unchecked(k) as usize) }
    }
    #[inline(always)]
    fn get(self, k: usize, number: usize) -> f32 {
        self.column.get(self.at[k] as usize + number)
    }
    #[inline(always)]
    fn set(self, k: usize, number: usize, value: f32) {
        self.column.set(self.at[k] as usize + number, value);
    }
}

/// The records of a column one after the other.
#[derive(Clone, Copy)]
pub struct RecordRun<'a>(pub WriteColumn<'a>);

impl Records for RecordRun<'_> {
    #[inline(always)]
    fn check(self, k: usize, n: usize) {
        _ = self.0.place(RECORD * k, RECORD * n);
    }
    #[inline(always)]
    unsafe fn place(self, k: usize) -> *mut f32 {
        // SAFETY: the column has a record there, by the caller.
        unsafe { self.0.place(0, 0).add(RECORD * k) }
    }
    #[inline(always)]
    fn get(self, k: usize, number: usize) -> f32 {
        self.0.get(RECORD * k + number)
    }
    #[inline(always)]
    fn set(self, k: usize, number: usize, value: f32) {
        self.0.set(RECORD * k + number, value);
    }
}
