//! The tables of docs/wardrobe.md and docs/garments.md: every garment sewn up in six sizes and walked in, outfits, patterns of others.
//!
//! `cargo build --release -p toile && cargo run --release -p toile --example wardrobe -- garments` (or `outfits`, or `patterns
//! FOLDER`) runs the program `toile` that lies beside it, once for each figure, and prints rows in Markdown. Times are those of a
//! machine that does nothing else.

mod patterns;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use serde_json::Value;
use toile_assets::drafting;

/// Sizes that a garment is sewn up in: smallest, largest, and four between.
const WOMEN: [&str; 6] = ["32", "38", "44", "50", "54", "42"];
const MEN: [&str; 6] = ["XXS", "S", "M", "XL", "3XL", "L"];
const MENS_TROUSERS: [&str; 6] = ["60", "76", "92", "114", "132", "84"];

/// The man who walks: the embedded session's joints, with measures by tape.
const MAN: [&str; 8] = ["--body", "male", "--measure", "chest=1000", "--measure", "waist=860", "--measure", "hip=1000"];

/// Outfits, inner garment first.
const OUTFITS: [&[&str]; 6] = [
    &["straight-trousers", "shirt", "blazer"],
    &["slim-trousers", "tee"],
    &["wide-leg-trousers", "tee"],
    &["pencil-skirt", "blouse"],
    &["shift-dress", "coat", "scarf"],
    &["mens-trousers", "mens-shirt", "mens-coat"],
];

/// Runs the program with `--json`; what it reports.
fn toile(arguments: &[&str]) -> Result<Value, String> {
    let here = std::env::current_exe().map_err(|e| e.to_string())?;
    let program: PathBuf =
        here.ancestors().nth(2).map(|folder| folder.join("toile")).ok_or("this program lies in no folder")?;
    let run = Command::new(&program).args(arguments).args(["--json", "--quiet"]).output();
    let run = run.map_err(|e| format!("{}: {e}; cargo build --release -p toile", program.display()))?;
    let report = serde_json::from_slice(&run.stdout);
    report.map_err(|_| format!("toile {}: {}", arguments.join(" "), String::from_utf8_lossy(&run.stderr).trim()))
}

/// A number of a report, by its path.
fn number(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or(f64::NAN)
}

/// The largest of a number over reports.
fn largest(reports: &[Value], path: &str) -> f64 {
    reports.iter().map(|r| number(r, path)).fold(f64::NEG_INFINITY, f64::max)
}

/// A part as `mean, p99` in per cent.
fn percent(mean: f64, p99: f64) -> String {
    format!("{:.1}, {:.1} %", 100.0 * mean, 100.0 * p99)
}

/// How garments walk for ten seconds: the columns from the step's time on.
fn walked(garments: &[&str]) -> Result<Value, String> {
    let mut arguments = vec!["try-on", "--no-pictures"];
    arguments.extend(garments.iter().flat_map(|g| ["--garment", g]));
    if garments[0].starts_with("mens-") {
        arguments.extend(MAN);
    }
    toile(&arguments)
}

/// The row of a garment.
fn garment(name: &str) -> Result<String, String> {
    let sizes = match name {
        "mens-trousers" | "mens-shorts" => MENS_TROUSERS,
        "scarf" => MEN,
        _ if name.starts_with("mens-") => MEN,
        _ => WOMEN,
    };
    let sewn = sizes.iter().map(|size| toile(&["tailor", name, "--size", size])).collect::<Result<Vec<_>, _>>()?;
    let least = sewn.iter().map(|r| number(r, "/particles")).fold(f64::INFINITY, f64::min);
    let walk = walked(&[name])?;
    Ok(format!(
        "| {name} | {} | {}, {} | {least} to {} | {:.1} | {} | {} | {} |",
        sewn[0]["fabric"].as_str().unwrap_or_default(),
        number(&sewn[0], "/panels"),
        number(&sewn[0], "/seams"),
        largest(&sewn, "/particles"),
        largest(&sewn, "/seconds"),
        percent(largest(&sewn, "/strain/mean"), largest(&sewn, "/strain/p99")),
        largest(&sewn, "/crossings"),
        walking_columns(&walk),
    ))
}

/// Step, strain, depth in the skin, and edges through cloth, of a walk.
fn walking_columns(walk: &Value) -> String {
    format!(
        "{:.1}, {:.1} ms | {} | {:.0} mm | {}, {:.0} %",
        number(walk, "/physics/step_us/p50") / 1000.0,
        number(walk, "/physics/step_us/p99") / 1000.0,
        percent(number(walk, "/physics/strain/mean"), number(walk, "/physics/strain/p99")),
        number(walk, "/physics/penetration_mm/max"),
        number(walk, "/crossings/max"),
        100.0 * number(walk, "/crossings/frames_with") / number(walk, "/crossings/frames"),
    )
}

/// The row of an outfit.
fn outfit(garments: &[&str]) -> Result<String, String> {
    let walk = walked(garments)?;
    let held = |path: &str| if number(&walk, path) < 1e6 / 120.0 { "held" } else { "**missed**" };
    Ok(format!(
        "| {} | {} | p50 {}, p99 {} | {} | {} |",
        garments.join(", "),
        number(&walk, "/physics/particles"),
        held("/physics/step_us/p50"),
        held("/physics/step_us/p99"),
        walking_columns(&walk),
        number(&walk, "/crossings/max_between"),
    ))
}

/// The rows of what is asked for, each printed as soon as it is known.
fn run(arguments: &[String]) -> Result<(), String> {
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["garments"] => drafting::names().iter().try_for_each(|name| garment(name).map(|row| println!("{row}"))),
        ["garments", name] => garment(name).map(|row| println!("{row}")),
        ["outfits"] => OUTFITS.iter().try_for_each(|worn| outfit(worn).map(|row| println!("{row}"))),
        ["patterns", folder] => patterns::rows(Path::new(folder)),
        _ => Err("usage: wardrobe garments [NAME] | outfits | patterns FOLDER".to_owned()),
    }
}

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("wardrobe: {why}");
            ExitCode::from(4)
        }
    }
}
