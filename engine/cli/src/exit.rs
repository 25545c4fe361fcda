//! End of a run: the exit codes, the one error type, and the message of a panic.

use std::fmt::Display;
use std::io;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use toile_fitting::FittingError;

use crate::output::OutputError;

/// Exit codes of the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Code {
    /// The work was done.
    Ok = 0,
    /// The command line was not understood, or names a program that is not installed.
    Usage = 2,
    /// The work was done, but a figure missed its threshold.
    Threshold = 3,
    /// A file, an asset or a folder cannot be used.
    BadInput = 4,
    /// A device, such as the GPU that was asked for, is not available.
    Device = 5,
    /// A replay did not give the bits that were recorded.
    Diverged = 6,
    /// Toile itself is at fault.
    Internal = 70,
}

impl From<Code> for ExitCode {
    fn from(code: Code) -> Self {
        Self::from(code as u8)
    }
}

/// Every way in which a command can fail. The text is one sentence: what, where, and the cure.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// The command line was not understood, or names a program that is not installed.
    #[error("{0}")]
    Usage(String),
    /// A figure missed its threshold.
    #[error("{0}")]
    Threshold(String),
    /// A file, an asset or a folder cannot be used.
    #[error("{0}")]
    Input(String),
    /// A device is not available.
    #[error("{0}")]
    Device(String),
    /// A replay did not give the recorded bits.
    #[error("{0}")]
    Diverged(String),
    /// Toile itself is at fault.
    #[error("{0}")]
    Internal(String),
    /// Standard output cannot be written, because a disk is full for example.
    #[error("standard output cannot be written ({0}); send it to another place")]
    Stdout(io::Error),
    /// The reader of standard output went away, as `head` does: not a fault, so nothing is said.
    #[error("the reader of standard output has closed it")]
    StdoutClosed,
}

impl AppError {
    /// Bad input, described by the error of the module that read it: `.map_err(AppError::input)?`.
    pub fn input(error: impl Display) -> Self {
        Self::Input(error.to_string())
    }

    /// A fault of Toile's own: an error that should not happen.
    pub fn internal(error: impl Display) -> Self {
        Self::Internal(error.to_string())
    }

    /// The exit code of this error.
    pub fn code(&self) -> Code {
        match self {
            Self::Usage(_) => Code::Usage,
            Self::Threshold(_) => Code::Threshold,
            Self::Input(_) | Self::Stdout(_) => Code::BadInput,
            Self::Device(_) => Code::Device,
            Self::Diverged(_) => Code::Diverged,
            Self::Internal(_) => Code::Internal,
            Self::StdoutClosed => Code::Ok,
        }
    }

    /// Prints the error on stderr, as one line: `toile: ...`.
    pub fn print(&self) {
        if !matches!(self, Self::StdoutClosed) {
            say_line(&one_line(&self.to_string()));
        }
    }
}

impl From<io::Error> for AppError {
    /// Only for errors of standard output: files have [`OutputError`], which names them.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe { Self::StdoutClosed } else { Self::Stdout(error) }
    }
}

impl From<OutputError> for AppError {
    /// An output that names no file is a line not understood; all else is a place that cannot be used.
    fn from(error: OutputError) -> Self {
        match error {
            OutputError::NoFile { .. } => Self::Usage(error.to_string()),
            _ => Self::input(error),
        }
    }
}

impl From<FittingError> for AppError {
    fn from(error: FittingError) -> Self {
        match error {
            FittingError::Usage(text) => Self::Usage(text),
            FittingError::Input(text) => Self::Input(text),
            FittingError::Device(text) => Self::Device(text),
            FittingError::Internal(text) => Self::Internal(text),
        }
    }
}

/// What a panic prints: where it happened means nothing to a user, and the cure is how those who know learn it.
const INTERNAL_FAULT: &str = "internal fault; please report the command you typed, with what it prints when \
                              RUST_BACKTRACE=1 is set";

static PANICKED: AtomicBool = AtomicBool::new(false);

/// Whether any thread has panicked since [`install_panic_hook`].
pub fn panicked() -> bool {
    // Relaxed: the flag guards no other data, and joining a thread already orders its store before this load.
    PANICKED.load(Ordering::Relaxed)
}

/// Makes the first panic print one sentence in place of a message about the source; later ones, its consequences, print
/// nothing. With `RUST_BACKTRACE` set the usual message and trace follow, for the report.
pub fn install_panic_hook() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        // Relaxed: only one thread can win the swap, and nothing else is published by it.
        if PANICKED.swap(true, Ordering::Relaxed) {
            return;
        }
        say_line(INTERNAL_FAULT);
        if let Some(saved) = toile_fitting::live::crash::save() {
            say_line(&one_line(&saved));
        }
        if std::env::var_os("RUST_BACKTRACE").is_some() {
            usual(info);
        }
    }));
}

/// Joins the lines of a text with single spaces, so that a message stays one line whatever a source put in it.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn say_line(sentence: &str) {
    use io::Write;
    // Nowhere is left to complain when stderr itself is closed.
    let _ = writeln!(io::stderr(), "toile: {sentence}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_line() {
        assert_eq!(one_line("a\n  b\r\n\tc "), "a b c");
    }

    #[test]
    fn each_error_has_the_code_of_the_contract() {
        let codes = [
            (AppError::Usage(String::new()), 2),
            (AppError::Threshold(String::new()), 3),
            (AppError::input("x"), 4),
            (AppError::Device(String::new()), 5),
            (AppError::Diverged(String::new()), 6),
            (AppError::internal("x"), 70),
            (AppError::from(io::Error::from(io::ErrorKind::BrokenPipe)), 0),
        ];
        for (error, code) in codes {
            assert_eq!(error.code() as u8, code, "{error:?}");
        }
    }
}
