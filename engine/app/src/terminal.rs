//! Where words go: data to stdout, words and progress to stderr, colour only where a person looks.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::exit::AppError;
use crate::report::Document;

/// Writes data to stdout.
///
/// # Errors
/// [`AppError::StdoutClosed`] where the reader has gone, [`AppError::Stdout`] where it cannot be written.
pub fn print(text: &str) -> Result<(), AppError> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}

/// Writes exactly one JSON object and a line end to stdout.
///
/// # Errors
/// As [`print()`].
pub fn print_json<T: Serialize>(document: &Document<T>) -> Result<(), AppError> {
    let mut text = serde_json::to_string_pretty(document).map_err(AppError::internal)?;
    text.push('\n');
    print(&text)
}

/// Words for the person at the terminal.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    quiet: bool,
}

impl Words {
    /// Words that are said unless `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self { quiet }
    }

    /// Says one line on stderr.
    pub fn say(&self, line: &str) {
        if !self.quiet {
            // A closed stderr is no reason to stop working.
            let _ = writeln!(io::stderr(), "{line}");
        }
    }

    /// A progress bar of `length` units; it is drawn only when stderr is a terminal.
    pub fn bar(&self, length: u64, label: &'static str) -> ProgressBar {
        let hidden = self.quiet || !io::stderr().is_terminal();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let style = ProgressStyle::with_template("{msg:12} {bar:32} {percent:>3} % {eta:>4}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        ProgressBar::with_draw_target(Some(length), target).with_style(style).with_message(label)
    }
}

/// What a piece of text means, and so its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// All is well.
    Good,
    /// Something deserves a look.
    Warn,
    /// Something to read first.
    Strong,
}

/// Paints text where a person looks at stdout.
#[derive(Debug, Clone, Copy)]
pub struct Paint {
    colour: bool,
}

impl Paint {
    /// Paint for stdout: none in a pipe, with `NO_COLOR` set, or on a dumb terminal.
    pub fn for_stdout() -> Self {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|v| v == "dumb");
        Self { colour: io::stdout().is_terminal() && !refused && !dumb }
    }

    /// No paint at all.
    pub fn none() -> Self {
        Self { colour: false }
    }

    /// Whether anything is painted.
    pub fn is_on(&self) -> bool {
        self.colour
    }

    /// The text in its tone.
    pub fn tone<'a>(&self, text: &'a str, tone: Tone) -> Cow<'a, str> {
        let code = match tone {
            Tone::Good => 32,
            Tone::Warn => 33,
            Tone::Strong => 1,
        };
        if self.colour { format!("\x1b[{code}m{text}\x1b[0m").into() } else { text.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_paint_text_is_left_alone() {
        assert_eq!(Paint::none().tone("ok", Tone::Good), "ok");
        assert_eq!(Paint { colour: true }.tone("ok", Tone::Good), "\x1b[32mok\x1b[0m");
    }
}
