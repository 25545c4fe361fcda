//! Patterns by others, in the folders in which they came, sewn up as `toile tailor` chooses.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::{number, percent, toile};

/// Prints a row for each file below a folder, in the order of their names.
pub fn rows(folder: &Path) -> Result<(), String> {
    let mut files = Vec::new();
    collect(folder, &mut files)?;
    files.sort_by_key(|file| file.file_name().map(std::ffi::OsStr::to_owned));
    if files.is_empty() {
        return Err(format!("{}: no pattern lies here", folder.display()));
    }
    for file in files {
        println!("{}", row(&file)?);
    }
    Ok(())
}

/// Files of patterns below a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "json" || e == "jsonc") && !is_measures(&path) {
            files.push(path);
        }
    }
    Ok(())
}

/// Measures of people lie beside FreeSewing's drafts.
fn is_measures(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("measurements"))
}

/// The row of a file. FreeSewing's have their seams in a file of ours, and one of them is for a man.
fn row(file: &Path) -> Result<String, String> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let path = file.display().to_string();
    let seams = ["aaron", "brian", "sandy"].into_iter().find(|n| name.starts_with(n));
    let seams = seams.map(|n| format!("assets/data/patterns/{n}.toml"));
    let mut arguments = vec!["tailor", &path];
    if let Some(seams) = &seams {
        arguments.extend(["--seams", seams]);
    }
    if name.contains("Male") && !name.contains("Female") {
        arguments.extend(["--body", "male"]);
    }
    let report = toile(&arguments)?;
    let seconds = |level: usize| number(&report, &format!("/levels/{level}/seconds"));
    Ok(format!(
        "| {name} | {} | {:.1}, {:.1}, {:.1} | {:.1} | {} | {}, {:.0} % | {:.1} mm | {} |",
        report["size"].as_str().map_or("", |s: &str| s),
        seconds(0),
        seconds(1),
        seconds(2),
        number(&report, "/seconds"),
        number(&report, "/particles"),
        percent(number(&report, "/strain/mean"), number(&report, "/strain/p99")).trim_end_matches(" %"),
        100.0 * number(&report, "/strain/max"),
        number(&report, "/seams_open_mm"),
        report.get("crossings").map_or(f64::NAN, |n: &Value| n.as_f64().unwrap_or(f64::NAN)),
    ))
}
