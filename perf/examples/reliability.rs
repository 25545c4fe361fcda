//! Whether the probabilities of sizes are true, on the women of ANSUR II:
//! `cargo run --release -p toile-perf --example reliability -- ANSUR_II_FEMALE.csv EVERY SEED` takes every EVERYth woman.

use std::process::ExitCode;

use toile_perf::reliability::{BINS, Girths, ReliabilityBin, ansur, of_dress};

/// Errors of the girths (m).
const SIGMAS: [f32; 4] = [0.005, 0.010, 0.020, 0.030];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, every, seed] = &args[..] else {
        eprintln!("give a table of ANSUR II, which part of its people to take, and a seed");
        return ExitCode::from(2);
    };
    let people = std::fs::read(file).ok().and_then(|b| ansur(&String::from_utf8_lossy(&b)));
    let (Some(people), Ok(every), Ok(seed)) = (people, every.parse::<usize>(), seed.parse::<u64>()) else {
        eprintln!("{file} cannot be read as a table of ANSUR II, or EVERY and SEED are not numbers");
        return ExitCode::from(4);
    };
    let some: Vec<Girths> = people.into_iter().step_by(every.max(1)).collect();
    match run(&some, seed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(70)
        }
    }
}

fn run(people: &[Girths], seed: u64) -> Result<(), Box<dyn std::error::Error>> {
    let heads = BINS.map(|low| format!("said {:.0} % and more", 100.0 * low));
    println!("| sigma | all | {} | tape promised, came |", heads.join(" | "));
    println!("|{}", "---|".repeat(BINS.len() + 3));
    for sigma in SIGMAS {
        let r = of_dress(people, sigma, seed)?;
        let bins = r.bins.map(|b| cell(&b));
        let [_, before, _] = r.untaped.rates();
        let taped = format!("{}, before {:.0}", cell(&r.taped), 100.0 * before);
        println!("| {:.0} mm | {} | {} | {taped} |", 1000.0 * sigma, cell(&r.all), bins.join(" | "));
    }
    Ok(())
}

/// Stated and right in percent, the standard error, and how many people.
fn cell(bin: &ReliabilityBin) -> String {
    let [stated, right, error] = bin.rates().map(|r| 100.0 * r);
    if bin.people == 0 { "-".to_owned() } else { format!("{stated:.0} → {right:.0} ± {error:.0} ({})", bin.people) }
}
