//! Checks the pointers, arrays and texts that C hands over before they are used.
//!
//! The types here are pointers to C. Rust can make none of them, only a call from C does; and the caller promises what the header
//! says: a pointer which is not null leads to as many elements as the call is told of, which no other thread changes meanwhile.
//! The checks are: null, alignment, a size that no memory has.

use std::ffi::{CStr, c_char};

use toile_sdk::glam::Vec3;

use crate::failure::{Failure, Result};

/// What may be read from and written to memory of C whatever bits it holds.
///
/// # Safety
/// Every pattern of bits is a value of such a type.
pub unsafe trait Plain: Copy {}

// SAFETY: every pattern of 8 bits is an `i8`.
unsafe impl Plain for i8 {}
// SAFETY: every pattern of 8 bits is a `u8`.
unsafe impl Plain for u8 {}
// SAFETY: every pattern of 16 bits is a `u16`.
unsafe impl Plain for u16 {}
// SAFETY: every pattern of 32 bits is a `u32`.
unsafe impl Plain for u32 {}
// SAFETY: every pattern of 32 bits is an `f32`.
unsafe impl Plain for f32 {}

/// An array of C's to be read, or one value; null where there is none.
#[repr(transparent)]
#[derive(Debug)]
pub struct In<T>(*const T);

/// C's place for one value.
#[repr(transparent)]
#[derive(Debug)]
pub struct Out<T>(*mut T);

/// C's place for an array.
#[repr(transparent)]
#[derive(Debug)]
pub struct Buffer<T>(*mut T);

/// A text of C's: UTF-8, ended by a zero.
#[repr(transparent)]
#[derive(Debug, Clone, Copy)]
pub struct Text(*const c_char);

fn null(what: &str) -> Failure {
    Failure::usage(format!("the pointer to the {what} is null; give one"))
}

fn aligned<T>(pointer: *const T, what: &str) -> Result<()> {
    if pointer.is_aligned() {
        return Ok(());
    }
    let bytes = align_of::<T>();
    Err(Failure::usage(format!(
        "the pointer to the {what} does not lie on a multiple of {bytes} bytes; give one of its type"
    )))
}

fn sized<T>(count: usize, what: &str) -> Result<()> {
    if count.checked_mul(size_of::<T>()).is_some_and(|bytes| isize::try_from(bytes).is_ok()) {
        return Ok(());
    }
    Err(Failure::usage(format!("{count} are more {what} than any memory holds; was the number negative?")))
}

impl<T> In<T> {
    /// So many elements; null is right where they are none.
    pub fn slice(&self, count: usize, what: &str) -> Result<&[T]> {
        if count == 0 {
            return Ok(&[]);
        }
        if self.0.is_null() {
            return Err(null(what));
        }
        aligned(self.0, what)?;
        sized::<T>(count, what)?;
        // SAFETY: not null, aligned, of a size that memory can have; that so many elements stand there is the caller's promise.
        Ok(unsafe { std::slice::from_raw_parts(self.0, count) })
    }

    /// The one value, or `None` of null.
    pub fn optional(&self, what: &str) -> Result<Option<&T>> {
        if self.0.is_null() { Ok(None) } else { Ok(self.slice(1, what)?.first()) }
    }

    /// The one value.
    pub fn value(&self, what: &str) -> Result<&T> {
        self.optional(what)?.ok_or_else(|| null(what))
    }
}

impl<T> Out<T> {
    /// No place: the value is not wanted.
    pub const fn nowhere() -> Self {
        Self(std::ptr::null_mut())
    }

    /// Checks it before any work is done.
    pub fn place(&self, what: &str) -> Result<Place<T>> {
        if self.0.is_null() {
            return Err(null(what));
        }
        aligned(self.0, what)?;
        Ok(Place(self.0))
    }

    /// The same, with nothing in it until there is something.
    pub fn empty(&self, what: &str) -> Result<Place<T>>
    where
        T: Default,
    {
        let place = self.place(what)?;
        place.set(T::default());
        Ok(place)
    }

    /// Writes a value where C wants to know it.
    fn tell(&self, value: T, what: &str) -> Result<()> {
        if !self.0.is_null() {
            self.place(what)?.set(value);
        }
        Ok(())
    }
}

/// C's place for a value, checked.
#[derive(Debug)]
pub struct Place<T>(*mut T);

impl<T> Place<T> {
    /// Writes the value, over whatever stands there.
    pub fn set(&self, value: T) {
        // SAFETY: a place is made by `Out::place` alone, of a pointer that is not null and aligned; that it leads to room for a
        // value is the caller's promise. What stood there is C's and is not dropped.
        unsafe { self.0.write(value) };
    }
}

/// How many elements of what an array has to take.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    /// Number of elements for which the caller has room.
    pub room: usize,
    /// Number of elements to write.
    pub needed: usize,
    /// Numbers of each element: 3 of a vertex.
    pub each: usize,
    /// What they are.
    pub what: &'a str,
}

impl<T: Plain> Buffer<T> {
    /// Whether there is one.
    pub fn is_given(&self) -> bool {
        !self.0.is_null()
    }

