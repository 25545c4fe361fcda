//! Lines of text.

/// Adds a line to a text: what `writeln!` does where writing cannot fail, as into a `String`.
#[macro_export]
macro_rules! put_line {
    ($text:expr $(, $($words:tt)*)?) => {{
        use std::fmt::Write as _;
        let _ = writeln!($text $(, $($words)*)?);
    }};
}
