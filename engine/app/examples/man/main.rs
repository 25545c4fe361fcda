//! The manual: one page a command, made from the grammar of the command line.
//!
//! `cargo run --release -p toile --example man -- DIR` writes `toile.1`, `toile-try-on.1` and all others into DIR, which is made
//! where it is missing. It is an example, so that the program itself does not carry it: only packages need it.

mod pages;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs, io};

/// Writes all pages, and gives how many.
fn write(folder: &Path) -> io::Result<usize> {
    fs::create_dir_all(folder)?;
    let pages = pages::all()?;
    for page in &pages {
        fs::write(folder.join(&page.name), &page.text)?;
    }
    Ok(pages.len())
}

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("man: no folder is given; name one for the pages, as in `man target/man`");
        return ExitCode::from(2);
    };
    match write(&folder) {
        Ok(count) => {
            println!("{count} pages in {}", folder.display());
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("man: pages cannot be written to {} ({why}); name another folder", folder.display());
            ExitCode::from(4)
        }
    }
}