    /// Tells how many there are, and writes them where there is room for all. If `write` fails, the array holds zeros.
    pub fn fill(
        &self,
        wanted: Wanted<'_>,
        count: &Out<usize>,
        write: impl FnOnce(&mut [T]) -> Result<()>,
    ) -> Result<()> {
        let Wanted { room, needed, each, what } = wanted;
        count.tell(needed, "count")?;
        if self.0.is_null() {
            return match (room, count.0.is_null()) {
                (0, false) => Ok(()),
                (0, true) => Err(Failure::usage(format!("neither room for the {what} is given nor for their number"))),
                _ => Err(null(what)),
            };
        }
        aligned(self.0, what)?;
        if room < needed {
            return Err(Failure::usage(format!(
                "there is room for {room} {what}, and there are {needed}; give room for all"
            )));
        }
        let numbers = needed * each;
        if numbers == 0 {
            return Ok(());
        }
        // C may give memory that nothing was written to yet, of which Rust can make no reference.
        // SAFETY: not null and aligned; that there is room for `room` elements, which are no fewer, is the caller's promise.
        unsafe { self.0.write_bytes(0, numbers) };
        // SAFETY: as above, and the line above has written every element: zeros are a value of a `Plain` type.
        write(unsafe { std::slice::from_raw_parts_mut(self.0, numbers) })
    }
}

impl Buffer<c_char> {
    /// A text with its closing zero.
    pub fn text(&self, text: &str, room: usize, needed: &Out<usize>) -> Result<()> {
        let wanted = Wanted { room, needed: text.len() + 1, each: 1, what: "bytes of the text" };
        self.fill(wanted, needed, |to| {
            let bytes = text.bytes().map(|byte| if byte == 0 { b' ' } else { byte });
            to.iter_mut().zip(bytes.chain([0])).for_each(|(to, byte)| *to = byte as c_char);
            Ok(())
        })
    }
}

impl Text {
    /// The text.
    pub fn of(&self, what: &str) -> Result<&str> {
        self.optional(what)?.ok_or_else(|| null(what))
    }

    /// The text, or `None` of null.
    pub fn optional(&self, what: &str) -> Result<Option<&str>> {
        if self.0.is_null() {
            return Ok(None);
        }
        // SAFETY: not null; that it ends with a zero is the caller's promise.
        let bytes = unsafe { CStr::from_ptr(self.0) };
        let text = bytes.to_str();
        text.map(Some)
            .map_err(|at| Failure::input(format!("the {what} is not UTF-8 from byte {} on", at.valid_up_to())))
    }
}

const _: () = assert!(size_of::<Vec3>() == 3 * size_of::<f32>() && align_of::<Vec3>() == align_of::<f32>());

/// Positions as C has them: x, y, z of each, one after the other.
pub fn vectors(numbers: &mut [f32]) -> &mut [Vec3] {
    let count = numbers.len() / 3;
    // SAFETY: a `Vec3` is three `f32` in their order, as the line above asserts with glam's `repr(C)`; these are no more than given.
    unsafe { std::slice::from_raw_parts_mut(numbers.as_mut_ptr().cast(), count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read_is_refused() {
        let numbers = [1.0_f32, 2.0, 3.0];
        let here = In(numbers.as_ptr());
        assert_eq!(here.slice(3, "numbers").unwrap(), numbers);
        assert!(here.slice(0, "numbers").unwrap().is_empty());
        let nowhere = In::<f32>(std::ptr::null());
        assert!(nowhere.slice(0, "numbers").unwrap().is_empty() && nowhere.optional("number").unwrap().is_none());
        assert!(nowhere.slice(1, "numbers").unwrap_err().sentence.contains("numbers is null"));
        let odd = In(numbers.as_ptr().wrapping_byte_add(1));
        assert!(odd.slice(1, "numbers").unwrap_err().sentence.contains("multiple of 4"));
        assert!(here.slice(usize::MAX, "numbers").unwrap_err().sentence.contains("negative"));
        assert!(here.slice(usize::MAX / 4, "numbers").unwrap_err().sentence.contains("negative"));
    }

    #[test]
    fn an_array_is_filled_or_left_alone() {
        let (mut to, mut count) = ([7.0_f32; 6], 0_usize);
        let (buffer, told) = (Buffer(to.as_mut_ptr()), Out(&raw mut count));
        let wanted = |room| Wanted { room, needed: 2, each: 3, what: "vertices" };
        let ones = |to: &mut [f32]| {
            to.fill(1.0);
            Ok(())
        };
        let refused = buffer.fill(wanted(1), &told, ones).unwrap_err();
        assert!(refused.sentence.contains("room for 1 vertices, and there are 2"), "{}", refused.sentence);
        assert_eq!((to, count), ([7.0; 6], 2));
        buffer.fill(wanted(2), &Out::nowhere(), ones).unwrap();
        assert_eq!(to, [1.0; 6]);
        let nowhere = Buffer::<f32>(std::ptr::null_mut());
        nowhere.fill(wanted(0), &told, ones).unwrap();
        assert!(nowhere.fill(wanted(2), &told, ones).is_err());
        assert!(nowhere.fill(wanted(0), &Out::nowhere(), ones).is_err());
    }

    #[test]
    fn memory_without_values_is_zeroed_first() {
        let mut to = [std::mem::MaybeUninit::<f32>::uninit(); 6];
        let wanted = Wanted { room: 2, needed: 2, each: 3, what: "vertices" };
        let read = |to: &mut [f32]| {
            assert_eq!(to, [0.0; 6], "a writer may read what it is handed");
            Ok(())
        };
        Buffer(to.as_mut_ptr().cast::<f32>()).fill(wanted, &Out::nowhere(), read).unwrap();
    }

    #[test]
    fn texts_are_utf8() {
        assert_eq!(Text(c"strap-dress".as_ptr()).of("name").unwrap(), "strap-dress");
        assert!(Text(c"a\xff".as_ptr()).of("name").unwrap_err().sentence.contains("not UTF-8 from byte 1"));
        assert!(Text(std::ptr::null()).of("name").unwrap_err().sentence.contains("name is null"));
    }
}
