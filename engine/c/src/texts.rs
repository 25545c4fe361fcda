//! Texts that are lent to C.

use std::ffi::{CString, c_char};

/// A text with a closing zero; a zero within becomes a space.
pub fn lent(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// The pointer to a text, or null where there is none.
pub fn pointer(text: Option<&CString>) -> *const c_char {
    text.map_or(std::ptr::null(), |text| text.as_ptr())
}
