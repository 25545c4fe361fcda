//! Cause of a failed call: a code for programs, a sentence for people, kept for the thread that called.

use std::cell::{Cell, RefCell};
use std::ffi::{CString, c_char};
use std::fmt::Display;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

use toile_sdk::{Error, ErrorKind};

/// How a call ended. The numbers are those with which the program `toile` exits.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Code {
    /// It is done.
    Ok = 0,
    /// The call itself is wrong: a null pointer, a handle that was closed, an index out of range, a busy scene.
    Usage = 2,
    /// What was given cannot be used: a file, a name, a measure, a mesh, a number that is not finite.
    Input = 4,
    /// The system does not give what is needed: a thread, a file that can be written.
    Device = 5,
    /// A fault of Toile's own. The scene that was called, if any, can only be closed.
    Internal = 70,
}

/// A code that is not `Ok`, and its sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    pub code: Code,
    pub sentence: String,
}

/// What the work of a call gives.
pub type Result<T> = std::result::Result<T, Failure>;

impl Failure {
    pub fn usage(sentence: impl Display) -> Self {
        Self { code: Code::Usage, sentence: sentence.to_string() }
    }

    pub fn input(sentence: impl Display) -> Self {
        Self { code: Code::Input, sentence: sentence.to_string() }
    }

    pub fn internal(sentence: impl Display) -> Self {
        Self { code: Code::Internal, sentence: sentence.to_string() }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let code = match error.kind() {
            ErrorKind::Usage => Code::Usage,
            ErrorKind::Input => Code::Input,
            ErrorKind::Device => Code::Device,
            _ => Code::Internal,
        };
        Self { code, sentence: error.sentence().to_owned() }
    }
}

thread_local! {
    /// The sentence of the last call of this thread that failed.
    static LAST: RefCell<CString> = RefCell::new(CString::default());
    /// Whether this thread is within a call, whose panics are reported by its code.
    static IN_CALL: Cell<bool> = const { Cell::new(false) };
    /// What the panic said that ends this thread's call.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Does the work of the call `name`, lets no panic out, and keeps the sentence of what failed.
pub fn call(name: &str, work: impl FnOnce() -> Result<()>) -> Code {
    static HOOK: Once = Once::new();
    HOOK.call_once(listen_to_panics);
    // A thread that ends has no storage any more; its panics then go to the hook that was there before.
    let within = |inside| _ = IN_CALL.try_with(|of| of.set(inside));
    within(true);
    let done = panic::catch_unwind(AssertUnwindSafe(work));
    within(false);
    let failure = match done {
        Ok(Ok(())) => return Code::Ok,
        Ok(Err(failure)) => failure,
        Err(_) => {
            let said = PANIC.try_with(RefCell::take).unwrap_or_default();
            Failure::internal(format!(
                "a fault of Toile's own ended the call: {said}; close the scene that it was made on, if any, and report this"
            ))
        }
    };
    let sentence = format!("{name}: {}", failure.sentence).replace('\0', " ");
    _ = LAST.try_with(|last| *last.borrow_mut() = CString::new(sentence).unwrap_or_default());
    failure.code
}

/// Keeps what a panic within a call says, and leaves all others to the hook that is there.
fn listen_to_panics() {
    let before = panic::take_hook();
    panic::set_hook(Box::new(move |info: &PanicHookInfo<'_>| {
        if !IN_CALL.try_with(Cell::get).unwrap_or_default() {
            return before(info);
        }
        let said = info.payload().downcast_ref::<&str>().copied();
        let said = said.or_else(|| info.payload().downcast_ref::<String>().map(String::as_str));
        let said = said.unwrap_or("it does not say why");
        let place = info.location().map(|at| format!(" ({}:{})", at.file(), at.line())).unwrap_or_default();
        _ = PANIC.try_with(|of| *of.borrow_mut() = format!("{said}{place}"));
    }));
}

/// What the last call of this thread that failed had to say: one sentence with the cure, UTF-8, after the name of the call. Empty
/// before any failed. A call that succeeds leaves it as it is. It lives until the next call of this thread fails.
#[unsafe(no_mangle)]
pub extern "C" fn toile_last_error() -> *const c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;

    use super::*;

    /// As C would see it: a function of C's calling convention, whose work panics.
    extern "C" fn panics() -> Code {
        call("panics", || panic!("number {}", 17))
    }

    fn last() -> String {
        let last = toile_last_error();
        // SAFETY: the pointer is that of a C string of this thread.
        unsafe { CStr::from_ptr(last) }.to_str().unwrap().to_owned()
    }

    #[test]
    fn a_panic_becomes_a_code_and_a_sentence() {
        assert_eq!(panics(), Code::Internal);
        let said = last();
        assert!(said.starts_with("panics: a fault of Toile's own") && said.contains("number 17"), "{said}");
        assert!(said.contains("failure.rs:"), "{said}");
        assert_eq!(call("fine", || Ok(())), Code::Ok);
        assert_eq!(last(), said, "a call that succeeds leaves the sentence");
    }

    #[test]
    fn a_sentence_belongs_to_its_thread() {
        assert_eq!(call("mine", || Err(Failure::usage("a\0b"))), Code::Usage);
        std::thread::spawn(|| assert_eq!(last(), "")).join().unwrap();
        assert_eq!(last(), "mine: a b");
    }
}
