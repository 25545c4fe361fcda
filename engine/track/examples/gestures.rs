//! Temporary.
fn main() {
    let n = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(20);
    println!("{}", toile_track::gesture::study::Study::run(n, 1, &mut |s| eprintln!("{s}")).markdown());
}
