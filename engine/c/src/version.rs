//! Versions, and the names of garments, fabrics and measures.

use std::ffi::{CStr, CString, c_char};
use std::sync::OnceLock;

use toile_sdk::{fabric_names, fit_colour, garment_names, measure_names};

use crate::border::{Buffer, Out, Wanted};
use crate::failure::{Code, Failure, call};
use crate::texts::{lent, pointer};

/// The number of this header's ABI, which the name of the shared library carries. It rises with whatever breaks a program that was
/// built before: compare it with toile_abi_version() where the library is loaded at run time.
pub const TOILE_ABI_VERSION: u32 = 1;

/// The version, such as 0.3.0.
const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => panic!("a version has no zero within"),
};

/// A list of names.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameList {
    /// Garments that are built in.
    Garments = 0,
    /// Fabrics that are built in.
    Fabrics = 1,
    /// Measures of a body.
    Measures = 2,
}

/// The version of the library, such as "0.3.0"; it lives for ever.
#[unsafe(no_mangle)]
pub extern "C" fn toile_version() -> *const c_char {
    VERSION.as_ptr()
}

/// The TOILE_ABI_VERSION that the library was built with.
#[unsafe(no_mangle)]
pub extern "C" fn toile_abi_version() -> u32 {
    TOILE_ABI_VERSION
}

/// A name of a list (a toile_name_list) by its number from 0; null behind the last one, and of an unknown list, which
/// toile_last_error() then says. It lives for ever.
#[unsafe(no_mangle)]
pub extern "C" fn toile_name(list: i32, index: usize) -> *const c_char {
    static NAMES: OnceLock<[Vec<CString>; 3]> = OnceLock::new();
    let mut found = std::ptr::null();
    call("toile_name", || {
        let lists = NAMES.get_or_init(|| {
            [garment_names(), fabric_names(), measure_names()].map(|names| names.into_iter().map(lent).collect())
        });
        let all = [NameList::Garments, NameList::Fabrics, NameList::Measures];
        let list = all.into_iter().zip(lists).find(|(own, _)| *own as i32 == list);
        let (_, list) =
            list.ok_or_else(|| Failure::usage("there is no such list of names; give one of toile_name_list"))?;
        found = pointer(list.get(index));
        Ok(())
    });
    found
}

/// The colour of a value of a fit map, -1 (loose) .. 1 (tight): sRGB into rgb[3], one of eight steps that colour-blind readers tell
/// apart. Mid grey for NaN.
#[unsafe(no_mangle)]
pub extern "C" fn toile_fit_colour(tightness: f32, rgb: Buffer<u8>) -> Code {
    call("toile_fit_colour", || {
        rgb.fill(Wanted { room: 3, needed: 3, each: 1, what: "bytes of the colour" }, &Out::nowhere(), |rgb| {
            rgb.copy_from_slice(&fit_colour(tightness));
            Ok(())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shared_library_is_named_by_the_abi() {
        let script = include_str!("../build.rs");
        assert!(script.contains(&format!("const ABI_VERSION: u32 = {TOILE_ABI_VERSION};")));
    }
}
