//! The long study of synthetic agreement:
//! `cargo run --release -p toile-perf --example agreement -- SUBJECTS FRAMES SEED`.

use std::process::ExitCode;

use toile_perf::agreement::{compare, study};

fn main() -> ExitCode {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let &[subjects, frames, seed] = &numbers[..] else {
        eprintln!("give three numbers: subjects of each sex, frames, seed");
        return ExitCode::from(2);
    };
    for sex_known in [false, true] {
        let results = study(subjects as usize, frames as usize, seed, sex_known);
        println!("sex {}, {} subjects, mm", if sex_known { "told" } else { "not told" }, results.len());
        println!("  measure            bias     SD    MAE    P95  sigma  within 1 and 2 sigma");
        for a in compare(&results) {
            let [bias, sd, mae, p95, sigma] =
                [a.bias, a.deviation, a.mean_absolute, a.p95, a.sigma].map(|m| m * 1000.0);
            let [one, two] = a.covered.map(|c| c * 100.0);
            println!("  {:16} {bias:6.1} {sd:6.1} {mae:6.1} {p95:6.1} {sigma:6.1}  {one:3.0} % {two:3.0} %", a.measure);
        }
    }
    ExitCode::SUCCESS
}
