//! Where words go: data to stdout, words and progress to stderr, colour only where a person looks.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

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
    /// Words that are printed unless `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self { quiet }
    }

    /// Prints one line on stderr.
    pub fn print_line(&self, line: &str) {
        if !self.quiet {
            // A closed stderr is no reason to stop working.
            let _ = writeln!(io::stderr(), "{line}");
        }
    }

    /// How far long work of `length` units is, under this label.
    pub fn bar(&self, length: u64, label: &'static str) -> Progress {
        let terminal = io::stderr().is_terminal();
        let target = if terminal && !self.quiet { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let style = ProgressStyle::with_template("{msg:12} {bar:32} {percent:>3} % {eta:>4}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(length), target).with_style(style);
        let lines = !terminal && !self.quiet;
        if lines {
            // The first line is due after a while: short work says nothing.
            NEXT_LINE
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .get_or_insert_with(|| Instant::now() + BETWEEN_LINES);
        }
        Progress { bar: bar.with_message(label), lines: lines.then_some(label) }
    }
}

/// Time between two lines of progress where stderr is not a terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// When the next line of progress is due, of whatever work; `None` before the first work.
static NEXT_LINE: Mutex<Option<Instant>> = Mutex::new(None);

/// How far long work is: a bar where stderr is a terminal, and a line every few seconds where it is not.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    /// The label of the lines; `None` where there are none.
    lines: Option<&'static str>,
}

impl Progress {
    /// So many units more are done.
    pub fn inc(&self, units: u64) {
        self.bar.inc(units);
        self.line();
    }

    /// So many units are done.
    pub fn set_position(&self, units: u64) {
        self.bar.set_position(units);
        self.line();
    }

    /// There are so many units.
    pub fn set_length(&self, units: u64) {
        self.bar.set_length(units);
    }

    /// The work is done; the bar goes.
    pub fn finish_and_clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Prints a line if one is due.
    fn line(&self) {
        let Some(label) = self.lines else { return };
        // Another thread that holds the lock prints the line.
        let Ok(mut next) = NEXT_LINE.try_lock() else { return };
        let now = Instant::now();
        if next.is_none_or(|next| now < next) {
            return;
        }
        *next = Some(now + BETWEEN_LINES);
        let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0).max(1));
        // A closed stderr is no reason to stop working.
        let _ = writeln!(io::stderr(), "{label}: {} %", (100 * done / all).min(100));
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
    fn progress_without_a_terminal_prints_a_line_when_one_is_due() {
        let words = Words::new(false);
        let progress = Progress { lines: Some("working"), ..words.bar(10, "working") };
        let due = |at: Instant| *NEXT_LINE.lock().unwrap() = Some(at);
        let soon = Instant::now() + BETWEEN_LINES;
        due(soon);
        progress.inc(1);
        assert_eq!(*NEXT_LINE.lock().unwrap(), Some(soon), "not yet due");
        due(Instant::now());
        progress.inc(1);
        assert!(NEXT_LINE.lock().unwrap().is_some_and(|next| next >= soon), "printed");
        assert!(Words::new(true).bar(10, "quiet").lines.is_none());
    }

    #[test]
    fn without_paint_text_is_left_alone() {
        assert_eq!(Paint::none().tone("ok", Tone::Good), "ok");
        assert_eq!(Paint { colour: true }.tone("ok", Tone::Good), "\x1b[32mok\x1b[0m");
    }
}
