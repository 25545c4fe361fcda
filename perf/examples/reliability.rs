//! Whether the probabilities of sizes are true, on the women of ANSUR II:
//! `cargo run --release -p toile-perf --example reliability -- ANSUR_II_FEMALE.csv EVERY SEED` takes every EVERYth woman.

use std::process::ExitCode;

use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_perf::reliability::{BINS, Girths, ReliabilityBin, ansur, reliability};
use toile_track::recommend::{EaseRange, MadeSize, Offer, Zone, ZoneGirth};

/// Errors of the girths (m).
const SIGMAS: [f32; 4] = [0.005, 0.010, 0.020, 0.030];

/// A dress over the body of each size (m): chest, waist, hip; and the ease that feels right.
const EASE: [f32; 3] = [0.06, 0.08, 0.10];
const RIGHT: [[f32; 2]; 3] = [[0.03, 0.09], [0.03, 0.15], [0.05, 0.20]];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, every, seed] = &args[..] else {
        eprintln!("give a table of ANSUR II, which part of its people to take, and a seed");
        return ExitCode::from(2);
    };
    let people = std::fs::read(file).ok().and_then(|b| ansur(&String::from_utf8_lossy(&b)));
    let (Some(people), Ok(every), Ok(seed)) = (people, every.parse::<usize>(), seed.parse::<u64>()) else {
        eprintln!("{file} cannot be read as a table of ANSUR II, or EVERY and SEED are no numbers");
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
    let table = SizeTable::embedded("women")?;
    let sizes = table.codes().into_iter().map(|code| made(&table, code)).collect::<Result<Vec<_>, _>>()?;
    let ease = [0, 1, 2].map(|i| EaseRange { zone: Zone::ALL[i], least: RIGHT[i][0], most: RIGHT[i][1] });
    let offer = Offer { garment: "dress", kind: GarmentKind::Dress, table: &table, sizes: &sizes, ease: &ease };
    let heads = BINS.map(|low| format!("said {:.0} % and more", 100.0 * low));
    println!("| sigma | all | {} | tape promised, came |", heads.join(" | "));
    println!("|{}", "---|".repeat(BINS.len() + 3));
    for sigma in SIGMAS {
        let r = reliability(people, &offer, sigma, seed)?;
        let bins = r.bins.map(|b| cell(&b));
        let [_, before, _] = r.untaped.rates();
        let taped = format!("{}, before {:.0}", cell(&r.taped), 100.0 * before);
        println!("| {:.0} mm | {} | {} | {taped} |", 1000.0 * sigma, cell(&r.all), bins.join(" | "));
    }
    Ok(())
}

fn made(table: &SizeTable, code: &str) -> Result<MadeSize, toile_assets::sizes::SizeError> {
    let body = table.size_body(code)?;
    let girths = [body.chest_girth, body.waist_girth, body.hip_girth];
    let zones = [0, 1, 2].map(|i| ZoneGirth { zone: Zone::ALL[i], girth_m: girths[i] + EASE[i] });
    Ok(MadeSize { code: code.to_owned(), zones: zones.to_vec() })
}

/// Stated and right in percent, the standard error, and how many people.
fn cell(bin: &ReliabilityBin) -> String {
    let [stated, right, error] = bin.rates().map(|r| 100.0 * r);
    if bin.people == 0 { "-".to_owned() } else { format!("{stated:.0} → {right:.0} ± {error:.0} ({})", bin.people) }
}
