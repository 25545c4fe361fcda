//! The command line of Toile: the only crate that uses all others.
//!
//! Reads: arguments, sessions, garments. Writes: one report on stdout, words on stderr, files in the output folder.
//! Budget: the words and the parsing take under 10 ms; the work itself is budgeted by the rooms it calls.
//! Thread: the main thread, which loads, starts the frame's threads and waits for them.

// Rooms in the order of the data: a room imports only from the groups above its own (tests/tests/layers.rs).
pub mod heap;
pub mod machine;
pub mod output;
mod overlay;

pub mod exit;
pub mod report;

pub mod fit;
pub mod renderer;
pub mod terminal;

pub mod arguments;

pub mod camera;
pub mod pictures;
pub mod session_export;
pub mod summary;
pub mod video;

pub mod commands;

pub mod cli;

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use cli::Command;
use exit::{AppError, Code};

/// Runs one command line, the program's name first, and returns what the process shall exit with.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    exit::install_panic_hook();
    let args = args.into_iter().collect();
    guarded(|| cli::parse(args).and_then(|command| dispatch(&command))).into()
}

/// Does some work, prints its error if it has one, and turns a panic, on any thread, into [`Code::Internal`].
pub fn guarded(work: impl FnOnce() -> Result<(), AppError>) -> Code {
    // Unwinding rather than leaving at once lets an output folder take back its unfinished files. Nothing that the
    // work has touched is looked at again, so it need not be unwind-safe.
    let outcome = catch_unwind(AssertUnwindSafe(work));
    let code = match outcome {
        Ok(Ok(())) => Code::Ok,
        Ok(Err(error)) => {
            error.print();
            error.code()
        }
        Err(_) => Code::Internal,
    };
    // A panic on another thread was reported by the hook; whatever this thread made of it, the run has failed.
    if exit::panicked() { Code::Internal } else { code }
}

fn dispatch(command: &Command) -> Result<(), AppError> {
    match command {
        Command::TryOn(args) => commands::try_on::run(args),
        Command::Measure(args) => commands::measure::run(args),
        Command::Record(args) => commands::record::run(args),
        Command::Live(args) => commands::live::run(args),
        Command::Convert(args) => commands::convert::run(args),
        Command::Bake(args) => commands::bake::run(args),
        Command::Tailor(args) => commands::tailor::run(args),
        Command::Catalogue(command) => commands::catalogue::run(command),
        Command::Fabric(command) => commands::fabric::run(command),
        Command::Collage(args) => commands::collage::run(args),
        Command::Body(args) if args.colliders => commands::colliders::run(args),
        Command::Body(args) => commands::body::run(args),
        Command::Run(args) => commands::run::run(args),
        Command::Doctor(args) => commands::doctor::run(args),
        Command::Bench(command) => commands::bench::run(command),
        Command::Validate(args) => commands::validate::run(args),
        Command::Pareto(args) => commands::pareto::run(args),
        Command::Capture(command) => commands::capture::run(command),
        Command::Torture(args) => commands::torture::run(args),
        Command::Latency(args) => commands::latency::run(args),
        Command::Plan(args) => commands::plan::run(args),
        Command::Study(args) => commands::study::run(args),
        Command::Replay(args) => commands::replay::run(args),
        Command::Soak(args) => commands::soak::run(args),
        Command::Kiosk(args) => commands::kiosk::run(args),
        Command::Completions(args) => commands::completions::run(args, cli::command()),
        Command::Print(text) => terminal::print(text),
    }
}
