//! Prints the table of how people's measures go together, as `assets/data/body/people.toml` holds it:
//! `cargo run --release -p toile-perf --example people -- ANSUR_II_FEMALE.csv ANSUR_II_MALE.csv`.

use std::path::Path;
use std::process::ExitCode;

use toile_perf::ansur::{Survey, SurveyError, table};

fn print(women: &str, men: &str) -> Result<(), SurveyError> {
    println!(
        "# How measures of people go together: ANSUR II (US Army Natick TR-15/007, 2014, public domain). Made by\n\
         # `cargo run --release -p toile-perf --example people -- ANSUR_II_FEMALE.csv ANSUR_II_MALE.csv`.\n\
         # Millimetres; `with` holds the correlations with the columns before. arm_bend: what a right angle at the\n\
         # elbow adds to the arm from acromion to wrist; sleeve_pose: what the survey's pose adds to half the shoulders\n\
         # and the straight arm; both are differences of means.\n"
    );
    println!("{}", table("female", &Survey::read(Path::new(women))?)?);
    print!("{}", table("male", &Survey::read(Path::new(men))?)?);
    Ok(())
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [women, men] = args.as_slice() else {
        eprintln!("give the two files of ANSUR II, women first");
        return ExitCode::from(2);
    };
    match print(women, men) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(4)
        }
    }
}
