//! Output streams: data to stdout, words and progress to stderr, colour only on a terminal.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::document::Document;
use crate::exit::AppError;

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
        let shown = match (self.quiet, io::stderr().is_terminal()) {
            (true, _) => Shown::Nothing,
            (false, true) => Shown::Bar,
            (false, false) => Shown::Lines,
        };
        if shown == Shown::Lines {
            // The first line is due after a while: short work says nothing.
            let mut next = NEXT_LINE.lock().unwrap_or_else(PoisonError::into_inner);
            next.get_or_insert_with(|| Instant::now() + BETWEEN_LINES);
        }
        let drawn = Mutex::new(None);
        Progress { label, shown, done: AtomicU64::new(0), length: AtomicU64::new(length), begun: Instant::now(), drawn }
    }
}

/// Time between two lines of progress where stderr is not a terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// When the next line of progress is due, of whatever work; `None` before the first work.
static NEXT_LINE: Mutex<Option<Instant>> = Mutex::new(None);

/// Time between two drawings of a bar.
const BETWEEN_DRAWINGS: Duration = Duration::from_millis(100);

/// Characters of a whole bar.
const BAR: u64 = 32;

/// What is shown of progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shown {
    Nothing,
    /// A bar that is drawn over itself, on a terminal.
    Bar,
    /// A line every few seconds.
    Lines,
}

/// How far long work is: a bar where stderr is a terminal, and a line every few seconds where it is not.
#[derive(Debug)]
pub struct Progress {
    label: &'static str,
    shown: Shown,
    done: AtomicU64,
    length: AtomicU64,
    begun: Instant,
    /// When the bar was drawn last; none where none stands on the terminal.
    drawn: Mutex<Option<Instant>>,
}

impl Progress {
    /// So many units more are done.
    pub fn inc(&self, units: u64) {
        // Relaxed, here and below: counts for people to look at.
        self.done.fetch_add(units, Relaxed);
        self.show();
    }

    /// So many units are done.
    pub fn set_position(&self, units: u64) {
        self.done.store(units, Relaxed);
        self.show();
    }

    /// There are so many units.
    pub fn set_length(&self, units: u64) {
        self.length.store(units, Relaxed);
    }

    /// The work is done; the bar goes.
    pub fn finish_and_clear(&self) {
        if self.drawn.lock().unwrap_or_else(PoisonError::into_inner).take().is_some() {
            // A closed stderr is no reason to stop working, here and below.
            let _ = write!(io::stderr(), "\r\x1b[2K");
        }
    }

    /// Shows the state if it is due. Another thread that holds the lock does it.
    fn show(&self) {
        let now = Instant::now();
        match self.shown {
            Shown::Nothing => {}
            Shown::Bar => {
                let Ok(mut drawn) = self.drawn.try_lock() else { return };
                if drawn.is_none_or(|last| now >= last + BETWEEN_DRAWINGS) {
                    *drawn = Some(now);
                    let _ = write!(io::stderr(), "\r\x1b[2K{}", self.bar());
                }
            }
            Shown::Lines => {
                let Ok(mut next) = NEXT_LINE.try_lock() else { return };
                if next.is_some_and(|next| now >= next) {
                    *next = Some(now + BETWEEN_LINES);
                    let _ = writeln!(io::stderr(), "{}: {} %", self.label, self.percent());
                }
            }
        }
    }

    fn percent(&self) -> u64 {
        (100 * self.done.load(Relaxed) / self.length.load(Relaxed).max(1)).min(100)
    }

    /// The bar as text, with the time that is left by the speed so far.
    fn bar(&self) -> String {
        let percent = self.percent();
        let full = (BAR * percent / 100) as usize;
        let left = self.begun.elapsed().as_secs() * (100 - percent) / percent.max(1);
        format!("{:12} {:-<32} {percent:>3} % {left:>4} s", self.label, "#".repeat(full))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish_and_clear();
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
        let mut progress = words.bar(10, "working");
        progress.shown = Shown::Lines;
        let due = |at: Instant| *NEXT_LINE.lock().unwrap() = Some(at);
        let soon = Instant::now() + BETWEEN_LINES;
        due(soon);
        progress.inc(1);
        assert_eq!(*NEXT_LINE.lock().unwrap(), Some(soon), "not yet due");
        due(Instant::now());
        progress.inc(1);
        assert!(NEXT_LINE.lock().unwrap().is_some_and(|next| next >= soon), "printed");
        assert_eq!(Words::new(true).bar(10, "quiet").shown, Shown::Nothing);
        progress.set_position(5);
        assert!(progress.bar().contains("################---"), "{}", progress.bar());
    }

    #[test]
    fn without_paint_text_is_left_alone() {
        assert_eq!(Paint::none().tone("ok", Tone::Good), "ok");
        assert_eq!(Paint { colour: true }.tone("ok", Tone::Good), "\x1b[32mok\x1b[0m");
    }
}
