//! What is alike for every vector of a processor: its operators and traits, written once as a macro over the names of the
//! processor's instructions.
//!
//! Soundness: a module makes a type by `vector!` only where the processor surely has its instructions: by its architecture
//! (SSE2 on x86-64, NEON on aarch64), by a feature of the compilation (SIMD128), or because it was asked at run time.

#![allow(unused_macros, unused_imports, reason = "a processor whose vectors no module has uses plain Rust")]

/// A vector type of `$n` lanes over `$raw`. The module adds what each width does in its own way: `read`, `write`, `less`,
/// `choose`, `seed`, `down`, `up`, `but_first`, `pick`, `spread`, `pick_among`, `lowest`, and the same for quads and records.
macro_rules! vector {
    ($name:ident, $raw:ty, $answers:ident, $n:literal, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident,
     $min:ident, $max:ident, $set:ident, $load:ident, $store:ident) => {
        /// A vector of this width.
        #[derive(Clone, Copy)]
        pub struct $name($raw);

        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $add(self.0, o.0) })
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $sub(self.0, o.0) })
            }
        }
        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $mul(self.0, o.0) })
            }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::splat(-0.0) - self
            }
        }
        impl Numbers for $name {
            const N: usize = $n;
            type Mask = $answers;

            #[inline(always)]
            fn splat(value: f32) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $set(value) })
            }
            #[inline(always)]
            fn load(from: impl Readable, at: usize) -> Self {
                let place = from.reader().place(at, $n);
                // SAFETY: `place` has checked that the column has `$n` numbers there.
                Self(unsafe { $load(place) })
            }
            #[inline(always)]
            fn load_part(from: impl Readable, at: usize, n: usize) -> Self {
                let place = from.reader().place(at, n.min($n));
                // SAFETY: `place` has checked that the column has `n` numbers there, and no more are read.
                unsafe { Self::read(place, n.min($n)) }
            }
            #[inline(always)]
            fn store(self, to: WriteColumn<'_>, at: usize) {
                let place = to.place(at, $n);
                // SAFETY: `place` has checked that the column has `$n` numbers there.
                unsafe { $store(place, self.0) }
            }
            #[inline(always)]
            fn store_part(self, to: WriteColumn<'_>, at: usize, n: usize) {
                let place = to.place(at, n.min($n));
                // SAFETY: `place` has checked that the column has `n` numbers there, and no more are written.
                unsafe { self.write(place, n.min($n)) }
            }
            #[inline(always)]
            fn div(self, by: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $div(self.0, by.0) })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn min(self, o: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $min(self.0, o.0) })
            }
            #[inline(always)]
            fn max(self, o: Self) -> Self {
                // SAFETY: the processor has the instruction, since the type exists only where it has (see the module).
                Self(unsafe { $max(self.0, o.0) })
            }
            #[inline(always)]
            fn lt(self, o: Self) -> $answers {
                self.less(o)
            }
            #[inline(always)]
            fn select(self, mask: $answers, o: Self) -> Self {
                self.choose(mask, o)
            }
            #[inline(always)]
            fn root_seed(self, magic: u32) -> Self {
                self.seed(magic)
            }
            #[inline(always)]
            fn rotate_down(self) -> Self {
                self.down()
            }
            #[inline(always)]
            fn rotate_up(self) -> Self {
                self.up()
            }
            #[inline(always)]
            fn with_first(self, other: Self) -> Self {
                self.but_first(other)
            }
        }
        impl Lanes for $name {
            #[inline(always)]
            fn from_array(values: &[f32; MOST]) -> Self {
                // SAFETY: the array has `MOST` numbers, which is no fewer than `$n`.
                Self(unsafe { $load(values.as_ptr()) })
            }
            #[inline(always)]
            fn to_array(self) -> [f32; MOST] {
                let mut out = [0.0; MOST];
                // SAFETY: the array has `MOST` numbers, which is no fewer than `$n`.
                unsafe { $store(out.as_mut_ptr(), self.0) };
                out
            }
            #[inline(always)]
            fn gather(from: impl Readable, index: &[u32], n: usize) -> Self {
                Self::pick(from, &index[..n.min($n)])
            }
            #[inline(always)]
            fn scatter(self, to: WriteColumn<'_>, index: &[u32], n: usize) {
                self.spread(to, &index[..n.min($n)]);
            }
            #[inline(always)]
            fn among(table: &[f32; TABLE], at: &[u32; MOST]) -> Self {
                Self::pick_among(table, at)
            }
            #[inline(always)]
            fn load_quads(from: impl Readable, quads: &[u32; 4], lane: usize) -> Self {
                // SAFETY: `quads` has checked that the column has four numbers at each place.
                unsafe { Self::read_quads(from.reader().quads(quads), lane / 4 % 4) }
            }
            #[inline(always)]
            fn store_quads(self, to: WriteColumn<'_>, quads: &[u32; 4], lane: usize) {
                // SAFETY: `quads` has checked that the column has four numbers at each place.
                unsafe { self.write_quads(to.quads(quads), lane / 4 % 4) }
            }
            #[inline(always)]
            fn load_records(from: impl Records, k: usize) -> [Self; RECORD] {
                from.check(k, $n);
                // SAFETY: `check` has seen `$n` records from the `k`th on.
                unsafe { Self::read_records(from, k) }
            }
            #[inline(always)]
            fn store_records(values: [Self; RECORD], to: impl Records, k: usize) {
                to.check(k, $n);
                // SAFETY: `check` has seen `$n` records from the `k`th on.
                unsafe { Self::write_records(values, to, k) }
            }
            #[inline(always)]
            fn store_doubles(values: [Self; DOUBLE], to: RecordsAt<'_>, k: usize) {
                to.check_doubles(k, $n);
                // SAFETY: `check_doubles` has seen `$n` double records from the `k`th on.
                unsafe { Self::write_doubles(values, to, k) }
            }
            #[inline(always)]
            fn least(self) -> f32 {
                self.lowest()
            }
        }
    };
}
pub(super) use vector;

/// One number after another: what widths without such an instruction do.
macro_rules! by_hand {
    ($name:ident, $($method:ident),+) => {
        impl $name {
            $(by_hand!(@ $method);)+
        }
    };
    (@ pick) => {
        #[inline(always)]
        pub(super) fn pick_among(table: &[f32; TABLE], at: &[u32; MOST]) -> Self {
            Self::pick(ReadColumn::new(table), &at[..Self::N])
        }
        #[inline(always)]
        pub(super) fn pick(from: impl Readable, index: &[u32]) -> Self {
            if index.len() == Self::N {
                // Never by way of an array, as in `Four::read`.
                return Self::pick_all(from, index);
            }
            let mut values = [0.0; MOST];
            for (v, &i) in values.iter_mut().zip(index) {
                *v = from.reader().get(i as usize);
            }
            Self::from_array(&values)
        }
    };
    (@ spread) => {
        #[inline(always)]
        pub(super) fn spread(self, to: WriteColumn<'_>, index: &[u32]) {
            for (v, &i) in self.to_array().into_iter().zip(index) {
                to.set(i as usize, v);
            }
        }
    };
}
pub(super) use by_hand;
